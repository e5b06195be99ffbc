//! `driftworld photograph`: photographs every object of a world from all sides and from above, into PNG files with a manifest.

use std::collections::BTreeMap;
use std::path::PathBuf;

use crate::env::{
    CATEGORY_BUILDING, CATEGORY_MAP, CATEGORY_NEGATIVE, CATEGORY_NEUTRAL, CATEGORY_POSITIVE, CATEGORY_SKY, Catalogue,
    Environment, Frame, Photograph as View, Studio, Target, Warning, category_color,
};
use crate::spec::{Modality, Object, World};
use clap::Args;
use serde::Serialize;

use super::output;
use crate::Failure;
use crate::modality::{self, metres_per_level};
use crate::numbers::documented;
use crate::worlds::WorldRequest;

/// Maximum number of characters of each part of a file name that comes from the document.
const MAX_NAME_PART: usize = 40;

/// Photograph every object of a world from all sides.
///
/// From several heights, too.
///
/// Each object stands alone in full daylight, with the world's ground and sky. The world's `image_params` set the
/// camera distance, the number of sides and the heights. Its `agent_params` set the image size and the field of view.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld photograph world.json -o photographs
  driftworld photograph find_objects#red --seed 7 --modalities rgb,depth,instance -o photographs

Depth images are 16-bit, in units of the manifest's metres_per_level. Class and instance images are 16-bit,
with 0 where there is no object.")]
pub(crate) struct Photograph {
    #[command(flatten)]
    choice: WorldRequest,
    /// Modalities to write [default: those of the world].
    #[arg(long, value_parser = documented::<Modality>(&modality::NAMES), value_delimiter = ',', value_name = "LIST")]
    modalities: Vec<Modality>,
    /// Folder for the pictures and manifest.json. Replaces pictures of the same name.
    #[arg(short, long, default_value = "photographs", value_name = "DIR")]
    output: PathBuf,
    /// Print the manifest as JSON.
    #[arg(long)]
    json: bool,
}

/// The manifest of a folder: properties shared by all pictures, and a list of the pictures.
#[derive(Serialize)]
struct Manifest<'a> {
    world: String,
    /// Width and height in pixels.
    size: [u32; 2],
    field_of_view_deg: f64,
    zoom: f64,
    yaw_subdivisions: u32,
    vertical_subdivisions: u32,
    /// The sRGB bytes of each reward category in segmentation images.
    categories: BTreeMap<&'static str, [u8; 3]>,
    /// Class ids in class images.
    classes: BTreeMap<&'a str, u16>,
    photographs: Vec<Entry<'a>>,
}

#[derive(Serialize)]
struct Entry<'a> {
    file: String,
    modality: Modality,
    object: usize,
    class: &'a str,
    model: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    unique_name: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    tag: Option<&'a str>,
    yaw_deg: f32,
    elevation_deg: f32,
    /// From the camera to the object's centre in metres.
    distance: f32,
    /// For depth images: level 65535 and above is the background.
    #[serde(skip_serializing_if = "Option::is_none")]
    metres_per_level: Option<f32>,
}

impl Photograph {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let world = self.choice.world(&|text| output::warning(text))?;
        let kinds = self.kinds(&world)?;
        let mut studio = Studio::new(&world)?;
        for warning in Environment::new(world.clone()).warnings() {
            if matches!(warning, Warning::UnknownAsset { .. }) {
                output::note(format!("warning: {warning}"));
            }
        }
        let views = studio.photographs();
        let [width, height] = studio.picture_size();
        let mut frame = Frame::new(width, height);
        let supersampling = studio.supersampling();
        let mut entries = Vec::with_capacity(views.len() * kinds.len());
        let bar = output::progress(views.len() as u64, "photographs");
        for view in &views {
            let target = frame.target().only(&kinds);
            studio.take(
                view,
                &mut Target {
                    supersampling,
                    ..target
                },
            )?;
            for kind in &kinds {
                entries.push(self.save(&world, view, *kind, &frame)?);
            }
            bar.inc(1);
        }
        bar.finish_and_clear();
        let manifest = manifest(&world, entries);
        let text = serde_json::to_string_pretty(&manifest)? + "\n";
        output::write(&self.output.join("manifest.json"), text.as_bytes())?;
        output::wrote(
            &self.output,
            format!(
                "{} objects in {} pictures of {width} × {height} pixels",
                world.objects.len(),
                manifest.photographs.len()
            ),
        );
        if self.json { output::json(&manifest) } else { Ok(()) }
    }

    fn kinds(&self, world: &World) -> Result<Vec<Modality>, Failure> {
        let mut kinds = self.modalities.clone();
        if kinds.is_empty() {
            kinds.extend(&world.agent_params.modalities);
        }
        kinds.sort_unstable_by_key(|kind| *kind as usize);
        kinds.dedup();
        if kinds.is_empty() {
            return Err(Failure::usage(
                "the world has no agent_params.modalities; choose images with --modalities, such as --modalities rgb",
            ));
        }
        Ok(kinds)
    }

    /// Writes one image of a view, and returns its entry in the manifest.
    fn save<'a>(&self, world: &'a World, view: &View, kind: Modality, frame: &Frame) -> Result<Entry<'a>, Failure> {
        let object = &world.objects[view.object];
        let file = file_name(view, object, kind, world.objects.len());
        let metres_per_level = (kind == Modality::Depth).then(|| metres_per_level(view.distance));
        let bytes = modality::to_png(kind, frame, metres_per_level.unwrap_or(1.0))?;
        output::write(&self.output.join(&file), &bytes)?;
        Ok(Entry {
            file,
            modality: kind,
            object: view.object,
            class: &object.class,
            model: &object.model.0,
            unique_name: object.unique_name.as_deref(),
            tag: object.tag.as_deref(),
            yaw_deg: view.yaw_deg,
            elevation_deg: view.elevation_deg,
            distance: view.distance,
            metres_per_level,
        })
    }
}

fn manifest<'a>(world: &'a World, photographs: Vec<Entry<'a>>) -> Manifest<'a> {
    let image = world.image_params.clone().unwrap_or_default();
    let categories = [
        ("sky", CATEGORY_SKY),
        ("map", CATEGORY_MAP),
        ("building", CATEGORY_BUILDING),
        ("positive", CATEGORY_POSITIVE),
        ("neutral", CATEGORY_NEUTRAL),
        ("negative", CATEGORY_NEGATIVE),
    ];
    Manifest {
        world: world.hash(),
        size: world.agent_params.picture_size(),
        field_of_view_deg: world.agent_params.field_of_view,
        zoom: image.zoom,
        yaw_subdivisions: image.yaw_subdivisions,
        vertical_subdivisions: image.vertical_subdivisions,
        categories: categories
            .map(|(name, category)| (name, category_color(category)))
            .into(),
        classes: classes(world),
        photographs,
    }
}

/// The ids of the classes in the world.
fn classes(world: &World) -> BTreeMap<&str, u16> {
    let catalogue = Catalogue::default();
    let classes = world.objects.iter().map(|object| object.class.as_str());
    classes.map(|class| (class, catalogue.class_number(class))).collect()
}

/// Folder and name of a picture, such as `000_barrel_2/yaw_090_up_30_rgb.png`.
fn file_name(view: &View, object: &Object, kind: Modality, objects: usize) -> String {
    let digits = objects.saturating_sub(1).to_string().len().max(3);
    let kind = modality::name(kind);
    format!(
        "{:0digits$}_{}_{}/yaw_{}_up_{}_{kind}.png",
        view.object,
        safe(&object.class),
        safe(&object.model.0),
        degrees(view.yaw_deg, 3),
        degrees(view.elevation_deg, 2),
    )
}

/// An angle without decimals if it is whole, otherwise with two: no two views are closer than that.
fn degrees(angle: f32, digits: usize) -> String {
    if angle.fract() == 0.0 {
        return format!("{angle:0digits$}");
    }
    format!("{angle:0width$.2}", width = digits + 3)
}

/// Turns a string from the document into part of a file name: anything but ASCII letters and digits becomes `-`.
fn safe(text: &str) -> String {
    let replace = |c: char| {
        if c.is_ascii_alphanumeric() {
            c.to_ascii_lowercase()
        } else {
            '-'
        }
    };
    let text: String = text.chars().take(MAX_NAME_PART).map(replace).collect();
    match text.trim_matches('-') {
        "" => "x".to_owned(),
        trimmed => trimmed.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::{ImageParams, WorldDraft};

    #[test]
    fn file_names_stay_inside_the_folder() {
        let check = |class: &str, expected: &str| {
            let view = View {
                object: 7,
                yaw_deg: 90.0,
                elevation_deg: 30.0,
                distance: 1.0,
            };
            let found = file_name(&view, &Object::new(class, [0.0, 0.0]), Modality::Rgb, 12);
            assert_eq!(found, format!("007_{expected}_1/yaw_090_up_30_rgb.png"));
        };
        check("barrel", "barrel");
        check("../x", "x");
        check("/etc/passwd", "etc-passwd");
        check("..\\..\\Con:\0", "con");
        check("Löwe", "l-we");
        check("..", "x");
        check(&"long".repeat(30), &"long".repeat(10));
    }

    #[test]
    fn view_names_are_unique() {
        let world = WorldDraft {
            image_params: Some(ImageParams {
                zoom: 1.0,
                yaw_subdivisions: 7,
                vertical_subdivisions: 360,
            }),
            objects: vec![Object::new("cube", [0.0, 0.0]); 2],
            ..WorldDraft::default()
        };
        let views = Studio::new(&world.clone().check().expect("the world is valid"))
            .expect("there are few photographs")
            .photographs();
        let names: std::collections::BTreeSet<String> = views
            .iter()
            .map(|view| file_name(view, &world.objects[view.object], Modality::Depth, 2))
            .collect();
        assert_eq!(names.len(), 2 * 7 * 360);
        assert!(
            names.contains("001_cube_1/yaw_051.43_up_00.25_depth.png"),
            "{:?}",
            names.iter().nth(9)
        );
    }
}
