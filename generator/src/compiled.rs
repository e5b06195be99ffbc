//! A task compiled for one variant and seed: fixed values are filled in, and each random value has its own stream.

use std::borrow::Cow;

use driftworld_spec::{
    Count, Distribution, Facing, Hole, Object, ParameterType, PlacedGroup, Resolved, Role, Source, Template, Value,
    Variant, WorldDraft,
};

use crate::draw::draw;
use crate::placement::Margins;
use crate::sequence::Sequence;
use crate::stream::{Rng, Stream};

/// A task compiled for one variant and seed, from which worlds are sampled.
#[derive(Debug)]
pub(crate) struct Compiled {
    pub(crate) parameters: Vec<Randomized>,
    /// Indices of the parameters; each parameter comes after those that its look-ups read.
    pub(crate) order: Vec<usize>,
    pub(crate) world: Filled<WorldDraft>,
    /// The layout cells in which the agent starts, if it starts in cells.
    pub(crate) start: Option<Start>,
    pub(crate) fixtures: Vec<Filled<Object>>,
    pub(crate) groups: Vec<Group>,
    /// Number of objects for which to reserve memory.
    pub(crate) capacity: usize,
}

/// A distribution with fixed numbers, and the stream it draws from.
#[derive(Debug)]
pub(crate) struct Drawn {
    /// The distribution; if look-ups read randomized parameters, the distribution over all their outcomes.
    pub(crate) distribution: Distribution,
    pub(crate) stream: Stream,
    look_up: Option<Box<LookUp>>,
}

impl Drawn {
    /// The distribution in a world in which the randomized parameters have these values.
    pub(crate) fn resolve(&self, values: &[Value]) -> Cow<'_, Distribution> {
        let look_up = self.look_up.as_ref();
        look_up.map_or(Cow::Borrowed(&self.distribution), |look_up| {
            Cow::Owned(look_up.resolve(values))
        })
    }
}

/// A source with look-ups that read randomized parameters.
#[derive(Debug)]
struct LookUp {
    variant: Variant,
    source: Source,
    /// The randomized parameters that it names, and their indices.
    reads: Vec<(String, usize)>,
}

impl LookUp {
    fn resolve(&self, values: &[Value]) -> Distribution {
        let drawn: Vec<(&str, Value)> = self
            .reads
            .iter()
            .map(|(name, number)| (name.as_str(), values[*number].clone()))
            .collect();
        match self.variant.resolve_with(&self.source, &drawn) {
            Some(Resolved::Draw(distribution)) => distribution,
            Some(Resolved::Value(value)) => Distribution::Constant { value },
            Some(Resolved::Randomized(reference)) => {
                let drawn = drawn.into_iter().find(|(name, _)| *name == reference.param);
                let value = drawn.and_then(|(_, value)| value.at(reference.index));
                Distribution::Constant {
                    value: value.expect("loading the task checked every reference"),
                }
            }
            None => unreachable!("all randomized parameters that it names are known"),
        }
    }
}

/// A randomized parameter.
#[derive(Debug)]
pub(crate) struct Randomized {
    pub(crate) name: String,
    kind: ParameterType,
    drawn: Drawn,
    /// The dimensions of a sequence that it uses: the first, and their number.
    dimensions: Option<(usize, usize)>,
}

impl Randomized {
    /// The parameter's value in a world.
    ///
    /// `known` are the values of the parameters that its look-ups read.
    pub(crate) fn value(
        &self,
        sequence: Sequence,
        stream: &Stream,
        (index, attempt): (u64, u32),
        known: &[Value],
    ) -> Value {
        let in_sequence = if attempt == 0 {
            self.in_sequence(sequence, stream, index)
        } else {
            None
        };
        let value = in_sequence.unwrap_or_else(|| {
            draw(&self.drawn.resolve(known), &mut self.drawn.stream.at(index, 0, attempt)).into_owned()
        });
        value
            .cast(self.kind)
            .expect("loading the task checked what the distribution yields")
    }

    fn in_sequence(&self, sequence: Sequence, stream: &Stream, index: u64) -> Option<Value> {
        let (first, count) = self.dimensions?;
        let u = sequence.unit(stream, first, index)?;
        let next_unit = |dimension: usize| sequence.unit(stream, first + dimension, index);
        let law = &self.drawn.distribution;
        match count {
            1 => law.value_at(u),
            2 => law.point_at([u, next_unit(1)?]).map(Value::Point),
            _ => law.color_at([u, next_unit(1)?, next_unit(2)?]).map(Value::Color),
        }
    }
}

/// A template with its fixed holes filled.
#[derive(Debug)]
pub(crate) struct Filled<T> {
    pub(crate) base: T,
    /// The path of the template, for messages: `group/trees/object`.
    pub(crate) place: String,
    pub(crate) holes: Vec<(Hole<T>, Fill)>,
}

/// The source of a hole's value in each world.
#[derive(Debug)]
pub(crate) enum Fill {
    /// The randomized parameter with this index, or one of its components.
    Parameter(usize, Option<usize>),
    /// A separate draw.
    Own(Box<Drawn>),
}

/// The position in its stream at which a value is drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Address {
    /// The world's number.
    pub(crate) index: u64,
    /// The object's number in its group.
    pub(crate) object: u64,
    /// Number of times that the world was sampled again.
    pub(crate) attempt: u32,
}

impl Address {
    /// The address of the first attempt.
    pub(crate) fn first(index: u64, object: u64) -> Self {
        let attempt = 0;
        Self { index, object, attempt }
    }
}

impl Fill {
    /// Calls `take` with the value at an address.
    pub(crate) fn with<R>(&self, at: Address, values: &[Value], take: impl FnOnce(&Value) -> R) -> R {
        match self {
            Self::Parameter(parameter, None) => take(&values[*parameter]),
            Self::Parameter(parameter, place) => take(
                &values[*parameter]
                    .at(*place)
                    .expect("loading the task checked the index"),
            ),
            Self::Own(drawn) => {
                let mut rng: Rng = drawn.stream.at(at.index, at.object, at.attempt);
                take(&draw(&drawn.resolve(values), &mut rng))
            }
        }
    }
}

#[derive(Debug)]
pub(crate) struct Group {
    pub(crate) name: String,
    pub(crate) count: GroupCount,
    pub(crate) object: Filled<Object>,
    pub(crate) placement: Drawn,
    pub(crate) margins: Margins,
    pub(crate) around: Option<usize>,
    pub(crate) turned: bool,
    pub(crate) facing: Option<FacingRule>,
    /// The stream of its objects' seeds, if their behaviour is random in any variant.
    pub(crate) seeds: Option<Stream>,
    /// Expected number of objects, for reserving memory.
    pub(crate) expected: f64,
}

/// Whether a template's objects behave randomly in any variant of the task. The answer is the same for every variant, so that
/// the same objects have seeds in the worlds of all variants.
fn may_be_random(template: &Template<Object>) -> bool {
    let random = ["/motion_model", "/reward_probability", "/respawn"];
    let varies = |hole: &Hole<Object>| random.contains(&hole.pointer.as_str());
    template.base.takes_chances() || template.holes.iter().any(varies)
}

/// The seeds of a group's or fixture's objects, which depend on its name alone and are therefore the same in every world.
fn seeds_of(place: &str) -> Stream {
    Stream::new("", 0, &format!("{place}/seed"))
}

/// The number of objects of a group.
#[derive(Debug)]
pub(crate) enum GroupCount {
    Fixed(u32),
    Drawn(Fill),
}

/// The direction that the objects of a group face.
#[derive(Debug)]
pub(crate) enum FacingRule {
    Random(Stream),
    Agent,
    Middle,
    Point([f64; 2]),
    Group(usize),
}

/// Where the agent starts in a layout.
#[derive(Debug)]
pub(crate) enum Start {
    /// In one of these cells, as set by the task.
    Cells(Drawn),
    /// Not set by the task: the start marked in a text layout, otherwise any cell, if the layout has cells.
    Default(Stream),
}

/// Parameter indices in the task's order, except that each parameter comes after those that its look-ups read.
fn order(parameters: &[Randomized]) -> Vec<usize> {
    fn visit(number: usize, parameters: &[Randomized], order: &mut Vec<usize>) {
        if order.contains(&number) {
            return;
        }
        let reads = parameters[number]
            .drawn
            .look_up
            .iter()
            .flat_map(|look_up| &look_up.reads);
        for (_, read) in reads {
            visit(*read, parameters, order);
        }
        order.push(number);
    }
    let mut order = Vec::with_capacity(parameters.len());
    (0..parameters.len()).for_each(|number| visit(number, parameters, &mut order));
    order
}

/// Compiles a task's declarations for one variant and seed.
struct Compiler<'a> {
    variant: &'a Variant,
    seed: u64,
    randomized: Vec<&'a str>,
}

impl Compiled {
    pub(crate) fn new(variant: &Variant, seed: u64) -> Self {
        let task = variant.task();
        let declared = task
            .parameters()
            .iter()
            .filter(|(_, parameter)| parameter.role == Role::Randomized);
        let randomized = declared.clone().map(|(name, _)| name.as_str()).collect();
        let compiler = Compiler {
            variant,
            seed,
            randomized,
        };
        let mut dimension = 0;
        let parameters: Vec<Randomized> = declared
            .filter_map(|(name, parameter)| {
                let distribution = variant.distribution(name)?;
                let look_up = compiler.look_up(parameter.distribution.as_ref()?);
                let num_dimensions = match &distribution {
                    Distribution::Choice { .. } | Distribution::Constant { .. } => 0,
                    Distribution::Box { .. }
                    | Distribution::Disc { .. }
                    | Distribution::Annulus { .. }
                    | Distribution::Gaussian { .. } => 2,
                    Distribution::ColorUniform { .. }
                    | Distribution::ColorNormal { .. }
                    | Distribution::ColorPerturb { .. }
                    | Distribution::ColorHsv { .. } => 3,
                    other => usize::from(other.is_scalar()),
                };
                let num_dimensions = if look_up.is_some() { 0 } else { num_dimensions };
                let dimensions = (num_dimensions > 0).then_some((dimension, num_dimensions));
                dimension += num_dimensions;
                let mut drawn = compiler.drawn(distribution, &format!("parameter/{name}"));
                drawn.look_up = look_up;
                Some(Randomized {
                    name: name.clone(),
                    kind: parameter.kind,
                    drawn,
                    dimensions,
                })
            })
            .collect();
        let fixtures = task.fixtures().iter().enumerate();
        let mut groups: Vec<Group> = task.groups().iter().map(|group| compiler.group(group)).collect();
        for number in 0..groups.len() {
            if let Some(middle) = groups[number].around {
                groups[number].expected *= groups[middle].expected;
            }
        }
        let expected: f64 = groups.iter().map(|group| group.expected).sum();
        let mut world = compiler.template(task.world(), "world");
        let is_start = |(hole, fill): &(Hole<WorldDraft>, Fill)| {
            let of_cells = matches!(fill, Fill::Own(drawn) if drawn.distribution.draws_cells());
            of_cells && hole.pointer == "/agent_params/coordinates"
        };
        let start = world
            .holes
            .iter()
            .position(is_start)
            .map(|number| world.holes.remove(number).1);
        let start = match start {
            Some(Fill::Own(drawn)) => Some(Start::Cells(*drawn)),
            _ if !task.says_start() => Some(Start::Default(compiler.stream("world/agent_params/coordinates"))),
            _ => None,
        };
        Self {
            // A quarter more than the mean is enough for most worlds; few have to reallocate.
            capacity: (expected * 1.25).min(4096.0) as usize + task.fixtures().len(),
            order: order(&parameters),
            parameters,
            world,
            start,
            fixtures: fixtures
                .map(|(k, fixture)| {
                    let place = format!("fixture/{k}");
                    let mut filled = compiler.template(fixture, &place);
                    if may_be_random(fixture) {
                        filled.base.seed = filled.base.seed.or_else(|| Some(seeds_of(&place).seed(0)));
                    }
                    filled
                })
                .collect(),
            groups,
        }
    }
}

impl Compiler<'_> {
    fn stream(&self, name: &str) -> Stream {
        Stream::new(self.variant.task().name(), self.seed, name)
    }

    fn drawn(&self, distribution: Distribution, name: &str) -> Drawn {
        Drawn {
            distribution,
            stream: self.stream(name),
            look_up: None,
        }
    }

    /// The look-ups of a source, if they read randomized parameters.
    fn look_up(&self, source: &Source) -> Option<Box<LookUp>> {
        if self.variant.resolve_with(source, &[]).is_some() {
            return None;
        }
        let number = |name: String| Some((self.randomized.iter().position(|known| *known == name)?, name));
        let reads = source.names().into_iter().filter_map(number);
        Some(Box::new(LookUp {
            variant: self.variant.clone(),
            source: source.clone(),
            reads: reads.map(|(number, name)| (name, number)).collect(),
        }))
    }

    /// Fills holes that fixed or variant parameters determine; leaves the others to be filled in each world.
    fn template<T: Clone>(&self, template: &Template<T>, place: &str) -> Filled<T> {
        let mut base = template.base.clone();
        let mut holes = Vec::new();
        for hole in &template.holes {
            match self.fill(&hole.source, &format!("{place}{}", hole.pointer)) {
                Ok(fill) => holes.push((hole.clone(), fill)),
                Err(value) => {
                    let turned = value.cast(hole.kind).filter(|_| hole.kind == ParameterType::Heading);
                    hole.fill(&mut base, turned.as_ref().unwrap_or(&value))
                        .expect("loading the task tried every value that this hole can receive");
                }
            }
        }
        Filled {
            base,
            place: place.to_owned(),
            holes,
        }
    }

    /// How to fill a hole in each world; `Err` with its value if it is the same in every world.
    fn fill(&self, source: &Source, name: &str) -> Result<Fill, Value> {
        match self.variant.resolve(source) {
            Resolved::Value(value) => Err(value),
            Resolved::Draw(distribution) => {
                let mut drawn = self.drawn(distribution, name);
                drawn.look_up = self.look_up(source);
                Ok(Fill::Own(Box::new(drawn)))
            }
            Resolved::Randomized(reference) => {
                let parameter = self.randomized.iter().position(|name| *name == reference.param);
                Ok(Fill::Parameter(
                    parameter.expect("loading the task checked every reference"),
                    reference.index,
                ))
            }
        }
    }

    fn group(&self, group: &PlacedGroup) -> Group {
        let spec = &group.spec;
        let name = &spec.name;
        let count = match &group.count {
            Count::Fixed(count) => GroupCount::Fixed(*count),
            Count::Drawn(source) => match self.fill(source, &format!("group/{name}/count")) {
                Ok(fill) => GroupCount::Drawn(fill),
                Err(value) => GroupCount::Fixed(value.as_integer().unwrap_or(0) as u32),
            },
        };
        let expected = match &count {
            GroupCount::Fixed(count) => f64::from(*count),
            GroupCount::Drawn(Fill::Own(drawn)) => drawn.distribution.mean().unwrap_or(0.0),
            GroupCount::Drawn(Fill::Parameter(..)) => 0.0,
        };
        let mut object = self.template(&group.object, &format!("group/{name}/object"));
        object.base.tag.get_or_insert_with(|| name.clone());
        let Ok(Fill::Own(placement)) = self.fill(&spec.placement, &format!("group/{name}/placement")) else {
            unreachable!("loading the task checked that placements are distributions")
        };
        let facing = spec.facing.as_ref().map(|facing| match facing {
            Facing::Random => FacingRule::Random(self.stream(&format!("group/{name}/facing"))),
            Facing::Agent => FacingRule::Agent,
            Facing::Middle => FacingRule::Middle,
            Facing::Point([x, y]) => FacingRule::Point([self.variant.number(x), self.variant.number(y)]),
            Facing::Group(_) => FacingRule::Group(
                group
                    .facing_group
                    .expect("loading the task checked that the group exists"),
            ),
        });
        Group {
            name: name.clone(),
            count,
            object,
            placement: *placement,
            margins: Margins {
                separation: self.variant.number(&spec.separation),
                walls: self.variant.number(&spec.keep_out.walls),
                agent: self.variant.number(&spec.keep_out.agent),
                groups: group
                    .keep_groups
                    .iter()
                    .map(|(group, metres)| (*group, self.variant.number(metres)))
                    .collect(),
            },
            around: group.around,
            expected,
            turned: spec.turned,
            facing,
            seeds: may_be_random(&group.object).then(|| seeds_of(&format!("group/{name}"))),
        }
    }
}
