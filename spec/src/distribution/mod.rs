//! [`Distribution`]: a probability distribution as data, with its moments, CDF and quantiles.

pub(crate) mod case;
mod cells;
mod channels;
mod color;
mod color_moments;
mod cumulative;
mod discrete;
mod display;
mod fault;
mod map;
mod moments;
mod number;
mod planar;
mod points;
mod quantile;
mod reference;
mod schema;
mod special;
mod support;
mod turn;
mod von_mises;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use case::Case;
pub use cells::{CellKind, CellRoom};
pub use channels::{Channel, ChannelChance, ChannelSpread, Channels};
pub use moments::Moments;
pub use number::Number;
pub use points::{Order, Spread};
pub use reference::ParamRef;
pub(crate) use support::MAX_ATOMS;
pub use turn::Turns;

use crate::serde_defaults::is_default;
use crate::value::Value;

/// A probability distribution. `N` is [`Number`] in a spec, where numbers may be references, and `f64` once a variant has
/// resolved them.
///
/// Distributions of numbers have closed forms where they exist: [`mean`](Distribution::mean),
/// [`variance`](Distribution::variance), [`cdf`](Distribution::cdf), [`quantile`](Distribution::quantile). Distributions of
/// points have [`planar_moments`](Distribution::planar_moments), distributions of colours have
/// [`color_moments`](Distribution::color_moments).
///
/// # Example
/// ```
/// use driftworld_spec::Distribution;
/// let light = Distribution::TruncatedNormal { mean: 2.0, std: 1.0, low: 0.0, high: 4.0 };
/// assert_eq!(light.mean(), Some(2.0));
/// assert!((light.quantile(0.5).unwrap() - 2.0).abs() < 1e-12);
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, strum::IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
#[serde(
    rename_all = "snake_case",
    deny_unknown_fields,
    bound(serialize = "N: Channel + Serialize", deserialize = "N: Channel + Deserialize<'de>")
)]
#[schemars(rename = "Distribution", transform = schema::gaussian_needs_one_spread)]
#[schemars(extend("examples" = [
    { "uniform": { "low": 0, "high": 360 } },
    { "truncated_normal": { "mean": 2.3, "std": 0.5, "low": 0, "high": 4 } },
    { "choice": { "values": ["1", "2", "5"], "weights": [2, 1, 1] } },
    { "gaussian": { "mean": [0, 0], "std": { "param": "spread" } } },
    { "mixture": { "parts": [{ "disc": { "center": [0, 0], "radius": 5 } }, { "disc": { "center": [20, 0], "radius": 5 } }] } },
]))]
pub enum Distribution<N = f64> {
    /// Always the same value, of any type.
    Constant {
        /// The value.
        #[schemars(with = "serde_json::Value")]
        value: Value,
    },
    /// One value of a list, chosen by weight.
    Choice {
        /// The possible values.
        #[schemars(length(min = 1, max = 10_000), with = "Vec<serde_json::Value>")]
        values: Vec<Value>,
        /// Weight of each value: at least 0, not all 0; equal weights if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(length(min = 1, max = 10_000), transform = schema::none_negative)]
        weights: Option<Vec<N>>,
    },
    /// All numbers in `low..high`, equally likely.
    Uniform {
        /// Lower end, included.
        low: N,
        /// Upper end, excluded; above `low`.
        high: N,
    },
    /// All whole numbers in `low..=high`, equally likely.
    IntegerUniform {
        /// Least value.
        #[schemars(extend("multipleOf" = 1))]
        low: N,
        /// Largest value, not below `low`.
        #[schemars(extend("multipleOf" = 1))]
        high: N,
    },
    /// The normal (Gaussian) distribution of numbers.
    Normal {
        /// Mean.
        mean: N,
        /// Standard deviation, at least 0.
        #[schemars(extend("minimum" = 0))]
        std: N,
    },
    /// The normal distribution, truncated to `low..=high`.
    TruncatedNormal {
        /// Mean of the normal distribution before truncation.
        mean: N,
        /// Standard deviation of the normal distribution before truncation, above 0.
        #[schemars(extend("exclusiveMinimum" = 0))]
        std: N,
        /// Least value.
        low: N,
        /// Largest value, above `low`.
        high: N,
    },
    /// Numbers above 0 with a normally distributed logarithm.
    LogNormal {
        /// Mean of the natural logarithm.
        #[schemars(extend("minimum" = -300, "maximum" = 300))]
        mu: N,
        /// Standard deviation of the natural logarithm, at least 0.
        #[schemars(extend("minimum" = 0, "maximum" = 30))]
        sigma: N,
    },
    /// Memoryless waiting times: density `rate × exp(−rate × x)` for `x` above 0.
    Exponential {
        /// Events per unit, above 0; the mean is 1 / `rate`.
        #[schemars(extend("exclusiveMinimum" = 0))]
        rate: N,
    },
    /// The beta distribution, rescaled from 0..1 to `low..high`.
    Beta {
        /// First shape parameter, above 0: large values favour `high`.
        #[schemars(extend("minimum" = 0.001, "maximum" = 1_000_000))]
        alpha: N,
        /// Second shape parameter, above 0: large values favour `low`.
        #[schemars(extend("minimum" = 0.001, "maximum" = 1_000_000))]
        beta: N,
        /// Lower end; 0 if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        low: Option<N>,
        /// Upper end, above `low`; 1 if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        high: Option<N>,
    },
    /// A density that rises linearly from `low` to `mode` and falls linearly to `high`.
    Triangular {
        /// Lower end.
        low: N,
        /// Most likely value, in `low..=high`.
        mode: N,
        /// Upper end, above `low`.
        high: N,
    },
    /// A value with uniform noise, clipped to limits.
    Perturb {
        /// The value without noise.
        value: N,
        /// Largest deviation in either direction, at least 0.
        #[schemars(extend("minimum" = 0))]
        noise: N,
        /// Lower limit to which smaller results are clipped; none if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        low: Option<N>,
        /// Upper limit to which larger results are clipped; none if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        high: Option<N>,
    },
    /// The von Mises distribution: headings around a mean direction, the circular counterpart of the normal distribution.
    VonMises {
        /// Mean direction in degrees clockwise from +y.
        mean: N,
        /// Concentration from 0 (all headings equally likely) to 10,000; about 3283 / (standard deviation in degrees)² when
        /// large.
        #[schemars(extend("minimum" = 0, "maximum" = 10_000))]
        kappa: N,
    },
    /// True with probability `p`.
    Bernoulli {
        /// Probability, 0..1.
        #[schemars(extend("minimum" = 0, "maximum" = 1))]
        p: N,
    },
    /// Number of successes in `n` trials.
    Binomial {
        /// Number of trials, a whole number from 0 to 100,000.
        #[schemars(extend("minimum" = 0, "maximum" = 100_000, "multipleOf" = 1))]
        n: N,
        /// Probability that a trial succeeds, 0..1.
        #[schemars(extend("minimum" = 0, "maximum" = 1))]
        p: N,
    },
    /// Number of independent events in an interval.
    Poisson {
        /// Mean number of events, from 0 to 100,000.
        #[schemars(extend("minimum" = 0, "maximum" = 100_000))]
        mean: N,
    },
    /// Number of failed trials before the first success.
    Geometric {
        /// Probability that a trial succeeds, above 0, at most 1.
        #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1))]
        p: N,
    },
    /// Shares that sum to 1: a vector with one entry per entry of `alpha`.
    Dirichlet {
        /// Shape parameter of each share, above 0; equal shapes above 1 favour equal shares, equal shapes below 1 favour one
        /// large share.
        #[schemars(length(min = 2, max = 100), transform = schema::shapes)]
        alpha: Vec<N>,
    },
    /// A uniformly random point of a rectangle.
    Box {
        /// South-west corner in metres.
        low: [N; 2],
        /// North-east corner in metres, above `low` in both coordinates.
        high: [N; 2],
    },
    /// A uniformly random point of a disc.
    Disc {
        /// Centre in metres.
        center: [N; 2],
        /// Radius in metres, above 0.
        #[schemars(extend("exclusiveMinimum" = 0))]
        radius: N,
    },
    /// A uniformly random point of a ring.
    Annulus {
        /// Centre in metres.
        center: [N; 2],
        /// Inner radius in metres, at least 0.
        #[schemars(extend("minimum" = 0))]
        inner: N,
        /// Outer radius in metres, above `inner`.
        #[schemars(extend("exclusiveMinimum" = 0))]
        outer: N,
    },
    /// The normal distribution in the plane: either `std` (one number, or one per axis) with an optional correlation, or
    /// `covariance`.
    Gaussian {
        /// Mean in metres.
        mean: [N; 2],
        /// Standard deviation in metres, at least 0: one number for both axes, or one for each.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(transform = schema::none_negative)]
        std: Option<Spread<N>>,
        /// Correlation of x and y, given together with `std`, −1..1; 0 if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(extend("minimum" = -1, "maximum" = 1))]
        correlation: Option<N>,
        /// Covariance matrix in square metres, given instead of `std`: symmetric, without negative eigenvalues.
        #[serde(skip_serializing_if = "Option::is_none")]
        covariance: Option<[[N; 2]; 2]>,
    },
    /// A list of points.
    Points {
        /// The points in metres.
        #[schemars(length(min = 1, max = 100_000))]
        values: Vec<[N; 2]>,
        /// Whether the points are taken in turn, starting over after the last, or at random.
        #[serde(default, skip_serializing_if = "is_default")]
        order: Order,
    },
    /// The centres of the cells of a grid, taken in turn from the south-west, row by row, or at random.
    Grid {
        /// South-west corner in metres.
        low: [N; 2],
        /// North-east corner in metres, above `low` in both coordinates.
        high: [N; 2],
        /// Cells from west to east, a whole number from 1 to 1,000.
        #[schemars(extend("minimum" = 1, "maximum" = 1_000, "multipleOf" = 1))]
        columns: N,
        /// Cells from south to north, a whole number from 1 to 1,000.
        #[schemars(extend("minimum" = 1, "maximum" = 1_000, "multipleOf" = 1))]
        rows: N,
        /// How far a point may be from its cell's centre, as a share of the cell: 0 is the centre itself, 1 anywhere in the
        /// cell; 0 if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(extend("minimum" = 0, "maximum" = 1))]
        jitter: Option<N>,
        /// Whether the cells are taken in turn, starting over after the last, or at random.
        #[serde(default, skip_serializing_if = "is_default")]
        order: Order,
    },
    /// Random points of a rectangle that keep a minimum distance from each other within the group: Poisson-disc sampling.
    PoissonDisc {
        /// South-west corner in metres.
        low: [N; 2],
        /// North-east corner in metres, above `low` in both coordinates.
        high: [N; 2],
        /// Minimum distance in metres between two objects of the group, above 0.
        #[schemars(extend("exclusiveMinimum" = 0))]
        distance: N,
    },
    /// A uniformly random free cell of the layout; each cell takes only one object of the group. For groups and, without `room`
    /// and `walk`, for the agent's start.
    Cells {
        /// Which cells, by their number of open sides; any if absent.
        #[serde(default, skip_serializing_if = "is_default")]
        kind: CellKind,
        /// Only cells marked with one of these letters in a text layout; any if absent. Letters for floor count if the legend
        /// names them.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(length(min = 1, max = 100))]
        letter: Option<String>,
        /// Whether to use only the cells whose letters the legend assigns to the group.
        #[serde(default, skip_serializing_if = "is_default")]
        of_group: bool,
        /// Only cells of the room in which the agent starts, or only of the other rooms; of all rooms if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        room: Option<CellRoom>,
        /// Minimum and maximum walking distance in metres from the cell in which the agent starts, between cell centres; any if
        /// absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(transform = schema::none_negative)]
        walk: Option<[N; 2]>,
        /// How far an object may be from its cell's centre, as a share of the cell: 0 is the centre itself, 1 anywhere in the
        /// cell; 0 if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(extend("minimum" = 0, "maximum" = 1))]
        jitter: Option<N>,
    },
    /// A uniformly random colour of a box in sRGB, or of the diagonal between two of its corners.
    ColorUniform {
        /// One corner.
        from: Channels<N>,
        /// The opposite corner; each channel lies between its values at the two corners, whichever is greater.
        to: Channels<N>,
        /// Whether the channels vary independently, which fills the box, or together, which follows the diagonal.
        #[serde(default, skip_serializing_if = "is_default")]
        channels: ChannelChance,
    },
    /// Colours around a mean: each channel is normal, truncated to 0..1.
    ColorNormal {
        /// The mean before truncation.
        mean: Channels<N>,
        /// Standard deviation of the channels before truncation, 0..10: one number for all, or one for each.
        #[schemars(transform = schema::small_spread)]
        std: ChannelSpread<N>,
    },
    /// A colour with uniform noise, each channel clipped to limits, as in L2Explorer's templates.
    ColorPerturb {
        /// The colour without noise.
        value: Channels<N>,
        /// Largest deviation of the channels in either direction, 0..10: one number for all, or one for each.
        #[schemars(transform = schema::small_spread)]
        noise: ChannelSpread<N>,
        /// Lower limits to which smaller channels are clipped; black if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        low: Option<Channels<N>>,
        /// Upper limits to which larger channels are clipped; white if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        high: Option<Channels<N>>,
        /// Whether each channel has its own noise, or all share one, which makes lighter and darker shades.
        #[serde(default, skip_serializing_if = "is_default")]
        channels: ChannelChance,
    },
    /// Colours by hue, saturation and value, each uniformly distributed between its ends.
    ColorHsv {
        /// Hues in degrees from the first to the second: 0 red, 120 green, 240 blue; `[-20, 20]` is a range across red; all if
        /// absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        hue: Option<[N; 2]>,
        /// Saturation from 0 (grey) to 1 (full); 0 to 1 if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(transform = schema::up_to_1)]
        saturation: Option<[N; 2]>,
        /// Value from 0 (black) to 1 (bright); 0 to 1 if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(transform = schema::up_to_1)]
        value: Option<[N; 2]>,
    },
    /// A draw from one of several distributions, chosen by weight.
    Mixture {
        /// The distributions: all of numbers, all of points, or all of colours.
        #[schemars(length(min = 1, max = 100))]
        parts: Vec<Distribution<N>>,
        /// Weight of each part: at least 0, not all 0; equal weights if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(length(min = 1, max = 100), transform = schema::none_negative)]
        weights: Option<Vec<N>>,
    },
}

impl<N> Distribution<N> {
    /// Its name in documents.
    pub fn name(&self) -> &'static str {
        self.into()
    }

    /// The names of the distributions that place objects, for messages.
    pub const PLANAR: &'static str =
        "box, disc, annulus, gaussian, points, grid, poisson_disc, cells, or a mixture of them";

    /// Whether it draws points, so that it can place objects.
    pub fn is_planar(&self) -> bool {
        match self {
            Self::Box { .. }
            | Self::Disc { .. }
            | Self::Annulus { .. }
            | Self::Gaussian { .. }
            | Self::Points { .. }
            | Self::Grid { .. }
            | Self::PoissonDisc { .. }
            | Self::Cells { .. } => true,
            Self::Constant { value } => matches!(value, Value::Point(_)),
            Self::Choice { values, .. } => values.iter().all(|value| matches!(value, Value::Point(_))),
            Self::Mixture { parts, .. } => parts.iter().all(Self::is_planar),
            _ => false,
        }
    }

    /// Whether its draws depend on earlier objects: points taken in turn, or kept apart. Allowed in groups only.
    pub fn needs_group(&self) -> bool {
        match self {
            Self::Points { order, .. } | Self::Grid { order, .. } => *order == Order::Turn,
            Self::PoissonDisc { .. } | Self::Cells { .. } => true,
            Self::Mixture { parts, .. } => parts.iter().any(Self::needs_group),
            _ => false,
        }
    }

    /// Whether it or one of its parts draws cells of a layout.
    pub fn draws_cells(&self) -> bool {
        match self {
            Self::Cells { .. } => true,
            Self::Mixture { parts, .. } => parts.iter().any(Self::draws_cells),
            _ => false,
        }
    }

    /// The cells whose letters a layout's legend assigns to a group.
    pub(crate) fn cells_of_group() -> Self {
        Self::Cells {
            kind: CellKind::Any,
            letter: None,
            of_group: true,
            room: None,
            walk: None,
            jitter: None,
        }
    }
}
