//! Measures how fast environments step, render and reset, and how much memory one takes.

use std::sync::Arc;
use std::time::Duration;

use crate::env::{Action, Autoreset, Batch, BatchOptions, Environment, Renderer, RendererKind};
use crate::generator::Sampler;
use crate::spec::{Looks, Modality, Style, TaskSpec, World};
use serde_json::json;

use crate::Failure;

use super::{Figures, rate, rates};

/// 20 objects of 2,652 triangles spread over a walled arena of 100 × 100 m; rewards for touching and approaching.
const ARENA_20: &str = include_str!("arena_20.json");

/// The same arena with 8 objects.
const ARENA_8: &str = include_str!("arena_8.json");

/// A maze drawn for each world, with a goal. The agent starts at the centre of a cell.
const MAZE: &str = r#"{ "version": 2, "name": "maze",
    "world": {
        "environment_params": { "layout": { "maze": { "cells": [8, 8], "cell": 3, "height": 2.5, "braid": 0.2 } } },
        "agent_params": { "coordinates": [1.5, 1.5], "observation_size": 84,
                          "modalities": ["rgb", "depth", "segmentation"] } },
    "groups": [{ "name": "goal", "count": 1, "placement": { "points": { "values": [[10.5, 10.5]] } },
                 "object": { "class": "geometric", "scale": 0.4, "reward": 1, "reward_once_stimulus": ["AgentCollide"] } }] }"#;

/// Number of environments that step together: few enough that their pictures stay in the processor's cache.
const NUM_ENVS: usize = 16;

/// Number of environments shared by two cores: enough that scheduling does not matter.
const NUM_ENVS_TWO_CORES: usize = 256;

/// An action that moves the agent along a circle of 19 m radius between the objects.
const CURVE: Action = Action::Continuous([5.0, 15.0, 0.0]);

/// Number of environments for measuring memory.
const NUM_MEASURED: usize = 512;

/// Measures steps per second, with physics, rewards and pictures, and resets per second.
pub(crate) fn measure(round: Duration, renderer: RendererKind) -> Result<Figures, Failure> {
    if Renderer::new(renderer)?.kind() == RendererKind::Gpu {
        return measure_graphics(round);
    }
    let square = arena(ARENA_20, [84, 84])?;
    let wide = arena(ARENA_20, [160, 120])?;
    let small = in_color(arena(ARENA_8, [64, 64])?)?;
    let mazes = mazes()?;
    let small_maze = in_color(mazes.world(0)?.edit(|world| world.agent_params.observation_size = 64)?)?;
    let steps_of = |world: &World, num_envs, threads| steps(batch(world, num_envs, threads, RendererKind::Cpu)?, round);
    let one_core = |world: &World| steps_of(world, NUM_ENVS, 1);
    let natural = |world: &World| one_core(&in_natural_looks(world)?);
    let mut environment = Environment::new(square.clone());
    let mut figures = rates([
        ("steps_per_second_per_core_84", one_core(&square)?),
        ("steps_per_second_per_core_160x120", one_core(&wide)?),
        ("steps_per_second_per_core_64_rgb", one_core(&small)?),
        (
            "resets_per_second_per_core",
            rate(round, |_| {
                environment.reset(square.clone());
                Ok::<_, Failure>(())
            })?,
        ),
        ("steps_per_second_per_core_maze_84", one_core(&mazes.world(0)?)?),
        ("steps_per_second_per_core_84_natural", natural(&square)?),
        ("steps_per_second_per_core_maze_84_natural", natural(&mazes.world(0)?)?),
        ("steps_per_second_per_core_160x120_natural", natural(&wide)?),
        ("steps_per_second_per_core_maze_64_rgb", one_core(&small_maze)?),
        ("steps_per_second_per_core_maze_64_rgb_natural", natural(&small_maze)?),
        (
            "resets_per_second_per_core_maze",
            rate(round, |index| {
                environment.reset(mazes.world(index)?);
                Ok::<_, Failure>(())
            })?,
        ),
    ]);
    // Measure one core again, so that both measurements see the machine in the same state.
    let [two, one] = [2, 1].map(|num_threads| steps_of(&square, NUM_ENVS_TWO_CORES, num_threads));
    let (two, one) = (two?, one?);
    let speedup = (two / one * 100.0).round() / 100.0;
    figures.insert("two_core_speedup".to_owned(), json!(speedup));
    if let Some(kilobytes) = kilobytes_per_environment(&square)? {
        figures.insert("kilobytes_per_environment".to_owned(), json!(kilobytes));
    }
    Ok(figures)
}

/// Measures steps per second in batches on all threads, with pictures from a graphics card.
fn measure_graphics(round: Duration) -> Result<Figures, Failure> {
    let square = arena(ARENA_20, [84, 84])?;
    let colors = in_color(square.clone())?;
    let steps = |world: &World, num_envs| steps(batch(world, num_envs, 0, RendererKind::Gpu)?, round);
    Ok(rates([
        ("gpu_steps_per_second_84_batch_256", steps(&square, 256)?),
        ("gpu_steps_per_second_84_rgb_batch_256", steps(&colors, 256)?),
        ("gpu_steps_per_second_84_rgb_batch_1024", steps(&colors, 1024)?),
        ("gpu_steps_per_second_84_rgb_batch_4096", steps(&colors, 4096)?),
    ]))
}

/// Mazes of 8 × 8 cells with a goal and images of 84 × 84 pixels in colour, depth and segmentation; each world has a different
/// maze.
fn mazes() -> Result<Sampler, Failure> {
    let task = TaskSpec::from_json("maze.json", MAZE)?;
    Ok(Sampler::new(&task.variant("default")?, 7))
}

/// The world in natural looks: with surfaces, shadows, sky and, in mazes, a ceiling.
fn in_natural_looks(world: &World) -> Result<World, Failure> {
    let looks = Looks::of(Style::Natural);
    Ok(world.clone().edit(|world| world.environment_params.looks = looks)?)
}

/// The world with colour as its only modality.
fn in_color(world: World) -> Result<World, Failure> {
    Ok(world.edit(|world| world.agent_params.modalities = vec![Modality::Rgb])?)
}

/// An arena with colour, depth and class images of this width and height.
fn arena(text: &str, [width, height]: [u32; 2]) -> Result<World, Failure> {
    let world = World::from_json("arena.json", text)?;
    Ok(world.edit(|world| {
        world.agent_params.observation_size = height;
        world.agent_params.observation_width = (width != height).then_some(width);
        world.agent_params.modalities = vec![Modality::Rgb, Modality::Depth, Modality::Class];
    })?)
}

fn batch(world: &World, num_envs: usize, num_threads: usize, renderer: RendererKind) -> Result<Batch, Failure> {
    let world = world.clone();
    let options = BatchOptions {
        autoreset: Autoreset::NextStep,
        num_threads,
        renderer,
        ..BatchOptions::default()
    };
    Ok(Batch::new(num_envs, Arc::new(move |_| Ok(world.clone())), options)?)
}

/// Environment steps per second in a batch, summed over its environments.
fn steps(mut batch: Batch, round: Duration) -> Result<f64, Failure> {
    let num_envs = batch.num_envs();
    let mut actions = vec![Action::Continuous([0.0; 3]); num_envs];
    // Spread the agents along the circle: groups start one after the other.
    for group in 0..NUM_ENVS {
        actions[group * num_envs / NUM_ENVS..(group + 1) * num_envs / NUM_ENVS].fill(CURVE);
        for _ in 0..4 {
            batch.step(&actions)?;
        }
    }
    Ok(rate(round, |_| batch.step(&actions))? * num_envs as f64)
}

/// Memory in kilobytes that each of many environments adds to the process, including its images; `None` if the system does not
/// report it.
fn kilobytes_per_environment(world: &World) -> Result<Option<u64>, Failure> {
    let Some(before) = resident() else { return Ok(None) };
    let batch = batch(world, NUM_MEASURED, 1, RendererKind::Cpu)?;
    let after = resident().unwrap_or(before);
    drop(batch);
    Ok(Some(after.saturating_sub(before) / NUM_MEASURED as u64))
}

/// Resident memory of this process in kilobytes, on Linux.
fn resident() -> Option<u64> {
    // Read directly, not through driftworld-files: it is a system file, not one that a user names.
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmRSS:"))?;
    line.split_whitespace().nth(1)?.parse().ok()
}
