//! [`Distribution`]: a probability distribution as data, with its laws.

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
mod planar;
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
pub use planar::{Order, Spread};
pub use reference::{Number, ParamRef};
pub(crate) use support::MOST_ATOMS;
pub use turn::Turns;

use crate::serde_defaults::is_default;
use crate::value::Value;

/// How values scatter. `N` is [`Number`] in a spec, where numbers may be references, and `f64` once a variant has settled them.
///
/// Families of numbers have closed-form laws where there are any: [`mean`](Distribution::mean),
/// [`variance`](Distribution::variance), [`cdf`](Distribution::cdf), [`quantile`](Distribution::quantile). Families of points
/// have [`planar_moments`](Distribution::planar_moments), those of colours [`color_moments`](Distribution::color_moments).
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
    /// One of a list, by weight.
    Choice {
        /// What may be chosen.
        #[schemars(length(min = 1, max = 10_000), with = "Vec<serde_json::Value>")]
        values: Vec<Value>,
        /// Weight of each value, at least 0, not all 0; all alike if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(length(min = 1, max = 10_000), transform = schema::none_negative)]
        weights: Option<Vec<N>>,
    },
    /// Every number in `low..high` alike.
    Uniform {
        /// Lower end, may occur.
        low: N,
        /// Upper end, above `low`; does not occur.
        high: N,
    },
    /// Every whole number in `low..=high` alike.
    IntegerUniform {
        /// Least value.
        #[schemars(extend("multipleOf" = 1))]
        low: N,
        /// Greatest value, not below `low`.
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
    /// The normal distribution, given that it falls in `low..=high`.
    TruncatedNormal {
        /// Mean of the normal before truncation.
        mean: N,
        /// Standard deviation of the normal before truncation, above 0.
        #[schemars(extend("exclusiveMinimum" = 0))]
        std: N,
        /// Least value.
        low: N,
        /// Greatest value, above `low`.
        high: N,
    },
    /// Numbers above 0 whose logarithm is normal.
    LogNormal {
        /// Mean of the natural logarithm.
        #[schemars(extend("minimum" = -300, "maximum" = 300))]
        mu: N,
        /// Standard deviation of the natural logarithm, at least 0.
        #[schemars(extend("minimum" = 0, "maximum" = 30))]
        sigma: N,
    },
    /// Waiting times without memory: density `rate × exp(−rate × x)` above 0.
    Exponential {
        /// Events per unit, above 0; the mean is 1 / `rate`.
        #[schemars(extend("exclusiveMinimum" = 0))]
        rate: N,
    },
    /// The beta distribution, stretched from 0..1 to `low..high`.
    Beta {
        /// First shape, above 0: large values push towards `high`.
        #[schemars(extend("minimum" = 0.001, "maximum" = 1_000_000))]
        alpha: N,
        /// Second shape, above 0: large values push towards `low`.
        #[schemars(extend("minimum" = 0.001, "maximum" = 1_000_000))]
        beta: N,
        /// Lower end; 0 if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        low: Option<N>,
        /// Upper end, above `low`; 1 if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        high: Option<N>,
    },
    /// A density that rises straight from `low` to `mode` and falls straight to `high`.
    Triangular {
        /// Lower end.
        low: N,
        /// Most likely value, in `low..=high`.
        mode: N,
        /// Upper end, above `low`.
        high: N,
    },
    /// A value with uniform noise, cut off at limits.
    Perturb {
        /// The value in the middle.
        value: N,
        /// Greatest deviation to either side, at least 0.
        #[schemars(extend("minimum" = 0))]
        noise: N,
        /// Limit below, at which smaller results are cut off; none if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        low: Option<N>,
        /// Limit above, at which greater results are cut off; none if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        high: Option<N>,
    },
    /// The von Mises distribution: headings around a mean direction, as the normal is for numbers.
    VonMises {
        /// Mean direction in degrees clockwise from +y.
        mean: N,
        /// Concentration from 0 (every heading alike) to 10,000; about 3283 / (standard deviation in degrees)² when large.
        #[schemars(extend("minimum" = 0, "maximum" = 10_000))]
        kappa: N,
    },
    /// True with probability `p`.
    Bernoulli {
        /// Probability, 0..1.
        #[schemars(extend("minimum" = 0, "maximum" = 1))]
        p: N,
    },
    /// How many of `n` tries succeed.
    Binomial {
        /// Number of tries, a whole number from 0 to 100,000.
        #[schemars(extend("minimum" = 0, "maximum" = 100_000, "multipleOf" = 1))]
        n: N,
        /// Probability that a try succeeds, 0..1.
        #[schemars(extend("minimum" = 0, "maximum" = 1))]
        p: N,
    },
    /// How many events fall into a stretch when they come independently.
    Poisson {
        /// Mean number of events, from 0 to 100,000.
        #[schemars(extend("minimum" = 0, "maximum" = 100_000))]
        mean: N,
    },
    /// How many tries fail before the first that succeeds.
    Geometric {
        /// Probability that a try succeeds, above 0, at most 1.
        #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1))]
        p: N,
    },
    /// Shares that sum to 1: a vector with one entry per shape.
    Dirichlet {
        /// Shape of each share, above 0; equal shapes above 1 pull towards equal shares, below 1 towards one taking all.
        #[schemars(length(min = 2, max = 100), transform = schema::shapes)]
        alpha: Vec<N>,
    },
    /// Every point of a rectangle alike.
    Box {
        /// South-west corner in metres.
        low: [N; 2],
        /// North-east corner in metres, above `low` in both coordinates.
        high: [N; 2],
    },
    /// Every point of a disc alike.
    Disc {
        /// Centre in metres.
        center: [N; 2],
        /// Radius in metres, above 0.
        #[schemars(extend("exclusiveMinimum" = 0))]
        radius: N,
    },
    /// Every point of a ring alike.
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
    /// The normal distribution of the plane: `std` (round, or along each axis) with a correlation, or the covariance itself.
    Gaussian {
        /// Mean in metres.
        mean: [N; 2],
        /// Standard deviation in metres, at least 0: one number for both axes, or one for each.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(transform = schema::none_negative)]
        std: Option<Spread<N>>,
        /// Correlation of x and y beside `std`, −1..1; 0 if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(extend("minimum" = -1, "maximum" = 1))]
        correlation: Option<N>,
        /// Covariance matrix in square metres in place of `std`: symmetric, no negative eigenvalue.
        #[serde(skip_serializing_if = "Option::is_none")]
        covariance: Option<[[N; 2]; 2]>,
    },
    /// A list of points.
    Points {
        /// The points in metres.
        #[schemars(length(min = 1, max = 100_000))]
        values: Vec<[N; 2]>,
        /// Whether the points are taken in turn, round and round, or drawn.
        #[serde(default, skip_serializing_if = "is_default")]
        order: Order,
    },
    /// The centres of the cells of a grid, taken in turn from the south-west, row by row, or drawn.
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
        /// How far a point strays from its cell's centre, as a share of the cell: 0 not at all, 1 anywhere in it; 0 if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(extend("minimum" = 0, "maximum" = 1))]
        jitter: Option<N>,
        /// Whether the cells are taken in turn, round and round, or drawn.
        #[serde(default, skip_serializing_if = "is_default")]
        order: Order,
    },
    /// Every point of a rectangle alike, but for keeping its distance from the group's own points: Poisson-disc sampling.
    PoissonDisc {
        /// South-west corner in metres.
        low: [N; 2],
        /// North-east corner in metres, above `low` in both coordinates.
        high: [N; 2],
        /// Least distance in metres between two objects of the group, above 0.
        #[schemars(extend("exclusiveMinimum" = 0))]
        distance: N,
    },
    /// The free cells of the layout, each alike, and each for one object of the group: for groups, and, without `room` and
    /// `walk`, for the agent's start.
    Cells {
        /// By how many sides they can be left; any if absent.
        #[serde(default, skip_serializing_if = "is_default")]
        kind: CellKind,
        /// Those that one of these letters of a text stands for; any if absent. Letters for floor count if the legend names them.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(length(min = 1, max = 100))]
        letter: Option<String>,
        /// Those whose letters the legend gives to the group.
        #[serde(default, skip_serializing_if = "is_default")]
        of_group: bool,
        /// Those of the room in which the agent starts, or of the others; of all rooms if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        room: Option<CellRoom>,
        /// Least and greatest metres to walk from the cell in which the agent starts, from middle to middle; any if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(transform = schema::none_negative)]
        walk: Option<[N; 2]>,
        /// How far a place strays from the middle of its cell, as a share of the cell: 0 not at all, 1 anywhere in it; 0 if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(extend("minimum" = 0, "maximum" = 1))]
        jitter: Option<N>,
    },
    /// Every colour of a box in sRGB alike, or of the line between two of its corners.
    ColorUniform {
        /// One corner.
        from: Channels<N>,
        /// The corner opposite; each channel lies between those of the two, whichever is greater.
        to: Channels<N>,
        /// Whether each channel has chance of its own, which fills the box, or all have the same, which goes along the line.
        #[serde(default, skip_serializing_if = "is_default")]
        channels: ChannelChance,
    },
    /// Colours around a colour: each channel is normal, given that it falls in 0..1.
    ColorNormal {
        /// The colour in the middle: the mean before truncation.
        mean: Channels<N>,
        /// Standard deviation of the channels before truncation, 0..10: one number for all, or one for each.
        #[schemars(transform = schema::small_spread)]
        std: ChannelSpread<N>,
    },
    /// A colour with uniform noise, each channel cut off at limits, as the original's templates have it.
    ColorPerturb {
        /// The colour in the middle.
        value: Channels<N>,
        /// Greatest deviation of the channels to either side, 0..10: one number for all, or one for each.
        #[schemars(transform = schema::small_spread)]
        noise: ChannelSpread<N>,
        /// Limits below, at which smaller channels are cut off; black if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        low: Option<Channels<N>>,
        /// Limits above, at which greater channels are cut off; white if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        high: Option<Channels<N>>,
        /// Whether each channel has noise of its own, or all have the same, which makes lighter and darker shades.
        #[serde(default, skip_serializing_if = "is_default")]
        channels: ChannelChance,
    },
    /// Colours by hue, saturation and value, each drawn alike between its ends.
    ColorHsv {
        /// Hues in degrees, clockwise from the first to the second: 0 red, 120 green, 240 blue; across red as `[-20, 20]`; all if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        hue: Option<[N; 2]>,
        /// Saturation from 0 (grey) to 1 (full); all if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(transform = schema::up_to_1)]
        saturation: Option<[N; 2]>,
        /// Value from 0 (black) to 1 (bright); all if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(transform = schema::up_to_1)]
        value: Option<[N; 2]>,
    },
    /// One of several distributions, by weight, and then a draw from that.
    Mixture {
        /// The distributions: all of numbers, all of points, or all of colours.
        #[schemars(length(min = 1, max = 100))]
        parts: Vec<Distribution<N>>,
        /// Weight of each part, at least 0, not all 0; all alike if absent.
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

    /// Whether its draws depend on earlier objects: places taken in turn, or kept apart. Allowed in groups only.
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
