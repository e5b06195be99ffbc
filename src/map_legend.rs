//! Draws the legend beside a map: objects by class, colour and reward, effects of zones, trigger ranges and paths, and scale and
//! north at the bottom.

use driftworld_env::Scene;
use driftworld_report::picture::{Drawing, Level, Picture, Rgb, Side, TextLine, ring, text_width};
use driftworld_spec::{MotionModel, Object, World, Zone, ZoneEnd};
use driftworld_text::{short, when};

use crate::map_colors::MapColors;
use crate::map_drawing::{INK, Moves, RING, TRAIL, WHITE, annotated, arrow, ground, map_size, pay, trigger_radius};
use crate::map_scale::{Bar, MapProjection, north, north_size};

/// Largest font size of the legend, in pixels.
const MAX_FONT_SIZE: f32 = 12.0;
/// Maximum length of the scale bar beside a map, in pixels.
const MAX_BAR: f32 = 140.0;

/// Draws a map of this height with the arena's aspect ratio. The legend to its right contains scale and north, so that they
/// cover nothing.
pub(crate) fn map_with_legend(world: &World, scene: &Scene, moves: &Moves, size: u32) -> Drawing {
    let ground = ground(scene, map_size(scene, size));
    let projection = MapProjection::of(scene, [ground.width, ground.height]);
    let entries = entries(world, scene, moves, &ground);
    let map = annotated(world, scene, moves, ground);
    let font_size = (size as f32 / 17.0).clamp(9.0, MAX_FONT_SIZE);
    let legend = legend(&entries, font_size, size, &projection);
    let mut drawing = Drawing::blank(map.width + legend.width, size);
    let left = map.width;
    drawing.put(map, [0, 0]);
    drawing.put(legend, [left, 0]);
    drawing
}

/// One line of a legend.
type Entry = (Mark, String);

#[derive(Clone, Debug, PartialEq)]
enum Mark {
    /// One to three colours.
    Colors(Vec<Rgb>),
    Zone(Rgb),
    Arrow,
    Ring,
    Trail,
    Path,
}

/// The entries of a map's legend: objects by class, colour and reward, then walls, zones, ranges and paths.
fn entries(world: &World, scene: &Scene, moves: &Moves, ground: &Picture) -> Vec<Entry> {
    let projection = MapProjection::of(scene, [ground.width, ground.height]);
    let agent = if moves.path.len() > 1 {
        "agent"
    } else {
        "agent, its start"
    };
    let mut entries = vec![(Mark::Arrow, agent.to_owned())];
    entries.extend(object_entries(world, scene, ground, &projection));
    for (number, zone) in world
        .environment_params
        .zones
        .iter()
        .enumerate()
        .filter(|(_, zone)| zone.visible)
    {
        let color = zone.ground_color().to_f32().map(|c| (c * 255.0) as u8);
        let mut words = vec![zone.name.clone().unwrap_or_else(|| format!("zone {number}"))];
        words.extend(effects(zone));
        let name = words.join(", ");
        if !entries.iter().any(|(_, other)| *other == name) {
            entries.push((Mark::Zone(color), name));
        }
    }
    let reaches: Vec<f32> = (0..world.objects.len())
        .filter(|index| scene.items.get(*index).is_some_and(|item| item.visible))
        .filter_map(|index| trigger_radius(world, scene, index))
        .collect();
    if let Some(first) = reaches.first() {
        let same = reaches.iter().all(|reach| (reach - first).abs() < 0.05);
        entries.push((
            Mark::Ring,
            format!("sets off{}", when(same, || format!(", {first:.1} m"))),
        ));
    }
    if !moves.trails.is_empty() {
        entries.push((Mark::Trail, format!("moves in {} s", moves.seconds.round())));
    }
    if world
        .objects
        .iter()
        .any(|object| object.motion_model == MotionModel::Patrol)
    {
        entries.push((Mark::Trail, "waypoints (dashed)".to_owned()));
    }
    if moves.path.len() > 1 {
        entries.push((Mark::Path, "the agent's path".to_owned()));
    }
    entries
}

/// The visible objects, grouped by name and reward, largest absolute reward first.
fn object_entries(world: &World, scene: &Scene, ground: &Picture, projection: &MapProjection) -> Vec<Entry> {
    let mut groups: Vec<(String, f64, Vec<usize>)> = Vec::new();
    let objects = world.objects.iter().zip(&scene.items).enumerate();
    for (index, (object, _)) in objects.filter(|(_, (_, item))| item.visible) {
        let (mut name, pay) = (named(object), pay(object));
        let mut failure = world.rules.failure.iter();
        if failure.any(|condition| condition.is_touch_of(object)) {
            name.push_str(", fails");
        }
        match groups.iter_mut().find(|group| group.0 == name && group.1 == pay) {
            Some(group) => group.2.push(index),
            None => groups.push((name, pay, vec![index])),
        }
    }
    groups.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    let colors = MapColors::of(scene);
    let entry = |(name, pay, members): (String, f64, Vec<usize>)| {
        let mut seen = colors.of_group(&members);
        if let (true, Some(first)) = (seen.is_empty(), members.first()) {
            seen.push(pixel_at(ground, projection.pixel(scene.items[*first].position)));
        }
        let count = when(members.len() > 1, || format!(" ×{}", members.len()));
        let pay = when(pay != 0.0, || format!(", {}", signed(pay)));
        (Mark::Colors(seen), format!("{name}{count}{pay}"))
    };
    groups.into_iter().map(entry).collect()
}

/// The effects of a zone as text.
fn effects(zone: &Zone) -> Vec<String> {
    let mut words = Vec::new();
    if zone.reward_per_second != 0.0 {
        words.push(format!("{}/s", signed(zone.reward_per_second)));
    }
    if zone.reward_on_entering != 0.0 {
        words.push(format!("{} on entering", signed(zone.reward_on_entering)));
    }
    if zone.speed_factor != 1.0 {
        words.push(format!("speed × {}", signed(zone.speed_factor).trim_start_matches('+')));
    }
    if zone.teleport.is_some() {
        words.push("teleports".to_owned());
    }
    match zone.ends {
        Some(ZoneEnd::Failure) => words.push("fails".to_owned()),
        Some(ZoneEnd::Success) => words.push("succeeds".to_owned()),
        None => {}
    }
    words
}

/// The name of a group of objects: their tag, which says what they are for, or else their shape or class.
pub(crate) fn named(object: &Object) -> String {
    let class = object.class.to_lowercase();
    let shape = match (class.as_str(), object.model.0.trim().to_lowercase().as_str()) {
        ("geometric", "1" | "cube") => "cube",
        ("geometric", "2" | "sphere") => "sphere",
        ("geometric", "3" | "cylinder") => "cylinder",
        (class, _) => class,
    };
    object.tag.clone().unwrap_or_else(|| shape.to_owned())
}

/// A reward with its sign.
fn signed(pay: f64) -> String {
    let sign = if pay < 0.0 { "−" } else { "+" };
    format!("{sign}{}", short(pay.abs(), 2))
}

fn pixel_at(picture: &Picture, [x, y]: [f32; 2]) -> Rgb {
    let clamped = |pixel: f32, size: u32| (pixel.max(0.0) as u32).min(size.saturating_sub(1)) as usize;
    let start = (clamped(y, picture.height) * picture.width as usize + clamped(x, picture.width)) * 3;
    [picture.rgb[start], picture.rgb[start + 1], picture.rgb[start + 2]]
}

/// Draws the legend in a column of this height, with scale and north at the bottom. The last line counts the entries that do
/// not fit; the agent's entry is left out first. If only one line fits and there are more entries, there is no text.
fn legend(entries: &[Entry], font_size: f32, height: u32, projection: &MapProjection) -> Drawing {
    let line = (font_size * 1.45).round();
    let bar = Bar::of(projection, (0.3 * projection.size[0]).min(MAX_BAR));
    let arrow_side = north_size((height as f32).min(280.0));
    let foot = bar.size()[1].max(arrow_side) + 2.0;
    // A small legend has no room for the note.
    let note = if height as f32 > 9.0 * line + foot {
        "in even light"
    } else {
        ""
    };
    let note_height = if note.is_empty() { 0.0 } else { font_size + 6.0 };
    let max_lines = (((height as f32 - foot - note_height - 6.0) / line).floor().max(1.0)) as usize;
    let mut shown: Vec<(Option<Mark>, String)> = entries
        .iter()
        .map(|(mark, name)| (Some(mark.clone()), name.clone()))
        .collect();
    if shown.len() > max_lines {
        // The agent needs no explanation.
        shown.rotate_left(1);
        let left_out = shown.len() - max_lines + 1;
        shown.truncate(max_lines - 1);
        // Without entries above it, the count would be meaningless.
        if !shown.is_empty() {
            shown.push((None, format!("and {left_out} more")));
        }
    }
    let left = 6.0 + font_size * 1.6;
    let names = shown.iter().map(|(_, name)| name.as_str()).chain([note]);
    let wide = names.map(|name| text_width(name, font_size)).fold(0.0, f32::max);
    let wide = (left + wide + 6.0).max(bar.size()[0] + arrow_side + 10.0);
    let mut legend = Drawing::blank(wide.ceil() as u32, height);
    for (number, (mark, name)) in shown.iter().enumerate() {
        let y = 6.0 + line * (number as f32 + 0.5);
        let (x, r) = (6.0 + font_size * 0.6, font_size * 0.42);
        match mark {
            Some(Mark::Colors(colors)) => swatch(&mut legend, [x, y], r, colors),
            Some(Mark::Zone(color)) => {
                legend.rectangle([x - r - 0.8, y - r - 0.8, 2.0 * r + 1.6, 2.0 * r + 1.6], INK);
                legend.rectangle([x - r, y - r, 2.0 * r, 2.0 * r], *color);
            }
            Some(Mark::Arrow) => arrow(&mut legend, [x, y], 90.0, r),
            Some(Mark::Ring) => {
                legend.line(ring([x, y], r), 3.0, INK);
                legend.line(ring([x, y], r), 1.6, RING);
            }
            Some(Mark::Trail) => {
                legend.line([[x - r, y], [x + r, y]], 4.0, INK);
                legend.line([[x - r, y], [x + r, y]], 2.4, TRAIL);
            }
            Some(Mark::Path) => {
                legend.line([[x - r, y], [x + r, y]], 4.0, INK);
                legend.line([[x - r, y], [x + r, y]], 2.0, WHITE);
            }
            None => {}
        }
        legend.write(TextLine::new(name, [left, y], font_size, INK).anchored(Side::Left, Level::Middle));
    }
    let top = height as f32 - foot;
    if !note.is_empty() {
        let words = TextLine::new(note, [6.0, top - 5.0], font_size * 0.9, [110, 116, 124]);
        legend.write(words.anchored(Side::Left, Level::Bottom));
    }
    bar.draw(&mut legend, [2.0, height as f32 - bar.size()[1] - 2.0], false);
    let at = [legend.width as f32 - arrow_side - 2.0, height as f32 - arrow_side - 2.0];
    north(&mut legend, at, arrow_side);
    legend
}

/// A disc with a sector for each colour.
fn swatch(legend: &mut Drawing, middle: [f32; 2], radius: f32, colors: &[Rgb]) {
    legend.disc(middle, radius + 0.8, INK);
    let rim = ring(middle, radius);
    let corner = |number: usize| number * (rim.len() - 1) / colors.len();
    for (number, color) in colors.iter().enumerate() {
        if number == 0 {
            legend.disc(middle, radius, *color);
        } else {
            let mut sector = rim[corner(number)..=corner(number + 1)].to_vec();
            sector.push(middle);
            legend.area(sector, *color);
        }
    }
}

#[cfg(test)]
mod tests {
    use driftworld_spec::{Color, EndCondition, Stimulus, WorldDraft};
    use proptest::prelude::*;

    use super::*;
    use crate::map_drawing::world_of_agent;

    fn object(class: &str, at: [f64; 2], reward: f64) -> Object {
        let mut object = Object::new(class, at);
        object.reward = reward;
        if reward != 0.0 {
            object.reward_once_stimulus = vec![Stimulus::AgentCollide];
        }
        object
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(12))]

        /// The legend covers nothing: the map beside it has no scale and no north.
        #[test]
        fn map_beside_a_legend_is_bare(x in -0.46..0.46_f64, y in -0.46..0.46_f64, heading in 0.0..360.0_f64, size in 80_u32..300) {
            let side = 16.0;
            let world = world_of_agent(side, [x, y], heading);
            let scene = Scene::from_world(&world);
            let bare = annotated(&world, &scene, &Moves::none(&world), ground(&scene, [size, size])).to_picture();
            let beside = map_with_legend(&world, &scene, &Moves::none(&world), size).to_picture();
            let row = |picture: &Picture, row: u32| {
                let start = (row * picture.width * 3) as usize;
                picture.rgb[start..][..(size * 3) as usize].to_vec()
            };
            for number in 0..size {
                prop_assert_eq!(row(&beside, number), row(&bare, number), "row {}", number);
            }
        }
    }

    #[test]
    fn legend_lists_exactly_what_is_on_the_map() {
        let mut gone = object("tent", [3.0, 3.0], 0.0);
        gone.color = Some(Color([1.0, 0.0, 0.0]));
        let objects = vec![
            object("geometric", [0.0, 0.0], 100.0),
            object("geometric", [4.0, 0.0], 100.0),
            object("geometric", [0.0, 5.0], -20.0),
            object("tree", [-5.0, 0.0], 0.0),
            gone,
        ];
        let mut draft = WorldDraft::with_objects(objects);
        draft.environment_params.map_size = [30.0, 30.0];
        draft.agent_params.coordinates = [10.0, 10.0];
        let world = draft.check().expect("the world is valid");
        let mut scene = Scene::from_world(&world);
        let names = |scene: &Scene| -> Vec<String> {
            let drawing = map_with_legend(&world, scene, &Moves::none(&world), 300);
            drawing.texts().into_iter().map(str::to_owned).collect()
        };
        let has = |scene: &Scene, name: &str| names(scene).iter().any(|other| other == name);
        for name in ["cube ×2, +100", "cube, −20", "tree", "tent", "agent, its start"] {
            assert!(has(&scene, name), "{name}: {:?}", names(&scene));
        }
        assert_eq!(names(&scene).iter().filter(|name| name.contains("cube")).count(), 2);
        scene.items[4].visible = false;
        assert!(!has(&scene, "tent") && !names(&scene).iter().any(|name| name.contains("rock")));
    }

    /// The legend contains the effects of zones, including an episode's end as a failure.
    #[test]
    fn legend_describes_the_effects_of_zones() {
        let zone = |name: &str, change: &dyn Fn(&mut Zone)| {
            let mut zone = Zone::disc([0.0, 0.0], 3.0);
            zone.name = Some(name.to_owned());
            change(&mut zone);
            zone
        };
        let mut thorn = object("shrub", [4.0, 4.0], 0.0);
        thorn.tag = Some("thorn".to_owned());
        let mut draft = WorldDraft::with_objects(vec![thorn]);
        draft.rules.failure = vec![EndCondition::Touch("thorn".to_owned())];
        draft.environment_params.map_size = [30.0, 30.0];
        draft.environment_params.zones = vec![
            zone("lava", &|zone| zone.ends = Some(ZoneEnd::Failure)),
            zone("mud", &|zone| (zone.speed_factor, zone.reward_per_second) = (0.2, -1.5)),
            zone("gate", &|zone| zone.teleport = Some([5.0, 5.0])),
            zone("home", &|zone| {
                (zone.ends, zone.reward_on_entering) = (Some(ZoneEnd::Success), 7.0);
            }),
        ];
        let world = draft.check().expect("the world is valid");
        let drawing = map_with_legend(&world, &Scene::from_world(&world), &Moves::none(&world), 300);
        let texts = drawing.texts();
        for name in [
            "thorn, fails",
            "lava, fails",
            "mud, −1.5/s, speed × 0.2",
            "gate, teleports",
            "home, +7 on entering, succeeds",
        ] {
            assert!(texts.contains(&name), "{name}: {texts:?}");
        }
    }
}
