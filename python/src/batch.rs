//! [`PyBatch`]: environments that step together, with their buffers as arrays. Single environments are batches of one.
//!
//! Spaces, infos and Gymnasium's rules are in `package/driftworld/envs/`.
#![expect(unsafe_code, reason = "arrays are views on the buffers of the batch that keeps them")]

use std::num::NonZeroU32;
use std::str::FromStr;
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};

use driftworld_env::{
    Action, Autoreset, Batch, BatchOptions, Catalogue, DepthForm, EnvError, Event, GoOn, Library, Outputs,
    RendererKind, WorldSource, top_down,
};
use driftworld_spec::{Modality, World};
use numpy::ndarray::{ArrayView, Ix4};
use numpy::{Element, PyArray1, PyArray4, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::errors::{Error, Result};
use crate::interruptible::run_cancellable;
use crate::supply::{PyStream, Stream, Supply, overrides_of};

/// From so many environments on, Ctrl-C ends making and resetting them: fewer are done before anybody waits.
const MANY: usize = 32;

/// The row that stands for every number that is none: no table is as long.
const NO_ROW: usize = usize::MAX;

/// Environments that step together.
#[pyclass(name = "Batch", module = "driftworld._native", frozen)]
pub(crate) struct PyBatch {
    /// One thread at a time has it; another that wants it meanwhile is refused.
    stepping: Mutex<Stepping>,
    supplies: Vec<Arc<Supply>>,
    /// The process that the batch was made in: its threads live nowhere else.
    process: u32,
}

/// What a step changes.
struct Stepping {
    batch: Batch,
    /// The actions of a step; the memory is used again.
    actions: Vec<Action>,
}

/// What a step says beside the observations: rewards, terminated, truncated, success, and the numbers of the environments in
/// which something happened.
type Stepped<'py> = (
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<bool>>,
    Bound<'py, PyArray1<bool>>,
    Bound<'py, PyArray1<bool>>,
    Vec<usize>,
);

#[pymethods]
impl PyBatch {
    /// One environment for each stream, at the start of world 0 under seed 0.
    #[new]
    #[pyo3(signature = (streams, overrides, autoreset, num_threads, renderer, depth, libraries, max_episode_steps=None))]
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
        max_episode_steps: Option<NonZeroU32>,
    ) -> Result<Self> {
        let overrides = Arc::new(overrides_of(overrides)?);
        let supply =
            |stream: &Bound<'_, PyStream>| Arc::new(Supply::new(stream.get().0.clone(), Arc::clone(&overrides)));
        let supplies: Vec<Arc<Supply>> = streams.iter().map(supply).collect();
        let options = BatchOptions {
            autoreset: autoreset_of(autoreset)?,
            num_threads,
            renderer: RendererKind::from_str(renderer)?,
            depth: depth_of(depth)?,
            max_episode_steps,
        };
        let make = |go_on: GoOn<'_>| {
            let mut catalogue = Catalogue::default();
            for bytes in &libraries {
                catalogue = catalogue.with_library(&Library::from_bytes(bytes)?);
            }
            let worlds = supplies.clone();
            let source: WorldSource = Arc::new(move |episode| worlds[episode.env].world());
            Batch::with_catalogue_while(supplies.len(), source, options, &catalogue, go_on)
        };
        let batch = interruptibly(py, supplies.len(), make)?;
        let actions = Vec::with_capacity(supplies.len());
        Ok(Self {
            stepping: Mutex::new(Stepping { batch, actions }),
            supplies,
            process: std::process::id(),
        })
    }

    /// What draws: `cpu` or `gpu`.
    #[getter]
    fn renderer(&self) -> Result<&'static str> {
        Ok(self.lock()?.batch.renderer().name())
    }

    /// Lets an environment draw worlds under another seed, from this index on.
    fn seed(&self, env: usize, seed: u64, index: u64) -> Result<()> {
        self.supply(env)?.seed(seed, index);
        Ok(())
    }

    /// Lets an environment go on with the world of this index.
    fn index(&self, env: usize, index: u64) -> Result<()> {
        self.supply(env)?.index(index);
        Ok(())
    }

    /// Lets an environment take its worlds from another stream from its next episode on.
    fn stream(&self, env: usize, stream: &Bound<'_, PyStream>) -> Result<()> {
        self.supply(env)?.stream(stream.get().0.clone());
        Ok(())
    }

    /// Gives an environment the world of a stream for its next episode.
    fn give(&self, env: usize, stream: &Bound<'_, PyStream>) -> Result<()> {
        let Stream::World { world, .. } = &stream.get().0 else {
            return Err(PyValueError::new_err("world: found a stream of variants, expected one of a world").into());
        };
        self.supply(env)?.give(World::clone(world));
        Ok(())
    }

    /// Seed, next index and turn of an environment's supply.
    fn place(&self, env: usize) -> Result<(u64, u64, u64)> {
        Ok(self.supply(env)?.place())
    }

    /// Takes up the supply of an environment where another stands.
    fn set_place(&self, env: usize, place: (u64, u64, u64)) -> Result<()> {
        self.supply(env)?.set_place(place);
        Ok(())
    }

    /// Steps of the episode that an environment is in, as the limit beside the worlds counts them.
    fn episode_steps(&self, env: usize) -> Result<u32> {
        let num_envs = self.supplies.len();
        let steps = self.lock()?.batch.episode_steps(env);
        steps.ok_or_else(|| EnvError::NoSuchEnv { found: env, num_envs }.into())
    }

    /// Counts on from so many.
    fn set_episode_steps(&self, env: usize, steps: u32) -> Result<()> {
        Ok(self.lock()?.batch.set_episode_steps(env, steps)?)
    }

    /// Begins the next episode in all environments, or in those that `mask` says true for. After Ctrl-C some have not begun.
    #[pyo3(signature = (mask=None))]
    fn reset(&self, py: Python<'_>, mask: Option<PyReadonlyArray1<'_, bool>>) -> Result<()> {
        self.expect_own_process()?;
        let chosen = mask.map_or_else(|| vec![true; self.supplies.len()], |mask| mask.as_array().to_vec());
        let mut stepping = self.lock()?;
        let batch = &mut stepping.batch;
        let count = chosen.iter().filter(|is_chosen| **is_chosen).count();
        interruptibly(py, count, |go_on| batch.reset_where_while(&chosen, go_on))
    }

    /// One step with actions of numbers, `(num_envs, 3)` or without interaction `(num_envs, 2)`.
    fn step_numbers<'py>(&self, py: Python<'py>, actions: PyReadonlyArray2<'py, f64>) -> Result<Stepped<'py>> {
        let mut stepping = self.lock()?;
        let actions = actions.as_array();
        stepping.actions.clear();
        stepping.actions.extend(actions.rows().into_iter().map(|row| {
            let number = |column: usize| row.get(column).copied().unwrap_or(0.0);
            Action::Continuous([number(0), number(1), number(2)])
        }));
        self.go(py, &mut stepping)?;
        Ok(stepping.stepped(py))
    }

    /// One step with actions that are rows of the table, `(num_envs,)`.
    fn step_rows<'py>(&self, py: Python<'py>, actions: PyReadonlyArray1<'py, i64>) -> Result<Stepped<'py>> {
        let mut stepping = self.lock()?;
        let rows = actions.as_array();
        stepping.actions.clear();
        // What is no row is an error where the action counts, which the batch knows.
        let row = |row: &i64| Action::Discrete(usize::try_from(*row).unwrap_or(NO_ROW));
        stepping.actions.extend(rows.iter().map(row));
        let done = self.go(py, &mut stepping);
        done.map_err(|error| match &error {
            Error::Env(EnvError::BatchAction { env, error: inner }) => no_row(inner, rows.get(*env)).unwrap_or(error),
            Error::Env(inner) => no_row(inner, rows.first()).unwrap_or(error),
            _ => error,
        })?;
        Ok(stepping.stepped(py))
    }

    /// One step of the only environment, by numbers: reward, terminated, truncated, success, and whether anything happened.
    fn step_one_by_numbers(&self, py: Python<'_>, numbers: Vec<f64>) -> Result<(f64, bool, bool, bool, bool)> {
        let number = |column: usize| numbers.get(column).copied().unwrap_or(0.0);
        self.step_one(py, Action::Continuous([number(0), number(1), number(2)]))
    }

    /// The same by a row of the table.
    fn step_one_by_row(&self, py: Python<'_>, row: i64) -> Result<(f64, bool, bool, bool, bool)> {
        let done = self.step_one(py, Action::Discrete(usize::try_from(row).unwrap_or(NO_ROW)));
        done.map_err(|error| match &error {
            Error::Env(inner) => no_row(inner, Some(&row)).unwrap_or(error),
            _ => error,
        })
    }

    /// Repeats the last step's actions so often without coming back to Python: what the batch can do by itself.
    fn repeat(&self, py: Python<'_>, steps: u64) -> Result<()> {
        self.expect_own_process()?;
        let mut stepping = self.lock()?;
        let mut left = steps;
        while left > 0 {
            let now = left.min(256);
            let Stepping { batch, actions } = &mut *stepping;
            py.detach(|| (0..now).try_for_each(|_| batch.step(actions)))?;
            left -= now;
            py.check_signals()?;
        }
        Ok(())
    }

    /// The observations' buffers as arrays that share their memory and cannot be written through, by modality:
    /// `(num_envs, height, width, channels)`, and `state` `(num_envs, 1, 1, n)`.
    fn buffers(slf: Bound<'_, Self>) -> Result<Bound<'_, PyDict>> {
        let stepping = slf.get().lock()?;
        views(&slf, stepping.batch.outputs())
    }

    /// The same of the last observations of episodes that ended in the last step; none unless autoreset is in the same step.
    fn final_buffers(slf: Bound<'_, Self>) -> Result<Option<Bound<'_, PyDict>>> {
        let stepping = slf.get().lock()?;
        let finals = stepping.batch.final_outputs();
        finals.map(|outputs| views(&slf, outputs)).transpose()
    }

    /// Task, variant, seed, index and hash of the world that an environment is in.
    fn origin(&self, env: usize) -> Result<(String, String, u64, u64, String)> {
        let origin = self.supply(env)?.origin();
        Ok((origin.task, origin.variant, origin.seed, origin.index, origin.hash))
    }

    /// What happened in an environment in the last step.
    fn events<'py>(&self, py: Python<'py>, env: usize) -> Result<Bound<'py, PyTuple>> {
        let stepping = self.lock()?;
        let events = stepping.batch.events(env).unwrap_or_default();
        let events: PyResult<Vec<_>> = events.iter().map(|event| to_py(py, event)).collect();
        Ok(PyTuple::new(py, events?)?)
    }

    /// The JSON of an environment's world as it is now.
    fn state(&self, env: usize) -> Result<String> {
        Ok(self.lock()?.environment(env)?.state().to_json())
    }

    /// What an environment's world asks for that is not as its author may think.
    fn warnings(&self, env: usize) -> Result<Vec<String>> {
        let stepping = self.lock()?;
        let warnings = stepping.environment(env)?.warnings();
        Ok(warnings.iter().map(ToString::to_string).collect())
    }

    /// A picture of an environment, `(height, width, 3)` bytes: what its agent sees, or the world from above.
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
        let pixels = py.detach(|| {
            if from_above {
                let agent = environment.agent();
                top_down(scene, width, height, Some((agent.position, agent.heading_deg))).rgb
            } else {
                let mut frame = driftworld_env::Frame::new(width, height);
                driftworld_env::CpuRenderer::new().render(scene, &environment.camera(), &mut frame);
                frame.rgb
            }
        });
        let picture = PyArray1::from_vec(py, pixels);
        Ok(picture.reshape([height as usize, width as usize, 3])?.into_any())
    }
}

impl PyBatch {
    /// What steps and resets change, for one thread alone.
    fn lock(&self) -> PyResult<MutexGuard<'_, Stepping>> {
        match self.stepping.try_lock() {
            Ok(stepping) => Ok(stepping),
            // A panic leaves no environment half stepped: each has its own part.
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

    /// One step with the actions that were set.
    fn go(&self, py: Python<'_>, stepping: &mut Stepping) -> Result<()> {
        self.expect_own_process()?;
        let Stepping { batch, actions } = stepping;
        py.detach(|| batch.step(actions)).map_err(|error| match error {
            // Alone, it needs no number.
            EnvError::BatchAction { error, .. } if actions.len() == 1 => *error,
            error => error,
        })?;
        Ok(())
    }

    fn supply(&self, env: usize) -> Result<&Supply> {
        let num_envs = self.supplies.len();
        let supply = self.supplies.get(env).map(AsRef::as_ref);
        supply.ok_or_else(|| EnvError::NoSuchEnv { found: env, num_envs }.into())
    }

    /// Threads do not survive a fork: stepping there would wait for ever.
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
    /// What the last step led to.
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
        let num_envs = self.batch.num_envs();
        let environment = self.batch.environment(env);
        environment.ok_or_else(|| EnvError::NoSuchEnv { found: env, num_envs }.into())
    }
}

/// Does what Ctrl-C may end between environments, where there are enough of them that somebody waits.
fn interruptibly<T: Send>(
    py: Python<'_>,
    num_envs: usize,
    work: impl FnOnce(GoOn<'_>) -> std::result::Result<T, EnvError> + Send,
) -> Result<T> {
    if num_envs < MANY {
        return Ok(py.detach(|| work(&|| true))?);
    }
    Ok(run_cancellable(py, |stop| work(&|| !stop.load(Ordering::Relaxed)))??)
}

/// The error of an action that is no row's number, told with the number that was found.
fn no_row(error: &EnvError, row: Option<&i64>) -> Option<Error> {
    let (EnvError::NoSuchAction { found: NO_ROW, last }, Some(row)) = (error, row) else {
        return None;
    };
    let message =
        format!("action: found row {row}, expected 0 to {last} of the world's action table; nothing was changed");
    Some(PyValueError::new_err(message).into())
}

/// Arrays over the buffers of observations that a batch keeps; what writes into them is the batch alone.
fn views<'py>(batch: &Bound<'py, PyBatch>, outputs: &Outputs) -> Result<Bound<'py, PyDict>> {
    let images = &outputs.images;
    let num_envs = outputs.rewards.len();
    let (height, width) = (images.layout.height as usize, images.layout.width as usize);
    let views = PyDict::new(batch.py());
    for modality in &images.layout.modalities {
        let shape = [num_envs, height, width, if *modality == Modality::Rgb { 3 } else { 1 }];
        match modality {
            Modality::Rgb => views.set_item("rgb", view(batch, &images.rgb, shape)?)?,
            Modality::Segmentation => views.set_item("segmentation", view(batch, &images.category, shape)?)?,
            Modality::Class => views.set_item("class", view(batch, &images.class, shape)?)?,
            Modality::Instance => views.set_item("instance", view(batch, &images.instance, shape)?)?,
            Modality::Depth if !images.depth_gray.is_empty() => {
                views.set_item("depth", view(batch, &images.depth_gray, shape)?)?;
            }
            Modality::Depth if !images.depth_millimetres.is_empty() => {
                views.set_item("depth", view(batch, &images.depth_millimetres, shape)?)?;
            }
            Modality::Depth => views.set_item("depth", view(batch, &images.depth, shape)?)?,
        }
    }
    let shape = [num_envs, 1, 1, outputs.state_len];
    views.set_item("state", view(batch, &outputs.states, shape)?)?;
    Ok(views)
}

fn view<'py, T: Element>(
    batch: &Bound<'py, PyBatch>,
    buffer: &[T],
    shape: [usize; 4],
) -> Result<Bound<'py, PyArray4<T>>> {
    let array: ArrayView<'_, T, Ix4> = ArrayView::from_shape(shape, buffer)
        .map_err(|error| PyRuntimeError::new_err(format!("a buffer is not as its layout says: {error}")))?;
    // SAFETY: the buffer belongs to the batch, which the array keeps alive as its base, and is made once: a batch writes into its
    // buffers and never replaces them.
    let view = unsafe { PyArray4::borrow_from_array(&array, batch.clone().into_any()) };
    // For good: NumPy makes no array writable whose base is neither an array nor a buffer.
    Ok(view
        .readwrite()
        .make_nonwriteable()
        .as_any()
        .cast::<PyArray4<T>>()
        .map_err(PyErr::from)?
        .clone())
}

/// An event as a dictionary.
fn to_py<'py>(py: Python<'py>, event: &Event) -> PyResult<Bound<'py, PyDict>> {
    let told = PyDict::new(py);
    told.set_item("object", event.object)?;
    told.set_item("tag", event.tag.as_deref())?;
    let stimulus = serde_json::to_value(event.stimulus).unwrap_or_default();
    told.set_item("stimulus", stimulus.as_str())?;
    told.set_item("reward", event.reward)?;
    told.set_item("destroyed", event.destroyed)?;
    Ok(told)
}

fn autoreset_of(name: &str) -> Result<Autoreset> {
    match name {
        "next_step" => Ok(Autoreset::NextStep),
        "same_step" => Ok(Autoreset::SameStep),
        "disabled" => Ok(Autoreset::Disabled),
        _ => Err(unknown("autoreset_mode", name, "next_step, same_step or disabled")),
    }
}

fn depth_of(name: &str) -> Result<DepthForm> {
    match name {
        "float32" => Ok(DepthForm::Metres),
        "uint16" => Ok(DepthForm::Millimetres),
        "uint8" => Ok(DepthForm::Gray),
        _ => Err(unknown("depth", name, "uint8, uint16 or float32")),
    }
}

fn unknown(option: &str, found: &str, expected: &str) -> Error {
    PyValueError::new_err(format!("{option}: found {found:?}, expected {expected}")).into()
}
