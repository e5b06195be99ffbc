//! [`Sampler`]: a variant under a seed, compiled so that any of its worlds can be drawn at once.

use driftworld_spec::{
    Count, Distribution, Hole, MAX_OBJECTS, Object, PlacedGroup, Role, Source, Template, Value, Variant, World,
};

use crate::GeneratorError;
use crate::draw::draw;
use crate::placement::{Margins, Plot};
use crate::regions::Ground;
use crate::stream::Stream;

/// Draws the worlds of one variant under one seed, any of them at once.
///
/// World `index` is a pure function of the task's name, the variant's values, the seed and the index. Two variants of a
/// task draw the same numbers under the same seed and index: what differs between their worlds is what differs between
/// the variants.
///
/// # Example
/// ```
/// use driftworld_generator::Sampler;
/// use driftworld_spec::TaskSpec;
/// let task = TaskSpec::from_json("t", r#"{ "name": "t", "groups": [{ "name": "cubes", "count": 3,
///     "object": { "class": "cube" }, "placement": { "disc": { "center": [0, 0], "radius": 20 } }, "separation": 2 }] }"#)?;
/// let sampler = Sampler::new(&task.variant("default")?, 7)?;
/// assert_eq!(sampler.world(12)?.objects.len(), 3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Sampler {
    variant: Variant,
    seed: u64,
    parameters: Vec<(String, Drawn)>,
    world: Filled<World>,
    fixtures: Vec<Filled<Object>>,
    groups: Vec<Group>,
}

/// A distribution with numbers settled, and the stream it draws from.
#[derive(Debug)]
struct Drawn {
    distribution: Distribution,
    stream: Stream,
}

impl Drawn {
    fn at(&self, index: u64, number: u32) -> Value {
        draw(&self.distribution, number, &mut self.stream.at(index, number))
    }
}

/// A template whose constant holes are filled.
#[derive(Debug)]
struct Filled<T: 'static> {
    base: T,
    place: String,
    holes: Vec<(Hole<T>, Fill)>,
}

/// Where a hole gets its value.
#[derive(Debug)]
enum Fill {
    /// The randomized parameter of this number.
    Parameter(usize),
    /// A draw of its own.
    Own(Box<Drawn>),
}

#[derive(Debug)]
struct Group {
    name: String,
    count: GroupCount,
    object: Filled<Object>,
    placement: Drawn,
    margins: Margins,
}

#[derive(Debug)]
enum GroupCount {
    Fixed(u32),
    Drawn(Fill),
}

impl Sampler {
    /// Prepares a variant for drawing.
    ///
    /// # Errors
    /// None today: loading the task has checked all that could fail.
    pub fn new(variant: &Variant, seed: u64) -> Result<Self, GeneratorError> {
        let task = variant.task();
        let compile = Compiler { variant, seed };
        let randomized = task
            .parameters()
            .iter()
            .filter(|(_, parameter)| parameter.role == Role::Randomized);
        let parameters = randomized
            .filter_map(|(name, _)| {
                let distribution = variant.distribution(name)?;
                Some((name.clone(), compile.drawn(distribution, &format!("parameter/{name}"))))
            })
            .collect::<Vec<_>>();
        let names: Vec<&str> = parameters.iter().map(|(name, _)| name.as_str()).collect();
        let world = compile.template(task.world(), "world", &names);
        let fixtures = task.fixtures().iter().enumerate();
        let fixtures = fixtures
            .map(|(k, fixture)| compile.template(fixture, &format!("fixture/{k}"), &names))
            .collect();
        let groups = task.groups().iter().map(|group| compile.group(group, &names)).collect();
        Ok(Self {
            variant: variant.clone(),
            seed,
            parameters,
            world,
            fixtures,
            groups,
        })
    }

    /// The variant that it draws from.
    pub fn variant(&self) -> &Variant {
        &self.variant
    }

    /// World number `index`.
    ///
    /// # Errors
    /// [`GeneratorError`] if an object finds no place, a draw falls out of its range, or there are too many objects.
    pub fn world(&self, index: u64) -> Result<World, GeneratorError> {
        let values: Vec<Value> = self.parameters.iter().map(|(_, drawn)| drawn.at(index, 0)).collect();
        let mut world = self.fill(&self.world, index, 0, &values)?;
        let ground = Ground::new(&world.environment_params);
        let mut plot = Plot::new(ground, world.agent_params.coordinates);
        for fixture in &self.fixtures {
            let object = self.fill(fixture, index, 0, &values)?;
            plot.occupy(object.coordinates);
            world.objects.push(object);
        }
        for group in &self.groups {
            self.place(group, index, &values, &mut plot, &mut world)?;
        }
        Ok(world)
    }

    fn place(
        &self,
        group: &Group,
        index: u64,
        values: &[Value],
        plot: &mut Plot,
        world: &mut World,
    ) -> Result<(), GeneratorError> {
        let count = match &group.count {
            GroupCount::Fixed(count) => *count,
            GroupCount::Drawn(fill) => fill.value(index, 0, values).as_integer().unwrap_or(0) as u32,
        };
        let found = world.objects.len() + count as usize;
        if found > MAX_OBJECTS {
            let variant = self.variant.id();
            return Err(GeneratorError::TooMany {
                variant,
                seed: self.seed,
                index,
                found,
                limit: MAX_OBJECTS,
            });
        }
        world.objects.reserve(count as usize);
        for number in 0..count {
            let mut object = self.fill(&group.object, index, number, values)?;
            let mut chance = group.placement.stream.at(index, number);
            object.coordinates = plot
                .find(&group.placement.distribution, group.margins, number, &mut chance)
                .map_err(|(tries, reason)| GeneratorError::NoPlace {
                    variant: self.variant.id(),
                    seed: self.seed,
                    index,
                    group: group.name.clone(),
                    object: number + 1,
                    count,
                    tries,
                    reason,
                })?;
            world.objects.push(object);
        }
        Ok(())
    }

    fn fill<T: Clone>(
        &self,
        template: &Filled<T>,
        index: u64,
        number: u32,
        values: &[Value],
    ) -> Result<T, GeneratorError> {
        let mut target = template.base.clone();
        for (hole, fill) in &template.holes {
            let value = fill.value(index, number, values);
            let [low, high] = hole.range;
            let numbers = match &value {
                Value::Point(point) => *point,
                other => [other.as_number().unwrap_or(low); 2],
            };
            if let Some(found) = numbers.into_iter().find(|number| !(low..=high).contains(number)) {
                return Err(GeneratorError::OutOfRange {
                    variant: self.variant.id(),
                    seed: self.seed,
                    index,
                    place: format!("{}{}", template.place, hole.pointer),
                    found,
                    low,
                    high,
                });
            }
            hole.fill(&mut target, &value)
                .expect("loading the task tried every value that this hole can be given");
        }
        Ok(target)
    }
}

impl Fill {
    fn value(&self, index: u64, number: u32, values: &[Value]) -> Value {
        match self {
            Self::Parameter(parameter) => values[*parameter].clone(),
            Self::Own(drawn) => drawn.at(index, number),
        }
    }
}

/// Turns what a task declares into what is drawn for one variant under one seed.
struct Compiler<'a> {
    variant: &'a Variant,
    seed: u64,
}

impl Compiler<'_> {
    fn drawn(&self, distribution: Distribution, name: &str) -> Drawn {
        Drawn {
            distribution,
            stream: Stream::new(self.variant.task().name(), self.seed, name),
        }
    }

    /// Fills holes that a fixed or variant parameter settles; leaves the rest for each draw.
    fn template<T: Clone>(&self, template: &Template<T>, place: &str, randomized: &[&str]) -> Filled<T> {
        let mut base = template.base.clone();
        let mut holes = Vec::new();
        for hole in &template.holes {
            match self.fill(&hole.source, &format!("{place}{}", hole.pointer), randomized) {
                Ok(fill) => holes.push((hole.clone(), fill)),
                Err(value) => {
                    hole.fill(&mut base, &value)
                        .expect("loading the task tried every value that this hole can be given");
                }
            }
        }
        Filled {
            base,
            place: place.to_owned(),
            holes,
        }
    }

    /// What fills a hole in each world, or the value that it has in all.
    fn fill(&self, source: &Source, name: &str, randomized: &[&str]) -> Result<Fill, Value> {
        match source {
            Source::Distribution(distribution) => {
                Ok(Fill::Own(Box::new(self.drawn(self.variant.settle(distribution), name))))
            }
            Source::Param(parameter) => match randomized.iter().position(|name| name == parameter) {
                Some(index) => Ok(Fill::Parameter(index)),
                None => Err(self
                    .variant
                    .value(parameter)
                    .cloned()
                    .expect("loading the task checked every reference")),
            },
        }
    }

    fn group(&self, group: &PlacedGroup, randomized: &[&str]) -> Group {
        let spec = &group.spec;
        let name = &spec.name;
        let count = match &group.count {
            Count::Fixed(count) => GroupCount::Fixed(*count),
            Count::Drawn(source) => match self.fill(source, &format!("group/{name}/count"), randomized) {
                Ok(fill) => GroupCount::Drawn(fill),
                Err(value) => GroupCount::Fixed(value.as_integer().unwrap_or(0) as u32),
            },
        };
        let mut object = self.template(&group.object, &format!("group/{name}/object"), randomized);
        object.base.tag.get_or_insert_with(|| name.clone());
        Group {
            name: name.clone(),
            count,
            object,
            placement: self.drawn(self.variant.settle(&spec.placement), &format!("group/{name}/placement")),
            margins: Margins {
                separation: self.variant.number(&spec.separation),
                wall: self.variant.number(&spec.wall_margin),
                agent: self.variant.number(&spec.agent_margin),
            },
        }
    }
}
