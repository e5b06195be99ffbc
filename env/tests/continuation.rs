//! A world that is saved in the middle of a puzzle resumes exactly: with the locked door open, the key in the agent's hands,
//! and half of its energy used up.

use driftworld_env::{Action, Agent, EndedBy, Environment, OnRailsAgent, RandomAgent, Step};
use driftworld_spec::{
    ActionModel, Door, EndCondition, Energy, Layout, Modality, MotionModel, StateFeature, Stimulus, World, WorldDraft,
    Zone,
};
use proptest::prelude::*;

use crate::fixtures::{key, thing};

const MAX_ENERGY: f64 = 100.0;

/// Indices of the locked door and of its key in the list of objects.
const LOCKED: usize = 0;
const KEY: usize = 1;

/// A corridor with rooms on both sides: the goal is behind a locked door, and its key in one of the other rooms.
fn corridor(start: usize, lies: usize, model: ActionModel, frame_skip: u32) -> WorldDraft {
    let rows = [
        "###########",
        "#kkk#kkk#G#",
        "#kkk#kkk#.#",
        "##D###D##L#",
        "#AAAAAAAAA#",
        "###########",
    ];
    let mut legend = std::collections::BTreeMap::new();
    legend.insert("L".to_owned(), driftworld_spec::Legend::Doorway);
    for letter in ["k", "G"] {
        legend.insert(letter.to_owned(), driftworld_spec::Legend::Floor);
    }
    let layout = Layout {
        text: Some(rows.map(str::to_owned).to_vec()),
        legend,
        ..Layout::default()
    };
    // Positions of the character, row by row from the north; cells are 2 m wide.
    let places = |letter: char| -> Vec<[f64; 2]> {
        let cells = rows.iter().enumerate().flat_map(|(row, text)| {
            let found = text.chars().enumerate().filter(move |(_, found)| *found == letter);
            found.map(move |(column, _)| [column as f64 * 2.0 - 10.0, 5.0 - row as f64 * 2.0])
        });
        cells.collect()
    };
    let nth = |letter: char, number: usize| {
        let places = places(letter);
        places[number % places.len()]
    };
    let door = |at: [f64; 2], door: Door| {
        let mut leaf = thing("door", "door", at);
        (leaf.scale, leaf.door) = (2.0, Some(door));
        leaf
    };
    let locked = Door {
        key: Some("key".to_owned()),
        closes_after: Some(8.0),
        ..Door::default()
    };
    let sprung = || Door {
        closes_after: Some(3.0),
        ..Door::default()
    };
    let mut goal = thing("geometric", "goal", nth('G', 0));
    (goal.reward, goal.reward_once_stimulus) = (100.0, vec![Stimulus::AgentCollide]);
    let mut guest = thing("barrel", "guest", nth('A', start + 4));
    (guest.motion_model, guest.speed, guest.solid) = (MotionModel::RandomWaypoint, 1.0, false);
    let mut mud = Zone::disc(nth('A', 4), 1.5);
    (mud.speed_factor, mud.reward_per_second) = (0.8, -0.3);
    let mut world = WorldDraft {
        seed: Some(11),
        objects: vec![
            door(nth('L', 0), locked),
            key("key", nth('k', lies)),
            door(nth('D', 0), sprung()),
            door(nth('D', 1), sprung()),
            goal,
            guest,
        ],
        ..WorldDraft::default()
    };
    world.environment_params.layout = Some(layout);
    world.environment_params.zones = vec![mud];
    let agent = &mut world.agent_params;
    (agent.coordinates, agent.agent_width, agent.carry_limit) = (nth('A', start), 0.8, 1);
    (agent.action_model, agent.frame_skip, agent.max_linear_speed) = (model, frame_skip, 4.0);
    agent.observation_size = 24;
    agent.modalities = vec![Modality::Rgb, Modality::Depth, Modality::Class, Modality::Instance];
    agent.state_features = vec![
        StateFeature::Position,
        StateFeature::Heading,
        StateFeature::Carrying,
        StateFeature::Energy,
        StateFeature::LastReward,
    ];
    world.rules.success = vec![EndCondition::Touch("goal".to_owned())];
    world.rules.failure = vec![EndCondition::OutOfEnergy];
    world.max_steps = 4000;
    world
}

fn begin(world: &WorldDraft) -> Environment {
    Environment::new(world.clone().check().expect("the world is valid"))
}

/// Runs the expert until the locked door is open while the agent carries the key; returns the time in seconds.
fn run_until_door_is_open(environment: &mut Environment) -> f64 {
    let mut expert = OnRailsAgent::new();
    loop {
        let own = environment.objects();
        if own[LOCKED].open && own[KEY].carried {
            return environment.seconds();
        }
        let action = expert.act(environment);
        let step = environment.step(action).expect("the episode continues");
        assert!(
            !step.ended(),
            "the episode ended by {:?} before the door was opened",
            step.ended_by
        );
    }
}

/// The same world with energy, half of which is used up when the door opens.
fn with_half_the_energy(mut world: WorldDraft) -> WorldDraft {
    let seconds = run_until_door_is_open(&mut begin(&world));
    world.agent_params.energy = Some(Energy {
        start: MAX_ENERGY,
        per_second: -MAX_ENERGY / 2.0 / seconds,
        per_metre: 0.0,
        most: MAX_ENERGY,
    });
    world
}

/// Results and observations of a step, for comparison bit for bit.
#[derive(Debug, PartialEq)]
struct Moment {
    step: Step,
    reward: u64,
    earned: u64,
    places: Vec<[u32; 3]>,
    features: Vec<u32>,
    pictures: (Vec<u8>, Vec<u32>, Vec<u16>, Vec<u32>),
    state: String,
}

fn moment(environment: &mut Environment, step: Step) -> Moment {
    let place = |[x, y]: [f32; 2], heading: f32| [x, y, heading].map(f32::to_bits);
    let agent = environment.agent();
    let mut places = vec![place(agent.position, agent.heading_deg)];
    places.extend(
        environment
            .objects()
            .iter()
            .map(|own| place(own.position, own.heading_deg)),
    );
    let frame = environment.observe();
    let depth = frame.depth.iter().map(|metres| metres.to_bits()).collect();
    let pictures = (frame.rgb.clone(), depth, frame.class.clone(), frame.instance.clone());
    Moment {
        reward: step.reward.to_bits(),
        earned: environment.episode_return().to_bits(),
        places,
        features: environment
            .state_vector()
            .iter()
            .map(|number| number.to_bits())
            .collect(),
        pictures,
        state: environment.state().to_json(),
        step,
    }
}

/// The agent's behaviour after the world was saved.
#[derive(Clone, Copy, Debug)]
enum Then {
    /// The expert continues to the goal and plans from the current state.
    Expert,
    /// Random actions, until the energy is used up or the goal happens to be touched.
    Anything(u64),
}

fn then() -> impl Strategy<Value = Then> {
    prop_oneof![Just(Then::Expert), any::<u64>().prop_map(Then::Anything)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn puzzle_resumes_from_its_document_bit_for_bit(
        start in 0usize..9,
        lies in 0usize..12,
        on_rails in any::<bool>(),
        frame_skip in 1u32..4,
        then in then(),
    ) {
        let model = if on_rails { ActionModel::OnRails } else { ActionModel::ByVelocity };
        let world = with_half_the_energy(corridor(start, lies, model, frame_skip));
        let mut environment = begin(&world);
        run_until_door_is_open(&mut environment);
        let energy = f64::from(environment.state_vector()[6]);
        prop_assert!((energy - MAX_ENERGY / 2.0).abs() < 1e-3, "{energy} is half of the energy");

        let text = environment.state().to_json();
        let read = World::from_json("state", &text).map_err(|error| TestCaseError::fail(error.to_string()))?;
        prop_assert!(read.progress.is_some());
        let mut resumed = Environment::new(read);
        prop_assert_eq!(resumed.state().to_json(), text, "saving the resumed world gives the same document");
        prop_assert_eq!(resumed.observe().rgb.clone(), environment.observe().rgb.clone());

        let mut agent: Box<dyn Agent> = match then {
            Then::Expert => Box::new(OnRailsAgent::new()),
            Then::Anything(seed) => Box::new(RandomAgent::new(seed)),
        };
        loop {
            // One agent acts in both: only the worlds are compared.
            let action = agent.act(&environment);
            let step = environment.step(action).expect("the episode continues");
            let other = resumed.step(action).expect("the episode continues");
            let (here, there) = (moment(&mut environment, step), moment(&mut resumed, other));
            prop_assert_eq!(&here, &there, "after {} s", environment.seconds());
            if let Some(end) = here.step.ended_by {
                prop_assert!(matches!(end, EndedBy::Touch | EndedBy::Energy), "{end:?}");
                if on_rails || matches!(then, Then::Expert) {
                    prop_assert_eq!(end, EndedBy::Touch);
                }
                break;
            }
        }
        prop_assert_eq!(resumed.step(Action::Continuous([0.0; 3])), environment.step(Action::Continuous([0.0; 3])));
    }
}

/// The test above would fail if the saved document lacked any of the three.
#[test]
fn door_key_and_energy_each_affect_the_resumed_world() {
    let world = with_half_the_energy(corridor(0, 0, ActionModel::ByVelocity, 1));
    let mut environment = begin(&world);
    run_until_door_is_open(&mut environment);
    let state = environment.state();
    let progress = state.progress.as_ref().expect("a state has progress");
    assert_eq!(progress.objects[LOCKED].open, Some(true));
    assert!(progress.objects[LOCKED].unlocked && progress.objects[LOCKED].closes_at.is_some());
    assert_eq!(progress.carried, [KEY as u32]);
    assert!(
        progress
            .energy
            .is_some_and(|energy| (energy - MAX_ENERGY / 2.0).abs() < 1e-6)
    );
    let course = |change: fn(&mut WorldDraft)| {
        let mut draft = state.clone().into_draft();
        change(&mut draft);
        let mut environment = begin(&draft);
        let mut expert = OnRailsAgent::new();
        let mut course = Vec::new();
        while !environment.ended() {
            let action = expert.act(&environment);
            let step = environment.step(action).expect("the episode continues");
            course.push((environment.state_vector().clone(), step.ended_by));
        }
        course
    };
    let whole = course(|_| ());
    assert_eq!(whole.last().map(|(_, end)| *end), Some(Some(EndedBy::Touch)));
    for (number, change) in [
        (|draft| progress_of(draft).objects[LOCKED].open = None) as fn(&mut WorldDraft),
        |draft| progress_of(draft).carried.clear(),
        |draft| progress_of(draft).energy = Some(0.1),
    ]
    .into_iter()
    .enumerate()
    {
        assert_ne!(course(change), whole, "change {number}");
    }
}

fn progress_of(draft: &mut WorldDraft) -> &mut driftworld_spec::Progress {
    draft.progress.as_mut().expect("a state has progress")
}
