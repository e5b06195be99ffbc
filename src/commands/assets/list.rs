//! `driftworld assets list`: tables of models.

use std::collections::BTreeSet;
use std::path::PathBuf;

use crate::env::{Asset, Catalogue, ColliderShape, LibraryModel, classes};
use crate::spec::Model;
use clap::Args;
use serde_json::{Value, json};

use super::super::output;
use crate::Failure;
use crate::table::table;

/// List the built-in classes, or the models in libraries.
#[derive(Args)]
#[command(after_help = "Examples:\n  driftworld assets list\n  driftworld assets list town.assets")]
pub(crate) struct List {
    /// Libraries to list [default: the built-in classes].
    #[arg(value_name = "LIBRARY")]
    libraries: Vec<PathBuf>,
    /// Print the list as JSON.
    #[arg(long)]
    json: bool,
}

impl List {
    pub(crate) fn run(self) -> Result<(), Failure> {
        if self.json {
            return output::json(&self.to_json()?);
        }
        if self.libraries.is_empty() {
            return output::line(built_in());
        }
        for path in &self.libraries {
            let library = crate::libraries::library(path)?;
            output::line(models(library.models()))?;
        }
        Ok(())
    }
}

impl List {
    /// The contents of the tables as JSON.
    fn to_json(&self) -> Result<Vec<Value>, Failure> {
        if self.libraries.is_empty() {
            let catalogue = Catalogue::default();
            let class =
                |(class, models)| json!({ "class": class, "number": catalogue.class_number(class), "models": models });
            return Ok(classes().map(class).collect());
        }
        let mut found = Vec::new();
        for path in &self.libraries {
            for model in crate::libraries::library(path)?.models() {
                let asset = model.asset();
                let triangles: Vec<usize> = asset.levels().map(|(triangles, _)| triangles).collect();
                found.push(json!({
                    "library": path, "class": model.class(), "model": model.name(), "triangles": triangles,
                    "height": asset.height, "width": 2.0 * asset.radius, "body": <&str>::from(&asset.collider),
                }));
            }
        }
        Ok(found)
    }
}

/// One row for each model.
pub(super) fn models(models: &[LibraryModel]) -> String {
    let rows = models.iter().map(|model| {
        let asset = model.asset();
        let levels: Vec<String> = asset.levels().map(|(triangles, _)| triangles.to_string()).collect();
        [
            model.class().to_owned(),
            model.name().to_owned(),
            levels.join(" → "),
            format!("{:.2} m", asset.height),
            format!("{:.2} m", 2.0 * asset.radius),
            body(&asset.collider),
        ]
    });
    table(
        ["class", "model", "triangles", "height", "width", "body"],
        rows,
        &[3, 4],
    )
}

/// One row for each built-in class.
fn built_in() -> String {
    let rows = classes().map(|(class, models)| {
        let catalogue = Catalogue::default();
        let assets = || (1..=models).map(|number| catalogue.asset(class, &Model(number.to_string())));
        let triangles = |asset: &Asset| asset.levels().next().map_or(0, |(triangles, _)| triangles);
        let counts: BTreeSet<usize> = assets().map(|asset| triangles(&asset)).collect();
        let heights = || assets().map(|asset| asset.height);
        let (low, high) = (heights().fold(f32::INFINITY, f32::min), heights().fold(0.0, f32::max));
        let bodies: BTreeSet<&str> = assets().map(|asset| (&asset.collider).into()).collect();
        [
            class.to_owned(),
            catalogue.class_number(class).to_string(),
            if models == 1 {
                "1".into()
            } else {
                format!("1–{models}")
            },
            match (counts.first(), counts.last()) {
                (Some(least), Some(most)) if least < most => format!("{least}–{most}"),
                (least, _) => least.map_or_else(String::new, usize::to_string),
            },
            if high - low < 0.01 {
                format!("{high:.2} m")
            } else {
                format!("{low:.2}–{high:.2} m")
            },
            bodies.into_iter().collect::<Vec<_>>().join(", "),
        ]
    });
    table(
        ["class", "number", "models", "triangles", "height", "body"],
        rows,
        &[1, 2, 3, 4],
    )
}

fn body(collider: &ColliderShape) -> String {
    let size = match collider {
        ColliderShape::Box { half: [x, y, z] } => format!("{:.2} × {:.2} × {:.2} m", 2.0 * x, 2.0 * y, 2.0 * z),
        ColliderShape::Ball { radius } => format!("{:.2} m wide", 2.0 * radius),
        ColliderShape::Cylinder { radius, .. } | ColliderShape::Capsule { radius, .. } => {
            format!("{:.2} m wide", 2.0 * radius)
        }
        ColliderShape::Hull { points } => format!("of {} points", points.len()),
    };
    format!("{} {size}", <&str>::from(collider))
}
