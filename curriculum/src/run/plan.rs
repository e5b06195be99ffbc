//! A scenario made ready to be lived: every variant and world found, every experience known by its number. Living it is in `mod.rs`.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::sync::Arc;

use driftworld_env::Label;
use driftworld_generator::{Drift, GeneratorError, Sampler, Schedule};
use driftworld_metrics::TaskParams;
use driftworld_spec::{Block, BlockKind, Phase, Regime, RegimeDrift, Scenario, TaskLabel, TaskSpec, Variant, World};
use serde_json::{Map, Value, json};
use sha2::{Digest, Sha256};

use super::gap::Subject;
use super::log_names::LogNames;
use super::undrawable::Undrawable;
use crate::CurriculumError;

/// Where the tasks and worlds of a scenario come from, since nothing here reads files. An error is its message.
pub struct Sources<'a> {
    /// The task of this name or path.
    pub task: &'a mut dyn FnMut(&str) -> Result<Arc<TaskSpec>, String>,
    /// The world file of this path, as the scenario has it.
    pub world: &'a mut dyn FnMut(&str) -> Result<FoundWorld, String>,
}

/// A world file that was found.
#[derive(Clone, Debug)]
pub struct FoundWorld {
    /// The world.
    pub world: World,
    /// What has to be known about it, for instance that it stands in for another. Logs keep it.
    pub note: Option<String>,
}

/// A scenario with everything that living it needs.
pub struct Plan {
    pub(super) scenario: Scenario,
    pub(super) regimes: Vec<Planned>,
    /// What must be the same when a log is taken up again: for each variant and world its name and hashes of what it is, and what
    /// [`Plan::add_fingerprint`] was told.
    pub(super) fingerprints: BTreeMap<String, Value>,
    /// What has to be known about world files, by path.
    pub(super) notes: BTreeMap<String, String>,
    /// What becomes of experiences whose worlds cannot be drawn.
    pub(super) undrawable: Undrawable,
    tasks: BTreeMap<String, Arc<TaskSpec>>,
}

/// An experience that is to be lived, for whoever lives it elsewhere than [`run`](crate::run) does.
#[derive(Clone, Debug, PartialEq)]
pub struct ExperienceSpec<'a> {
    /// Its block, from 0.
    pub block: usize,
    /// Its regime in the block, from 0.
    pub regime: usize,
    /// Whether the agent may learn from it.
    pub kind: BlockKind,
    /// What it is called: `task#variant`, in a drift with both ends.
    pub variant: &'a str,
    /// The seed of its world; nothing for a world from a file.
    pub seed: Option<u64>,
    /// The number of its world under the seed.
    pub index: Option<u64>,
    /// How far on its way a drift is, 0..=1; 0 where nothing drifts.
    pub progress: f64,
    /// The number that an agent draws its own chance from.
    pub chance: u64,
    /// What the agent is told of its task, where the scenario tells it.
    pub label: Option<&'a Label>,
}

/// A regime of it.
pub(super) struct Planned {
    pub(super) block: usize,
    pub(super) regime: usize,
    pub(super) kind: BlockKind,
    phase: Phase,
    /// Its name in tables: `task#variant`.
    pub(super) id: String,
    pub(super) log_name: String,
    /// The number of its first experience over the whole lifetime.
    pub(super) first: u64,
    pub(super) count: u32,
    pub(super) seed: u64,
    pub(super) first_index: u64,
    max_steps: Option<u32>,
    source: Source,
    /// How many regimes of learning before it begin with the same variant under the same seed.
    learned_before: u64,
    /// The regime that the agent learned in last before this one.
    pub(super) learned: Option<usize>,
    /// The label of its variant, and of the one that its drift leads to.
    labels: Option<[Label; 2]>,
}

/// Where its worlds come from.
enum Source {
    Variant(Variant),
    Drift {
        from: Variant,
        to: Variant,
        way: Box<Drift>,
        drift: Box<RegimeDrift>,
    },
    World {
        world: Arc<World>,
        path: String,
    },
}

/// What one experience is made of.
pub(super) struct Assignment {
    pub(super) world: World,
    /// The variant, where it is another in each experience.
    pub(super) between: Option<Variant>,
}

impl Plan {
    /// Finds everything that a scenario names, so that what cannot be had is known before anything is lived.
    ///
    /// # Errors
    /// [`CurriculumError::Unknown`], [`CurriculumError::WorldFile`], [`CurriculumError::World`] where the first world of a
    /// variant cannot be drawn, [`CurriculumError::SameLogName`].
    pub fn new(scenario: &Scenario, sources: &mut Sources) -> Result<Self, CurriculumError> {
        Self::with_undrawable(scenario, sources, Undrawable::Refused)
    }

    /// As [`Plan::new`], and says what becomes of experiences whose worlds cannot be drawn: where they are skipped, no world that
    /// cannot be drawn is an error.
    ///
    /// # Errors
    /// As [`Plan::new`].
    pub fn with_undrawable(
        scenario: &Scenario,
        sources: &mut Sources,
        undrawable: Undrawable,
    ) -> Result<Self, CurriculumError> {
        let mut plan = Self {
            scenario: scenario.clone(),
            regimes: Vec::new(),
            fingerprints: BTreeMap::new(),
            notes: BTreeMap::new(),
            undrawable,
            tasks: BTreeMap::new(),
        };
        let mut finder = Finder {
            sources,
            tasks: BTreeMap::new(),
            worlds: BTreeMap::new(),
        };
        let mut log_names = LogNames::default();
        // For each variant and seed, the regimes in which it was learned.
        let mut rounds: BTreeMap<(String, u64), u64> = BTreeMap::new();
        let (mut first, mut learned) = (0, None);
        for (b, block) in scenario.blocks.iter().enumerate() {
            for (r, regime) in block.regimes.iter().enumerate() {
                let mut planned = plan.planned(&mut finder, (b, block), (r, regime), first, learned)?;
                first += u64::from(planned.count);
                log_names.claim(regime, &planned.log_name)?;
                if planned.kind == BlockKind::Learning {
                    learned = Some(plan.regimes.len());
                    let [begins, _] = planned.ends();
                    let rounds = rounds.entry((begins, planned.seed)).or_insert(0);
                    planned.learned_before = *rounds;
                    *rounds += 1;
                }
                plan.regimes.push(planned);
            }
        }
        plan.put_labels();
        plan.tasks = finder.tasks;
        Ok(plan)
    }

    /// Notes something else that its lifetime depends on, such as the bytes of an agent's script: a log is taken up again only if
    /// it is still the same. `what` is a name that is no variant's, so one without `#`.
    pub fn add_fingerprint(&mut self, what: &str, fingerprint: impl Into<Value>) {
        self.fingerprints.insert(what.to_owned(), fingerprint.into());
    }

    /// The scenario that it was made from.
    pub fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    /// How many experiences the whole lifetime has.
    pub fn num_experiences(&self) -> u64 {
        self.scenario.num_experiences()
    }

    /// The world of an experience, by its number over the whole lifetime.
    ///
    /// # Errors
    /// [`CurriculumError::World`] if it cannot be drawn; [`CurriculumError::NoSuchExperience`].
    pub fn world(&self, number: u64) -> Result<World, CurriculumError> {
        let total = self.num_experiences();
        if number >= total {
            return Err(CurriculumError::NoSuchExperience { found: number, total });
        }
        Ok(self.regimes[self.regime_of(number)].assignment(number, None)?.world)
    }

    /// What an experience is one of, by its number over the whole lifetime; its world is [`Plan::world`].
    ///
    /// # Errors
    /// [`CurriculumError::NoSuchExperience`].
    pub fn experience_spec(&self, number: u64) -> Result<ExperienceSpec<'_>, CurriculumError> {
        let total = self.num_experiences();
        if number >= total {
            return Err(CurriculumError::NoSuchExperience { found: number, total });
        }
        let planned = &self.regimes[self.regime_of(number)];
        let is_drawn = !matches!(planned.source, Source::World { .. });
        Ok(ExperienceSpec {
            block: planned.block,
            regime: planned.regime,
            kind: planned.kind,
            variant: &planned.id,
            seed: is_drawn.then_some(planned.seed),
            index: is_drawn.then(|| planned.index_of(number)),
            progress: planned.progress(number),
            chance: planned.chance(number),
            label: planned.label(number),
        })
    }

    /// The index of the regime that an experience belongs to.
    pub(super) fn regime_of(&self, number: u64) -> usize {
        // The first regime begins with experience 0.
        self.regimes.partition_point(|planned| planned.first <= number) - 1
    }

    /// What becomes of experiences whose worlds cannot be drawn.
    pub fn undrawable(&self) -> Undrawable {
        self.undrawable
    }

    /// Every task that it draws worlds of, by the name that the scenario calls it by.
    pub fn tasks(&self) -> &BTreeMap<String, Arc<TaskSpec>> {
        &self.tasks
    }

    /// Where the unbroken stretch of blocks of one kind that an experience belongs to ends.
    pub(super) fn end_of_kind(&self, number: u64) -> u64 {
        let here = self.regime_of(number);
        let kind = self.regimes[here].kind;
        let other = self.regimes[here..].iter().find(|planned| planned.kind != kind);
        other.map_or(self.num_experiences(), |planned| planned.first)
    }

    fn planned(
        &mut self,
        finder: &mut Finder,
        (b, block): (usize, &Block),
        (r, regime): (usize, &Regime),
        first: u64,
        learned: Option<usize>,
    ) -> Result<Planned, CurriculumError> {
        let source = finder.source(b, r, regime)?;
        let (id, log_name) = match &source {
            Source::Variant(variant) => (variant.id(), log_name(variant.task().name(), variant.name())),
            Source::Drift { from, to, .. } => {
                let task = from.task().name();
                let id = format!("{}..{}", from.id(), to.name());
                (id, log_name(task, &format!("{}to{}", from.name(), to.name())))
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
            count: regime.count,
            seed: regime.seed,
            first_index: regime.first_index,
            max_steps: regime.max_steps,
            source,
            learned_before: 0,
            learned,
            labels: None,
        };
        self.fingerprint(&planned)?;
        if let Source::World { path, .. } = &planned.source
            && let Some(note) = finder.worlds[path].1.clone()
        {
            self.notes.insert(path.clone(), note);
        }
        Ok(planned)
    }

    /// Takes down what a regime's worlds are made from.
    fn fingerprint(&mut self, planned: &Planned) -> Result<(), CurriculumError> {
        let undrawable = self.undrawable;
        let mut take = |variant: &Variant, is_lived: bool| {
            let Entry::Vacant(place) = self.fingerprints.entry(variant.id()) else {
                return Ok(());
            };
            // The variant says what all worlds are made from, the first world that they are still made in the same way.
            let world = match Sampler::new(variant, planned.seed).world(planned.first_index) {
                Ok(world) => Some(world.hash()),
                Err(source) if is_lived && undrawable == Undrawable::Refused => {
                    return Err(planned.wrong(planned.first, source));
                }
                Err(_) => None,
            };
            place.insert(json!({ "variant": variant.hash(), "first_world": world }));
            Ok(())
        };
        match &planned.source {
            Source::Variant(variant) => take(variant, true),
            Source::Drift { from, to, .. } => {
                take(from, planned.progress(planned.first) == 0.0)?;
                take(to, false)
            }
            Source::World { world, .. } => {
                let hash = || json!(world.hash());
                self.fingerprints.entry(planned.id.clone()).or_insert_with(hash);
                Ok(())
            }
        }
    }

    /// Gives the variants their labels, numbered in the order in which they come, where the scenario wants any.
    fn put_labels(&mut self) {
        let wanted = self.scenario.task_label;
        if wanted == TaskLabel::None {
            return;
        }
        let mut names: Vec<String> = Vec::new();
        let mut numbers: BTreeMap<String, usize> = BTreeMap::new();
        for id in self.regimes.iter().flat_map(Planned::ends) {
            let next = names.len();
            numbers.entry(id.clone()).or_insert_with(|| {
                names.push(id);
                next
            });
        }
        for planned in &mut self.regimes {
            planned.labels = Some(planned.ends().map(|name| Label {
                number: numbers[&name],
                of: names.len(),
                observed: wanted == TaskLabel::Observation,
                name,
            }));
        }
    }
}

impl Planned {
    /// The names of the variants that it begins with and ends with, which are one unless it drifts.
    fn ends(&self) -> [String; 2] {
        match &self.source {
            Source::Drift { from, to, .. } => [from.id(), to.id()],
            _ => [self.id.clone(), self.id.clone()],
        }
    }

    /// The label of experience `number`: in a drift that of the nearer end, by how far the drift has come; in the middle the
    /// one that it leads to.
    pub(super) fn label(&self, number: u64) -> Option<&Label> {
        let [from, to] = self.labels.as_ref()?;
        let Source::Drift { drift, .. } = &self.source else {
            return Some(from);
        };
        let come = Schedule::from(drift.schedule).at(drift.progress((number - self.first) as u32, self.count));
        Some(if come < 0.5 { from } else { to })
    }

    pub(super) fn wrong(&self, number: u64, source: GeneratorError) -> CurriculumError {
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

    /// What tells its drift from others between the same variants; nothing where it does not drift.
    pub(super) fn way(&self) -> String {
        match &self.source {
            Source::Drift { drift, .. } => format!(" {drift:?}"),
            _ => String::new(),
        }
    }

    /// The number of an experience's world under its seed.
    pub(super) fn index_of(&self, number: u64) -> u64 {
        self.first_index + (number - self.first)
    }

    /// The sampler of its worlds, where they are all drawn from one variant.
    pub(super) fn sampler(&self) -> Option<Sampler> {
        match &self.source {
            Source::Variant(variant) => Some(Sampler::new(variant, self.seed)),
            _ => None,
        }
    }

    /// What experience `number` of the lifetime is made of. `sampler` is this regime's own.
    pub(super) fn assignment(&self, number: u64, sampler: Option<&Sampler>) -> Result<Assignment, CurriculumError> {
        self.draw(number, sampler).map_err(|source| self.wrong(number, source))
    }

    /// As [`Planned::assignment`], with the error as the generator says it.
    pub(super) fn draw(&self, number: u64, sampler: Option<&Sampler>) -> Result<Assignment, GeneratorError> {
        let index = self.index_of(number);
        let between = self.variant_of(number)?;
        let mut world = match &self.source {
            Source::World { world, .. } => World::clone(world),
            Source::Variant(variant) => match sampler {
                Some(sampler) => sampler.world(index)?,
                None => Sampler::new(variant, self.seed).world(index)?,
            },
            Source::Drift { from, .. } => Sampler::new(between.as_ref().unwrap_or(from), self.seed).world(index)?,
        };
        if let Some(max_steps) = self.max_steps {
            world.limit_steps(max_steps);
        }
        Ok(Assignment { world, between })
    }

    /// The number that an agent begins an experience with.
    ///
    /// It is of the task, the seed and the world's number, and not of the variant: whoever acts by chance acts alike in two
    /// variants under one seed. Every evaluation of a world has the same, so that an agent that has not changed earns the
    /// same in it; what is learned in the same world again has another, so that a learner does not try the same again.
    pub(super) fn chance(&self, number: u64) -> u64 {
        let index = self.index_of(number);
        let mut hash = Sha256::new();
        let task = self.id.rsplit_once('#').map_or(self.id.as_str(), |(task, _)| task);
        hash.update(task.as_bytes());
        hash.update([0]);
        hash.update(self.seed.to_le_bytes());
        hash.update(index.to_le_bytes());
        if self.kind == BlockKind::Learning {
            hash.update(self.learned_before.to_le_bytes());
        }
        let digest = hash.finalize();
        digest.iter().take(8).fold(0, |seed, byte| seed << 8 | u64::from(*byte))
    }

    /// The variant that an experience is of, where its regime drifts.
    pub(super) fn variant_of(&self, number: u64) -> Result<Option<Variant>, GeneratorError> {
        let Source::Drift { way, drift, .. } = &self.source else {
            return Ok(None);
        };
        let experience = (number - self.first) as u32;
        way.at(drift.progress(experience, self.count), self.index_of(number))
            .map(Some)
    }

    /// What experience `number` is an experience of, under a name that is its own; `between` is its variant in a drift.
    pub(super) fn subject<'a>(&'a self, number: u64, between: Option<&'a Variant>) -> (String, Subject<'a>) {
        match (&self.source, between) {
            (Source::World { world, .. }, _) => (self.id.clone(), Subject::World(world)),
            (Source::Variant(variant), _) => (variant.id(), Subject::Variant(variant)),
            // On the way, chance may have made another variant of each experience.
            (Source::Drift { from, to, .. }, Some(variant)) if ![from.name(), to.name()].contains(&variant.name()) => {
                (format!("{}/{number}", variant.id()), Subject::Variant(variant))
            }
            (Source::Drift { from, .. }, between) => {
                let variant = between.unwrap_or(from);
                (variant.id(), Subject::Variant(variant))
            }
        }
    }

    /// The variant of its last experience that has one, where it drifts: on the way of a drift the task may forbid some.
    pub(super) fn last(&self) -> Option<Variant> {
        let mut numbers = (self.first..self.first + u64::from(self.count)).rev();
        numbers.find_map(|number| self.variant_of(number).transpose()?.ok())
    }

    /// The number of an experience's world among those of its variant and seed; NaN for a world from a file.
    pub(super) fn world_index(&self, number: u64) -> f64 {
        match self.source {
            Source::Variant(_) | Source::Drift { .. } => self.index_of(number) as f64,
            Source::World { .. } => f64::NAN,
        }
    }

    /// How far on its way a drift is in an experience, 0..=1; 0 where nothing drifts.
    pub(super) fn progress(&self, number: u64) -> f64 {
        match &self.source {
            Source::Drift { drift, .. } => drift.progress((number - self.first) as u32, self.count),
            Source::Variant(_) | Source::World { .. } => 0.0,
        }
    }

    /// What a log says of the experiences of this regime beside their numbers: the same of each, since programs that read
    /// logs take experiences with other parameters for other regimes.
    pub(super) fn params(&self) -> TaskParams {
        let mut params = Map::new();
        let mut say = |key: &str, value: Value| params.insert(key.to_owned(), value);
        match &self.source {
            Source::Variant(variant) => {
                say("task", json!(variant.task().name()));
                say("variant", json!(variant.name()));
                say("seed", json!(self.seed));
            }
            Source::Drift { from, to, .. } => {
                say("task", json!(from.task().name()));
                say("variant", json!(from.name()));
                say("to", json!(to.name()));
                say("seed", json!(self.seed));
            }
            Source::World { path, .. } => {
                let (task, variant) = self.id.split_once('#').unwrap_or((&self.id, ""));
                say("task", json!(task));
                say("variant", json!(variant));
                say("world", json!(path));
            }
        }
        if let Some(max_steps) = self.max_steps {
            say("max_steps", json!(max_steps));
        }
        if self.phase == Phase::PreDeployment {
            say("phase", json!("pre_deployment"));
        }
        TaskParams::from(params)
    }
}

/// Finds tasks and worlds, each once.
struct Finder<'a, 'b> {
    sources: &'a mut Sources<'b>,
    tasks: BTreeMap<String, Arc<TaskSpec>>,
    worlds: BTreeMap<String, (Arc<World>, Option<String>)>,
}

impl Finder<'_, '_> {
    fn source(&mut self, block: usize, regime_number: usize, regime: &Regime) -> Result<Source, CurriculumError> {
        if let Some(path) = &regime.world {
            if !self.worlds.contains_key(path) {
                let found = (self.sources.world)(path).map_err(|reason| CurriculumError::WorldFile {
                    block,
                    regime: regime_number,
                    reason,
                })?;
                self.worlds.insert(path.clone(), (Arc::new(found.world), found.note));
            }
            return Ok(Source::World {
                world: Arc::clone(&self.worlds[path].0),
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
        if !self.tasks.contains_key(&regime.task) {
            let task = (self.sources.task)(&regime.task).map_err(|reason| unknown(&regime.variant, reason))?;
            self.tasks.insert(regime.task.clone(), task);
        }
        let task = &self.tasks[&regime.task];
        let from = regime
            .resolve(task)
            .map_err(|error| unknown(&regime.variant, error.to_string()))?;
        let Some(drift) = &regime.drift else {
            return Ok(Source::Variant(from));
        };
        let to = regime
            .resolve_end(task)
            .map_err(|error| unknown(&drift.to, error.to_string()))?
            .expect("a regime with a drift has its end");
        let way = Drift::declared(drift, from.clone(), to.clone(), regime.seed);
        let way = way.map_err(|error| unknown(&drift.to, error.to_string()))?;
        Ok(Source::Drift {
            from,
            to,
            way: Box::new(way),
            drift: Box::new(drift.clone()),
        })
    }
}

/// The name of a variant in a log: letters and digits of the task's name, an underscore, those of the variant's.
///
/// The format wants `task_variant` with letters and digits alone: `find_objects` and `red` are `findobjects_red`. A name
/// without any is `x`.
pub fn log_name(task: &str, variant: &str) -> String {
    let plain = |text: &str| {
        let plain: String = text.chars().filter(char::is_ascii_alphanumeric).collect();
        if plain.is_empty() {
            "x".to_owned()
        } else {
            plain.to_lowercase()
        }
    };
    format!("{}_{}", plain(task), plain(variant))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_in_logs_are_letters_and_digits() {
        let check = |task: &str, variant: &str, expected: &str| assert_eq!(log_name(task, variant), expected);
        check("find_objects", "red", "findobjects_red");
        check("Task1", "map_findobjects_0", "task1_mapfindobjects0");
        check("tasks/my-own.json", "élan 2", "tasksmyownjson_lan2");
        check("任务", "#", "x_x");
    }
}
