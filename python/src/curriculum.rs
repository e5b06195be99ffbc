//! Scenarios and logs for Python; the agent and its environment are in `package/driftworld/curricula.py`.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use driftworld::clock::Clock;
use driftworld::scenarios::{Named, ScenarioFile, task_from};
use driftworld::tasks::TaskError;
use driftworld_curriculum::{
    CurriculumError, Experience, FoundWorld, Journal, MOST_STEPS, Plan, Progress, REPEATED_EVALUATIONS, Repeats,
    Rollout, Tried, Undrawable, run_rollout,
};
use driftworld_env::Recording;
use driftworld_spec::{BlockKind, Scenario, TaskSpec, World};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde_json::json;

use crate::covered::covered_in;
use crate::document::Whole;
use crate::errors::{Error, Result, wrong};
use crate::json::{from_python, to_py};
use crate::recordings::PyRecording;
use crate::rounding::detach;
use crate::supply::{PyStream, Stream};

/// A scenario with everything that it refers to.
#[pyclass(name = "Plan", module = "driftworld._native")]
pub(crate) struct PyPlan {
    plan: Plan,
    /// The documents that it was made from: later changes to the files do not affect it.
    named: Named,
    warnings: Vec<String>,
}

/// A plan as values: the scenario's text; for each task its name in the scenario, its own name and its text; for each world
/// file its name in the scenario, its text and additional information; and the warnings.
type Values = (
    String,
    Vec<(String, String, String)>,
    Vec<(String, String, Option<String>)>,
    Vec<String>,
);

fn undrawable(skip: bool) -> Undrawable {
    if skip { Undrawable::Skipped } else { Undrawable::Refused }
}

#[pymethods]
impl PyPlan {
    /// The plan of a scenario's text; paths in it are resolved as if it were at `path`. A world that cannot be drawn is an
    /// error if it is the first of a regime, unless such worlds are left out.
    #[new]
    fn new(py: Python<'_>, path: PathBuf, text: &str, stand_in: Option<bool>, skip_undrawable: bool) -> Result<Self> {
        let mut warnings = Vec::new();
        let (plan, named) = detach(py, || {
            let mut warn = |warning| warnings.push(warning);
            let file = ScenarioFile::from_text(Path::new(&path), text, &mut warn)?;
            // L2Explorer's own scenario refers to a map that is not included with it, and has to run unchanged.
            let may_stand_in = stand_in.unwrap_or(file.original);
            let planned = file.plan_named(may_stand_in, undrawable(skip_undrawable), &mut warn);
            planned.map_err(|error| because(&path, error))
        })?;
        Ok(Self { plan, named, warnings })
    }

    /// The plan made from these values.
    #[staticmethod]
    fn from_values(py: Python<'_>, values: Values, skip_undrawable: bool) -> Result<Self> {
        let (scenario, tasks, worlds, warnings) = values;
        let (plan, named) = detach(py, || {
            let mut named = Named::default();
            for (called, name, text) in tasks {
                named.tasks.insert(called, TaskSpec::from_json(&name, &text)?);
            }
            for (called, text, note) in worlds {
                let world = World::from_json(&called, &text)?;
                named.worlds.insert(called, FoundWorld { world, note });
            }
            let find = |task: &str| named.tasks.get(task).cloned();
            let scenario = Scenario::from_json_with("scenario", &scenario, find)?;
            Ok::<_, Error>((named.plan(&scenario, undrawable(skip_undrawable))?, named))
        })?;
        Ok(Self { plan, named, warnings })
    }

    /// All values that it was made from: equal values give equal plans.
    fn values(&self) -> Values {
        let tasks = self.named.tasks.iter();
        let worlds = self.named.worlds.iter();
        (
            self.plan.scenario().to_json_pretty(),
            tasks
                .map(|(called, task)| (called.clone(), task.name().to_owned(), task.to_json()))
                .collect(),
            worlds
                .map(|(called, found)| (called.clone(), found.world.to_json(), found.note.clone()))
                .collect(),
            self.warnings.clone(),
        )
    }

    /// Recreates the plan in another process, even if its files are missing there or have changed.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (Values, bool))> {
        let plan = slf.borrow();
        let skips = plan.plan.undrawable() == Undrawable::Skipped;
        Ok((slf.get_type().getattr("from_values")?, (plan.values(), skips)))
    }

    /// The warnings about it.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }

    /// The scenario as a dictionary, in our format.
    fn scenario<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        Ok(to_py(py, self.plan.scenario())?)
    }

    /// The scenario as the contents of a file.
    fn text(&self) -> String {
        self.plan.scenario().to_json_pretty()
    }

    /// Number of experiences of the whole lifetime.
    fn __len__(&self) -> usize {
        usize::try_from(self.plan.num_experiences()).unwrap_or(usize::MAX)
    }

    /// Experience `number` as a dictionary, without its world.
    fn experience_spec<'py>(&self, py: Python<'py>, number: Whole) -> Result<Bound<'py, PyAny>> {
        let spec = self.plan.experience_spec(number.0)?;
        let label = spec.label.map(
            |label| json!({ "number": label.number, "of": label.of, "name": label.name, "observed": label.observed }),
        );
        let dictionary = json!({
            "number": number.0, "block": spec.block, "regime": spec.regime, "learning": spec.kind == BlockKind::Learning,
            "variant": spec.variant, "seed": spec.seed, "index": spec.index, "progress": spec.progress,
            "chance": spec.agent_seed, "steps": spec.steps, "label": label,
        });
        Ok(to_py(py, &dictionary)?)
    }

    /// The experience that follows when the budget of experience `number`'s regime is spent.
    fn after(&self, number: u64) -> u64 {
        self.plan.after(number)
    }

    /// The indices of the first and the last experience of each regime: all variants, and both ends of each drift.
    fn ends_of_regimes(&self) -> Vec<u64> {
        self.plan.ends_of_regimes().collect()
    }

    /// The differences between its variants that options of environments hide: see `covered.rs`.
    fn covered(&self, py: Python<'_>, overrides: &str, shown: Option<&str>) -> Result<String> {
        detach(py, || covered_in(&self.plan, overrides, shown))
    }

    /// The world of experience `number`; a world without any limit gets a step limit.
    fn world(&self, py: Python<'_>, number: Whole) -> Result<PyStream> {
        handle(detach(py, || self.plan.world(number.0))?)
    }

    /// Draws this many worlds of each regime, and reports failures and their reasons: a list of dictionaries.
    fn try_worlds<'py>(&self, py: Python<'py>, worlds: u32) -> Result<Bound<'py, PyAny>> {
        let trials = detach(py, || self.plan.try_worlds(worlds, &mut Tried::default()));
        Ok(to_py(py, &trials)?)
    }

    /// Sets the number of environments that run at the same time.
    fn set_lanes(&mut self, lanes: usize) {
        self.plan.set_lanes(lanes);
    }

    /// Records the run's seed: a log can be resumed only with the same one.
    fn set_run_seed(&mut self, seed: u64) {
        self.plan.set_run_seed(seed);
    }

    fn add_fingerprint(&mut self, what: &str, print: &Bound<'_, PyAny>) -> Result<()> {
        self.plan.add_fingerprint(what, from_python(print)?);
        Ok(())
    }
}

/// Converts a plan's error; if a task's document caused it, includes the document's problems.
fn because(scenario: &Path, error: CurriculumError) -> Error {
    if let CurriculumError::Unknown { task, .. } = &error
        && let Err(TaskError::Spec(source)) = task_from(scenario, task)
    {
        return Error::InScenario(error, source);
    }
    error.into()
}

/// The log of a lifetime.
#[pyclass(name = "Journal", module = "driftworld._native")]
pub(crate) struct PyJournal(Option<Journal>);

#[pymethods]
impl PyJournal {
    /// Begins or resumes a log.
    #[new]
    fn new(
        py: Python<'_>,
        folder: PathBuf,
        plan: &Bound<'_, PyPlan>,
        agent: &str,
        resume: bool,
        record: bool,
    ) -> Result<Self> {
        let plan = &plan.borrow().plan;
        let mut journal = detach(py, || {
            if resume {
                Journal::resume(&folder, plan, agent)
            } else {
                Journal::create(&folder, plan, agent)
            }
        })?;
        if record {
            journal.record();
        }
        Ok(Self(Some(journal)))
    }

    /// Whether it keeps recordings; if so, the rollout is asked for them.
    #[getter]
    fn records(&mut self) -> Result<bool> {
        Ok(self.open()?.records())
    }

    /// Runs the plan from the first experience that is not in the log, and returns the result as a dictionary. `learned`:
    /// number of experiences that the agent has learned from. `rollout` has the methods of [`Rollout`]. `check_frozen`: whether
    /// to repeat some evaluations of each block; the rollout's attribute `repeats_first` says whether these are the first ones.
    fn run<'py>(
        &mut self,
        py: Python<'py>,
        plan: &Bound<'py, PyPlan>,
        rollout: Bound<'py, PyAny>,
        learned: Whole,
        check_frozen: bool,
    ) -> Result<Bound<'py, PyAny>> {
        let clock = Clock::from_environment().map_err(wrong)?;
        let repeats = Repeats {
            count: if check_frozen { REPEATED_EVALUATIONS } else { 0 },
            first: rollout.getattr("repeats_first")?.extract()?,
        };
        let (plan, mut rollout) = (&plan.borrow().plan, PythonRollout { rollout, repeats });
        let summary = run_rollout(plan, &mut rollout, self.open()?, learned.0, &mut || clock.now())?;
        Ok(to_py(py, &summary)?)
    }

    /// Removes the last logged block, after the agent was refused because of it.
    fn withdraw_block(&mut self) -> Result<()> {
        Ok(self.open()?.withdraw_block()?)
    }

    /// Number of experiences in the log.
    fn __len__(&mut self) -> Result<usize> {
        let logged = self.open()?.num_experiences();
        Ok(usize::try_from(logged).unwrap_or(usize::MAX))
    }

    /// Closes the log and syncs it to disk. A second call does nothing.
    fn close(&mut self) -> Result<()> {
        self.0.take().map_or(Ok(()), |journal| Ok(journal.finish()?))
    }
}

impl PyJournal {
    fn open(&mut self) -> PyResult<&mut Journal> {
        self.0
            .as_mut()
            .ok_or_else(|| PyValueError::new_err("log: found it closed, expected an open one"))
    }
}

/// A world for Python; one without any limit gets a step limit.
fn handle(world: World) -> Result<PyStream> {
    let world = match world.step_limit() {
        Some(_) => world,
        None => world.edit(|world| world.max_steps = MOST_STEPS)?,
    };
    Ok(PyStream(Stream::World {
        world: Arc::new(world),
        name: "world".to_owned(),
    }))
}

/// A Python agent with its environment, implemented in `package/driftworld/lifetimes.py`.
struct PythonRollout<'py> {
    rollout: Bound<'py, PyAny>,
    repeats: Repeats,
}

impl Rollout for PythonRollout<'_> {
    type Error = Error;

    fn repeats(&self) -> Repeats {
        self.repeats
    }

    fn begin_block(&mut self, learning: bool, repeated: &[u64]) -> Result<()> {
        self.rollout
            .call_method1("begin_block", (learning, repeated.to_vec()))?;
        Ok(())
    }

    fn experience(&mut self, number: u64, world: World) -> Result<Option<Experience>> {
        let agent = &world.agent_params;
        let time = (agent.time_step, agent.frame_skip.max(1), world.max_seconds);
        let outcome = self
            .rollout
            .call_method1("experience", (number, handle(world)?, time))?;
        let (reward, success, steps, seconds, truncated, ended_by) = outcome.extract()?;
        let ended_by: Option<String> = ended_by;
        Ok(Some(Experience {
            reward,
            success,
            steps,
            seconds,
            truncated,
            ended_by: ended_by.and_then(|word| word.parse().ok()),
        }))
    }

    fn recording(&mut self, number: u64, experience: &Experience) -> Result<Option<Recording>> {
        let found = self.rollout.call_method1("recording", (number,))?;
        let found: Option<Bound<'_, PyRecording>> = found.extract().map_err(PyErr::from)?;
        // A limit set from outside may also have ended the episode.
        Ok(found.map(|recording| Recording {
            ended_by: experience.ended_by,
            ..Recording::clone(&recording.get().0)
        }))
    }

    fn end_learning(&mut self, done: u64) -> Result<()> {
        self.rollout.call_method1("end_learning", (done,))?;
        Ok(())
    }

    fn logged(&mut self, progress: &Progress, reward: Option<f64>) -> Result<ControlFlow<()>> {
        let reward = reward.unwrap_or(f64::NAN);
        let goes_on: bool = self
            .rollout
            .call_method1("logged", (progress.done - 1, reward))?
            .extract()?;
        Ok(if goes_on {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        })
    }
}
