//! `driftworld assets show`: pictures of a class's models, of one model from four sides at each level of detail, or of
//! every class.

#![expect(clippy::disallowed_methods, reason = "only camera positions for pictures")]

use std::path::PathBuf;
use std::sync::Arc;

use crate::env::{
    Asset, Camera, CpuRenderer, Frame, Item, Library, LibraryModel, Scene, Target, classes, model_names as built_in,
};
use crate::spec::{Model, Object, Style, WorldDraft};
use clap::Args;
use driftworld_text::counted;

use super::super::output;
use super::LibraryChoice;
use crate::Failure;
use crate::report::picture::{Picture, SheetRow, sheet};

/// Draw the models of a class, one model from four sides at each level of detail, or some models of each built-in class.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld assets show -o all.png
  driftworld assets show tree -o trees.png
  driftworld assets show lamp 1 --assets town.assets -o lamp.png")]
pub(crate) struct Show {
    /// The class to draw [default: some models of every built-in class, in natural looks].
    class: Option<String>,
    /// A single model of the class.
    model: Option<String>,
    #[command(flatten)]
    libraries: LibraryChoice,
    /// Width and height of each picture in pixels [default: 220, or 44 for all classes].
    #[arg(long, value_parser = clap::value_parser!(u32).range(16..=2048))]
    size: Option<u32>,
    /// PNG file to write.
    #[arg(short, long, default_value = "assets.png", value_name = "FILE")]
    output: PathBuf,
    /// Print what was written as JSON.
    #[arg(long)]
    json: bool,
}

/// Larger of height and width, in metres, to which every model is scaled in its picture.
const SHOWN_SIZE: f32 = 4.0;

/// Pixels along each side of a picture: for the models of one class, and in the overview of all classes.
const SIZE: u32 = 220;
const ALBUM_SIZE: u32 = 44;

/// In the overview of all classes: the number of unnamed models per class, and the number of classes side by side.
const ALBUM_MODELS: usize = 7;
const ALBUM_COLUMNS: usize = 2;

/// Number of pictures per row.
const COLUMNS: usize = 7;

/// Maximum number of models per sheet.
const MAX_MODELS: usize = 210;

impl Show {
    pub(crate) fn run(self) -> Result<(), Failure> {
        if let Some(class) = &self.class {
            let rows = self.of_class(&class.to_lowercase())?;
            output::write_and_report_picture(&self.output, &sheet(&rows, 1))?;
        } else {
            output::write_and_report_picture(&self.output, &sheet(&self.overview(), ALBUM_COLUMNS))?;
        }
        output::json_of_what_was_written(self.json)
    }

    /// Some models of every built-in class.
    fn overview(&self) -> Vec<SheetRow> {
        let row = |(class, models): (&str, u32)| {
            let names: Vec<String> = built_in(class).collect();
            let is_named = names.iter().any(|name| name.parse::<u32>().is_err());
            let shown = if is_named {
                names.len()
            } else {
                names.len().min(ALBUM_MODELS)
            };
            SheetRow {
                title: class.to_owned(),
                words: match models {
                    _ if is_named => names.join(", "),
                    models => counted(models as usize, "model"),
                },
                pictures: names[..shown]
                    .iter()
                    .map(|name| cut_out(class, name, self.size.unwrap_or(ALBUM_SIZE)).into())
                    .collect(),
            }
        };
        classes().map(row).collect()
    }

    fn of_class(&self, class: &str) -> Result<Vec<SheetRow>, Failure> {
        let libraries = self.libraries.read()?;
        let names = model_names(class, &libraries);
        match &self.model {
            Some(model) => self.levels(class, model, &libraries),
            None if names.is_empty() => Err(Failure::input(format!(
                "class {class:?} is not known; driftworld assets list shows the built-in classes"
            ))),
            None => self.models(class, &names),
        }
    }

    /// All models of a class, several per row.
    fn models(&self, class: &str, names: &[String]) -> Result<Vec<SheetRow>, Failure> {
        let catalogue = self.libraries.catalogue()?;
        if names.len() > MAX_MODELS {
            output::note(format!(
                "note: the first {MAX_MODELS} of {} models are drawn",
                names.len()
            ));
        }
        let shown = &names[..names.len().min(MAX_MODELS)];
        let rows = shown.chunks(COLUMNS).map(|names| {
            let assets: Vec<Arc<Asset>> = names
                .iter()
                .map(|name| catalogue.asset(class, &Model(name.clone())))
                .collect();
            let counts: Vec<String> = assets.iter().map(|asset| triangles(asset).to_string()).collect();
            let heights: Vec<String> = assets.iter().map(|asset| format!("{:.1}", asset.height)).collect();
            SheetRow::new(
                format!("{class} {}", names.join(", ")),
                format!("{} triangles; {} m high", counts.join(", "), heights.join(", ")),
                assets.iter().map(|asset| self.picture(asset, 210.0).into()).collect(),
            )
        });
        Ok(rows.collect())
    }

    /// One model from four sides, at each of its levels of detail.
    fn levels(&self, class: &str, name: &str, libraries: &[Library]) -> Result<Vec<SheetRow>, Failure> {
        let is_it = |model: &&LibraryModel| model.class().to_lowercase() == class && model.name() == name;
        // The last library has priority, as in a catalogue.
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
                let share = error / asset.height.max(asset.radius);
                format!(
                    "off by up to {:.1} mm, {:.1} % of its size",
                    1000.0 * error,
                    100.0 * share
                )
            },
            pictures: [180.0, 270.0, 0.0, 90.0]
                .map(|heading| self.picture(asset, heading).into())
                .to_vec(),
        };
        Ok(forms.iter().enumerate().map(row).collect())
    }

    /// A model that fills a picture, turned to a heading in degrees, seen from the south.
    fn picture(&self, asset: &Arc<Asset>, heading_deg: f32) -> Picture {
        let mut world = WorldDraft::with_objects(vec![Object::new("cube", [0.0, 0.0])]);
        world.environment_params.wall_height = 0.0;
        let mut scene = Scene::from_world(&world.check().expect("a cube on open ground is valid"));
        let item = &mut scene.items[0];
        item.scale = SHOWN_SIZE / asset.height.max(2.0 * asset.radius);
        item.asset = Arc::clone(asset);
        item.heading_deg = heading_deg;
        let camera = camera_towards(item, [1.65 * SHOWN_SIZE, 0.62 * SHOWN_SIZE], 44.0);
        let size = self.size.unwrap_or(SIZE);
        let mut frame = Frame::new(2 * size, 2 * size);
        CpuRenderer::new().render(&scene, &camera, &mut frame);
        let drawn = Picture::new(frame.width, frame.height, frame.rgb);
        drawn.halved()
    }
}

/// A built-in model in natural looks on a white background, filling the picture.
fn cut_out(class: &str, name: &str, size: u32) -> Picture {
    let mut object = Object::new(class, [0.0, 0.0]);
    object.model = Model(name.to_owned());
    object.text = (class == "sign").then(|| "ABC".to_owned());
    let mut world = WorldDraft::with_objects(vec![object]);
    world.environment_params.wall_height = 0.0;
    world.environment_params.looks.style = Style::Natural;
    // The light comes from behind the camera, to its left.
    world.environment_params.sun_direction = [-0.5, -0.6, 0.6];
    let mut scene = Scene::from_world(&world.check().expect("a model on open ground is valid"));
    let item = &mut scene.items[0];
    item.heading_deg = 210.0;
    let reach = item.asset.height.max(2.0 * item.asset.radius) * item.scale;
    let camera = camera_towards(item, [2.6 * reach, 0.9 * reach], 32.0);
    let side = 4 * size;
    let (mut rgb, mut instances) = (vec![0; 3 * (side * side) as usize], vec![0; (side * side) as usize]);
    let mut target = Target {
        instance: Some(&mut instances),
        ..Target::of_colors([side, side], &mut rgb)
    };
    let drawn = CpuRenderer::new().draw(&scene, &camera, &mut target);
    drawn.expect("the picture is as large as its target");
    for (pixel, instance) in rgb.chunks_exact_mut(3).zip(instances) {
        if instance == 0 {
            pixel.fill(255);
        }
    }
    let large = Picture::new(side, side, rgb);
    large.halved().halved()
}

/// A camera `back` metres south of an item and `height` metres up, pointed at the item's middle.
fn camera_towards(item: &Item, [back, height]: [f32; 2], field_of_view_deg: f32) -> Camera {
    let middle = item.asset.height * item.scale / 2.0;
    Camera {
        position: [0.0, -back, height],
        heading_deg: 0.0,
        pitch_deg: -((height - middle) / back).atan().to_degrees(),
        field_of_view_deg,
    }
}

fn triangles(asset: &Asset) -> usize {
    asset.parts.iter().map(|part| part.mesh.triangles.len()).sum()
}

/// The models of a class: the built-in ones, then those of libraries, each once.
fn model_names(class: &str, libraries: &[Library]) -> Vec<String> {
    let mut names: Vec<String> = built_in(class).collect();
    for model in libraries.iter().flat_map(Library::models) {
        if model.class().to_lowercase() == class && !names.iter().any(|name| name == model.name()) {
            names.push(model.name().to_owned());
        }
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every built-in model is visible in the overview, on white, and not cut off at a side.
    #[test]
    fn every_model_is_shown_whole_on_white() {
        for (class, _) in classes() {
            for name in built_in(class).step_by(5) {
                let picture = cut_out(class, &name, 24);
                let is_drawn = |at: usize| picture.rgb[3 * at..3 * at + 3] != [255; 3];
                let count = (0..24 * 24).filter(|at| is_drawn(*at)).count();
                assert!(count >= 20, "{class} {name}: {count} pixels");
                let rim = (0..24).flat_map(|k| [k, 23 * 24 + k, 24 * k, 24 * k + 23]);
                assert_eq!(rim.filter(|at| is_drawn(*at)).count(), 0, "{class} {name} is cut off");
            }
        }
    }
}
