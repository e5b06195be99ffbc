//! The kinds of images there are, and how each is kept in a PNG file. What a pixel means is decided in `env`.

use crate::env::{Frame, Target, category_color};
use crate::spec::Modality;
use clap::ValueEnum;
use serde::Serialize;

use crate::report::ReportError;
use crate::report::picture::{Gray, Picture};

/// The greatest number of a 16-bit image.
const FULL: f32 = 65_535.0;

/// One kind of image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, ValueEnum, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Kind {
    Rgb,
    Depth,
    Segmentation,
    Class,
    Instance,
}

impl From<Modality> for Kind {
    fn from(modality: Modality) -> Self {
        match modality {
            Modality::Rgb => Self::Rgb,
            Modality::Depth => Self::Depth,
            Modality::Segmentation => Self::Segmentation,
            Modality::Class => Self::Class,
            Modality::Instance => Self::Instance,
        }
    }
}

impl From<Kind> for Modality {
    fn from(kind: Kind) -> Self {
        match kind {
            Kind::Rgb => Self::Rgb,
            Kind::Depth => Self::Depth,
            Kind::Segmentation => Self::Segmentation,
            Kind::Class => Self::Class,
            Kind::Instance => Self::Instance,
        }
    }
}

impl Kind {
    /// All of them.
    pub(crate) const ALL: [Self; 5] = [Self::Rgb, Self::Depth, Self::Segmentation, Self::Class, Self::Instance];

    /// Its name in arguments, documents and file names.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Rgb => "rgb",
            Self::Depth => "depth",
            Self::Segmentation => "segmentation",
            Self::Class => "class",
            Self::Instance => "instance",
        }
    }

    /// A PNG file's bytes: colours and reward categories as RGB; depths (in levels of so many metres, at most 65535 of them),
    /// classes and instances as 16-bit numbers. Numbers beyond are cut.
    pub(crate) fn to_png(self, frame: &Frame, metres_per_level: f32) -> Result<Vec<u8>, ReportError> {
        let (width, height) = (frame.width, frame.height);
        let picture = |rgb: Vec<u8>| Picture { width, height, rgb }.to_png();
        let gray = |levels: Vec<u16>| Gray { width, height, levels }.to_png();
        let cut = |number: &u32| u16::try_from(*number).unwrap_or(u16::MAX);
        match self {
            Self::Rgb => picture(frame.rgb.clone()),
            Self::Segmentation => picture(frame.category.iter().flat_map(|it| category_color(*it)).collect()),
            Self::Depth => {
                let level = |metres: &f32| (metres / metres_per_level + 0.5).min(FULL) as u16;
                gray(frame.depth.iter().map(level).collect())
            }
            Self::Class => gray(frame.class.clone()),
            Self::Instance => gray(frame.instance.iter().map(cut).collect()),
        }
    }
}

/// The images of a frame that are wanted.
pub(crate) fn target<'a>(frame: &'a mut Frame, kinds: &[Kind], supersampling: u32) -> Target<'a> {
    let mut target = Target {
        supersampling,
        ..frame.target()
    };
    let wanted = |kind: Kind| kinds.contains(&kind);
    target.rgb = target.rgb.filter(|_| wanted(Kind::Rgb));
    target.depth = target.depth.filter(|_| wanted(Kind::Depth));
    target.category = target.category.filter(|_| wanted(Kind::Segmentation));
    target.class = target.class.filter(|_| wanted(Kind::Class));
    target.instance = target.instance.filter(|_| wanted(Kind::Instance));
    target
}

/// The finest of millimetres, centimetres and decimetres by which twice a distance can be told.
pub(crate) fn metres_per_level(distance: f32) -> f32 {
    let fine = [0.001, 0.01].into_iter().find(|level| 2.0 * distance < level * FULL);
    fine.unwrap_or(0.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depths_are_as_fine_as_the_distance_allows() {
        assert_eq!([2.0, 40.0, 900.0].map(metres_per_level), [0.001, 0.01, 0.1]);
    }
}
