//! Moves a single number whose distance does not depend on the others: finds the value that meets the target distance, and
//! checks whether the task allows it.

use driftworld_spec::{ParameterType, Variant};

use super::search::{Changes, Found, Search, with};
use super::space::Space;
use super::subject::Free;

/// Bisection steps per interval.
const MAX_BISECTIONS: u32 = 60;

/// Offsets of the target to try, as shares of the tolerance: if a requirement's border lies exactly at the target, one of them
/// is allowed.
const TARGET_OFFSETS: [f64; 3] = [0.0, -0.95, 0.95];

impl<'a, D: FnMut(&Variant) -> f64> Search<'a, D> {
    /// All allowed values of a number that, together with some choices, meet the target.
    pub(super) fn along_a_line(&mut self, choices: &Changes, moving: Free<'a>) -> Vec<Found> {
        let space = Space::new(self.from, &[moving]);
        let [axis] = &space.axes[..] else { return Vec::new() };
        let mut stops = vec![axis.low, axis.here, axis.high];
        if moving.1.kind == ParameterType::Heading {
            let opposite = [axis.here - 180.0, axis.here + 180.0];
            stops.extend(
                opposite
                    .into_iter()
                    .filter(|stop| (axis.low..=axis.high).contains(stop)),
            );
        }
        stops.sort_by(f64::total_cmp);
        stops.dedup();
        let mut measure = |search: &mut Self, at: f64| search.measure_beyond(with(choices, &space.changes(&[at])));
        let mut found = Vec::new();
        for interval in stops.windows(2) {
            let (Some(low), Some(high)) = (measure(self, interval[0]), measure(self, interval[1])) else {
                continue;
            };
            for offset in TARGET_OFFSETS {
                let target = self.target + offset * self.tolerance;
                let at = if (low - target).abs() <= self.tolerance * 0.04 {
                    interval[0]
                } else if (high - target).abs() <= self.tolerance * 0.04 {
                    interval[1]
                } else if (low < target) == (high < target) {
                    continue;
                } else {
                    self.bisect_interval(interval, target, low < target, &mut measure)
                };
                if let Some(candidate) = self
                    .look(with(choices, &space.changes(&[at])))
                    .filter(|candidate| self.meets(candidate))
                {
                    found.push(candidate);
                    break;
                }
            }
        }
        found
    }

    /// Bisects an interval for the target distance. `is_rising` says whether the distance grows from start to end.
    fn bisect_interval(
        &mut self,
        interval: &[f64],
        target: f64,
        is_rising: bool,
        measure: &mut impl FnMut(&mut Self, f64) -> Option<f64>,
    ) -> f64 {
        let (mut low, mut high) = (interval[0], interval[1]);
        for _ in 0..MAX_BISECTIONS {
            let at = f64::midpoint(low, high);
            let Some(distance) = measure(self, at) else { break };
            if (distance - target).abs() <= self.tolerance * 0.04 {
                return at;
            }
            if (distance < target) == is_rising {
                low = at;
            } else {
                high = at;
            }
        }
        f64::midpoint(low, high)
    }
}
