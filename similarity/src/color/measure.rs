//! [`ColorMeasure`]: the choice of a distance between colours, with its diameter.

use driftworld_spec::Color;
use strum::VariantArray;

use crate::color::cie76::{CIE76_DIAMETER, cie76};
use crate::color::ciede2000::{CIEDE2000_DIAMETER, ciede2000};
use crate::color::hyab::hyab;
use crate::color::lab::Lab;
use crate::color::srgb::srgb_distance;
use crate::{MetricProperties, Oklab};

/// A distance between colours.
///
/// # Example
/// ```
/// use driftworld_similarity::ColorMeasure;
/// use driftworld_spec::Color;
/// let named = |name| Color::from_name(name).unwrap();
/// let far = ColorMeasure::Ciede2000.between(named("blue"), named("yellow"));
/// let near = ColorMeasure::Ciede2000.between(named("blue"), named("navy"));
/// assert!(near < far && far <= ColorMeasure::Ciede2000.diameter());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, strum::VariantArray)]
pub enum ColorMeasure {
    /// [`srgb_distance`], as in the L2Explorer paper.
    Srgb,
    /// [`cie76`].
    Cie76,
    /// [`ciede2000`]. Not a metric.
    Ciede2000,
    /// [`Color::distance`]: the default, a metric close to perception.
    Oklab,
    /// [`hyab`].
    Hyab,
}

impl ColorMeasure {
    /// All measures.
    pub const ALL: &[Self] = Self::VARIANTS;

    /// The distance between two colours, in the measure's own unit.
    pub fn between(self, a: Color, b: Color) -> f64 {
        self.between_prepared(self.prepare(a), self.prepare(b))
    }

    /// The largest distance between two sRGB colours, rounded up in the last digit.
    pub fn diameter(self) -> f64 {
        match self {
            // Black to white.
            Self::Srgb => 1.732_050_807_568_877_2,
            Self::Oklab => 1.0,
            Self::Cie76 => CIE76_DIAMETER,
            Self::Ciede2000 => CIEDE2000_DIAMETER,
            // Blue to lime.
            Self::Hyab => 308.109_02,
        }
    }

    /// The metric properties of the measure.
    pub fn properties(self) -> MetricProperties {
        match self {
            Self::Ciede2000 => MetricProperties::Distance,
            Self::Srgb | Self::Cie76 | Self::Oklab | Self::Hyab => MetricProperties::Metric,
        }
    }

    /// The colour in the measure's colour space: each colour is converted once for many pairs.
    pub(crate) fn prepare(self, color: Color) -> [f64; 3] {
        match self {
            Self::Srgb => color.0,
            Self::Oklab => Oklab::from(color).0,
            Self::Cie76 | Self::Ciede2000 | Self::Hyab => Lab::from(color).0,
        }
    }

    pub(crate) fn between_prepared(self, a: [f64; 3], b: [f64; 3]) -> f64 {
        match self {
            Self::Srgb => srgb_distance(Color(a), Color(b)),
            Self::Oklab => Oklab(a).distance(Oklab(b)),
            Self::Cie76 => cie76(Lab(a), Lab(b)),
            Self::Ciede2000 => ciede2000(Lab(a), Lab(b)),
            Self::Hyab => hyab(Lab(a), Lab(b)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn color() -> impl Strategy<Value = Color> {
        let channel = prop_oneof![Just(0.0), Just(1.0), 0.0..=1.0];
        prop::array::uniform3(channel).prop_map(Color)
    }

    #[test]
    fn diameter_is_the_distance_between_the_farthest_colours() {
        let named = |name| Color::from_name(name).expect("a CSS colour name");
        for (measure, a, b) in [
            (ColorMeasure::Srgb, named("black"), named("white")),
            (ColorMeasure::Oklab, named("black"), named("white")),
            (ColorMeasure::Cie76, named("blue"), named("lime")),
            (ColorMeasure::Hyab, named("blue"), named("lime")),
            (
                ColorMeasure::Ciede2000,
                Color([0.0, 0.0, 0.430_3]),
                Color([0.558_93, 1.0, 0.0]),
            ),
        ] {
            let share = measure.between(a, b) / measure.diameter();
            assert!((1.0 - 1e-7..=1.0 + 1e-12).contains(&share), "{measure:?}: {share}");
        }
    }

    #[test]
    fn ciede2000_can_violate_the_triangle_inequality() {
        let [a, b, c] = [[0.0, 1.0, 0.4], [0.6, 0.8, 0.8], [1.0, 0.0, 1.0]].map(Color);
        let d = |a, b| ColorMeasure::Ciede2000.between(a, b);
        // scikit-image gives 30.3 and 32.0 instead of 108.4.
        assert!(
            d(a, b) + d(b, c) < 0.58 * d(a, c),
            "{} {} {}",
            d(a, b),
            d(b, c),
            d(a, c)
        );
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn measures_satisfy_their_declared_properties(a in color(), b in color(), c in color()) {
            for &measure in ColorMeasure::ALL {
                let d = |a, b| (measure.between(a, b) / measure.diameter()).min(1.0);
                prop_assert_eq!(d(a, a), 0.0);
                prop_assert!((d(a, b) - d(b, a)).abs() < 1e-9);
                prop_assert!((0.0..=1.0).contains(&d(a, b)));
                prop_assert!(measure.between(a, b) <= measure.diameter() * (1.0 + 1e-12), "{measure:?}");
                if a != b {
                    prop_assert!(d(a, b) > 0.0);
                }
                if measure.properties().is_metric() {
                    prop_assert!(d(a, c) <= d(a, b) + d(b, c) + 1e-12, "{measure:?}");
                }
            }
        }
    }
}
