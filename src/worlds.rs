//! Resolves names of worlds: files in our format or L2Explorer's, or variants with a seed and an index.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::contents::{Contents, OtherContents};
use crate::documents;
use crate::numbers::seed;
use crate::tasks;
use crate::top_level::TopLevel;
use clap::Args;
use driftworld_env::EpisodeOrigin;
use driftworld_generator::Sampler;
use driftworld_spec::maps::MapLibrary;
use driftworld_spec::{DEFAULT_VARIANT, Warning, World};
use driftworld_text::ShownPath;

use crate::{Failure, Warn, argument};

/// A world file in our format or L2Explorer's, with its maps resolved to layouts.
fn world_file(path: &Path, l2explorer: bool, maps: &MapLibrary) -> Result<(World, Vec<Warning>), Failure> {
    let name = documents::name_of(path);
    let text = documents::text_of(path, &[Contents::World])?;
    if l2explorer {
        return Ok(World::from_l2explorer_with(&name, &text, maps)?);
    }
    match World::from_json(&name, &text) {
        Ok(world) => Ok((world.with_maps(maps), Vec::new())),
        Err(error) => Err(match World::from_l2explorer(&name, &text) {
            Ok(_) => Failure::input(format!(
                "{error}\nhint: this looks like an L2Explorer map; add {}",
                argument("l2explorer")
            )),
            Err(_) => error.into(),
        }),
    }
}

/// Whether an argument names a world file, not a task: a JSON object without `name`, `parameters` and `groups`.
pub(crate) fn is_world_file(name: &str) -> bool {
    let path = Path::new(name);
    let Ok(text) = documents::text(path) else {
        return false;
    };
    // The reader of tasks reports text that is not a JSON object.
    TopLevel::of(&text).is_some_and(|keys| !keys.has_any(&["name", "parameters", "groups"]))
}

/// Refuses a folder, and a file recognised as a document other than a world or a task spec.
pub(crate) fn expect_world_or_task(name: &str) -> Result<(), Failure> {
    let path = Path::new(tasks::split(name).0);
    let shown = || Contents::of_text(&documents::text(path).ok()?);
    let found = Contents::of_folder(path).or_else(shown);
    match OtherContents::check(path, found, &[Contents::World, Contents::Task]) {
        Some(other) => Err(other.into()),
        None => Ok(()),
    }
}

/// The layouts of a maps file, or of all `.json` files in a folder.
pub(crate) fn maps(path: &Path) -> Result<MapLibrary, Failure> {
    let mut library = MapLibrary::default();
    for file in json_files(path)? {
        let text = documents::text_of(&file, &[Contents::Maps])?;
        let read = MapLibrary::from_json(&file.display().to_string(), &text)?;
        for layout in read.layouts() {
            if library.layouts().any(|known| known.id == layout.id) {
                let id = layout.id;
                return Err(Failure::input(format!(
                    "{}: found map {id}, which another file in the folder also has, expected each number once",
                    file.shown()
                )));
            }
        }
        library.extend(read);
    }
    Ok(library)
}

/// The given file, or the `.json` files in the given folder, sorted.
pub(crate) fn json_files(path: &Path) -> Result<Vec<PathBuf>, Failure> {
    if !path.is_dir() {
        return Ok(vec![path.to_owned()]);
    }
    let failed = |error| Failure::in_file(path, format!("cannot be read: {error}"));
    let mut files = Vec::new();
    for entry in fs::read_dir(path).map_err(failed)? {
        let file = entry.map_err(failed)?.path();
        if file.extension().is_some_and(|extension| extension == "json") {
            files.push(file);
        }
    }
    if files.is_empty() {
        return Err(Failure::in_file(path, "holds no .json file"));
    }
    files.sort();
    Ok(files)
}

/// Which world is meant: one of a file, or one drawn from a variant.
#[derive(Args, Clone, Debug)]
pub(crate) struct WorldRequest {
    /// A world file, or a variant: PATH, PATH#variant, or a built-in such as `find_objects#red`.
    pub(crate) world: String,
    /// Seed for drawing the world from a variant.
    #[arg(long, default_value_t = 0, allow_negative_numbers = true, value_parser = seed)]
    pub(crate) seed: u64,
    /// Index of the world under the seed.
    #[arg(long, default_value_t = 0)]
    pub(crate) index: u64,
    /// Read the world in L2Explorer's format, with warnings.
    #[arg(long)]
    pub(crate) l2explorer: bool,
    /// Use the layouts in this maps file, or folder of them, instead of the built-in maps.
    #[arg(long, value_name = "PATH")]
    pub(crate) maps: Option<PathBuf>,
}

impl WorldRequest {
    /// The origin of an episode in this world.
    pub(crate) fn origin(&self) -> EpisodeOrigin {
        let (task, variant) = tasks::split(&self.world);
        let is_drawn = !self.is_file();
        // A task without a variant's name stands for the variant with all defaults.
        let variant = variant.or(is_drawn.then_some(DEFAULT_VARIANT));
        EpisodeOrigin {
            task: Some(task.to_owned()),
            variant: variant.map(str::to_owned),
            seed: is_drawn.then_some(self.seed),
            index: is_drawn.then_some(self.index),
            ..EpisodeOrigin::default()
        }
    }

    /// Reads or draws the world.
    pub(crate) fn world(&self, warn: Warn<'_>) -> Result<World, Failure> {
        expect_world_or_task(&self.world)?;
        if self.is_file() {
            return self.named(&self.world, warn);
        }
        self.numbered(self.index)
    }

    /// The world of the variant with this index, under the same seed.
    pub(crate) fn numbered(&self, index: u64) -> Result<World, Failure> {
        expect_world_or_task(&self.world)?;
        if self.is_file() {
            return Err(Failure::input(format!(
                "{}: found a single world, expected a variant to draw worlds from, or a world file",
                self.world
            )));
        }
        let mut sampler = Sampler::new(&tasks::variant(&self.world)?, self.seed);
        if let Some(maps) = self.maps.as_deref().map(maps).transpose()? {
            sampler = sampler.with_maps(Arc::new(maps));
        }
        Ok(sampler.world(index)?)
    }

    /// A different world, with the same options: a file, or the first world of a variant.
    pub(crate) fn named(&self, name: &str, warn: Warn<'_>) -> Result<World, Failure> {
        let maps = self.maps.as_deref().map(maps).transpose()?.unwrap_or_default();
        if !self.l2explorer && !is_world_file(name) {
            expect_world_or_task(name)?;
            return Ok(Sampler::new(&tasks::variant(name)?, self.seed)
                .world(0)?
                .with_maps(&maps));
        }
        file(name, self.l2explorer, &maps, warn)
    }

    fn is_file(&self) -> bool {
        self.l2explorer || is_world_file(&self.world)
    }
}

/// The world in a file, with its maps resolved to layouts.
pub(crate) fn file(name: &str, l2explorer: bool, maps: &MapLibrary, warn: Warn<'_>) -> Result<World, Failure> {
    expect_world_or_task(name)?;
    let (world, warnings) = world_file(Path::new(name), l2explorer, maps)?;
    for warning in warnings {
        warn(warning.to_string());
    }
    Ok(world)
}
