//! How different two worlds look to an agent in them: pictures from the same places, compared. `env` draws the pictures and
//! `similarity` compares them; where they are taken from is in `poses.rs`.

mod poses;

use driftworld_env::{Camera, Catalogue, CpuRenderer, EnvError, Environment, Target};
use driftworld_similarity::picture::{Picture, PictureMeasure, picture_oklab_sums, views_distance};
use driftworld_similarity::{DistanceMatrix, MetricProperties, SimilarityError};
use driftworld_spec::World;

pub use poses::{Pose, poses};

/// The most places along each side of the arena.
pub const MAX_ACROSS: u32 = 32;

/// The most directions at each place.
pub const MAX_HEADINGS: u32 = 64;

/// The longest side of a picture in pixels.
pub const MAX_PICTURE_SIDE: u32 = 512;

/// The most pixels of all pictures of one world.
pub const MAX_VIEW_PIXELS: u64 = 1 << 26;

/// Points that each pixel is the mean of, along each side: small pictures of single points flicker.
const SUPERSAMPLING: u32 = 2;

/// From where worlds are looked at, and how their pictures are compared.
#[derive(Clone, Debug)]
pub struct PictureOptions {
    /// Places along each side of the arena, 1 to 32; default 4, which makes 16 places.
    pub across: u32,
    /// Directions at each place, 1 to 64, from north clockwise; default 4.
    pub headings: u32,
    /// Height and width of the pictures in pixels, 1 to 512 (11 at least for `Structure`); default 48.
    pub side: u32,
    /// How two pictures are compared; default the mean distance of colours in Oklab.
    pub measure: PictureMeasure,
    /// Where the worlds take their assets from; default the built-in ones.
    pub catalogue: Catalogue,
}

impl Default for PictureOptions {
    fn default() -> Self {
        Self {
            across: 4,
            headings: 4,
            side: 48,
            measure: PictureMeasure::default(),
            catalogue: Catalogue::default(),
        }
    }
}

/// What can keep worlds from being compared by how they look.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PictureDistanceError {
    /// An option out of its range.
    #[error("pictures, {option}: found {found}, expected 1 to {limit}")]
    Option {
        /// The option.
        option: &'static str,
        /// Its value.
        found: u64,
        /// The most it can be.
        limit: u64,
    },
    /// There is no place where an agent could stand in every world.
    #[error(
        "pictures: found none of {tried} places free in all worlds, expected at least 1; where walls stand elsewhere, as in mazes \
         of other sizes, compare by worlds or by parameters"
    )]
    NoPlace {
        /// How many places were tried.
        tried: u32,
    },
    /// A world cannot be looked at.
    #[error(transparent)]
    World(#[from] EnvError),
    /// Pictures cannot be compared.
    #[error(transparent)]
    Compare(#[from] SimilarityError),
}

impl PictureDistanceError {
    /// The stable name of this kind of error.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Option { .. } => "pictures/option",
            Self::NoPlace { .. } => "pictures/no-place",
            Self::World(error) => error.code(),
            Self::Compare(error) => error.code(),
        }
    }
}

/// How different two worlds look: the mean distance of what an agent would see from the same places in both.
///
/// Sees what the observation function shows and nothing else: worlds that differ in what things pay are at 0. In `0..=1`,
/// symmetric, 0 for worlds that look alike from all [`poses`]. With one set of poses for many worlds ([`picture_matrix`]) and
/// the measure `Oklab` the triangle inequality holds; poses chosen pair by pair, as here, may break it. Cost: two environments
/// and `2 · across² · headings` pictures.
///
/// # Errors
/// As [`poses`] and [`Views::new`]; [`PictureDistanceError::Compare`] for `Structure` with pictures smaller than its window.
///
/// # Example
/// ```
/// use driftworld::picture_distance::{PictureOptions, picture_distance};
/// use driftworld::spec::World;
/// let day = World::from_json("day.json", r#"{ "environment_params": { "ground_color": [0.3, 0.5, 0.2] } }"#)?;
/// let sand = World::from_json("sand.json", r#"{ "environment_params": { "ground_color": [0.8, 0.7, 0.4] } }"#)?;
/// let options = PictureOptions::default();
/// assert_eq!(picture_distance(&day, &day, &options)?, 0.0);
/// assert!(picture_distance(&day, &sand, &options)? > 0.05);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn picture_distance(a: &World, b: &World, options: &PictureOptions) -> Result<f64, PictureDistanceError> {
    let poses = poses(&[a, b], options)?;
    let views = [Views::new(a, &poses, options)?, Views::new(b, &poses, options)?];
    views[0].distance(&views[1], options.measure)
}

/// [`picture_distance`] among many worlds, each drawn once, from places that are free in all of them.
///
/// # Errors
/// As [`picture_distance`].
pub fn picture_matrix(
    labels: Vec<String>,
    worlds: &[&World],
    options: &PictureOptions,
) -> Result<DistanceMatrix, PictureDistanceError> {
    if labels.len() != worlds.len() {
        return Err(SimilarityError::Shape {
            of: "labels of worlds",
            found: labels.len(),
            expected: worlds.len(),
        }
        .into());
    }
    let poses = poses(worlds, options)?;
    let views = worlds
        .iter()
        .map(|world| Views::new(world, &poses, options))
        .collect::<Result<Vec<_>, _>>()?;
    let matrix = DistanceMatrix::measure(labels, |a, b| views[a].distance(&views[b], options.measure));
    Ok::<_, PictureDistanceError>(matrix?.with_properties(Views::properties(options.measure)))
}

fn check(options: &PictureOptions) -> Result<(), PictureDistanceError> {
    let (across, headings, side) = (options.across.into(), options.headings.into(), options.side.into());
    let in_range = |option, found: u64, limit: u64| {
        if (1..=limit).contains(&found) {
            Ok(())
        } else {
            Err(PictureDistanceError::Option { option, found, limit })
        }
    };
    in_range("across", across, MAX_ACROSS.into())?;
    in_range("headings", headings, MAX_HEADINGS.into())?;
    in_range("side", side, MAX_PICTURE_SIDE.into())?;
    in_range(
        "pixels of all pictures",
        across * across * headings * side * side,
        MAX_VIEW_PIXELS,
    )
}

/// What an agent sees of one world from some poses, drawn once, to be compared with other worlds' from the same poses.
///
/// Each picture is taken with the world's own camera: its height and its field of view count as part of what is seen.
#[derive(Clone, Debug)]
pub struct Views {
    side: usize,
    /// Picture after picture, `(poses, side, side, 3)` bytes.
    rgb: Vec<u8>,
    /// Which pixels show an object, `(poses, side, side)`.
    objects: Vec<bool>,
}

/// How different two worlds look, in what shows objects and in all else.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PictureParts {
    /// Mean Oklab difference of the pixels that show an object in either world, `0..=1`; 0 where none does.
    pub objects: f64,
    /// That of all other pixels.
    pub surroundings: f64,
}

impl Views {
    /// Draws them, on the processor: the same bytes on every machine.
    ///
    /// # Errors
    /// [`PictureDistanceError::Option`]; [`PictureDistanceError::World`] if a picture cannot be drawn.
    pub fn new(world: &World, poses: &[Pose], options: &PictureOptions) -> Result<Self, PictureDistanceError> {
        check(options)?;
        let environment = Environment::with_catalogue(world.clone(), options.catalogue.clone());
        let agent = &world.agent_params;
        let mut renderer = CpuRenderer::new();
        let pixels = options.side as usize * options.side as usize;
        let mut rgb = vec![0; poses.len() * pixels * 3];
        let mut instances = vec![0; poses.len() * pixels];
        let pictures = rgb.chunks_exact_mut(pixels * 3).zip(instances.chunks_exact_mut(pixels));
        for (pose, (picture, instances)) in poses.iter().zip(pictures) {
            let camera = Camera::first_person(
                pose.position.map(|metres| metres as f32),
                pose.heading_deg as f32,
                agent.agent_height as f32,
                agent.field_of_view as f32,
            );
            let mut target = Target {
                width: options.side,
                height: options.side,
                supersampling: SUPERSAMPLING,
                rgb: Some(picture),
                instance: Some(instances),
                ..Target::default()
            };
            renderer.draw(environment.scene(), &camera, &mut target)?;
        }
        let side = options.side as usize;
        let objects = instances.iter().map(|item| *item > 0).collect();
        Ok(Self { side, rgb, objects })
    }

    /// Those from some of the poses, by their places in the list.
    ///
    /// # Panics
    /// When there is no pose of one of the numbers.
    #[must_use]
    pub fn only(&self, poses: &[usize]) -> Self {
        let pixels = self.side * self.side;
        let rgb = poses
            .iter()
            .flat_map(|k| &self.rgb[k * pixels * 3..(k + 1) * pixels * 3]);
        let objects = poses.iter().flat_map(|k| &self.objects[k * pixels..(k + 1) * pixels]);
        Self {
            side: self.side,
            rgb: rgb.copied().collect(),
            objects: objects.copied().collect(),
        }
    }

    /// Whether there is no picture.
    pub fn is_empty(&self) -> bool {
        self.rgb.is_empty()
    }

    /// The pictures in the order of their poses.
    pub fn pictures(&self) -> Vec<Picture<'_>> {
        let each = self.rgb.chunks_exact(self.side * self.side * 3);
        each.map(|rgb| Picture::new(rgb, self.side, self.side).expect("what was drawn is a picture"))
            .collect()
    }

    /// Mean distance of the pictures of two worlds, pose by pose, in `0..=1`.
    ///
    /// # Errors
    /// [`PictureDistanceError::Compare`] unless both have as many pictures of one size.
    pub fn distance(&self, other: &Self, measure: PictureMeasure) -> Result<f64, PictureDistanceError> {
        Ok(views_distance(&self.pictures(), &other.pictures(), measure)?)
    }

    /// How different they look where objects are seen, and elsewhere: so that small things that a task is about do not drown in
    /// ground and sky. Symmetric, each `0..=1`; a distance, for each pair has pixels of its own.
    ///
    /// # Errors
    /// As [`Views::distance`].
    pub fn parts(&self, other: &Self) -> Result<PictureParts, PictureDistanceError> {
        let (ours, theirs) = (self.pictures(), other.pictures());
        if ours.len() != theirs.len() {
            let (of, found, expected) = ("pictures of the second set", theirs.len(), ours.len());
            return Err(SimilarityError::Shape { of, found, expected }.into());
        }
        let marks = self
            .objects
            .iter()
            .zip(&other.objects)
            .map(|(ours, theirs)| *ours || *theirs);
        let marks: Vec<bool> = marks.collect();
        let mut sums = [(0.0, 0_usize); 2];
        for ((ours, theirs), marks) in ours.iter().zip(&theirs).zip(marks.chunks_exact(self.side * self.side)) {
            for (sum, (more, count)) in sums.iter_mut().zip(picture_oklab_sums(*ours, *theirs, marks)?) {
                sum.0 += more;
                sum.1 += count;
            }
        }
        let [objects, surroundings] = sums.map(|(sum, count)| sum / count.max(1) as f64);
        Ok(PictureParts { objects, surroundings })
    }

    /// Which laws [`Views::distance`] keeps among worlds seen from one set of poses, worlds that look alike taken as equal.
    pub fn properties(measure: PictureMeasure) -> MetricProperties {
        measure.properties()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn world(environment: &str, objects: &str) -> World {
        let text = format!(r#"{{ "environment_params": {{ {environment} }}, "objects": [{objects}] }}"#);
        World::from_json("w.json", &text).expect("a sound world")
    }

    fn with_tree(reward: f64, color: &str) -> World {
        let tree =
            format!(r#"{{ "class": "tree", "coordinates": [2.0, 1.0], "reward": {reward:?}, "color": {color} }}"#);
        world("", &tree)
    }

    fn distance(a: &World, b: &World) -> f64 {
        picture_distance(a, b, &PictureOptions::default()).expect("both have free ground")
    }

    #[test]
    fn it_sees_what_is_seen_and_nothing_else() {
        let red = with_tree(1.0, "[1.0, 0.0, 0.0]");
        let blue = with_tree(1.0, "[0.0, 0.0, 1.0]");
        let paying = with_tree(-5.0, "[1.0, 0.0, 0.0]");
        assert_eq!(distance(&red, &red), 0.0);
        assert_eq!(distance(&red, &paying), 0.0, "what a tree pays cannot be seen");
        let there = distance(&red, &blue);
        assert!(there > 0.0);
        assert_eq!(there, distance(&blue, &red));
        assert_eq!(there, distance(&red, &blue), "the same bits again");
        let dark = world("\"ground_color\": [0.05, 0.05, 0.05]", "");
        assert!(
            distance(&red, &dark) > there,
            "the ground fills more of the pictures than a tree"
        );
    }

    #[test]
    fn small_things_count_beside_the_ground() {
        let parts = |a: &World, b: &World| {
            let options = PictureOptions::default();
            let poses = poses(&[a, b], &options).expect("both have free ground");
            let [a, b] = [a, b].map(|world| Views::new(world, &poses, &options).expect("it is drawn"));
            assert_eq!(a.parts(&b).unwrap(), b.parts(&a).unwrap());
            assert_eq!(a.parts(&a).unwrap(), PictureParts::default());
            (a.parts(&b).unwrap(), a.distance(&b, PictureMeasure::Oklab).unwrap())
        };
        let [red, blue] = ["[1.0, 0.0, 0.0]", "[0.0, 0.0, 1.0]"].map(|color| with_tree(1.0, color));
        let (found, whole) = parts(&red, &blue);
        assert!(found.objects > 20.0 * whole, "{found:?} {whole}");
        assert!(found.surroundings < whole, "{found:?} {whole}");
        let (found, _) = parts(&world("", ""), &world("\"ground_color\": [0.05, 0.05, 0.05]", ""));
        assert!(found.objects == 0.0 && found.surroundings > 0.05, "{found:?}");
    }

    #[test]
    fn the_camera_is_the_worlds_own() {
        let wide = World::from_json("w.json", r#"{ "agent_params": { "field_of_view": 100.0 } }"#).expect("sound");
        let tall = World::from_json("w.json", r#"{ "agent_params": { "agent_height": 4.0 } }"#).expect("sound");
        assert!(distance(&World::default(), &wide) > 0.0);
        assert!(distance(&World::default(), &tall) > 0.0);
    }

    #[test]
    fn nobody_stands_in_what_is_solid() {
        let options = PictureOptions {
            across: 1,
            ..PictureOptions::default()
        };
        let empty = world("", "");
        assert_eq!(poses(&[&empty], &options).expect("the middle is free").len(), 4);
        let blocked = world("", r#"{ "class": "tree", "coordinates": [0.0, 0.0], "solid": true }"#);
        for pair in [[&empty, &blocked], [&blocked, &empty]] {
            let error = poses(&pair, &options).expect_err("a tree stands in the only place");
            assert!(error.to_string().contains("none of 1 places free"), "{error}");
        }
    }

    #[test]
    fn a_matrix_of_worlds_keeps_the_laws_of_a_metric() {
        let worlds = [
            world("", ""),
            with_tree(1.0, "[1.0, 0.0, 0.0]"),
            with_tree(1.0, "[0.2, 0.9, 0.1]"),
            world("\"ground_color\": [0.4, 0.4, 0.7]", ""),
        ];
        let labels = (0..worlds.len()).map(|k| format!("world {k}")).collect();
        let worlds: Vec<&World> = worlds.iter().collect();
        let matrix = picture_matrix(labels, &worlds, &PictureOptions::default()).expect("all have free ground");
        assert_eq!(
            matrix.get(1, 2),
            distance(worlds[1], worlds[2]),
            "their poses are the same"
        );
        for (a, b) in (0..4).flat_map(|a| (0..4).map(move |b| (a, b))) {
            assert!(a == b || matrix.get(a, b) > 0.0);
            for c in 0..4 {
                assert!(matrix.get(a, b) <= matrix.get(a, c) + matrix.get(c, b) + 1e-12);
            }
        }
    }

    #[test]
    fn options_out_of_range_say_so() {
        let check = |options: PictureOptions, expected: &str| {
            let world = World::default();
            let error = picture_distance(&world, &world, &options).expect_err("it is out of range");
            assert_eq!(
                (error.code(), error.to_string().as_str()),
                ("pictures/option", expected)
            );
        };
        let base = PictureOptions::default;
        check(
            PictureOptions { across: 0, ..base() },
            "pictures, across: found 0, expected 1 to 32",
        );
        check(
            PictureOptions { headings: 65, ..base() },
            "pictures, headings: found 65, expected 1 to 64",
        );
        check(
            PictureOptions { side: 513, ..base() },
            "pictures, side: found 513, expected 1 to 512",
        );
        check(
            PictureOptions {
                side: 512,
                across: 32,
                ..base()
            },
            "pictures, pixels of all pictures: found 1073741824, expected 1 to 67108864",
        );
    }
}
