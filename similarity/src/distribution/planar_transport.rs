//! Wasserstein distances between distributions of points.

use driftworld_spec::{Distribution, Value};

use super::measured::Measured;
use super::planar::bures_wasserstein;
use super::quadrature::integrate;
use super::scatter::scatter;
use super::wasserstein_2::wasserstein_2;
use crate::Assignment;

/// Sample points per distribution, if no exact method applies.
const NUM_SAMPLES: usize = 256;

/// Wasserstein-1 between two distributions of points, in metres.
///
/// A metric in `0..`, except when estimated from samples. In closed form if one is the other shifted, and for concentric
/// discs; by quadrature if rings or round gaussians are concentric with each other or with a disc; otherwise from 256 evenly
/// spread points of each, matched at minimum cost, which is accurate to within a few per cent of the spreads. Ignores
/// the minimum distance of `poisson_disc`. `None` if either draws no points.
///
/// Source: Villani 2009, "Optimal Transport: Old and New", chapter 6.
///
/// # Example
/// ```
/// use driftworld_similarity::distribution::planar_wasserstein_1;
/// use driftworld_spec::Distribution::Disc;
/// let disc = |x: f64| Disc { center: [x, 0.0], radius: 2.0 };
/// assert_eq!(planar_wasserstein_1(&disc(0.0), &disc(5.0)).unwrap().value, 5.0);
/// ```
pub fn planar_wasserstein_1(a: &Distribution, b: &Distribution) -> Option<Measured> {
    let (of_a, of_b) = (a.planar_moments()?, b.planar_moments()?);
    if a == b {
        return Some(Measured::closed(0.0));
    }
    let distance = libm::hypot(of_a.mean[0] - of_b.mean[0], of_a.mean[1] - of_b.mean[1]);
    if let (Some(x), Some(y)) = (Form::of(a), Form::of(b)) {
        if x == y && of_a.covariance == of_b.covariance {
            return Some(Measured::closed(distance));
        }
        if let (Some(x), Some(y), true) = (Radii::of(a), Radii::of(b), distance == 0.0) {
            if let (Radii::Ring(0.0, outer), Radii::Ring(0.0, other)) = (x, y) {
                return Some(Measured::closed((outer - other).abs() * 2.0 / 3.0));
            }
            // Each point moves along its ray: no plan is cheaper, because distances from the centre must change by at least
            // that much.
            return Some(x.compare(y, f64::abs));
        }
    }
    matched_mean(a, b, |x, y| libm::hypot(x[0] - y[0], x[1] - y[1]))
}

/// Wasserstein-2 between two distributions of points: the root mean square of the distances that points have to move, in metres.
///
/// A metric in `0..`, except when estimated from samples; never below [`bures_wasserstein`](super::bures_wasserstein())
/// nor [`planar_wasserstein_1`]. In closed form for two of the same family (boxes, discs, gaussians, rings of
/// equal proportions) and for anything against a single point; axis by axis for boxes, axis-aligned gaussians and grids, as
/// exact as [`wasserstein_2`](super::wasserstein_2()); by quadrature for discs, rings and round gaussians; otherwise from 256
/// evenly spread points of each, matched at minimum cost. Ignores the minimum distance of `poisson_disc`. `None` if
/// either draws no points.
///
/// Source: Peyré & Cuturi 2019, "Computational Optimal Transport", remarks 2.31 and 2.34.
pub fn planar_wasserstein_2(a: &Distribution, b: &Distribution) -> Option<Measured> {
    let (of_a, of_b) = (a.planar_moments()?, b.planar_moments()?);
    if a == b {
        return Some(Measured::closed(0.0));
    }
    if let (Some(x), Some(y)) = (Form::of(a), Form::of(b))
        && (x == y || x == Form::Point || y == Form::Point)
    {
        // One is the other shifted and stretched by a symmetric map: then means and covariances suffice.
        return bures_wasserstein(a, b).map(Measured::closed);
    }
    if let (Some([a_x, a_y]), Some([b_x, b_y])) = (axes(a), axes(b)) {
        let (x, y) = (wasserstein_2(&a_x, &b_x)?, wasserstein_2(&a_y, &b_y)?);
        let value = libm::hypot(x.value, y.value);
        return Some(Measured::within(value, x.tolerance() + y.tolerance()));
    }
    if let (Some(x), Some(y)) = (Radii::of(a), Radii::of(b)) {
        let distance = [0, 1].map(|axis| (of_a.mean[axis] - of_b.mean[axis]).powi(2));
        let around = x.compare(y, |gap| gap * gap);
        return Some(
            Measured {
                value: around.value + distance[0] + distance[1],
                ..around
            }
            .root(),
        );
    }
    let square = |x: [f64; 2], y: [f64; 2]| (x[0] - y[0]).powi(2) + (x[1] - y[1]).powi(2);
    matched_mean(a, b, square).map(Measured::root)
}

/// A family up to shifts, and stretching along its axes.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Form {
    Point,
    Box,
    /// Inner radius as a share of the outer.
    Ring(f64),
    Gaussian,
}

impl Form {
    fn of(distribution: &Distribution) -> Option<Self> {
        Some(match distribution {
            Distribution::Constant { value: Value::Point(_) } => Self::Point,
            Distribution::Box { .. } | Distribution::PoissonDisc { .. } => Self::Box,
            Distribution::Disc { .. } => Self::Ring(0.0),
            Distribution::Annulus { inner, outer, .. } => Self::Ring(inner / outer),
            Distribution::Gaussian { .. } => Self::Gaussian,
            _ => return None,
        })
    }
}

/// The distribution of distances from the centre, if it is rotationally symmetric.
#[derive(Clone, Copy, Debug)]
enum Radii {
    /// Inner and outer radius.
    Ring(f64, f64),
    /// Standard deviation along each axis.
    Bell(f64),
}

impl Radii {
    fn of(distribution: &Distribution) -> Option<Self> {
        Some(match distribution {
            Distribution::Disc { radius, .. } => Self::Ring(0.0, *radius),
            Distribution::Annulus { inner, outer, .. } => Self::Ring(*inner, *outer),
            Distribution::Constant { value: Value::Point(_) } => Self::Bell(0.0),
            Distribution::Gaussian { .. } => {
                let [[xx, xy], [_, yy]] = distribution.gaussian_covariance()?;
                if xx != yy || xy != 0.0 {
                    return None;
                }
                Self::Bell(xx.sqrt())
            }
            _ => return None,
        })
    }

    /// The radius that this share of all points exceeds.
    fn beyond(self, share: f64) -> f64 {
        match self {
            Self::Ring(inner, outer) => (outer * outer - (outer * outer - inner * inner) * share)
                .max(0.0)
                .sqrt(),
            Self::Bell(std) => std * (-2.0 * libm::log(share.max(1e-300))).max(0.0).sqrt(),
        }
    }

    /// The mean of a function of the difference, quantile by quantile.
    fn compare(self, other: Self, of: impl Fn(f64) -> f64) -> Measured {
        let gap = |share: f64| self.beyond(share) - other.beyond(share);
        let knots = super::quadrature::split_at_signs(&[0.0, 0.01, 0.5, 1.0], gap);
        let (mut sum, mut tolerance) = (0.0, 1e-12);
        for ends in knots.windows(2) {
            let ([value], [error]) = integrate([ends[0], ends[1]], 1e-12, |node| [of(gap(node.x()))]);
            sum += value;
            tolerance += error;
        }
        Measured::quadrature(sum, tolerance)
    }
}

/// The distributions along x and along y, if they are independent.
fn axes(distribution: &Distribution) -> Option<[Distribution; 2]> {
    match distribution {
        Distribution::Box { low, high } | Distribution::PoissonDisc { low, high, .. } => Some([0, 1].map(|axis| {
            let (low, high) = (low[axis], high[axis]);
            Distribution::Uniform { low, high }
        })),
        Distribution::Gaussian { mean, .. } => {
            let [[xx, xy], [_, yy]] = distribution.gaussian_covariance()?;
            let normal = |mean: f64, variance: f64| Distribution::Normal {
                mean,
                std: variance.sqrt(),
            };
            (xy == 0.0).then(|| [normal(mean[0], xx), normal(mean[1], yy)])
        }
        Distribution::Grid {
            low,
            high,
            columns,
            rows,
            jitter,
            ..
        } => {
            let jitter = jitter.unwrap_or(0.0);
            let axis = |axis: usize, count: f64| {
                let cell = (high[axis] - low[axis]) / count;
                let centre = |k: u32| low[axis] + cell * (f64::from(k) + 0.5);
                let parts = (0..count as u32).map(|k| Distribution::Perturb {
                    value: centre(k),
                    noise: cell * jitter / 2.0,
                    low: None,
                    high: None,
                });
                let parts = parts.collect();
                Distribution::Mixture { parts, weights: None }
            };
            Some([axis(0, *columns), axis(1, *rows)])
        }
        _ => None,
    }
}

/// The mean cost of the cheapest matching of sample points.
fn matched_mean(a: &Distribution, b: &Distribution, cost: impl Fn([f64; 2], [f64; 2]) -> f64) -> Option<Measured> {
    let listed = |distribution: &Distribution| match distribution {
        Distribution::Points { values, .. } if values.len() <= NUM_SAMPLES => Some(values.clone()),
        _ => None,
    };
    let lists = listed(a).zip(listed(b)).filter(|(a, b)| a.len() == b.len());
    let exact = lists.is_some();
    let (a, b) = match lists {
        Some(lists) => lists,
        None => (scatter(a, NUM_SAMPLES)?, scatter(b, NUM_SAMPLES)?),
    };
    let costs: Vec<f64> = a.iter().flat_map(|x| b.iter().map(|y| cost(*x, *y))).collect();
    let total = Assignment::new().solve(&costs, a.len(), b.len()).ok()?;
    let mean = total.max(0.0) / a.len() as f64;
    Some(if exact {
        Measured::atoms(mean)
    } else {
        Measured::samples(mean, a.len())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distribution::Method;
    use Distribution::{Annulus, Box, Disc, Gaussian, Grid, Points};
    use driftworld_spec::{Order, Spread};

    fn round(x: f64, std: f64) -> Distribution {
        Gaussian {
            mean: [x, 0.0],
            std: Some(Spread::Round(std)),
            correlation: None,
            covariance: None,
        }
    }

    fn disc(x: f64, radius: f64) -> Distribution {
        Disc {
            center: [x, 0.0],
            radius,
        }
    }

    #[track_caller]
    fn check(found: Option<Measured>, expected: f64, within: f64) {
        let found = found.unwrap();
        assert!(
            (found.value - expected).abs() <= within,
            "{found:?}, expected {expected}"
        );
    }

    #[test]
    fn concentric_discs_grow_along_their_rays() {
        check(planar_wasserstein_1(&disc(0.0, 1.0), &disc(0.0, 4.0)), 2.0, 1e-12);
        check(
            planar_wasserstein_2(&disc(0.0, 1.0), &disc(0.0, 4.0)),
            4.5_f64.sqrt(),
            1e-12,
        );
        let ring = Annulus {
            center: [0.0, 0.0],
            inner: 2.0,
            outer: 2.0 + 1e-9,
        };
        // All points at 2 m; a disc of 3 m has its points at 2 m on average.
        check(planar_wasserstein_2(&disc(0.0, 3.0), &ring), 0.5_f64.sqrt(), 1e-6);
        // Mean and mean square of the distance from the centre: √(π/2) and 2.
        let point = round(0.0, 0.0);
        check(planar_wasserstein_1(&point, &round(0.0, 1.0)), 1.253_314_137_3, 1e-9);
        check(planar_wasserstein_2(&point, &round(0.0, 1.0)), 2.0_f64.sqrt(), 1e-9);
    }

    #[test]
    fn distance_between_centres_adds_as_a_leg_of_a_triangle() {
        let near = planar_wasserstein_2(&disc(0.0, 2.0), &round(0.0, 1.0)).unwrap().value;
        check(
            planar_wasserstein_2(&disc(0.0, 2.0), &round(3.0, 1.0)),
            libm::hypot(near, 3.0),
            1e-9,
        );
    }

    #[test]
    fn samples_approximate_known_distances() {
        let square = Box {
            low: [0.0, 0.0],
            high: [2.0, 2.0],
        };
        let cells = |columns: f64| Grid {
            low: [0.0, 0.0],
            high: [2.0, 2.0],
            columns,
            rows: columns,
            jitter: Some(1.0),
            order: Order::Turn,
        };
        check(planar_wasserstein_2(&square, &cells(3.0)), 0.0, 1e-9);
        let found = planar_wasserstein_1(&square, &cells(3.0)).unwrap();
        assert_eq!(found.method, Method::Samples { count: 256 });
        assert!(found.value < 0.06, "{found:?}");
        let cost = |x: [f64; 2], y: [f64; 2]| (x[0] - y[0]).powi(2) + (x[1] - y[1]).powi(2);
        let by_pairs = matched_mean(&square, &disc(5.0, 2.0), cost).unwrap().root().value;
        let found = planar_wasserstein_2(&square, &disc(5.0, 2.0)).unwrap().value;
        assert_eq!(by_pairs, found);
        let least = bures_wasserstein(&square, &disc(5.0, 2.0)).unwrap();
        assert!(
            found > 0.99 * least && found < 1.02 * least,
            "{found}, at least {least}"
        );
    }

    #[test]
    fn lists_of_points_are_matched_exactly() {
        let list = |values: &[[f64; 2]]| Points {
            values: values.to_vec(),
            order: Order::Turn,
        };
        let (a, b) = (list(&[[0.0, 0.0], [1.0, 0.0]]), list(&[[1.0, 1.0], [0.0, 2.0]]));
        check(planar_wasserstein_1(&a, &b), 1.5, 1e-12);
        check(planar_wasserstein_2(&a, &b), 2.5_f64.sqrt(), 1e-12);
    }
}
