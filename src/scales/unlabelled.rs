//! Ceilings of agents that cannot know the variant: nothing that they see at the start tells it, and no label does. What
//! one agent does in one world is `env`'s.

use std::collections::BTreeMap;

use driftworld_curriculum::{MOST_STEPS, log_name};
use driftworld_env::{
    Agent, Catalogue, Environment, Expertise, RandomAgent, StillAgent, UNKNOWN_CLASS,
};
use driftworld_generator::Sampler;
use driftworld_spec::{Modality, Object, Rules, Variant, World};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::{AgentLevel, ScalesRequest, episode};
use crate::{Failure, argument, tasks};

/// In how many worlds the first pictures are compared.
const PICTURES: usize = 5;

/// What the best of some agents earns that cannot know which of these variants it is in.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct UnlabelledCeiling {
    /// The variants, each as likely as the others, by their names in logs.
    pub among: Vec<String>,
    /// Which agent it is.
    #[serde(default)]
    pub agent: String,
    /// What that agent earns in each of them.
    pub ceilings: BTreeMap<String, AgentLevel>,
}

/// One agent that is tried.
#[derive(Clone, Copy)]
enum Ignorant {
    /// Stands still.
    Still,
    /// Acts at random.
    Random,
    /// The expert of one variant, whatever happens.
    Fixed(usize),
    /// The expert of one variant until a reward shows another.
    FindsOut(usize),
}

impl Ignorant {
    fn all(num_variants: usize) -> impl Iterator<Item = Self> {
        let experts = (0..num_variants).flat_map(|own| [Self::Fixed(own), Self::FindsOut(own)]);
        [Self::Still, Self::Random].into_iter().chain(experts)
    }

    fn name(self, variants: &[&Variant]) -> String {
        match self {
            Self::Still => "stands still".to_owned(),
            Self::Random => "acts at random".to_owned(),
            Self::Fixed(own) => format!("expert of {}", variants[own].id()),
            Self::FindsOut(own) => format!("expert of {} until a reward shows another", variants[own].id()),
        }
    }

    /// What it earns in one of these worlds, one of each variant, and whether it succeeds.
    fn run(self, worlds: &[World], place: usize, chance: u64, expertise: &Expertise) -> Result<(f64, bool), Failure> {
        let (abroad, catalogue) = (&worlds[place], &expertise.catalogue);
        let found = match self {
            Self::Still => return episode(&mut StillAgent, abroad, catalogue),
            Self::Random => {
                let mut agent = RandomAgent::new(0);
                agent.begin(chance);
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

/// The sets that a request asks for: those that it names, or all of its variants that look alike.
pub(super) fn sets_of<'a>(
    variants: &'a [(String, Variant)],
    request: &ScalesRequest,
    catalogue: &Catalogue,
) -> Result<Vec<Vec<&'a Variant>>, Failure> {
    let mut sets: Vec<Vec<&Variant>> = Vec::new();
    for asked in &request.unlabelled {
        if asked.is_empty() {
            let mut classes: Vec<Vec<&Variant>> = Vec::new();
            for (_, variant) in variants {
                let mut of_these = None;
                for (place, class) in classes.iter().enumerate() {
                    if class[0].task().name() == variant.task().name()
                        && unlike(class[0], variant, request, catalogue)?.is_none()
                    {
                        of_these = Some(place);
                        break;
                    }
                }
                match of_these {
                    Some(place) => classes[place].push(variant),
                    None => classes.push(vec![variant]),
                }
            }
            sets.extend(classes.into_iter().filter(|class| class.len() > 1));
            continue;
        }
        let named = tasks::variants_of(asked)?;
        let mut set = Vec::new();
        for (_, variant) in &named {
            let known = variants.iter().map(|(_, known)| known);
            let Some(known) = known.into_iter().find(|known| known.id() == variant.id()) else {
                return Err(Failure::usage(format!(
                    "{}: found {}, expected variants that are measured",
                    argument("unlabelled"),
                    variant.id()
                )));
            };
            set.push(known);
        }
        let [first, others @ ..] = set.as_slice() else { continue };
        if others.is_empty() {
            return Err(Failure::usage(format!(
                "{}: found {} alone, expected two variants or more",
                argument("unlabelled"),
                first.id()
            )));
        }
        for other in others {
            if let Some(what) = unlike(first, other, request, catalogue)? {
                return Err(Failure::input(format!(
                    "{}: found {} and {}, which {what}, expected variants that look alike at the start; a learner can \
                     tell these, so their ceiling is the expert's",
                    argument("unlabelled"),
                    first.id(),
                    other.id()
                )));
            }
        }
        sets.push(set);
    }
    sets.dedup();
    Ok(sets)
}
