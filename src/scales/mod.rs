//! Measures the scale of rewards in each variant: the floor, reached by agents that know nothing, and the ceiling, reached by one
//! that knows the map. [`ScalesFile`] reads scales from files.

mod file;
mod unlabelled;

use std::collections::BTreeMap;
use std::convert::Infallible;
use std::path::PathBuf;

use clap::Args;
use driftworld_curriculum::{MOST_STEPS, log_name};
use driftworld_env::{Agent, Catalogue, Environment, OnRailsAgent, RandomAgent, StillAgent};
use driftworld_generator::Sampler;
use driftworld_spec::{Variant, World};
use rayon::prelude::*;

pub use file::{AgentLevel, ScalesFile, VariantScale};
pub use unlabelled::{BestAgent, UnlabelledCeiling};

use crate::{Failure, libraries, numbers, tasks};

/// Default number of worlds per agent.
pub const DEFAULT_SCALES_WORLDS: u64 = 50;

/// Maximum number of worlds per agent.
pub const MAX_SCALES_WORLDS: u64 = 10_000;

/// The agents for the floor: they know nothing about a variant.
const FLOOR: [&str; 2] = ["random", "still"];

/// The agent for the ceiling: it knows the map and the rewards.
const CEILING: &str = "onrails";

/// What is measured: the arguments of `driftworld scales`. There are 2 to [`MAX_SCALES_WORLDS`] worlds of each variant.
#[derive(Args, Clone, Debug, PartialEq)]
#[group(skip)]
pub struct ScalesRequest {
    /// Variants, or tasks, which stand for all their variants [default: the built-in tasks].
    #[arg(value_name = "TASK")]
    pub tasks: Vec<String>,
    /// Worlds of each variant.
    #[arg(long, value_name = "N", default_value_t = DEFAULT_SCALES_WORLDS,
        value_parser = clap::value_parser!(u64).range(2..=MAX_SCALES_WORLDS))]
    pub worlds: u64,
    /// Seed of the worlds.
    #[arg(long, default_value_t = 0, allow_negative_numbers = true, value_parser = numbers::seed)]
    pub seed: u64,
    /// Also measure the ceiling of agents that cannot tell apart variants that look alike at the start.
    ///
    /// For each set of the variants above that look alike, or for the set named. Repeatable. It is the highest mean
    /// reward over the set among some scripted agents: one that stands still, one that acts at random, the planner of
    /// each variant, and that planner until a reward reveals another variant. Without the last, it is the ceiling of
    /// agents without memory.
    #[arg(long, num_args = 0..=1, require_equals = true, default_missing_value = "", value_parser = names, value_name = "VARIANT,…")]
    pub unlabelled: Vec<Vec<String>>,
    /// An asset library to search before the built-in assets. Repeatable.
    ///
    /// The last one given is searched first.
    #[arg(long = "assets", value_name = "LIBRARY")]
    pub libraries: Vec<PathBuf>,
}

/// Parses names separated by commas; an empty text contains none.
#[expect(clippy::unnecessary_wraps, reason = "the signature of a clap value parser")]
fn names(set: &str) -> Result<Vec<String>, Infallible> {
    let names = set.split(',').filter(|name| !name.is_empty());
    Ok(names.map(str::to_owned).collect())
}

/// Runs three agents in the same worlds of each variant: one acts at random, one stands still, and one knows the map. The
/// better of the first two gives the floor, the third the ceiling. `progress` is called after each variant.
///
/// For each set of variants in `unlabelled`, further agents run in all of them: one stands still, one acts at random, one acts
/// as the expert of a fixed variant, and one does so until a reward reveals another variant of the set. There are two ceilings,
/// each the highest mean over the set: that of the agents that act alike in all variants, and that of all agents. These are the
/// best known agents; better ones may exist.
///
/// # Errors
/// [`Failure`] if a task or variant is missing or invalid, a world cannot be drawn, or the number of worlds is out of range.
pub fn scales(request: &ScalesRequest, progress: &(dyn Fn() + Sync)) -> Result<ScalesFile, Failure> {
    if !(2..=MAX_SCALES_WORLDS).contains(&request.worlds) {
        return Err(Failure::usage(format!(
            "worlds: found {}, expected 2 to {MAX_SCALES_WORLDS}",
            request.worlds
        )));
    }
    let catalogue = libraries::catalogue(&request.libraries)?;
    let variants = tasks::variants_of(&request.tasks)?;
    tasks::check_variants(variants.iter().map(|(_, variant)| variant), &catalogue)?;
    let measure = |(_, variant): &(String, Variant)| {
        let found = of_variant(variant, request, &catalogue)?;
        progress();
        Ok((log_name(variant.task().name(), variant.name()), found))
    };
    let sets = unlabelled::sets_of(&variants, request, &catalogue)?;
    let measured: Result<Vec<_>, Failure> = variants.par_iter().map(measure).collect();
    let unlabelled: Result<Vec<_>, Failure> = (sets.iter())
        .map(|set| unlabelled::ceiling(set, request, &catalogue))
        .collect();
    Ok(ScalesFile {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        worlds: request.worlds,
        seed: request.seed,
        scales: measured?.into_iter().collect(),
        unlabelled: unlabelled?,
    })
}

/// Number of variants in a request.
///
/// # Errors
/// As [`scales`].
pub fn num_variants(request: &ScalesRequest) -> Result<usize, Failure> {
    Ok(tasks::variants_of(&request.tasks)?.len())
}

fn of_variant(variant: &Variant, request: &ScalesRequest, catalogue: &Catalogue) -> Result<VariantScale, Failure> {
    let sampler = Sampler::new(variant, request.seed);
    let worlds = (0..request.worlds).map(|index| sampler.world(index));
    let worlds: Vec<World> = worlds.collect::<Result<_, _>>()?;
    let mut agents: BTreeMap<String, AgentLevel> = BTreeMap::new();
    for (name, mut agent) in agents_of_scales() {
        let mut episodes = Vec::new();
        for (index, world) in (0..).zip(&worlds) {
            agent.begin(agent_seed(request, index));
            episodes.push(episode(agent.as_mut(), world, catalogue)?);
        }
        agents.insert(name.to_owned(), AgentLevel::of(&episodes));
    }
    let level = |name: &str| agents.get(name).map_or(f64::NAN, |level| level.mean);
    Ok(VariantScale {
        variant: variant.id(),
        floor: FLOOR.into_iter().map(level).fold(f64::NEG_INFINITY, f64::max),
        ceiling: level(CEILING),
        agents,
    })
}

/// The seed of an agent's random numbers: different for every world index, but the same in every variant.
fn agent_seed(request: &ScalesRequest, index: u64) -> u64 {
    request.seed.rotate_left(32) ^ index
}

fn agents_of_scales() -> [(&'static str, Box<dyn Agent>); 3] {
    [
        (FLOOR[0], Box::new(RandomAgent::new(0))),
        (FLOOR[1], Box::new(StillAgent)),
        (CEILING, Box::new(OnRailsAgent::new())),
    ]
}

/// Runs an agent's episode in a world; returns the reward, and whether it succeeded.
fn episode(agent: &mut dyn Agent, world: &World, catalogue: &Catalogue) -> Result<(f64, bool), Failure> {
    let mut environment = Environment::with_catalogue(world.clone(), catalogue.clone());
    let mut success = false;
    while !environment.ended() && environment.num_steps() < MOST_STEPS {
        let action = agent.act(&environment);
        success = environment.step(action)?.success;
    }
    Ok((environment.episode_return(), success))
}

#[cfg(test)]
mod tests;
