//! `driftworld schema`: prints the JSON Schemas of the documents and the reference of a world's keys, generated from the code.

use std::path::PathBuf;

use crate::spec::{reference, schema};
use clap::Args;
use driftworld_text::ShownPath;

use crate::{Failure, documents};

use super::output;

/// Print, write or check the JSON Schemas of all documents.
#[derive(Args)]
#[command(after_help = "Example:\n  driftworld schema task > task.schema.json\n  driftworld schema -o schemas")]
pub(crate) struct Schema {
    /// The schema to print.
    #[arg(value_parser = ["world", "task", "scenario", "maps"], conflicts_with_all = ["output", "check", "reference"])]
    document: Option<String>,
    /// Use the Markdown reference of a world's keys instead of the schemas.
    #[arg(long)]
    reference: bool,
    /// Write all schemas into this folder.
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Compare the schemas in this folder with the code. Exit code 1 if one is stale.
    #[arg(long, value_name = "DIR", conflicts_with = "output")]
    check: Option<PathBuf>,
    /// Print what was written as JSON.
    #[arg(long, requires = "output")]
    json: bool,
}

impl Schema {
    pub(crate) fn run(self) -> Result<(), Failure> {
        if let Some(document) = &self.document {
            let file = format!("{document}.schema.json");
            return schemas()
                .into_iter()
                .filter(|(name, _)| *name == file)
                .try_for_each(|(_, text)| output::print(&text));
        }
        if let Some(folder) = &self.check {
            for (name, expected) in self.texts() {
                let path = folder.join(name);
                if documents::text(&path)? != expected {
                    let text = format!("{}: is stale; run: cargo xtask schemas", path.shown());
                    return Err(Failure::input(text));
                }
            }
            return output::line(format!("{}: up to date", folder.shown()));
        }
        let Some(folder) = &self.output else {
            return Err(Failure::usage(
                "name a document (world, task, scenario, maps), a folder with -o, or one with --check",
            ));
        };
        for (name, text) in self.texts() {
            let path = folder.join(name);
            output::write(&path, text.as_bytes())?;
            output::wrote(&path, "");
        }
        output::json_of_what_was_written(self.json)
    }

    fn texts(&self) -> Vec<(&'static str, String)> {
        if self.reference { reference::pages() } else { schemas() }
    }
}

fn schemas() -> Vec<(&'static str, String)> {
    let all = schema::all().into_iter();
    all.map(|(name, schema)| (name, schema.text())).collect()
}
