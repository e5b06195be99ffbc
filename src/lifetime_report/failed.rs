//! Links into a workbench, to the worlds in which the agent failed in a lifetime's last evaluation.

use std::collections::BTreeMap;

use driftworld_metrics::{BlockType, Log, Row};

use crate::{Failure, argument, tasks};

/// Maximum number of links for each task.
const MAX_LINKS_PER_TASK: usize = 3;

/// Maximum number of links for a lifetime.
const MAX_LINKS: usize = 24;

/// Refuses anything but a web address, because it becomes a link.
pub(super) fn check_address(workbench: &str) -> Result<(), Failure> {
    if ["http://", "https://"].iter().any(|start| workbench.starts_with(start)) {
        return Ok(());
    }
    Err(Failure::usage(format!(
        "{}: found {workbench:?}, expected an address that begins with http:// or https://, as `driftworld studio` prints it",
        argument("studio")
    )))
}

/// The links, each with its text. Only worlds of built-in tasks get one, and only in logs with a column `success`.
pub(super) fn links(log: &Log, workbench: &str) -> Vec<(String, String)> {
    let page = workbench.split('#').next().unwrap_or_default();
    let evaluated = || log.rows.iter().filter(|row| row.block_type() == BlockType::Test);
    let last = evaluated().map(Row::block_num).max();
    let has_failed = |row: &Row<'_>| Some(row.block_num()) == last && row.metric("success") == Some(0.0);
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    let mut links = Vec::new();
    for row in evaluated().filter(has_failed) {
        let count = counts.entry(row.task_name()).or_default();
        if *count < MAX_LINKS_PER_TASK
            && links.len() < MAX_LINKS
            && let Some((words, fragment)) = world(row)
        {
            *count += 1;
            links.push((words, format!("{page}{fragment}")));
        }
    }
    links
}

/// The world of an experience as text and as a URL fragment; `None` unless it was drawn from a variant of a built-in task.
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
    // Some rows of a log may have no index.
    let index = row.metric("world_index").filter(|index| *index >= 0.0)?;
    Some((
        format!("{task}#{variant}, world {index}"),
        format!("#/play/{task}?variant={variant}&seed={seed}&index={index}"),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use driftworld_metrics::{LogWriter, LoggerInfo, Record, ScenarioInfo, Timestamp, read_log};
    use serde_json::json;

    #[test]
    fn only_failures_of_the_last_evaluation_in_worlds_of_variants_are_linked() {
        let folder = tempfile::tempdir().expect("there is a folder for temporary files");
        let folder = folder.path().join("log");
        let info = LoggerInfo::new(["success", "world_index"]).expect("the columns are valid");
        let mut writer = LogWriter::create(&folder, &info, &ScenarioInfo::default()).expect("the log is new");
        let known = json!({ "task": "maze", "variant": "tiny", "seed": 7 });
        let rows = [
            (0, BlockType::Test, 0.0, &known),
            (1, BlockType::Train, 0.0, &known),
            (2, BlockType::Test, 1.0, &known),
            (2, BlockType::Test, 0.0, &known),
            (
                2,
                BlockType::Test,
                0.0,
                &json!({ "task": "maze", "variant": "tiny", "to": "small", "seed": 7 }),
            ),
            (
                2,
                BlockType::Test,
                0.0,
                &json!({ "task": "mine", "variant": "tiny", "seed": 7 }),
            ),
            (
                2,
                BlockType::Test,
                0.0,
                &json!({ "task": "maze", "variant": "gone", "seed": 7 }),
            ),
        ];
        for (number, (block, kind, success, params)) in (0_u32..).zip(rows) {
            let when = Timestamp::from_unix_micros(i64::from(number)).expect("it is a valid time");
            let record = Record::new(block, u64::from(number), kind, "maze_tiny", when)
                .with_metric("success", success)
                .with_metric("world_index", f64::from(number));
            let params = params.as_object().expect("it is an object").clone();
            writer.write(&record.with_task_params(params)).expect("it is valid");
        }
        drop(writer);
        let found = links(&read_log(&folder).expect("it is a valid log"), "http://x/#/old");
        let expected = (
            "maze#tiny, world 3".to_owned(),
            "http://x/#/play/maze?variant=tiny&seed=7&index=3".to_owned(),
        );
        assert_eq!(found, [expected]);
    }
}
