//! A scenario prepared to run: all variants and worlds are resolved, and experiences are identified by number.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::sync::Arc;

use driftworld_env::Label;
use driftworld_generator::{Drift, Sampler};
use driftworld_spec::{Block, BlockKind, BlockMix, Regime, Scenario, TaskLabel, TaskSpec, Variant, World};
use indexmap::IndexSet;
use serde_json::{Value, json};

use super::log_names::{LogNames, log_name};
use super::planned::{Planned, Repeats, Source, end_name};
use super::shuffle::Shuffle;
use super::undrawable::Undrawable;
use crate::CurriculumError;

/// The source of a scenario's tasks and worlds, because this crate does not read their files. An error is given as a message.
pub struct Sources<'a> {
    /// The task of this name or path.
    pub task: &'a mut dyn FnMut(&str) -> Result<Arc<TaskSpec>, String>,
    /// The world file with this path, as in the scenario.
    pub world: &'a mut dyn FnMut(&str) -> Result<FoundWorld, String>,
}

/// The result of looking up a world file.
#[derive(Clone, Debug)]
pub struct FoundWorld {
    /// The world.
    pub world: World,
    /// A note about it, for instance that it replaces another. Logs keep it.
    pub note: Option<String>,
}

/// The name of a run's seed in logs.
const RUN_SEED: &str = "run_seed";

/// A scenario with everything needed to run it.
pub struct Plan {
    pub(super) scenario: Scenario,
    pub(super) regimes: Vec<Planned>,
    /// Values that must be unchanged when a log is resumed: for each variant and world its name and hashes of its contents, and
    /// the additions of [`Plan::add_fingerprint`].
    pub(super) fingerprints: BTreeMap<String, Value>,
    /// Notes about world files, by path.
    pub(super) notes: BTreeMap<String, String>,
    /// How experiences whose worlds cannot be drawn are treated.
    pub(super) undrawable: Undrawable,
    tasks: BTreeMap<String, Arc<TaskSpec>>,
    /// Number of environments that run in parallel.
    pub(super) lanes: usize,
}

/// An experience to be run, for callers that do not use [`run`](crate::run).
#[derive(Clone, Debug, PartialEq)]
pub struct ExperienceSpec<'a> {
    /// Its block, from 0.
    pub block: usize,
    /// Its regime in the block, from 0.
    pub regime: usize,
    /// Whether the agent may learn from it.
    pub kind: BlockKind,
    /// Its name: `task#variant`; for a drift, with both ends.
    pub variant: &'a str,
    /// The seed of its world; `None` for a world from a file.
    pub seed: Option<u64>,
    /// The index of its world under the seed.
    pub index: Option<u64>,
    /// Progress of a drift, 0..=1; 0 without a drift.
    pub progress: f64,
    /// The seed of the agent's own random numbers.
    pub agent_seed: u64,
    /// Decisions after which no more experiences of its regime start, if it has such a budget.
    pub steps: Option<u32>,
    /// The task label that the agent gets, if the scenario has labels.
    pub label: Option<&'a Label>,
}

impl Plan {
    /// Resolves everything that a scenario names, so that missing things are reported before anything is run.
    ///
    /// # Errors
    /// [`CurriculumError::Unknown`] or [`CurriculumError::WorldFile`] for a task, variant or world file that cannot be found;
    /// [`CurriculumError::World`] if the first world of a variant cannot be drawn; [`CurriculumError::SameLogName`] if two
    /// variants would have the same name in the log.
    pub fn new(scenario: &Scenario, sources: &mut Sources) -> Result<Self, CurriculumError> {
        Self::with_undrawable(scenario, sources, Undrawable::Refused)
    }

    /// Like [`Plan::new`], with a choice of how experiences whose worlds cannot be drawn are treated: if they are skipped, such
    /// worlds are not an error.
    ///
    /// # Errors
    /// Those of [`Plan::new`].
    pub fn with_undrawable(
        scenario: &Scenario,
        sources: &mut Sources,
        undrawable: Undrawable,
    ) -> Result<Self, CurriculumError> {
        let mut finder = Finder {
            plan: Self {
                scenario: scenario.clone(),
                regimes: Vec::new(),
                fingerprints: BTreeMap::new(),
                notes: BTreeMap::new(),
                undrawable,
                tasks: BTreeMap::new(),
                lanes: 1,
            },
            sources,
            worlds: BTreeMap::new(),
        };
        let mut log_names = LogNames::default();
        // For each variant and seed, the number of regimes in which it was learned.
        let mut rounds: BTreeMap<(String, u64), u64> = BTreeMap::new();
        let (mut first, mut learned) = (0, None);
        for (b, block) in scenario.blocks.iter().enumerate() {
            let shuffle = shuffle(b, block, first).map(Arc::new);
            let learned_before_block = learned;
            for (r, regime) in block.regimes.iter().enumerate() {
                let before = if shuffle.is_some() {
                    learned_before_block
                } else {
                    learned
                };
                let place = (first, shuffle.clone());
                let mut planned = finder.planned((b, block), (r, regime), place, before)?;
                first += u64::from(planned.count);
                log_names.claim(regime, &planned.log_name)?;
                if planned.kind == BlockKind::Learning {
                    learned = Some(finder.plan.regimes.len());
                    let [begins, _] = planned.ends();
                    let rounds = rounds.entry((begins, planned.seed)).or_insert(0);
                    planned.learned_before = *rounds;
                    *rounds += 1;
                }
                finder.plan.regimes.push(planned);
            }
        }
        finder.plan.assign_labels();
        Ok(finder.plan)
    }

    /// Records a further dependency of the lifetime, such as the bytes of an agent's script: a log can be resumed only if it is
    /// unchanged. `what` must not be a variant's name, so it has no `#`.
    pub fn add_fingerprint(&mut self, what: &str, fingerprint: impl Into<Value>) {
        self.fingerprints.insert(what.to_owned(), fingerprint.into());
    }

    /// Gives the agent different random numbers in the same worlds: a repeat of a run, not a copy. 0, the default, is the
    /// scenario's original run.
    pub fn set_run_seed(&mut self, seed: u64) {
        for planned in &mut self.regimes {
            planned.run_seed = seed;
        }
        if seed == 0 {
            self.fingerprints.remove(RUN_SEED);
        } else {
            self.add_fingerprint(RUN_SEED, seed);
        }
    }

    /// Sets the number of environments that run in parallel, which affects budgets of decisions. One by default.
    pub fn set_lanes(&mut self, lanes: usize) {
        self.lanes = lanes.max(1);
    }

    /// Whether regimes of a block end after a number of decisions.
    pub(super) fn has_budgets(&self, block: usize) -> bool {
        let mut of_block = self.regimes.iter().filter(|planned| planned.block == block);
        of_block.any(|planned| planned.steps.is_some())
    }

    /// How experiences whose worlds cannot be drawn are treated.
    pub fn undrawable(&self) -> Undrawable {
        self.undrawable
    }

    /// The scenario of this plan.
    pub fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    /// Number of experiences in the whole lifetime; the maximum, if regimes have a budget of decisions.
    pub fn num_experiences(&self) -> u64 {
        self.scenario.num_experiences()
    }

    /// The world of an experience, by its number over the whole lifetime.
    ///
    /// # Errors
    /// [`CurriculumError::World`] if it cannot be drawn; [`CurriculumError::NoSuchExperience`] beyond the last experience.
    pub fn world(&self, number: u64) -> Result<World, CurriculumError> {
        let planned = self.planned_at(number)?;
        let drawn = planned.draw(number, None);
        Ok(drawn.map_err(|source| planned.world_error(number, source))?.0)
    }

    /// The regime of an experience, if the experience exists.
    fn planned_at(&self, number: u64) -> Result<&Planned, CurriculumError> {
        let total = self.num_experiences();
        if number >= total {
            return Err(CurriculumError::NoSuchExperience { found: number, total });
        }
        Ok(&self.regimes[self.regime_of(number)])
    }

    /// The description of an experience, by its number over the whole lifetime; its world is [`Plan::world`].
    ///
    /// # Errors
    /// [`CurriculumError::NoSuchExperience`] beyond the last experience.
    pub fn experience_spec(&self, number: u64) -> Result<ExperienceSpec<'_>, CurriculumError> {
        let planned = self.planned_at(number)?;
        let is_drawn = planned.is_drawn();
        Ok(ExperienceSpec {
            block: planned.block,
            regime: planned.regime,
            kind: planned.kind,
            variant: &planned.id,
            seed: is_drawn.then_some(planned.seed),
            index: is_drawn.then(|| planned.index_of(number)),
            progress: planned.progress(number),
            agent_seed: planned.agent_seed(number),
            steps: planned.steps,
            label: planned.label(number),
        })
    }

    /// The number of the next experience to consider once the budget of experience `number`'s regime is spent: the
    /// first after the regime, or the next one in a shuffled block.
    pub fn after(&self, number: u64) -> u64 {
        let planned = &self.regimes[self.regime_of(number)];
        let end = planned.first + u64::from(planned.count);
        if planned.shuffle.is_some() { number + 1 } else { end }
    }

    /// The numbers of the first and the last experience of each regime: these cover all variants, and both ends of each drift.
    pub fn ends_of_regimes(&self) -> impl Iterator<Item = u64> {
        let ends = |planned: &Planned| [0, u64::from(planned.count) - 1].map(|offset| planned.number(offset));
        self.regimes.iter().flat_map(ends)
    }

    /// The index of an experience's regime.
    pub(super) fn regime_of(&self, number: u64) -> usize {
        // The first regime begins with experience 0.
        let at = |place: u64| self.regimes.partition_point(|planned| planned.first <= place) - 1;
        let index = at(number);
        // All regimes of a block have the same shuffle, so any of them locates the experience.
        match &self.regimes[index].shuffle {
            Some(shuffle) => at(shuffle.position(number)),
            None => index,
        }
    }

    /// The evaluations that are repeated at the end of the block of `from`, in ascending order: the first ones, starting
    /// with `from`, or some chosen by the block's seeds.
    pub(super) fn repeated(&self, from: u64, repeats: Repeats) -> Vec<u64> {
        let index = self.regime_of(from);
        let planned = &self.regimes[index];
        if planned.kind == BlockKind::Learning || repeats.count == 0 {
            return Vec::new();
        }
        let after = self.regimes[index..].iter().find(|other| other.block != planned.block);
        let end = after.map_or(self.num_experiences(), |other| other.first);
        let key = block_key(planned.seed ^ planned.run_seed.rotate_left(32), !planned.block);
        let order = Shuffle::new(from, end - from, key);
        let place = |n: &u64| if repeats.first { *n } else { order.position(*n) };
        (from..end)
            .filter(|number| place(number) - from < repeats.count as u64)
            .collect()
    }

    /// Every variant from which worlds are drawn, including both ends of drifts, each once with the step limit that its first
    /// regime sets.
    pub fn variants(&self) -> Vec<(&Variant, Option<u32>)> {
        let mut found: BTreeMap<String, (&Variant, Option<u32>)> = BTreeMap::new();
        for planned in &self.regimes {
            let variants = match &planned.source {
                Source::Variant(variant) => vec![variant],
                Source::Drift { from, to, .. } => vec![from, to],
                Source::World { .. } => Vec::new(),
            };
            for variant in variants {
                found.entry(variant.id()).or_insert((variant, planned.max_steps));
            }
        }
        found.into_values().collect()
    }

    /// Every world from a file, once, with its name, and with a step limit as in [`Plan::variants`].
    pub fn world_files(&self) -> Vec<(&str, &World, Option<u32>)> {
        let mut found: BTreeMap<&str, (&str, &World, Option<u32>)> = BTreeMap::new();
        for planned in &self.regimes {
            if let Source::World { world, .. } = &planned.source {
                found
                    .entry(&planned.id)
                    .or_insert((&planned.id, world, planned.max_steps));
            }
        }
        found.into_values().collect()
    }

    /// Every task from which worlds are drawn, by its name in the scenario.
    pub fn tasks(&self) -> &BTreeMap<String, Arc<TaskSpec>> {
        &self.tasks
    }

    /// The end of the unbroken stretch of blocks of one kind that contains an experience.
    pub(super) fn end_of_kind(&self, number: u64) -> u64 {
        let here = self.regime_of(number);
        let kind = self.regimes[here].kind;
        let other = self.regimes[here..].iter().find(|planned| planned.kind != kind);
        other.map_or(self.num_experiences(), |planned| planned.first)
    }

    /// Records fingerprints of the sources of a regime's worlds.
    fn fingerprint(&mut self, planned: &Planned) -> Result<(), CurriculumError> {
        let undrawable = self.undrawable;
        let mut take = |variant: &Variant, is_first_drawn: bool| {
            let Entry::Vacant(place) = self.fingerprints.entry(variant.id()) else {
                return Ok(());
            };
            // The variant's hash covers the input of all worlds, the first world's hash the code that generates them.
            let world = match Sampler::new(variant, planned.seed).world(planned.first_index) {
                Ok(world) => Some(world.hash()),
                Err(source) if is_first_drawn && undrawable == Undrawable::Refused => {
                    return Err(planned.world_error(planned.number(0), source));
                }
                Err(_) => None,
            };
            place.insert(json!({ "variant": variant.hash(), "first_world": world }));
            Ok(())
        };
        match &planned.source {
            Source::Variant(variant) => take(variant, true),
            Source::Drift { from, to, .. } => {
                take(from, planned.progress(planned.number(0)) == 0.0)?;
                take(to, false)
            }
            Source::World { world, .. } => {
                let hash = || json!(world.hash());
                self.fingerprints.entry(planned.id.clone()).or_insert_with(hash);
                Ok(())
            }
        }
    }

    /// Numbers the variants' labels in their order of appearance, if the scenario has labels.
    fn assign_labels(&mut self) {
        let wanted = self.scenario.task_label;
        if wanted == TaskLabel::None {
            return;
        }
        let names: IndexSet<String> = self.regimes.iter().flat_map(Planned::ends).collect();
        for planned in &mut self.regimes {
            planned.labels = Some(planned.ends().map(|name| Label {
                number: names.get_index_of(&name).expect("the set contains every name"),
                of: names.len(),
                observed: wanted == TaskLabel::Observation,
                name,
            }));
        }
    }
}

/// The order of a shuffled block.
fn shuffle(number: usize, block: &Block, first: u64) -> Option<Shuffle> {
    let seed = block.regimes.first().map_or(0, |regime| regime.seed);
    (block.mix == BlockMix::Shuffled).then(|| Shuffle::new(first, block.num_experiences(), block_key(seed, number)))
}

/// A separate key for each block of a seed.
fn block_key(seed: u64, block: usize) -> u64 {
    seed.wrapping_add((block as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15))
}

/// Looks up the tasks and worlds that a scenario names, each only once.
struct Finder<'a, 'b> {
    /// The plan so far.
    plan: Plan,
    sources: &'a mut Sources<'b>,
    worlds: BTreeMap<String, Arc<World>>,
}

impl Finder<'_, '_> {
    fn planned(
        &mut self,
        (b, block): (usize, &Block),
        (r, regime): (usize, &Regime),
        (first, shuffle): (u64, Option<Arc<Shuffle>>),
        learned: Option<usize>,
    ) -> Result<Planned, CurriculumError> {
        let source = self.source(b, r, regime)?;
        let (id, log_name) = match &source {
            Source::Variant(variant) => (variant.id(), log_name(variant.task().name(), variant.name())),
            Source::Drift { from, to, .. } => {
                let task = from.task().name();
                let end = end_name(from.task().name(), to);
                let id = format!("{}..{end}", from.id());
                (id, log_name(task, &format!("{}to{end}", from.name())))
            }
            Source::World { .. } => {
                let name = regime.variant_name();
                (format!("{}#{name}", regime.task), log_name(&regime.task, name))
            }
        };
        let planned = Planned {
            block: b,
            regime: r,
            kind: block.kind,
            phase: block.phase,
            id,
            log_name,
            first,
            shuffle,
            count: regime.count,
            steps: regime.steps,
            seed: regime.seed,
            first_index: regime.first_index,
            max_steps: regime.max_steps,
            source,
            learned_before: 0,
            run_seed: 0,
            learned,
            labels: None,
        };
        self.plan.fingerprint(&planned)?;
        Ok(planned)
    }

    fn source(&mut self, block: usize, regime_number: usize, regime: &Regime) -> Result<Source, CurriculumError> {
        if let Some(path) = &regime.world {
            if !self.worlds.contains_key(path) {
                let found = (self.sources.world)(path).map_err(|reason| CurriculumError::WorldFile {
                    block,
                    regime: regime_number,
                    reason,
                })?;
                self.worlds.insert(path.clone(), Arc::new(found.world));
                self.plan.notes.extend(found.note.map(|note| (path.clone(), note)));
            }
            return Ok(Source::World {
                world: Arc::clone(&self.worlds[path]),
                path: path.clone(),
            });
        }
        let unknown = |variant: &str, reason: String| CurriculumError::Unknown {
            block,
            regime: regime_number,
            task: regime.task.clone(),
            variant: variant.to_owned(),
            reason,
        };
        let end = regime.drift.as_ref().map_or(&regime.variant, |drift| &drift.to);
        for (name, variant) in [(regime.task.as_str(), &regime.variant), (regime.end_task(), end)] {
            if !self.plan.tasks.contains_key(name) {
                let task = (self.sources.task)(name).map_err(|reason| unknown(variant, reason))?;
                self.plan.tasks.insert(name.to_owned(), task);
            }
        }
        let (task, end_task) = (&self.plan.tasks[&regime.task], &self.plan.tasks[regime.end_task()]);
        let from = regime
            .resolve(task)
            .map_err(|error| unknown(&regime.variant, error.to_string()))?;
        let Some(drift) = &regime.drift else {
            return Ok(Source::Variant(from));
        };
        let to = regime
            .resolve_end(end_task)
            .map_err(|error| unknown(&drift.to, error.to_string()))?
            .expect("a regime with a drift has an end");
        let path = Drift::declared(drift, from.clone(), to.clone(), regime.seed);
        let path = path.map_err(|error| unknown(&drift.to, error.to_string()))?;
        Ok(Source::Drift {
            from,
            to,
            path: Box::new(path),
            drift: Box::new(drift.clone()),
        })
    }
}
