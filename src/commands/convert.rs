//! `driftworld convert`: a world from one dialect to the other. Both are read and written by the spec.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::{Failure, input, output};

/// Write a world in L2Explorer's form, or one of L2Explorer's in ours.
///
/// What the other form cannot say is named in warnings on standard error.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld convert map.json --l2explorer -o world.json
  driftworld convert find_objects#red --seed 7 --to l2explorer -o reset.json")]
pub(crate) struct Convert {
    /// A world file, or a task's variant: PATH, PATH#variant, or a built-in such as `find_objects#red`.
    world: String,
    /// Read the world as L2Explorer wrote it, with warnings.
    #[arg(long)]
    l2explorer: bool,
    /// The form to write.
    #[arg(long, value_enum, default_value_t = Form::World)]
    to: Form,
    /// The seed, where the world is drawn from a variant.
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// The number of the world, where it is drawn from a variant.
    #[arg(long, default_value_t = 0)]
    index: u64,
    /// Layouts in place of the built-in maps: a maps file, or a folder of them.
    #[arg(long, value_name = "PATH")]
    maps: Option<PathBuf>,
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
        let world = input::world(
            &self.world,
            self.seed,
            self.index,
            self.l2explorer,
            self.maps.as_deref(),
        )?;
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
