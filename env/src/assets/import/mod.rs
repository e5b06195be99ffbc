//! Models from glTF 2.0 files: what may be asked for, and the way from bytes to a model. Files that lie are refused where they
//! lie, in the file of the step that meets them. Skins and animations are left out; extensions that compress are refused.

mod accessor;
mod buffers;
mod color;
mod coloring;
mod container;
mod deviation;
mod document;
mod fit;
mod nodes;
mod palette;
mod primitive;
mod simplify;
mod surface;
mod texture;
mod uri;
mod warning;

pub use fit::ColliderKind;
pub use warning::ImportWarning;

use self::palette::Group;
use super::library::{Detail, LibraryModel, MAX_MODEL_REACH};
use crate::EnvError;

/// The largest glTF file, and the largest of each file that it names, in bytes.
pub const MAX_IMPORT_BYTES: usize = 64 << 20;

/// The most nodes of a glTF file.
pub const MAX_IMPORT_NODES: usize = 10_000;

/// How deep nodes may lie in each other, and objects and lists of JSON.
pub const MAX_IMPORT_DEPTH: usize = 64;

/// The most pixels of a texture along each side.
pub const MAX_TEXTURE_SIDE: u32 = 4096;

/// How a glTF file becomes a model.
#[derive(Clone, Debug, PartialEq)]
pub struct ImportOptions {
    /// The class that worlds refer to it by.
    pub class: String,
    /// The model's name within its class, such as "1".
    pub name: String,
    /// How large it becomes.
    pub size: ImportSize,
    /// What the agent bumps into.
    pub collider: ColliderKind,
    /// Name of the material whose colour gives way to an object's `color`. Without it, the material named `main`, if any.
    pub main: Option<String>,
}

/// How large a model becomes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ImportSize {
    /// So many metres for each unit of the file: 1 where the file is in metres, as glTF asks for.
    Scale(f32),
    /// So high in metres.
    Height(f32),
}

/// A model and what was left out of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    /// The model.
    pub model: LibraryModel,
    /// What of the file could not be kept, each kind once.
    pub warnings: Vec<ImportWarning>,
}

/// Hands over a file that lies beside the glTF file, or says why it cannot. It is asked for relative paths that lead into the
/// folder only, with `/` between their parts; whoever follows links must see that they stay there too.
pub type ReadBeside<'a> = dyn FnMut(&str) -> Result<Vec<u8>, String> + 'a;

impl LibraryModel {
    /// A model from the bytes of a `.glb` or `.gltf` file.
    ///
    /// It is turned so that glTF's up (+y) is up and its front (+z) faces +y, stood on the ground, centred above its origin, and
    /// gets up to three coarser levels of detail. A triangle's colour is the mean of base colour, texture and corner colours
    /// over it; at most 64 colours are kept.
    ///
    /// # Errors
    /// [`EnvError::BadModel`] for what is not a sound glTF file within the limits: [`MAX_IMPORT_BYTES`], [`MAX_IMPORT_NODES`],
    /// [`MAX_IMPORT_DEPTH`], [`MAX_MODEL_VERTICES`](crate::MAX_MODEL_VERTICES),
    /// [`MAX_MODEL_TRIANGLES`](crate::MAX_MODEL_TRIANGLES), [`MAX_TEXTURE_SIDE`].
    pub fn from_gltf(bytes: &[u8], options: &ImportOptions, read: &mut ReadBeside) -> Result<Imported, EnvError> {
        if bytes.len() > MAX_IMPORT_BYTES {
            let found = format!("{} bytes", bytes.len());
            return Err(refuse("file", found, format!("at most {MAX_IMPORT_BYTES}")));
        }
        let container = container::open(bytes)?;
        let root = document::parse(container.json)?;
        let mut warnings = warning::Warnings::default();
        warnings.note_left_out(&root);
        let main = document::main_material(&root, options.main.as_deref())?;
        let buffers = buffers::Buffers::load(&root, container.binary, read)?;
        let mut reading = primitive::Reading {
            root: &root,
            buffers: &buffers,
            textures: texture::Textures::new(&root, &buffers, read),
            warnings,
        };
        let mut surface = surface::Surface::default();
        nodes::visit(&root, &mut |mesh, pose, node| {
            surface.add(&mut reading, mesh, pose, node)
        })?;
        surface.stand(options.size)?;
        let groups = palette::groups(&surface, main);
        finish(options, &surface, groups, reading.warnings)
    }
}

/// Levels of detail, a collider and both sides for what is standing in its place.
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
        warnings: warnings.into_list(),
    })
}

/// What is found at a place of a file, and what was expected.
fn refuse(place: impl Into<String>, found: impl Into<String>, expected: impl Into<String>) -> EnvError {
    EnvError::BadModel {
        place: place.into(),
        found: found.into(),
        expected: expected.into(),
    }
}

impl ImportSize {
    /// Metres for each unit of a file in which the model is `height` units high.
    fn factor(self, height: f64) -> Result<f64, EnvError> {
        let (place, asked) = match self {
            Self::Scale(scale) => ("scale", f64::from(scale)),
            Self::Height(metres) => ("height", f64::from(metres)),
        };
        if !(asked > 0.0 && asked.is_finite()) {
            return Err(refuse(place, asked.to_string(), "a number above 0"));
        }
        match self {
            Self::Scale(_) => Ok(asked),
            Self::Height(_) if asked > f64::from(MAX_MODEL_REACH) => Err(refuse(
                place,
                format!("{asked} m"),
                format!("at most {MAX_MODEL_REACH} m"),
            )),
            Self::Height(_) if height > 0.0 => Ok(asked / height),
            Self::Height(_) => Err(refuse(place, "a flat model, of no height", "a scale in its place")),
        }
    }
}
