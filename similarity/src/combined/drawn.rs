//! [`DrawnMeasure`]: compares two distributions of one parameter, and normalises the result.

use std::collections::BTreeSet;

use driftworld_spec::{Distribution, MeasureName, Parameter, ParameterType};

use crate::combined::value::share;
use crate::distribution::{
    Measured, Method, bures_wasserstein, circular_wasserstein_1, color_wasserstein_1, color_wasserstein_2,
    draws_headings, energy, hellinger, jensen_shannon, placement_wasserstein_1, placement_wasserstein_2,
    shares_wasserstein_1, total_variation, wasserstein_1, wasserstein_2,
};
use crate::scalar::choice_mismatch;
use crate::{ColorMeasure, MetricProperties};

/// Up to this number of distributions, all pairs are compared to find the widest.
const ALL_PAIRS: usize = 24;

/// How two distributions of one parameter are compared.
#[derive(Clone, Debug)]
pub(super) struct DrawnMeasure {
    measure: Option<MeasureName>,
    has_headings: bool,
    /// The largest distance between two distributions that the task's declared values allow. `None` if that is infinite:
    /// numbers are then not normalised.
    widest: Option<f64>,
    can_differ: bool,
    /// Whether points come from different families, or colours from both lists and densities; these can only be compared by
    /// samples.
    is_mixed: bool,
    /// The measure of single colours, if distributions are compared by transporting colours.
    colors: Option<ColorMeasure>,
}

/// A comparison: the measure's name, the method, the raw number, and the normalised one, which may be above 1.
pub(super) type Found = (&'static str, Option<Method>, f64, f64);

impl DrawnMeasure {
    /// The measure that the parameter requests, or its type's default; `all` are the distributions at the ends of the declared
    /// ranges.
    pub(super) fn of(parameter: &Parameter, all: &[Distribution]) -> Self {
        let measure = parameter.compare.as_ref().and_then(|compare| compare.measure);
        let kinds = [false, true].map(|colors| all.iter().any(|own| own.draws_colors() == colors));
        let families = all.iter().filter_map(|own| own.planar_moments().map(|_| own.name()));
        let families: BTreeSet<&str> = families.collect();
        let has_transport = kinds[1] || (parameter.kind == ParameterType::Color && requires_transport(measure));
        let colors = has_transport && measure != Some(MeasureName::SameOrNot);
        let mut this = Self {
            measure,
            colors: colors.then(|| color_measure_of(measure)),
            has_headings: parameter.kind == ParameterType::Heading || all.iter().any(draws_headings),
            widest: Some(1.0),
            can_differ: all.len() > 1,
            is_mixed: families.len() > 1 || (colors && kinds == [true; 2]),
        };
        let widest = this.widest_of(all);
        this.widest = (widest != f64::INFINITY).then_some(if is_usable(widest) { widest } else { 1.0 });
        this
    }

    /// The largest distance between two distributions; 0 if all are equal. If there are many, compares only the one farthest
    /// from the first with all others: the result is at least half of the largest if the triangle inequality holds.
    fn widest_of(&self, all: &[Distribution]) -> f64 {
        let raw = |a: &Distribution, b: &Distribution| self.raw(a, b).2;
        if all.len() <= ALL_PAIRS {
            let pairs = all
                .iter()
                .enumerate()
                .flat_map(|(index, a)| all[..index].iter().map(move |b| (a, b)));
            pairs.map(|(a, b)| raw(a, b)).fold(0.0, f64::max)
        } else {
            let farthest = |from: &Distribution| {
                let far = all.iter().map(|other| (other, raw(from, other)));
                far.fold((&all[0], 0.0), |best, next| if next.1 > best.1 { next } else { best })
            };
            farthest(farthest(&all[0]).0).1
        }
    }

    /// The metric properties of the measure. Between points of different families the triangle inequality may fail by the
    /// sampling error.
    pub(super) fn properties(&self) -> MetricProperties {
        match self.measure {
            Some(MeasureName::SameOrNot) => MetricProperties::Metric,
            Some(MeasureName::BuresWasserstein) => MetricProperties::Pseudometric,
            _ if self.is_mixed => MetricProperties::Distance,
            _ => self.colors.map_or(MetricProperties::Metric, ColorMeasure::properties),
        }
    }

    /// Whether the declared values bound the distance.
    pub(super) fn is_bounded(&self) -> bool {
        self.widest.is_some()
    }

    /// Whether the declared values allow more than one distribution of the parameter.
    pub(super) fn can_differ(&self) -> bool {
        self.can_differ
    }

    /// Compares two distributions.
    pub(super) fn between(&self, a: &Distribution, b: &Distribution) -> Found {
        let (name, method, raw) = self.raw(a, b);
        let normalised = if method.is_none() {
            raw
        } else {
            share(raw, self.widest.unwrap_or(1.0))
        };
        (name, method, raw, normalised)
    }

    /// The measure's name, the method, and the number; "same or not" has no method.
    fn raw(&self, a: &Distribution, b: &Distribution) -> (&'static str, Option<Method>, f64) {
        let same_or_not = || ("same or not", None, choice_mismatch(a, b));
        if self.measure == Some(MeasureName::SameOrNot) {
            return same_or_not();
        }
        if let Some(colors) = self.colors {
            return between_colors(a, b, colors, self.measure).unwrap_or_else(same_or_not);
        }
        let found = |name, measured: Option<Measured>| measured.map(|found| (name, Some(found.method), found.value));
        let requested = match self.measure {
            Some(MeasureName::Wasserstein1) => found("planar wasserstein-1 / widest", placement_wasserstein_1(a, b)),
            Some(MeasureName::Wasserstein2) => found("planar wasserstein-2 / widest", placement_wasserstein_2(a, b))
                .or_else(|| found("wasserstein-2 / widest", wasserstein_2(a, b))),
            Some(MeasureName::TotalVariation) => found("total variation / widest", total_variation(a, b)),
            Some(MeasureName::Hellinger) => found("hellinger / widest", hellinger(a, b)),
            Some(MeasureName::JensenShannon) => found("jensen-shannon / widest", jensen_shannon(a, b)),
            Some(MeasureName::Energy) => found("energy / widest", energy(a, b)),
            Some(MeasureName::BuresWasserstein) => found(
                "bures-wasserstein / widest",
                bures_wasserstein(a, b).map(Measured::closed),
            ),
            _ => None,
        };
        if let Some(requested) = requested {
            return requested;
        }
        if self.has_headings
            && let Some(circular) = found("circular wasserstein-1 / widest", circular_wasserstein_1(a, b))
        {
            return circular;
        }
        found("planar wasserstein-2 / widest", placement_wasserstein_2(a, b))
            .or_else(|| found("wasserstein-1 / widest", wasserstein_1(a, b)))
            .or_else(|| found("total variation / widest", total_variation(a, b)))
            .or_else(|| found("wasserstein-1 of shares / widest", shares_wasserstein_1(a, b)))
            .unwrap_or_else(same_or_not)
    }
}

/// Whether numbers can be divided by this width.
fn is_usable(width: f64) -> bool {
    width > 0.0 && width.is_finite()
}

/// Whether a measure requires transport, so that lists of colours are also compared by transport.
fn requires_transport(measure: Option<MeasureName>) -> bool {
    use MeasureName::{Cie76, Ciede2000, Hyab, Oklab, Srgb, Wasserstein1, Wasserstein2};
    matches!(
        measure,
        Some(Srgb | Cie76 | Ciede2000 | Oklab | Hyab | Wasserstein1 | Wasserstein2)
    )
}

/// The measure by which single colours are compared.
fn color_measure_of(measure: Option<MeasureName>) -> ColorMeasure {
    match measure {
        Some(MeasureName::Srgb) => ColorMeasure::Srgb,
        Some(MeasureName::Cie76) => ColorMeasure::Cie76,
        Some(MeasureName::Ciede2000) => ColorMeasure::Ciede2000,
        Some(MeasureName::Hyab) => ColorMeasure::Hyab,
        _ => ColorMeasure::Oklab,
    }
}

/// Wasserstein-1 of colours, or Wasserstein-2 if requested.
fn between_colors(
    a: &Distribution,
    b: &Distribution,
    by: ColorMeasure,
    requested: Option<MeasureName>,
) -> Option<(&'static str, Option<Method>, f64)> {
    let (name, measured) = if requested == Some(MeasureName::Wasserstein2) {
        ("wasserstein-2 of oklab / widest", color_wasserstein_2(a, b, by)?)
    } else {
        let name = match by {
            ColorMeasure::Srgb => "wasserstein-1 of srgb / widest",
            ColorMeasure::Cie76 => "wasserstein-1 of cie76 / widest",
            ColorMeasure::Ciede2000 => "wasserstein-1 of ciede2000 / widest",
            ColorMeasure::Oklab => "wasserstein-1 of oklab / widest",
            ColorMeasure::Hyab => "wasserstein-1 of hyab / widest",
        };
        (name, color_wasserstein_1(a, b, by)?)
    };
    Some((name, Some(measured.method), measured.value))
}
