//! [`Sampler`]: a variant under a seed, compiled so that any of its worlds can be sampled directly.

mod doors;
mod groups;
mod start;

use std::sync::Arc;

use driftworld_spec::maps::MapLibrary;
use driftworld_spec::{Layout, MAX_OBJECTS, ParameterType, Requirement, Value, Variant, World, WorldDraft};

use crate::clearance::FreeSpace;
use crate::compiled::{Address, Compiled, Filled, Start};
use crate::placement::{Anchor, PlacementContext};
use crate::sequence::Sequence;
use crate::stream::Stream;
use crate::{GeneratorError, WorldId};
use doors::stands_in_door;
use groups::Draft;

/// Maximum number of times to draw a world's randomized parameters; after that, a violated requirement is an error.
pub(crate) const MAX_ATTEMPTS: u32 = 1000;

/// Samples the worlds of one variant under one seed, with random access.
///
/// World `index` is a pure function of the task's name, the variant's values, the seed and the index. Two variants of a task draw
/// the same numbers under the same seed and index: their worlds differ only where the variants differ.
///
/// # Example
/// ```
/// use driftworld_generator::Sampler;
/// use driftworld_spec::TaskSpec;
/// let task = TaskSpec::from_json("t", r#"{ "name": "t", "groups": [{ "name": "cubes", "count": 3,
///     "object": { "class": "cube" }, "placement": { "disc": { "center": [0, 0], "radius": 20 } }, "separation": 2 }] }"#)?;
/// let sampler = Sampler::new(&task.variant("default")?, 7);
/// assert_eq!(sampler.world(12)?.objects.len(), 3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Sampler {
    variant: Variant,
    seed: u64,
    compiled: Compiled,
    /// The requirements on randomized parameters.
    requirements: Vec<Requirement>,
    sequence: Sequence,
    sequence_stream: Stream,
    /// The stream of the worlds' seeds.
    seeds: Stream,
    /// The stream of seeds for layouts without their own.
    layouts: Stream,
    /// The stream of the rooms' doors and keys.
    doors: Stream,
    maps: Option<Arc<MapLibrary>>,
    /// The free space, if it is the same in every world.
    free_space: Option<FreeSpace>,
    /// Whether the agent's start or the free space varies between worlds.
    start_varies: bool,
}

impl Sampler {
    /// Prepares a variant for sampling.
    pub fn new(variant: &Variant, seed: u64) -> Self {
        let compiled = Compiled::new(variant, seed);
        let is_random = |requirement: &&Requirement| {
            requirement
                .names()
                .iter()
                .any(|name| compiled.parameters.iter().any(|parameter| parameter.name == *name))
        };
        let requirements = variant
            .task()
            .requirements()
            .iter()
            .filter(is_random)
            .cloned()
            .collect();
        let mut sampler = Self {
            variant: variant.clone(),
            seed,
            compiled,
            requirements,
            sequence: Sequence::Independent,
            sequence_stream: Stream::new(variant.task().name(), seed, "coverage"),
            seeds: Stream::new(variant.task().name(), seed, "seed"),
            layouts: Stream::new(variant.task().name(), seed, "layout"),
            doors: Stream::new(variant.task().name(), seed, "doors"),
            maps: None,
            free_space: None,
            start_varies: false,
        };
        sampler.prepare_free_space();
        sampler
    }

    /// Spreads the randomized parameters evenly over many worlds.
    #[must_use]
    pub fn with_sequence(mut self, sequence: Sequence) -> Self {
        self.sequence = sequence;
        self
    }

    /// Takes the layouts of predefined maps from a library, and writes each world's layout into the world.
    #[must_use]
    pub fn with_maps(mut self, maps: Arc<MapLibrary>) -> Self {
        self.maps = Some(maps);
        self.prepare_free_space();
        self
    }

    /// Prepares the map and the free space once, if they are the same in every world.
    fn prepare_free_space(&mut self) {
        let keys = ["predefined_map", "map_size", "map_regions", "walls", "layout"];
        let shapes = keys.map(|key| format!("/environment_params/{key}"));
        let layout = &mut self.compiled.world.base.environment_params.layout;
        layout.take_if(|layout| is_open(layout));
        let is_drawn = layout.as_ref().is_some_and(Layout::is_drawn);
        let mut holes = self.compiled.world.holes.iter().map(|(hole, _)| &hole.pointer);
        let varies = is_drawn
            || holes
                .clone()
                .any(|pointer| shapes.iter().any(|shape| pointer.starts_with(shape.as_str())));
        self.start_varies = varies
            || matches!(self.compiled.start, Some(Start::Cells(_)))
            || holes.any(|pointer| pointer.starts_with("/agent_params/coordinates"));
        if !varies {
            if let Some(maps) = &self.maps {
                maps.apply(&mut self.compiled.world.base);
            }
            self.free_space = Some(FreeSpace::new(&self.compiled.world.base));
        }
    }

    /// The variant from which it samples.
    pub fn variant(&self) -> &Variant {
        &self.variant
    }

    /// The seed under which it samples.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// The randomized parameters of world number `index`, in the task's order of declaration.
    ///
    /// # Errors
    /// [`GeneratorError::Requirement`] if the task's requirements fail in every try, [`GeneratorError::NoStart`] if the agent's
    /// start is never in free space, [`GeneratorError::OutOfRange`] if a draw is outside the range that the world allows.
    pub fn values(&self, index: u64) -> Result<Vec<(&str, Value)>, GeneratorError> {
        let names = self.compiled.parameters.iter().map(|parameter| parameter.name.as_str());
        Ok(names.zip(self.empty_world(index)?.1).collect())
    }

    /// Draws the randomized parameters until they meet the requirements, starting with attempt `first`; also returns the number
    /// of the successful attempt.
    fn draw_values(&self, index: u64, first: u32) -> Result<(Vec<Value>, u32), GeneratorError> {
        for attempt in first..MAX_ATTEMPTS {
            let mut values = vec![Value::Boolean(false); self.compiled.parameters.len()];
            for &number in &self.compiled.order {
                let parameter = &self.compiled.parameters[number];
                values[number] = parameter.value(self.sequence, &self.sequence_stream, (index, attempt), &values);
            }
            if self.requirements.is_empty() {
                return Ok((values, attempt));
            }
            let value_of = |name: &str| {
                let parameter = self
                    .compiled
                    .parameters
                    .iter()
                    .position(|parameter| parameter.name == name);
                parameter
                    .map(|number| values[number].clone())
                    .or_else(|| self.variant.value(name).cloned())
            };
            let violated = self
                .requirements
                .iter()
                .find(|requirement| requirement.holds(value_of) != Some(true));
            match violated {
                None => return Ok((values, attempt)),
                Some(requirement) if attempt + 1 == MAX_ATTEMPTS => {
                    return Err(GeneratorError::Requirement {
                        world: self.id(index),
                        requirement: requirement.text().to_owned(),
                        values: requirement.describe(value_of),
                        tries: MAX_ATTEMPTS,
                    });
                }
                Some(_) => {}
            }
        }
        unreachable!("callers start below the last attempt, which returns")
    }

    /// The free space shared by all worlds, or the world's own.
    fn free_space_of<'a>(&'a self, own: Option<&'a FreeSpace>) -> &'a FreeSpace {
        self.free_space
            .as_ref()
            .or(own)
            .expect("a world has its own free space unless it is shared")
    }

    /// The world without its objects, and its free space unless that is shared. If a random start is not in free space, it is
    /// drawn again together with the parameters.
    fn empty_world(&self, index: u64) -> Result<(WorldDraft, Vec<Value>, Option<FreeSpace>), GeneratorError> {
        let mut first = 0;
        loop {
            let (values, attempt) = self.draw_values(index, first)?;
            let mut world = self.fill(
                &self.compiled.world,
                Address {
                    index,
                    object: 0,
                    attempt,
                },
                &values,
            )?;
            let mut own_free_space = None;
            if self.free_space.is_none() {
                if let Some(maps) = &self.maps {
                    maps.apply(&mut world);
                }
                world.environment_params.layout.take_if(|layout| is_open(layout));
                if let Some(layout) = &mut world.environment_params.layout
                    && layout.is_drawn()
                {
                    layout.set_seed(self.layouts.seed_at(index, attempt));
                }
                own_free_space = Some(FreeSpace::new(&world));
            }
            let free_space = self.free_space_of(own_free_space.as_ref());
            self.start_in_cell(&mut world, free_space, index, attempt)?;
            let start = world.agent_params.coordinates;
            let radius = world.agent_params.agent_width / 2.0;
            if free_space.clearance(start, 0.0) > 0.0 && !stands_in_door(&world, free_space, start, radius) {
                return Ok((world, values, own_free_space));
            }
            let tries = attempt + 1;
            if !self.start_varies || tries == MAX_ATTEMPTS {
                let world = self.id(index);
                return Err(GeneratorError::NoStart { world, start, tries });
            }
            first = tries;
        }
    }

    /// World number `index`.
    ///
    /// # Errors
    /// [`GeneratorError`] if no position is found for an object or the agent, a draw is out of range, the drawn values
    /// conflict, a requirement is never met, or there are too many objects.
    pub fn world(&self, index: u64) -> Result<World, GeneratorError> {
        let (mut world, values, own_free_space) = self.empty_world(index)?;
        world.seed = Some(self.seeds.seed(index));
        let free_space = self.free_space_of(own_free_space.as_ref());
        let mut context = PlacementContext::new(free_space, world.agent_params.coordinates, self.compiled.groups.len());
        world.objects.reserve_exact(self.compiled.capacity);
        for (number, fixture) in self.compiled.fixtures.iter().enumerate() {
            let object = self.fill(fixture, Address::first(index, number as u64), &values)?;
            context.occupy(object.coordinates);
            world.objects.push(object);
        }
        let doors = self.doors(&world, free_space, index);
        for door in &doors {
            context.occupy(door.coordinates);
        }
        let mut draft = Draft {
            index,
            values: &values,
            context: &mut context,
            world: &mut world,
        };
        // For each group, the range of its objects in the world's list.
        let mut ranges = Vec::with_capacity(self.compiled.groups.len());
        for (number, group) in self.compiled.groups.iter().enumerate() {
            let first = draft.world.objects.len();
            match group.around {
                None => self.place(number, group, Anchor::ORIGIN, 0, &mut draft)?,
                Some(middle) => {
                    let middles: std::ops::Range<usize> = std::ops::Range::clone(&ranges[middle]);
                    for (anchor_number, object) in middles.enumerate() {
                        let object = &draft.world.objects[object];
                        let heading = if group.turned { object.heading } else { 0.0 };
                        let anchor = Anchor {
                            at: object.coordinates,
                            heading,
                        };
                        self.place(number, group, anchor, anchor_number as u64, &mut draft)?;
                    }
                }
            }
            ranges.push(first..draft.world.objects.len());
        }
        if !doors.is_empty() {
            let keys = self.keys(&doors, &mut draft)?;
            world.objects.extend(doors.into_iter().chain(keys));
            self.check_count(world.objects.len(), index)?;
        }
        // Loading the task and `fill` check each value by itself; only this check finds conflicts between values.
        world
            .check_in_range_with(free_space.plan.clone())
            .map_err(|source| GeneratorError::Clash {
                world: self.id(index),
                source,
            })
    }

    fn fill<T: Clone>(&self, template: &Filled<T>, at: Address, values: &[Value]) -> Result<T, GeneratorError> {
        let mut target = template.base.clone();
        for (hole, fill) in &template.holes {
            fill.with(at, values, |value| {
                if hole.kind == ParameterType::Heading {
                    let turned = value.cast(ParameterType::Heading);
                    hole.fill(&mut target, turned.as_ref().unwrap_or(value));
                    return Ok(());
                }
                let [low, high] = hole.range;
                let outside = |number: &&f64| !(low..=high).contains(*number);
                let found = match value {
                    Value::Number(number) => Some(number).filter(outside).copied(),
                    Value::Integer(whole) => Some(&(*whole as f64)).filter(outside).copied(),
                    Value::Point(point) => point.iter().find(outside).copied(),
                    Value::Vector(vector) => vector.iter().find(outside).copied(),
                    _ => None,
                };
                if let Some(found) = found {
                    return Err(self.out_of_range(
                        at.index,
                        &format!("{}{}", template.place, hole.pointer),
                        [found; 2],
                        hole.range,
                    ));
                }
                hole.fill(&mut target, value)
                    .expect("loading the task tried every value that this hole can receive");
                Ok(())
            })?;
        }
        Ok(target)
    }

    /// Identifies the world in errors.
    fn id(&self, index: u64) -> WorldId {
        WorldId {
            variant: self.variant.id(),
            seed: self.seed,
            index,
        }
    }

    /// Fails if there are more objects than a world may have.
    fn check_count(&self, found: usize, index: u64) -> Result<(), GeneratorError> {
        if found <= MAX_OBJECTS {
            return Ok(());
        }
        Err(GeneratorError::TooMany {
            world: self.id(index),
            found,
            limit: MAX_OBJECTS,
        })
    }

    fn out_of_range(&self, index: u64, place: &str, found: [f64; 2], [low, high]: [f64; 2]) -> GeneratorError {
        GeneratorError::OutOfRange {
            world: self.id(index),
            place: place.to_owned(),
            found: found
                .into_iter()
                .find(|number| !(low..=high).contains(number))
                .unwrap_or(found[0]),
            low,
            high,
        }
    }
}

/// Whether a layout has no walls, so that its arena is identical to one without a layout.
fn is_open(layout: &Layout) -> bool {
    layout.walls.as_ref().is_some_and(Vec::is_empty)
}
