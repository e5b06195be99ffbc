//! Resets the fields of an object that the simulator ignores to their defaults, so that they do not count.

use driftworld_spec::{MotionModel, Object, Stimulus, Style, Surface};

/// The class whose objects display their text.
const SIGN: &str = "sign";

/// The object with all unread fields at their defaults: its pay if no stimulus triggers it, the range of a stimulus that it
/// does not have, the speed of a static object, the texture in a world with plain looks, and so on.
pub(super) fn as_read(object: &Object, style: Style) -> Object {
    let plain = Object::new(object.class.as_str(), object.coordinates);
    let mut read = object.clone();
    if style == Style::Plain {
        read.surface = Surface::Plain;
    }
    if !object.class.eq_ignore_ascii_case(SIGN) {
        read.text = None;
    }
    let pays = !(read.reward_stimulus.is_empty() && read.reward_once_stimulus.is_empty());
    if !pays {
        (read.reward, read.reward_probability) = (plain.reward, plain.reward_probability);
    }
    let stimuli = [
        &read.reward_stimulus,
        &read.reward_once_stimulus,
        &read.destroy_stimulus,
    ];
    let has_range = stimuli.iter().any(|list| list.contains(&Stimulus::AgentInRange)) || reacts_to_range(object);
    if !has_range {
        read.range_stimulus_distance = plain.range_stimulus_distance;
    }
    if read.destroy_stimulus.is_empty() {
        read.respawn = None;
    }
    let is_stationary = read.motion_model == MotionModel::Stationary;
    if is_stationary {
        (read.speed, read.turn_rate) = (plain.speed, None);
    }
    if !read.solid || !is_stationary {
        read.pushable = None;
    }
    if !matches!(read.motion_model, MotionModel::Predator | MotionModel::Prey) {
        read.sight_range = None;
    }
    if read.motion_model != MotionModel::Patrol {
        read.waypoints.clear();
    }
    read
}

/// Whether approaching the object changes it: opens or closes it, triggers it, picks it up.
fn reacts_to_range(object: &Object) -> bool {
    let is_near = |list: &Vec<Stimulus>| list.contains(&Stimulus::AgentInRange);
    let door = object.door.as_ref();
    door.is_some_and(|door| is_near(&door.opens_on) || is_near(&door.closes_on))
        || object.switch.as_ref().is_some_and(|switch| is_near(&switch.on))
        || object.portable.as_ref().is_some_and(|portable| is_near(&portable.on))
}
