//! What is odd about a sound world: what means to move and stands still, and what stands where nobody comes. What is wrong with
//! one is said by the schema and in `mod.rs`.

use super::lock_remarks::lock_remarks;
use super::thing_remarks::thing_remarks;
use super::{EndCondition, MotionModel, Object, World, ZoneEnd};
use crate::layout::{self, Layout};
use crate::warning::{Remarks, Warning};

impl Object {
    /// Whether the object means to move by itself, and cannot: it has no speed, or its patrol no waypoints.
    pub fn stands_still(&self) -> bool {
        let goes_nowhere = self.motion_model == MotionModel::Patrol && self.waypoints.is_empty();
        self.motion_model != MotionModel::Stationary && (self.speed == 0.0 || goes_nowhere)
    }
}

impl World {
    /// What is odd about this world as the text that it was read from has it, with the places there; `name` is what messages call
    /// the text.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::World;
    /// let text = r#"{ "objects": [{ "class": "car", "coordinates": [3, 4], "motion_model": "prey" }] }"#;
    /// let remarks = World::from_json("w.json", text)?.remarks("w.json", text);
    /// assert_eq!(
    ///     remarks[0].to_string(),
    ///     "w.json:1:72 (/objects/0/motion_model): the car is to move as prey and stands still: it has no speed; set \"speed\""
    /// );
    /// # Ok::<(), driftworld_spec::SpecError>(())
    /// ```
    pub fn remarks(&self, name: &str, text: &str) -> Vec<Warning> {
        self.found_odd().in_text(name, text)
    }

    /// What is odd about this world, as [`World::remarks`], of a world that was read from no text: without lines and columns.
    pub fn remarks_without_text(&self) -> Vec<Warning> {
        self.found_odd().without_text("world")
    }

    fn found_odd(&self) -> Remarks {
        let mut remarks = Remarks::default();
        let arena = &self.environment_params;
        let [width, depth] = arena.arena_size();
        for (index, _) in arena
            .zones
            .iter()
            .enumerate()
            .filter(|(_, zone)| zone.is_outside(arena))
        {
            let text = format!("the zone lies outside the {width} × {depth} m arena; it is kept, out of reach");
            remarks.push(format!("/environment_params/zones/{index}"), text);
        }
        let start = self.agent_params.coordinates;
        if let Some(place) = self.place_out_of_reach(start).filter(|_| self.progress.is_none()) {
            remarks.push(
                "/agent_params/coordinates".to_owned(),
                format!("the agent starts {place}"),
            );
        }
        let failing = |place: [f64; 2]| {
            let mut zones = arena.zones.iter().enumerate();
            zones.find(|(_, zone)| zone.ends == Some(ZoneEnd::Failure) && zone.contains(place))
        };
        if let Some((zone, _)) = failing(start) {
            let text = format!("the agent starts in zone {zone}, which ends the episode as a failure");
            remarks.push("/agent_params/coordinates".to_owned(), text);
        }
        if let Some(odd) = self.plan().and_then(Layout::remark) {
            remarks.push(layout::POINTER.to_owned(), odd);
        }
        let lists = [("success", &self.rules.success), ("failure", &self.rules.failure)];
        for (list, conditions) in lists.into_iter().filter(|_| self.agent_params.energy.is_none()) {
            if let Some(index) = conditions.iter().position(|one| *one == EndCondition::OutOfEnergy) {
                let text = "out_of_energy never holds: the agent has no energy to use; set \"energy\" of agent_params";
                remarks.push(format!("/rules/{list}/{index}"), text.to_owned());
            }
        }
        for (index, object) in self.objects.iter().enumerate() {
            if let Some(place) = self.out_of_reach(object) {
                remarks.push(format!("/objects/{index}/coordinates"), place);
            }
            if let Some((zone, _)) = failing(object.coordinates).filter(|_| self.is_wanted(object)) {
                let text = format!(
                    "the {} stands in zone {zone}, which ends the episode as a failure before the agent gets there",
                    object.class
                );
                remarks.push(format!("/objects/{index}/coordinates"), text);
            }
            if object.text.is_some() && object.class.to_lowercase() != "sign" {
                let text = format!("a {} shows no text; signs do, the class \"sign\"", object.class);
                remarks.push(format!("/objects/{index}/text"), text);
            }
            if object.stands_still() {
                let model = serde_json::to_value(object.motion_model).unwrap_or_default();
                let lack = if object.speed == 0.0 {
                    "it has no speed; set \"speed\""
                } else {
                    "it has no waypoints; set \"waypoints\""
                };
                let (class, model) = (&object.class, model.as_str().unwrap_or_default());
                let text = format!("the {class} is to move as {model} and stands still: {lack}");
                remarks.push(format!("/objects/{index}/motion_model"), text);
            }
        }
        for (pointer, text) in thing_remarks(self).into_iter().chain(lock_remarks(self)) {
            remarks.push(pointer, text);
        }
        remarks
    }

    /// Whether the agent is to go to an object: it pays, or touching it or picking it up ends the episode well.
    fn is_wanted(&self, object: &Object) -> bool {
        let tag = object.tag.as_ref();
        let mut ends = self.rules.success.iter();
        let is_end = ends.any(|condition| match condition {
            EndCondition::Touch(wanted) | EndCondition::Carried(wanted) => Some(wanted) == tag,
            _ => false,
        });
        is_end || object.is_target()
    }

    /// Where an object stands that nobody comes to: outside the arena, or inside which wall; `None` on free ground.
    pub(crate) fn out_of_reach(&self, object: &Object) -> Option<String> {
        let place = self.place_out_of_reach(object.coordinates)?;
        let ([x, y], class) = (object.coordinates, &object.class);
        Some(format!(
            "the {class} stands at ({x:.1}, {y:.1}), {place}; it is kept, out of reach"
        ))
    }

    /// Where a place is that nobody comes to: outside the arena, or inside which wall; `None` on free ground.
    fn place_out_of_reach(&self, at: [f64; 2]) -> Option<String> {
        let arena = &self.environment_params;
        if arena.contains(at) {
            return Some(format!("inside {}", self.enclosure(at)?));
        }
        let [width, depth] = arena.arena_size();
        Some(format!("outside the {width} × {depth} m arena"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Rules, WorldDraft, Zone};

    #[test]
    fn a_start_and_a_goal_in_a_zone_that_fails_are_said() {
        let said = |start: [f64; 2], goal: [f64; 2], ends: Option<ZoneEnd>| {
            let mut world = WorldDraft::default();
            let mut zone = Zone::disc([5.0, 0.0], 2.0);
            zone.ends = ends;
            world.environment_params.zones = vec![zone];
            world.agent_params.coordinates = start;
            let mut cube = Object::new("cube", goal);
            cube.tag = Some("goal".to_owned());
            world.objects = vec![cube, Object::new("tree", [5.0, 1.0])];
            world.rules = Rules {
                success: vec![EndCondition::Touch("goal".to_owned())],
                ..Rules::default()
            };
            let world = world.check().expect("the world is sound");
            let text = serde_json::to_string(&world).expect("a world is JSON");
            let remarks = world.remarks("w.json", &text);
            remarks.iter().map(ToString::to_string).collect::<Vec<_>>()
        };
        let fails = Some(ZoneEnd::Failure);
        assert_eq!(said([-5.0, 0.0], [-9.0, 0.0], fails), [""; 0]);
        assert_eq!(said([5.0, 0.0], [5.0, 0.0], Some(ZoneEnd::Success)), [""; 0]);
        let start = said([5.0, 1.0], [-9.0, 0.0], fails);
        assert!(
            start.len() == 1 && start[0].contains("the agent starts in zone 0"),
            "{start:?}"
        );
        let goal = said([-5.0, 0.0], [4.0, 0.0], fails);
        assert!(
            goal.len() == 1 && goal[0].contains("the cube stands in zone 0"),
            "{goal:?}"
        );
    }
}
