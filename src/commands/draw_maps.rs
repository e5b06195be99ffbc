//! The worlds that a scenario draws, written as L2Explorer's map files, since the original lives files only. Used by `convert`.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use crate::curriculum::{Plan, log_name};
use crate::spec::{Regime, Scenario};

use super::{Failure, output};

/// The most that a regime may say.
const MOST_STEPS: u32 = 1_000_000_000;

/// The most map files that one scenario becomes.
const MAX_MAPS: u64 = 10_000;

/// Puts a regime of one map in the place of each experience that is drawn, and writes the maps beside `file`.
///
/// Experiences of one world share its file. What the original's maps cannot say is warned about, each thing once.
pub(crate) fn draw_maps(scenario: &mut Scenario, plan: &Plan, file: &Path) -> Result<(), Failure> {
    if file == Path::new("-") {
        return Err(Failure::usage(
            "the scenario draws worlds, which are written as map files beside the output; name the output with -o",
        ));
    }
    let drawn: u64 = scenario
        .blocks
        .iter()
        .flat_map(|block| &block.regimes)
        .filter(|regime| regime.world.is_none())
        .map(|regime| u64::from(regime.count))
        .sum();
    if drawn > MAX_MAPS {
        return Err(Failure::input(format!(
            "found {drawn} experiences in drawn worlds, each a map file of its own, expected at most {MAX_MAPS}; \
             convert a shorter scenario"
        )));
    }
    let stem = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let mut maps = Maps {
        folder: format!("{stem}-maps"),
        beside: file.parent().unwrap_or(Path::new("")),
        written: BTreeMap::new(),
        lost: BTreeSet::new(),
    };
    let mut number = 0;
    for block in &mut scenario.blocks {
        let mut regimes = Vec::new();
        for regime in &block.regimes {
            if regime.world.is_some() {
                number += u64::from(regime.count);
                regimes.push(regime.clone());
                continue;
            }
            for _ in 0..regime.count {
                regimes.push(maps.regime(plan, regime, number)?);
                number += 1;
            }
        }
        block.regimes = regimes;
    }
    for lost in &maps.lost {
        output::warning(lost);
    }
    output::wrote(&maps.beside.join(&maps.folder), format!("{} maps", maps.written.len()));
    Ok(())
}

struct Maps<'a> {
    folder: String,
    beside: &'a Path,
    /// By the hash of the world, the file that holds it.
    written: BTreeMap<String, String>,
    lost: BTreeSet<String>,
}

impl Maps<'_> {
    /// Experience `number` as a regime of its own.
    fn regime(&mut self, plan: &Plan, regime: &Regime, number: u64) -> Result<Regime, Failure> {
        let world = plan.world(number)?;
        let name = log_name(&regime.task, regime.variant_name());
        let hash = world.hash();
        if !self.written.contains_key(&hash) {
            let path = format!("{}/{name}_{number}.json", self.folder);
            let (text, warnings) = world.to_l2explorer();
            // The same property of another object is the same loss.
            self.lost.extend(warnings.into_iter().map(|warning| warning.text));
            output::write(&self.beside.join(&path), text.as_bytes())?;
            self.written.insert(hash.clone(), path);
        }
        let path = &self.written[&hash];
        let variant = path.rsplit('/').next().unwrap_or(path).trim_end_matches(".json");
        Ok(Regime {
            world: Some(path.clone()),
            max_steps: Some(world.step_limit().unwrap_or(0).min(MOST_STEPS)),
            ..Regime::new(name, variant, 1)
        })
    }
}
