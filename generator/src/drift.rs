//! [`Drift`]: the variants between two variants of a task. How far apart two variants are is `similarity`'s to say.

use driftworld_spec::{
    ChannelSpread, Channels, Color, Distribution, Domain, DriftSchedule, DriftSwitch, Number, Parameter, ParameterType,
    RegimeDrift, Spread, Value, Variant,
};

use crate::GeneratorError;
use crate::stream::Stream;

/// How far a drift has come, as a function of the progress of what it happens in.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Schedule {
    /// Evenly.
    #[default]
    Linear,
    /// Slowly at first and at last: (1 − cos π·progress) / 2.
    Cosine,
    /// In so many equal steps, from 1 on: the first is taken at `1 / (steps + 1)` of the way, the last at `steps / (steps + 1)`.
    Step {
        /// How many steps.
        steps: u32,
    },
    /// Up to the end and back at once to the beginning, so many times, from 1 on.
    Sawtooth {
        /// How many times.
        periods: u32,
    },
}

impl Schedule {
    /// How far the drift has come, 0..=1, when its surroundings have come `progress`, 0..=1.
    pub fn at(self, progress: f64) -> f64 {
        let progress = progress.clamp(0.0, 1.0);
        match self {
            Self::Linear => progress,
            Self::Cosine => (1.0 - libm::cos(std::f64::consts::PI * progress)) / 2.0,
            Self::Step { steps } => {
                let steps = f64::from(steps.max(1));
                ((progress * (steps + 1.0)).floor() / steps).min(1.0)
            }
            Self::Sawtooth { .. } if progress == 1.0 => 1.0,
            Self::Sawtooth { periods } => (progress * f64::from(periods.max(1))).fract(),
        }
    }
}

impl From<DriftSchedule> for Schedule {
    fn from(schedule: DriftSchedule) -> Self {
        match schedule {
            DriftSchedule::Linear => Self::Linear,
            DriftSchedule::Cosine => Self::Cosine,
            DriftSchedule::Steps(steps) => Self::Step { steps },
            DriftSchedule::Sawtooth(periods) => Self::Sawtooth { periods },
        }
    }
}

/// How values that have nothing between them change: texts, true and false, numbers out of a list.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Switch {
    /// At the fraction that the parameter declares as `switch_at`; a half where it declares none.
    #[default]
    AtPoint,
    /// By chance: at fraction t of the drift a world has the new value with probability t, drawn under this seed.
    Mixture {
        /// The seed.
        seed: u64,
    },
}

/// The way from one variant of a task to another.
///
/// Numbers, points, vectors and the numbers of distributions of one family go straight; headings take the shorter way round, or the way through their range;
/// colours, those of distributions too, go straight in Oklab, so that they change evenly to the eye; distributions of different families are mixed; whatever
/// has nothing in between switches. At 0 and 1 the variants are those that were given.
///
/// # Example
/// ```
/// use driftworld_generator::Drift;
/// use driftworld_spec::TaskSpec;
/// let task = TaskSpec::from_json("t", r#"{ "name": "t", "parameters": {
///     "light": { "role": "variant", "type": "number", "affects": ["O"], "range": [0, 4], "default": 0 } },
///     "variants": { "night": {}, "day": { "light": 2 } } }"#)?;
/// let drift = Drift::new(task.variant("night")?, task.variant("day")?)?;
/// assert_eq!(drift.at(0.25, 0)?.value("light").and_then(|light| light.as_number()), Some(0.5));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Drift {
    from: Variant,
    to: Variant,
    schedule: Schedule,
    switch: Switch,
}

/// The variant at fraction `t`, 0..=1, between two variants of one task: a linear [`Drift`] whose switches are at points.
///
/// # Errors
/// As [`Drift::new`] and [`Drift::at`].
pub fn drift(from: &Variant, to: &Variant, t: f64) -> Result<Variant, GeneratorError> {
    Drift::new(from.clone(), to.clone())?.at(t, 0)
}

impl Drift {
    /// The way from one variant to another of the same task, linear, switching at points.
    ///
    /// # Errors
    /// [`GeneratorError::DifferentTasks`].
    pub fn new(from: Variant, to: Variant) -> Result<Self, GeneratorError> {
        if from.task().name() == to.task().name() {
            Ok(Self {
                from,
                to,
                schedule: Schedule::default(),
                switch: Switch::default(),
            })
        } else {
            Err(GeneratorError::DifferentTasks {
                from: from.id(),
                to: to.id(),
            })
        }
    }

    /// The way that a regime of a scenario declares, from its variant to the one that its drift leads to; mixing switches
    /// draw under the regime's seed.
    ///
    /// # Errors
    /// [`GeneratorError::DifferentTasks`].
    pub fn declared(drift: &RegimeDrift, from: Variant, to: Variant, seed: u64) -> Result<Self, GeneratorError> {
        let switch = match drift.switch {
            DriftSwitch::AtPoint => Switch::AtPoint,
            DriftSwitch::Mixture => Switch::Mixture { seed },
        };
        Ok(Self::new(from, to)?
            .with_schedule(drift.schedule.into())
            .with_switch(switch))
    }

    /// Goes by another schedule.
    #[must_use]
    pub fn with_schedule(mut self, schedule: Schedule) -> Self {
        self.schedule = schedule;
        self
    }

    /// Switches in another way.
    #[must_use]
    pub fn with_switch(mut self, switch: Switch) -> Self {
        self.switch = switch;
        self
    }

    /// The variant when `progress`, 0..=1, has passed, for world number `index`, which only mixing switches look at.
    ///
    /// # Errors
    /// [`GeneratorError::Between`] if a variant on the way breaks a requirement or cannot be drawn from.
    pub fn at(&self, progress: f64, index: u64) -> Result<Variant, GeneratorError> {
        let t = self.schedule.at(progress);
        if t == 0.0 {
            return Ok(self.from.clone());
        }
        if t == 1.0 {
            return Ok(self.to.clone());
        }
        let changes = self.from.values().iter().filter_map(|(name, from)| {
            let to = self.to.value(name)?;
            (from != to).then(|| (name.clone(), self.between(name, from, to, t, index)))
        });
        let name = format!("{}..{}@{}", self.from.name(), self.to.name(), (t * 1e6).round() / 1e6);
        self.from.with(&name, changes).map_err(GeneratorError::Between)
    }

    fn between(&self, name: &str, from: &Value, to: &Value, t: f64, index: u64) -> Value {
        let parameter = &self.from.task().parameters()[name];
        let listed = matches!(parameter.domain(), Some(Domain::Choices(_)));
        interpolate(parameter, listed, from, to, t, (&self.from, &self.to)).unwrap_or_else(|| {
            let threshold = match self.switch {
                Switch::AtPoint => parameter.switch_at.unwrap_or(0.5),
                Switch::Mixture { seed } => Stream::new(self.from.task().name(), seed, &format!("drift/{name}"))
                    .at(index, 0, 0)
                    .unit(),
            };
            if t >= threshold { to.clone() } else { from.clone() }
        })
    }
}

/// The value between two, or `None` if there is nothing between them. `listed`: the domain is a list of choices.
pub(crate) fn interpolate(
    parameter: &Parameter,
    listed: bool,
    from: &Value,
    to: &Value,
    t: f64,
    (a, b): (&Variant, &Variant),
) -> Option<Value> {
    let straight = |from: f64, to: f64| from + (to - from) * t;
    match (from, to) {
        (Value::Color(from), Value::Color(to)) => Some(Value::Color(from.mix(*to, t))),
        (Value::Point(from), Value::Point(to)) => {
            Some(Value::Point([straight(from[0], to[0]), straight(from[1], to[1])]))
        }
        (Value::Vector(from), Value::Vector(to)) => Some(Value::Vector(
            from.iter().zip(to).map(|(from, to)| straight(*from, *to)).collect(),
        )),
        (Value::Distribution(from), Value::Distribution(to)) => {
            between_distributions(&a.settle(from), &b.settle(to), t)
                .map(|between| Value::Distribution(Box::new(literal(&between))))
        }
        _ if listed => None,
        (Value::Number(from), Value::Number(to)) if parameter.kind == ParameterType::Heading => {
            if let Some([low, high]) = parameter.range.filter(|[low, high]| high - low < 360.0) {
                // Within the arc that the parameter declares, which may be the longer way.
                let along = |degrees: f64| (degrees - low).rem_euclid(360.0).min(high - low);
                return Some(Value::Number(
                    (low + straight(along(*from), along(*to))).rem_euclid(360.0),
                ));
            }
            let turn = (to - from + 180.0).rem_euclid(360.0) - 180.0;
            Some(Value::Number((from + turn * t).rem_euclid(360.0)))
        }
        (Value::Number(from), Value::Number(to)) => Some(Value::Number(straight(*from, *to))),
        (Value::Integer(from), Value::Integer(to)) => {
            Some(Value::Integer(straight(*from as f64, *to as f64).round() as i64))
        }
        _ => None,
    }
}

/// A distribution as documents have it.
fn literal(distribution: &Distribution) -> Distribution<Number> {
    let mapped: Result<_, std::convert::Infallible> = distribution.try_map(&mut |number| Ok(Number::Literal(*number)));
    match mapped {
        Ok(literal) => literal,
        Err(never) => match never {},
    }
}

/// Distributions of one family interpolate number by number; others are mixed, where both draw numbers, points or colours.
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
            let end = ends.next().expect("equal skeletons have equally many numbers");
            number + (end - number) * t
        });
        return Some(colored(whole(between), &from, &to, t));
    }
    let alike = if from.draws_colors() || to.draws_colors() {
        from.yields(ParameterType::Color) && to.yields(ParameterType::Color)
    } else {
        from.is_planar() == to.is_planar() && (from.is_planar() || from.mean().is_some() == to.mean().is_some())
    };
    alike.then(|| Distribution::Mixture {
        parts: vec![from, to],
        weights: Some(vec![1.0 - t, t]),
    })
}

/// A distribution as the other is written, where its family can be written in several ways: a Gaussian by its covariance, a
/// spread of channels for each of them, the ends that are meant where none are given.
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

/// A distribution of colours between two of its family: its colours in Oklab, its hues the shorter way round.
fn colored(between: Distribution, from: &Distribution, to: &Distribution, t: f64) -> Distribution {
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
            // Where a document may have them, which is within a turn of 0..360.
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
                .map(|(part, (a, b))| colored(part, a, b, t))
                .collect(),
            weights,
        },
        (other, ..) => other,
    }
}

fn map(distribution: &Distribution, mut f: impl FnMut(f64) -> f64) -> Distribution {
    let mapped: Result<_, std::convert::Infallible> = distribution.try_map(&mut |number| Ok(f(*number)));
    match mapped {
        Ok(mapped) => mapped,
        Err(never) => match never {},
    }
}

/// The distribution but for its numbers.
fn skeleton(distribution: &Distribution) -> Distribution {
    map(distribution, |_| 0.0)
}

/// Rounds the numbers that a family wants whole.
fn whole(distribution: Distribution) -> Distribution {
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
            parts: parts.into_iter().map(whole).collect(),
            weights,
        },
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn schedules_begin_at_0_and_end_at_1() {
        for schedule in [
            Schedule::Linear,
            Schedule::Cosine,
            Schedule::Step { steps: 1 },
            Schedule::Step { steps: 4 },
            Schedule::Sawtooth { periods: 3 },
        ] {
            assert_eq!(schedule.at(0.0), 0.0, "{schedule:?}");
            assert_eq!(schedule.at(1.0), 1.0, "{schedule:?}");
        }
        assert!((Schedule::Cosine.at(0.5) - 0.5).abs() < 1e-15 && Schedule::Cosine.at(0.1) < 0.05);
        assert_eq!(
            [0.3, 0.4, 0.7].map(|x| Schedule::Step { steps: 2 }.at(x)),
            [0.0, 0.5, 1.0]
        );
        assert_eq!(
            [0.125, 0.375, 0.5, 0.625].map(|x| Schedule::Sawtooth { periods: 2 }.at(x)),
            [0.25, 0.75, 0.0, 0.25]
        );
    }
}
