//! Turns a task's document into a checked task: checks references, types and ranges, which the schema cannot check.

mod cases;
mod groups;
mod json;
pub(super) mod partial;
mod sources;
mod templates;
mod variants;

use std::collections::BTreeSet;
use std::sync::OnceLock;

use indexmap::IndexMap;

use super::expression::{Kind, Requirement};
use super::extends::{is_built_on, values_of};
use super::family::{self, Variants};
use super::parameter::{Parameter, Role};
use super::template::Source;
use super::variant;
use super::variant_spec::{DEFAULT_VARIANT, RESERVED};
use super::{PlacedGroup, TaskDocument, TaskSpec};
use crate::classes::Classes;
use crate::describe::escape;
use crate::distribution::{Distribution, Number};
use crate::error::Problem;
use crate::value::{ParameterType, Value};

/// Invalid parts of a document.
#[derive(Clone, Debug, Default)]
pub(super) struct Unsound {
    /// Invalid parameters: references to them are not checked.
    pub(super) parameters: BTreeSet<String>,
    /// Invalid variants: variants that extend them are not checked.
    pub(super) variants: BTreeSet<String>,
}

/// The checked task, or all problems; `classes` are the known classes of objects, if any are given.
///
/// After a problem, continues with everything that does not depend on it: `unsound` lists the parts that the schema rejected.
pub(super) fn compile(
    document: TaskDocument,
    classes: Option<&Classes>,
    mut unsound: Unsound,
) -> Result<TaskSpec, Vec<Problem>> {
    family::fits(document.variants.len(), document.parameters.len())?;
    let mut problems: Vec<Problem> = reserved_names(&document.parameters).collect();
    problems.extend(names(&document));
    for (name, parameter) in &document.parameters {
        let found = parameter.problems(name);
        if !found.is_empty() {
            unsound.parameters.insert(name.clone());
        }
        problems.extend(found);
    }
    let (variants, found) = family::unfold(&document.parameters, &document.variants);
    let unfolded = found.is_empty();
    problems.extend(found);
    let is_unsound = |name: &str| unsound.parameters.contains(name);
    let reported: BTreeSet<String> = problems.iter().map(|problem| problem.pointer.clone()).collect();
    let more = variants::problems(&document.parameters, &document.variants, &variants, is_unsound);
    problems.extend(more.into_iter().filter(|problem| !reported.contains(&problem.pointer)));
    let of_variants: BTreeSet<&str> = problems
        .iter()
        .filter_map(|problem| problem.pointer.strip_prefix("/variants/")?.split('/').next())
        .collect();
    let wrong = document
        .variants
        .keys()
        .filter(|name| of_variants.contains(escape(name).as_str()));
    unsound.variants.extend(wrong.cloned());

    let mut check = Check::new(&document, &variants, classes, unsound);
    check.cycles();
    check.parameters();
    let (world, fixtures) = check.world(&document.world);
    let groups: Vec<Option<PlacedGroup>> = (0..document.groups.len())
        .map(|index| check.group(index, &document.groups))
        .collect();
    let requirements = check.requirements(&document.require);
    let read_conditions = check.read_conditions();
    check.variants_meet(&requirements, &variants);
    problems.append(&mut check.problems);
    fail_on(problems)?;
    let (Some(world), Some(fixtures), Some(groups), true) = (
        world,
        fixtures.into_iter().collect(),
        groups.into_iter().collect(),
        unfolded,
    ) else {
        // The task depends on a rejected part; the problem of that part is reported instead.
        return Err(Vec::new());
    };
    let task = TaskSpec {
        document,
        variants,
        world,
        fixtures,
        groups,
        requirements,
        read_conditions,
        readers: OnceLock::new(),
    };
    fail_on(unused_measures(&task))?;
    Ok(task)
}

fn fail_on(problems: Vec<Problem>) -> Result<(), Vec<Problem>> {
    if problems.is_empty() { Ok(()) } else { Err(problems) }
}

/// Reports measures of parameters that only distributions read: variants are then compared by those distributions, so the
/// measure would not be used.
fn unused_measures(task: &TaskSpec) -> Vec<Problem> {
    let compared = task.parameters().iter().filter(|(_, own)| own.compare.is_some());
    let problem = |(name, parameter): (&String, &Parameter)| {
        let readers = task.readers(name);
        (parameter.role == Role::Variant && readers.are_draws_alone()).then(|| {
            let draws = readers.draws.join(", ");
            let found = format!("a measure for a parameter that is used only to draw {draws}");
            let expected = "\"compare\" in the drawn parameter, because its distribution is compared";
            let pointer = format!("/parameters/{}/compare", escape(name));
            Problem::new("spec/compare", pointer, found, expected)
        })
    };
    compared.filter_map(problem).collect()
}

/// Reports names that pass the schema but not the grammar; names of a family's variants are checked when it is unfolded.
fn names(document: &TaskDocument) -> impl Iterator<Item = Problem> {
    let variants = document
        .variants
        .keys()
        .map(|name| (format!("/variants/{}", escape(name)), name));
    let groups = document.groups.iter().enumerate();
    let groups = groups.map(|(index, group)| (format!("/groups/{index}/name"), &group.name));
    [("/name".to_owned(), &document.name)]
        .into_iter()
        .chain(variants)
        .chain(groups)
        .filter_map(|(pointer, name)| crate::names::problem(pointer, name))
}

fn reserved_names(parameters: &IndexMap<String, Parameter>) -> impl Iterator<Item = Problem> {
    parameters
        .keys()
        .filter(|name| RESERVED.contains(&name.as_str()))
        .map(|name| {
            let found = format!("a parameter named {name:?}");
            Problem::new(
                "spec/reserved-name",
                format!("/parameters/{name}"),
                found,
                "a name that is not a key of a variant",
            )
        })
}

/// A check of one document, which collects problems.
struct Check<'a> {
    parameters: &'a IndexMap<String, Parameter>,
    /// The values of every valid variant, by name; the default variant comes first.
    variants: Vec<(String, IndexMap<String, Value>)>,
    /// The known classes of objects, if any are given.
    classes: Option<&'a Classes>,
    /// Whether the task's world mentions a layout.
    has_layout: bool,
    unsound: Unsound,
    problems: Vec<Problem>,
}

impl<'a> Check<'a> {
    fn new(document: &'a TaskDocument, variants: &Variants, classes: Option<&'a Classes>, unsound: Unsound) -> Self {
        let names = std::iter::once(DEFAULT_VARIANT).chain(variants.keys().map(String::as_str));
        let checked_variants = names
            .filter(|name| !is_built_on(variants, name, &unsound.variants))
            .filter_map(|name| {
                let mut values = values_of(&document.parameters, variants, name).ok()?;
                values.retain(|parameter, _| !unsound.parameters.contains(parameter));
                Some((name.to_owned(), values))
            })
            .collect();
        Self {
            parameters: &document.parameters,
            variants: checked_variants,
            classes,
            has_layout: document.world.pointer("/environment_params/layout").is_some(),
            unsound,
            problems: Vec::new(),
        }
    }

    /// Whether a source depends on an unsound parameter and therefore cannot be checked.
    fn is_unsound(&self, source: &Source) -> bool {
        if self.unsound.parameters.is_empty() {
            return false;
        }
        let is_named = source.names().iter().any(|name| self.unsound.parameters.contains(name));
        is_named || self.distributions_of(source).iter().any(|law| self.has_unsound(law))
    }

    /// Whether a distribution refers to an unsound parameter.
    fn has_unsound(&self, distribution: &Distribution<Number>) -> bool {
        let numbers = distribution.numbers();
        let mut names = numbers.iter().flat_map(Number::names);
        names.any(|name| self.unsound.parameters.contains(name))
    }

    fn report(&mut self, problem: Problem) {
        self.problems.push(problem);
    }

    /// Checks parameters that are, or are drawn from, distributions: their numbers and their type.
    fn parameters(&mut self) {
        for (name, parameter) in self.parameters {
            if self.unsound.parameters.contains(name) {
                continue;
            }
            let pointer = format!("/parameters/{}", escape(name));
            for (key, value) in parameter.entries() {
                if let (ParameterType::Distribution, Value::Distribution(distribution)) = (parameter.kind, value)
                    && !self.has_unsound(distribution)
                {
                    self.parameter_distribution(&format!("{pointer}/{key}"), distribution);
                }
            }
            if let Some(source) = &parameter.distribution {
                self.randomized(&pointer, parameter, source);
            }
        }
    }

    /// Checks that a randomized parameter's distribution yields its type.
    fn randomized(&mut self, parameter_pointer: &str, parameter: &Parameter, source: &Source) {
        let pointer = &format!("{parameter_pointer}/distribution");
        let is_plain = matches!(source, Source::Param(_));
        for (place, leaf) in source.leaves() {
            let Source::Param(reference) = leaf else { continue };
            let known = self.parameters.get(&reference.param);
            let fits = |known: &Parameter| {
                known.role != Role::Randomized && (known.kind == ParameterType::Distribution || !is_plain)
            };
            if known.is_some_and(|known| !fits(known)) {
                let found = format!("the parameter {:?}", reference.param);
                let expected = if is_plain {
                    "a fixed or variant parameter of type distribution"
                } else {
                    "a fixed or variant parameter"
                };
                return self.report(Problem::new("spec/type", format!("{pointer}{place}"), found, expected));
            }
        }
        if parameter.kind == ParameterType::Layout {
            self.drawn_layouts(pointer, source);
        }
        if !self.is_unsound(source)
            && self.source(pointer, source, parameter.kind)
            && matches!(source, Source::Param(_) | Source::Case(_))
        {
            self.measure_fits(&format!("{parameter_pointer}/compare/measure"), parameter, source);
        }
    }

    /// Checks that the measure of a parameter fits all distributions of the parameter from which it is drawn.
    fn measure_fits(&mut self, pointer: &str, parameter: &Parameter, source: &Source) {
        let Some(measure) = parameter.compare.as_ref().and_then(|compare| compare.measure) else {
            return;
        };
        let all = self.distributions_of(source);
        let mut misfits = all.iter().map(|own| measure.misfit_of_draws(own, parameter.kind));
        if let Some(expected) = misfits.find_map(|misfit| misfit) {
            self.report(Problem::new("spec/compare", pointer, measure.name(), expected));
        }
    }

    /// The valid requirements.
    fn requirements(&mut self, texts: &[String]) -> Vec<Requirement> {
        let mut requirements = Vec::new();
        for (index, text) in texts.iter().enumerate() {
            let pointer = format!("/require/{index}");
            if let Some(requirement) = self.parsed(&pointer, text)
                && self.requirement(&pointer, &requirement)
            {
                requirements.push(requirement);
            }
        }
        requirements
    }

    /// The valid conditions of `read_if`.
    fn read_conditions(&mut self) -> IndexMap<String, Requirement> {
        let mut conditions = IndexMap::new();
        for (name, parameter) in self.parameters {
            let Some(text) = &parameter.read_if else { continue };
            let pointer = format!("/parameters/{}/read_if", escape(name));
            if let Some(condition) = self.parsed(&pointer, text)
                && self.reads_no_draw(&pointer, condition.names())
                && self.requirement(&pointer, &condition)
            {
                conditions.insert(name.clone(), condition);
            }
        }
        conditions
    }

    /// Parses a condition; reports a syntax error.
    fn parsed(&mut self, pointer: &str, text: &str) -> Option<Requirement> {
        let parsed = Requirement::parse(text);
        let problem = |expected| Problem::new("spec/requirement", pointer, format!("{text:?}"), expected);
        parsed.map_err(|expected| self.report(problem(expected))).ok()
    }

    /// Whether a requirement compares comparable parameters and gives true or false.
    fn requirement(&mut self, pointer: &str, requirement: &Requirement) -> bool {
        if requirement
            .names()
            .iter()
            .any(|name| self.unsound.parameters.contains(name))
        {
            return false;
        }
        let before = self.problems.len();
        for name in requirement.names() {
            let Some(parameter) = self.parameters.get(name) else {
                self.unknown_parameter(pointer, name);
                continue;
            };
            if Kind::of(parameter).is_none() {
                let found = format!("the parameter {name:?} of type {}", parameter.kind.name());
                let expected = "numbers, headings, true or false, texts, colours, or one number of a vector or point";
                self.report(Problem::new("spec/type", pointer, found, expected));
            }
        }
        if self.problems.len() > before {
            return false;
        }
        if let Some((found, expected)) = requirement.misfit(|name| Kind::of(self.parameters.get(name)?)) {
            let found = format!("{found} in {:?}", requirement.text());
            self.report(Problem::new("spec/requirement", pointer, found, expected));
            return false;
        }
        if requirement.names().is_empty() && requirement.holds(|_| None) == Some(false) {
            let found = format!("{:?}, which names no parameter and never holds", requirement.text());
            let expected = "a condition that some values of the parameters meet";
            self.report(Problem::new("spec/requirement", pointer, found, expected));
            return false;
        }
        true
    }

    /// Checks that every declared variant meets the requirements on parameters that are not randomized.
    fn variants_meet(&mut self, requirements: &[Requirement], variants: &Variants) {
        for (name, values) in self.variants.iter().filter(|(name, _)| variants.contains_key(name)) {
            if let Some((requirement, shown)) = variant::violated_requirement(requirements, values) {
                let pointer = format!("/variants/{}", escape(&variants[name].origin));
                let found = format!("{shown} in variant {name:?}");
                let expected = format!("the condition in \"require\": {requirement}");
                self.problems
                    .push(Problem::new("spec/requirement", pointer, found, expected));
            }
        }
    }
}
