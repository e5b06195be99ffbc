//! Agents that change during evaluations although they promise to be frozen.

use std::ops::ControlFlow;

use driftworld_curriculum::{Experience, Progress, REPEATED_EVALUATIONS, Repeats, Rollout, run_rollout};
use driftworld_metrics::Timestamp;

use super::*;

/// Acts differently depending on how many episodes it has begun, including evaluations.
#[derive(Clone, Default)]
struct Restless {
    episodes: u32,
    /// Whether evaluations are run by copies of it.
    is_copied: bool,
    /// Whether it acts differently only after learning.
    is_honest: bool,
    learned: u32,
}

impl Agent for Restless {
    fn act(&mut self, environment: &Environment) -> Action {
        let steps = if self.is_honest { self.learned } else { self.episodes };
        // Speed and turns affect the reward of every step.
        let share = f64::from(steps % 7) / 7.0;
        Action::Continuous([
            share * environment.world().agent_params.max_linear_speed,
            f64::from(steps % 5) * 10.0,
            1.0,
        ])
    }
    fn begin(&mut self, _: u64) {
        self.episodes += 1;
    }
    fn learn(&mut self, _: &Environment, _: &Step) {
        self.learned += 1;
    }
    fn frozen(&self) -> Option<Box<dyn Agent + Send>> {
        self.is_copied.then(|| Box::new(self.clone()) as _)
    }
}

/// A world that rewards progress towards a goal at `ahead` in every step, so that every action affects the reward.
pub(crate) fn hill(ahead: i32) -> World {
    let text = r#"{ "max_steps": 30,
        "objects": [{ "class": "geometric", "coordinates": [0, AHEAD], "tag": "goal" }],
        "rules": { "shaping": { "toward": "goal", "scale": 1 } } }"#
        .replace("AHEAD", &ahead.to_string());
    World::from_json("hill.json", &text).unwrap_or_else(|error| panic!("{error}"))
}

pub(crate) fn shaped(world: &str) -> Scenario {
    let regime = |count: u32| Regime {
        world: Some(world.to_owned()),
        ..Regime::new("Task 2", "hill", count)
    };
    let evaluation = || Block::new(BlockKind::Evaluation, vec![regime(6)]);
    let learning = Block::new(BlockKind::Learning, vec![regime(3)]);
    Scenario::new("shaped", vec![evaluation(), learning, evaluation()])
}

#[test]
fn agent_changed_by_evaluations_is_refused_with_one_or_several_jobs() {
    let folder = scratch();
    for (name, is_copied, jobs) in [("self", false, 1), ("copy", true, 1), ("copies", true, 3)] {
        let mut agent = Restless {
            is_copied,
            ..Restless::default()
        };
        let settings = RunSettings {
            jobs,
            repeated: REPEATED_EVALUATIONS,
            ..RunSettings::default()
        };
        let refused = run_with(&shaped("hill.json"), &mut agent, &folder.path().join(name), &settings)
            .expect_err("evaluations change the agent");
        assert_eq!(refused.code(), "curriculum/not-frozen", "{name}: {refused}");
        let message = refused.to_string();
        assert!(
            message.contains("block 0") && message.contains("Task 2#hill"),
            "{message}"
        );
    }
}

/// Stands still except for one step, in which it turns by a tiny angle that differs each time; its world has no rewards.
struct Fidgety {
    episodes: u32,
    step: u32,
}

impl Agent for Fidgety {
    fn act(&mut self, environment: &Environment) -> Action {
        let turn = f64::from(u32::from(environment.num_steps() == self.step) * self.episodes);
        Action::Continuous([0.0, turn * 1e-9, 0.0])
    }
    fn begin(&mut self, _: u64) {
        self.episodes += 1;
    }
}

#[test]
fn changed_actions_are_detected_without_rewards() {
    let folder = scratch();
    let regime = Regime {
        world: Some("yard.json".to_owned()),
        ..Regime::new("Task 1", "yard", 5)
    };
    let scenario = Scenario::new("idle", vec![Block::new(BlockKind::Evaluation, vec![regime])]);
    let settings = RunSettings {
        repeated: REPEATED_EVALUATIONS,
        ..RunSettings::default()
    };
    for step in [0, 17, 39] {
        let mut agent = Fidgety { episodes: 0, step };
        let log = folder.path().join(step.to_string());
        let refused = run_with(&scenario, &mut agent, &log, &settings).expect_err("it acts differently");
        let expected = format!("found a different action in step {} of experience", step + 1);
        assert!(refused.to_string().contains(&expected), "{refused}");
    }
}

/// Records which evaluations of each block are repeated, and runs nothing.
struct RepeatRecorder {
    repeats: Repeats,
    blocks: Vec<Vec<u64>>,
}

impl Rollout for RepeatRecorder {
    type Error = CurriculumError;
    fn begin_block(&mut self, _: bool, repeated: &[u64]) -> Result<(), CurriculumError> {
        self.blocks.push(repeated.to_vec());
        Ok(())
    }
    fn repeats(&self) -> Repeats {
        self.repeats
    }
    fn experience(&mut self, _: u64, _: World) -> Result<Option<Experience>, CurriculumError> {
        Ok(Some(Experience::default()))
    }
    fn logged(&mut self, _: &Progress, _: Option<f64>) -> Result<ControlFlow<()>, CurriculumError> {
        Ok(ControlFlow::Continue(()))
    }
}

#[test]
fn repeated_evaluations_are_drawn_for_each_block() {
    let regime = |seed: u64| Regime {
        seed,
        ..Regime::new("find_objects", "red", 40)
    };
    let blocks = |seed: u64| vec![Block::new(BlockKind::Evaluation, vec![regime(seed)]); 20];
    let drawn = |seed: u64, first: bool| {
        let plan = plan(&Scenario::new("drawn", blocks(seed))).unwrap_or_else(|error| panic!("{error}"));
        let folder = scratch();
        let mut journal = Journal::create(&folder.path().join("log"), &plan, "test").unwrap_or_else(|e| panic!("{e}"));
        let repeats = Repeats { count: 4, first };
        let mut recorder = RepeatRecorder {
            repeats,
            blocks: Vec::new(),
        };
        let now = Timestamp::from_unix_micros(0).expect("the epoch is a valid time");
        run_rollout(&plan, &mut recorder, &mut journal, 0, &mut || now).unwrap_or_else(|error| panic!("{error}"));
        let in_block = |(block, numbers): (u64, Vec<u64>)| -> Vec<u64> {
            numbers.into_iter().map(|number| number - 40 * block).collect()
        };
        (0..).zip(recorder.blocks).map(in_block).collect::<Vec<_>>()
    };
    let (one, other) = (drawn(1, false), drawn(2, false));
    for block in &one {
        assert!(
            block.len() == 4 && block.is_sorted() && block.iter().all(|index| *index < 40),
            "{block:?}"
        );
    }
    let indices: std::collections::BTreeSet<u64> = one.iter().flatten().copied().collect();
    assert!(indices.len() > 25, "any evaluation may be repeated: {indices:?}");
    assert_ne!(one, other);
    assert_eq!(one, drawn(1, false));
    assert!(drawn(1, true).iter().all(|block| *block == [0, 1, 2, 3]));
}

#[test]
fn check_of_a_frozen_learner_does_not_change_its_log() {
    let folder = scratch();
    let mut logs = Vec::new();
    for (name, is_copied, jobs, repeated) in [
        ("unchecked", false, 1, 0),
        ("self", false, 1, REPEATED_EVALUATIONS),
        ("copy", true, 1, REPEATED_EVALUATIONS),
        ("copies", true, 4, REPEATED_EVALUATIONS),
    ] {
        let mut agent = Restless {
            is_copied,
            is_honest: true,
            ..Restless::default()
        };
        let (log, settings) = (
            folder.path().join(name),
            RunSettings {
                jobs,
                repeated,
                ..RunSettings::default()
            },
        );
        let summary = run_with(&shaped("hill.json"), &mut agent, &log, &settings)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(summary.finished && summary.experiences == 15, "{name}: {summary:?}");
        logs.push(log_text(&log));
    }
    assert!(logs.windows(2).all(|pair| pair[0] == pair[1]));
}
