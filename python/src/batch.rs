//! [`PyBatch`]: environments that step together, with their buffers as arrays. Single environments are batches of one.
//!
//! `package/driftworld/envs/` adds spaces, infos and Gymnasium's rules.

use std::num::NonZeroU32;
use std::str::FromStr;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};

use driftworld::tasks::{check_variants, check_world};
use driftworld_env::{
    Action, Batch, BatchOptions, Catalogue, Effect, EndedBy, EnvError, Event, GoOn, RendererKind, WorldSource, top_down,
};
use driftworld_spec::{Modality, TaskSpec, Variant};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::classes::catalogue;
use crate::errors::{Error, Result};
use crate::interruptible::run_between_envs;
use crate::recordings::PyRecording;
use crate::rounding::{detach, usually_rounded};
use crate::supply::{Origin, PyStream, Stream, Supply, overrides_of};
use crate::views::views;

/// Environments that step together.
#[pyclass(name = "Batch", module = "driftworld._native", frozen)]
pub(crate) struct PyBatch {
    /// Used by one thread at a time; a second one gets an error.
    stepping: Mutex<Stepping>,
    supplies: Vec<Arc<Supply>>,
    known: Known,
    /// The process that created the batch: its threads exist only there.
    process: u32,
}

/// The known classes and models, and the tasks that were checked to use no others.
struct Known {
    catalogue: Catalogue,
    tasks: Mutex<Vec<Arc<TaskSpec>>>,
}

impl Known {
    /// Refuses a stream of worlds with objects of unknown classes or models.
    fn check(&self, stream: &Stream) -> Result<()> {
        let mut known = self.tasks.lock().unwrap_or_else(PoisonError::into_inner);
        let check = |variant: &Variant| -> Result<()> {
            if !known.iter().any(|task| Arc::ptr_eq(task, variant.task())) {
                check_variants([variant], &self.catalogue)?;
                known.push(Arc::clone(variant.task()));
            }
            Ok(())
        };
        match stream {
            Stream::Variants { variants, .. } => variants.iter().try_for_each(check),
            Stream::Drift { drift, .. } => [drift.at(0.0, 0)?, drift.at(1.0, 0)?].iter().try_for_each(check),
            Stream::World { world, name } => Ok(check_world(name, world, &self.catalogue)?),
        }
    }
}

/// The state that steps change.
struct Stepping {
    batch: Batch,
    /// The actions of a step, in a reused buffer.
    actions: Vec<Action>,
}

/// Results of a step besides observations: rewards, terminated, truncated, success, and the indices of environments with
/// events.
type Stepped<'py> = (
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<bool>>,
    Bound<'py, PyArray1<bool>>,
    Bound<'py, PyArray1<bool>>,
    Vec<usize>,
);

#[pymethods]
impl PyBatch {
    /// One environment per stream, at the start of world 0 under seed 0.
    #[new]
    #[pyo3(signature = (streams, overrides, autoreset, num_threads, renderer, depth, libraries, modalities, max_episode_steps=None))]
    #[expect(clippy::too_many_arguments, reason = "called from one place, by name")]
    fn new(
        py: Python<'_>,
        streams: Vec<Bound<'_, PyStream>>,
        overrides: &str,
        autoreset: &str,
        num_threads: usize,
        renderer: &str,
        depth: &str,
        libraries: Vec<Vec<u8>>,
        modalities: &str,
        max_episode_steps: Option<NonZeroU32>,
    ) -> Result<Self> {
        let overrides = Arc::new(overrides_of(overrides)?);
        let modalities: Vec<Modality> = serde_json::from_str(modalities).map_err(|error| {
            PyValueError::new_err(format!("modalities: {error}, expected a list of image modalities"))
        })?;
        let supply =
            |stream: &Bound<'_, PyStream>| Arc::new(Supply::new(stream.get().0.clone(), Arc::clone(&overrides)));
        let supplies: Vec<Arc<Supply>> = streams.iter().map(supply).collect();
        let known = Known {
            catalogue: catalogue(&libraries)?,
            tasks: Mutex::default(),
        };
        streams.iter().try_for_each(|stream| known.check(&stream.get().0))?;
        let options = BatchOptions {
            autoreset: word("autoreset_mode", autoreset, "next_step, same_step or disabled")?,
            num_threads,
            renderer: RendererKind::from_str(renderer)?,
            depth: word("depth", depth, "uint8, uint16 or float32")?,
            modalities: Some(modalities),
            max_episode_steps,
        };
        let make = |go_on: GoOn<'_>| {
            let worlds = supplies.clone();
            let source: WorldSource = Arc::new(move |episode| worlds[episode.env].world());
            Batch::with_catalogue_while(supplies.len(), source, options, &known.catalogue, go_on)
        };
        let batch = run_between_envs(py, supplies.len(), make)?;
        let actions = Vec::with_capacity(supplies.len());
        Ok(Self {
            stepping: Mutex::new(Stepping { batch, actions }),
            supplies,
            known,
            process: std::process::id(),
        })
    }

    /// The renderer: `cpu` or `gpu`.
    #[getter]
    fn renderer(&self) -> Result<&'static str> {
        Ok(self.lock()?.batch.renderer().into())
    }

    /// Makes an environment draw its worlds with a different seed, starting at this index.
    fn seed(&self, env: usize, seed: u64, index: u64) -> Result<()> {
        self.supply(env)?.seed(seed, index);
        Ok(())
    }

    /// Makes an environment continue with the world of this index.
    fn index(&self, env: usize, index: u64) -> Result<()> {
        self.supply(env)?.index(index);
        Ok(())
    }

    /// Makes an environment take its worlds from another stream, from its next episode on.
    fn stream(&self, env: usize, stream: &Bound<'_, PyStream>) -> Result<()> {
        self.known.check(&stream.get().0)?;
        self.supply(env)?.stream(stream.get().0.clone());
        Ok(())
    }

    /// Gives an environment the world of a stream for its next episode.
    fn give(&self, env: usize, stream: &Bound<'_, PyStream>) -> Result<()> {
        let stream = &stream.get().0;
        let world = stream.single()?;
        self.known.check(stream)?;
        self.supply(env)?.give(world.clone());
        Ok(())
    }

    /// Seed, next index and turn of an environment's supply.
    fn place(&self, env: usize) -> Result<(u64, u64, u64)> {
        Ok(self.supply(env)?.place())
    }

    /// Moves an environment's supply to this place.
    fn set_place(&self, env: usize, place: (u64, u64, u64)) -> Result<()> {
        self.supply(env)?.set_place(place);
        Ok(())
    }

    /// Steps of an environment's current episode, as counted for `max_episode_steps`.
    fn episode_steps(&self, env: usize) -> Result<u32> {
        let steps = self.lock()?.batch.episode_steps(env);
        of_env(steps, env, self.supplies.len())
    }

    /// Sets the number that `episode_steps` returns.
    fn set_episode_steps(&self, env: usize, steps: u32) -> Result<()> {
        Ok(self.lock()?.batch.set_episode_steps(env, steps)?)
    }

    /// Begins the next episode in all environments, or in those where `mask` is true. After Ctrl-C, some may not have begun.
    #[pyo3(signature = (mask=None))]
    fn reset(&self, py: Python<'_>, mask: Option<PyReadonlyArray1<'_, bool>>) -> Result<()> {
        self.expect_own_process()?;
        let chosen = mask.map_or_else(|| vec![true; self.supplies.len()], |mask| mask.as_array().to_vec());
        let mut stepping = self.lock()?;
        let batch = &mut stepping.batch;
        let count = chosen.iter().filter(|is_chosen| **is_chosen).count();
        run_between_envs(py, count, |go_on| batch.reset_where_while(&chosen, go_on))
    }

    /// One step with numeric actions, `(num_envs, 3)`, or `(num_envs, 2)` without interaction.
    fn step_numbers<'py>(&self, py: Python<'py>, actions: PyReadonlyArray2<'py, f64>) -> Result<Stepped<'py>> {
        let mut stepping = self.lock()?;
        let actions = actions.as_array();
        stepping.actions.clear();
        stepping.actions.extend(
            actions
                .rows()
                .into_iter()
                .map(|row| number_action(|column| row.get(column).copied())),
        );
        self.go(py, &mut stepping)?;
        Ok(stepping.stepped(py))
    }

    /// One step with rows of the action table, `(num_envs,)`.
    fn step_rows<'py>(&self, py: Python<'py>, actions: PyReadonlyArray1<'py, i64>) -> Result<Stepped<'py>> {
        let mut stepping = self.lock()?;
        let rows = actions.as_array();
        stepping.actions.clear();
        stepping.actions.extend(rows.iter().copied().map(row_action));
        let done = self.go(py, &mut stepping);
        done.map_err(|error| no_row(error, |env| rows.get(env).copied()))?;
        Ok(stepping.stepped(py))
    }

    /// One step of the only environment, by numbers: reward, terminated, truncated, success, and whether there were events.
    fn step_one_by_numbers(&self, py: Python<'_>, numbers: Vec<f64>) -> Result<(f64, bool, bool, bool, bool)> {
        self.step_one(py, number_action(|column| numbers.get(column).copied()))
    }

    /// Like `step_one_by_numbers`, with a row of the action table.
    fn step_one_by_row(&self, py: Python<'_>, row: i64) -> Result<(f64, bool, bool, bool, bool)> {
        let done = self.step_one(py, row_action(row));
        done.map_err(|error| no_row(error, |_| Some(row)))
    }

    /// The cause of an episode's end in an environment's last step, as a word; `None` if it did not end.
    fn ended_by(&self, env: usize) -> Result<Option<&'static str>> {
        Ok(self.lock()?.batch.ended_by(env).map(EndedBy::word))
    }

    /// Repeats the last step's actions this many times without returning to Python: the speed of the batch alone.
    fn repeat(&self, py: Python<'_>, steps: u64) -> Result<()> {
        self.expect_own_process()?;
        let mut stepping = self.lock()?;
        let mut left = steps;
        while left > 0 {
            let now = left.min(256);
            let Stepping { batch, actions } = &mut *stepping;
            detach(py, || (0..now).try_for_each(|_| batch.step(actions)))?;
            left -= now;
            py.check_signals()?;
        }
        Ok(())
    }

    /// The observation buffers as read-only arrays that share their memory, by modality: `(num_envs, height, width, channels)`,
    /// and `state` `(num_envs, 1, 1, n)`.
    fn buffers(slf: Bound<'_, Self>) -> Result<Bound<'_, PyDict>> {
        let stepping = slf.get().lock()?;
        views(&slf, stepping.batch.outputs())
    }

    /// Like `buffers`, for the last observations of episodes that ended in the last step; `None` unless the autoreset mode is
    /// `same_step`.
    fn final_buffers(slf: Bound<'_, Self>) -> Result<Option<Bound<'_, PyDict>>> {
        let stepping = slf.get().lock()?;
        let finals = stepping.batch.final_outputs();
        finals.map(|outputs| views(&slf, outputs)).transpose()
    }

    /// Task, variant, seed, index and hash of an environment's world.
    fn origin(&self, env: usize) -> Result<Origin> {
        Ok(self.supply(env)?.origin())
    }

    /// Events in an environment during the last step.
    fn events<'py>(&self, py: Python<'py>, env: usize) -> Result<Bound<'py, PyTuple>> {
        let stepping = self.lock()?;
        let events = stepping.batch.events(env).unwrap_or_default();
        let events: PyResult<Vec<_>> = events.iter().map(|event| to_py(py, event)).collect();
        Ok(PyTuple::new(py, events?)?)
    }

    /// Starts or stops recording, in one environment or in all.
    #[pyo3(signature = (records, env=None))]
    fn record(&self, records: bool, env: Option<usize>) -> Result<()> {
        let batch = &mut self.lock()?.batch;
        batch.set_recording(env, records);
        Ok(())
    }

    /// The recording of an environment's episode so far; before its first step, that of the previous episode. `None` unless it
    /// was recorded.
    fn recording(&self, env: usize) -> Result<Option<PyRecording>> {
        Ok(self.lock()?.batch.recording(env).map(PyRecording::from))
    }

    /// The JSON of the current state of an environment's world.
    fn state(&self, env: usize) -> Result<String> {
        let stepping = self.lock()?;
        let environment = stepping.environment(env)?;
        Ok(usually_rounded(|| environment.state().to_json()))
    }

    /// Warnings about settings of an environment's world that may be unintended.
    fn warnings(&self, env: usize) -> Result<Vec<String>> {
        let stepping = self.lock()?;
        let environment = stepping.environment(env)?;
        let warnings = environment.warnings();
        let remarks = environment.world().remarks_without_text().into_iter();
        let remarks = remarks.map(|remark| format!("{}: {}", remark.pointer, remark.text));
        Ok(warnings.iter().map(ToString::to_string).chain(remarks).collect())
    }

    /// An image of an environment, `(height, width, 3)` bytes: its agent's view, or the world from above.
    fn picture<'py>(
        &self,
        py: Python<'py>,
        env: usize,
        height: u32,
        width: u32,
        from_above: bool,
    ) -> Result<Bound<'py, PyAny>> {
        let stepping = self.lock()?;
        let environment = stepping.environment(env)?;
        let sides = 1..=4096;
        if !sides.contains(&height) || !sides.contains(&width) {
            return Err(EnvError::PictureSize { width, height }.into());
        }
        let scene = environment.scene();
        let pixels = detach(py, || {
            if from_above {
                let agent = environment.agent();
                top_down(scene, width, height, Some((agent.position, agent.heading_deg))).rgb
            } else {
                let mut frame = driftworld_env::Frame::new(width, height);
                let mut renderer = driftworld_env::CpuRenderer::new();
                renderer.render(scene, &environment.camera(), &mut frame);
                environment.draw_carried(&mut renderer, &mut frame.target());
                frame.rgb
            }
        });
        let picture = PyArray1::from_vec(py, pixels);
        Ok(picture.reshape([height as usize, width as usize, 3])?.into_any())
    }
}

impl PyBatch {
    /// Locks the state that steps and resets change, for one thread at a time.
    fn lock(&self) -> PyResult<MutexGuard<'_, Stepping>> {
        match self.stepping.try_lock() {
            Ok(stepping) => Ok(stepping),
            // A panic in one environment does not affect the others, because each has its own state.
            Err(TryLockError::Poisoned(poisoned)) => Ok(PoisonError::into_inner(poisoned)),
            Err(TryLockError::WouldBlock) => Err(PyRuntimeError::new_err(
                "environment: found it in use by another thread, expected one thread at a time; make an environment for each \
                 thread, or hold a lock around its calls",
            )),
        }
    }

    fn step_one(&self, py: Python<'_>, action: Action) -> Result<(f64, bool, bool, bool, bool)> {
        let mut stepping = self.lock()?;
        stepping.actions.clear();
        stepping.actions.push(action);
        self.go(py, &mut stepping)?;
        let outputs = stepping.batch.outputs();
        let eventful = stepping.batch.events(0).is_some_and(|events| !events.is_empty());
        let [reward] = outputs.rewards[..] else {
            return Err(PyRuntimeError::new_err("found a batch of several environments, expected one").into());
        };
        Ok((
            reward,
            outputs.terminated[0],
            outputs.truncated[0],
            outputs.success[0],
            eventful,
        ))
    }

    /// One step with the prepared actions.
    fn go(&self, py: Python<'_>, stepping: &mut Stepping) -> Result<()> {
        self.expect_own_process()?;
        let Stepping { batch, actions } = stepping;
        detach(py, || batch.step(actions)).map_err(|error| match error {
            // With a single environment, the message needs no index.
            EnvError::BatchAction { error, .. } if actions.len() == 1 => *error,
            error => error,
        })?;
        Ok(())
    }

    fn supply(&self, env: usize) -> Result<&Supply> {
        of_env(self.supplies.get(env).map(AsRef::as_ref), env, self.supplies.len())
    }

    /// Threads do not survive a fork, so a step would wait forever.
    fn expect_own_process(&self) -> Result<()> {
        let here = std::process::id();
        if here == self.process {
            return Ok(());
        }
        Err(Error::Python(PyRuntimeError::new_err(format!(
            "found an environment of process {} in process {here}, expected one made here; make environments after the fork, or \
             send a pickled one",
            self.process
        ))))
    }
}

impl Stepping {
    /// Results of the last step.
    fn stepped<'py>(&self, py: Python<'py>) -> Stepped<'py> {
        let outputs = self.batch.outputs();
        let eventful = |env: &usize| self.batch.events(*env).is_some_and(|events| !events.is_empty());
        (
            PyArray1::from_slice(py, &outputs.rewards),
            PyArray1::from_slice(py, &outputs.terminated),
            PyArray1::from_slice(py, &outputs.truncated),
            PyArray1::from_slice(py, &outputs.success),
            (0..self.batch.num_envs()).filter(eventful).collect(),
        )
    }

    fn environment(&self, env: usize) -> Result<&driftworld_env::Environment> {
        of_env(self.batch.environment(env), env, self.batch.num_envs())
    }
}

/// A value of an environment, or an error if there is no such environment.
fn of_env<T>(found: Option<T>, env: usize, num_envs: usize) -> Result<T> {
    found.ok_or_else(|| EnvError::NoSuchEnv { found: env, num_envs }.into())
}

/// Converts an event to a dictionary.
fn to_py<'py>(py: Python<'py>, event: &Event) -> PyResult<Bound<'py, PyDict>> {
    let dictionary = PyDict::new(py);
    dictionary.set_item("object", event.object)?;
    dictionary.set_item("tag", event.tag.as_deref())?;
    let stimulus = serde_json::to_value(event.stimulus).unwrap_or_default();
    dictionary.set_item("stimulus", stimulus.as_str())?;
    dictionary.set_item("reward", event.reward)?;
    dictionary.set_item("destroyed", event.destroyed)?;
    dictionary.set_item("effect", event.effect.map(Effect::name))?;
    Ok(dictionary)
}

/// Parses an option that is one of a few words.
fn word<T: FromStr>(option: &str, found: &str, expected: &str) -> Result<T> {
    let unknown = |_| PyValueError::new_err(format!("{option}: found {found:?}, expected {expected}"));
    Ok(found.parse().map_err(unknown)?)
}

/// Represents every invalid row number; no table is this long.
const NO_ROW: usize = usize::MAX;

/// An action of up to three numbers; missing ones are 0.
fn number_action(number: impl Fn(usize) -> Option<f64>) -> Action {
    Action::Continuous([0, 1, 2].map(|column| number(column).unwrap_or(0.0)))
}

/// The action for a row. The batch reports invalid rows, if the action is used.
fn row_action(row: i64) -> Action {
    Action::Discrete(usize::try_from(row).unwrap_or(NO_ROW))
}

/// Replaces the row in an error about an unknown row by the number that was given.
fn no_row(error: Error, row: impl Fn(usize) -> Option<i64>) -> Error {
    let Error::Cause(cause) = &error else {
        return error;
    };
    let (inner, env) = match cause.downcast_ref() {
        Some(EnvError::BatchAction { env, error }) => (&**error, *env),
        Some(inner) => (inner, 0),
        None => return error,
    };
    let (EnvError::NoSuchAction { found: NO_ROW, last }, Some(row)) = (inner, row(env)) else {
        return error;
    };
    let message =
        format!("action: found row {row}, expected 0 to {last} of the world's action table; nothing was changed");
    PyValueError::new_err(message).into()
}
