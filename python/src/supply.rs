//! [`Supply`]: where one environment's worlds come from, episode after episode. What is laid over them is in `overrides.rs`.

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

/// Worlds without end: number *i* under a seed.
#[derive(Clone)]
pub(crate) enum Stream {
    /// Of these variants, one in each episode, in an order over and over.
    Variants { variants: Arc<[Variant]>, turns: Turns },
    /// On the way from one variant to another, which ends with episode number `episodes` − 1.
    Drift { drift: Arc<Drift>, episodes: u64 },
    /// The same world again and again, and what it is called.
    World { world: Arc<World>, name: String },
}

/// Which variant comes in which episode. Environments that share an order take turns in it.
#[derive(Clone)]
pub(crate) struct Turns {
    /// Places of variants; at least one, each a variant's.
    order: Arc<[u32]>,
    /// The place in the order of episode 0, and from each episode to the next.
    first: u64,
    step: u64,
}

impl Turns {
    /// The place of the variant of an episode.
    fn place(&self, episode: u64) -> usize {
        // Orders are shorter than 2^32: neither sum nor product leaves 64 bits.
        let length = self.order.len() as u64;
        let turn = (self.first % length + (episode % length) * (self.step % length)) % length;
        self.order[turn as usize] as usize
    }
}

/// A [`Stream`] in Python's hands.
#[pyclass(name = "Stream", module = "driftworld._native", frozen)]
pub(crate) struct PyStream(pub(crate) Stream);

#[pymethods]
impl PyStream {
    /// The worlds of variants, one variant in each episode in turn, over and over.
    #[staticmethod]
    fn variants(variants: Vec<Bound<'_, PyVariant>>) -> Result<Self> {
        let order = (0..).take(variants.len()).collect();
        let one = Stream::dealt(&variants, order, 1)?.pop();
        Ok(Self(one.expect("there is one for one environment")))
    }

    /// The worlds of variants in the order that their places in `order` say, dealt out like cards, over and over: one stream for each
    /// of `num_envs` environments.
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

    /// The worlds on the way from one variant to another. `schedule` and `switch` are JSON, as in a scenario.
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
        // Under one seed, so that every environment meets a new value in the same episode.
        let drift = Arc::new(usually_rounded(|| Drift::declared(&declared, from, to, 0))?);
        Ok(Self(Stream::Drift { drift, episodes }))
    }

    /// One world, in every episode from its start. `name` is what messages and infos call it.
    #[staticmethod]
    fn world(name: String, text: &str) -> Result<Self> {
        let world = Arc::new(usually_rounded(|| World::from_json(&name, text))?);
        Ok(Self(Stream::World { world, name }))
    }

    /// The JSON of the one world that it hands out.
    fn text(&self) -> Result<String> {
        match &self.0 {
            Stream::World { world, .. } => Ok(world.to_json()),
            _ => Err(PyValueError::new_err("world: found a stream of variants, expected one of a world").into()),
        }
    }

    /// What environments of its worlds look like with these options (JSON), for each variant that it names, as JSON.
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
    /// The worlds of variants in an order, dealt out to so many environments.
    fn dealt(variants: &[Bound<'_, PyVariant>], order: Arc<[u32]>, num_envs: u32) -> PyResult<Vec<Self>> {
        let wrong = |found: &str, expected: &str| {
            PyValueError::new_err(format!("variants: found {found}, expected {expected}"))
        };
        if order.is_empty() || order.len() as u64 > u64::from(u32::MAX) {
            return Err(wrong(&order.len().to_string(), "at least one, and less than 2^32"));
        }
        if let Some(place) = order.iter().find(|place| **place as usize >= variants.len()) {
            let found = format!("place {place} in the order");
            return Err(wrong(&found, "less than there are variants"));
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

/// Options from the JSON that the package makes of them.
pub(crate) fn overrides_of(text: &str) -> Result<WorldOverrides> {
    Ok(serde_json::from_str(text).map_err(|error| PyValueError::new_err(format!("options: {error}")))?)
}

/// Where a world came from: task, variant, seed, index, and the hash of the world as it was drawn, before options were laid over it.
pub(crate) type Origin = (String, String, u64, u64, String);

/// Hands one environment its worlds.
pub(crate) struct Supply {
    overrides: Arc<WorldOverrides>,
    state: Mutex<State>,
}

struct State {
    stream: Stream,
    /// A sampler for each variant of the stream by its place, made when it is first needed.
    samplers: BTreeMap<usize, Sampler>,
    seed: u64,
    /// Index of the next world.
    next: u64,
    /// How many episodes the stream has been asked for.
    turn: u64,
    /// A world for the next episode alone.
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
        // A panic elsewhere leaves nothing half done here.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The next world, with the options laid over it. After an error the same world is asked for again.
    pub(crate) fn world(&self) -> std::result::Result<World, String> {
        let mut state = self.lock();
        let (world, origin) = state.draw().map_err(|error| error.to_string())?;
        if state.given.take().is_none() {
            state.next = state.next.saturating_add(1);
            state.turn = state.turn.saturating_add(1);
        }
        // Without a seed, random numbers depend on where things are in the world as it was drawn, as they do everywhere:
        // options laid over it change none.
        let is_seedless = world.seed.is_none() && world.progress.is_none();
        let hash = (is_seedless && !self.overrides.is_empty()).then(|| world.hash_of_places());
        state.origin = origin;
        drop(state);
        if hash.is_none() && self.overrides.is_empty() {
            return Ok(world);
        }
        let world = world.edit(|world| {
            if hash.is_some() {
                world.progress = Some(Progress {
                    seed: hash,
                    objects: vec![ObjectProgress::default(); world.objects.len()],
                    ..Progress::default()
                });
            }
            self.overrides.apply(world);
        });
        world.map_err(|error| error.to_string())
    }

    /// Where the last world came from.
    pub(crate) fn origin(&self) -> Origin {
        self.lock().origin.clone()
    }

    /// Draws under another seed from now on, from this index on.
    pub(crate) fn seed(&self, seed: u64, index: u64) {
        let mut state = self.lock();
        if state.seed != seed {
            state.samplers.clear();
        }
        (state.seed, state.next, state.turn) = (seed, index, 0);
    }

    /// Goes on with the world of this index.
    pub(crate) fn index(&self, index: u64) {
        self.lock().next = index;
    }

    /// Takes worlds from another stream from now on.
    pub(crate) fn stream(&self, stream: Stream) {
        let mut state = self.lock();
        state.samplers.clear();
        (state.stream, state.turn) = (stream, 0);
    }

    /// Hands out this world once.
    pub(crate) fn give(&self, world: World) {
        self.lock().given = Some(world);
    }

    /// Seed, next index and turn: what a copy has to be told.
    pub(crate) fn place(&self) -> (u64, u64, u64) {
        let state = self.lock();
        (state.seed, state.next, state.turn)
    }

    /// Goes on where another supply stands.
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
