//! Remarks on doors, switches, portable objects and end conditions of a valid world that can never take effect.

use super::{ActionModel, EndCondition, Object, Stimulus, World};

/// The remarks, as pairs of a pointer to the subject and a text.
pub(super) fn thing_remarks(world: &World) -> Vec<(String, String)> {
    let mut found = Vec::new();
    for (index, object) in world.objects.iter().enumerate() {
        let at = |key: &str| format!("/objects/{index}/{key}");
        found.extend(door(world, object).map(|(key, text)| (at(key), text)));
        if let Some(switch) = &object.switch {
            if !has(world, &switch.target, |object| object.door.is_some()) {
                let text = format!("no door has the tag {:?}; the switch has no effect", switch.target);
                found.push((at("switch/target"), text));
            }
            found.extend(impossible_stimuli(world, object, &switch.on).map(|text| (at("switch/on"), text)));
        }
        if let Some(portable) = &object.portable {
            if world.agent_params.carry_limit == 0 {
                let text = format!(
                    "the {} can be carried, but the agent cannot carry anything; set /agent_params/carry_limit to 1 or more",
                    object.class
                );
                found.push((at("portable"), text));
            }
            found.extend(impossible_stimuli(world, object, &portable.on).map(|text| (at("portable/on"), text)));
        }
    }
    for (key, conditions) in [("success", &world.rules.success), ("failure", &world.rules.failure)] {
        for (place, condition) in conditions.iter().enumerate() {
            found.extend(ending(world, condition).map(|text| (format!("/rules/{key}/{place}"), text)));
        }
    }
    found
}

/// The remark on a door that nothing can open, with the key that it concerns.
fn door(world: &World, object: &Object) -> Option<(&'static str, String)> {
    let door = object.door.as_ref()?;
    let key = |tag: &String| has(world, tag, |object| object.portable.is_some());
    if let Some(tag) = door.key.as_ref().filter(|tag| !key(tag)) {
        return Some((
            "door/key",
            format!("no portable object has the tag {tag:?}; nothing unlocks the door"),
        ));
    }
    let by_switch = world.objects.iter().filter_map(|object| object.switch.as_ref());
    let mut by_switch = by_switch.filter(|switch| Some(&switch.target) == object.tag.as_ref());
    if door.opens_on.is_empty() && door.period.is_none() && !door.open && by_switch.next().is_none() {
        let text =
            "nothing opens the door: it has no stimulus in opens_on, no period, and no switch has its tag as target";
        return Some(("door/opens_on", text.to_owned()));
    }
    impossible_stimuli(world, object, &door.opens_on).map(|text| ("door/opens_on", text))
}

/// Why none of these stimuli can ever occur.
fn impossible_stimuli(world: &World, object: &Object, stimuli: &[Stimulus]) -> Option<String> {
    let agent = &world.agent_params;
    let interacts = agent.interact && agent.action_model != ActionModel::ByWaypoint;
    let can_occur = |stimulus: &Stimulus| match stimulus {
        Stimulus::AgentCollide => true,
        Stimulus::AgentInteract => interacts,
        Stimulus::AgentInRange => object.range_stimulus_distance > 0.0,
    };
    if stimuli.is_empty() || stimuli.iter().any(can_occur) {
        return None;
    }
    Some(if stimuli.contains(&Stimulus::AgentInRange) {
        "AgentInRange needs a range_stimulus_distance above 0".to_owned()
    } else {
        "the agent cannot interact: add \"AgentCollide\", or let it interact".to_owned()
    })
}

/// Why a condition can never hold.
fn ending(world: &World, condition: &EndCondition) -> Option<String> {
    let portable = |tag: &String| has(world, tag, |object| object.portable.is_some());
    let text = |tag: &String, what: &str| Some(format!("no {what} has the tag {tag:?}; this never ends the episode"));
    match condition {
        EndCondition::Touch(tag) if !has(world, tag, |_| true) => text(tag, "object"),
        EndCondition::Opened(tag) if !has(world, tag, |object| object.door.is_some()) => text(tag, "door"),
        EndCondition::Carried(tag) if !portable(tag) => text(tag, "portable object"),
        EndCondition::Delivered(delivery) if !has(world, &delivery.tag, |_| true) => text(&delivery.tag, "object"),
        EndCondition::Delivered(delivery) if !has(world, &delivery.to, |_| true) => text(&delivery.to, "object"),
        _ => None,
    }
}

/// Whether some object with a tag meets a condition.
fn has(world: &World, tag: &str, meets: impl Fn(&Object) -> bool) -> bool {
    let mut tagged = world.objects.iter().filter(|object| object.tag.as_deref() == Some(tag));
    tagged.any(meets)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{AgentParams, Delivery, Door, Portable, Rules, Switch, WorldDraft};

    fn check(change: impl FnOnce(&mut WorldDraft), expected: &[&str]) {
        let mut objects: Vec<Object> = ["door", "key", "switch"]
            .map(|class| Object::new(class, [3.0, 4.0]))
            .into();
        for object in &mut objects {
            object.tag = Some(object.class.clone());
        }
        objects[0].door = Some(Door {
            key: Some("key".into()),
            ..Door::default()
        });
        objects[1].portable = Some(Portable::default());
        objects[2].switch = Some(Switch::of("door"));
        let mut world = WorldDraft {
            objects,
            agent_params: AgentParams {
                carry_limit: 1,
                ..AgentParams::default()
            },
            ..WorldDraft::default()
        };
        change(&mut world);
        let world = world.check().expect("the world is valid despite remarks");
        let remarks: Vec<String> = thing_remarks(&world)
            .into_iter()
            .map(|(at, text)| format!("{at}: {text}"))
            .collect();
        assert_eq!(remarks.len(), expected.len(), "{remarks:?}");
        for (remarks, expected) in remarks.iter().zip(expected) {
            assert!(remarks.contains(expected), "{remarks}");
        }
    }

    #[test]
    fn doors_and_portables_that_can_never_be_used_get_a_remark() {
        check(|_| {}, &[]);
        let door =
            |change: fn(&mut Door)| move |world: &mut WorldDraft| change(world.objects[0].door.as_mut().unwrap());
        check(
            door(|door| door.key = Some("kay".into())),
            &["/objects/0/door/key: no portable object has the tag \"kay\""],
        );
        check(door(|door| door.opens_on.clear()), &[]);
        check(
            |world| {
                world.objects[0].door.as_mut().unwrap().opens_on.clear();
                world.objects[2].switch = None;
            },
            &["/objects/0/door/opens_on: nothing opens the door"],
        );
        check(
            door(|door| door.opens_on = vec![Stimulus::AgentInRange]),
            &["/objects/0/door/opens_on: AgentInRange needs a range_stimulus_distance"],
        );
        check(
            |world| world.agent_params.interact = false,
            &[
                "/objects/0/door/opens_on: the agent cannot",
                "/objects/1/portable/on",
                "/objects/2/switch/on",
            ],
        );
        check(
            |world| world.objects[2].switch.as_mut().unwrap().target = "dore".into(),
            &["/objects/2/switch/target: no door has the tag \"dore\""],
        );
        check(
            |world| world.agent_params.carry_limit = 0,
            &["/objects/1/portable: the key can be carried, but the agent cannot carry anything"],
        );
        check(
            |world| {
                let delivery = Delivery {
                    tag: "key".into(),
                    to: "box".into(),
                    within: 2.0,
                };
                let opened = EndCondition::Opened("key".into());
                let success = vec![
                    opened,
                    EndCondition::Delivered(delivery),
                    EndCondition::Carried("key".into()),
                    EndCondition::Touch("goal".into()),
                ];
                world.rules = Rules {
                    success,
                    ..Rules::default()
                };
            },
            &[
                "/rules/success/0: no door has the tag \"key\"",
                "/rules/success/1: no object has the tag \"box\"",
                "/rules/success/3: no object has the tag \"goal\"",
            ],
        );
    }
}
