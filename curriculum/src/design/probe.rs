//! Variants that differ in one element of the decision process and in no other: chosen where the task declares them, made where it
//! does not. In which order they are met is said by `hypothesis.rs`.

use driftworld_generator::{GeneratorError, Subject, at_distance};
use driftworld_spec::{Domain, Element, Role, Value, Variant};

use driftworld_similarity::{Method, OrderOptions, VariantMeasure, order};

use super::choice::changes;
use super::picked::{Picked, apart, distances, farthest, in_element, is_alone, measure_of};
use crate::CurriculumError;

/// The most variants that a probe can be asked for: each is compared with every other.
pub const MAX_PROBED: usize = 200;

/// How many variants there are at least where nobody says how many.
const ENOUGH: usize = 4;

/// Two variants are alike if they are no farther apart than this.
const ALIKE: f64 = 1e-9;

/// Variants for a curriculum that probes one element: the anchor first, and others whose distance from it, and from each
/// other, is above 0 in `element` and exactly 0 in all other elements.
///
/// Those of the `pool` that are such come first, in its order. Of more than `wanted` those are kept that lie farthest apart
/// (farthest-first from the anchor). If there are fewer than `wanted`, or than 4 where that is left open, others are made along
/// the parameters that affect this element alone: every choice of a list, then variants at even distances up to the farthest.
/// `task` is what scenarios call the task.
///
/// # Errors
/// [`CurriculumError::BadProbe`] if fewer than 2 or more than [`MAX_PROBED`] are wanted; [`CurriculumError::SeveralTasks`] if the pool has a variant of another task; [`CurriculumError::TooFew`] if not enough are
/// found and made; [`CurriculumError::Generator`] if no parameter affects the element alone.
pub fn probe(
    task: &str,
    pool: &[Variant],
    anchor: &Variant,
    element: Element,
    wanted: Option<usize>,
) -> Result<Vec<Picked>, CurriculumError> {
    if let Some(found) = wanted.filter(|wanted| !(2..=MAX_PROBED).contains(wanted)) {
        return Err(CurriculumError::BadProbe(found));
    }
    let mut search = Search {
        measure: measure_of(anchor),
        task,
        anchor,
        element,
        found: vec![Picked::declared(task, anchor.clone())],
        made: 0,
    };
    for variant in pool {
        if variant.task().name() != anchor.task().name() {
            return Err(CurriculumError::several_tasks(anchor.id(), variant.id()));
        }
        if search.is_new(variant)? {
            search.found.push(Picked::declared(task, variant.clone()));
        }
    }
    let (least, enough) = wanted.map_or((2, ENOUGH), |wanted| (wanted, wanted));
    if search.found.len() < enough {
        match search.make(enough) {
            // What the task declares may do where nothing can be made.
            Err(CurriculumError::Generator(GeneratorError::NothingToVary { .. })) if search.found.len() >= least => {}
            other => other?,
        }
    }
    if search.found.len() < least {
        return Err(CurriculumError::TooFew {
            anchor: anchor.id(),
            element: element.name(),
            found: search.found.len(),
            wanted: least,
        });
    }
    let found = search.found;
    match wanted {
        Some(wanted) if wanted < found.len() => spread_out(found, element, wanted),
        _ => Ok(found),
    }
}

/// Variants for a curriculum that probes one element, where somebody has named which: the anchor first, then all others named, in their
/// order; if more are `wanted`, others are made as [`probe`] does.
///
/// # Errors
/// [`CurriculumError::NotAlone`] for a variant that differs from the anchor or another named one in something else, or not at all; else
/// as [`probe`].
pub fn probe_named(
    task: &str,
    named: &[Variant],
    anchor: &Variant,
    element: Element,
    wanted: Option<usize>,
) -> Result<Vec<Picked>, CurriculumError> {
    let measure = measure_of(anchor);
    let mut met = vec![anchor];
    for variant in named.iter().filter(|variant| variant.name() != anchor.name()) {
        if variant.task().name() != anchor.task().name() {
            return Err(CurriculumError::several_tasks(anchor.id(), variant.id()));
        }
        for before in &met {
            let apart = measure.between(before, variant)?;
            if in_element(&apart, Some(element)) <= ALIKE || !is_alone(&apart, element) {
                let differs = Element::ALL
                    .into_iter()
                    .filter(|one| in_element(&apart, Some(*one)) > ALIKE);
                let differs: Vec<&str> = differs.map(Element::name).collect();
                return Err(CurriculumError::NotAlone {
                    a: before.id(),
                    b: variant.id(),
                    element: element.name(),
                    differs: driftworld_text::joined_or(&differs, ", ", "nothing"),
                });
            }
        }
        met.push(variant);
    }
    let count = wanted.unwrap_or(met.len()).max(met.len());
    let named: Vec<Variant> = met.into_iter().cloned().collect();
    probe(task, &named, anchor, element, Some(count))
}

/// The `wanted` that lie farthest apart, in the order they had.
fn spread_out(found: Vec<Picked>, element: Element, wanted: usize) -> Result<Vec<Picked>, CurriculumError> {
    let matrix = distances(&found, Some(element))?;
    let order = order(&matrix, Method::Farthest, &OrderOptions::default().with_first(0))?;
    let kept = &order.indices[..wanted];
    let numbered = found.into_iter().enumerate();
    Ok(numbered
        .filter(|(index, _)| kept.contains(index))
        .map(|(_, picked)| picked)
        .collect())
}

struct Search<'a> {
    measure: VariantMeasure,
    task: &'a str,
    anchor: &'a Variant,
    element: Element,
    found: Vec<Picked>,
    made: usize,
}

impl Search<'_> {
    /// Whether a variant differs in the element alone, from everything that was found.
    fn is_new(&self, variant: &Variant) -> Result<bool, CurriculumError> {
        for picked in &self.found {
            let apart = self.measure.between(&picked.variant, variant)?;
            if in_element(&apart, Some(self.element)) <= ALIKE || !is_alone(&apart, self.element) {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Makes variants until there are `enough`, or nothing new comes of it.
    fn make(&mut self, enough: usize) -> Result<(), CurriculumError> {
        for (parameter, value) in self.choices() {
            if self.found.len() >= enough {
                return Ok(());
            }
            self.add([(parameter, value)])?;
        }
        let subject = Subject::Element(self.element);
        let (anchor, element) = (self.anchor, self.element);
        let by = self.measure.clone();
        let measure = |other: &Variant| apart(&by, anchor, other, Some(element)).unwrap_or(0.0);
        let farthest = farthest(&by, anchor, &subject, Some(element))?;
        let missing = enough.saturating_sub(self.found.len());
        for parts in [missing, 2 * missing, 4 * missing, 8 * missing] {
            for part in 1..=parts {
                if self.found.len() >= enough {
                    return Ok(());
                }
                let target = farthest * part as f64 / parts as f64;
                let tolerance = farthest / (8 * parts) as f64;
                // Where choices leave a gap, there is none.
                if let Ok(found) = at_distance(anchor, &subject, target, tolerance.min(1e-4), measure)
                    .or_else(|_| at_distance(anchor, &subject, target, tolerance, measure))
                {
                    self.add(changes(anchor, &found.variant))?;
                }
            }
        }
        Ok(())
    }

    /// Every other choice of the parameters that affect the element alone.
    fn choices(&self) -> Vec<(String, Value)> {
        let mut choices = Vec::new();
        for (name, parameter) in self.anchor.task().parameters() {
            if parameter.role != Role::Variant || !parameter.affects_only(self.element) {
                continue;
            }
            if let Some(Domain::Choices(values)) = parameter.domain() {
                let others = values
                    .into_iter()
                    .filter(|value| self.anchor.value(name) != Some(value));
                choices.extend(others.map(|value| (name.clone(), value)));
            }
        }
        choices
    }

    /// Adds the anchor with these values, if the task allows them and they are new.
    fn add(&mut self, changes: impl IntoIterator<Item = (String, Value)>) -> Result<(), CurriculumError> {
        let name = self.next_name();
        let Ok(variant) = self.anchor.with(&name, changes) else {
            return Ok(());
        };
        if self.is_new(&variant)? {
            self.made += 1;
            self.found.push(Picked::made(self.task, self.anchor, variant));
        }
        Ok(())
    }

    /// A name that the task does not have: `blue-reward-1`.
    fn next_name(&self) -> String {
        let declared = self.anchor.task().variant_names();
        let name = |number: usize| format!("{}-{}-{number}", self.anchor.name(), self.element.name());
        let numbers = self.made + 1..;
        numbers
            .map(name)
            .find(|name| !declared.contains(&name.as_str()))
            .expect("a task declares finitely many names")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use driftworld_spec::TaskSpec;
    use std::sync::Arc;

    fn task() -> Arc<TaskSpec> {
        TaskSpec::from_json(
            "t",
            r#"{ "name": "t", "parameters": {
                "pay": { "role": "variant", "type": "number", "affects": ["R"], "range": [0, 100], "default": 100 },
                "light": { "role": "variant", "type": "number", "affects": ["O"], "range": [0, 4], "default": 2 },
                "motion": { "role": "variant", "type": "string", "affects": ["T"], "choices": ["still", "prey", "predator"], "default": "still" },
                "size": { "role": "variant", "type": "number", "affects": ["S", "O"], "range": [1, 9], "default": 5 } },
               "variants": { "base": {}, "dim": { "light": 1 }, "dark": { "light": 0 }, "poor": { "pay": 50 },
                "poor_and_dim": { "pay": 20, "light": 1 }, "large": { "size": 9 } } }"#,
        )
        .unwrap()
    }

    #[track_caller]
    fn check(element: Element, wanted: Option<usize>, expected: &[(&str, f64)]) {
        let task = task();
        let picked = probe(
            "t",
            &task.all_variants(),
            &task.variant("base").unwrap(),
            element,
            wanted,
        )
        .unwrap();
        let found: Vec<(&str, f64)> = picked
            .iter()
            .map(|one| {
                (
                    one.choice.name(),
                    picked[0].distance(one).unwrap().element(element).unwrap(),
                )
            })
            .collect();
        let near = found.len() == expected.len()
            && found
                .iter()
                .zip(expected)
                .all(|(a, b)| a.0 == b.0 && (a.1 - b.1).abs() < 1e-3);
        assert!(near, "{found:?}");
        for a in &picked {
            for b in &picked {
                assert!(
                    is_alone(&a.distance(b).unwrap(), element),
                    "{} and {}",
                    a.choice.id(),
                    b.choice.id()
                );
            }
        }
    }

    #[test]
    fn declared_variants_are_picked_and_the_missing_ones_made() {
        check(
            Element::R,
            None,
            &[
                ("base", 0.0),
                ("poor", 0.5),
                ("base-reward-1", 0.5 + 0.5),
                ("base-reward-2", 0.25),
            ],
        );
        check(
            Element::T,
            None,
            &[("base", 0.0), ("base-transition-1", 1.0), ("base-transition-2", 1.0)],
        );
    }

    #[test]
    fn of_too_many_those_are_kept_that_lie_farthest_apart() {
        let task = task();
        let pick = |wanted| {
            let picked = probe(
                "t",
                &task.all_variants(),
                &task.variant("base").unwrap(),
                Element::O,
                Some(wanted),
            );
            let picked = picked.unwrap();
            picked
                .iter()
                .map(|one| one.choice.name().to_owned())
                .collect::<Vec<_>>()
        };
        assert_eq!(pick(2), ["base", "dark"]);
        assert_eq!(pick(3), ["base", "dim", "dark"]);
    }

    #[test]
    fn what_cannot_be_probed_says_why() {
        let task = task();
        let pool = task.all_variants();
        let base = task.variant("base").unwrap();
        let said = |element, wanted| probe("t", &pool, &base, element, wanted).unwrap_err().to_string();
        assert!(said(Element::A, None).contains("affect A alone"));
        assert!(said(Element::S, None).contains("affect S alone"));
        assert_eq!(
            said(Element::T, Some(5)),
            "probing the transition: found 3 variants that differ from t#base in it alone, expected 5; \
             ask for fewer, or give the task parameters that affect it alone"
        );
        for (wanted, found) in [(0, "0"), (1, "1"), (201, "201")] {
            let expected = format!("probing: found {found} variants wanted, expected 2 to 200");
            assert_eq!(said(Element::O, Some(wanted)), expected);
        }
        let other = TaskSpec::from_json("u", r#"{ "name": "u" }"#).unwrap();
        let mixed = [other.variant("default").unwrap()];
        let error = probe("t", &mixed, &base, Element::R, None).unwrap_err().to_string();
        assert!(error.contains("t#base and u#default"), "{error}");
    }
}
