//! Interpolates between two values, and between two distributions.

use driftworld_spec::{ChannelSpread, Channels, Color, Distribution, Number, Parameter, ParameterType, Value, Variant};

/// Interpolates between two values; `None` if that is impossible. `listed` says whether the domain is a list of choices.
pub(crate) fn interpolate(
    parameter: &Parameter,
    listed: bool,
    from: &Value,
    to: &Value,
    t: f64,
    (a, b): (&Variant, &Variant),
) -> Option<Value> {
    let lerp = |from: f64, to: f64| from + (to - from) * t;
    match (from, to) {
        (Value::Color(from), Value::Color(to)) => Some(Value::Color(from.mix(*to, t))),
        (Value::Point(from), Value::Point(to)) => Some(Value::Point([lerp(from[0], to[0]), lerp(from[1], to[1])])),
        (Value::Vector(from), Value::Vector(to)) => Some(Value::Vector(
            from.iter().zip(to).map(|(from, to)| lerp(*from, *to)).collect(),
        )),
        (Value::Distribution(from), Value::Distribution(to)) => {
            between_distributions(&a.settle(from), &b.settle(to), t)
                .map(|between| Value::Distribution(Box::new(map(&between, Number::Literal))))
        }
        (Value::Layout(from), Value::Layout(to)) => Some(Value::Layout(Box::new(from.toward(to, t)))),
        _ if listed => None,
        (Value::Number(from), Value::Number(to)) if parameter.kind == ParameterType::Heading => {
            if let Some([low, high]) = parameter.range.filter(|[low, high]| high - low < 360.0) {
                // Stays within the arc that the parameter declares, even if it is the longer way round.
                let along = |degrees: f64| (degrees - low).rem_euclid(360.0).min(high - low);
                return Some(Value::Number((low + lerp(along(*from), along(*to))).rem_euclid(360.0)));
            }
            let turn = (to - from + 180.0).rem_euclid(360.0) - 180.0;
            Some(Value::Number((from + turn * t).rem_euclid(360.0)))
        }
        (Value::Number(from), Value::Number(to)) => Some(Value::Number(lerp(*from, *to))),
        (Value::Integer(from), Value::Integer(to)) => {
            Some(Value::Integer(lerp(*from as f64, *to as f64).round() as i64))
        }
        _ => None,
    }
}

/// Interpolates distributions of one family number by number; others become a mixture if both draw numbers, points or colours.
fn between_distributions(from: &Distribution, to: &Distribution, t: f64) -> Option<Distribution> {
    let (from, to) = (comparable(from, to), comparable(to, from));
    if skeleton(&from) == skeleton(&to) {
        let mut ends = Vec::new();
        map(&to, |number| {
            ends.push(number);
            number
        });
        let mut ends = ends.into_iter();
        let mut between = map(&from, |number| {
            let end = ends.next().expect("equal skeletons have the same number of numbers");
            number + (end - number) * t
        });
        round_counts(&mut between);
        interpolate_colors(&mut between, &from, &to, t);
        return Some(between);
    }
    let can_mix = if from.draws_cells() || to.draws_cells() {
        // Distributions of cells cannot be part of a mixture.
        false
    } else if from.draws_colors() || to.draws_colors() {
        from.yields(ParameterType::Color) && to.yields(ParameterType::Color)
    } else {
        from.is_planar() == to.is_planar() && (from.is_planar() || from.mean().is_some() == to.mean().is_some())
    };
    can_mix.then(|| Distribution::Mixture {
        parts: vec![from, to],
        weights: Some(vec![1.0 - t, t]),
    })
}

/// Rewrites a distribution in a form shared with the other if the family has several forms: Gaussians by their covariance, one
/// spread per channel, default ends written out.
fn comparable(distribution: &Distribution, other: &Distribution) -> Distribution {
    let each = |spread: &ChannelSpread| ChannelSpread::Each(spread.to_array());
    let mut own = distribution.clone();
    match (&mut own, other) {
        (Distribution::ColorNormal { std, .. }, Distribution::ColorNormal { .. }) => *std = each(std),
        (Distribution::ColorPerturb { noise, low, high, .. }, Distribution::ColorPerturb { .. }) => {
            *noise = each(noise);
            low.get_or_insert(Channels([0.0; 3]));
            high.get_or_insert(Channels([1.0; 3]));
        }
        (Distribution::ColorHsv { hue, saturation, value }, Distribution::ColorHsv { .. }) => {
            hue.get_or_insert([0.0, 360.0]);
            saturation.get_or_insert([0.0, 1.0]);
            value.get_or_insert([0.0, 1.0]);
        }
        (
            Distribution::Gaussian {
                std,
                correlation,
                covariance,
                ..
            },
            Distribution::Gaussian { .. },
        ) if skeleton(distribution) != skeleton(other) => {
            (*std, *correlation) = (None, None);
            *covariance = distribution.gaussian_covariance();
        }
        _ => {}
    }
    own
}

/// Corrects an interpolated distribution of colours: colours are interpolated in Oklab, hues the shorter way round.
fn interpolate_colors(between: &mut Distribution, from: &Distribution, to: &Distribution, t: f64) {
    use Distribution::{ColorHsv, ColorNormal, ColorPerturb, ColorUniform, Mixture};
    let mix = |color: &mut Channels, a: &Channels, b: &Channels| {
        *color = if a == b {
            a.clone()
        } else {
            Channels::from(Color(a.0).mix(Color(b.0), t))
        };
    };
    match (between, from, to) {
        (ColorUniform { from, to, .. }, ColorUniform { from: a, to: b, .. }, ColorUniform { from: c, to: d, .. }) => {
            mix(from, a, c);
            mix(to, b, d);
        }
        (ColorNormal { mean: color, .. }, ColorNormal { mean: a, .. }, ColorNormal { mean: b, .. })
        | (ColorPerturb { value: color, .. }, ColorPerturb { value: a, .. }, ColorPerturb { value: b, .. }) => {
            mix(color, a, b);
        }
        (ColorHsv { hue, .. }, ColorHsv { hue: Some([a, b]), .. }, ColorHsv { hue: Some([c, d]), .. }) => {
            let (middle, other) = (f64::midpoint(*a, *b), f64::midpoint(*c, *d));
            let turn = (other - middle + 180.0).rem_euclid(360.0) - 180.0;
            let (middle, half) = (middle + turn * t, 0.5 * ((b - a) + ((d - c) - (b - a)) * t));
            // Wraps into the range that documents allow, which is within one turn of 0..360.
            let middle = middle.rem_euclid(360.0);
            *hue = Some([middle - half, middle + half]);
        }
        (Mixture { parts, .. }, Mixture { parts: a, .. }, Mixture { parts: b, .. }) => {
            for (part, (a, b)) in parts.iter_mut().zip(a.iter().zip(b)) {
                interpolate_colors(part, a, b, t);
            }
        }
        _ => {}
    }
}

fn map<T>(distribution: &Distribution, mut f: impl FnMut(f64) -> T) -> Distribution<T> {
    let mapped: Result<_, std::convert::Infallible> = distribution.try_map(&mut |number| Ok(f(*number)));
    match mapped {
        Ok(mapped) => mapped,
        Err(never) => match never {},
    }
}

/// The distribution with all numbers set to 0, for comparing forms.
fn skeleton(distribution: &Distribution) -> Distribution {
    map(distribution, |_| 0.0)
}

/// Rounds the numbers that must be integers.
fn round_counts(distribution: &mut Distribution) {
    match distribution {
        Distribution::IntegerUniform { low, high } => (*low, *high) = (low.round(), high.round()),
        Distribution::Binomial { n, .. } => *n = n.round(),
        Distribution::Grid { columns, rows, .. } => (*columns, *rows) = (columns.round(), rows.round()),
        Distribution::Mixture { parts, .. } => parts.iter_mut().for_each(round_counts),
        _ => {}
    }
}
