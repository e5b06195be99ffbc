//! Distances between neighbouring learning blocks, from a matrix or from the logged scenario, and pictures of their worlds.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use driftworld_curriculum::{log_name, log_name_of_label};
use driftworld_env::Catalogue;
use driftworld_metrics::{Lifetime, Log, VariantMode};
use driftworld_report::neighbours;
use driftworld_report::picture::SheetRow;
use driftworld_similarity::DistanceMatrix;
use driftworld_spec::{BlockKind, Regime, Scenario, TaskSpec, Variant};
use driftworld_text::{ShownPath, when};
use serde_json::Value;

use crate::contact_sheet::{Item, Options, cells};
use crate::distances::{Sample, fitting, variant_matrix};
use crate::sheet_words::Worlds;
use crate::{Failure, argument, matrix_file, tasks};

/// Maximum number of variants whose worlds are drawn.
const MAX_PICTURED: usize = 12;

const LOOK: Options = Options {
    index: None,
    turn: None,
    size: 144,
    columns: 1,
};

/// Maximum number of variants whose distances are measured for a report.
const MAX_MEASURED: usize = 32;

/// The source of distances.
pub(super) struct Neighbours {
    given: Option<Named>,
    tasks: Tasks,
    mode: VariantMode,
    /// Measured distances by the scenario's text, which repeats share.
    measured: BTreeMap<String, Result<Named, String>>,
    /// The scenarios whose worlds are already on the page.
    pictured: BTreeSet<String>,
}

/// A matrix with the indices of its variants by their log names.
struct Named {
    matrix: DistanceMatrix,
    /// The indices of a block's first and last variants, which differ only if the block drifts.
    index: BTreeMap<String, (usize, usize)>,
    /// Its source, as the end of a sentence.
    origin: String,
}

/// A learning block: its name in the log, its regime, its variant and, if it drifts, its last variant.
type Learned = (String, Regime, Variant, Option<Variant>);

/// Distances of neighbours, with a sentence about them.
type Distances = (Option<Vec<Option<f64>>>, String);

impl Neighbours {
    /// Uses the matrix in a file; without one, measures distances. `tasks` are the files of tasks that are not built in.
    pub(super) fn new(file: Option<&Path>, tasks: &[PathBuf], mode: VariantMode) -> Result<Self, Failure> {
        let read = |path: &Path| {
            let matrix = matrix_file::read("distances", path)?;
            let origin = format!("from {}", path.file_name().unwrap_or_default().to_string_lossy());
            let labels = matrix.labels().iter().enumerate();
            let index = labels.map(|(at, label)| (log_name_of_label(label), (at, at)));
            Ok::<_, Failure>(Named {
                index: index.collect(),
                matrix,
                origin,
            })
        };
        Ok(Self {
            given: file.map(read).transpose()?,
            tasks: Tasks::read(tasks)?,
            mode,
            measured: BTreeMap::new(),
            pictured: BTreeSet::new(),
        })
    }

    /// Pictures of the worlds that a lifetime learned in, or why there are none. Lifetimes of the same scenario share them.
    pub(super) fn worlds_of(&mut self, log: &Log) -> Result<Vec<SheetRow>, String> {
        let scenario = log.scenario_info.extra.get("scenario").map(ToString::to_string);
        let scenario = scenario.ok_or("No pictures of worlds: the log does not say which scenario was run.")?;
        if !self.pictured.insert(scenario.clone()) {
            return Err("This lifetime ran the same scenario as one above: see there for its worlds.".to_owned());
        }
        let made_from = log.scenario_info.extra.get("made_from");
        pictures(&scenario, &self.tasks, made_from).map_err(|why| format!("No pictures of worlds: {why}."))
    }

    /// The distances between neighbouring learning blocks of a lifetime.
    pub(super) fn of(&mut self, log: &Log, lifetime: &Lifetime) -> Distances {
        if self.mode == VariantMode::Agnostic {
            let why = "No distances between blocks: the lifetime was scored by whole tasks (variant mode agnostic), \
                 and distances are between variants.";
            return (None, why.to_owned());
        }
        if let Some(named) = &self.given {
            return named.distances(lifetime);
        }
        let Some(scenario) = log.scenario_info.extra.get("scenario").map(ToString::to_string) else {
            let why =
                "No distances between blocks: the log does not say which scenario was run, and no matrix was given.";
            return (None, why.to_owned());
        };
        let measured = self
            .measured
            .entry(scenario)
            .or_insert_with_key(|scenario| measure(scenario, &self.tasks));
        match measured {
            Ok(named) => named.distances(lifetime),
            Err(why) => match logged(log, lifetime) {
                Some(distances) => {
                    let words = format!(
                        "Stems: how far apart the variants of neighbouring learning blocks are, as the run logged it (column \
                         distance); not measured again: {why}."
                    );
                    (Some(distances), words)
                }
                None => (None, format!("No distances between blocks: {why}.")),
            },
        }
    }
}

/// Pictures of the first worlds of each variant that a scenario learns.
fn pictures(scenario: &str, tasks: &Tasks, made_from: Option<&Value>) -> Result<Vec<SheetRow>, String> {
    let mut shown = Vec::new();
    for (_, regime, variant, _) in learned(scenario, tasks)?.into_iter().take(MAX_PICTURED) {
        let logged_hash = made_from.and_then(|made_from| made_from.get(variant.id())?.get("variant")?.as_str());
        if logged_hash.is_some_and(|hash| hash != variant.hash()) {
            return Err(format!("{} has changed since this run", variant.id()));
        }
        shown.push(Item {
            index: regime.first_index,
            count: u64::from(regime.count),
            worlds: Worlds::OfScenario,
            ..Item::declared(variant, regime.seed)
        });
    }
    let drawn = || {
        tasks::check_variants(shown.iter().map(|shown| &shown.variant), &Catalogue::default())?;
        cells(&shown, LOOK, &|| ())
    };
    let (cells, _) = drawn().map_err(|failure: Failure| failure.to_string())?;
    Ok(cells.into_iter().map(|cell| cell.row).collect())
}

/// The logged distance from each learning block's variant to the one learned before it; `None` if the log has none.
fn logged(log: &Log, lifetime: &Lifetime) -> Option<Vec<Option<f64>>> {
    let column = log.rows.metric("distance")?;
    let numbers: BTreeMap<u64, f64> = log
        .rows
        .exp_nums()
        .iter()
        .copied()
        .zip(column.iter().copied())
        .collect();
    let learned = lifetime.regimes().iter().filter(|regime| regime.is_wake_training());
    let distance = |regime: &driftworld_metrics::Regime| {
        numbers
            .get(regime.exp_nums.first()?)
            .copied()
            .filter(|value| value.is_finite())
    };
    let distances: Vec<Option<f64>> = learned.skip(1).map(distance).collect();
    distances.iter().any(Option::is_some).then_some(distances)
}

impl Named {
    fn distances(&self, lifetime: &Lifetime) -> Distances {
        let distance = |[a, b]: [&str; 2]| {
            let of = |name: &str| self.index.get(name).copied();
            Some(self.matrix.get(of(a)?.1, of(b)?.0))
        };
        let distances: Vec<Option<f64>> = neighbours(lifetime).into_iter().map(distance).collect();
        if distances.is_empty() {
            return (None, "There is one learning block, so no distance.".to_owned());
        }
        if distances.iter().all(Option::is_none) {
            let why = format!(
                "No distances between blocks: {} has none of the log's variants.",
                self.origin_as_subject()
            );
            return (None, why);
        }
        let drifts = when(self.index.values().any(|(first, last)| first != last), || {
            " The beginning of a drifting block is compared with the block before, its end with the block after."
                .to_owned()
        });
        let words = format!(
            "Stems: how far apart the variants of neighbouring learning blocks are, {}.{drifts}",
            self.origin
        );
        (Some(distances), words)
    }

    fn origin_as_subject(&self) -> &str {
        self.origin.strip_prefix("from ").unwrap_or("the scenario")
    }
}

/// The tasks that a log may name: the built-in ones, and those of files that the user named.
struct Tasks {
    named: Vec<(PathBuf, Arc<TaskSpec>)>,
}

impl Tasks {
    fn read(paths: &[PathBuf]) -> Result<Self, Failure> {
        let read = |path: &PathBuf| {
            let name = path.to_str().ok_or_else(|| {
                Failure::usage(format!(
                    "{}: found {}, expected a UTF-8 name",
                    argument("task"),
                    path.shown()
                ))
            })?;
            Ok::<_, Failure>((path.clone(), tasks::task(name)?))
        };
        Ok(Self {
            named: paths.iter().map(read).collect::<Result<_, _>>()?,
        })
    }

    /// The task with a name in a log: a file by its path, or else by its file name, because the log may come from another
    /// folder.
    fn task(&self, name: &str) -> Option<Arc<TaskSpec>> {
        if tasks::text_by_name(name).is_some() {
            return tasks::task(name).ok();
        }
        let name = Path::new(name);
        let alike = |path: &&(PathBuf, _)| path.0.file_name().is_some() && path.0.file_name() == name.file_name();
        let same = self.named.iter().find(|(path, _)| path == name);
        let found = same.or_else(|| self.named.iter().find(alike))?;
        Some(Arc::clone(&found.1))
    }
}

/// The learning blocks of a scenario, each name once, or why they are unknown.
fn learned(scenario: &str, tasks: &Tasks) -> Result<Vec<Learned>, String> {
    let scenario = Scenario::from_json_with("scenario_info.json", scenario, |task| tasks.task(task))
        .map_err(|_| "this version cannot read the scenario in the log".to_owned())?;
    let mut found: Vec<Learned> = Vec::new();
    let blocks = scenario.blocks.iter().filter(|block| block.kind == BlockKind::Learning);
    for regime in blocks
        .flat_map(|block| &block.regimes)
        .filter(|regime| regime.world.is_none())
    {
        let find = |name: &str| {
            tasks.task(name).ok_or_else(|| {
                format!(
                    "the log names the task {name:?}, which is not built in; files that a log names are not opened, so \
                     give it with --task FILE"
                )
            })
        };
        let (task, end_task) = (find(&regime.task)?, find(regime.end_task())?);
        let missing = |task: &str, name: &str| format!("the task {task} no longer has the variant {name} that was run");
        let start = regime
            .resolve(&task)
            .map_err(|_| missing(&regime.task, regime.variant_name()))?;
        let end = regime.resolve_end(&end_task);
        let end = end.map_err(|_| missing(regime.end_task(), "at the end of the drift"))?;
        // The block's name in logs of `driftworld run`.
        let name = match &end {
            None => log_name(task.name(), start.name()),
            Some(end) if end.task().name() != task.name() => {
                log_name(task.name(), &format!("{}to{}", start.name(), end.id()))
            }
            Some(end) => log_name(task.name(), &format!("{}to{}", start.name(), end.name())),
        };
        if found.iter().all(|(known, ..)| *known != name) {
            found.push((name, regime.clone(), start, end));
        }
    }
    if found.is_empty() {
        return Err("no variant of a task was learned in the scenario".to_owned());
    }
    Ok(found)
}

/// Measures distances between the variants that a scenario learns, or returns why that is impossible.
fn measure(scenario: &str, tasks: &Tasks) -> Result<Named, String> {
    let mut variants: Vec<(String, Variant)> = Vec::new();
    let mut index_of = |variant: Variant| {
        let name = log_name(variant.task().name(), variant.name());
        let known = variants.iter().position(|(known, _)| *known == name);
        known.unwrap_or_else(|| {
            variants.push((name, variant));
            variants.len() - 1
        })
    };
    let mut index = BTreeMap::new();
    for (name, _, start, end) in learned(scenario, tasks)? {
        let first = index_of(start);
        let last = end.map_or(first, &mut index_of);
        index.insert(name, (first, last));
        if first.max(last) >= MAX_MEASURED {
            return Err(format!(
                "more than {MAX_MEASURED} variants were learned; measure them with driftworld order --matrix FILE and \
                 give --distances FILE"
            ));
        }
    }
    let by = fitting(variants.iter().map(|(_, variant)| variant));
    let matrix = variant_matrix(&variants, &Sample::by(by), Ok).map_err(|error| error.to_string())?;
    Ok(Named {
        matrix,
        index,
        origin: format!("as measured by {} from the scenario in the log", by.name()),
    })
}
