//! Benchmarks of a session's commands, without a network: a step with its images in both forms, and a reset.

#![expect(clippy::disallowed_methods, reason = "only its speed is measured")]

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use driftworld_spec::{Object, World, WorldDraft};
use driftworld_unity::protocol::{
    AgentActionProto, CommandProto, ListAgentActionProto, UnityRlInitializationInputProto, UnityRlInputProto,
};
use driftworld_unity::{BEHAVIOR, PictureForm, Screenshots, Session, Setup};

/// Twenty objects in a ring, in which the agent drives in a circle.
fn ring() -> World {
    let kinds = ["tree", "barrel", "chair", "rock", "geometric"];
    let object = |number: u32| {
        let angle = f64::from(number) * std::f64::consts::TAU / 20.0;
        Object::new(
            kinds[number as usize % kinds.len()],
            [12.0 * angle.cos(), 12.0 * angle.sin()],
        )
    };
    let world = WorldDraft::with_objects((0..20).map(object).collect());
    world.check().expect("the world is valid")
}

fn session(pictures: PictureForm) -> Session {
    let setup = Setup {
        world: ring(),
        pictures,
        ..Setup::default()
    };
    let clock = || "2026-01-01T00:00:00Z".to_owned();
    let mut session = Session::new(setup, Screenshots::new("screenshots"), clock);
    session
        .begin(&UnityRlInitializationInputProto {
            communication_version: "1.0.0".to_owned(),
            ..UnityRlInitializationInputProto::default()
        })
        .expect("the version is 1");
    session
}

fn commands(c: &mut Criterion) {
    let action = AgentActionProto {
        vector_actions: vec![5.0, 15.0, 0.0],
        ..AgentActionProto::default()
    };
    let mut step = UnityRlInputProto::default();
    step.agent_actions
        .insert(BEHAVIOR.to_owned(), ListAgentActionProto { value: vec![action] });
    let reset = UnityRlInputProto {
        command: CommandProto::Reset.into(),
        ..UnityRlInputProto::default()
    };
    for (form, name) in [(PictureForm::Png, "PNG"), (PictureForm::Floats, "floats")] {
        let mut session = session(form);
        c.bench_function(&format!("a step with three pictures of 84 × 84 as {name}"), |bench| {
            bench.iter(|| black_box(session.answer(&step).expect("the world has no end")));
        });
    }
    let mut session = session(PictureForm::Png);
    c.bench_function("a reset of 20 objects with three pictures as PNG", |bench| {
        bench.iter(|| black_box(session.answer(&reset).expect("a world can always be reset")));
    });
}

criterion_group!(benches, commands);
criterion_main!(benches);
