//! What the simulator reads of an object: fields that nothing reads stand at their defaults, so that they count nothing.

use driftworld_spec::{MotionModel, Object, Stimulus};

/// The object with everything that nothing reads at its default: what it pays where no stimulus makes it pay, the range of a
/// stimulus that it does not have, the speed of what stands, and so on.
pub(super) fn as_read(object: &Object) -> Object {
    let plain = Object::new(object.class.as_str(), object.coordinates);
    let mut read = object.clone();
    let pays = !(read.reward_stimulus.is_empty() && read.reward_once_stimulus.is_empty());
    if !pays {
        (read.reward, read.reward_probability) = (plain.reward, plain.reward_probability);
    }
    let stimuli = [
        &read.reward_stimulus,
        &read.reward_once_stimulus,
        &read.destroy_stimulus,
    ];
    let moves = [
        read.door.as_ref().map(|door| &door.opens_on),
        read.door.as_ref().map(|door| &door.closes_on),
        read.switch.as_ref().map(|switch| &switch.on),
        read.portable.as_ref().map(|portable| &portable.on),
    ];
    let has_range = stimuli
        .into_iter()
        .chain(moves.into_iter().flatten())
        .any(|list| list.contains(&Stimulus::AgentInRange));
    if !has_range {
        read.range_stimulus_distance = plain.range_stimulus_distance;
    }
    if read.destroy_stimulus.is_empty() {
        read.respawn = None;
    }
    let stands = read.motion_model == MotionModel::Stationary;
    if stands {
        (read.speed, read.turn_rate) = (plain.speed, None);
    }
    if !read.solid || !stands {
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
