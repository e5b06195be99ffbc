//! [`DrawnMeasure`]: how two distributions of a parameter are compared, and what the number is divided by. Values are in `value.rs`, the
//! measures in `distribution/`.

use std::collections::BTreeSet;

use driftworld_spec::{Distribution, MeasureName, Parameter, ParameterType};

use crate::ColorMeasure;
use crate::combined::value::share;
use crate::distribution::{
    Measured, Method, circular_wasserstein_1, color_wasserstein_1, color_wasserstein_2, draws_headings, extent,
    hellinger, jensen_shannon, planar_wasserstein_2, total_variation, wasserstein_1, wasserstein_2,
};
use crate::scalar::choice_mismatch;

/// How two distributions of one parameter are compared.
#[derive(Clone, Debug)]
pub(super) struct DrawnMeasure {
    measure: Option<MeasureName>,
    headings: bool,
    /// Width of the numbers, or diagonal of the points, that all declared variants together draw.
    width: Option<f64>,
    /// Whether points are drawn by different families, or colours from lists and densities, between which there are only samples.
    mixed: bool,
    /// By which measure the ways of colours are counted, where colours are compared by how far they are apart.
    colors: Option<ColorMeasure>,
}

/// A comparison: the measure's name, how its number was found, the number, and the one that counts, which may be above 1.
pub(super) type Found = (&'static str, Option<Method>, f64, f64);

impl DrawnMeasure {
    /// What the parameter asks for, or what its type has; `all` are its distributions in the declared variants.
    pub(super) fn of(parameter: &Parameter, all: impl Iterator<Item = Distribution>) -> Self {
        let mut corners: Option<[[f64; 2]; 2]> = None;
        let mut families = BTreeSet::new();
        let mut headings = parameter.kind == ParameterType::Heading;
        let measure = parameter.compare.as_ref().and_then(|compare| compare.measure);
        let mut kinds = [false; 2];
        for distribution in all {
            kinds[usize::from(distribution.draws_colors())] = true;
            headings |= draws_headings(&distribution);
            families.insert(distribution.planar_moments().map(|_| distribution.name()));
            if let Some([low, high]) = bounds(&distribution) {
                let [least, most] = corners.unwrap_or([low, high]);
                let join = |axis: usize| [least[axis].min(low[axis]), most[axis].max(high[axis])];
                let [x, y] = [0, 1].map(join);
                corners = Some([[x[0], y[0]], [x[1], y[1]]]);
            }
        }
        let has_ways = kinds[1] || (parameter.kind == ParameterType::Color && asks_for_ways(measure));
        let colors = has_ways && measure != Some(MeasureName::SameOrNot);
        Self {
            measure,
            colors: colors.then(|| ways_of(measure)),
            headings,
            width: corners.map(|[low, high]| libm::hypot(high[0] - low[0], high[1] - low[1])),
            mixed: families.iter().flatten().count() > 1 || (colors && kinds == [true; 2]),
        }
    }

    /// Whether the triangle inequality holds. Between points of different families it may fail by what samples are off.
    pub(super) fn is_metric(&self) -> bool {
        !self.mixed && self.colors.is_none_or(|colors| colors.properties().is_metric())
    }

    /// How far two distributions are apart.
    pub(super) fn between(&self, a: &Distribution, b: &Distribution) -> Found {
        let over_width = |measured: Measured| share(measured.value, self.width.unwrap_or(0.0));
        let as_it_is = |measured: Measured| measured.value;
        let half_turn = |measured: Measured| measured.value / 180.0;
        let found = |name, measured: Option<Measured>, normalise: &dyn Fn(Measured) -> f64| -> Option<Found> {
            let measured = measured?;
            Some((name, Some(measured.method), measured.value, normalise(measured)))
        };
        let same_or_not = || {
            let raw = choice_mismatch(a, b);
            ("same or not", None, raw, raw)
        };
        if let Some(colors) = self.colors {
            return between_colors(a, b, colors, self.measure).unwrap_or_else(same_or_not);
        }
        let asked = match self.measure {
            Some(MeasureName::Wasserstein2) => found("wasserstein-2 / width", wasserstein_2(a, b), &over_width),
            Some(MeasureName::TotalVariation) => found("total variation", total_variation(a, b), &as_it_is),
            Some(MeasureName::Hellinger) => found("hellinger", hellinger(a, b), &as_it_is),
            Some(MeasureName::JensenShannon) => found("jensen-shannon", jensen_shannon(a, b), &as_it_is),
            Some(MeasureName::SameOrNot) => Some(same_or_not()),
            _ => None,
        };
        if let Some(asked) = asked {
            return asked;
        }
        if self.headings {
            let round = circular_wasserstein_1(a, b);
            if let Some(found) = found("circular wasserstein-1 / 180 degrees", round, &half_turn) {
                return found;
            }
        }
        found("wasserstein-1 / width", wasserstein_1(a, b), &over_width)
            .or_else(|| found("planar wasserstein-2 / width", planar_wasserstein_2(a, b), &over_width))
            .or_else(|| found("total variation", total_variation(a, b), &as_it_is))
            .or_else(|| found("total variation of mean shares", shares(a, b), &as_it_is))
            .unwrap_or_else(same_or_not)
    }
}

/// Whether a measure counts ways, so that colours of lists have them, too.
fn asks_for_ways(measure: Option<MeasureName>) -> bool {
    use MeasureName::{Cie76, Ciede2000, Oklab, Srgb, Wasserstein1, Wasserstein2};
    matches!(
        measure,
        Some(Srgb | Cie76 | Ciede2000 | Oklab | Wasserstein1 | Wasserstein2)
    )
}

/// What a colour's way is measured by.
fn ways_of(measure: Option<MeasureName>) -> ColorMeasure {
    match measure {
        Some(MeasureName::Srgb) => ColorMeasure::Srgb,
        Some(MeasureName::Cie76) => ColorMeasure::Cie76,
        Some(MeasureName::Ciede2000) => ColorMeasure::Ciede2000,
        _ => ColorMeasure::Oklab,
    }
}

/// Wasserstein-1 of colours, or Wasserstein-2 where that is asked for, over the largest distance of two colours.
fn between_colors(a: &Distribution, b: &Distribution, by: ColorMeasure, asked: Option<MeasureName>) -> Option<Found> {
    let (name, measured) = if asked == Some(MeasureName::Wasserstein2) {
        ("wasserstein-2 of oklab", color_wasserstein_2(a, b, by)?)
    } else {
        let name = match by {
            ColorMeasure::Srgb => "wasserstein-1 of srgb / largest",
            ColorMeasure::Cie76 => "wasserstein-1 of cie76 / largest",
            ColorMeasure::Ciede2000 => "wasserstein-1 of ciede2000 / largest",
            ColorMeasure::Oklab | ColorMeasure::Hyab => "wasserstein-1 of oklab",
        };
        (name, color_wasserstein_1(a, b, by)?)
    };
    Some((
        name,
        Some(measured.method),
        measured.value,
        measured.value / by.diameter(),
    ))
}

/// The corners between which nearly all of a distribution's numbers or points lie; numbers have the second coordinate 0.
fn bounds(distribution: &Distribution) -> Option<[[f64; 2]; 2]> {
    if let Some([low, high]) = extent(distribution) {
        return Some([[low, 0.0], [high, 0.0]]);
    }
    let moments = distribution.planar_moments()?;
    let reach = [0, 1].map(|axis| 3.0 * moments.covariance[axis][axis].max(0.0).sqrt());
    let corner = |sign: f64| [0, 1].map(|axis| moments.mean[axis] + sign * reach[axis]);
    Some([corner(-1.0), corner(1.0)])
}

/// Half of the sum of the differences of the mean shares.
fn shares(a: &Distribution, b: &Distribution) -> Option<Measured> {
    let (a, b) = (a.mean_shares()?, b.mean_shares()?);
    (a.len() == b.len()).then(|| Measured {
        value: a.iter().zip(&b).map(|(a, b)| (a - b).abs()).sum::<f64>() / 2.0,
        method: Method::Closed,
    })
}
