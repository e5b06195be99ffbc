//! [`Mover`] decides where an object that moves by itself goes.

use driftworld_spec::{MotionModel, Object};

use super::rng::{Purpose, Seed, Stream};

/// Distance at which a waypoint counts as reached, in metres.
const REACHED: f32 = 0.3;

/// A wanderer gives up its goal if it moves less than this fraction of the intended distance.
const STUCK: f32 = 0.2;

/// State of an object that moves by itself.
#[derive(Clone, Debug)]
pub(super) struct Mover {
    /// The object's index in the world.
    pub(crate) object: usize,
    /// Index of the next point of a patrol.
    next: usize,
    /// A wanderer's goal.
    goal: Option<[f32; 2]>,
    /// The wanderer's random numbers, which depend only on the world's seed and the object.
    goal_stream: Stream,
    /// Number of goals drawn so far.
    goals: u64,
}

/// What a mover knows when it decides.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    /// Its position, in metres.
    pub(crate) position: [f32; 2],
    /// Its heading, in degrees.
    pub(crate) heading_deg: f32,
    /// The agent's position.
    pub(crate) agent: [f32; 2],
    /// Half the arena's sides.
    pub(crate) half: [f32; 2],
    /// Duration of a step in seconds.
    pub(crate) seconds: f32,
}

/// A mover's intended motion for a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stride {
    /// Its new heading in degrees.
    pub(crate) heading_deg: f32,
    /// Its intended displacement, in metres.
    pub(crate) by: [f32; 2],
}

impl Mover {
    /// The mover of an object; `None` if the object does not move by itself.
    pub(super) fn new(index: usize, object: &Object, seed: &Seed, identity: u64) -> Option<Self> {
        moves(object).then(|| Self {
            object: index,
            next: 0,
            goal: None,
            goal_stream: Stream::new(seed, identity, Purpose::Goals),
            goals: 0,
        })
    }

    /// The index of its next point, its goal, and the number of goals drawn.
    pub(super) fn progress(&self) -> (u32, Option<[f64; 2]>, u64) {
        let goal = self.goal.map(|goal| goal.map(f64::from));
        (self.next as u32, goal, self.goals)
    }

    /// Resumes from the result of [`Mover::progress`].
    pub(super) fn resume(&mut self, next: u32, goal: Option<[f64; 2]>, goals: u64) {
        self.next = next as usize;
        self.goal = goal.map(|goal| goal.map(|metres| metres as f32));
        self.goals = goals;
    }

    /// The object's intended motion; `None` if it stands still.
    pub(super) fn decide(&mut self, object: &Object, view: View) -> Option<Stride> {
        let wanted = self.direction(object, view)?;
        let bearing = libm::atan2f(wanted[0], wanted[1]).to_degrees();
        let turn = (bearing - view.heading_deg + 180.0).rem_euclid(360.0) - 180.0;
        let max_turn = object.turn_rate.map_or(180.0, |rate| rate as f32 * view.seconds);
        let heading_deg = (view.heading_deg + turn.clamp(-max_turn, max_turn)).rem_euclid(360.0);
        let mut metres = object.speed as f32 * view.seconds;
        // Stops at waypoints instead of overshooting them; objects that flee or hunt have no waypoints.
        if matches!(object.motion_model, MotionModel::Patrol | MotionModel::RandomWaypoint) {
            metres = metres.min(length(wanted));
            // Slows down while facing elsewhere, so that it does not circle around a waypoint towards which it cannot turn in time.
            metres *= libm::cosf((turn - turn.clamp(-max_turn, max_turn)).to_radians()).max(0.0);
        }
        let heading = heading_deg.to_radians();
        Some(Stride {
            heading_deg,
            by: [libm::sinf(heading) * metres, libm::cosf(heading) * metres],
        })
    }

    /// The vector to the object's goal, in metres; for prey, away from the agent.
    fn direction(&mut self, object: &Object, view: View) -> Option<[f32; 2]> {
        let to = |point: [f32; 2]| [point[0] - view.position[0], point[1] - view.position[1]];
        let to_agent = to(view.agent);
        let sees_agent = object.sight_range.is_none_or(|range| length(to_agent) <= range as f32);
        let direction = match object.motion_model {
            MotionModel::Predator if sees_agent => to_agent,
            MotionModel::Prey if sees_agent => to_agent.map(|metres| -metres),
            MotionModel::Stationary | MotionModel::Predator | MotionModel::Prey => return None,
            MotionModel::Patrol => {
                let point = |number: usize| object.waypoints[number].map(|metres| metres as f32);
                if object.waypoints.is_empty() {
                    return None;
                }
                if length(to(point(self.next))) < REACHED {
                    self.next = (self.next + 1) % object.waypoints.len();
                }
                to(point(self.next))
            }
            MotionModel::RandomWaypoint => {
                if self.goal.is_none_or(|goal| length(to(goal)) < REACHED) {
                    let sides = view.half.map(|half| (half - 1.0).max(0.0));
                    let units = self.goal_stream.draw(self.goals);
                    self.goals += 1;
                    self.goal = Some([0, 1].map(|axis| (units[axis] * 2.0 - 1.0) as f32 * sides[axis]));
                }
                to(self.goal?)
            }
        };
        (length(direction) > 1e-4).then_some(direction)
    }

    /// Records how far the object moved. A wanderer that hardly moved chooses a new goal.
    pub(super) fn report_motion(&mut self, intended: [f32; 2], actual: [f32; 2]) {
        if length(actual) < STUCK * length(intended) {
            self.goal = None;
        }
    }
}

/// Whether an object moves by itself.
fn moves(object: &Object) -> bool {
    object.motion_model != MotionModel::Stationary && object.speed > 0.0
}

fn length([x, y]: [f32; 2]) -> f32 {
    (x * x + y * y).sqrt()
}
