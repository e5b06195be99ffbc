//! From a task's document to a checked task: references, types and ranges that the schema cannot see.

use indexmap::IndexMap;
use serde_json::Value as Json;

use super::distribution::{Distribution, Number};
use super::parameter::{Domain, Parameter, Role};
use super::template::{Hole, Opening, Source, Template, openings};
use super::value::{ParameterType, Value};
use super::variant::{self, DEFAULT_VARIANT};
use super::{Count, Group, PlacedGroup, TaskDocument, TaskSpec};
use crate::MAX_OBJECTS;
use crate::document::escape;
use crate::error::{Problem, nearest};
use crate::world::{Object, World};

/// The checked task, or everything that is wrong with it.
pub(super) fn compile(document: TaskDocument) -> Result<TaskSpec, Vec<Problem>> {
    let mut problems: Vec<Problem> = document
        .parameters
        .iter()
        .flat_map(|(name, parameter)| parameter.problems(name))
        .collect();
    problems.extend(reserved_names(&document.parameters));
    problems.extend(variant::problems(&document.parameters, &document.variants));
    fail_on(problems)?;

    let mut check = Check::new(&document);
    let (world, fixtures) = check.world(&document.world);
    let groups: Vec<Option<PlacedGroup>> = document
        .groups
        .iter()
        .enumerate()
        .map(|(index, group)| check.group(index, group))
        .collect();
    check.parameters();
    check.group_names(&document.groups);
    let problems = std::mem::take(&mut check.problems);
    fail_on(problems)?;
    let (Some(world), Some(fixtures), Some(groups)) =
        (world, fixtures.into_iter().collect(), groups.into_iter().collect())
    else {
        unreachable!("what could not be built left a problem")
    };
    Ok(TaskSpec {
        document,
        world,
        fixtures,
        groups,
    })
}

fn fail_on(problems: Vec<Problem>) -> Result<(), Vec<Problem>> {
    if problems.is_empty() { Ok(()) } else { Err(problems) }
}

fn reserved_names(parameters: &IndexMap<String, Parameter>) -> impl Iterator<Item = Problem> {
    parameters
        .keys()
        .filter(|name| matches!(name.as_str(), "extends" | "description"))
        .map(|name| {
            let found = format!("a parameter named {name:?}");
            Problem::new(
                "spec/reserved-name",
                format!("/parameters/{name}"),
                found,
                "a name that variants do not use themselves",
            )
        })
}

/// A check of one document: gathers problems on its way.
struct Check<'a> {
    parameters: &'a IndexMap<String, Parameter>,
    /// The values of every variant, by name; the default variant first.
    variants: Vec<(String, IndexMap<String, Value>)>,
    problems: Vec<Problem>,
}

impl<'a> Check<'a> {
    fn new(document: &'a TaskDocument) -> Self {
        let names = std::iter::once(DEFAULT_VARIANT).chain(document.variants.keys().map(String::as_str));
        let variants = names
            .filter_map(|name| {
                let values = variant::values_of(&document.parameters, &document.variants, name).ok()?;
                Some((name.to_owned(), values))
            })
            .collect();
        Self {
            parameters: &document.parameters,
            variants,
            problems: Vec::new(),
        }
    }

    fn report(&mut self, problem: Problem) {
        self.problems.push(problem);
    }

    /// Randomized parameters: the numbers of their distributions.
    fn parameters(&mut self) {
        for (name, parameter) in self.parameters {
            if let Some(distribution) = &parameter.distribution {
                self.distribution(&format!("/parameters/{}/distribution", escape(name)), distribution);
            }
        }
    }

    /// Whether a distribution's references name numbers, and whether every variant can draw from it.
    fn distribution(&mut self, pointer: &str, distribution: &Distribution<Number>) -> bool {
        let before = self.problems.len();
        let mut references = Vec::new();
        let collected: Result<_, ()> = distribution.try_map(&mut |number| {
            references.extend(match number {
                Number::Param(reference) => Some(reference.param.clone()),
                Number::Literal(_) => None,
            });
            Ok(0.0)
        });
        drop(collected);
        for name in references {
            self.number_reference(pointer, &name);
        }
        if self.problems.len() > before {
            return false;
        }
        let fault = self.variants.iter().find_map(|(name, values)| {
            let (found, expected) = variant::settle(values, distribution).ok()?.fault()?;
            Some((name.clone(), found, expected))
        });
        if let Some((variant, found, expected)) = fault {
            let found = format!("{found} in variant {variant:?}");
            self.report(Problem::new("spec/distribution", pointer, found, expected));
        }
        self.problems.len() == before
    }

    /// A number in a distribution, or a group's margin, may refer to a fixed or variant number only.
    fn number_reference(&mut self, pointer: &str, name: &str) {
        let Some(parameter) = self.parameters.get(name) else {
            return self.unknown_parameter(pointer, name);
        };
        if parameter.role == Role::Randomized {
            let found = format!("the randomized parameter {name:?}");
            self.report(Problem::new(
                "spec/role",
                pointer,
                found,
                "a fixed or variant parameter",
            ));
        } else if !parameter.kind.fits(ParameterType::Number) {
            let found = format!("the parameter {name:?} of type {}", parameter.kind.name());
            self.report(Problem::new("spec/type", pointer, found, "a parameter of type number"));
        }
    }

    fn unknown_parameter(&mut self, pointer: &str, name: &str) {
        let known: Vec<&str> = self.parameters.keys().map(String::as_str).collect();
        let expected = if known.is_empty() {
            "a declared parameter; there is none".into()
        } else {
            format!("one of {}", known.join(", "))
        };
        let problem = Problem::new(
            "spec/unknown-parameter",
            pointer,
            format!("the unknown parameter {name:?}"),
            expected,
        );
        self.report(match nearest(name, known) {
            Some(near) => problem.advise(format!("did you mean {near:?}?")),
            None => problem,
        });
    }

    /// Whether a source is known and yields the type that its place wants.
    fn source(&mut self, pointer: &str, source: &Source, kind: ParameterType) -> bool {
        match source {
            Source::Param(name) => {
                let Some(parameter) = self.parameters.get(name) else {
                    self.unknown_parameter(pointer, name);
                    return false;
                };
                let found = format!("the parameter {name:?} of type {}", parameter.kind.name());
                self.type_matches(pointer, parameter.kind.fits(kind), found, kind)
            }
            Source::Distribution(distribution) => {
                let found = format!("the distribution {}", distribution.name());
                let sound = self.distribution(pointer, distribution);
                let drawable = !matches!(distribution, Distribution::Points { .. });
                self.type_matches(pointer, drawable && distribution.yields(kind), found, kind) && sound
            }
        }
    }

    fn type_matches(&mut self, pointer: &str, fits: bool, found: String, kind: ParameterType) -> bool {
        if !fits {
            self.report(Problem::new(
                "spec/type",
                pointer,
                found,
                format!("something of type {}", kind.name()),
            ));
        }
        fits
    }

    /// Every value that a source is known to be able to give: ends of ranges and supports, choices, defaults.
    fn candidates(&self, source: &Source) -> Vec<Value> {
        let drawn = |distribution: &Distribution<Number>| -> Vec<Value> {
            let settled = self
                .variants
                .iter()
                .filter_map(|(_, values)| variant::settle(values, distribution).ok());
            let values = settled.flat_map(|distribution| {
                let example = distribution.example();
                distribution.support().unwrap_or_default().into_iter().chain([example])
            });
            values.collect()
        };
        match source {
            Source::Distribution(distribution) => drawn(distribution),
            Source::Param(name) => {
                let Some(parameter) = self.parameters.get(name) else {
                    return Vec::new();
                };
                let typed = |value: &Value| value.cast(parameter.kind);
                let mut values: Vec<Value> = parameter
                    .default
                    .iter()
                    .chain(&parameter.value)
                    .filter_map(typed)
                    .collect();
                match parameter.domain() {
                    Some(Domain::Range(ends)) => values.extend(ends.map(|end| number_of(parameter.kind, end))),
                    Some(Domain::Choices(choices)) => values.extend(choices),
                    None => {}
                }
                values.extend(
                    parameter
                        .distribution
                        .iter()
                        .flat_map(drawn)
                        .filter_map(|value| typed(&value)),
                );
                values
            }
        }
    }

    /// Whether all that a source can give lies in the range of its place.
    fn in_range(&mut self, pointer: &str, candidates: &[Value], [low, high]: [f64; 2]) -> bool {
        let numbers = candidates.iter().flat_map(|value| match value {
            Value::Point([x, y]) => vec![*x, *y],
            other => other.as_number().into_iter().collect(),
        });
        let outside = numbers.into_iter().find(|number| !(low..=high).contains(number));
        if let Some(number) = outside {
            let found = format!("a source that can give {number}");
            let expected = if low == f64::MIN {
                format!("at most {high}")
            } else {
                format!("numbers in {low}..{high}")
            };
            let advice = "narrow the parameter's range or the distribution";
            self.report(Problem::new("spec/range", pointer, found, expected).advise(advice));
        }
        outside.is_none()
    }

    /// The world's template and those of the objects it holds.
    fn world(&mut self, json: &Json) -> (Option<Template<World>>, Vec<Option<Template<Object>>>) {
        let mut json = if json.is_null() {
            Json::Object(serde_json::Map::new())
        } else {
            json.clone()
        };
        let objects = json.as_object_mut().and_then(|map| map.shift_remove("objects"));
        let fixtures = objects
            .as_ref()
            .and_then(Json::as_array)
            .into_iter()
            .flatten()
            .enumerate();
        let fixtures = fixtures
            .map(|(index, object)| self.object(&format!("/world/objects/{index}"), object))
            .collect();
        let world = self.template("/world", &json, Template::<World>::hole);
        if let Some(world) = &world {
            for mut problem in world.base.problems() {
                problem.pointer.insert_str(0, "/world");
                self.report(problem);
            }
        }
        (world, fixtures)
    }

    fn object(&mut self, pointer: &str, json: &Json) -> Option<Template<Object>> {
        self.template(pointer, json, Template::<Object>::hole)
    }

    /// A template: each hole checked, and the rest read with an example in each hole.
    fn template<T: serde::de::DeserializeOwned + Clone>(
        &mut self,
        root: &str,
        json: &Json,
        hole_at: fn(&Opening) -> Option<Hole<T>>,
    ) -> Option<Template<T>> {
        let before = self.problems.len();
        let mut example = json.clone();
        let mut holes = Vec::new();
        for opening in openings(json) {
            let pointer = format!("{root}{}", opening.0);
            let Some(hole) = hole_at(&opening) else {
                let found = "a parameter or distribution";
                self.report(Problem::new(
                    "spec/value",
                    pointer,
                    found,
                    "a plain value; this place cannot vary",
                ));
                continue;
            };
            if self.source(&pointer, &hole.source, hole.kind) {
                let candidates = self.candidates(&hole.source);
                if self.in_range(&pointer, &candidates, hole.range)
                    && let (Some(value), Some(place)) = (candidates.first(), example.pointer_mut(&opening.0))
                {
                    *place = value.to_json();
                    holes.push((hole, candidates));
                }
            }
        }
        if self.problems.len() > before {
            return None;
        }
        let base: T = match serde_path_to_error::deserialize(&example) {
            Ok(base) => base,
            Err(error) => {
                let expected = error.inner().to_string();
                self.report(Problem::new(
                    "spec/value",
                    root,
                    "a template that cannot be read",
                    expected,
                ));
                return None;
            }
        };
        self.fillable(root, &base, &holes);
        (self.problems.len() == before).then(|| Template {
            base,
            holes: holes.into_iter().map(|(hole, _)| hole).collect(),
        })
    }

    /// Whether each hole takes each value that it may be given, as a text that must name something.
    fn fillable<T: Clone>(&mut self, root: &str, base: &T, holes: &[(Hole<T>, Vec<Value>)]) {
        for (hole, candidates) in holes {
            let mut trial = base.clone();
            if let Some(value) = candidates.iter().find(|value| hole.fill(&mut trial, value).is_none()) {
                let pointer = format!("{root}{}", hole.pointer);
                let found = format!("a source that can give {value}");
                self.report(Problem::new(
                    "spec/value",
                    pointer,
                    found,
                    "only values that can stand here",
                ));
            }
        }
    }

    fn group(&mut self, index: usize, group: &Group) -> Option<PlacedGroup> {
        let before = self.problems.len();
        let root = format!("/groups/{index}");
        let count = self.count(&format!("{root}/count"), &group.count);
        let mut object = group.object.clone();
        if let Some(map) = object.as_object_mut() {
            map.insert("coordinates".to_owned(), serde_json::json!([0, 0]));
        }
        let object = self.object(&format!("{root}/object"), &object);
        let placement = format!("{root}/placement");
        if group.placement.is_planar() {
            self.distribution(&placement, &group.placement);
        } else {
            let found = format!("the distribution {}", group.placement.name());
            self.report(Problem::new(
                "spec/type",
                placement,
                found,
                "one of box, disc, annulus, gaussian, points",
            ));
        }
        for (key, number) in [
            ("separation", &group.separation),
            ("wall_margin", &group.wall_margin),
            ("agent_margin", &group.agent_margin),
        ] {
            self.margin(&format!("{root}/{key}"), number);
        }
        let (count, object) = (count?, object?);
        (self.problems.len() == before).then(|| PlacedGroup {
            spec: group.clone(),
            count,
            object,
        })
    }

    fn margin(&mut self, pointer: &str, number: &Number) {
        let before = self.problems.len();
        if let Number::Param(reference) = number {
            self.number_reference(pointer, &reference.param);
        }
        let settled = self
            .variants
            .iter()
            .filter_map(|(_, values)| variant::settle_number(values, number).ok());
        let worst = settled.fold(
            0.0_f64,
            |worst, metres| if (0.0..=300.0).contains(&metres) { worst } else { metres },
        );
        if worst != 0.0 && self.problems.len() == before {
            self.report(Problem::new("spec/range", pointer, format!("{worst} m"), "0 to 300 m"));
        }
    }

    fn count(&mut self, pointer: &str, json: &Json) -> Option<Count> {
        if let Some(count) = json.as_u64() {
            return u32::try_from(count).ok().map(Count::Fixed);
        }
        let source = Source::read(json)?;
        let sound = self.source(pointer, &source, ParameterType::Integer) && {
            let candidates = self.candidates(&source);
            self.in_range(pointer, &candidates, [0.0, MAX_OBJECTS as f64])
        };
        sound.then_some(Count::Drawn(source))
    }

    fn group_names(&mut self, groups: &[Group]) {
        for (index, group) in groups.iter().enumerate() {
            if let Some(first) = groups[..index].iter().position(|other| other.name == group.name) {
                let found = format!("{:?}, which group {first} has too", group.name);
                let pointer = format!("/groups/{index}/name");
                self.report(Problem::new("spec/duplicate-name", pointer, found, "a name of its own"));
            }
        }
    }
}

fn number_of(kind: ParameterType, number: f64) -> Value {
    if kind == ParameterType::Integer {
        Value::Integer(number.ceil() as i64)
    } else {
        Value::Number(number)
    }
}
