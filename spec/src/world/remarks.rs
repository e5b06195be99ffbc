//! Remarks on a valid world: objects that should move but cannot, and objects that cannot be reached.

use super::lock_remarks::lock_remarks;
use super::thing_remarks::thing_remarks;
use super::{EndCondition, MotionModel, Object, World, ZoneEnd};
use crate::layout::{self, Layout};
use crate::warning::{Remarks, Warning};

impl Object {
    /// Whether the object should move by itself but cannot: it has no speed, or its patrol has no waypoints.
    pub fn stands_still(&self) -> bool {
        let has_no_waypoints = self.motion_model == MotionModel::Patrol && self.waypoints.is_empty();
        self.motion_model != MotionModel::Stationary && (self.speed == 0.0 || has_no_waypoints)
    }
}

impl World {
    /// The remarks on this world, with their lines and columns in the text from which it was read; `name` is the text's name in
    /// messages.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::World;
    /// let text = r#"{ "objects": [{ "class": "car", "coordinates": [3, 4], "motion_model": "prey" }] }"#;
    /// let remarks = World::from_json("w.json", text)?.remarks("w.json", text);
    /// assert_eq!(
    ///     remarks[0].to_string(),
    ///     "w.json:1:72 (/objects/0/motion_model): the car should move as prey but stands still: it has no speed; set \"speed\""
    /// );
    /// # Ok::<(), driftworld_spec::SpecError>(())
    /// ```
    pub fn remarks(&self, name: &str, text: &str) -> Vec<Warning> {
        self.collect_remarks().in_text(name, text)
    }

    /// Like [`World::remarks`], for a world that was not read from a text: without lines and columns.
    pub fn remarks_without_text(&self) -> Vec<Warning> {
        self.collect_remarks().without_text("world")
    }

    fn collect_remarks(&self) -> Remarks {
        let mut remarks = Remarks::default();
        let arena = &self.environment_params;
        let sides @ [width, depth] = arena.arena_size();
        let zones = arena.zones.iter().enumerate();
        for (index, _) in zones.filter(|(_, zone)| zone.is_outside(sides)) {
            let text = format!("the zone lies outside the {width} × {depth} m arena; it is kept but unreachable");
            remarks.push(format!("/environment_params/zones/{index}"), text);
        }
        for (pointer, fault) in self.polygon_faults() {
            remarks.push(pointer, format!("the polygon {fault}; it is kept unchanged"));
        }
        let start = self.agent_params.coordinates;
        if let Some(place) = arena
            .out_of_reach(start, self.plan())
            .filter(|_| self.progress.is_none())
        {
            remarks.push("/agent_params/coordinates", format!("the agent starts {place}"));
        }
        let failing = |place: [f64; 2]| {
            let mut zones = arena.zones.iter().enumerate();
            zones.find(|(_, zone)| zone.ends == Some(ZoneEnd::Failure) && zone.contains(place))
        };
        if let Some((zone, _)) = failing(start) {
            let text = format!("the agent starts in zone {zone}, which ends the episode as a failure");
            remarks.push("/agent_params/coordinates", text);
        }
        if let Some(odd) = self.plan().and_then(Layout::remark) {
            remarks.push(layout::POINTER, odd);
        }
        let lists = [("success", &self.rules.success), ("failure", &self.rules.failure)];
        for (list, conditions) in lists.into_iter().filter(|_| self.agent_params.energy.is_none()) {
            if let Some(index) = conditions.iter().position(|one| *one == EndCondition::OutOfEnergy) {
                let text = "out_of_energy never holds: the agent has no energy to use; set \"energy\" of agent_params";
                remarks.push(format!("/rules/{list}/{index}"), text);
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
                let text = format!("a {} shows no text; only the class \"sign\" does", object.class);
                remarks.push(format!("/objects/{index}/text"), text);
            }
            if object.stands_still() {
                let model = serde_json::to_value(object.motion_model).unwrap_or_default();
                let missing = if object.speed == 0.0 {
                    "it has no speed; set \"speed\""
                } else {
                    "it has no waypoints; set \"waypoints\""
                };
                let (class, model) = (&object.class, model.as_str().unwrap_or_default());
                let text = format!("the {class} should move as {model} but stands still: {missing}");
                remarks.push(format!("/objects/{index}/motion_model"), text);
            }
        }
        for (pointer, text) in thing_remarks(self).into_iter().chain(lock_remarks(self)) {
            remarks.push(pointer, text);
        }
        remarks
    }

    /// Polygons of walls and zones that have no area or cross themselves.
    fn polygon_faults(&self) -> Vec<(String, &'static str)> {
        let arena = &self.environment_params;
        let walls = arena.walls.iter().map(|wall| Some(&wall.polygon));
        let own = arena.layout.iter().flat_map(|layout| layout.walls.iter().flatten());
        let walls_of_layout = format!("{}/walls", layout::POINTER);
        let lists = [
            ("/environment_params/walls", walls.collect::<Vec<_>>()),
            (
                walls_of_layout.as_str(),
                own.map(|wall| wall.polygon.as_ref()).collect(),
            ),
            (
                "/environment_params/zones",
                arena.zones.iter().map(|zone| zone.polygon.as_ref()).collect(),
            ),
        ];
        let (mut pairs_left, mut faults) = (MAX_PAIRS, Vec::new());
        for (list, polygons) in lists {
            for (index, corners) in polygons.into_iter().enumerate() {
                let fault = corners.and_then(|corners| polygon_fault(corners, &mut pairs_left));
                faults.extend(fault.map(|fault| (format!("{list}/{index}/polygon"), fault)));
            }
        }
        faults
    }

    /// Whether the agent should go to an object: it pays, or touching it or picking it up is a success.
    fn is_wanted(&self, object: &Object) -> bool {
        let tag = object.tag.as_ref();
        let mut ends = self.rules.success.iter();
        let is_end = ends.any(|condition| match condition {
            EndCondition::Touch(wanted) | EndCondition::Carried(wanted) => Some(wanted) == tag,
            _ => false,
        });
        is_end || object.is_target()
    }

    /// Why an object cannot be reached: it is outside the arena, or inside a wall; `None` on free ground.
    pub(crate) fn out_of_reach(&self, object: &Object) -> Option<String> {
        let place = self.environment_params.out_of_reach(object.coordinates, self.plan())?;
        let ([x, y], class) = (object.coordinates, &object.class);
        Some(format!(
            "the {class} stands at ({x:.1}, {y:.1}), {place}; it is kept but unreachable"
        ))
    }
}

/// Maximum number of pairs of polygon sides to compare in one world.
const MAX_PAIRS: usize = 2_000_000;

/// The fault of a polygon; `pairs_left` is the number of pairs of sides that may still be compared.
fn polygon_fault(corners: &[[f64; 2]], pairs_left: &mut usize) -> Option<&'static str> {
    let turn = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let first = *corners.first()?;
    if corners
        .windows(2)
        .all(|side| turn(first, side[0], side[1]).abs() < 1e-9)
    {
        return Some("has no area");
    }
    let sides: Vec<_> = corners.iter().zip(corners.iter().cycle().skip(1)).collect();
    *pairs_left = pairs_left.checked_sub(sides.len() * sides.len() / 2)?;
    let differ = |p: f64, q: f64| (p > 0.0 && q < 0.0) || (p < 0.0 && q > 0.0);
    let crosses = |(index, (a, b)): (usize, &(&[f64; 2], &[f64; 2]))| {
        sides[..index].iter().any(|(c, d)| {
            differ(turn(**a, **b, **c), turn(**a, **b, **d)) && differ(turn(**c, **d, **a), turn(**c, **d, **b))
        })
    };
    sides.iter().enumerate().any(crosses).then_some("crosses itself")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Rules, WorldDraft, Zone};

    #[test]
    fn polygons_without_area_or_with_crossings_get_a_remark() {
        for (polygon, expected) in [
            ("[[0, 0], [2, 2], [4, 4]]", Some("has no area")),
            ("[[0, 0], [2, 2], [2, 0], [0, 2]]", Some("crosses itself")),
            ("[[0, 0], [4, 0], [4, 4], [2, 0], [0, 4]]", None),
            ("[[0, 0], [4, 0], [0, 4]]", None),
        ] {
            let own = format!(r#"{{ "polygon": {polygon} }}"#);
            for part in ["walls", "zones", "layout"] {
                let list = if part == "layout" {
                    format!(r#"{{ "walls": [{own}] }}"#)
                } else {
                    format!("[{own}]")
                };
                let text = format!(
                    r#"{{ "environment_params": {{ "{part}": {list} }}, "agent_params": {{ "coordinates": [-9, -9] }} }}"#
                );
                let world = World::from_json("w", &text).expect("it is valid");
                let remarks_of: Vec<String> = world.remarks("w", &text).iter().map(ToString::to_string).collect();
                let fits = remarks_of
                    .iter()
                    .filter(|remarks_of| remarks_of.contains("/0/polygon): the polygon "));
                let fits: Vec<bool> = fits
                    .map(|remarks_of| expected.is_some_and(|expected| remarks_of.contains(expected)))
                    .collect();
                assert_eq!(
                    fits,
                    vec![true; usize::from(expected.is_some())],
                    "{part} {polygon}: {remarks_of:?}"
                );
            }
        }
    }

    #[test]
    fn start_and_goal_in_a_failing_zone_get_remarks() {
        let remarks_of = |start: [f64; 2], goal: [f64; 2], ends: Option<ZoneEnd>| {
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
            let world = world.check().expect("the world is valid");
            let text = serde_json::to_string(&world).expect("a world is JSON");
            let remarks = world.remarks("w.json", &text);
            remarks.iter().map(ToString::to_string).collect::<Vec<_>>()
        };
        let fails = Some(ZoneEnd::Failure);
        assert_eq!(remarks_of([-5.0, 0.0], [-9.0, 0.0], fails), [""; 0]);
        assert_eq!(remarks_of([5.0, 0.0], [5.0, 0.0], Some(ZoneEnd::Success)), [""; 0]);
        let start = remarks_of([5.0, 1.0], [-9.0, 0.0], fails);
        assert!(
            start.len() == 1 && start[0].contains("the agent starts in zone 0"),
            "{start:?}"
        );
        let goal = remarks_of([-5.0, 0.0], [4.0, 0.0], fails);
        assert!(
            goal.len() == 1 && goal[0].contains("the cube stands in zone 0"),
            "{goal:?}"
        );
    }
}
