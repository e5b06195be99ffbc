//! How different two worlds look to an agent in them: pictures from the same places, compared. `env` draws the pictures and
//! `similarity` compares them; where they are taken from is in `poses.rs`.

mod poses;

use driftworld_env::{Camera, Catalogue, CpuRenderer, EnvError, Environment, Target};
use driftworld_similarity::SimilarityError;
use driftworld_similarity::picture::{Picture, PictureMeasure, picture_oklab_sums, views_distance};
use driftworld_spec::World;

pub use poses::{Pose, poses};

/// Places along each side of the arena.
pub(crate) const ACROSS: u32 = 4;

/// Directions at each place, from north clockwise.
const HEADINGS: u32 = 4;

/// Height and width of the pictures in pixels.
const SIDE: u32 = 48;

const PIXELS: usize = (SIDE * SIDE) as usize;

/// Points that each pixel is the mean of, along each side: small pictures of single points flicker.
const SUPERSAMPLING: u32 = 2;

/// What can keep worlds from being compared by how they look.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PictureDistanceError {
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
            Self::NoPlace { .. } => "pictures/no-place",
            Self::World(error) => error.code(),
            Self::Compare(error) => error.code(),
        }
    }
}

/// What an agent sees of one world from some poses, drawn once, to be compared with other worlds' from the same poses.
///
/// Each picture is taken with the world's own camera: its height and its field of view count as part of what is seen.
#[derive(Clone, Debug)]
pub struct Views {
    /// Picture after picture, `(poses, SIDE, SIDE, 3)` bytes.
    rgb: Vec<u8>,
    /// Which pixels show an object, `(poses, SIDE, SIDE)`.
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
    /// [`PictureDistanceError::World`] if a picture cannot be drawn.
    pub fn new(world: &World, poses: &[Pose], catalogue: &Catalogue) -> Result<Self, PictureDistanceError> {
        let environment = Environment::with_catalogue(world.clone(), catalogue.clone());
        let agent = &world.agent_params;
        let mut renderer = CpuRenderer::new();
        let mut rgb = vec![0; poses.len() * PIXELS * 3];
        let mut instances = vec![0; poses.len() * PIXELS];
        let pictures = rgb.chunks_exact_mut(PIXELS * 3).zip(instances.chunks_exact_mut(PIXELS));
        for (pose, (picture, instances)) in poses.iter().zip(pictures) {
            let camera = Camera::first_person(
                pose.position.map(|metres| metres as f32),
                pose.heading_deg as f32,
                agent.agent_height as f32,
                agent.field_of_view as f32,
            );
            let mut target = Target {
                width: SIDE,
                height: SIDE,
                supersampling: SUPERSAMPLING,
                rgb: Some(picture),
                instance: Some(instances),
                ..Target::default()
            };
            renderer.draw(environment.scene(), &camera, &mut target)?;
        }
        let objects = instances.iter().map(|item| *item > 0).collect();
        Ok(Self { rgb, objects })
    }

    /// Those from some of the poses, by their places in the list.
    ///
    /// # Panics
    /// When there is no pose of one of the numbers.
    #[must_use]
    pub fn only(&self, poses: &[usize]) -> Self {
        let rgb = poses
            .iter()
            .flat_map(|k| &self.rgb[k * PIXELS * 3..(k + 1) * PIXELS * 3]);
        let objects = poses.iter().flat_map(|k| &self.objects[k * PIXELS..(k + 1) * PIXELS]);
        Self {
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
        let each = self.rgb.chunks_exact(PIXELS * 3);
        each.map(|rgb| Picture::new(rgb, SIDE as usize, SIDE as usize).expect("what was drawn is a picture"))
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
        for ((ours, theirs), marks) in ours.iter().zip(&theirs).zip(marks.chunks_exact(PIXELS)) {
            for (sum, (more, count)) in sums.iter_mut().zip(picture_oklab_sums(*ours, *theirs, marks)?) {
                sum.0 += more;
                sum.1 += count;
            }
        }
        let [objects, surroundings] = sums.map(|(sum, count)| sum / count.max(1) as f64);
        Ok(PictureParts { objects, surroundings })
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

    fn views(worlds: &[&World]) -> Vec<Views> {
        let catalogue = Catalogue::default();
        let poses = poses(worlds, &catalogue).expect("all have free ground");
        let views = |world: &&World| Views::new(world, &poses, &catalogue).expect("it is drawn");
        worlds.iter().map(views).collect()
    }

    fn distance(a: &World, b: &World) -> f64 {
        let views = views(&[a, b]);
        let found = views[0].distance(&views[1], PictureMeasure::Oklab);
        found.expect("they are of one size")
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
            let views = views(&[a, b]);
            let [a, b] = [&views[0], &views[1]];
            assert_eq!(a.parts(b).unwrap(), b.parts(a).unwrap());
            assert_eq!(a.parts(a).unwrap(), PictureParts::default());
            (a.parts(b).unwrap(), a.distance(b, PictureMeasure::Oklab).unwrap())
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
        let catalogue = Catalogue::default();
        let empty = world("", "");
        assert_eq!(poses(&[&empty], &catalogue).expect("all is free").len(), 64);
        // Places are 25 m apart, the first 12.5 m from the middle.
        let tree = |x: f64, y: f64| format!(r#"{{ "class": "tree", "coordinates": [{x:?}, {y:?}], "solid": true }}"#);
        let one = world("", &tree(12.5, 12.5));
        let places = [-37.5, -12.5, 12.5, 37.5];
        let all: Vec<String> = places.iter().flat_map(|x| places.map(|y| tree(*x, y))).collect();
        let blocked = world("", &all.join(", "));
        assert_eq!(poses(&[&empty, &one], &catalogue).expect("15 are free").len(), 60);
        for pair in [[&empty, &blocked], [&blocked, &empty]] {
            let error = poses(&pair, &catalogue).expect_err("a tree stands in every place");
            assert!(error.to_string().contains("none of 16 places free"), "{error}");
        }
    }

    #[test]
    fn worlds_seen_from_one_set_of_poses_keep_the_laws_of_a_metric() {
        let worlds = [
            world("", ""),
            with_tree(1.0, "[1.0, 0.0, 0.0]"),
            with_tree(1.0, "[0.2, 0.9, 0.1]"),
            world("\"ground_color\": [0.4, 0.4, 0.7]", ""),
        ];
        let worlds: Vec<&World> = worlds.iter().collect();
        let views = views(&worlds);
        let apart = |a: usize, b: usize| views[a].distance(&views[b], PictureMeasure::Oklab).unwrap();
        assert_eq!(apart(1, 2), distance(worlds[1], worlds[2]), "their poses are the same");
        for (a, b) in (0..4).flat_map(|a| (0..4).map(move |b| (a, b))) {
            assert!(a == b || apart(a, b) > 0.0);
            for c in 0..4 {
                assert!(apart(a, b) <= apart(a, c) + apart(c, b) + 1e-12);
            }
        }
    }
}
