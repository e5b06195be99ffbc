//! [`Album`]: shows photographs of a world's objects, one per step, in worlds made for photographs.

use driftworld_env::{Catalogue, Frame, Photograph, Studio};
use driftworld_spec::World;

use crate::error::UnityError;

/// The photographs of a world, and the current one.
#[derive(Clone, Debug)]
pub(super) struct Album {
    studio: Studio,
    /// Never empty.
    photographs: Vec<Photograph>,
    /// Index of the current photograph.
    current: usize,
    frame: Frame,
}

impl Album {
    /// Opens an album at its first photograph.
    ///
    /// # Errors
    /// The reason why there are no photographs: no objects, or too many views of them.
    pub(super) fn open(world: &World, catalogue: &Catalogue) -> Result<Self, String> {
        let studio = Studio::with_catalogue(world, catalogue).map_err(|error| error.to_string())?;
        let photographs = studio.photographs();
        if photographs.is_empty() {
            return Err("found no objects, expected some to photograph".to_owned());
        }
        let [width, height] = studio.picture_size();
        Ok(Self {
            studio,
            photographs,
            current: 0,
            frame: Frame::new(width, height),
        })
    }

    /// Moves on to the next photograph; returns whether there is one.
    pub(super) fn advance(&mut self) -> bool {
        let has_next = self.current + 1 < self.photographs.len();
        self.current += usize::from(has_next);
        has_next
    }

    /// The current photograph.
    pub(super) fn picture(&mut self) -> Result<&Frame, UnityError> {
        let supersampling = self.studio.supersampling();
        let mut target = self.frame.target();
        target.supersampling = supersampling;
        self.studio.take(&self.photographs[self.current], &mut target)?;
        Ok(&self.frame)
    }

    /// The state vector: the object's number, from 1, the camera's position in the world in metres, and its heading in degrees.
    pub(super) fn state(&self, world: &World) -> Vec<f32> {
        let photograph = &self.photographs[self.current];
        let object = &world.objects[photograph.object];
        let yaw = (photograph.yaw_deg + object.heading as f32).rem_euclid(360.0);
        let level = photograph.distance * libm::cosf(photograph.elevation_deg.to_radians());
        let [x, y] = object.coordinates.map(|metres| metres as f32);
        let (sin, cos) = (libm::sinf(yaw.to_radians()), libm::cosf(yaw.to_radians()));
        let heading = (yaw + 180.0).rem_euclid(360.0);
        vec![
            (photograph.object + 1) as f32,
            x + sin * level,
            y + cos * level,
            heading,
        ]
    }
}
