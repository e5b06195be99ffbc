//! [`Supply`]: provides one environment's worlds, episode after episode.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use driftworld_generator::{Drift, GeneratorError, Sampler};
use driftworld_spec::{DriftSchedule, DriftSwitch, ObjectProgress, Progress, RegimeDrift, Variant, World};
use numpy::PyReadonlyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::errors::Result;
use crate::overrides::{Reach, WorldOverrides};
use crate::rounding::usually_rounded;
use crate::variant::PyVariant;

/// An endless sequence of worlds: world number *i* under a seed.
#[derive(Clone)]
pub(crate) enum Stream {
    /// Worlds of these variants, one per episode, in a repeating order.
    Variants { variants: Arc<[Variant]>, turns: Turns },
    /// Worlds drifting from one variant to another; the drift ends with world number `episodes` − 1.
    Drift { drift: Arc<Drift>, episodes: u64 },
    /// The same world in every episode, with its name.
    World { world: Arc<World>, name: String },
}

/// The variant of each episode. Environments that share an order take turns in it.
#[derive(Clone)]
pub(crate) struct Turns {
    /// Indices of variants; not empty.
    order: Arc<[u32]>,
    /// The position in the order of episode 0, and the increment per episode.
    first: u64,
    step: u64,
}

impl Turns {
    /// The index of an episode's variant.
    fn place(&self, episode: u64) -> usize {
        // Orders are shorter than 2^32, so sums and products fit into 64 bits.
        let length = self.order.len() as u64;
        let turn = (self.first % length + (episode % length) * (self.step % length)) % length;
        self.order[turn as usize] as usize
    }
}

/// A [`Stream`] for Python.
#[pyclass(name = "Stream", module = "driftworld._native", frozen)]
pub(crate) struct PyStream(pub(crate) Stream);

#[pymethods]
impl PyStream {
    /// The worlds of variants, one variant per episode in turn, repeatedly.
    #[staticmethod]
    fn variants(variants: Vec<Bound<'_, PyVariant>>) -> Result<Self> {
        let order = (0..).take(variants.len()).collect();
        let one = Stream::dealt(&variants, order, 1)?.pop();
        Ok(Self(one.expect("there is one for one environment")))
    }

    /// The worlds of variants in the order given by their indices in `order`, dealt out like cards, repeatedly: one stream for
    /// each of `num_envs` environments.
    #[staticmethod]
    fn dealt(
        variants: Vec<Bound<'_, PyVariant>>,
        order: PyReadonlyArray1<'_, u32>,
        num_envs: u32,
    ) -> Result<Vec<Self>> {
        let order = order.as_array().iter().copied().collect();
        let dealt = Stream::dealt(&variants, order, num_envs)?;
        Ok(dealt.into_iter().map(Self).collect())
    }

    /// Worlds drifting from one variant to another. `schedule` and `switch` are JSON, as in a scenario.
    #[staticmethod]
    fn drift(
        from_: &Bound<'_, PyVariant>,
        to: &Bound<'_, PyVariant>,
        schedule: &str,
        switch: &str,
        episodes: u64,
    ) -> Result<Self> {
        let wrong = |name: &str, found: &str, expected: &str| {
            PyValueError::new_err(format!("drift: found {name} {found}, expected {expected}"))
        };
        let schedule: DriftSchedule = serde_json::from_str(schedule).map_err(|_| {
            let expected = "\"linear\", \"cosine\", {\"steps\": n} or {\"sawtooth\": n}";
            wrong("schedule", schedule, expected)
        })?;
        let switch: DriftSwitch = serde_json::from_str(switch)
            .map_err(|_| wrong("switch", switch, "\"at_point\", \"mixture\" or \"task\""))?;
        if episodes == 0 {
            return Err(wrong("episodes", "0", "at least 1").into());
        }
        let (from, to) = (from_.get().0.clone(), to.get().0.clone());
        let declared = RegimeDrift {
            schedule,
            switch,
            ..RegimeDrift::to("")
        };
        // All environments share one seed, so that a value changes in the same episode in each of them.
        let drift = Arc::new(usually_rounded(|| Drift::declared(&declared, from, to, 0))?);
        Ok(Self(Stream::Drift { drift, episodes }))
    }

    /// One world, restarted in every episode. Messages and infos call it `name`.
    #[staticmethod]
    fn world(name: String, text: &str) -> Result<Self> {
        let world = Arc::new(usually_rounded(|| World::from_json(&name, text))?);
        Ok(Self(Stream::World { world, name }))
    }

    /// The JSON of a single-world stream.
    fn text(&self) -> Result<String> {
        Ok(self.0.single()?.to_json())
    }

    /// The layout of environments for its worlds with these options (JSON), one per variant, as JSON.
    fn layouts(&self, overrides: &str) -> Result<Vec<String>> {
        let overrides = overrides_of(overrides)?;
        let worlds = match &self.0 {
            Stream::Variants { variants, .. } => variants
                .iter()
                .map(first_world)
                .collect::<std::result::Result<_, _>>()?,
            Stream::Drift { drift, .. } => {
                let ends = [drift.at(0.0, 0)?, drift.at(1.0, 0)?];
                ends.iter().map(first_world).collect::<std::result::Result<_, _>>()?
            }
            Stream::World { world, .. } => vec![(World::clone(world), Reach::default())],
        };
        let layouts = worlds
            .into_iter()
            .map(|(world, reach)| Ok(overrides.checked_layout(world, &reach)?.to_string()));
        layouts.collect()
    }
}

impl Stream {
    /// The world of a stream of a single world.
    pub(crate) fn single(&self) -> PyResult<&World> {
        let Self::World { world, .. } = self else {
            let message = "world: found a stream of variants, expected a stream of a single world";
            return Err(PyValueError::new_err(message));
        };
        Ok(world)
    }

    /// Deals out the worlds of variants in an order to `num_envs` environments.
    fn dealt(variants: &[Bound<'_, PyVariant>], order: Arc<[u32]>, num_envs: u32) -> PyResult<Vec<Self>> {
        let wrong = |found: &str, expected: &str| {
            PyValueError::new_err(format!("variants: found {found}, expected {expected}"))
        };
        if order.is_empty() || order.len() as u64 > u64::from(u32::MAX) {
            return Err(wrong(&order.len().to_string(), "at least one, and fewer than 2^32"));
        }
        if let Some(place) = order.iter().find(|place| **place as usize >= variants.len()) {
            let found = format!("place {place} in the order");
            return Err(wrong(&found, "less than the number of variants"));
        }
        let variants: Arc<[Variant]> = variants.iter().map(|variant| variant.get().0.clone()).collect();
        let turns = |env: u32| Turns {
            order: Arc::clone(&order),
            first: env.into(),
            step: num_envs.into(),
        };
        let stream = |env: u32| Self::Variants {
            variants: Arc::clone(&variants),
            turns: turns(env),
        };
        Ok((0..num_envs).map(stream).collect())
    }
}

fn first_world(variant: &Variant) -> std::result::Result<(World, Reach), GeneratorError> {
    Ok((driftworld_generator::sample(variant, 0, 0)?, Reach::of(variant)))
}

/// Parses options from the package's JSON.
pub(crate) fn overrides_of(text: &str) -> Result<WorldOverrides> {
    Ok(serde_json::from_str(text).map_err(|error| PyValueError::new_err(format!("options: {error}")))?)
}

/// The origin of a world: task, variant, seed, index, and the hash of the world as drawn, before options were applied.
pub(crate) type Origin = (String, String, u64, u64, String);

/// Provides one environment with worlds.
pub(crate) struct Supply {
    overrides: Arc<WorldOverrides>,
    state: Mutex<State>,
}

struct State {
    stream: Stream,
    /// A sampler per variant of the stream, by its index, created on first use.
    samplers: BTreeMap<usize, Sampler>,
    seed: u64,
    /// Index of the next world.
    next: u64,
    /// Number of episodes that the stream has provided.
    turn: u64,
    /// A world for the next episode only.
    given: Option<World>,
    origin: Origin,
}

impl Supply {
    pub(crate) fn new(stream: Stream, overrides: Arc<WorldOverrides>) -> Self {
        Self {
            overrides,
            state: Mutex::new(State {
                samplers: BTreeMap::new(),
                stream,
                seed: 0,
                next: 0,
                turn: 0,
                given: None,
                origin: Origin::default(),
            }),
        }
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        // A panic elsewhere leaves a valid state.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The next world, with the options applied. After an error, the same world is requested again.
    pub(crate) fn world(&self) -> std::result::Result<World, String> {
        let mut state = self.lock();
        let (world, origin) = state.draw().map_err(|error| error.to_string())?;
        if state.given.take().is_none() {
            state.next = state.next.saturating_add(1);
            state.turn = state.turn.saturating_add(1);
        }
        // Without a seed, random numbers depend on the positions of objects in the world as drawn; options that are applied
        // must not change them.
        let is_seedless = world.seed.is_none() && world.progress.is_none();
        let hash = (is_seedless && !self.overrides.is_empty()).then(|| world.hash_of_places());
        state.origin = origin;
        drop(state);
        if hash.is_none() && self.overrides.is_empty() {
            return Ok(world);
        }
        let mut world = world.into_draft();
        if hash.is_some() {
            world.progress = Some(Progress {
                seed: hash,
                objects: vec![ObjectProgress::default(); world.objects.len()],
                ..Progress::default()
            });
        }
        self.overrides.apply(&mut world);
        // The options' values were checked when the environment was made: see `WorldOverrides::checked_layout`.
        world.check_in_range().map_err(|error| error.to_string())
    }

    /// The origin of the last world.
    pub(crate) fn origin(&self) -> Origin {
        self.lock().origin.clone()
    }

    /// Draws worlds under this seed from now on, starting at this index.
    pub(crate) fn seed(&self, seed: u64, index: u64) {
        let mut state = self.lock();
        if state.seed != seed {
            state.samplers.clear();
        }
        (state.seed, state.next, state.turn) = (seed, index, 0);
    }

    /// Continues with the world of this index.
    pub(crate) fn index(&self, index: u64) {
        self.lock().next = index;
    }

    /// Takes worlds from another stream from now on.
    pub(crate) fn stream(&self, stream: Stream) {
        let mut state = self.lock();
        state.samplers.clear();
        (state.stream, state.turn) = (stream, 0);
    }

    /// Provides this world once.
    pub(crate) fn give(&self, world: World) {
        self.lock().given = Some(world);
    }

    /// Seed, next index and turn, for a copy.
    pub(crate) fn place(&self) -> (u64, u64, u64) {
        let state = self.lock();
        (state.seed, state.next, state.turn)
    }

    /// Continues from another supply's seed, index and turn.
    pub(crate) fn set_place(&self, (seed, next, turn): (u64, u64, u64)) {
        self.seed(seed, next);
        self.lock().turn = turn;
    }
}

impl State {
    fn draw(&mut self) -> std::result::Result<(World, Origin), GeneratorError> {
        let (seed, index) = (self.seed, self.next);
        let of = |variant: &Variant| (variant.task().name().to_owned(), variant.id());
        let (world, (task, variant)) = match (&self.given, &self.stream) {
            (Some(world), _) => (world.clone(), ("given".to_owned(), "given".to_owned())),
            (None, Stream::Variants { variants, turns }) => {
                let place = turns.place(self.turn);
                let variant = &variants[place];
                let sampler = self.samplers.entry(place);
                let sampler = sampler.or_insert_with(|| Sampler::new(variant, seed));
                (sampler.world(index)?, of(variant))
            }
            (None, Stream::Drift { drift, episodes }) => {
                let progress = RegimeDrift::to("").progress(clamped(index), clamped(*episodes));
                let progress = if *episodes == 1 { 1.0 } else { progress };
                let variant = drift.at(progress, index)?;
                (driftworld_generator::sample(&variant, seed, index)?, of(&variant))
            }
            (None, Stream::World { world, name }) => (World::clone(world), (name.clone(), name.clone())),
        };
        let hash = world.hash();
        Ok((world, (task, variant, seed, index, hash)))
    }
}

fn clamped(count: u64) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}
