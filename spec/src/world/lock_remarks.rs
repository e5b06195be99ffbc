//! Remarks on the positions of doors and keys: doors with all keys behind locked doors, and doors that overlap.

use std::collections::BTreeSet;

use super::World;
use crate::layout::Plan;

/// Maximum number of doors that are checked, because the check compares all doors with each other.
const MAX_DOORS: usize = 1000;

/// The part of a layout that a locked door blocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Barrier {
    /// The side between two cells, the lower index first.
    Side(usize, usize),
    /// The cell in which the door stands.
    Cell(usize),
}

/// The remarks, as pairs of a pointer to the subject and a text.
pub(super) fn lock_remarks(world: &World) -> Vec<(String, String)> {
    let doors = world.objects.iter().filter(|object| object.door.is_some()).count();
    if doors == 0 || doors > MAX_DOORS {
        return Vec::new();
    }
    let mut found = locked_forever(world);
    found.extend(overlapping(world));
    found
}

/// The locked doors of a layout with all keys behind locked doors that stay shut. Doors without a lock, and doors opened by a
/// switch or a clock, count as open.
fn locked_forever(world: &World) -> Vec<(String, String)> {
    let Some(plan) = world.plan() else { return Vec::new() };
    let Some(start) = plan.cell_at(world.agent_params.coordinates) else {
        return Vec::new();
    };
    let switched = |tag: Option<&String>| {
        let mut switches = world.objects.iter().filter_map(|object| object.switch.as_ref());
        tag.is_some() && switches.any(|switch| Some(&switch.target) == tag)
    };
    let mut locked: Vec<(usize, &String, Barrier)> = Vec::new();
    for (index, object) in world.objects.iter().enumerate() {
        let Some(door) = object.door.as_ref().filter(|door| !door.open && door.period.is_none()) else {
            continue;
        };
        if let Some(key) = door.key.as_ref().filter(|_| !switched(object.tag.as_ref()))
            && let Some(barrier) = barrier(plan, object.coordinates)
        {
            locked.push((index, key, barrier));
        }
    }
    let keys: Vec<(&String, usize)> = world
        .objects
        .iter()
        .filter(|object| object.portable.is_some())
        .filter_map(|object| Some((object.tag.as_ref()?, plan.cell_at(object.coordinates)?)))
        .collect();
    let tags: BTreeSet<&String> = keys.iter().map(|(tag, _)| *tag).collect();
    locked.retain(|(_, key, _)| tags.contains(key));
    loop {
        let reached = reached(plan, start, &locked.iter().map(|(.., barrier)| *barrier).collect());
        let owned: BTreeSet<&String> = keys
            .iter()
            .filter(|(_, cell)| reached[*cell])
            .map(|(tag, _)| *tag)
            .collect();
        let before = locked.len();
        locked.retain(|(_, key, _)| !owned.contains(key));
        if locked.len() == before {
            break;
        }
    }
    let remark = |(index, key, _): (usize, &String, Barrier)| {
        let text = format!(
            "every {key:?} lies behind this door or behind others that stay locked; put one where the agent can get it first"
        );
        (format!("/objects/{index}/door/key"), text)
    };
    locked.into_iter().map(remark).collect()
}

/// The part of the layout blocked by a door at this position.
fn barrier(plan: &Plan, at: [f64; 2]) -> Option<Barrier> {
    let own = plan.cell_at(at);
    let stands_in = |center: [f64; 2], width: f64| (0..2).all(|axis| (center[axis] - at[axis]).abs() < width / 2.0);
    let doorway = plan
        .doorways
        .iter()
        .find(|doorway| stands_in(doorway.center, doorway.width));
    let sides = doorway.and_then(|doorway| {
        let axis = usize::from(doorway.heading == 0.0);
        let [before, beyond] = [-0.5, 0.5].map(|share| {
            let mut at = doorway.center;
            at[axis] += share * plan.cell[axis];
            plan.cell_at(at)
        });
        // In a text layout the doorway is a cell of its own.
        let is_between = plan.cell_at(doorway.center) != before && doorway.depth < plan.cell[axis];
        is_between.then_some((before?, beyond?))
    });
    let side = sides.map(|(a, b)| Barrier::Side(a.min(b), a.max(b)));
    side.or(own.map(Barrier::Cell))
}

/// For each cell, whether it can be reached from `start` without passing a barrier.
fn reached(plan: &Plan, start: usize, barriers: &BTreeSet<Barrier>) -> Vec<bool> {
    let mut reached = vec![false; plan.cells.len()];
    plan.reach(start, &mut reached, |cell, next| {
        !barriers.contains(&Barrier::Cell(next)) && !barriers.contains(&Barrier::Side(cell.min(next), cell.max(next)))
    });
    reached
}

/// Doors that overlap: closer to each other than half the width of the narrower one.
fn overlapping(world: &World) -> Vec<(String, String)> {
    let mut doors: Vec<(usize, [f64; 2], f64)> = world
        .objects
        .iter()
        .enumerate()
        .filter(|(_, object)| object.door.is_some())
        .map(|(index, object)| (index, object.coordinates, object.scale))
        .collect();
    doors.sort_by(|a, b| a.1[0].total_cmp(&b.1[0]).then(a.0.cmp(&b.0)));
    let mut found = Vec::new();
    for (number, (index, position, scale)) in doors.iter().enumerate() {
        // One report per door is enough, and keeps the search short if all are in one place.
        let near = doors[number + 1..]
            .iter()
            .take_while(|(_, other, _)| other[0] - position[0] < scale / 2.0);
        let mut near = near.filter(|(_, other, width)| {
            let offset = [0, 1].map(|axis| other[axis] - position[axis]);
            libm::hypot(offset[0], offset[1]) < scale.min(*width) / 2.0
        });
        if let Some((other, ..)) = near.next() {
            let (first, second) = (index.min(other), index.max(other));
            let text = format!("the door overlaps that of /objects/{first}; move one of them");
            found.push((format!("/objects/{second}/coordinates"), text));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::WorldDraft;

    fn remarks(layout: &str, objects: &str) -> Vec<String> {
        let text = format!(
            r#"{{ "environment_params": {{ "layout": {layout} }}, "agent_params": {{ "coordinates": [-4, 0], "carry_limit": 1 }},
                "objects": {objects} }}"#
        );
        let world: WorldDraft = serde_json::from_str(&text).expect("it is a world");
        let world = world.check().expect("the world is valid despite remarks");
        lock_remarks(&world)
            .into_iter()
            .map(|(at, text)| format!("{at}: {text}"))
            .collect()
    }

    const TEXT: &str = r#"{ "text": ["A. D .L ."], "legend": { "L": "floor" }, "cell": 1 }"#;

    fn in_a_row(keys: [f64; 2]) -> Vec<String> {
        let objects = format!(
            r#"[{{ "class": "door", "coordinates": [-1, 0], "tag": "a", "door": {{ "key": "red" }} }},
                {{ "class": "door", "coordinates": [2, 0], "tag": "b", "door": {{ "key": "blue" }} }},
                {{ "class": "key", "coordinates": [{}, 0], "tag": "red", "portable": {{}} }},
                {{ "class": "key", "coordinates": [{}, 0], "tag": "blue", "portable": {{}} }}]"#,
            keys[0], keys[1]
        );
        remarks(TEXT, &objects)
    }

    #[test]
    fn keys_behind_their_own_doors_get_a_remark() {
        assert_eq!(in_a_row([-3.0, 0.0]), [""; 0]);
        assert_eq!(in_a_row([-3.0, -2.0]), [""; 0]);
        let behind = in_a_row([-3.0, 4.0]);
        assert!(
            behind.len() == 1 && behind[0].starts_with("/objects/1/door/key: every \"blue\" lies"),
            "{behind:?}"
        );
        assert_eq!(
            in_a_row([0.0, -2.0]).len(),
            1,
            "the red key is behind the red door; the blue one is within reach"
        );
        assert_eq!(in_a_row([4.0, 0.0]).len(), 2, "neither can be opened first");
    }

    #[test]
    fn doors_between_cells_block_their_doorway_and_switches_open_them() {
        let rooms = r#"{ "rooms": { "grid": [2, 1], "room": [6, 2], "doorway": 1, "wall": 0.2, "seed": 1 } }"#;
        let objects = |key: &str, more: &str| {
            format!(
                r#"[{{ "class": "door", "coordinates": [0, DOOR], "heading": 90, "tag": "gate", "door": {{ "key": "red" }} }},
                    {{ "class": "key", "coordinates": [{key}, 0.5], "tag": "red", "portable": {{}} }}{more}]"#
            )
        };
        let plan = serde_json::from_str::<crate::Layout>(rooms).unwrap().plan(0);
        let position = |text: String| text.replace("DOOR", &plan.doorways[0].center[1].to_string());
        assert_eq!(remarks(rooms, &position(objects("-2", ""))), [""; 0]);
        assert_eq!(remarks(rooms, &position(objects("2", ""))).len(), 1);
        let switch = r#", { "class": "switch", "coordinates": [-2, -0.5], "switch": { "target": "gate" } }"#;
        assert_eq!(remarks(rooms, &position(objects("2", switch))), [""; 0]);
    }

    #[test]
    fn overlapping_doors_get_a_remark() {
        let doors = |x: f64| {
            let objects = format!(
                r#"[{{ "class": "door", "coordinates": [{x}, 0], "door": {{}} }},
                    {{ "class": "door", "coordinates": [0, 0], "scale": 2, "door": {{}} }}]"#
            );
            remarks(r#"{ "walls": [] }"#, &objects)
        };
        assert_eq!(doors(0.6), [""; 0]);
        let expected = ["/objects/1/coordinates: the door overlaps that of /objects/0; move one of them"];
        assert_eq!(doors(0.4), expected);
        assert_eq!(doors(-0.4), expected);
    }
}
