//! Interpolates between two values, and between two distributions.

use driftworld_spec::{
    ChannelSpread, Channels, Color, Distribution, Number, Parameter, ParameterType, Spread, Value, Variant,
};

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
        let between = map(&from, |number| {
            let end = ends.next().expect("equal skeletons have the same number of numbers");
            number + (end - number) * t
        });
        return Some(with_colors_interpolated(with_rounded_counts(between), &from, &to, t));
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
    match (distribution, other) {
        (Distribution::ColorNormal { mean, std }, Distribution::ColorNormal { .. }) => Distribution::ColorNormal {
            mean: mean.clone(),
            std: each(std),
        },
        (
            Distribution::ColorPerturb {
                value,
                noise,
                low,
                high,
                channels,
            },
            Distribution::ColorPerturb { .. },
        ) => Distribution::ColorPerturb {
            value: value.clone(),
            noise: each(noise),
            low: Some(low.clone().unwrap_or(Channels([0.0; 3]))),
            high: Some(high.clone().unwrap_or(Channels([1.0; 3]))),
            channels: *channels,
        },
        (Distribution::ColorHsv { hue, saturation, value }, Distribution::ColorHsv { .. }) => Distribution::ColorHsv {
            hue: hue.or(Some([0.0, 360.0])),
            saturation: saturation.or(Some([0.0, 1.0])),
            value: value.or(Some([0.0, 1.0])),
        },
        (Distribution::Gaussian { mean, .. }, Distribution::Gaussian { .. })
            if skeleton(distribution) != skeleton(other) =>
        {
            Distribution::Gaussian {
                mean: *mean,
                std: None::<Spread>,
                correlation: None,
                covariance: distribution.gaussian_covariance(),
            }
        }
        _ => distribution.clone(),
    }
}

/// Corrects an interpolated distribution of colours: colours are interpolated in Oklab, hues the shorter way round.
fn with_colors_interpolated(between: Distribution, from: &Distribution, to: &Distribution, t: f64) -> Distribution {
    use Distribution::{ColorHsv, ColorNormal, ColorPerturb, ColorUniform, Mixture};
    let color = |a: &Channels, b: &Channels| {
        if a == b {
            a.clone()
        } else {
            Channels::from(Color(a.0).mix(Color(b.0), t))
        }
    };
    match (between, from, to) {
        (ColorUniform { channels, .. }, ColorUniform { from: a, to: b, .. }, ColorUniform { from: c, to: d, .. }) => {
            ColorUniform {
                from: color(a, c),
                to: color(b, d),
                channels,
            }
        }
        (ColorNormal { std, .. }, ColorNormal { mean: a, .. }, ColorNormal { mean: b, .. }) => {
            ColorNormal { mean: color(a, b), std }
        }
        (
            ColorPerturb {
                noise,
                low,
                high,
                channels,
                ..
            },
            ColorPerturb { value: a, .. },
            ColorPerturb { value: b, .. },
        ) => ColorPerturb {
            value: color(a, b),
            noise,
            low,
            high,
            channels,
        },
        (
            ColorHsv { saturation, value, .. },
            ColorHsv { hue: Some([a, b]), .. },
            ColorHsv { hue: Some([c, d]), .. },
        ) => {
            let (middle, other) = (f64::midpoint(*a, *b), f64::midpoint(*c, *d));
            let turn = (other - middle + 180.0).rem_euclid(360.0) - 180.0;
            let (middle, half) = (middle + turn * t, 0.5 * ((b - a) + ((d - c) - (b - a)) * t));
            // Wraps into the range that documents allow, which is within one turn of 0..360.
            let middle = middle.rem_euclid(360.0);
            ColorHsv {
                hue: Some([middle - half, middle + half]),
                saturation,
                value,
            }
        }
        (Mixture { parts, weights }, Mixture { parts: a, .. }, Mixture { parts: b, .. }) => Mixture {
            parts: parts
                .into_iter()
                .zip(a.iter().zip(b))
                .map(|(part, (a, b))| with_colors_interpolated(part, a, b, t))
                .collect(),
            weights,
        },
        (other, ..) => other,
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
fn with_rounded_counts(distribution: Distribution) -> Distribution {
    match distribution {
        Distribution::IntegerUniform { low, high } => Distribution::IntegerUniform {
            low: low.round(),
            high: high.round(),
        },
        Distribution::Binomial { n, p } => Distribution::Binomial { n: n.round(), p },
        Distribution::Grid {
            low,
            high,
            columns,
            rows,
            jitter,
            order,
        } => Distribution::Grid {
            low,
            high,
            columns: columns.round(),
            rows: rows.round(),
            jitter,
            order,
        },
        Distribution::Mixture { parts, weights } => Distribution::Mixture {
            parts: parts.into_iter().map(with_rounded_counts).collect(),
            weights,
        },
        other => other,
    }
}
