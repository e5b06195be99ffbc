//! `driftworld convert`: a world from one dialect to the other. Both are read and written by the spec.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::input::WorldChoice;
use super::{Failure, output};

/// Write a world in L2Explorer's form, or one of L2Explorer's in ours.
///
/// What the other form cannot say is named in warnings on standard error.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld convert map.json --l2explorer -o world.json
  driftworld convert find_objects#red --seed 7 --to l2explorer -o reset.json")]
pub(crate) struct Convert {
    #[command(flatten)]
    choice: WorldChoice,
    /// The form to write.
    #[arg(long, value_enum, default_value_t = Form::World)]
    to: Form,
    /// A file, or - for standard output.
    #[arg(short, long, default_value = "-", value_name = "FILE")]
    output: PathBuf,
}

/// A form of world documents.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Form {
    /// Ours, in its current version.
    World,
    /// L2Explorer's reset payload.
    L2explorer,
}

impl Convert {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let world = self.choice.world()?;
        if self.to == Form::World {
            return output::write_or_print(&self.output, &world.to_json_pretty());
        }
        let (text, warnings) = world.to_l2explorer();
        for warning in warnings {
            output::note(format!("warning: {warning}"));
        }
        output::write_or_print(&self.output, &text)
    }
}
