//! Finds variants that differ in exactly one element of the decision process: declared ones first, then made ones.

use driftworld_generator::{GeneratorError, Subject, at_distance};
use driftworld_spec::{Domain, Element, Role, Value, Variant};

use driftworld_similarity::{Method, OrderOptions, VariantMeasure, order};

use super::choice::changes;
use super::picked::{Picked, apart, distances, farthest, is_alone, measure_of};
use super::wanted::MAX_PROBED;
use crate::CurriculumError;

/// Number of variants by default, if as many can be made.
const DEFAULT_COUNT: usize = 4;

/// Two variants at most this far apart count as equal.
const ALIKE: f64 = 1e-9;

/// Variants for a curriculum that probes one element: the anchor first, and others whose distance from it, and from each
/// other, is above 0 in `element` and exactly 0 in all other elements.
///
/// Matching variants of the `pool` come first, in its order. If there are more than `wanted`, those farthest apart are kept
/// (farthest-first from the anchor). If there are fewer than `wanted`, or than 4 by default, others are made by changing the
/// parameters that affect this element alone: every choice of a list, then variants at even distances up to the farthest.
/// `task` is the task's name in scenarios.
///
/// # Errors
/// [`CurriculumError::BadProbe`] if fewer than 2 or more than [`MAX_PROBED`] are wanted; [`CurriculumError::SeveralTasks`] if
/// the pool has a variant of another task; [`CurriculumError::TooFew`] if not enough could be found or made;
/// [`CurriculumError::Generator`] if no parameter affects the element alone.
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
    let (least, enough) = wanted.map_or((2, DEFAULT_COUNT), |wanted| (wanted, wanted));
    if search.found.len() < enough {
        match search.make(enough) {
            // The declared variants may be enough if none can be made.
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

/// Like [`probe`], with variants named by the user: the anchor first, then the named ones in their order; if more are `wanted`,
/// others are made.
///
/// # Errors
/// [`CurriculumError::NotAlone`] for a variant that does not differ from the anchor and all other named ones in exactly this
/// element; otherwise as [`probe`].
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
            if apart.within(Some(element)) <= ALIKE || !is_alone(&apart, element) {
                let differs = Element::ALL.into_iter().filter(|one| apart.within(Some(*one)) > ALIKE);
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

/// Keeps the `wanted` variants that are farthest apart, in their original order.
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
    /// Whether a variant differs from every variant found so far, and in this element alone.
    fn is_new(&self, variant: &Variant) -> Result<bool, CurriculumError> {
        for picked in &self.found {
            let apart = self.measure.between(&picked.variant, variant)?;
            if apart.within(Some(self.element)) <= ALIKE || !is_alone(&apart, self.element) {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Makes variants until there are `enough`, or no new ones can be made.
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
                // Discrete choices may leave no variant at this distance.
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

    /// Adds a copy of the anchor with these values, if the task allows it and it is new.
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

    /// A name that the task does not declare: `blue-reward-1`.
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
    fn surplus_variants_are_reduced_to_the_farthest_apart() {
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
    fn impossible_probes_are_refused_with_a_reason() {
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
