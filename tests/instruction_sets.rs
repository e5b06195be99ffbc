//! Tests that pictures do not depend on the CPU's instruction set, in all families and along the planner's paths.

use driftworld::env::{Agent, CpuRenderer, Environment, Frame, OnRailsAgent};
use driftworld::{generator, tasks};

use crate::tier::quick_or_full;

/// Widths that are multiples of each vector's length, and others.
const SIZES: [[u32; 2]; 6] = [[160, 120], [84, 84], [101, 77], [90, 60], [33, 32], [7, 9]];

/// Compares the pictures of each instruction set along the first steps of a variant's world; returns the number of steps.
fn compare(name: &str, index: usize, sizes: &[[u32; 2]], steps: usize) -> usize {
    let task = tasks::task(name).expect("it is built in");
    let variants = task.all_variants();
    let variant = &variants[index % variants.len()];
    let world = generator::sample(variant, 3, index as u64).expect("it can be drawn");
    let (mut environment, mut agent) = (Environment::new(world), OnRailsAgent::new());
    let mut compared = 0;
    for (step, &[width, height]) in sizes.iter().cycle().take(steps).enumerate() {
        let action = agent.act(&environment);
        let ended = environment.step(action).expect("the action is valid").ended();
        let mut frames = CpuRenderer::each_instruction_set()
            .into_iter()
            .map(|(set, mut renderer)| {
                let mut frame = Frame::new(width, height);
                renderer.render(environment.scene(), &environment.camera(), &mut frame);
                (set, frame)
            });
        let (_, portable) = frames.next().expect("every CPU has a portable instruction set");
        for (set, frame) in frames {
            let same =
                frame.rgb == portable.rgb && frame.depth == portable.depth && frame.instance == portable.instance;
            assert!(same, "{}, step {step}, {width} × {height}: {set}", variant.id());
        }
        compared += 1;
        if ended {
            break;
        }
    }
    compared
}

#[test]
fn pictures_do_not_depend_on_instructions() {
    // Ground behind a door, darkened at the foot of the wall, was once too bright with the narrowest vectors.
    assert_eq!(compare("key_corridor", 2, &[[160, 120]], 25), 25);
    // A point of a wall exactly as far from its foot as the darkening reaches, to the last bit.
    assert_eq!(compare("obstacle_course", 7, &[[320, 240]], 38), 38);
    let names: Vec<&str> = tasks::groups()
        .flat_map(|(_, names)| names)
        .map(|(name, _)| *name)
        .collect();
    let (variants, steps) = (quick_or_full(1, 6), quick_or_full(6, 60));
    for name in names {
        for index in 0..variants {
            assert!(compare(name, index, &SIZES, steps) > 0, "{name}");
        }
    }
}
