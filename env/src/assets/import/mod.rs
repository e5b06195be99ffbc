//! Imports models from glTF 2.0 files. Each step refuses faulty input and names its location. Skins and animations are left
//! out; compression extensions are refused.

mod accessor;
mod buffers;
mod color;
mod coloring;
mod container;
mod deviation;
mod document;
mod fit;
mod limits;
mod nodes;
mod options;
mod palette;
mod primitive;
mod refusal;
mod simplify;
mod surface;
mod texture;
mod uri;
mod warning;

pub use limits::{MAX_IMPORT_BYTES, MAX_IMPORT_DEPTH, MAX_IMPORT_NODES, MAX_TEXTURE_SIDE};
pub use options::{ImportOptions, ImportSize};
pub use uri::ReadBeside;
pub use warning::ImportWarning;

use self::palette::Group;
use self::refusal::{at_most, refuse};
use super::library::{Detail, LibraryModel};
use crate::EnvError;

/// A model, with warnings about what was left out of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    /// The model.
    pub model: LibraryModel,
    /// Features of the file that were left out, each kind once.
    pub warnings: Vec<ImportWarning>,
}

impl LibraryModel {
    /// Converts the bytes of a `.glb` or `.gltf` file to a model.
    ///
    /// The model is rotated so that glTF's up (+y) is up and its front (+z) faces +y, placed on the ground, and centred above
    /// its origin. It gets up to three coarser levels of detail. A triangle has one colour, the mean over its base colour,
    /// texture and vertex colours; at most 64 colours are kept.
    ///
    /// # Errors
    /// [`EnvError::BadModel`] if the file is not valid glTF within the limits: [`MAX_IMPORT_BYTES`], [`MAX_IMPORT_NODES`],
    /// [`MAX_IMPORT_DEPTH`], [`MAX_MODEL_VERTICES`](crate::MAX_MODEL_VERTICES),
    /// [`MAX_MODEL_TRIANGLES`](crate::MAX_MODEL_TRIANGLES), [`MAX_TEXTURE_SIDE`].
    pub fn from_gltf(bytes: &[u8], options: &ImportOptions, read: &mut ReadBeside) -> Result<Imported, EnvError> {
        at_most(MAX_IMPORT_BYTES, bytes.len(), "bytes", "file")?;
        let (json, binary) = container::open(bytes)?;
        let root = document::parse(json)?;
        let main = document::main_material(&root, options.main.as_deref())?;
        let buffers = buffers::Buffers::load(&root, binary, read)?;
        let mut reading = primitive::Reading {
            buffers: &buffers,
            textures: texture::Textures::new(&buffers, read),
            warnings: warning::left_out(&root),
        };
        let mut surface = surface::Surface::default();
        nodes::visit(&root, &mut |mesh, pose, node| {
            surface.add(&mut reading, mesh, pose, node)
        })?;
        surface.place_on_ground(options.size)?;
        let groups = palette::groups(&surface, main);
        finish(options, &surface, groups, reading.warnings)
    }
}

/// Adds levels of detail, a collider and back faces to a surface that has its final size and position.
fn finish(
    options: &ImportOptions,
    surface: &surface::Surface,
    groups: Vec<Group>,
    warnings: warning::Warnings,
) -> Result<Imported, EnvError> {
    let collider = options.collider.fit(surface);
    let (corners, groups) = palette::welded(&surface.corners, groups);
    let mut levels = vec![Detail {
        error: 0.0,
        triangles: groups.iter().map(|group| group.triangles.clone()).collect(),
    }];
    levels.extend(simplify::levels(&corners, &levels[0].triangles));
    for level in &mut levels {
        for (group, triangles) in groups.iter().zip(&mut level.triangles) {
            if group.two_sided {
                let backs: Vec<[u32; 3]> = triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
                triangles.extend(backs);
            }
        }
    }
    let paints = groups.iter().map(|group| group.paint).collect();
    let (class, name) = (options.class.clone(), options.name.clone());
    let model = LibraryModel::checked(class, name, collider, corners, paints, levels)
        .map_err(|(found, expected)| refuse("model", found, expected))?;
    Ok(Imported {
        model,
        warnings: warnings.into_iter().collect(),
    })
}
