//! Collects remarks on the worlds that a task draws. Each remark is made once, with its first occurrence.

use std::collections::BTreeSet;
use std::sync::Arc;

use driftworld_generator::Sampler;
use driftworld_spec::{Legend, TaskSpec, World, did_you_mean};
use rayon::prelude::*;

/// Maximum number of worlds checked per variant.
pub(crate) const MAX_CHECKED_WORLDS: u64 = 100;

/// A remark on some worlds of a task.
struct Remark {
    /// The remark without its numbers, which may differ from world to world.
    kind: String,
    pointer: String,
    text: String,
    /// Its first occurrence: the variant, and the index of its world.
    variant: String,
    index: u64,
    worlds: u64,
    variants: BTreeSet<String>,
}

/// Remarks on the first worlds of each variant, as sentences. Worlds that cannot be drawn are skipped.
pub(crate) fn of_task(task: &Arc<TaskSpec>, seed: u64, worlds: u64) -> Vec<String> {
    let worlds = worlds.clamp(1, MAX_CHECKED_WORLDS);
    let variants = task.all_variants();
    let by_variant: Vec<Vec<Remark>> = variants
        .par_iter()
        .map(|variant| {
            let sampler = Sampler::new(variant, seed);
            let groups: Vec<&str> = task.groups().iter().map(|group| group.spec.name.as_str()).collect();
            let mut found = Vec::new();
            for index in 0..worlds {
                if let Ok(world) = sampler.world(index) {
                    let own = world.remarks_without_text().into_iter();
                    let own = own.map(|remark| (remark.pointer, remark.text));
                    let remarks = own.chain(unknown_groups(&world, &groups));
                    gather(
                        &mut found,
                        remarks.map(|(pointer, text)| remark(pointer, text, variant.name(), index)),
                    );
                }
            }
            found
        })
        .collect();
    let mut found = Vec::new();
    for own in by_variant {
        gather(&mut found, own.into_iter());
    }
    let total = variants.len() as u64 * worlds;
    found.iter().map(|remark| remark.sentence(total)).collect()
}

/// Groups that are named in the legend of a world's layout, but missing in its task.
fn unknown_groups(world: &World, groups: &[&str]) -> Vec<(String, String)> {
    let legend = world.environment_params.layout.iter().flat_map(|layout| &layout.legend);
    let unknown = legend.filter_map(|(symbol, meaning)| match meaning {
        Legend::Group(group) if !groups.contains(&group.as_str()) => Some((symbol, group)),
        _ => None,
    });
    let remark = |(symbol, group): (&String, &String)| {
        let near = did_you_mean(group, groups.iter().copied());
        let text =
            format!("no group of the task is called {group:?}: nothing is placed at the letters {symbol:?}{near}");
        (format!("/environment_params/layout/legend/{symbol}"), text)
    };
    unknown.map(remark).collect()
}

fn remark(pointer: String, text: String, variant: &str, index: u64) -> Remark {
    Remark {
        kind: text.chars().filter(|c| !matches!(c, '0'..='9' | '-' | '.')).collect(),
        pointer,
        text,
        variant: variant.to_owned(),
        index,
        worlds: 1,
        variants: BTreeSet::from([variant.to_owned()]),
    }
}

/// Merges new remarks into earlier ones of the same kind; a world counts once per kind.
fn gather(found: &mut Vec<Remark>, more: impl Iterator<Item = Remark>) {
    let mut seen = BTreeSet::new();
    for remark in more {
        let is_first = seen.insert((remark.kind.clone(), remark.variant.clone()));
        match found.iter_mut().find(|known| known.kind == remark.kind) {
            Some(known) if is_first => {
                known.worlds += remark.worlds;
                known.variants.extend(remark.variants);
            }
            Some(_) => {}
            None => found.push(remark),
        }
    }
}

impl Remark {
    fn sentence(&self, total: u64) -> String {
        let Self {
            pointer,
            text,
            variant,
            index,
            worlds,
            variants,
            ..
        } = self;
        let of = match variants.len() {
            1 => String::new(),
            many => format!(", from {many} variants"),
        };
        format!("world {index} of {variant} ({pointer}): {text} (in {worlds} of {total} worlds{of})")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn remarks(world: &str, worlds: u64) -> Vec<String> {
        let text = format!(
            r#"{{ "name": "t", "parameters": {{
                "x": {{ "role": "randomized", "type": "number", "affects": ["S"], "distribution": {{ "uniform": {{ "low": -20, "high": 20 }} }} }},
                "open": {{ "role": "variant", "type": "boolean", "affects": ["S"], "choices": [true, false], "default": false }} }},
              "world": {{ "environment_params": {{ "map_size": [20, 20] }}, {world} }},
              "variants": {{ "shut": {{}}, "wide": {{ "open": true }} }} }}"#
        );
        of_task(&TaskSpec::from_json("t", &text).unwrap(), 0, worlds)
    }

    #[test]
    fn remark_on_all_worlds_is_made_once() {
        let lever = r#""objects": [{ "class": "switch", "coordinates": [2, 2], "switch": { "target": "nothing" } }]"#;
        let found = remarks(lever, 50);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(
            found[0].starts_with("world 0 of shut (/objects/0/switch/target): "),
            "{found:?}"
        );
        assert!(
            found[0].ends_with("(in 100 of 100 worlds, from 2 variants)"),
            "{found:?}"
        );
        assert!(remarks(lever, 1)[0].ends_with("(in 2 of 2 worlds, from 2 variants)"));
    }

    #[test]
    fn unknown_legend_group_is_reported_with_the_nearest_name() {
        let text = r#"{ "name": "t", "world": { "environment_params": { "layout": {
            "text": ["*****", "*P.G*", "*****"], "cell": 3, "legend": { "G": { "group": "gaol" } } } } },
            "groups": [{ "name": "goal", "count": 1, "object": { "class": "cube" }, "placement": { "cells": {} } }] }"#;
        let found = of_task(&TaskSpec::from_json("t", text).unwrap(), 0, 1);
        assert_eq!(
            found,
            [
                "world 0 of default (/environment_params/layout/legend/G): no group of the task is called \"gaol\": nothing is placed at \
              the letters \"G\"; did you mean \"goal\"? (in 1 of 1 worlds)"
            ]
        );
    }

    #[test]
    fn remark_on_some_worlds_is_counted() {
        let zone = r#""rules": { "reward_per_second": 0 }, "objects": [
            { "class": "cube", "coordinates": [{ "param": "x" }, 0], "reward": 1, "reward_once_stimulus": ["AgentCollide"] }]"#;
        let found = remarks(zone, 100);
        assert_eq!(found.len(), 1, "{found:?}");
        let outside: u64 = found[0]
            .split("(in ")
            .nth(1)
            .and_then(|rest| rest.split(' ').next())
            .unwrap()
            .parse()
            .unwrap();
        // About half of the objects lie beyond 10 m, and both variants have the same worlds.
        assert!(outside > 60 && outside < 140 && outside.is_multiple_of(2), "{found:?}");
    }
}
