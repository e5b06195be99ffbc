//! Checks groups: counts, placements, distances, and references to other groups.

use serde_json::{Value as Json, json};

use super::super::group::{Facing, Group};
use super::super::scope::{Resolved, Scope};
use super::super::template::Source;
use super::super::{Count, PlacedGroup};
use super::Check;
use crate::MAX_OBJECTS;
use crate::describe::{describe, escape, plain_number};
use crate::distribution::{Distribution, Number};
use crate::error::{Problem, first_of};
use crate::value::{ParameterType, Value};

/// Maximum number of placements of a group to check for room: a family may have thousands of variants.
const MAX_CASES: usize = 64;

impl Check<'_> {
    pub(super) fn group(&mut self, index: usize, groups: &[Group]) -> Option<PlacedGroup> {
        let before = self.problems.len();
        let (earlier, group) = (&groups[..index], &groups[index]);
        let root = format!("/groups/{index}");
        let count = self.count(&format!("{root}/count"), &group.count);
        let mut object = group.object.clone();
        if let Some(map) = object.as_object_mut() {
            map.insert("coordinates".to_owned(), json!([0, 0]));
        }
        let object = self.object(&format!("{root}/object"), &object);
        if group.object.get("unique_name").is_some_and(|name| !name.is_null()) {
            let expected = "no unique_name: every object of the group would have it";
            let problem = Problem::new("spec/value", format!("{root}/object/unique_name"), "a name", expected);
            self.report(problem.advise("give them a common \"tag\""));
        }
        self.placement(&format!("{root}/placement"), &group.placement);
        self.cells(&root, group);
        if self.problems.len() == before {
            self.room(&root, group, count.as_ref());
        }
        let around = group
            .around
            .as_ref()
            .and_then(|name| self.earlier(&format!("{root}/around"), name, earlier));
        let facing_group = self.facing(&root, group, earlier);
        let keep_groups = self.keep_out(&root, group, earlier);
        if let Some(first) = earlier.iter().position(|other| other.name == group.name) {
            let found = format!("{:?}, which group {first} has too", group.name);
            self.report(Problem::new(
                "spec/duplicate-name",
                format!("{root}/name"),
                found,
                "a name of its own",
            ));
        }
        let (count, object) = (count?, object?);
        (self.problems.len() == before).then(|| PlacedGroup {
            spec: group.clone(),
            count,
            object,
            around,
            facing_group,
            keep_groups,
        })
    }

    fn placement(&mut self, pointer: &str, placement: &Source) {
        if self.is_unsound(placement) {
            return;
        }
        if let Source::Case(_) = placement {
            self.cases(pointer, placement);
            for (place, leaf) in placement.leaves() {
                self.placement(&format!("{pointer}{place}"), leaf);
            }
            self.has_outcomes(pointer, placement);
            return;
        }
        let sound = match placement {
            Source::Param(reference) => match self.parameters.get(&reference.param) {
                None => {
                    self.unknown_parameter(pointer, &reference.param);
                    false
                }
                Some(parameter) if parameter.kind != ParameterType::Distribution => {
                    let found = format!("the parameter {reference} of type {}", parameter.kind.name());
                    let expected = "a parameter of type distribution";
                    self.report(Problem::new("spec/type", pointer, found, expected));
                    false
                }
                Some(_) => true,
            },
            Source::Case(_) | Source::Value(_) => true,
            Source::Distribution(distribution) => self.distribution(pointer, distribution),
        };
        let odd = self
            .distributions_of(placement)
            .into_iter()
            .find(|distribution| !distribution.is_planar());
        if let (true, Some(odd)) = (sound, odd) {
            let found = format!("the distribution {}", odd.name());
            let expected = format!("one of {}", Distribution::<f64>::PLANAR);
            self.report(Problem::new("spec/type", pointer, found, expected));
        }
    }

    /// Checks placements on layout cells: they need a world with a layout, and allow neither a mixture nor `around`.
    fn cells(&mut self, root: &str, group: &Group) {
        let all = self.distributions_of(&group.placement);
        if !all.iter().any(Distribution::draws_cells) {
            return;
        }
        let pointer = format!("{root}/placement");
        let is_mixed = |law: &Distribution<Number>| law.draws_cells() && !matches!(law, Distribution::Cells { .. });
        if all.iter().any(is_mixed) {
            let found = "cells in a mixture";
            self.report(Problem::new("spec/value", &pointer, found, "only cells"));
        }
        if !self.has_layout {
            let problem = if all.contains(&Distribution::cells_of_group()) {
                Problem::new("spec/missing-key", root, "nothing", "the key \"placement\"")
            } else {
                let found = "cells in a world without a layout";
                Problem::new("spec/value", &pointer, found, "a layout in /world/environment_params")
            };
            self.report(problem);
        }
        if group.around.is_some() {
            let found = "cells with \"around\"";
            let problem = Problem::new("spec/value", pointer, found, "one of the two");
            self.report(problem.advise("cells have fixed positions, which \"around\" cannot move"));
        }
    }

    /// Checks that points taken in turn suffice for the group's minimum number of objects in an empty arena.
    fn room(&mut self, root: &str, group: &Group, count: Option<&Count>) {
        let Some(count) = count else { return };
        let mut seen: Vec<(Distribution, u64, f64)> = Vec::new();
        for (name, values) in &self.variants {
            let scope = Scope::new(self.parameters, values);
            let separation = scope.number(&group.separation).unwrap_or(0.0);
            let (Ok(Resolved::Draw(placement)), Some(min)) =
                (scope.resolve(&group.placement), self.min_count(count, scope))
            else {
                continue;
            };
            let case = (placement, min, separation);
            if seen.contains(&case) {
                continue;
            }
            if let Some(room) = case.0.room_in_turn(min, separation).filter(|room| *room < min) {
                let places = case.0.num_turns().unwrap_or_default();
                let found =
                    format!("{places} places, with room for {room} objects {separation} m apart, in variant {name:?}");
                let expected = format!("places for {min} objects {separation} m apart");
                let problem = Problem::new("spec/no-room", format!("{root}/placement"), found, expected);
                return self.report(problem.advise("add places, or lower the count or the separation"));
            }
            seen.push(case);
            if seen.len() > MAX_CASES {
                return;
            }
        }
    }

    /// The minimum number of objects of a group in a variant, if known.
    fn min_count(&self, count: &Count, scope: Scope) -> Option<u64> {
        let source = match count {
            Count::Fixed(count) => return Some(u64::from(*count)),
            Count::Drawn(source) => source,
        };
        let law = match scope.resolve(source).ok()? {
            Resolved::Value(value) => return u64::try_from(value.as_integer()?).ok(),
            Resolved::Draw(law) => law,
            Resolved::Randomized(reference) => match self.parameters.get(&reference.param)?.distribution.as_ref()? {
                Source::Distribution(distribution) => scope.settle(distribution).ok()?,
                _ => return None,
            },
        };
        let numbers = law.support()?;
        let min_count = numbers
            .iter()
            .filter_map(Value::as_number)
            .fold(f64::INFINITY, f64::min);
        min_count.is_finite().then_some(min_count.max(0.0) as u64)
    }

    /// Index of an earlier group with this name; reports an unknown name.
    fn earlier(&mut self, pointer: &str, name: &str, earlier: &[Group]) -> Option<usize> {
        let found = earlier.iter().position(|group| group.name == name);
        if found.is_none() {
            let names: Vec<&str> = earlier.iter().map(|group| group.name.as_str()).collect();
            let expected = if names.is_empty() {
                "a group before this one; there is none".to_owned()
            } else {
                format!("a group before this one: {}", first_of(&names))
            };
            let problem = Problem::new("spec/unknown-group", pointer, format!("the group {name:?}"), expected);
            self.report(problem.suggest(name, names));
        }
        found
    }

    /// Checks `turned` and `facing`; returns the index of the earlier group that the group faces, if any.
    fn facing(&mut self, root: &str, group: &Group, earlier: &[Group]) -> Option<usize> {
        let wanted = "the key \"around\" with the name of a group";
        if group.turned && group.around.is_none() {
            let pointer = format!("{root}/turned");
            self.report(Problem::new("spec/value", pointer, "true without around", wanted));
        }
        let pointer = format!("{root}/facing");
        match &group.facing {
            Some(Facing::Group(name)) => return self.earlier(&pointer, name, earlier),
            Some(Facing::Point(point)) => {
                for number in point {
                    self.number(&pointer, number, [-300.0, 300.0]);
                }
            }
            Some(Facing::Middle) if group.around.is_none() => {
                let problem = Problem::new("spec/value", pointer, "\"middle\" without around", wanted);
                self.report(problem.advise("or face a point, a group or the agent"));
            }
            _ => {}
        }
        None
    }

    /// Checks the margins; returns the earlier groups from which to keep a distance.
    fn keep_out(&mut self, root: &str, group: &Group, earlier: &[Group]) -> Vec<(usize, Number)> {
        self.number(&format!("{root}/separation"), &group.separation, [0.0, 300.0]);
        self.number(&format!("{root}/keep_out/walls"), &group.keep_out.walls, [0.0, 300.0]);
        self.number(&format!("{root}/keep_out/agent"), &group.keep_out.agent, [0.0, 300.0]);
        let mut groups = Vec::new();
        for (name, distance) in &group.keep_out.groups {
            let pointer = format!("{root}/keep_out/groups/{}", escape(name));
            self.number(&pointer, distance, [0.0, 300.0]);
            groups.extend(
                self.earlier(&pointer, name, earlier)
                    .map(|index| (index, distance.clone())),
            );
        }
        groups
    }

    /// Checks that a number in metres, or a reference to one, is in a range in every variant.
    fn number(&mut self, pointer: &str, number: &Number, [low, high]: [f64; 2]) {
        let before = self.problems.len();
        let names = number.names();
        if names.iter().any(|name| self.unsound.parameters.contains(*name)) {
            return;
        }
        match number {
            Number::Param(reference) => self.number_reference(pointer, reference),
            Number::Case(case) => {
                self.number_case(pointer, case);
                self.reads_no_draw(pointer, &names);
            }
            Number::Literal(_) => {}
        }
        let values = self
            .variants
            .iter()
            .filter_map(|(_, values)| Scope::new(self.parameters, values).number(number).ok());
        let outside = values.into_iter().find(|metres| !(low..=high).contains(metres));
        if let (Some(metres), true) = (outside, self.problems.len() == before) {
            self.report(Problem::new(
                "spec/range",
                pointer,
                format!("{metres} m"),
                format!("{low} to {high} m"),
            ));
        }
    }

    fn count(&mut self, pointer: &str, json: &Json) -> Option<Count> {
        if let Some(number) = json.as_f64() {
            if number.fract() == 0.0 && (0.0..=MAX_OBJECTS as f64).contains(&number) {
                return Some(Count::Fixed(number as u32));
            }
            let expected = format!("a whole number from 0 to {MAX_OBJECTS}");
            self.report(Problem::new("spec/range", pointer, plain_number(number), expected));
            return None;
        }
        let Some(source) = Source::read(json) else {
            let expected = "a whole number, a parameter ({\"param\": …}) or a distribution";
            self.report(Problem::new("spec/value", pointer, describe(json), expected));
            return None;
        };
        if self.is_unsound(&source) {
            return None;
        }
        let sound = self.source(pointer, &source, ParameterType::Integer) && {
            let candidates = self.candidates(&source, ParameterType::Integer);
            self.in_range(pointer, &candidates, [0.0, MAX_OBJECTS as f64])
        };
        sound.then_some(Count::Drawn(source))
    }
}
