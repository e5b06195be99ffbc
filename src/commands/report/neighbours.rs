//! How far apart neighbouring learning blocks are: by a matrix that was handed in, or as measured from the scenario in the log.

use std::collections::BTreeMap;
use std::path::Path;

use driftworld::curriculum::{log_name, log_name_of_label};
use driftworld::distances::variant_matrix;
use driftworld::metrics::{Lifetime, Log};
use driftworld::report::neighbours;
use driftworld::similarity::DistanceMatrix;
use driftworld::spec::{BlockKind, Scenario, Variant};
use driftworld::tasks;

use crate::commands::{Failure, matrix_file};

/// Variants beyond these are not measured in passing.
const MOST_MEASURED: usize = 32;

/// Where distances come from.
pub(super) struct Neighbours {
    given: Option<Named>,
    /// By the scenario's text: repeats live the same one.
    measured: BTreeMap<String, Result<Named, String>>,
}

/// A matrix, and its variants by the names that logs give them.
struct Named {
    matrix: DistanceMatrix,
    index: BTreeMap<String, usize>,
    /// Where it comes from, as the end of a sentence.
    origin: String,
}

/// Distances of neighbours, and a sentence about them.
type Told = (Option<Vec<Option<f64>>>, String);

impl Neighbours {
    /// Of the matrix in a file, or else to be measured.
    pub(super) fn new(file: Option<&Path>) -> Result<Self, Failure> {
        let read = |path: &Path| {
            let matrix = matrix_file::read("--distances", path)?;
            let origin = format!("from {}", path.file_name().unwrap_or_default().to_string_lossy());
            Ok::<_, Failure>(Named::new(matrix, origin))
        };
        Ok(Self {
            given: file.map(read).transpose()?,
            measured: BTreeMap::new(),
        })
    }

    /// The distances between neighbouring learning blocks of a lifetime.
    pub(super) fn of(&mut self, log: &Log, lifetime: &Lifetime) -> Told {
        if let Some(named) = &self.given {
            return named.told(lifetime);
        }
        let Some(scenario) = log.scenario_info.extra.get("scenario").map(ToString::to_string) else {
            let why =
                "No distances between blocks: the log does not say which scenario was lived, and no matrix was given.";
            return (None, why.to_owned());
        };
        let measured = self
            .measured
            .entry(scenario)
            .or_insert_with_key(|scenario| measure(scenario));
        match measured {
            Ok(named) => named.told(lifetime),
            Err(why) => (None, format!("No distances between blocks: {why}.")),
        }
    }
}

impl Named {
    fn new(matrix: DistanceMatrix, origin: String) -> Self {
        let labels = matrix.labels().iter().enumerate();
        Self {
            index: labels.map(|(index, label)| (log_name_of_label(label), index)).collect(),
            matrix,
            origin,
        }
    }

    fn told(&self, lifetime: &Lifetime) -> Told {
        let apart = |[a, b]: [&str; 2]| {
            let of = |name: &str| self.index.get(name).copied();
            if a == b {
                Some(0.0)
            } else {
                Some(self.matrix.get(of(a)?, of(b)?))
            }
        };
        let distances: Vec<Option<f64>> = neighbours(lifetime).into_iter().map(apart).collect();
        if distances.is_empty() {
            return (None, "There is one learning block, and so no distance.".to_owned());
        }
        if distances.iter().all(Option::is_none) {
            let why = format!(
                "No distances between blocks: {} has none of the log's variants.",
                self.origin_as_subject()
            );
            return (None, why);
        }
        let words = format!(
            "Stems: how far apart the variants of neighbouring learning blocks are, {}.",
            self.origin
        );
        (Some(distances), words)
    }

    fn origin_as_subject(&self) -> &str {
        self.origin.strip_prefix("from ").unwrap_or("the scenario")
    }
}

/// Measures the variants that a scenario learns, or says why that cannot be done.
fn measure(scenario: &str) -> Result<Named, String> {
    let scenario = Scenario::from_json_with("scenario_info.json", scenario, |task| tasks::task(task).ok())
        .map_err(|_| "the scenario in the log is not one of this version's".to_owned())?;
    let mut variants: Vec<(String, Variant)> = Vec::new();
    let learnt = scenario.blocks.iter().filter(|block| block.kind == BlockKind::Learning);
    for regime in learnt
        .flat_map(|block| &block.regimes)
        .filter(|regime| regime.world.is_none())
    {
        let task = tasks::task(&regime.task).map_err(|_| format!("the task {} is not found from here", regime.task))?;
        let variant = regime.resolve(&task).map_err(|_| {
            format!(
                "the task {} has no variant {} as it was lived",
                regime.task,
                regime.variant_name()
            )
        })?;
        let name = log_name(variant.task().name(), variant.name());
        if variants.iter().all(|(known, _)| *known != name) {
            variants.push((name, variant));
        }
        if variants.len() > MOST_MEASURED {
            return Err(format!(
                "more than {MOST_MEASURED} variants were learnt; measure them with driftworld order --matrix FILE and give --distances FILE"
            ));
        }
    }
    if variants.is_empty() {
        return Err("the scenario was lived in world files, not in variants of tasks".to_owned());
    }
    let matrix = variant_matrix(&variants, Ok).map_err(|error| error.to_string())?;
    Ok(Named::new(
        matrix,
        "as measured from the scenario in the log".to_owned(),
    ))
}
