//! Passing every number of a distribution through a function: how references are settled and variants interpolated.

use super::{ChannelSpread, Channels, Distribution, Spread};

type Map<'a, N, M, E> = &'a mut dyn FnMut(&N) -> Result<M, E>;

impl<N> Distribution<N> {
    /// The same distribution with every number passed through `f`, in the order of the text.
    ///
    /// # Errors
    /// The first that `f` returns.
    #[expect(clippy::too_many_lines, reason = "a flat match, one arm for each family")]
    pub fn try_map<M, E>(&self, f: Map<N, M, E>) -> Result<Distribution<M>, E> {
        use Distribution as D;
        Ok(match self {
            Self::Constant { value } => D::Constant { value: value.clone() },
            Self::Choice { values, weights } => D::Choice {
                values: values.clone(),
                weights: list(weights.as_ref(), f)?,
            },
            Self::Uniform { low, high } => D::Uniform {
                low: f(low)?,
                high: f(high)?,
            },
            Self::IntegerUniform { low, high } => D::IntegerUniform {
                low: f(low)?,
                high: f(high)?,
            },
            Self::Normal { mean, std } => D::Normal {
                mean: f(mean)?,
                std: f(std)?,
            },
            Self::TruncatedNormal { mean, std, low, high } => D::TruncatedNormal {
                mean: f(mean)?,
                std: f(std)?,
                low: f(low)?,
                high: f(high)?,
            },
            Self::LogNormal { mu, sigma } => D::LogNormal {
                mu: f(mu)?,
                sigma: f(sigma)?,
            },
            Self::Exponential { rate } => D::Exponential { rate: f(rate)? },
            Self::Beta { alpha, beta, low, high } => D::Beta {
                alpha: f(alpha)?,
                beta: f(beta)?,
                low: maybe(low.as_ref(), f)?,
                high: maybe(high.as_ref(), f)?,
            },
            Self::Triangular { low, mode, high } => D::Triangular {
                low: f(low)?,
                mode: f(mode)?,
                high: f(high)?,
            },
            Self::Perturb {
                value,
                noise,
                low,
                high,
            } => D::Perturb {
                value: f(value)?,
                noise: f(noise)?,
                low: maybe(low.as_ref(), f)?,
                high: maybe(high.as_ref(), f)?,
            },
            Self::VonMises { mean, kappa } => D::VonMises {
                mean: f(mean)?,
                kappa: f(kappa)?,
            },
            Self::Bernoulli { p } => D::Bernoulli { p: f(p)? },
            Self::Binomial { n, p } => D::Binomial { n: f(n)?, p: f(p)? },
            Self::Poisson { mean } => D::Poisson { mean: f(mean)? },
            Self::Geometric { p } => D::Geometric { p: f(p)? },
            Self::Dirichlet { alpha } => D::Dirichlet {
                alpha: alpha.iter().map(f).collect::<Result<_, E>>()?,
            },
            Self::Box { low, high } => D::Box {
                low: pair(low, f)?,
                high: pair(high, f)?,
            },
            Self::Disc { center, radius } => D::Disc {
                center: pair(center, f)?,
                radius: f(radius)?,
            },
            Self::Annulus { center, inner, outer } => D::Annulus {
                center: pair(center, f)?,
                inner: f(inner)?,
                outer: f(outer)?,
            },
            Self::Gaussian {
                mean,
                std,
                correlation,
                covariance,
            } => D::Gaussian {
                mean: pair(mean, f)?,
                std: match std {
                    None => None,
                    Some(Spread::Round(std)) => Some(Spread::Round(f(std)?)),
                    Some(Spread::Axes(axes)) => Some(Spread::Axes(pair(axes, f)?)),
                },
                correlation: maybe(correlation.as_ref(), f)?,
                covariance: match covariance {
                    None => None,
                    Some([x, y]) => Some([pair(x, f)?, pair(y, f)?]),
                },
            },
            Self::Points { values, order } => {
                let values = values.iter().map(|point| pair(point, f)).collect::<Result<_, E>>()?;
                D::Points { values, order: *order }
            }
            Self::Grid {
                low,
                high,
                columns,
                rows,
                jitter,
                order,
            } => D::Grid {
                low: pair(low, f)?,
                high: pair(high, f)?,
                columns: f(columns)?,
                rows: f(rows)?,
                jitter: maybe(jitter.as_ref(), f)?,
                order: *order,
            },
            Self::PoissonDisc { low, high, distance } => D::PoissonDisc {
                low: pair(low, f)?,
                high: pair(high, f)?,
                distance: f(distance)?,
            },
            Self::Cells {
                kind,
                letter,
                of_group,
                room,
                walk,
                jitter,
            } => D::Cells {
                kind: *kind,
                letter: letter.clone(),
                of_group: *of_group,
                room: *room,
                walk: walk.as_ref().map(|walk| pair(walk, f)).transpose()?,
                jitter: maybe(jitter.as_ref(), f)?,
            },
            Self::ColorUniform { from, to, channels } => D::ColorUniform {
                from: color(from, f)?,
                to: color(to, f)?,
                channels: *channels,
            },
            Self::ColorNormal { mean, std } => D::ColorNormal {
                mean: color(mean, f)?,
                std: spread(std, f)?,
            },
            Self::ColorPerturb {
                value,
                noise,
                low,
                high,
                channels,
            } => D::ColorPerturb {
                value: color(value, f)?,
                noise: spread(noise, f)?,
                low: low.as_ref().map(|low| color(low, f)).transpose()?,
                high: high.as_ref().map(|high| color(high, f)).transpose()?,
                channels: *channels,
            },
            Self::ColorHsv { hue, saturation, value } => D::ColorHsv {
                hue: hue.as_ref().map(|hue| pair(hue, f)).transpose()?,
                saturation: saturation.as_ref().map(|saturation| pair(saturation, f)).transpose()?,
                value: value.as_ref().map(|value| pair(value, f)).transpose()?,
            },
            Self::Mixture { parts, weights } => D::Mixture {
                parts: parts.iter().map(|part| part.try_map(f)).collect::<Result<_, E>>()?,
                weights: list(weights.as_ref(), f)?,
            },
        })
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
