//! Moves several numbers at once, if their distances add up: computes points with the required sum, and checks whether the
//! task allows each. `scan.rs` takes over if no distance adds up, or the allowed region is too narrow to hit.

use std::collections::HashMap;

use driftworld_spec::{Value, Variant};

use super::reach::ChangeSet;
use super::search::{Changes, Found, Search, with};
use super::space::Space;
use super::subject::Free;

/// Number of parts into which the range of a number is divided for measuring.
const PARTS: usize = 128;

/// The same for each component of a vector.
const PARTS_OF_VECTOR: usize = 6;

/// Bisection steps within a part.
const MAX_BISECTIONS: u32 = 40;

/// Values of a parameter from end to end of its range, each with its distance.
struct Profile {
    samples: Vec<(Vec<f64>, f64)>,
}

/// The profiles measured so far, by parameter.
#[derive(Default)]
pub(super) struct Profiles(HashMap<String, Profile>);

impl Profiles {
    fn measure<D: FnMut(&Variant) -> f64>(&mut self, search: &mut Search<D>, free: Free) {
        if self.0.contains_key(free.0) {
            return;
        }
        let space = Space::new(search.from, &[free]);
        let parts = if space.axes.len() == 1 { PARTS } else { PARTS_OF_VECTOR };
        let mut samples = vec![Vec::new()];
        for axis in &space.axes {
            let mut stops: Vec<f64> = (0..=parts).map(|part| axis.at(part, parts)).collect();
            stops.push(axis.here);
            stops.sort_by(f64::total_cmp);
            stops.dedup();
            let longer = |place: Vec<f64>| {
                stops
                    .iter()
                    .map(move |stop| [&place[..], &[*stop]].concat())
                    .collect::<Vec<_>>()
            };
            samples = samples.into_iter().flat_map(longer).take(PARTS * PARTS).collect();
        }
        let measured = samples.into_iter().filter_map(|place| {
            let distance = search.measure_beyond(space.changes(&place))?;
            Some((place, distance))
        });
        let samples = measured.collect();
        self.0.insert(free.0.to_owned(), Profile { samples });
    }
}

impl<'a, D: FnMut(&Variant) -> f64> Search<'a, D> {
    /// An allowed point of a change set with the required sum, out of about `points` candidates; `None` if no candidate is
    /// allowed.
    pub(super) fn on_level(&mut self, set: &ChangeSet<'a>, profiles: &mut Profiles, points: usize) -> Option<Found> {
        for free in &set.smooth {
            profiles.measure(self, *free);
        }
        for last in (0..set.smooth.len()).filter(|last| !set.are_tied[*last]) {
            let mut others = set.smooth.clone();
            let last = others.remove(last);
            if matches!(self.from.value(last.0), Some(Value::Vector(_))) {
                continue;
            }
            let each = libm::pow(points as f64, 1.0 / others.len().max(1) as f64) as usize;
            let mut anchors: Vec<(Changes, f64)> = vec![(set.choices.clone(), set.sum.unwrap_or(0.0))];
            for other in others {
                let space = Space::new(self.from, &[other]);
                let samples = &profiles.0[other.0].samples;
                let step = (samples.len() as f64 / each.max(2) as f64).max(1.0);
                let chosen = (0..)
                    .map(|k| (f64::from(k) * step) as usize)
                    .take_while(|index| *index < samples.len() - 1);
                let chosen: Vec<usize> = chosen.chain([samples.len() - 1]).collect();
                let extend = |(changes, sum): &(Changes, f64)| {
                    let moved = chosen.iter().map(|index| {
                        let (place, distance) = &samples[*index];
                        (with(changes, &space.changes(place)), sum + distance)
                    });
                    let is_possible = |sum: f64| set.sum.is_none() || sum <= self.target + self.tolerance;
                    moved.filter(|(_, sum)| is_possible(*sum)).collect::<Vec<_>>()
                };
                anchors = anchors.iter().flat_map(extend).take(4 * points).collect();
            }
            let profile = &profiles.0[last.0];
            for (changes, sum) in &anchors {
                let sum = if set.sum.is_some() {
                    Some(*sum)
                } else {
                    self.measure_beyond(changes.clone())
                };
                let found = sum.and_then(|sum| self.complete_sum(last, profile, changes, sum));
                if found.is_some() {
                    return found;
                }
            }
        }
        None
    }

    /// An allowed value of the last number that contributes the rest of the sum.
    fn complete_sum(&mut self, last: Free<'a>, profile: &Profile, changes: &Changes, sum: f64) -> Option<Found> {
        let space = Space::new(self.from, &[last]);
        let rest = self.target - sum;
        for part in profile.samples.windows(2) {
            let [(low, near), (high, far)] = part else { continue };
            if (*near - rest) * (*far - rest) > 0.0 {
                continue;
            }
            let (mut low, mut high) = (low[0], high[0]);
            let is_rising = near < far;
            let mut share = if near == far { 0.0 } else { (rest - near) / (far - near) };
            for _ in 0..MAX_BISECTIONS {
                let at = if share == 0.0 { low } else { low + (high - low) * share };
                // If this value is not allowed, neighbouring values are assumed not to be either.
                let Some(found) = self.look(with(changes, &space.changes(&[at]))) else {
                    break;
                };
                if self.meets(&found) {
                    return Some(found);
                }
                if (found.distance < self.target) == is_rising {
                    low = at;
                } else {
                    high = at;
                }
                share = 0.5;
            }
        }
        None
    }
}
