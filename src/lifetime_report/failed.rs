//! Links to the worlds in which a lifetime's last evaluation failed, in a workbench.

use std::collections::BTreeMap;

use driftworld_metrics::{BlockType, Log, Row};

use crate::{Failure, argument, tasks};

/// Maximum number of links for each task.
const MOST_OF_A_TASK: usize = 3;

/// Maximum number of links for a lifetime.
const MOST: usize = 24;

/// Refuses what is no address: it becomes a link.
pub(super) fn check_address(workbench: &str) -> Result<(), Failure> {
    if ["http://", "https://"].iter().any(|start| workbench.starts_with(start)) {
        return Ok(());
    }
    Err(Failure::usage(format!(
        "{}: found {workbench:?}, expected an address that begins with http:// or https://, as `driftworld studio` prints it",
        argument("studio")
    )))
}

/// Each link with its words; only worlds of built-in tasks have one, and only logs with a column `success`.
pub(super) fn links(log: &Log, workbench: &str) -> Vec<(String, String)> {
    let page = workbench.split('#').next().unwrap_or_default();
    let evaluated = || log.rows.iter().filter(|row| row.block_type() == BlockType::Test);
    let last = evaluated().map(Row::block_num).max();
    let has_failed = |row: &Row<'_>| Some(row.block_num()) == last && row.metric("success") == Some(0.0);
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    let mut links = Vec::new();
    for row in evaluated().filter(has_failed) {
        let Some((words, fragment)) = world(row) else { continue };
        let count = counts.entry(row.task_name()).or_default();
        *count += 1;
        if *count <= MOST_OF_A_TASK && links.len() < MOST {
            links.push((words, format!("{page}{fragment}")));
        }
    }
    links
}

/// The world of an experience, in words and as the fragment of an address; `None` unless a variant of a built-in task drew it.
fn world(row: Row<'_>) -> Option<(String, String)> {
    let params = row.task_params();
    let known = ["task", "variant", "seed", "max_steps"];
    if !params.keys().all(|key| known.contains(&key.as_str())) {
        return None;
    }
    let text = |key: &str| params.get(key)?.as_str();
    let (task, variant, seed) = (text("task")?, text("variant")?, params.get("seed")?.as_u64()?);
    tasks::text_by_name(task)?;
    tasks::task(task).ok()?.variant(variant).ok()?;
    let index = row.metric("world_index")?;
    Some((
        format!("{task}#{variant}, world {index}"),
        format!("#/play/{task}?variant={variant}&seed={seed}&index={index}"),
    ))
}
