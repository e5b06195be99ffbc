//! `driftworld assets pack`: packs glTF files into a library.

#[cfg(feature = "gltf")]
use std::path::Path;
use std::path::PathBuf;

use crate::env::ColliderKind;
#[cfg(feature = "gltf")]
use crate::env::{ImportOptions, ImportSize, Library, LibraryModel};
use crate::numbers::documented;
use clap::Args;
#[cfg(feature = "gltf")]
use driftworld_text::ShownPath;

#[cfg(feature = "gltf")]
use super::super::output;
#[cfg(feature = "gltf")]
use super::{gltf, list};
use crate::Failure;

/// Pack glTF files into a library, with levels of detail and colliders.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld assets pack lamp.glb -o town.assets --height 4 --collider cylinder
  driftworld assets pack oak.glb beech.glb -o trees.assets --class tree
  driftworld assets pack bin.gltf -o town.assets --add --main paint")]
pub(crate) struct Pack {
    /// The glTF files: .glb, or .gltf with the files it refers to.
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Library to write.
    #[arg(short, long, value_name = "LIBRARY")]
    output: PathBuf,
    /// Add to an existing library instead of replacing it.
    #[arg(long)]
    add: bool,
    /// Class of all models [default: each file's name].
    #[arg(long, value_name = "NAME")]
    class: Option<String>,
    /// Scale each model to this height, in metres.
    #[arg(long, value_name = "METRES", conflicts_with = "scale", allow_negative_numbers = true)]
    height: Option<f32>,
    /// Metres per unit of the files.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, allow_negative_numbers = true)]
    scale: f32,
    /// Shape of the collider.
    #[arg(long, value_parser = documented::<ColliderKind>(&COLLIDERS), default_value = "auto")]
    collider: ColliderKind,
    /// Material that takes an object's colour [default: the one named main, if any].
    #[arg(long, value_name = "MATERIAL")]
    main: Option<String>,
    /// Print what was written as JSON.
    #[arg(long)]
    json: bool,
}

/// The kinds of colliders, with help texts.
const COLLIDERS: [&str; 6] = [
    "auto: A ball if the model is round, else the smaller of box and cylinder",
    "box: A box around the part below 2 m",
    "ball: A ball as high as the model",
    "cylinder: A cylinder around the part below 2 m",
    "capsule: A capsule: a cylinder with round ends",
    "hull: Approximately the convex hull of the model",
];

#[cfg(not(feature = "gltf"))]
impl Pack {
    #[expect(clippy::unused_self, reason = "same signature as with the feature")]
    pub(crate) fn run(self) -> Result<(), Failure> {
        Err(Failure::input(
            "reading glTF is not in this build: it lacks the feature `gltf`; build with `--features gltf` (or `full`), or use a \
             library that was packed elsewhere",
        ))
    }
}

#[cfg(feature = "gltf")]
impl Pack {
    pub(crate) fn run(self) -> Result<(), Failure> {
        gltf::check_output(&self.output)?;
        let mut library = if self.add && self.output.exists() {
            crate::libraries::library(&self.output)?
        } else {
            Library::default()
        };
        let first = library.models().len();
        for path in &self.files {
            self.pack(path, &mut library)?;
        }
        let bytes = library.to_bytes();
        output::write(&self.output, &bytes)?;
        output::wrote(
            &self.output,
            format!("{} models, {} bytes", library.models().len(), bytes.len()),
        );
        if self.json {
            return output::json_of_what_was_written(true);
        }
        output::line(list::models(&library.models()[first..]))
    }

    fn pack(&self, path: &Path, library: &mut Library) -> Result<(), Failure> {
        let in_file = |error: crate::env::EnvError| Failure::in_file(path, error);
        let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        let class = self.class.clone().or(stem).unwrap_or_default().trim().to_lowercase();
        let options = ImportOptions {
            name: free_name(library, &class),
            class,
            size: self.height.map_or(ImportSize::Scale(self.scale), ImportSize::Height),
            collider: self.collider,
            main: self.main.clone(),
        };
        let bytes = gltf::model(path)?;
        let imported = LibraryModel::from_gltf(&bytes, &options, &mut gltf::read_beside(path)).map_err(in_file)?;
        for warning in &imported.warnings {
            output::note(format!("warning: {}: {warning}", path.shown()));
        }
        library.insert(imported.model).map_err(in_file)
    }
}

/// The smallest number, from 1, that no model of the class has as its name.
#[cfg(feature = "gltf")]
fn free_name(library: &Library, class: &str) -> String {
    let is_taken = |name: &String| {
        let has_name = |model: &LibraryModel| model.class() == class && model.name() == name;
        library.models().iter().any(has_name)
    };
    let mut names = (1_u32..).map(|number| number.to_string());
    names.find(|name| !is_taken(name)).unwrap_or_default()
}
