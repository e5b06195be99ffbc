//! Living a scenario: experience after experience, each logged. Designing one is in `design.rs`, scoring it is `metrics`'.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use driftworld_env::{Agent, Catalogue, EnvError, Environment, Step};
use driftworld_generator::Sampler;
use driftworld_metrics::{BlockType, LogWriter, LoggerInfo, Record, ScenarioInfo, ScenarioType, TaskParams, Timestamp};
use driftworld_spec::{BlockKind, Regime, Scenario, Variant, World};
use serde_json::{Map, Value, json};

use crate::CurriculumError;

/// The columns that every experience is logged with, beside those that the format asks for.
pub const COLUMNS: [&str; 4] = ["reward", "success", "episode_step_count", "time_to_completion"];

/// What a run is handed, since it neither reads files nor looks at the clock.
pub struct Surroundings<'a> {
    /// Finds the variant of a task by the names in the scenario; an error is its message.
    pub find: &'a mut dyn FnMut(&str, &str) -> Result<Variant, String>,
    /// The time now.
    pub now: &'a mut dyn FnMut() -> Timestamp,
    /// Told after each experience; may end the run there. What was lived until then is in the log.
    pub watch: &'a mut dyn FnMut(&Progress) -> ControlFlow<()>,
    /// Where worlds take their assets from.
    pub catalogue: Catalogue,
}

/// How far a run has come.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// Experiences that are over.
    pub done: u64,
    /// Experiences of the whole lifetime.
    pub total: u64,
    /// The block of the last one, from 0.
    pub block: usize,
    /// Whether the agent learned in it.
    pub kind: BlockKind,
    /// Its variant, as `task#variant`.
    pub variant: String,
    /// What it paid.
    pub reward: f64,
}

/// What a lifetime came to.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct Summary {
    /// Experiences that were lived.
    pub experiences: u64,
    /// Steps in all of them.
    pub steps: u64,
    /// Whether the whole scenario was lived.
    pub finished: bool,
    /// One row for each regime that was begun.
    pub regimes: Vec<RegimeSummary>,
}

/// What a regime came to.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct RegimeSummary {
    /// The block, from 0.
    pub block: usize,
    /// Whether the agent learned.
    pub kind: BlockKind,
    /// The variant, as `task#variant`.
    pub variant: String,
    /// Experiences.
    pub experiences: u32,
    /// Mean of their rewards.
    pub mean_reward: f64,
    /// Share of them that were successes.
    pub success_rate: f64,
}

/// The logger's own description of what [`run`] writes.
///
/// # Errors
/// None today: the columns are this crate's own.
pub fn logger_info() -> Result<LoggerInfo, CurriculumError> {
    Ok(LoggerInfo::new(COLUMNS)?)
}

/// What the log says of a scenario: the scenario itself, and who lived it.
pub fn scenario_info(scenario: &Scenario, agent: &str) -> ScenarioInfo {
    let mut extra = Map::new();
    extra.insert("agent".to_owned(), json!(agent));
    extra.insert("scenario".to_owned(), json!(scenario));
    ScenarioInfo {
        scenario_type: Some(ScenarioType::Custom),
        extra,
        ..ScenarioInfo::default()
    }
}

/// The name of a variant in a log: letters and digits of the task's name, an underscore, those of the variant's.
///
/// The format wants `task_variant` with letters and digits alone: `find_objects#red` is `findobjects_red`.
pub fn log_name(variant: &Variant) -> String {
    let plain = |text: &str| {
        text.chars()
            .filter(char::is_ascii_alphanumeric)
            .collect::<String>()
            .to_lowercase()
    };
    format!("{}_{}", plain(variant.task().name()), plain(variant.name()))
}

/// Lives a scenario from its first experience to its last and logs each as soon as it is over.
///
/// The order of experiences, their worlds and the numbers that the agent begins them with depend on the scenario alone.
/// [`Agent::learn`] is called in learning blocks only.
///
/// # Errors
/// [`CurriculumError`] that says at which block, regime and experience; what was lived before is in the log.
pub fn run(
    scenario: &Scenario,
    agent: &mut dyn Agent,
    log: &mut LogWriter,
    around: &mut Surroundings,
) -> Result<Summary, CurriculumError> {
    let variants = find_all(scenario, around)?;
    let mut life = Life {
        agent,
        log,
        around,
        total: scenario.num_experiences(),
        summary: Summary::default(),
    };
    for (b, block) in scenario.blocks.iter().enumerate() {
        for (r, regime) in block.regimes.iter().enumerate() {
            let variant = &variants[&(regime.task.clone(), regime.variant.clone())];
            let place = Place {
                block: b,
                regime: r,
                kind: block.kind,
            };
            if life.regime(&place, regime, variant)?.is_break() {
                return Ok(life.summary);
            }
        }
    }
    life.summary.finished = true;
    Ok(life.summary)
}

type Variants = BTreeMap<(String, String), Variant>;

/// Every variant of the scenario, so that one that cannot be had is known before anything is lived.
fn find_all(scenario: &Scenario, around: &mut Surroundings) -> Result<Variants, CurriculumError> {
    let mut found = Variants::new();
    let mut names: BTreeMap<String, String> = BTreeMap::new();
    for (b, block) in scenario.blocks.iter().enumerate() {
        for (r, regime) in block.regimes.iter().enumerate() {
            let key = (regime.task.clone(), regime.variant.clone());
            if found.contains_key(&key) {
                continue;
            }
            let variant = (around.find)(&regime.task, &regime.variant).map_err(|reason| CurriculumError::Unknown {
                block: b,
                regime: r,
                task: regime.task.clone(),
                variant: regime.variant.clone(),
                reason,
            })?;
            let name = log_name(&variant);
            let called = format!("{}#{}", regime.task, regime.variant);
            if let Some(other) = names.insert(name.clone(), called.clone()) {
                return Err(CurriculumError::SameLogName {
                    a: other,
                    b: called,
                    name,
                });
            }
            found.insert(key, variant);
        }
    }
    Ok(found)
}

/// Where in the scenario a regime is.
struct Place {
    block: usize,
    regime: usize,
    kind: BlockKind,
}

/// A lifetime under way.
struct Life<'a, 'b> {
    agent: &'a mut dyn Agent,
    log: &'a mut LogWriter,
    around: &'a mut Surroundings<'b>,
    total: u64,
    summary: Summary,
}

/// One experience that is over.
struct Experience {
    reward: f64,
    steps: u32,
    success: bool,
    seconds: f64,
}

impl Life<'_, '_> {
    fn regime(
        &mut self,
        place: &Place,
        regime: &Regime,
        variant: &Variant,
    ) -> Result<ControlFlow<()>, CurriculumError> {
        let wrong = |source| CurriculumError::World {
            block: place.block,
            regime: place.regime,
            source,
        };
        let sampler = Sampler::new(variant, regime.seed);
        let name = log_name(variant);
        self.summary.regimes.push(RegimeSummary {
            block: place.block,
            kind: place.kind,
            variant: variant.id(),
            experiences: 0,
            mean_reward: 0.0,
            success_rate: 0.0,
        });
        let mut environment: Option<Environment> = None;
        for index in regime.first_index..regime.first_index + u64::from(regime.count) {
            let world = sampler.world(index).map_err(wrong)?;
            let number = self.summary.experiences;
            let failed = |source| CurriculumError::Episode {
                block: place.block,
                regime: place.regime,
                experience: number,
                source,
            };
            let environment = match &mut environment {
                Some(environment) => {
                    environment.reset(world).map_err(failed)?;
                    environment
                }
                None => environment.insert(self.first_environment(world).map_err(failed)?),
            };
            let experience = self.episode(environment, place.kind).map_err(failed)?;
            self.record(place, &name, params(regime, variant, index), &experience)?;
            if self.tell(place, variant, &experience).is_break() {
                return Ok(ControlFlow::Break(()));
            }
        }
        Ok(ControlFlow::Continue(()))
    }

    fn first_environment(&self, world: World) -> Result<Environment, EnvError> {
        Environment::with_catalogue(world, self.around.catalogue.clone())
    }

    fn episode(&mut self, environment: &mut Environment, kind: BlockKind) -> Result<Experience, EnvError> {
        self.agent.begin(self.summary.experiences);
        // A world without a limit of steps and without an end would never be over.
        let limit = if environment.world().max_steps == 0 {
            MOST_STEPS
        } else {
            u32::MAX
        };
        let mut last = Step::default();
        while !environment.ended() && environment.num_steps() < limit {
            let action = self.agent.act(environment);
            last = environment.step(action)?;
            if kind == BlockKind::Learning {
                self.agent.learn(environment, &last);
            }
        }
        let steps = environment.num_steps();
        Ok(Experience {
            reward: environment.episode_return(),
            steps,
            success: last.success,
            seconds: f64::from(steps) * environment.world().agent_params.time_step,
        })
    }

    fn record(
        &mut self,
        place: &Place,
        name: &str,
        params: TaskParams,
        experience: &Experience,
    ) -> Result<(), CurriculumError> {
        let kind = if place.kind == BlockKind::Learning {
            BlockType::Train
        } else {
            BlockType::Test
        };
        let values = [
            experience.reward,
            f64::from(u8::from(experience.success)),
            f64::from(experience.steps),
            experience.seconds,
        ];
        let record = Record::new(
            place.block as u64,
            self.summary.experiences,
            kind,
            name,
            (self.around.now)(),
        );
        let record = COLUMNS
            .into_iter()
            .zip(values)
            .fold(record, |record, (name, value)| record.with_metric(name, value));
        Ok(self.log.write(&record.with_task_params(params))?)
    }

    /// Counts an experience and tells whoever watches.
    fn tell(&mut self, place: &Place, variant: &Variant, experience: &Experience) -> ControlFlow<()> {
        self.summary.experiences += 1;
        self.summary.steps += u64::from(experience.steps);
        if let Some(row) = self.summary.regimes.last_mut() {
            let before = f64::from(row.experiences);
            row.experiences += 1;
            let mean = |old: f64, new: f64| (old * before + new) / (before + 1.0);
            row.mean_reward = mean(row.mean_reward, experience.reward);
            row.success_rate = mean(row.success_rate, f64::from(u8::from(experience.success)));
        }
        (self.around.watch)(&Progress {
            done: self.summary.experiences,
            total: self.total,
            block: place.block,
            kind: place.kind,
            variant: variant.id(),
            reward: experience.reward,
        })
    }
}

/// Steps after which an experience in a world without a limit is over.
const MOST_STEPS: u32 = 100_000;

fn params(regime: &Regime, variant: &Variant, index: u64) -> TaskParams {
    let entries: [(&str, Value); 4] = [
        ("task", json!(variant.task().name())),
        ("variant", json!(variant.name())),
        ("seed", json!(regime.seed)),
        ("index", json!(index)),
    ];
    let map: Map<String, Value> = entries
        .into_iter()
        .map(|(key, value)| (key.to_owned(), value))
        .collect();
    TaskParams::from(map)
}
