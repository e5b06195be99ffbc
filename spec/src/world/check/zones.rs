//! Checks zones beyond the schema: their shape, and the places to which they teleport.

use crate::error::Problem;
use crate::world::WorldDraft;

/// Checks a world's zones beyond single fields.
pub(super) fn problems(world: &WorldDraft) -> Vec<Problem> {
    let arena = &world.environment_params;
    let mut problems = Vec::new();
    let teleports = arena.zones.iter().any(|zone| zone.teleport.is_some());
    let plan = teleports.then(|| world.valid_plan()).flatten();
    for (index, zone) in arena.zones.iter().enumerate() {
        let pointer = format!("/environment_params/zones/{index}");
        let found = match (&zone.disc, &zone.polygon) {
            (Some(_), Some(_)) => Some("both a disc and a polygon"),
            (None, None) => Some("neither a disc nor a polygon"),
            _ => None,
        };
        if let Some(found) = found {
            let advice = "such as \"disc\": { \"center\": [0, 0], \"radius\": 3 }";
            problems.push(Problem::new("spec/zone", pointer.clone(), found, "one of the two").advise(advice));
        }
        let Some([x, y]) = zone.teleport else { continue };
        if let Some(place) = arena.out_of_reach([x, y], plan.as_deref()) {
            let found = format!("({x}, {y}), {place}");
            let pointer = format!("{pointer}/teleport");
            problems.push(Problem::new("spec/zone", pointer, found, "a place on free ground"));
        }
    }
    problems
}

#[cfg(test)]
mod tests {
    use crate::World;

    fn check(zone: &str, expected: &str) {
        let text = format!(
            r#"{{ "environment_params": {{ "map_size": [20, 20], "zones": [{zone}],
               "walls": [{{ "polygon": [[5, 5], [8, 5], [8, 8]] }}] }} }}"#
        );
        let output = World::from_json("w.json", &text).map_or_else(
            |error| error.to_string(),
            |world| world.remarks("w.json", &text).iter().map(ToString::to_string).collect(),
        );
        assert!(
            output.contains(expected) && output.is_empty() == expected.is_empty(),
            "{output}"
        );
    }

    #[test]
    fn zone_problems_are_reported_with_their_place() {
        let disc = r#""disc": { "center": [0, 0], "radius": 3 }"#;
        check(&format!("{{ {disc} }}"), "");
        check(
            r#"{ "disc": { "center": [0, 14], "radius": 3 } }"#,
            "the zone lies outside the 20 × 20 m arena",
        );
        for row in r#"
{ } => ): found neither a disc nor a polygon
{ DISC, "polygon": [[0, 0], [1, 0], [0, 1]] } => ): found both a disc and a polygon
{ "polygon": [[0, 0], [1, 0]] } => /polygon)
{ "disc": { "center": [0, 0], "radius": 0 } } => /disc/radius)
{ DISC, "teleport": [11, 0] } => /teleport): found (11, 0), outside the 20 × 20 m arena
{ DISC, "teleport": [7.5, 6] } => /teleport): found (7.5, 6), inside the wall /environment_params/walls/0"#
            .trim()
            .lines()
        {
            let (zone, output) = row.split_once(" => ").expect("a row has two parts");
            check(
                &zone.replace("DISC", disc),
                &format!("(/environment_params/zones/0{output}"),
            );
        }
    }
}
