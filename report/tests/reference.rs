//! Renders the example lifetime that l2metrics publishes: the page has every figure, and is small.
//!
//! Without the logs the test is skipped; see `reference_data`.

use driftworld_metrics::{Lifetime, Options, Scorer, SteLog, read_log, read_ste_log};
use driftworld_report::{Chapter, ChapterOptions, Report};

use crate::reference_data::reference;

#[test]
fn reference_example_is_a_small_page_with_every_figure() -> Result<(), Box<dyn std::error::Error>> {
    let Some(dir) = reference("l2metrics") else {
        return Ok(());
    };
    let log = read_log(dir.join("ll_logs/multi_task"))?;
    let runs = [
        "ste_task1_1_run1",
        "ste_task2_1_run1",
        "ste_task3_1_run1",
        "ste_task3_1_run2",
    ];
    let experts: Vec<SteLog> = runs
        .iter()
        .map(|run| read_ste_log(dir.join("ste_logs").join(run)))
        .collect::<Result<_, _>>()?;
    let options = Options {
        perf_measure: "performance".to_owned(),
        ..Options::default()
    };
    let lifetime = Lifetime::prepare(&log, &experts, &options)?;
    let metrics = Scorer::default().judge(&log, &lifetime, &options)?;
    let chapters = vec![Chapter::write(&lifetime, &metrics, &ChapterOptions::default())?];
    let page = Report {
        chapters,
        ..Report::default()
    }
    .to_html()?;
    assert_eq!(page.matches("<figure>").count(), 5);
    // The reference's published values, rounded as on the page.
    for part in ">−2.000< >83.82< >78.52< >3.863< >12.63< >1.082< >1.105< >0.913<".split(' ') {
        assert!(page.contains(part), "{part}");
    }
    // Comparisons with experts also depend on learning, so they are not tested.
    for part in ["not tested", "9.552"] {
        assert!(page.contains(part), "{part}");
    }
    for row in metrics.summary().into_iter().filter(|row| row.value.is_some()) {
        let place = page.find(&format!("<code>{}</code>", row.name)).unwrap_or_default();
        let cells = page[place..].split("</tr>").next().unwrap_or_default();
        let word = cells
            .split_once("class=\"verdict")
            .and_then(|(_, rest)| rest.split("</span>").nth(1));
        assert_eq!(word, row.word, "{}: {cells}", row.name);
    }
    assert!(page.len() < 400_000, "{} bytes", page.len());
    Ok(())
}
