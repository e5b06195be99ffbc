//! [`Planned`]: a regime of a plan. Maps its experiences' numbers to worlds, variants along a drift, seeds, labels, and log
//! parameters.

use std::sync::Arc;

use driftworld_env::Label;
use driftworld_generator::{Drift, GeneratorError, Sampler};
use driftworld_metrics::TaskParams;
use driftworld_spec::{BlockKind, DriftSwitch, Phase, RegimeDrift, Variant, World};
use serde_json::{Map, Value, json};

use super::gap::Subject;
use super::shuffle::Shuffle;
use crate::CurriculumError;
use crate::hash::number_of;

/// A regime of a plan.
pub(super) struct Planned {
    pub(super) block: usize,
    pub(super) regime: usize,
    pub(super) kind: BlockKind,
    pub(super) phase: Phase,
    /// Its name in tables: `task#variant`.
    pub(super) id: String,
    pub(super) log_name: String,
    /// The number of its first experience over the whole lifetime; its first position, if its block is shuffled.
    pub(super) first: u64,
    /// The order of its block's experiences, if the block is shuffled.
    pub(super) shuffle: Option<Arc<Shuffle>>,
    pub(super) count: u32,
    /// Decisions after which no more of its experiences start.
    pub(super) steps: Option<u32>,
    pub(super) seed: u64,
    pub(super) first_index: u64,
    pub(super) max_steps: Option<u32>,
    pub(super) source: Source,
    /// Number of earlier learning regimes that begin with the same variant under the same seed.
    pub(super) learned_before: u64,
    /// Distinguishes repeats of the scenario in the agent's random numbers.
    pub(super) run_seed: u64,
    /// The last regime in which the agent learned before this one.
    pub(super) learned: Option<usize>,
    /// The labels of its variant and of the variant that its drift ends at.
    pub(super) labels: Option<[Label; 2]>,
}

/// The source of its worlds.
pub(super) enum Source {
    Variant(Variant),
    Drift {
        from: Variant,
        to: Variant,
        path: Box<Drift>,
        drift: Box<RegimeDrift>,
    },
    World {
        world: Arc<World>,
        path: String,
    },
}

impl Planned {
    /// The names of its first and last variants, which are equal unless it drifts.
    pub(super) fn ends(&self) -> [String; 2] {
        match &self.source {
            Source::Drift { from, to, .. } => [from.id(), to.id()],
            _ => [self.id.clone(), self.id.clone()],
        }
    }

    /// The label of experience `number`: in a drift, the label of the nearer end according to the schedule, or of the second
    /// end if exactly halfway; if whole variants switch, the label of the experience's own variant.
    pub(super) fn label(&self, number: u64) -> Option<&Label> {
        let [from, to] = self.labels.as_ref()?;
        Some(if self.is_nearer_to_start(number) { from } else { to })
    }

    /// The name of experience `number`'s variant: in a drift, the name of the end that also gives its label.
    pub(super) fn nearest(&self, number: u64) -> String {
        let [from, to] = self.ends();
        if self.is_nearer_to_start(number) { from } else { to }
    }

    fn is_nearer_to_start(&self, number: u64) -> bool {
        let Source::Drift { to, drift, .. } = &self.source else {
            return true;
        };
        // If whole variants switch, an experience has one of the two.
        if drift.switch == DriftSwitch::Task
            && let Ok(Some(variant)) = self.variant_of(number)
        {
            return variant.id() != to.id();
        }
        drift.schedule.at(self.progress(number)) < 0.5
    }

    pub(super) fn world_error(&self, number: u64, source: GeneratorError) -> CurriculumError {
        CurriculumError::World {
            block: self.block,
            regime: self.regime,
            experience: number,
            variant: self.id.clone(),
            progress: self.progress(number),
            source,
        }
    }

    /// Whether its worlds are drawn, not read from a file.
    pub(super) fn is_drawn(&self) -> bool {
        !matches!(self.source, Source::World { .. })
    }

    /// Distinguishes its drift from others between the same variants; empty without a drift.
    pub(super) fn drift_key(&self) -> String {
        match &self.source {
            Source::Drift { drift, .. } => format!(" {drift:?}"),
            _ => String::new(),
        }
    }

    /// The position of an experience in the regime, from 0.
    fn offset(&self, number: u64) -> u64 {
        let position = self.shuffle.as_ref().map_or(number, |shuffle| shuffle.position(number));
        position - self.first
    }

    /// The number, over the whole lifetime, of the experience at a position in the regime.
    pub(super) fn number(&self, offset: u64) -> u64 {
        let position = self.first + offset;
        self.shuffle.as_ref().map_or(position, |order| order.number(position))
    }

    /// The index of an experience's world under its seed.
    pub(super) fn index_of(&self, number: u64) -> u64 {
        self.first_index + self.offset(number)
    }

    /// The sampler of its worlds, if they are all drawn from one variant.
    pub(super) fn sampler(&self) -> Option<Sampler> {
        match &self.source {
            Source::Variant(variant) => Some(Sampler::new(variant, self.seed)),
            _ => None,
        }
    }

    /// The world of experience `number` of the lifetime, with its variant if that changes between experiences. `sampler` is
    /// this regime's own.
    pub(super) fn draw(
        &self,
        number: u64,
        sampler: Option<&Sampler>,
    ) -> Result<(World, Option<Variant>), GeneratorError> {
        let index = self.index_of(number);
        let between = self.variant_of(number)?;
        let world = match &self.source {
            Source::World { world, .. } => World::clone(world),
            Source::Variant(variant) => match sampler {
                Some(sampler) => sampler.world(index)?,
                None => Sampler::new(variant, self.seed).world(index)?,
            },
            Source::Drift { from, .. } => Sampler::new(between.as_ref().unwrap_or(from), self.seed).world(index)?,
        };
        let world = match self.max_steps {
            Some(max_steps) => world
                .edit(|world| world.limit_steps(max_steps))
                .expect("a scenario's step limit is valid in a world"),
            None => world,
        };
        Ok((world, between))
    }

    /// The seed of the agent's random numbers in an experience.
    ///
    /// It depends on the task, the seed and the world's index, but not on the variant: a random agent acts the same in two
    /// variants under one seed. Every evaluation of a world gets the same seed, so an unchanged agent earns the same in
    /// it; learning in that world again gets a different seed, so that a learner does not repeat its attempts.
    pub(super) fn agent_seed(&self, number: u64) -> u64 {
        let task = self.id.rsplit_once('#').map_or(self.id.as_str(), |(task, _)| task);
        let numbers = [self.seed, self.index_of(number), self.learned_before, self.run_seed];
        let [seed, index, learned_before, run_seed] = numbers.map(u64::to_le_bytes);
        let mut parts: Vec<&[u8]> = vec![task.as_bytes(), &[0], &seed, &index];
        if self.kind == BlockKind::Learning {
            parts.push(&learned_before);
        }
        if self.run_seed != 0 {
            parts.extend([&b"run"[..], &run_seed]);
        }
        number_of(parts)
    }

    /// The variant of an experience, if its regime drifts.
    pub(super) fn variant_of(&self, number: u64) -> Result<Option<Variant>, GeneratorError> {
        let Source::Drift { path, drift, .. } = &self.source else {
            return Ok(None);
        };
        let experience = self.offset(number) as u32;
        path.at(drift.progress(experience, self.count), self.index_of(number))
            .map(Some)
    }

    /// The subject of experience `number` with a unique name; `between` is its variant in a drift.
    pub(super) fn subject<'a>(&'a self, number: u64, between: Option<&'a Variant>) -> (String, Subject<'a>) {
        match (&self.source, between) {
            (Source::World { world, .. }, _) => (self.id.clone(), Subject::World(world)),
            (Source::Variant(variant), _) => (variant.id(), Subject::Variant(variant)),
            // During a drift, random choices may have made a different variant for each experience.
            (Source::Drift { from, to, .. }, Some(variant)) if ![from.name(), to.name()].contains(&variant.name()) => {
                (format!("{}/{number}", variant.id()), Subject::Variant(variant))
            }
            (Source::Drift { from, .. }, between) => {
                let variant = between.unwrap_or(from);
                (variant.id(), Subject::Variant(variant))
            }
        }
    }

    /// The variant of its last experience that has one, if it drifts: the task may forbid some variants along a drift.
    pub(super) fn last_variant(&self) -> Option<Variant> {
        let mut offsets = (0..u64::from(self.count)).rev();
        offsets.find_map(|offset| self.variant_of(self.number(offset)).transpose()?.ok())
    }

    /// The index of an experience's world for its variant and seed; NaN for a world from a file.
    pub(super) fn world_index(&self, number: u64) -> f64 {
        if self.is_drawn() {
            self.index_of(number) as f64
        } else {
            f64::NAN
        }
    }

    /// The progress of a drift in an experience, 0..=1; 0 without a drift.
    pub(super) fn progress(&self, number: u64) -> f64 {
        match &self.source {
            Source::Drift { drift, .. } => drift.progress(self.offset(number) as u32, self.count),
            Source::Variant(_) | Source::World { .. } => 0.0,
        }
    }

    /// The log parameters of this regime's experiences: the same for each, because programs that read logs treat
    /// experiences with different parameters as different regimes.
    pub(super) fn params(&self) -> TaskParams {
        let mut params = Map::new();
        let mut set = |key: &str, value: Value| drop(params.insert(key.to_owned(), value));
        let (task, variant) = match &self.source {
            Source::Variant(variant) | Source::Drift { from: variant, .. } => (variant.task().name(), variant.name()),
            Source::World { .. } => self.id.split_once('#').unwrap_or((&self.id, "")),
        };
        set("task", json!(task));
        set("variant", json!(variant));
        match &self.source {
            Source::Variant(_) => {}
            Source::Drift { to, .. } => set("to", json!(end_name(task, to))),
            Source::World { path, .. } => set("world", json!(path)),
        }
        if self.is_drawn() {
            set("seed", json!(self.seed));
        }
        if self.shuffle.is_some() {
            set("mix", json!("shuffled"));
        }
        if let Some(max_steps) = self.max_steps {
            set("max_steps", json!(max_steps));
        }
        if self.phase == Phase::PreDeployment {
            set("phase", json!("pre_deployment"));
        }
        TaskParams::from(params)
    }
}

/// The name of a drift's second end, prefixed with its task if that differs from the first end's.
pub(super) fn end_name(task: &str, to: &Variant) -> String {
    if to.task().name() == task {
        to.name().to_owned()
    } else {
        to.id()
    }
}

/// Which evaluations of each block are repeated at its end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Repeats {
    /// How many.
    pub count: usize,
    /// Repeat the block's first evaluations instead of a seeded sample: for cases where order matters, as in batches.
    pub first: bool,
}
