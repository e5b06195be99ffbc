//! [`Zone`]: a part of the ground that affects the agent inside it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::fields::{fields, word};
use super::region::encloses;
use crate::Color;
use crate::serde_defaults::{is_default, is_one, is_true};

fields! {
    /// A part of the ground, either a `disc` or a `polygon`. It affects the agent, and nothing else, while the agent's centre
    /// is in it. Starting in a zone counts as entering it in the first time step.
    ///
    /// Zones may overlap: their rewards are added, and their speed factors multiplied. If several end the episode in one time
    /// step, success takes precedence over failure; an ending takes precedence over a teleport; of several teleports, the first
    /// in the list counts. No zone is skipped: crossing one within a time step counts as entering it.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(default, deny_unknown_fields)]
    #[schemars(extend("examples" = [
        { "disc": { "center": [5, 0], "radius": 3 }, "name": "lava", "ends": "failure", "color": "orangered" },
        { "polygon": [[0, 0], [8, 0], [8, 4]], "reward_per_second": -1, "speed_factor": 0.5 },
    ]))]
    pub struct Zone {
        /// Its area, if it is a disc.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub disc: Option<Disc> = None => Field::ours(Measured(&[Zones, ZonePay, ZoneLooks])),
        /// Its area, if it is a polygon: corners in metres, in order; the last corner connects to the first.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(length(min = 3, max = 1000), inner(inner(range(min = -1e4, max = 1e4))))]
        pub polygon: Option<Vec<[f64; 2]>> = None => Field::ours(Measured(&[Zones, ZonePay, ZoneLooks])).unit("m"),
        /// A free-form name, for logs and display.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(length(min = 1, max = 100))]
        pub name: Option<String> = None => Field::ours(Not("it is a name")),
        /// Paid per second in it, for each time step that ends with the agent in it.
        #[serde(skip_serializing_if = "is_default")]
        #[schemars(range(min = -1e9, max = 1e9))]
        pub reward_per_second: f64 = 0.0 => Field::ours(Measured(&[ZonePay])),
        /// Paid whenever the agent enters it, by its own motion or by a teleport.
        #[serde(skip_serializing_if = "is_default")]
        #[schemars(range(min = -1e9, max = 1e9))]
        pub reward_on_entering: f64 = 0.0 => Field::ours(Measured(&[ZonePay])),
        /// Factor on the agent's speed, applied if the agent is in the zone at the beginning of a time step. The factors of
        /// overlapping zones are multiplied, up to at most 100.
        #[serde(skip_serializing_if = "is_one")]
        #[schemars(range(min = 0.0, max = 100.0))]
        pub speed_factor: f64 = 1.0 => Field::ours(Measured(&[Zones])),
        /// How the episode ends when the agent enters it; the episode continues if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub ends: Option<ZoneEnd> = None => Field::ours(Measured(&[ZonePay])),
        /// Position in metres to which the agent is moved at the end of the time step in which it enters; it arrives at rest,
        /// and next to anything that stands there. Zones that it enters in this way do not teleport it again.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(inner(inner(range(min = -300.0, max = 300.0))))]
        pub teleport: Option<[f64; 2]> = None => Field::ours(Measured(&[Zones])).unit("m"),
        /// Colour of its ground; if absent, a colour for its effect, listed in `docs/worlds.md`.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub color: Option<Color> = None => Field::ours(Measured(&[ZoneLooks])),
        /// Whether its ground is drawn in its colour.
        #[serde(skip_serializing_if = "is_true")]
        pub visible: bool = true => Field::ours(Measured(&[ZoneLooks])),
    }
}

fields! {
    /// A disc on the ground.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    #[schemars(extend("examples" = [{ "center": [5, 0], "radius": 3 }]))]
    pub struct Disc {
        /// Its centre in metres.
        #[schemars(inner(range(min = -1e4, max = 1e4)))]
        pub center: [f64; 2] => Field::ours(AsPart).unit("m"),
        /// Its radius in metres.
        #[schemars(range(min = 0.001, max = 1e4))]
        pub radius: f64 => Field::ours(AsPart).unit("m"),
    }
}

/// How a zone ends an episode.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ZoneEnd {
    /// As a success.
    Success,
    /// As a failure.
    Failure,
}

word!(ZoneEnd);

/// Maximum factor on the agent's speed, of one zone or of several together.
const MAX_SPEED_FACTOR: f64 = 100.0;

impl Zone {
    /// A round zone without effects, with everything else at its default.
    pub fn disc(center: [f64; 2], radius: f64) -> Self {
        Self {
            disc: Some(Disc { center, radius }),
            ..Self::default()
        }
    }

    /// The factor on the agent's speed in overlapping zones.
    pub fn speed_factor_of(factors: impl IntoIterator<Item = f64>) -> f64 {
        // The product could overflow to infinity, and a later factor of 0 would then give NaN.
        let product = factors
            .into_iter()
            .fold(1.0, |product: f64, factor| (product * factor).min(1e300));
        product.min(MAX_SPEED_FACTOR)
    }

    /// A zone with these corners and without effects, with everything else at its default.
    pub fn polygon(corners: Vec<[f64; 2]>) -> Self {
        Self {
            polygon: Some(corners),
            ..Self::default()
        }
    }

    /// Whether it contains a point in metres: nearer to the centre than the radius, or inside the corners by the even-odd rule.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::Zone;
    /// let pond = Zone::disc([5.0, 0.0], 3.0);
    /// assert!(pond.contains([7.0, 1.0]) && !pond.contains([1.0, 0.0]));
    /// ```
    pub fn contains(&self, point: [f64; 2]) -> bool {
        match (&self.disc, &self.polygon) {
            (Some(disc), _) => {
                let [x, y] = [0, 1].map(|axis| point[axis] - disc.center[axis]);
                x * x + y * y < disc.radius * disc.radius
            }
            (None, Some(corners)) => encloses(corners, point),
            (None, None) => false,
        }
    }

    /// Whether being in it is costly: it has a negative reward, or ends the episode as a failure.
    pub fn is_costly(&self) -> bool {
        self.reward_per_second < 0.0 || self.reward_on_entering < 0.0 || self.ends == Some(ZoneEnd::Failure)
    }

    /// Whether being in it is desirable: it pays or ends the episode as a success, and is not costly.
    pub fn is_wanted(&self) -> bool {
        let pays = self.reward_per_second > 0.0 || self.reward_on_entering > 0.0 || self.ends == Some(ZoneEnd::Success);
        pays && !self.is_costly()
    }

    /// Its colour on the ground: its own, or the colour for its effect. Red for failing or costly, green for success or reward,
    /// violet for a teleport, brown for slowing, blue for speeding up, grey for anything else.
    pub fn ground_color(&self) -> Color {
        self.color.unwrap_or_else(|| {
            Color(if self.is_costly() {
                [0.78, 0.2, 0.12]
            } else if self.is_wanted() {
                [0.25, 0.7, 0.3]
            } else if self.teleport.is_some() {
                [0.5, 0.3, 0.75]
            } else if self.speed_factor < 1.0 {
                [0.42, 0.31, 0.2]
            } else if self.speed_factor > 1.0 {
                [0.3, 0.55, 0.8]
            } else {
                [0.6, 0.6, 0.6]
            })
        })
    }

    /// Its bounding box: smallest and largest x and y in metres; `None` for a zone without ground.
    pub fn bounds(&self) -> Option<[[f64; 2]; 2]> {
        if let Some(Disc { center: [x, y], radius }) = self.disc {
            return Some([[x - radius, y - radius], [x + radius, y + radius]]);
        }
        let mut corners = self.polygon.iter().flatten();
        let first = *corners.next()?;
        Some(corners.fold([first, first], |[low, high], corner| {
            [
                [low[0].min(corner[0]), low[1].min(corner[1])],
                [high[0].max(corner[0]), high[1].max(corner[1])],
            ]
        }))
    }

    /// Whether its bounding box is entirely outside the arena, so that it cannot be entered.
    pub(super) fn is_outside(&self, sides: [f64; 2]) -> bool {
        self.bounds().is_some_and(|[low, high]| {
            (0..2).any(|axis| low[axis] >= sides[axis] / 2.0 || high[axis] <= -sides[axis] / 2.0)
        })
    }
}
