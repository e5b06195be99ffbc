//! One lifetime on the page: the facts, metrics, curriculum, figures and tasks.

use base64::prelude::{BASE64_STANDARD, Engine as _};
use driftworld_metrics::{BlockSubtype, BlockType, Lifetime, LifetimeMetrics};
use driftworld_text::when;
use maud::{Markup, html};

use super::pieces::{breakable, calm, count, described, number, warnings};
use super::{metric_table, pair_table, reached, task_table};
use crate::ReportError;
use crate::figure::{Figure, FigureOptions, Figures, Layout};
use crate::picture::{Drawing, SheetRow};
use crate::words::shown;

/// A lifetime rendered as HTML.
#[derive(Debug, Clone, Default)]
pub struct Chapter {
    pub(super) name: String,
    pub(super) body: Markup,
}

/// Options of a chapter, and information for its readers.
#[derive(Debug, Clone, PartialEq)]
pub struct ChapterOptions {
    /// Options of the figures.
    pub figures: FigureOptions,
    /// The figures on the page; default all.
    pub shown: Vec<Figure>,
    /// Whether learning was smoothed before scoring; default `true`.
    pub smoothed: bool,
    /// Further entries of the log, by name: agent, scenario, policy.
    pub facts: Vec<(String, String)>,
    /// Pictures of worlds in which the agent learned, or a sentence that explains why there are none.
    pub worlds: Result<Vec<SheetRow>, String>,
    /// Links for playing worlds in which the agent failed: text and address of each.
    pub failed: Vec<(String, String)>,
    /// Warnings, such as those of the log's reader.
    pub warnings: Vec<String>,
    /// A sentence under the timeline: the source of its distances, or why there are none.
    pub distance_note: String,
}

impl Default for ChapterOptions {
    fn default() -> Self {
        Self {
            figures: FigureOptions::default(),
            shown: Figure::ALL.to_vec(),
            smoothed: true,
            facts: Vec::new(),
            worlds: Err(String::new()),
            failed: Vec::new(),
            warnings: Vec::new(),
            distance_note: String::new(),
        }
    }
}

impl Chapter {
    /// Renders a lifetime with its metrics.
    ///
    /// # Errors
    /// Those of [`Figures::of`], and [`ReportError::Drawing`] if the plotting library fails.
    pub fn write(
        lifetime: &Lifetime,
        metrics: &LifetimeMetrics,
        options: &ChapterOptions,
    ) -> Result<Self, ReportError> {
        let figures = Figures::of(lifetime, &metrics.metrics_column, &options.figures)?;
        let table = metric_table::table(lifetime, metrics)?;
        let figure = |figure_kind: Figure, title: &str, caption: &str| -> Result<Markup, ReportError> {
            if !options.shown.contains(&figure_kind) {
                return Ok(Markup::default());
            }
            if !figures.has(figure_kind) {
                return Ok(html! { h3 { (title) } p.note { (missing_reason(figure_kind)) } });
            }
            let alt = format!(
                "{title} of {}: {}",
                shown(lifetime.run_id()),
                alternative(lifetime, figure_kind)
            );
            let wide = described(&figures.inline(figure_kind, Layout::Wide)?, Some("wide"), &alt);
            let narrow = described(&figures.inline(figure_kind, Layout::Narrow)?, Some("narrow"), &alt);
            Ok(html! {
                h3 { (title) }
                figure { (wide) (narrow) figcaption { (caption) } }
            })
        };
        let sleep_note = sleep_note(lifetime);
        let blocks = format!(
            "Each block of the lifetime from left to right.{sleep_note} {}",
            calm(&options.distance_note)
        );
        let lines = when(options.figures.show_eval_lines, || ", joined by lines".to_owned());
        let line_note = if options.smoothed {
            "after smoothing"
        } else {
            "as logged, joined"
        };
        let asleep = when(!sleep_note.is_empty(), || {
            " This lifetime has sleep phases: evaluations while awake are drawn, but do not count towards maintenance, \
             transfer or evaluation performance."
                .to_owned()
        });
        let preprocessing = match (options.smoothed, lifetime.normalization_data_range().is_some()) {
            (true, true) => "after smoothing, scaled to 1…101",
            (true, false) => "after smoothing, in the log's unit",
            (false, true) => "scaled to 1…101",
            (false, false) => "in the log's unit",
        };
        let body = html! {
            (reached::section("Reached", metrics, &options.figures.names))
            (warnings(&options.warnings))
            (facts(lifetime, metrics, &options.facts))
            (worlds(&options.worlds)?)
            (failed(&options.failed))
            (pair_table::tables(metrics, &options.figures.names))
            h3 { "Metrics" }
            (table)
            (figure(Figure::Timeline, "Curriculum", &blocks)?)
            (figure(Figure::Learning, "Learning curves", &format!(
                "Performance {preprocessing}. Grey: evaluations, with learning switched off. Marks: each task's mean \
                 in an evaluation{lines}."
            ))?)
            (figure(Figure::Evaluation, "Evaluations", &format!(
                "Mean of each evaluation with its 95 % interval by Student's t over the evaluation's experiences; no \
                 bar where all were equal or there was only one. The tint shows when the task was learned.{asleep}"))?)
            (figure(Figure::Experts, "Against the single-task expert",
                "The learning blocks of each task end to end, with vertical lines between them, against agents that \
                 learned only this task. Where a curve is above the expert's, this agent performs better after the \
                 same amount of learning.")?)
            (figure(Figure::Raw, "Raw values",
                &format!("As logged: points where there is room, otherwise the area that they cover. Lines: \
                     learning {line_note}."))?)
            h3 { "Tasks" }
            (task_table::table(lifetime, metrics, &options.figures.names))
        };
        Ok(Self {
            name: shown(lifetime.run_id()),
            body,
        })
    }
}

/// Pictures of worlds, or the reason why there are none.
fn worlds(rows: &Result<Vec<SheetRow>, String>) -> Result<Markup, ReportError> {
    let rows = match rows {
        Ok(rows) => rows,
        Err(why) => return Ok(html! { @if !why.is_empty() { p.note { (calm(why)) } } }),
    };
    let mut figures = Vec::new();
    for SheetRow { title, words, pictures } in rows {
        let pngs = pictures.iter().map(Drawing::to_png).collect::<Result<Vec<_>, _>>()?;
        figures.push(html! {
            figure.world {
                @for (png, from) in pngs.iter().zip(["as its agent sees it", "from above"]) {
                    img src=(format!("data:image/png;base64,{}", BASE64_STANDARD.encode(png)))
                        alt=(format!("a world of {}, {from}", shown(title)));
                }
                figcaption { b { (breakable(&shown(title))) } " " (calm(words)) }
            }
        });
    }
    Ok(html! {
        h3 { "Worlds" }
        div.worlds { @for figure in &figures { (figure) } }
    })
}

/// Links to worlds in which the agent failed.
fn failed(links: &[(String, String)]) -> Markup {
    html! {
        @if !links.is_empty() {
            p.note {
                "Failed in the last evaluation; play in the workbench: "
                @for (number, (words, address)) in links.iter().enumerate() {
                    @if number > 0 { " · " }
                    a href=(address) { (breakable(words)) }
                }
            }
        }
    }
}

/// The number of blocks of a kind, and how many of them are sleep blocks.
fn blocks_of(lifetime: &Lifetime, kind: BlockType) -> (usize, usize) {
    let regimes = lifetime.regimes().iter();
    let of_kind = regimes.filter(|regime| regime.block_type == kind);
    of_kind.fold((0, 0), |(all, asleep), regime| {
        (
            all + 1,
            asleep + usize::from(regime.block_subtype == BlockSubtype::Sleep),
        )
    })
}

/// A sentence on the number of sleep blocks in the figures, if there are any.
fn sleep_note(lifetime: &Lifetime) -> String {
    let [learning, evaluation] = [BlockType::Train, BlockType::Test].map(|kind| blocks_of(lifetime, kind).1);
    when(learning + evaluation > 0, || {
        let (learning, evaluation) = (count(learning), count(evaluation));
        format!(" Sleep blocks are drawn like the others: {learning} of learning, {evaluation} of evaluation.")
    })
}

/// The reason why a figure is missing.
fn missing_reason(figure: Figure) -> &'static str {
    match figure {
        Figure::Experts => "No single-task expert was given for any learned task, so there is nothing to compare with.",
        Figure::Evaluation => "The log has no evaluations.",
        _ => "The log has no learning.",
    }
}

/// Alternative text of a figure.
fn alternative(lifetime: &Lifetime, figure: Figure) -> String {
    let tasks = lifetime.tasks().len();
    let blocks = lifetime.regimes().len();
    match figure {
        Figure::Timeline => format!("{blocks} blocks in {tasks} rows, one per task"),
        Figure::Learning => format!("a curve for each learning block of {tasks} tasks, and means of evaluations"),
        Figure::Evaluation => format!("means with intervals over the lifetime, a panel for each of {tasks} tasks"),
        Figure::Experts => "for each task, a curve of this agent and one for each run of its expert".to_owned(),
        Figure::Raw => format!("points for each experience of {tasks} tasks, with curves of learning"),
    }
}

/// The size of the lifetime, and the column by which it was scored.
fn facts(lifetime: &Lifetime, metrics: &LifetimeMetrics, given_facts: &[(String, String)]) -> Markup {
    let blocks = match blocks_of(lifetime, BlockType::Train) {
        (all, 0) => count(all),
        (all, asleep) => format!("{} ({} asleep)", count(all), count(asleep)),
    };
    let mut facts: Vec<(String, String)> = given_facts
        .iter()
        .map(|(name, value)| (shown(name), shown(value)))
        .collect();
    // The agent's performance comes first: the metrics, scaled by the lifetime's own range, do not show it.
    for (column, means) in &metrics.as_logged {
        for (mean, when) in [(means.learning, "learning"), (means.evaluation, "evaluations")] {
            if let Some(mean) = mean {
                facts.push((format!("mean {}, {when}", shown(column)), number(mean)));
            }
        }
    }
    let counts = [
        ("learning experiences", count(metrics.num_lx)),
        ("evaluation experiences", count(metrics.num_ex)),
        ("tasks", count(lifetime.tasks().len())),
        ("learning blocks", blocks),
        ("scored by", shown(&metrics.metrics_column)),
    ];
    facts.extend(counts.map(|(name, value)| (name.to_owned(), value)));
    html! {
        dl.facts {
            @for (name, value) in &facts {
                div { dt { (name) } dd { (value) } }
            }
        }
    }
}
