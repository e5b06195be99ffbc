//! Photographs a world's objects one by one, from all sides and from above, for `collect_images`.

use driftworld_spec::{EnvironmentParams, World, WorldDraft};

use crate::EnvError;
use crate::assets::Catalogue;
use crate::camera::Camera;
use crate::render::{CpuRenderer, Target};
use crate::scene::{Item, Scene};
use crate::vector::{add, scaled};

/// Maximum number of photographs of one world, so that object numbers fit into 16-bit images.
pub const MAX_PHOTOGRAPHS: usize = 50_000;

/// The sun's angle to the left of the camera, and its elevation, in degrees.
const SUN: [f32; 2] = [35.0, 50.0];

/// One view of one object.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Photograph {
    /// Index of the object in the world.
    pub object: usize,
    /// Direction from the object to the camera, in degrees clockwise from the object's heading, 0..360: 0 shows its front, 90
    /// its right side.
    pub yaw_deg: f32,
    /// Elevation of the camera over the object's centre, in degrees, 0..=90: 90 looks straight down.
    pub elevation_deg: f32,
    /// Distance from the camera to the object's centre in metres.
    pub distance: f32,
}

/// A studio in which the objects of a world are photographed one by one.
///
/// Each object stands alone on ground of the world's colour under a sky of the world's colour, without walls or fog. The light
/// is always full daylight, with the sun behind the photographer's left shoulder, so that no view shows a shaded side. The same
/// object gives the same pixels for every position and heading in the world.
///
/// # Example
/// ```
/// use driftworld_env::Studio;
/// use driftworld_spec::{ImageParams, Object, WorldDraft};
/// let world = WorldDraft {
///     image_params: Some(ImageParams { zoom: 1.5, yaw_subdivisions: 4, vertical_subdivisions: 3 }),
///     objects: vec![Object::new("barrel", [3.0, 4.0])],
///     ..WorldDraft::default()
/// };
/// let world = world.check()?;
/// let photographs = Studio::new(&world)?.photographs();
/// assert_eq!(photographs.len(), 12);
/// assert_eq!((photographs[5].yaw_deg, photographs[5].elevation_deg), (90.0, 45.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Studio {
    scene: Scene,
    renderer: CpuRenderer,
    zoom: f32,
    yaws: u32,
    elevations: u32,
    size: [u32; 2],
    supersampling: u32,
    field_of_view_deg: f32,
}

impl Studio {
    /// A studio for a world's objects, using the world's `image_params` or their defaults.
    ///
    /// # Errors
    /// [`EnvError::TooManyPhotographs`] for more than [`MAX_PHOTOGRAPHS`] photographs.
    pub fn new(world: &World) -> Result<Self, EnvError> {
        Self::with_catalogue(world, &Catalogue::default())
    }

    /// Like [`Studio::new`], with assets from a catalogue.
    ///
    /// # Errors
    /// The errors of [`Studio::new`].
    pub fn with_catalogue(world: &World, catalogue: &Catalogue) -> Result<Self, EnvError> {
        let image = world.image_params.clone().unwrap_or_default();
        let views = image.yaw_subdivisions as usize * image.vertical_subdivisions as usize;
        let objects = world.objects.len();
        if objects.saturating_mul(views) > MAX_PHOTOGRAPHS {
            return Err(EnvError::TooManyPhotographs {
                objects,
                views,
                most: MAX_PHOTOGRAPHS,
            });
        }
        let backdrop = WorldDraft {
            environment_params: backdrop(&world.environment_params),
            objects: world.objects.clone(),
            ..WorldDraft::default()
        };
        let backdrop = backdrop.check_in_range().expect("the objects come from a valid world");
        let mut scene = Scene::from_world_with(&backdrop, catalogue);
        for item in &mut scene.items {
            (item.position, item.heading_deg, item.visible) = ([0.0; 2], 0.0, false);
        }
        Ok(Self {
            scene,
            renderer: CpuRenderer::new(),
            zoom: image.zoom as f32,
            yaws: image.yaw_subdivisions,
            elevations: image.vertical_subdivisions,
            size: world.agent_params.picture_size(),
            supersampling: world.agent_params.supersampling,
            field_of_view_deg: world.agent_params.field_of_view as f32,
        })
    }

    /// Width and height of the photographs in pixels, the same as for the world's observations.
    pub fn picture_size(&self) -> [u32; 2] {
        self.size
    }

    /// Samples per pixel along each side, whose mean is the colour, as the world requests.
    pub fn supersampling(&self) -> u32 {
        self.supersampling
    }

    /// All photographs, object by object, in full circles from the level view up to the top view.
    ///
    /// Yaws divide the full circle into `yaw_subdivisions` equal parts, starting at the front. The first elevation is 0 degrees
    /// and the last of several is 90.
    pub fn photographs(&self) -> Vec<Photograph> {
        let mut photographs = Vec::with_capacity(self.scene.items.len() * (self.yaws * self.elevations) as usize);
        for (object, item) in self.scene.items.iter().enumerate() {
            let distance = self.distance(item);
            for up in 0..self.elevations {
                let elevation_deg = 90.0 * up as f32 / (self.elevations - 1).max(1) as f32;
                photographs.extend((0..self.yaws).map(|around| Photograph {
                    object,
                    yaw_deg: 360.0 * around as f32 / self.yaws as f32,
                    elevation_deg,
                    distance,
                }));
            }
        }
        photographs
    }

    /// Distance of the camera from an object's centre: `zoom` times the distance at which the object's bounding ball just fits.
    fn distance(&self, item: &Item) -> f32 {
        let [width, height] = self.size.map(|pixels| pixels as f32);
        let half = (self.field_of_view_deg.clamp(1.0, 170.0) / 2.0).to_radians();
        let tangent = libm::sinf(half) / libm::cosf(half) * (width / height).min(1.0);
        let sine = tangent / (1.0 + tangent * tangent).sqrt();
        self.zoom * item.asset.ball_radius() * item.scale / sine
    }

    /// The camera of a photograph. The object stands at the origin and faces along +y.
    ///
    /// # Errors
    /// [`EnvError::NoSuchObject`] if the photograph's object does not exist.
    pub fn camera(&self, photograph: &Photograph) -> Result<Camera, EnvError> {
        let (found, count) = (photograph.object, self.scene.items.len());
        let item = self.scene.items.get(found);
        let item = item.ok_or(EnvError::NoSuchObject { found, count })?;
        let middle = [0.0, 0.0, item.asset.height * item.scale / 2.0];
        let towards_camera = direction(photograph.yaw_deg, photograph.elevation_deg);
        Ok(Camera {
            position: add(middle, scaled(towards_camera, photograph.distance)),
            heading_deg: photograph.yaw_deg + 180.0,
            pitch_deg: -photograph.elevation_deg,
            field_of_view_deg: self.field_of_view_deg,
        })
    }

    /// Takes a photograph: fills the requested images of the target. Class and object numbers are the same as in the world.
    ///
    /// # Errors
    /// [`EnvError::NoSuchObject`] if the photograph's object does not exist; the errors of [`CpuRenderer::draw`].
    pub fn take(&mut self, photograph: &Photograph, target: &mut Target<'_>) -> Result<(), EnvError> {
        let camera = self.camera(photograph)?;
        self.scene.light.direction = direction(photograph.yaw_deg + SUN[0], SUN[1]);
        self.scene.items[photograph.object].visible = true;
        let result = self.renderer.draw(&self.scene, &camera, target);
        self.scene.items[photograph.object].visible = false;
        result
    }
}

/// An arena in full daylight, without anything that could obscure the view.
fn backdrop(environment: &EnvironmentParams) -> EnvironmentParams {
    EnvironmentParams {
        ground_color: environment.ground_color,
        sky_color: environment.sky_color,
        wall_height: 0.0,
        ..EnvironmentParams::default()
    }
}

/// A unit vector from degrees clockwise from +y and degrees above the horizon.
fn direction(heading_deg: f32, elevation_deg: f32) -> [f32; 3] {
    let (heading, elevation) = (heading_deg.to_radians(), elevation_deg.to_radians());
    let level = libm::cosf(elevation);
    [
        libm::sinf(heading) * level,
        libm::cosf(heading) * level,
        libm::sinf(elevation),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::{CATEGORY_POSITIVE, Frame};
    use driftworld_spec::{ImageParams, Object};

    fn world(zoom: f64, yaws: u32, elevations: u32, objects: Vec<Object>) -> World {
        let world = WorldDraft {
            image_params: Some(ImageParams {
                zoom,
                yaw_subdivisions: yaws,
                vertical_subdivisions: elevations,
            }),
            objects,
            ..WorldDraft::default()
        };
        world.check().expect("the world is valid")
    }

    fn take(studio: &mut Studio, photograph: &Photograph) -> Frame {
        let [width, height] = studio.picture_size();
        let mut frame = Frame::new(width, height);
        studio
            .take(photograph, &mut frame.target())
            .expect("the photograph belongs to this studio");
        frame
    }

    /// Number of the object's pixels, and whether none of them touches the image's border.
    fn subject(frame: &Frame) -> (usize, bool) {
        let (width, height) = (frame.width as usize, frame.height as usize);
        let is_rim = |at: usize| {
            let (x, y) = (at % width, at / width);
            x == 0 || y == 0 || x == width - 1 || y == height - 1
        };
        let seen: Vec<usize> = (0..frame.instance.len()).filter(|at| frame.instance[*at] > 0).collect();
        (seen.len(), !seen.iter().any(|at| is_rim(*at)))
    }

    #[test]
    fn every_known_asset_fits_into_the_image_from_all_sides() {
        let objects = crate::classes()
            .map(|(class, _)| {
                let mut object = Object::new(class, [-20.0, 30.0]);
                object.scale = 3.0;
                object
            })
            .collect();
        for (width, field_of_view) in [(None, 60.0), (Some(40), 100.0), (Some(160), 20.0)] {
            let world = world(1.05, 3, 3, Vec::clone(&objects)).edit(|world| {
                world.agent_params.observation_width = width;
                world.agent_params.field_of_view = field_of_view;
            });
            let world = world.expect("the world is valid");
            let mut studio = Studio::new(&world).expect("this many photographs are allowed");
            for photograph in studio.photographs() {
                let (pixels, whole) = subject(&take(&mut studio, &photograph));
                let class = &world.objects[photograph.object].class;
                assert!(pixels > 20 && whole, "{class} {photograph:?}: {pixels} pixels");
            }
        }
    }

    #[test]
    fn doubling_zoom_doubles_distance_and_quarters_the_pixels() {
        let pixels = |zoom: f64| {
            let mut studio = Studio::new(&world(zoom, 1, 1, vec![Object::new("cube", [0.0, 0.0])]))
                .expect("one photograph is allowed");
            let photograph = studio.photographs()[0];
            (photograph.distance, subject(&take(&mut studio, &photograph)).0 as f32)
        };
        let ((near, large), (far, small)) = (pixels(2.0), pixels(4.0));
        assert_eq!(far, 2.0 * near);
        assert!((3.0..5.5).contains(&(large / small)), "{large} and {small}");
    }

    #[test]
    fn yaw_0_shows_the_front_and_90_the_right_side() {
        let studio = Studio::new(&world(2.0, 4, 2, vec![Object::new("car", [0.0, 0.0])]))
            .expect("eight photographs are allowed");
        let all = studio.photographs();
        let position = |index: usize| {
            studio
                .camera(&all[index])
                .expect("the photograph belongs to this studio")
                .position
        };
        assert!(position(0)[1] > 1.0 && position(0)[0].abs() < 1e-3, "{:?}", position(0));
        assert!(position(1)[0] > 1.0 && position(1)[1].abs() < 1e-3, "{:?}", position(1));
        let above = position(4);
        assert!(above[2] > 1.0 && above[0].abs().max(above[1].abs()) < 1e-3, "{above:?}");
    }

    #[test]
    fn photograph_does_not_depend_on_position_or_surroundings() {
        let mut car = Object::new("car", [0.0, 0.0]);
        car.reward = 1.0;
        let mut other = car.clone();
        (other.coordinates, other.heading) = ([40.0, -3.0], 77.0);
        let mut alone = Studio::new(&world(2.0, 5, 2, vec![car])).expect("ten photographs are allowed");
        let crowd = world(2.0, 5, 2, vec![Object::new("building", [40.0, -3.0]), other]).edit(|world| {
            world.environment_params.predefined_map = 2;
            world.environment_params.light_intensity = 0.1;
            world.environment_params.fog_distance = Some(1.0);
        });
        let mut crowd = Studio::new(&crowd.expect("the world is valid")).expect("twenty photographs are allowed");
        let (all, in_crowd) = (alone.photographs(), crowd.photographs());
        for (photograph, same) in all.iter().zip(&in_crowd[10..]) {
            let (one, two) = (take(&mut alone, photograph), take(&mut crowd, same));
            assert_eq!(
                (&one.rgb, &one.depth, &one.category),
                (&two.rgb, &two.depth, &two.category)
            );
            assert!(one.category.contains(&CATEGORY_POSITIVE));
            assert!(
                two.instance.iter().all(|id| [0, 2].contains(id)),
                "object numbers match the world"
            );
            assert!(
                two.class.contains(&6) && !two.class.contains(&5),
                "the image shows a car and no building"
            );
        }
    }

    #[test]
    fn no_view_shows_a_shaded_side() {
        let mut ball = Object::new("icosphere", [0.0, 0.0]);
        ball.color = driftworld_spec::Color::from_name("white");
        let mut studio = Studio::new(&world(1.5, 8, 1, vec![ball])).expect("eight photographs are allowed");
        for photograph in studio.photographs() {
            let frame = take(&mut studio, &photograph);
            let middle = 3 * (42 * 84 + 42);
            assert!(frame.rgb[middle] > 150, "{photograph:?}: {}", frame.rgb[middle]);
        }
    }

    #[test]
    fn running_a_world_for_photographs_warns() {
        let world = WorldDraft {
            game_mode: driftworld_spec::GameMode::CollectImages,
            ..WorldDraft::default()
        };
        let warnings = crate::Environment::new(world.check().expect("the world is valid")).warnings();
        assert_eq!(warnings, [crate::Warning::ForPhotographs]);
        assert!(warnings[0].to_string().contains("driftworld photograph"));
    }

    #[test]
    fn too_many_photographs_are_refused_up_front() {
        let objects = vec![Object::new("cube", [0.0, 0.0]); 100];
        assert!(Studio::new(&world(2.0, 100, 5, objects.clone())).is_ok());
        let error = Studio::new(&world(2.0, 100, 6, objects)).expect_err("60,000 photographs are too many");
        assert_eq!(error.code(), "env/too-many-photographs");
    }
}
