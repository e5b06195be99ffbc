//! [`Pairs`]: worlds prepared for pairwise comparison by one measure, and the [`Means`] over pairs of worlds of two variants.

use driftworld_env::{Catalogue, ExpertRun, Expertise, WorldAbstraction};
use driftworld_similarity::distribution::Method;
use driftworld_similarity::picture::PictureMeasure;
use driftworld_similarity::{Distance, Part, Weights, WorldMeasure, world_rewards_distance};
use driftworld_spec::{By, Element, World};
use rayon::prelude::*;

use super::DistancesError;
use crate::behavior::{POINTS, regrets};
use crate::dynamics;
use crate::picture_distance::{GRID_SIDE, Pose, Views, poses};

/// The numbers of one comparison: one per entry of [`parts`]; for whole decision processes, those used by [`Means`].
pub(super) type Values = Vec<f64>;

/// The measure of two worlds with this name, if the `similarity` crate has one.
pub(super) fn world_measure(by: By) -> Option<WorldMeasure> {
    let measure = by.name().split_once(':').map(|(_, measure)| measure);
    WorldMeasure::from_name(by.subject(), measure)
}

/// Name, element and unit of each number of a measure; empty if it compares the whole decision process.
fn parts(by: By) -> Vec<(&'static str, Element, &'static str)> {
    if let Some(measure) = world_measure(by) {
        return vec![(by.subject(), measure.element(), measure.label())];
    }
    let parts: &[_] = match by {
        By::Pictures => &[
            ("looks of objects", Element::O, "oklab, where objects are seen"),
            ("looks of surroundings", Element::O, "oklab, elsewhere"),
        ],
        By::PicturesWhole => &[("looks", Element::O, "oklab")],
        By::PicturesStructure => &[("looks", Element::O, "(1 − ssim) / 2")],
        By::Rewards => &[("rewards", Element::R, "epic")],
        By::Dynamics => &[
            ("what actions pay", Element::R, "difference / 100 points"),
            ("where actions lead", Element::T, "distance / 10 m + turn / 180°"),
        ],
        _ => &[],
    };
    parts.to_vec()
}

/// Worlds with the data that a measure needs, computed once for each world.
pub(super) struct Pairs<'a> {
    by: By,
    worlds: &'a [World],
    prepared: Prepared,
}

enum Prepared {
    Rewards,
    World(WorldMeasure),
    /// For each world, the poses that are free in it, and the views from there.
    Pictures(Catalogue, Vec<(Vec<Pose>, Views)>),
    /// Each world tabulated over its own arena.
    Dynamics(Catalogue, Vec<WorldAbstraction>),
    /// The reward of each world's own expert.
    Behavior(Expertise, Vec<ExpertRun>),
}

impl<'a> Pairs<'a> {
    /// Prepares worlds in parallel, for any measure except parameters, worlds and placements.
    pub(super) fn new(by: By, worlds: &'a [World], catalogue: &Catalogue) -> Result<Self, DistancesError> {
        let catalogue = catalogue.clone();
        let prepared = match by.subject() {
            "pictures" => {
                let views = |world: &World| {
                    let poses = poses(&[world], &catalogue)?;
                    let views = Views::new(world, &poses, &catalogue)?;
                    Ok::<_, DistancesError>((poses, views))
                };
                let views = worlds.par_iter().map(views).collect::<Result<_, _>>()?;
                Prepared::Pictures(catalogue, views)
            }
            "dynamics" => {
                let tables = |world: &World| dynamics::tables(world, world.environment_params.arena_size(), &catalogue);
                let tables = worlds.par_iter().map(tables).collect::<Result<_, _>>()?;
                Prepared::Dynamics(catalogue, tables)
            }
            "behavior" => {
                let expertise = Expertise {
                    catalogue,
                    ..Expertise::default()
                };
                let own = worlds.par_iter().map(|world| expertise.at_home(world));
                let own = own.collect::<Result<_, _>>()?;
                Prepared::Behavior(expertise, own)
            }
            _ => world_measure(by).map_or(Prepared::Rewards, Prepared::World),
        };
        Ok(Self { by, worlds, prepared })
    }

    /// Compares two worlds by index.
    pub(super) fn between(&self, a: usize, b: usize) -> Result<Values, DistancesError> {
        let worlds = [&self.worlds[a], &self.worlds[b]];
        Ok(match &self.prepared {
            Prepared::Rewards => vec![world_rewards_distance(worlds[0], worlds[1])?],
            Prepared::World(measure) => vec![measure.between(worlds[0], worlds[1])?],
            Prepared::Pictures(catalogue, views) => {
                let sides = worlds.map(|world| world.environment_params.arena_size());
                if sides[0] != sides[1] {
                    let poses = poses(&worlds, catalogue)?;
                    let [a, b] = worlds.map(|world| Views::new(world, &poses, catalogue));
                    return self.looks(&a?, &b?);
                }
                let [(poses_a, a), (poses_b, b)] = [&views[a], &views[b]];
                // Pictures are copied only if a position is occupied in one of the worlds.
                let common_views = |views: &Views, own: &[Pose], other: &[Pose]| {
                    let common: Vec<usize> = (0..own.len()).filter(|k| other.contains(&own[*k])).collect();
                    (common.len() < own.len()).then(|| views.only(&common))
                };
                let (common_a, common_b) = (common_views(a, poses_a, poses_b), common_views(b, poses_b, poses_a));
                let (a, b) = (common_a.as_ref().unwrap_or(a), common_b.as_ref().unwrap_or(b));
                if a.is_empty() {
                    let tried = GRID_SIDE * GRID_SIDE;
                    return Err(DistancesError::NoPlace { tried });
                }
                self.looks(a, b)?
            }
            Prepared::Dynamics(catalogue, tables) => {
                let area = dynamics::common_area(worlds[0], worlds[1]);
                if worlds.iter().all(|world| world.environment_params.arena_size() == area) {
                    return self.outcomes(&tables[a], &tables[b]);
                }
                let [a, b] = worlds.map(|world| dynamics::tables(world, area, catalogue));
                return self.outcomes(&a?, &b?);
            }
            Prepared::Behavior(expertise, own) => regrets(expertise, worlds, [own[a], own[b]])?.to_vec(),
        })
    }

    fn looks(&self, a: &Views, b: &Views) -> Result<Values, DistancesError> {
        Ok(match self.by {
            By::Pictures => a.parts(b)?.to_vec(),
            By::PicturesStructure => vec![a.distance(b, PictureMeasure::Structure)?],
            _ => vec![a.distance(b, PictureMeasure::Oklab)?],
        })
    }

    fn outcomes(&self, a: &WorldAbstraction, b: &WorldAbstraction) -> Result<Values, DistancesError> {
        if self.by == By::DynamicsBisimulation {
            let found = dynamics::bisimulation(a, b)?;
            return Ok(vec![found.lower, found.upper]);
        }
        let (rewards, motion) = dynamics::w1(a, b)?;
        Ok(vec![rewards, motion])
    }
}

/// Means over comparisons of worlds of two variants.
pub(super) struct Means {
    by: By,
    sums: Values,
    count: usize,
}

impl Means {
    pub(super) fn new(by: By) -> Self {
        Self {
            by,
            sums: Vec::new(),
            count: 0,
        }
    }

    pub(super) fn add(&mut self, values: &[f64]) {
        self.sums.resize(values.len(), 0.0);
        for (sum, value) in self.sums.iter_mut().zip(values) {
            *sum += value;
        }
        self.count += 1;
    }

    fn mean(&self, k: usize) -> f64 {
        self.sums[k] / self.count as f64
    }

    /// Further notes on the distance, starting with a comma or a semicolon; often empty.
    pub(super) fn remark(&self) -> String {
        match self.by.subject() {
            _ if self.by == By::BehaviorSuccess => {
                format!("; own experts succeed in {:.1} % more worlds", 100.0 * self.mean(2))
            }
            "behavior" => format!(
                "; the second's planner earns {:.1} points less in the first's worlds, the first's {:.1} less in the second's",
                self.mean(0),
                self.mean(1)
            ),
            _ if self.by == By::DynamicsBisimulation => {
                format!(", between {:.4} and {:.4}", self.mean(0), self.mean(1))
            }
            _ => String::new(),
        }
    }

    /// The resulting distance.
    pub(super) fn distance(&self, weights: &Weights) -> Distance {
        match self.by {
            By::DynamicsBisimulation => Distance::whole(f64::midpoint(self.mean(0), self.mean(1))),
            By::Behavior => Distance::whole((f64::midpoint(self.mean(0), self.mean(1)) / POINTS).max(0.0)),
            By::BehaviorSuccess => Distance::whole(self.mean(2).max(0.0)),
            by => {
                let means = parts(by).into_iter().enumerate();
                let count = self.count;
                let parts = means.map(|(k, (name, element, measure))| Part {
                    method: (count > 1).then_some(Method::Samples { count }),
                    ..Part::of(name, element, measure, self.mean(k))
                });
                Distance::new(parts.collect(), weights)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn each_world_measure_has_one_name() {
        let names = By::names()
            .iter()
            .map(|name| By::from_name(name).expect("it is a name"));
        let measured = names.filter(|by| ["occupancy", "objects", "colors"].contains(&by.subject()));
        let found: Vec<(&str, &str)> = measured
            .map(|by| {
                let measure = world_measure(by).unwrap_or_else(|| panic!("{} names no measure", by.name()));
                (measure.kind(), measure.name())
            })
            .collect();
        let expected: BTreeSet<(&str, &str)> = WorldMeasure::all().map(|own| (own.kind(), own.name())).collect();
        assert_eq!(found.len(), expected.len());
        assert_eq!(found.into_iter().collect::<BTreeSet<_>>(), expected);
    }
}
