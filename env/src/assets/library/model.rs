//! [`LibraryModel`]: one model of a library, with its colours, levels of detail and collider.

use super::{
    MAX_MODEL_LEVELS, MAX_MODEL_PARTS, MAX_MODEL_REACH, MAX_MODEL_TRIANGLES, MAX_MODEL_VERTICES, MAX_NAME_BYTES,
};
use crate::assets::{Asset, ColliderShape, Mesh, Paint, Part};

/// A checked model of a library, in metres, standing on the ground, with levels of detail.
#[derive(Clone, Debug, PartialEq)]
pub struct LibraryModel {
    pub(crate) class: String,
    pub(crate) name: String,
    pub(crate) collider: ColliderShape,
    /// Corners of all levels, in metres.
    pub(super) corners: Vec<[f32; 3]>,
    /// The colours; every level has a list of triangles for each.
    pub(super) paints: Vec<Paint>,
    /// Levels of detail, from the full model to the coarsest.
    pub(super) levels: Vec<Detail>,
}

/// One level of detail of a model.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Detail {
    /// Largest distance of the surface from the full model's, in metres.
    pub(crate) error: f32,
    /// The triangles of each of the model's colours.
    pub(crate) triangles: Vec<Vec<[u32; 3]>>,
}

/// A fault in a model's parts: what was found, and what was expected.
pub(crate) type Fault = (String, String);

impl LibraryModel {
    /// Builds a model from these parts, or returns the first fault.
    pub(crate) fn checked(
        class: String,
        name: String,
        collider: ColliderShape,
        corners: Vec<[f32; 3]>,
        paints: Vec<Paint>,
        levels: Vec<Detail>,
    ) -> Result<Self, Fault> {
        for (what, text) in [("class", &class), ("model", &name)] {
            if text.trim().is_empty() || text.len() > MAX_NAME_BYTES || text.chars().any(char::is_control) {
                let found = format!("a {what} of {} bytes", text.len());
                let expected = format!("1 to {MAX_NAME_BYTES} bytes of printable text");
                return Err((found, expected));
            }
        }
        let within = |what: &str, found: usize, most: usize| match found {
            0 => Err((format!("no {what}"), format!("1 to {most}"))),
            _ if found > most => Err((format!("{found} {what}"), format!("at most {most}"))),
            _ => Ok(()),
        };
        within("corners", corners.len(), MAX_MODEL_VERTICES)?;
        within("colours", paints.len(), MAX_MODEL_PARTS)?;
        within("levels", levels.len(), MAX_MODEL_LEVELS)?;
        let reaches = |metres: &f32| metres.abs() <= MAX_MODEL_REACH;
        if let Some(bad) = corners.iter().find(|corner| !corner.iter().all(reaches)) {
            return Err((
                format!("a corner at {bad:?}"),
                format!("numbers in ±{MAX_MODEL_REACH} m"),
            ));
        }
        let colors = |paint: &Paint| match *paint {
            Paint::Main(color) | Paint::Fixed(color) => color,
        };
        let shines = |channel: &f32| (0.0..=1.0).contains(channel);
        if let Some(bad) = paints.iter().map(colors).find(|color| !color.iter().all(shines)) {
            return Err((format!("a colour {bad:?}"), "channels in 0..1".into()));
        }
        for (k, level) in levels.iter().enumerate() {
            let total = level.triangles.iter().map(Vec::len).sum::<usize>();
            within(&format!("triangles in level {k}"), total, MAX_MODEL_TRIANGLES)?;
            if level.triangles.len() != paints.len() {
                let expected = format!("{}, one for each colour", paints.len());
                return Err((format!("{} lists of triangles", level.triangles.len()), expected));
            }
            let last = corners.len() as u32 - 1;
            if let Some(bad) = level
                .triangles
                .iter()
                .flatten()
                .flatten()
                .find(|corner| **corner > last)
            {
                return Err((format!("a triangle with corner {bad}"), format!("0 to {last}")));
            }
            let before = k.checked_sub(1).map(|k| levels[k].error);
            let rises = before.map_or(level.error == 0.0, |before| level.error >= before);
            if !rises || level.error > MAX_MODEL_REACH {
                let found = format!("an error of {} m in level {k}", level.error);
                return Err((found, "0 in level 0, then rising".into()));
            }
        }
        if !is_valid(&collider) {
            let expected = format!("sizes above 0, up to {MAX_MODEL_REACH} m");
            return Err((format!("a collider {collider:?}"), expected));
        }
        Ok(Self {
            class,
            name,
            collider,
            corners,
            paints,
            levels,
        })
    }

    /// The class by which worlds refer to it.
    pub fn class(&self) -> &str {
        &self.class
    }

    /// The model's name within its class, usually "1", "2" and so on.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The model's collider.
    pub fn collider(&self) -> &ColliderShape {
        &self.collider
    }

    /// Number of levels of detail, including the full model: 1 to [`MAX_MODEL_LEVELS`].
    pub fn num_levels(&self) -> usize {
        self.levels.len()
    }

    /// Number of triangles of a level and its largest error in metres; level 0 is the full model, with error 0.
    pub fn level(&self, level: usize) -> Option<(usize, f32)> {
        let level = self.levels.get(level)?;
        Some((level.triangles.iter().map(Vec::len).sum(), level.error))
    }

    /// Converts the model to an asset for drawing.
    pub fn asset(&self) -> Asset {
        let levels = self.levels.iter().map(|level| (level.error, self.parts(level)));
        Asset::of_levels(levels.collect(), self.collider.clone())
    }

    /// The model at a fixed level of detail, for inspection; `None` if there is no such level.
    pub fn asset_at(&self, level: usize) -> Option<Asset> {
        let parts = self.parts(self.levels.get(level)?);
        let whole = self.asset();
        let asset = Asset::of_levels(vec![(0.0, parts)], self.collider.clone());
        // Keeps the full model's dimensions for placing it, since coarse levels may be smaller.
        Some(Asset {
            height: whole.height,
            radius: whole.radius,
            ..asset
        })
    }

    /// A level's triangles by colour, each with only the corners it needs.
    fn parts(&self, level: &Detail) -> Vec<Part> {
        const UNUSED: u32 = u32::MAX;
        let mut new_index = vec![UNUSED; self.corners.len()];
        let mut parts = Vec::new();
        for (paint, triangles) in self.paints.iter().zip(&level.triangles) {
            if triangles.is_empty() {
                continue;
            }
            let mut mesh = Mesh::default();
            for triangle in triangles {
                let corners = triangle.map(|corner| {
                    let new_index = &mut new_index[corner as usize];
                    if *new_index == UNUSED {
                        *new_index = mesh.corners.len() as u32;
                        mesh.corners.push(self.corners[corner as usize]);
                    }
                    *new_index
                });
                mesh.triangles.push(corners);
            }
            // Clears only the entries in use, so that many colours stay cheap.
            triangles
                .iter()
                .flatten()
                .for_each(|corner| new_index[*corner as usize] = UNUSED);
            parts.push(Part::new(mesh, *paint));
        }
        parts
    }
}

/// Whether all dimensions of a collider are valid.
fn is_valid(collider: &ColliderShape) -> bool {
    let size = |metres: &f32| *metres > 0.0 && *metres <= 2.0 * MAX_MODEL_REACH;
    match collider {
        ColliderShape::Box { half } => half.iter().all(size),
        ColliderShape::Ball { radius } => size(radius),
        ColliderShape::Cylinder { radius, half_height } | ColliderShape::Capsule { radius, half_height } => {
            size(radius) && size(half_height)
        }
        ColliderShape::Hull { points } => {
            let reaches = |metres: &f32| metres.abs() <= MAX_MODEL_REACH;
            (4..=MAX_HULL_POINTS).contains(&points.len()) && points.iter().flatten().all(reaches)
        }
    }
}

/// Maximum number of points of a hull.
pub(crate) const MAX_HULL_POINTS: usize = 64;
