//! Maps every number of a distribution through a function; used to resolve references and to interpolate variants.

use super::{ChannelSpread, Channels, Distribution, Number, Spread};

type Map<'a, N, M, E> = &'a mut dyn FnMut(&N) -> Result<M, E>;

/// Builds a distribution of the same family, with each field from the expression after its name.
macro_rules! same_family {
    ($from:expr => $($family:ident { $($field:ident: $mapped:expr),+ $(,)? })+) => {
        match $from {
            $(Distribution::$family { $($field),+ } => Distribution::$family { $($field: $mapped),+ },)+
        }
    };
}

impl<N> Distribution<N> {
    /// The same distribution with every number passed through `f`, in document order.
    ///
    /// # Errors
    /// Returns the first error of `f`.
    pub fn try_map<M, E>(&self, f: Map<N, M, E>) -> Result<Distribution<M>, E> {
        Ok(same_family! { self =>
            Constant { value: value.clone() }
            Choice { values: values.clone(), weights: list(weights.as_ref(), f)? }
            Uniform { low: f(low)?, high: f(high)? }
            IntegerUniform { low: f(low)?, high: f(high)? }
            Normal { mean: f(mean)?, std: f(std)? }
            TruncatedNormal { mean: f(mean)?, std: f(std)?, low: f(low)?, high: f(high)? }
            LogNormal { mu: f(mu)?, sigma: f(sigma)? }
            Exponential { rate: f(rate)? }
            Beta { alpha: f(alpha)?, beta: f(beta)?, low: maybe(low.as_ref(), f)?, high: maybe(high.as_ref(), f)? }
            Triangular { low: f(low)?, mode: f(mode)?, high: f(high)? }
            Perturb { value: f(value)?, noise: f(noise)?, low: maybe(low.as_ref(), f)?, high: maybe(high.as_ref(), f)? }
            VonMises { mean: f(mean)?, kappa: f(kappa)? }
            Bernoulli { p: f(p)? }
            Binomial { n: f(n)?, p: f(p)? }
            Poisson { mean: f(mean)? }
            Geometric { p: f(p)? }
            Dirichlet { alpha: alpha.iter().map(f).collect::<Result<_, E>>()? }
            Box { low: pair(low, f)?, high: pair(high, f)? }
            Disc { center: pair(center, f)?, radius: f(radius)? }
            Annulus { center: pair(center, f)?, inner: f(inner)?, outer: f(outer)? }
            Gaussian {
                mean: pair(mean, f)?,
                std: match std {
                    None => None,
                    Some(Spread::Round(std)) => Some(Spread::Round(f(std)?)),
                    Some(Spread::Axes(axes)) => Some(Spread::Axes(pair(axes, f)?)),
                },
                correlation: maybe(correlation.as_ref(), f)?,
                covariance: covariance.as_ref().map(|[x, y]| Ok([pair(x, f)?, pair(y, f)?])).transpose()?,
            }
            Points { values: values.iter().map(|point| pair(point, f)).collect::<Result<_, E>>()?, order: *order }
            Grid {
                low: pair(low, f)?,
                high: pair(high, f)?,
                columns: f(columns)?,
                rows: f(rows)?,
                jitter: maybe(jitter.as_ref(), f)?,
                order: *order,
            }
            PoissonDisc { low: pair(low, f)?, high: pair(high, f)?, distance: f(distance)? }
            Cells {
                kind: *kind,
                letter: letter.clone(),
                of_group: *of_group,
                room: *room,
                walk: walk.as_ref().map(|walk| pair(walk, f)).transpose()?,
                jitter: maybe(jitter.as_ref(), f)?,
            }
            ColorUniform { from: color(from, f)?, to: color(to, f)?, channels: *channels }
            ColorNormal { mean: color(mean, f)?, std: spread(std, f)? }
            ColorPerturb {
                value: color(value, f)?,
                noise: spread(noise, f)?,
                low: low.as_ref().map(|low| color(low, f)).transpose()?,
                high: high.as_ref().map(|high| color(high, f)).transpose()?,
                channels: *channels,
            }
            ColorHsv {
                hue: hue.as_ref().map(|hue| pair(hue, f)).transpose()?,
                saturation: saturation.as_ref().map(|saturation| pair(saturation, f)).transpose()?,
                value: value.as_ref().map(|value| pair(value, f)).transpose()?,
            }
            Mixture {
                parts: parts.iter().map(|part| part.try_map(f)).collect::<Result<_, E>>()?,
                weights: list(weights.as_ref(), f)?,
            }
        })
    }
}

impl Distribution<Number> {
    /// Its numbers in document order.
    pub(crate) fn numbers(&self) -> Vec<Number> {
        let mut numbers = Vec::new();
        let collected: Result<Distribution, ()> = self.try_map(&mut |number| {
            numbers.push(number.clone());
            Ok(0.0)
        });
        drop(collected);
        numbers
    }
}

fn pair<N, M, E>([x, y]: &[N; 2], f: Map<N, M, E>) -> Result<[M; 2], E> {
    Ok([f(x)?, f(y)?])
}

fn triple<N, M, E>([red, green, blue]: &[N; 3], f: Map<N, M, E>) -> Result<[M; 3], E> {
    Ok([f(red)?, f(green)?, f(blue)?])
}

fn color<N, M, E>(Channels(channels): &Channels<N>, f: Map<N, M, E>) -> Result<Channels<M>, E> {
    Ok(Channels(triple(channels, f)?))
}

fn spread<N, M, E>(spread: &ChannelSpread<N>, f: Map<N, M, E>) -> Result<ChannelSpread<M>, E> {
    Ok(match spread {
        ChannelSpread::Same(spread) => ChannelSpread::Same(f(spread)?),
        ChannelSpread::Each(spreads) => ChannelSpread::Each(triple(spreads, f)?),
    })
}

fn maybe<N, M, E>(number: Option<&N>, f: Map<N, M, E>) -> Result<Option<M>, E> {
    number.map(f).transpose()
}

fn list<N, M, E>(numbers: Option<&Vec<N>>, f: Map<N, M, E>) -> Result<Option<Vec<M>>, E> {
    numbers.map(|numbers| numbers.iter().map(f).collect()).transpose()
}
