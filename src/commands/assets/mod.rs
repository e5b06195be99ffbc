//! `driftworld assets`: packs, lists and draws libraries of models.

#[cfg(feature = "gltf")]
mod gltf;
mod list;
mod pack;
mod show;
mod source;

pub(crate) use source::LibraryChoice;

use clap::{Args, Subcommand};

use crate::Failure;

/// Pack glTF models into asset libraries, and inspect them.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld assets pack lamp.glb kiosk.glb -o town.assets
  driftworld assets list town.assets
  driftworld assets show lamp --assets town.assets -o lamp.png
  driftworld render world.json --assets town.assets -o world.png")]
pub(crate) struct Assets {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand)]
enum What {
    /// Pack glTF files into a library, with levels of detail and colliders.
    Pack(pack::Pack),
    /// List the built-in classes, or the models in libraries.
    List(list::List),
    /// Draw the models of a class, or one model from four sides at each level of detail.
    Show(show::Show),
}

impl Assets {
    pub(crate) fn run(self) -> Result<(), Failure> {
        match self.what {
            What::Pack(command) => command.run(),
            What::List(command) => command.run(),
            What::Show(command) => command.run(),
        }
    }
}
