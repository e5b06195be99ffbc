//! Compares how two worlds look to an agent in them, by pictures from the same positions.

mod poses;

use driftworld_env::{Camera, Catalogue, CpuRenderer, Environment, Target};
use driftworld_similarity::SimilarityError;
use driftworld_similarity::picture::{Picture, PictureMeasure, picture_oklab_sums, views_distance};
use driftworld_spec::World;

use crate::distances::DistancesError;
pub(crate) use poses::{Pose, poses};

/// Number of positions along each side of the arena.
pub(crate) const GRID_SIDE: u32 = 4;

/// Number of directions at each position, clockwise from north.
const HEADINGS: u32 = 4;

/// Height and width of the pictures in pixels.
const SIDE: u32 = 48;

const PIXELS: usize = (SIDE * SIDE) as usize;

/// Samples per pixel along each side: small pictures with one sample per pixel flicker.
const SUPERSAMPLING: u32 = 2;

/// An agent's views of one world from some poses, rendered once, for comparison with other worlds from the same poses.
///
/// Each picture uses the world's own camera: its height and its field of view are part of the view.
#[derive(Clone, Debug)]
pub(crate) struct Views {
    /// Picture after picture, `(poses, SIDE, SIDE, 3)` bytes.
    rgb: Vec<u8>,
    /// Which pixels show an object, `(poses, SIDE, SIDE)`.
    objects: Vec<bool>,
}

impl Views {
    /// Renders the views on the CPU, which gives the same bytes on every machine.
    ///
    /// # Errors
    /// [`DistancesError::Env`] if a picture cannot be rendered.
    pub(crate) fn new(world: &World, poses: &[Pose], catalogue: &Catalogue) -> Result<Self, DistancesError> {
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

    /// The views from some of the poses, by their indices.
    ///
    /// # Panics
    /// If an index is out of range.
    #[must_use]
    pub(crate) fn only(&self, poses: &[usize]) -> Self {
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
    pub(crate) fn is_empty(&self) -> bool {
        self.rgb.is_empty()
    }

    /// The pictures in the order of their poses.
    pub(crate) fn pictures(&self) -> Vec<Picture<'_>> {
        let each = self.rgb.chunks_exact(PIXELS * 3);
        each.map(|rgb| Picture::new(rgb, SIDE as usize, SIDE as usize).expect("each chunk has the picture's size"))
            .collect()
    }

    /// Mean distance of the pictures of two worlds, pose by pose, in `0..=1`.
    ///
    /// # Errors
    /// [`DistancesError::Similarity`] unless both have the same number of pictures, all of the same size.
    pub(crate) fn distance(&self, other: &Self, measure: PictureMeasure) -> Result<f64, DistancesError> {
        Ok(views_distance(&self.pictures(), &other.pictures(), measure)?)
    }

    /// The visual differences where objects are visible, and elsewhere, separated so that ground and sky do not drown out small
    /// objects: the mean Oklab difference of the pixels that show an object in either world (0 without any), and of all others.
    /// Symmetric, each in `0..=1`; not a metric, because each pair of worlds compares different pixels.
    ///
    /// # Errors
    /// As [`Views::distance`].
    pub(crate) fn parts(&self, other: &Self) -> Result<[f64; 2], DistancesError> {
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
        Ok(sums.map(|(sum, count)| sum / count.max(1) as f64))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn world(environment: &str, objects: &str) -> World {
        let text = format!(r#"{{ "environment_params": {{ {environment} }}, "objects": [{objects}] }}"#);
        World::from_json("w.json", &text).expect("a valid world")
    }

    fn with_tree(reward: f64, color: &str) -> World {
        let tree =
            format!(r#"{{ "class": "tree", "coordinates": [2.0, 1.0], "reward": {reward:?}, "color": {color} }}"#);
        world("", &tree)
    }

    fn views(worlds: &[&World]) -> Vec<Views> {
        let catalogue = Catalogue::default();
        let poses = poses(worlds, &catalogue).expect("all have free ground");
        let views = |world: &&World| Views::new(world, &poses, &catalogue).expect("it renders");
        worlds.iter().map(views).collect()
    }

    fn distance(a: &World, b: &World) -> f64 {
        let views = views(&[a, b]);
        let found = views[0].distance(&views[1], PictureMeasure::Oklab);
        found.expect("the pictures have the same size")
    }

    #[test]
    fn only_visible_changes_count() {
        let red = with_tree(1.0, "[1.0, 0.0, 0.0]");
        let blue = with_tree(1.0, "[0.0, 0.0, 1.0]");
        let paying = with_tree(-5.0, "[1.0, 0.0, 0.0]");
        assert_eq!(distance(&red, &red), 0.0);
        assert_eq!(distance(&red, &paying), 0.0, "rewards are invisible");
        let there = distance(&red, &blue);
        assert!(there > 0.0);
        assert_eq!(there, distance(&blue, &red));
        assert_eq!(there, distance(&red, &blue), "bit for bit");
        let dark = world("\"ground_color\": [0.05, 0.05, 0.05]", "");
        assert!(
            distance(&red, &dark) > there,
            "the ground fills more of the pictures than a tree"
        );
    }

    #[test]
    fn small_objects_count_beside_the_ground() {
        let parts = |a: &World, b: &World| {
            let views = views(&[a, b]);
            let [a, b] = [&views[0], &views[1]];
            assert_eq!(a.parts(b).unwrap(), b.parts(a).unwrap());
            assert_eq!(a.parts(a).unwrap(), [0.0; 2]);
            (a.parts(b).unwrap(), a.distance(b, PictureMeasure::Oklab).unwrap())
        };
        let [red, blue] = ["[1.0, 0.0, 0.0]", "[0.0, 0.0, 1.0]"].map(|color| with_tree(1.0, color));
        let (found, whole) = parts(&red, &blue);
        assert!(found[0] > 20.0 * whole, "{found:?} {whole}");
        assert!(found[1] < whole, "{found:?} {whole}");
        let (found, _) = parts(&world("", ""), &world("\"ground_color\": [0.05, 0.05, 0.05]", ""));
        assert!(found[0] == 0.0 && found[1] > 0.05, "{found:?}");
    }

    #[test]
    fn each_world_uses_its_own_camera() {
        let wide = World::from_json("w.json", r#"{ "agent_params": { "field_of_view": 100.0 } }"#).expect("valid");
        let tall = World::from_json("w.json", r#"{ "agent_params": { "agent_height": 4.0 } }"#).expect("valid");
        assert!(distance(&World::default(), &wide) > 0.0);
        assert!(distance(&World::default(), &tall) > 0.0);
    }

    #[test]
    fn occupied_positions_are_excluded() {
        let catalogue = Catalogue::default();
        let empty = world("", "");
        assert_eq!(poses(&[&empty], &catalogue).expect("every position is free").len(), 64);
        // Positions are 25 m apart, the innermost 12.5 m from the centre on each axis.
        let tree = |x: f64, y: f64| format!(r#"{{ "class": "tree", "coordinates": [{x:?}, {y:?}], "solid": true }}"#);
        let one = world("", &tree(12.5, 12.5));
        let grid = [-37.5, -12.5, 12.5, 37.5];
        let trees: Vec<String> = grid.iter().flat_map(|x| grid.map(|y| tree(*x, y))).collect();
        let blocked = world("", &trees.join(", "));
        assert_eq!(poses(&[&empty, &one], &catalogue).expect("15 are free").len(), 60);
        for pair in [[&empty, &blocked], [&blocked, &empty]] {
            let error = poses(&pair, &catalogue).expect_err("a tree stands at every position");
            assert!(error.to_string().contains("none of 16 places free"), "{error}");
        }
    }

    #[test]
    fn views_from_one_set_of_poses_satisfy_the_metric_laws() {
        let worlds = [
            world("", ""),
            with_tree(1.0, "[1.0, 0.0, 0.0]"),
            with_tree(1.0, "[0.2, 0.9, 0.1]"),
            world("\"ground_color\": [0.4, 0.4, 0.7]", ""),
        ];
        let worlds: Vec<&World> = worlds.iter().collect();
        let views = views(&worlds);
        let between = |a: usize, b: usize| views[a].distance(&views[b], PictureMeasure::Oklab).unwrap();
        assert_eq!(between(1, 2), distance(worlds[1], worlds[2]), "same poses");
        for (a, b) in (0..4).flat_map(|a| (0..4).map(move |b| (a, b))) {
            assert!(a == b || between(a, b) > 0.0);
            for c in 0..4 {
                assert!(between(a, b) <= between(a, c) + between(c, b) + 1e-12);
            }
        }
    }
}
