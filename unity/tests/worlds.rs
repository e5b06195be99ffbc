//! Sessions in unusual worlds: with action tables, photographs, custom models or unknown objects.

use std::collections::BTreeMap;

use driftworld_env::{
    Action, Catalogue, ColliderKind, Environment, ImportOptions, ImportSize, Library, LibraryModel, Studio,
};
use driftworld_spec::{ActionSpace, GameMode, ImageParams, Object, WorldDraft};
use driftworld_unity::protocol::ListAgentActionProto;
use driftworld_unity::protocol::ObservationData;
use driftworld_unity::protocol::{
    AgentActionProto, AgentInfoProto, CommandProto, SpaceTypeProto, UnityOutputProto, UnityRlCapabilitiesProto,
    UnityRlInitializationInputProto, UnityRlInputProto,
};
use driftworld_unity::{BEHAVIOR, PictureForm, Screenshots, Session, Setup, Turn};
use proptest::prelude::*;

/// A session with a client of the first generation, or of the latest.
fn session(world: WorldDraft, catalogue: Catalogue, is_new: bool) -> Session {
    let setup = Setup {
        world: world.check().expect("the world is valid"),
        catalogue,
        pictures: PictureForm::Floats,
        ..Setup::default()
    };
    let clock = || "2026-01-01T00:00:00Z".to_owned();
    let mut session = Session::new(setup, Screenshots::new("none"), clock);
    let identity = UnityRlInitializationInputProto {
        communication_version: "1.0.0".to_owned(),
        package_version: if is_new { "1.1.0" } else { "0.16.0" }.to_owned(),
        capabilities: Some(UnityRlCapabilitiesProto {
            hybrid_actions: is_new,
            ..UnityRlCapabilitiesProto::default()
        }),
        ..UnityRlInitializationInputProto::default()
    };
    session.begin(&identity).expect("the client uses version 1");
    session
}

fn answer(session: &mut Session, command: CommandProto, action: Option<AgentActionProto>) -> UnityOutputProto {
    let agent_actions = action.map(|action| (BEHAVIOR.to_owned(), ListAgentActionProto { value: vec![action] }));
    let input = UnityRlInputProto {
        command: command.into(),
        agent_actions: agent_actions.into_iter().collect::<BTreeMap<_, _>>(),
        ..UnityRlInputProto::default()
    };
    match session.answer(&input).expect("the command is valid") {
        Turn::Output(output) => *output,
        Turn::Quit => panic!("unexpected quit"),
    }
}

fn agents(output: &UnityOutputProto) -> &[AgentInfoProto] {
    &output.rl_output.as_ref().expect("there is an agent").agent_infos[BEHAVIOR].value
}

fn floats(agent: &AgentInfoProto, index: usize) -> &[f32] {
    match &agent.observations[index].observation_data {
        Some(ObservationData::FloatData(floats)) => &floats.data,
        other => panic!("expected floats: {other:?}"),
    }
}

/// An action that chooses a row, as clients of either generation send it.
fn row(number: usize, is_new: bool) -> AgentActionProto {
    let (vector_actions, discrete_actions) = if is_new {
        (Vec::new(), vec![number as i32])
    } else {
        (vec![number as f32], Vec::new())
    };
    AgentActionProto {
        vector_actions,
        discrete_actions,
        ..AgentActionProto::default()
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn action_rows_have_the_same_effect_as_in_the_environment(
        table in proptest::option::of(proptest::collection::vec([-10.0..=10.0f64, -90.0..=90.0, 0.0..=1.0], 1..5)),
        rows in proptest::collection::vec(any::<proptest::sample::Index>(), 1..12),
        is_new in any::<bool>(),
    ) {
        let mut world = WorldDraft::default();
        world.agent_params.observation_size = 4;
        world.agent_params.actions = table.map_or(ActionSpace::DefaultDiscrete, ActionSpace::Discrete);
        let count = world.agent_params.num_actions().expect("there is a table");
        let mut environment = Environment::new(world.clone().check().expect("the world is valid"));
        let mut session = session(world, Catalogue::default(), is_new);
        let first = answer(&mut session, CommandProto::Reset, None);
        let behavior = &first.rl_initialization_output.expect("the first reply describes the behaviour").brain_parameters[0];
        prop_assert_eq!(behavior.vector_action_space_type, i32::from(SpaceTypeProto::Discrete));
        prop_assert_eq!(&behavior.vector_action_size, &vec![count as i32]);
        prop_assert_eq!(behavior.action_spec.is_some(), is_new);
        if let Some(spec) = &behavior.action_spec {
            prop_assert_eq!((spec.num_continuous_actions, spec.num_discrete_actions), (0, 1));
            prop_assert_eq!(&spec.discrete_branch_sizes, &vec![count as i32]);
        }
        for number in rows {
            let number = number.index(count);
            environment.step(Action::Discrete(number)).expect("the row exists");
            let output = answer(&mut session, CommandProto::Step, Some(row(number, is_new)));
            prop_assert_eq!(&floats(&agents(&output)[0], 3)[1..], environment.state_vector());
        }
    }
}

#[test]
fn unknown_rows_and_wrong_lengths_are_refused() {
    let mut world = WorldDraft::default();
    world.agent_params.actions = ActionSpace::DefaultDiscrete;
    let refused = |action: AgentActionProto| {
        let mut session = session(world.clone(), Catalogue::default(), true);
        let list = ListAgentActionProto { value: vec![action] };
        let input = UnityRlInputProto {
            agent_actions: BTreeMap::from([(BEHAVIOR.to_owned(), list)]),
            ..UnityRlInputProto::default()
        };
        session.answer(&input).expect_err("there is no such action").to_string()
    };
    let expected = "expected the number of a row of the world's action table, 0 to 6";
    assert_eq!(refused(row(7, true)), format!("action: found 7, {expected}"));
    for (number, identity) in [(-1.0, "-1"), (0.5, "0.5"), (f32::NAN, "NaN")] {
        let action = AgentActionProto {
            vector_actions: vec![number],
            ..AgentActionProto::default()
        };
        assert_eq!(refused(action), format!("action: found {identity}, {expected}"));
    }
    let three = AgentActionProto {
        continuous_actions: vec![0.0; 3],
        ..AgentActionProto::default()
    };
    assert_eq!(refused(three), "action: found 3 numbers, expected 1");
}

#[test]
fn photographs_are_shown_one_per_step_until_the_last() {
    let mut barrel = Object::new("barrel", [3.0, 4.0]);
    barrel.heading = 90.0;
    let mut world = WorldDraft {
        game_mode: GameMode::CollectImages,
        image_params: Some(ImageParams {
            zoom: 1.5,
            yaw_subdivisions: 3,
            vertical_subdivisions: 2,
        }),
        objects: vec![Object::new("car", [-20.0, 0.0]), barrel],
        ..WorldDraft::default()
    };
    world.agent_params.observation_size = 12;
    let mut studio =
        Studio::new(&world.clone().check().expect("the world is valid")).expect("there are twelve photographs");
    let views = studio.photographs();
    let mut session = session(world, Catalogue::default(), true);
    let mut output = answer(&mut session, CommandProto::Reset, None);
    for view in &views {
        let agent = &agents(&output)[0];
        assert!(!agent.done);
        let mut frame = driftworld_env::Frame::new(12, 12);
        studio
            .take(view, &mut frame.target())
            .expect("the view belongs to this studio");
        let rgb = floats(agent, 1);
        // Channels first, as the latest generation expects.
        let expected: Vec<f32> = (0..3)
            .flat_map(|channel| {
                frame
                    .rgb
                    .iter()
                    .skip(channel)
                    .step_by(3)
                    .map(|byte| f32::from(*byte) / 255.0)
            })
            .collect();
        assert_eq!(rgb, expected, "{view:?}");
        let state = floats(agent, 3);
        assert_eq!((state[0], state.len()), ((view.object + 1) as f32, 6));
        output = answer(&mut session, CommandProto::Step, None);
    }
    let [last, next] = agents(&output) else {
        panic!("{output:?}")
    };
    assert!(last.done && last.max_step_reached && !next.done);
    assert_eq!(
        (floats(last, 3)[0], floats(next, 3)[0]),
        (2.0, 1.0),
        "after the last photograph comes the first"
    );
    // The barrel faces east, so the camera of its first photograph is east of it and looks west.
    let mut output_again = answer(&mut session, CommandProto::Reset, None);
    for _ in 0..6 {
        output_again = answer(&mut session, CommandProto::Step, None);
    }
    let state = floats(&agents(&output_again)[0], 3);
    assert!(
        state[1] > 3.5 && (state[2] - 4.0).abs() < 1e-3 && (state[3] - 270.0).abs() < 1e-3,
        "{state:?}"
    );
}

#[test]
fn world_without_objects_to_photograph_gives_a_remark_and_runs() {
    let world = WorldDraft {
        game_mode: GameMode::CollectImages,
        ..WorldDraft::default()
    };
    let mut session = session(world, Catalogue::default(), false);
    let remarks = session.take_remarks();
    assert_eq!(
        remarks,
        ["collect_images: found no objects, expected some to photograph; the world runs as in mode learn"]
    );
    let output = answer(&mut session, CommandProto::Reset, None);
    assert!(!agents(&output)[0].done);
}

#[test]
fn library_models_are_drawn_and_unknown_ones_give_a_remark() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../examples/assets/lighthouse.gltf");
    let bytes = std::fs::read(path).expect("the example file exists");
    let options = ImportOptions {
        class: "lighthouse".into(),
        name: "1".into(),
        size: ImportSize::Scale(1.0),
        collider: ColliderKind::Cylinder,
        main: None,
    };
    let imported = LibraryModel::from_gltf(&bytes, &options, &mut |_| {
        unreachable!("the model refers to no other file")
    })
    .expect("the example is a valid model");
    let mut library = Library::default();
    library
        .insert(imported.model)
        .expect("the library has room for a model");
    let mut world = WorldDraft::with_objects(vec![
        Object::new("lighthouse", [0.0, 12.0]),
        Object::new("dragon", [5.0, 9.0]),
    ]);
    world.agent_params.observation_size = 32;
    let seen = |catalogue: Catalogue| {
        let mut session = session(world.clone(), catalogue, false);
        let remarks = session.take_remarks();
        let output = answer(&mut session, CommandProto::Reset, None);
        (floats(&agents(&output)[0], 1).to_vec(), remarks)
    };
    let (placeholder, remarks_for_both) = seen(Catalogue::default());
    let (model, remarks_for_one) = seen(Catalogue::default().with_library(&library));
    assert_ne!(placeholder, model);
    assert_eq!(
        remarks_for_one,
        ["world: /objects/1: class \"dragon\" model \"1\" is not known; a placeholder is shown"]
    );
    assert_eq!(remarks_for_both.len(), 2, "{remarks_for_both:?}");
}
