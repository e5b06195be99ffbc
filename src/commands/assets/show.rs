//! `driftworld assets show`: pictures of a class's models, or of one model from all sides, level by level.

#![expect(clippy::disallowed_methods, reason = "where a camera stands for a picture")]

use std::path::PathBuf;
use std::sync::Arc;

use crate::env::{Asset, Camera, CpuRenderer, Frame, Library, LibraryModel, Scene, model_names as built_in};
use crate::spec::{Model, Object, WorldDraft};
use clap::Args;

use super::super::{Failure, output};
use super::LibraryChoice;
use crate::report::picture::{Picture, SheetRow, sheet};

/// Draw the models of a class, or one model from four sides at each level of detail.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld assets show tree -o trees.png
  driftworld assets show lamp 1 --assets town.assets -o lamp.png")]
pub(crate) struct Show {
    /// The class to draw.
    class: String,
    /// A single model of the class.
    model: Option<String>,
    #[command(flatten)]
    libraries: LibraryChoice,
    /// Width and height of each picture in pixels.
    #[arg(long, default_value_t = 220, value_parser = clap::value_parser!(u32).range(16..=2048))]
    size: u32,
    /// PNG file to write.
    #[arg(short, long, default_value = "assets.png", value_name = "FILE")]
    output: PathBuf,
    /// Print what was written as JSON.
    #[arg(long)]
    json: bool,
}

/// Height and width in metres that a model is drawn at, whatever its own size is.
const SHOWN_SIZE: f32 = 4.0;

/// Pictures beside each other.
const COLUMNS: usize = 7;

/// The most models of one sheet.
const MOST_MODELS: usize = 210;

impl Show {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let class = self.class.to_lowercase();
        let libraries = self.libraries.read()?;
        let names = model_names(&class, &libraries);
        let rows = match &self.model {
            Some(model) => self.levels(&class, model, &libraries)?,
            None if names.is_empty() => {
                return Err(Failure::input(format!(
                    "class {class:?} is not known; driftworld assets list shows those that are built in"
                )));
            }
            None => self.models(&class, &names)?,
        };
        output::write_picture_and_tell(&self.output, &sheet(&rows, 1)?)?;
        if self.json {
            output::json_of_what_was_written()
        } else {
            Ok(())
        }
    }

    /// All models of a class, some in each row.
    fn models(&self, class: &str, names: &[String]) -> Result<Vec<SheetRow>, Failure> {
        let catalogue = self.libraries.catalogue()?;
        if names.len() > MOST_MODELS {
            output::note(format!(
                "note: the first {MOST_MODELS} of {} models are drawn",
                names.len()
            ));
        }
        let shown = &names[..names.len().min(MOST_MODELS)];
        let rows = shown.chunks(COLUMNS).map(|names| {
            let assets: Vec<Arc<Asset>> = names
                .iter()
                .map(|name| catalogue.asset(class, &Model(name.clone())))
                .collect();
            let counts: Vec<String> = assets.iter().map(|asset| triangles(asset).to_string()).collect();
            let heights: Vec<String> = assets.iter().map(|asset| format!("{:.1}", asset.height)).collect();
            SheetRow {
                title: format!("{class} {}", names.join(", ")),
                words: format!("{} triangles; {} m high", counts.join(", "), heights.join(", ")),
                pictures: assets.iter().map(|asset| self.picture(asset, 210.0).into()).collect(),
            }
        });
        Ok(rows.collect())
    }

    /// One model from four sides, in each of its levels.
    fn levels(&self, class: &str, name: &str, libraries: &[Library]) -> Result<Vec<SheetRow>, Failure> {
        let is_it = |model: &&LibraryModel| model.class().to_lowercase() == class && model.name() == name;
        // As in a catalogue, the last library comes first.
        let own = libraries
            .iter()
            .rev()
            .find_map(|library| library.models().iter().find(is_it));
        let forms: Vec<(Arc<Asset>, f32)> = match own {
            Some(model) => (0..model.num_levels())
                .filter_map(|level| Some((Arc::new(model.asset_at(level)?), model.level(level)?.1)))
                .collect(),
            None => vec![(self.libraries.catalogue()?.asset(class, &Model(name.to_owned())), 0.0)],
        };
        if let Some((asset, _)) = forms.first()
            && !asset.known
        {
            return Err(Failure::input(format!(
                "class {class:?}, model {name:?} is not known; driftworld assets show {class} draws all models of a class"
            )));
        }
        let row = |(level, (asset, error)): (usize, &(Arc<Asset>, f32))| SheetRow {
            title: format!("{class} {name}, level {level}: {} triangles", triangles(asset)),
            words: if level == 0 {
                format!(
                    "{:.2} m high; from the front, its left, the back, its right",
                    asset.height
                )
            } else {
                let near = error / asset.height.max(asset.radius);
                format!(
                    "off by up to {:.1} mm, {:.1} % of its size",
                    1000.0 * error,
                    100.0 * near
                )
            },
            pictures: [180.0, 270.0, 0.0, 90.0]
                .map(|heading| self.picture(asset, heading).into())
                .to_vec(),
        };
        Ok(forms.iter().enumerate().map(row).collect())
    }

    /// A model that fills a picture, turned to a heading in degrees; it is seen from the south.
    fn picture(&self, asset: &Arc<Asset>, heading_deg: f32) -> Picture {
        let mut world = WorldDraft {
            objects: vec![Object::new("cube", [0.0, 0.0])],
            ..WorldDraft::default()
        };
        world.environment_params.wall_height = 0.0;
        let mut scene = Scene::from_world(&world.check().expect("a cube on open ground is sound"));
        let item = &mut scene.items[0];
        item.scale = SHOWN_SIZE / asset.height.max(2.0 * asset.radius);
        item.asset = Arc::clone(asset);
        item.heading_deg = heading_deg;
        let back = 1.65 * SHOWN_SIZE;
        let height = 0.62 * SHOWN_SIZE;
        let middle = asset.height * item.scale / 2.0;
        let camera = Camera {
            position: [0.0, -back, height],
            heading_deg: 0.0,
            pitch_deg: -((height - middle) / back).atan().to_degrees(),
            field_of_view_deg: 44.0,
        };
        let mut frame = Frame::new(2 * self.size, 2 * self.size);
        CpuRenderer::new().render(&scene, &camera, &mut frame);
        let drawn = Picture {
            width: frame.width,
            height: frame.height,
            rgb: frame.rgb,
        };
        drawn.halved()
    }
}

fn triangles(asset: &Asset) -> usize {
    asset.parts.iter().map(|part| part.mesh.triangles.len()).sum()
}

/// The models of a class: those built in, then those of libraries, each once.
fn model_names(class: &str, libraries: &[Library]) -> Vec<String> {
    let mut names: Vec<String> = built_in(class).collect();
    for model in libraries.iter().flat_map(Library::models) {
        if model.class().to_lowercase() == class && !names.iter().any(|name| name == model.name()) {
            names.push(model.name().to_owned());
        }
    }
    names
}
