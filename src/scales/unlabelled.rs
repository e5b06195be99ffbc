//! Measures ceilings of agents that cannot know the variant, because neither their first view nor a label reveals it.

use std::collections::BTreeMap;

use driftworld_curriculum::{MOST_STEPS, log_name};
use driftworld_env::{Agent, Catalogue, Environment, Expertise, RandomAgent, StillAgent};
use driftworld_generator::Sampler;
use driftworld_spec::{Modality, Object, Rules, Variant, World};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::{AgentLevel, ScalesRequest, episode};
use crate::{Failure, tasks};

/// Number of worlds in which the first pictures are compared.
const PICTURES: u64 = 5;

/// The best known rewards of agents that cannot know which of these variants they are in.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct UnlabelledCeiling {
    /// The variants, equally likely, by their names in logs.
    pub among: Vec<String>,
    /// The best agent that acts alike in all of them, such as an agent without memory.
    pub fixed: BestAgent,
    /// The best agent that may also infer the variant from rewards within an episode.
    pub finds_out: BestAgent,
}

/// The agent with the highest mean over a set of variants.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BestAgent {
    /// Description of the agent.
    #[serde(default)]
    pub agent: String,
    /// Its results in each of the variants.
    pub levels: BTreeMap<String, AgentLevel>,
}

impl BestAgent {
    /// Its mean reward over the variants.
    pub fn mean(&self) -> f64 {
        self.levels.values().map(|level| level.mean).sum::<f64>() / self.levels.len().max(1) as f64
    }
}

/// A candidate agent.
#[derive(Clone, Copy)]
enum Candidate {
    /// Stands still.
    Still,
    /// Acts at random.
    Random,
    /// The expert of one variant throughout.
    Fixed(usize),
    /// The expert of one variant until a reward reveals a different one.
    FindsOut(usize),
}

impl Candidate {
    fn all(num_variants: usize) -> impl Iterator<Item = Self> {
        let experts = (0..num_variants).flat_map(|own| [Self::Fixed(own), Self::FindsOut(own)]);
        [Self::Still, Self::Random].into_iter().chain(experts)
    }

    fn is_fixed(self) -> bool {
        !matches!(self, Self::FindsOut(_))
    }

    fn name(self, variants: &[&Variant]) -> String {
        match self {
            Self::Still => "stands still".to_owned(),
            Self::Random => "acts at random".to_owned(),
            Self::Fixed(own) => format!("planner of {}", variants[own].id()),
            Self::FindsOut(own) => format!("planner of {} until a reward shows another", variants[own].id()),
        }
    }

    /// Runs the agent in the world at `index`; `worlds` contains one of each variant. Returns the reward, and whether it
    /// succeeded.
    fn run(self, worlds: &[World], index: usize, seed: u64, expertise: &Expertise) -> Result<(f64, bool), Failure> {
        let (abroad, catalogue) = (&worlds[index], &expertise.catalogue);
        let found = match self {
            Self::Still => return episode(&mut StillAgent, abroad, catalogue),
            Self::Random => {
                let mut agent = RandomAgent::new(0);
                agent.begin(seed);
                return episode(&mut agent, abroad, catalogue);
            }
            Self::Fixed(own) => expertise.abroad(&worlds[own], abroad)?,
            Self::FindsOut(own) => {
                let homes: Vec<&World> = worlds[own..].iter().chain(&worlds[..own]).collect();
                expertise.finding_out(&homes, abroad)?
            }
        };
        Ok((found.earned, found.success))
    }
}

/// The requested sets: sets of named variants, or all sets of measured variants that look alike.
///
/// # Errors
/// [`Failure`] if a named variant is not measured, is alone in its set, or does not look like the others.
pub(super) fn sets_of<'a>(
    variants: &'a [(String, Variant)],
    request: &ScalesRequest,
    catalogue: &Catalogue,
) -> Result<Vec<Vec<&'a Variant>>, Failure> {
    let mut sets: Vec<Vec<&Variant>> = Vec::new();
    for names in &request.unlabelled {
        let found = if names.is_empty() {
            alike_sets(variants, request, catalogue)?
        } else {
            vec![named_set(names, variants, request, catalogue)?]
        };
        let ids = |set: &[&Variant]| set.iter().map(|variant| variant.id()).collect::<Vec<_>>();
        for set in found {
            if sets.iter().all(|known| ids(known) != ids(&set)) {
                sets.push(set);
            }
        }
    }
    Ok(sets)
}

/// All sets of at least two variants that look alike.
fn alike_sets<'a>(
    variants: &'a [(String, Variant)],
    request: &ScalesRequest,
    catalogue: &Catalogue,
) -> Result<Vec<Vec<&'a Variant>>, Failure> {
    let mut sets: Vec<Vec<&Variant>> = Vec::new();
    for (_, variant) in variants {
        let mut own = None;
        for (index, set) in sets.iter().enumerate() {
            let is_of_task = set[0].task().name() == variant.task().name();
            if is_of_task && visible_difference(set[0], variant, request, catalogue)?.is_none() {
                own = Some(index);
                break;
            }
        }
        match own {
            Some(index) => sets[index].push(variant),
            None => sets.push(vec![variant]),
        }
    }
    sets.retain(|set| set.len() > 1);
    Ok(sets)
}

/// The set of variants with these names, which must look alike.
fn named_set<'a>(
    names: &[String],
    variants: &'a [(String, Variant)],
    request: &ScalesRequest,
    catalogue: &Catalogue,
) -> Result<Vec<&'a Variant>, Failure> {
    let wrong = |text: String| Failure::in_argument("unlabelled", text);
    let mut set: Vec<&Variant> = Vec::new();
    // The names may omit their tasks.
    let full_names = tasks::with_tasks(&[request.tasks.as_slice(), names].concat());
    for (_, variant) in tasks::variants_of(&full_names[request.tasks.len()..])? {
        let known = variants.iter().find(|(_, known)| known.id() == variant.id());
        let (_, known) = known.ok_or_else(|| {
            wrong(format!(
                "found {}, expected variants that are measured: name it as a TASK, too",
                variant.id()
            ))
        })?;
        if let Some(first) = set.first()
            && let Some(what) = visible_difference(first, known, request, catalogue)?
        {
            return Err(wrong(format!(
                "found {} and {}, which {what}, expected variants that look alike at the start; the ceiling of those \
                 that can be told apart is the planner's",
                first.id(),
                known.id()
            )));
        }
        set.push(known);
    }
    if set.len() < 2 {
        return Err(wrong(format!(
            "found {} alone, expected two variants or more",
            names.join(", ")
        )));
    }
    Ok(set)
}

/// What distinguishes two variants before any reward; `None` if nothing does.
fn visible_difference(
    a: &Variant,
    b: &Variant,
    request: &ScalesRequest,
    catalogue: &Catalogue,
) -> Result<Option<&'static str>, Failure> {
    let (sampler_a, sampler_b) = (Sampler::new(a, request.seed), Sampler::new(b, request.seed));
    for index in 0..request.worlds {
        let (a, b) = (sampler_a.world(index)?, sampler_b.world(index)?);
        if unpaid(&a)? != unpaid(&b)? {
            return Ok(Some("differ in more than their rewards"));
        }
        if index < PICTURES && first_picture(&a, catalogue) != first_picture(&b, catalogue) {
            return Ok(Some("have different first pictures"));
        }
    }
    Ok(None)
}

/// A world without rewards, their conditions, and end conditions of episodes.
fn unpaid(world: &World) -> Result<World, Failure> {
    let bare = world.clone().edit(|world| {
        world.rules = Rules::default();
        for object in &mut world.objects {
            let plain = Object::new(object.class.clone(), object.coordinates);
            object.reward = plain.reward;
            object.reward_probability = plain.reward_probability;
            object.reward_stimulus = plain.reward_stimulus;
            object.reward_once_stimulus = plain.reward_once_stimulus;
            object.range_stimulus_distance = plain.range_stimulus_distance;
            object.order = plain.order;
            object.tag = plain.tag;
        }
    });
    Ok(bare?)
}

/// The agent's first view: colours and, if the world's agent sees them, reward categories.
fn first_picture(world: &World, catalogue: &Catalogue) -> (Vec<u8>, Vec<u8>) {
    let shows_pay = world.agent_params.modalities.contains(&Modality::Segmentation);
    let mut environment = Environment::with_catalogue(world.clone(), catalogue.clone());
    let frame = environment.observe();
    let pay = if shows_pay { frame.category.clone() } else { Vec::new() };
    (frame.rgb.clone(), pay)
}

/// Runs every candidate in the same worlds of each variant of a set, and picks the candidates with the highest mean over variants.
///
/// # Errors
/// [`Failure`] if a world cannot be drawn.
pub(super) fn ceiling(
    set: &[&Variant],
    request: &ScalesRequest,
    catalogue: &Catalogue,
) -> Result<UnlabelledCeiling, Failure> {
    let expertise = Expertise {
        steps: MOST_STEPS,
        catalogue: catalogue.clone(),
    };
    let samplers: Vec<Sampler> = set.iter().map(|variant| Sampler::new(variant, request.seed)).collect();
    let in_worlds = |index: u64| -> Result<Vec<Vec<(f64, bool)>>, Failure> {
        let worlds: Vec<World> = samplers
            .iter()
            .map(|sampler| sampler.world(index))
            .collect::<Result<_, _>>()?;
        let of_agent = |agent: Candidate| {
            let of_variant = |variant| agent.run(&worlds, variant, super::agent_seed(request, index), &expertise);
            (0..set.len()).map(of_variant).collect()
        };
        Candidate::all(set.len()).map(of_agent).collect()
    };
    let of_worlds: Vec<_> = (0..request.worlds)
        .into_par_iter()
        .map(in_worlds)
        .collect::<Result<_, _>>()?;
    let among: Vec<String> = (set.iter())
        .map(|variant| log_name(variant.task().name(), variant.name()))
        .collect();
    let of_agent = |(number, agent): (usize, Candidate)| {
        let level = |variant: usize| {
            let episodes: Vec<_> = of_worlds.iter().map(|world| world[number][variant]).collect();
            AgentLevel::of(&episodes)
        };
        BestAgent {
            agent: agent.name(set),
            levels: among.iter().cloned().zip((0..set.len()).map(level)).collect(),
        }
    };
    let best = |fits: &dyn Fn(Candidate) -> bool| {
        let agents = Candidate::all(set.len()).enumerate().filter(|(_, agent)| fits(*agent));
        // Ties go to the first candidate, which knows least.
        let better = |best: BestAgent, other: BestAgent| if other.mean() > best.mean() { other } else { best };
        agents.map(of_agent).reduce(better).expect("there are candidates")
    };
    Ok(UnlabelledCeiling {
        fixed: best(&Candidate::is_fixed),
        finds_out: best(&|_| true),
        among,
    })
}
