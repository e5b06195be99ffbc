//! Tests that recorded episodes replay bit for bit (observations, rewards and ending), in all built-in tasks and example worlds,
//! with any agent and action space.

use std::io::BufReader;
use std::path::Path;
use std::sync::LazyLock;

use driftworld::env::{
    Action, Agent, Catalogue, EndedBy, EnvError, Environment, OnRailsAgent, RandomAgent, Recorder, Recording,
    RecordingLines, RecordingReader, Replay,
};
use driftworld::generator::Sampler;
use driftworld::spec::{ActionModel, ActionSpace, Variant, World};
use driftworld::tasks;
use proptest::prelude::*;
use proptest::sample::Index;

/// The observation, state, reward and ending of a step.
#[derive(Debug, PartialEq)]
struct Observed {
    pixels: Vec<u8>,
    state: Vec<u32>,
    reward: u64,
    ended_by: Option<EndedBy>,
}

fn observed(environment: &mut Environment, reward: f64, ended_by: Option<EndedBy>) -> Observed {
    let frame = environment.observe_at(16, 16).expect("the size is allowed");
    let depth = frame.depth.iter().flat_map(|metres| metres.to_bits().to_le_bytes());
    Observed {
        pixels: frame
            .rgb
            .iter()
            .copied()
            .chain(depth)
            .chain(frame.category.iter().copied())
            .collect(),
        state: environment.state_vector().into_iter().map(f32::to_bits).collect(),
        reward: reward.to_bits(),
        ended_by,
    }
}

/// Runs an episode, and records it.
fn run_recorded(world: &World, agent: &mut dyn Agent, seed: u64, max_steps: u32) -> (Vec<Observed>, Recording) {
    let mut environment = Environment::new(world.clone());
    let mut recorder = Recorder::default();
    recorder.begin(world.clone());
    agent.begin(seed);
    let mut course = vec![observed(&mut environment, 0.0, None)];
    let mut ended_by = None;
    while !environment.ended() && recorder.num_steps() < max_steps {
        let action = agent.act(&environment);
        let step = environment.step(action).expect("the agent's action is valid");
        recorder.step(action);
        ended_by = step.ended_by;
        course.push(observed(&mut environment, step.reward, step.ended_by));
    }
    let recording = recorder.recording(&environment, ended_by);
    (course, recording)
}

fn written(recordings: &[Recording]) -> String {
    let mut lines = RecordingLines::default();
    let episodes = recordings.iter().map(|recording| lines.lines(recording));
    RecordingLines::header() + &episodes.collect::<String>()
}

/// All recordings in a text, or the first error.
fn read(text: &str) -> Result<Vec<Recording>, EnvError> {
    let mut reader = RecordingReader::new(BufReader::new(text.as_bytes()))?;
    let mut found = Vec::new();
    while let Some(episode) = reader.next_episode()? {
        found.push(reader.recording(&episode)?);
    }
    Ok(found)
}

fn replayed(recording: &Recording) -> Vec<Observed> {
    let mut replay = Replay::new(recording, &Catalogue::default());
    let mut course = vec![observed(replay.environment(), 0.0, None)];
    while let Some(step) = replay.step().expect("the replay continues") {
        course.push(observed(replay.environment(), step.reward, step.ended_by));
    }
    replay.check().expect("the replay matches the recording");
    course
}

/// Runs, writes, reads and replays an episode. The recording must be unchanged, and the replay equal to the run.
#[track_caller]
fn check(name: &str, world: &World, agent: &mut dyn Agent, seed: u64, max_steps: u32) {
    let (course, recording) = run_recorded(world, agent, seed, max_steps);
    let text = written(std::slice::from_ref(&recording));
    let back = read(&text).unwrap_or_else(|error| panic!("{name}: {error}"));
    assert_eq!(back, [recording], "{name}");
    assert!(replayed(&back[0]) == course, "{name}: observations or rewards differ");
}

static ALL_VARIANTS: LazyLock<Vec<Variant>> = LazyLock::new(|| {
    let examples =
        std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/worlds")).expect("it can be listed");
    let paths = examples.map(|entry| entry.expect("it can be listed").path().display().to_string());
    let mut names: Vec<String> = paths
        .filter(|path| Path::new(path).extension().is_some_and(|ending| ending == "json"))
        .collect();
    names.sort();
    names.extend(tasks::built_in_names().iter().map(ToString::to_string));
    let variants = names
        .iter()
        .map(|name| tasks::variants(name).unwrap_or_else(|error| panic!("{error}")));
    variants.flatten().collect()
});

/// A world with a different action interface, if requested.
fn with_actions(world: World, actions: Option<ActionSpace>, frame_skip: u32, interact: bool) -> World {
    let edited = world.edit(|world| {
        let agent = &mut world.agent_params;
        agent.frame_skip = frame_skip;
        agent.interact |= interact;
        if let Some(actions) = actions
            && agent.action_model == ActionModel::ByVelocity
        {
            agent.actions = actions;
        }
    });
    edited.expect("any world accepts these actions")
}

#[test]
fn every_task_and_every_example_world_replays() {
    let mut names = Vec::new();
    for variant in &*ALL_VARIANTS {
        let task = variant.task().name().to_owned();
        // Tests only the first one or two variants of each task; the property test below draws others.
        if names.iter().filter(|name| **name == task).count() >= crate::tier::quick_or_full(1, 2) {
            continue;
        }
        names.push(task);
        let world = Sampler::new(variant, 3)
            .world(1)
            .unwrap_or_else(|error| panic!("{error}"));
        check(&variant.id(), &world, &mut RandomAgent::new(0), 7, 60);
        check(&variant.id(), &world, &mut OnRailsAgent::new(), 0, 150);
    }
    assert!(names.len() > 12, "{names:?}");
}

/// Three short episodes.
static THREE: LazyLock<Vec<Recording>> = LazyLock::new(|| {
    let variant = tasks::variant("find_objects#red").expect("it is built in");
    let episode = |number| {
        let world = Sampler::new(&variant, number).world(0).expect("it can be drawn");
        run_recorded(&world, &mut RandomAgent::new(0), number, 4).1
    };
    (0..3).map(episode).collect()
});

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]
    #[test]
    fn any_agent_and_action_space_replays(
        variant in any::<Index>(),
        (seed, index) in (any::<u64>(), 0u64..1000),
        space in 0usize..4,
        frame_skip in 1u32..4,
        interact in any::<bool>(),
        most in 0u32..50,
    ) {
        let variant = variant.get(&ALL_VARIANTS);
        let world = Sampler::new(variant, seed).world(index);
        prop_assume!(world.is_ok());
        let actions = match space {
            0 => None,
            1 => Some(ActionSpace::Continuous),
            2 => Some(ActionSpace::Normalized),
            _ => Some(ActionSpace::Discrete(vec![[5.0, 0.0, 0.0], [0.0, 90.0, 1.0], [3.3, -45.0, 0.0]])),
        };
        let world = with_actions(world.expect("it can be drawn"), actions, frame_skip, interact);
        check(&variant.id(), &world, &mut RandomAgent::new(0), seed ^ index, most);
    }

    /// Any changed byte is detected, with its line; episodes on other lines can still be read. A truncated text gives the
    /// episodes before the cut.
    #[test]
    fn damage_is_located_and_other_episodes_are_readable(offset in any::<Index>(), flip in 1u8..128) {
        let recordings: &[Recording] = &THREE;
        let text = written(recordings);
        let offset = offset.index(text.len());
        let line = 1 + text[..offset].matches('\n').count() as u64;

        let mut bytes = text.clone().into_bytes();
        bytes[offset] ^= flip;
        let read_all = |bytes: &[u8]| {
            let mut reader = RecordingReader::new(bytes)?;
            let (mut found, mut errors) = (Vec::new(), Vec::new());
            loop {
                match reader.next_episode() {
                    Ok(Some(episode)) => match reader.recording(&episode) {
                        Ok(recording) => found.push(recording),
                        Err(error) => errors.push(error),
                    },
                    Ok(None) => return Ok::<_, EnvError>((found, errors)),
                    Err(error) => errors.push(error),
                }
            }
        };
        let line_of = |error: &EnvError| match error {
            EnvError::Recording { line, .. } => *line,
            other => panic!("{other}"),
        };
        match read_all(&bytes) {
            // Splitting or joining lines changes the numbers of later lines.
            Ok((found, errors)) => {
                prop_assert!(!errors.is_empty() && found.len() < 3, "the change is not detected");
                prop_assert_eq!(line_of(&errors[0]), line);
                prop_assert!(found.iter().all(|recording| recordings.contains(recording)));
                // Each episode has its own world, so a damaged line costs one episode, a damaged line break two.
                let lost = if text.as_bytes()[offset] == b'\n' { 2 } else { 1 };
                prop_assert!(found.len() + lost >= 3, "{} episodes are left", found.len());
            }
            Err(error) => prop_assert_eq!(line_of(&error), 1),
        }

        let cut = &text.as_bytes()[..offset];
        if let Ok((found, errors)) = read_all(cut) {
            let num_lines = cut.split(|byte| *byte == b'\n').count() - 1;
            // The file has a header, then for each recording a line for its world and one for its episode.
            prop_assert_eq!(found.len(), num_lines.saturating_sub(1) / 2);
            prop_assert_eq!(&found[..], &recordings[..found.len()]);
            prop_assert_eq!(errors.len(), usize::from(cut.last() != Some(&b'\n')));
        } else {
            prop_assert_eq!(line, 1);
        }
    }
}

#[test]
fn external_changes_are_part_of_the_episode() {
    let world = Sampler::new(&tasks::variant("find_objects#red").unwrap(), 5)
        .world(2)
        .unwrap();
    let mut environment = Environment::new(world.clone());
    let mut recorder = Recorder::default();
    recorder.begin(world.clone());
    let mut agent = RandomAgent::new(4);
    let mut course = Vec::new();
    for number in 0..30 {
        if number == 0 || number == 12 {
            let mut object = world.objects[number / 6].clone();
            object.unique_name = Some(format!("new {number}"));
            object.coordinates = [20.0 - number as f64, 18.0];
            environment.spawn(object).expect("there is room");
            recorder.edit(&environment);
        }
        let action = agent.act(&environment);
        let step = environment.step(action).unwrap();
        recorder.step(action);
        course.push(observed(&mut environment, step.reward, step.ended_by));
        assert!(!environment.ended(), "the episode is long enough");
    }
    let recording = recorder.recording(&environment, None);
    let back = read(&written(&[recording])).unwrap();
    assert_eq!(back[0].edits.len(), 2);
    assert!(replayed(&back[0])[1..] == course[..], "observations or rewards differ");
}

#[test]
fn divergent_replay_is_reported() {
    let world = Sampler::new(&tasks::variant("find_objects#red").unwrap(), 5)
        .world(2)
        .unwrap();
    let (_, recording) = run_recorded(&world, &mut OnRailsAgent::new(), 0, 4000);
    assert_eq!(recording.ended_by, Some(EndedBy::AllCollected));
    let outcome = |change: &dyn Fn(&mut Recording)| {
        let mut changed = recording.clone();
        change(&mut changed);
        let mut replay = Replay::new(&changed, &Catalogue::default());
        loop {
            match replay.step() {
                Ok(Some(_)) => {}
                Ok(None) => return replay.check().map_err(|error| error.to_string()),
                Err(error) => return Err(error.to_string()),
            }
        }
    };
    assert_eq!(outcome(&|_| {}), Ok(()));
    let check_error = |change: &dyn Fn(&mut Recording), words: &str| {
        let error = outcome(change).expect_err("the replay differs");
        assert!(error.contains(words), "{error}");
        assert!(error.contains("recorded by driftworld"), "{error}");
    };
    check_error(&|recording| recording.reward += 1.0, "reward: found");
    check_error(
        &|recording| recording.ended_by = Some(EndedBy::Zone),
        "ended_by: found all_collected, expected zone",
    );
    check_error(
        &|recording| recording.actions.push(Action::Continuous([0.0; 3])),
        "the episode has ended",
    );
    check_error(
        &|recording| {
            recording.actions.pop();
        },
        "found",
    );
    check_error(
        &|recording| {
            let moved = recording
                .world
                .clone()
                .edit(|world| world.objects[0].coordinates[0] += 5.0);
            recording.world = moved.expect("it is valid");
        },
        "found",
    );
}
