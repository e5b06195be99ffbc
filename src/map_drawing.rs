//! Maps that can be read: the ground from above with a scale, north, where the agent starts, what pays and what costs,
//! how far triggers reach and where things move; beside it, what is on it. How the ground is drawn is `env`'s.

#![expect(clippy::disallowed_methods, reason = "where lines and words stand on a map")]

use driftworld_env::{Scene, top_down};
use driftworld_report::picture::{Drawing, Level, Picture, Rgb, Shape, Side, TextLine, ring, text_width};
use driftworld_spec::{EndCondition, MotionModel, Object, Stimulus, World, Zone, ZoneEnd};

use crate::map_scale::{Bar, CORNERS, Places, freest, north, north_size};

const INK: Rgb = [20, 24, 30];
const WHITE: Rgb = [255, 255, 255];
/// How far triggers reach.
const RING: Rgb = [255, 214, 0];
/// Ways that things take.
const TRAIL: Rgb = [255, 120, 200];
const PAYS: Rgb = [0, 110, 50];
const COSTS: Rgb = [190, 0, 20];
/// With more objects that pay or cost than this, none has a sign of its own.
const MOST_SIGNS: usize = 60;
/// Letters of the legend are this large at most, in pixels.
const LEGEND: f32 = 12.0;
/// The longest bar beside a map, in pixels.
const LONGEST_BAR: f32 = 140.0;
/// A smaller map without a legend has no room for a scale.
const LEAST_SCALED: u32 = 80;
/// A map is at most so many times as wide as high, and as high as wide.
const MOST_OBLONG: f32 = 2.0;

/// What a map shows beside what stands in its world.
#[derive(Clone, Debug, Default)]
pub(crate) struct Moves {
    /// Where the agent is, and its heading in degrees.
    pub(crate) agent: ([f32; 2], f32),
    /// The way that the agent took.
    pub(crate) way: Vec<[f32; 2]>,
    /// The ways of objects that moved.
    pub(crate) trails: Vec<Vec<[f32; 2]>>,
    /// For how many seconds they did.
    pub(crate) seconds: f64,
}

impl Moves {
    /// A world at its start.
    pub(crate) fn none(world: &World) -> Self {
        let agent = &world.agent_params;
        Self {
            agent: (agent.coordinates.map(|metres| metres as f32), agent.heading as f32),
            ..Self::default()
        }
    }
}

/// A map of so many pixels from north to south, as wide as its arena is, and to its right the legend with scale and north, where they
/// cover nothing.
pub(crate) fn map_with_legend(world: &World, scene: &Scene, moves: &Moves, size: u32) -> Drawing {
    let ground = ground(scene, map_size(scene, size));
    let places = Places::of(scene, [ground.width, ground.height]);
    let entries = entries(world, scene, moves, &ground);
    let map = annotated(world, scene, moves, ground);
    let letters = (size as f32 / 17.0).clamp(9.0, LEGEND);
    let legend = legend(&entries, letters, size, &places);
    let mut drawing = Drawing::blank(map.width + legend.width, size);
    let left = map.width;
    drawing.put(map, [0, 0]);
    drawing.put(legend, [left, 0]);
    drawing
}

/// The map alone, a square, with scale and north in the corners where they cover least.
pub(crate) fn map(world: &World, scene: &Scene, moves: &Moves, size: u32) -> Drawing {
    let mut map = annotated(world, scene, moves, ground(scene, [size, size]));
    if size < LEAST_SCALED {
        return map;
    }
    let places = Places::of(scene, [size, size]);
    let visible = scene.items.iter().filter(|item| item.visible);
    // The agent's place counts for more than anything else.
    let mut marks = vec![(places.pixel(moves.agent.0), 1_000.0)];
    marks.extend(visible.map(|item| (places.pixel(item.position), 1.0)));
    marks.extend(places.pixels(&moves.way).into_iter().map(|place| (place, 0.01)));
    let mut corners = CORNERS.to_vec();
    let bar = Bar::of(&places, size as f32 * 0.3);
    let at = freest(&mut corners, bar.size(), places.size, &marks);
    bar.draw(&mut map, at, true);
    corners.reverse();
    let side = north_size(size as f32);
    north(&mut map, freest(&mut corners, [side; 2], places.size, &marks), side);
    map
}

/// Pixels across and down of a map that is so high: as oblong as the arena, within limits.
pub(crate) fn map_size(scene: &Scene, height: u32) -> [u32; 2] {
    let [wide, deep] = scene.arena_size();
    let aspect = (wide / deep.max(1e-3)).clamp(1.0 / MOST_OBLONG, MOST_OBLONG);
    [((height as f32 * aspect).round() as u32).max(1), height]
}

/// The ground from above with what stands on it, in neutral light, with smooth edges where that is allowed.
fn ground(scene: &Scene, [width, height]: [u32; 2]) -> Picture {
    let twice = if width.max(height) <= 2048 { 2 } else { 1 };
    let image = top_down(&scene.clone().in_neutral_light(), width * twice, height * twice, None);
    let picture = Picture {
        width: image.width,
        height: image.height,
        rgb: image.rgb,
    };
    if twice == 2 { picture.halved() } else { picture }
}

/// Whether the agent gets or loses something by an object.
fn pay(object: &Object) -> f64 {
    if object.reward_stimulus.is_empty() && object.reward_once_stimulus.is_empty() {
        0.0
    } else {
        object.reward
    }
}

/// How far from an object the agent sets it off, in metres on the ground; none without a stimulus that works at a distance.
pub(crate) fn trigger_radius(world: &World, scene: &Scene, index: usize) -> Option<f32> {
    let object = &world.objects[index];
    let effects = [
        &object.reward_stimulus,
        &object.reward_once_stimulus,
        &object.destroy_stimulus,
    ];
    let opens = object.door.iter().flat_map(|door| &door.opens_on);
    let mut stimuli = effects.into_iter().flatten().chain(opens);
    let reach = object.range_stimulus_distance as f32;
    if reach <= 0.0 || !stimuli.any(|stimulus| *stimulus == Stimulus::AgentInRange) {
        return None;
    }
    // Range is measured from middle to middle, at half of each one's height.
    let item = scene.items.get(index)?;
    let rise = (item.body.height * item.scale - world.agent_params.agent_height as f32) / 2.0;
    let square = reach * reach - rise * rise;
    (square > 0.0).then(|| square.sqrt())
}

fn annotated(world: &World, scene: &Scene, moves: &Moves, ground: Picture) -> Drawing {
    let size = ground.width.min(ground.height);
    let places = Places::of(scene, [ground.width, ground.height]);
    let thin = (size as f32 / 240.0).max(1.0);
    let mut map = Drawing::from(ground);
    let visible = || (0..world.objects.len()).filter(|index| scene.items.get(*index).is_some_and(|item| item.visible));
    for index in visible() {
        let at = places.pixel(scene.items[index].position);
        if let Some(radius) = trigger_radius(world, scene, index) {
            for (width, color) in [(2.4 * thin, INK), (1.2 * thin, RING)] {
                map.line(ring(at, radius * places.scale), width, color);
            }
        }
        let object = &world.objects[index];
        if object.motion_model == MotionModel::Patrol && !object.waypoints.is_empty() {
            let mut points: Vec<[f32; 2]> = vec![scene.items[index].position];
            points.extend(object.waypoints.iter().map(|point| point.map(|metres| metres as f32)));
            map.shapes.push(Shape::Line {
                points: places.pixels(&points),
                width: 1.5 * thin,
                color: TRAIL,
                alpha: 1.0,
                dash: Some(4.0 * thin),
            });
        }
    }
    for trail in &moves.trails {
        let points = places.pixels(trail);
        map.line(points.clone(), 3.0 * thin, INK);
        map.line(points.clone(), 1.8 * thin, TRAIL);
        if let Some(end) = points.last() {
            map.disc(*end, 2.2 * thin, TRAIL);
        }
    }
    if moves.way.len() > 1 {
        let points = places.pixels(&moves.way);
        map.line(points.clone(), 4.0 * thin, INK);
        map.line(points, 2.0 * thin, WHITE);
    }
    arrow(
        &mut map,
        places.pixel(moves.agent.0),
        moves.agent.1,
        (size as f32 / 26.0).max(6.0),
    );
    let signs: Vec<usize> = visible().filter(|index| pay(&world.objects[*index]) != 0.0).collect();
    if signs.len() <= MOST_SIGNS {
        for index in signs {
            let item = &scene.items[index];
            let [x, y] = places.pixel(item.position);
            let off = (item.asset.radius * item.scale * places.scale).max(0.015 * size as f32) + 1.0;
            sign(&mut map, [x + off, y - off], pay(&world.objects[index]), size);
        }
    }
    map
}

/// A plus or a minus.
fn sign(map: &mut Drawing, at: [f32; 2], pay: f64, size: u32) {
    let (text, color) = if pay > 0.0 { ("+", PAYS) } else { ("−", COSTS) };
    let words = TextLine::new(text, at, (size as f32 / 17.0).clamp(11.0, 30.0), color);
    map.write(words.anchored(Side::Middle, Level::Middle).rimmed(WHITE));
}

/// An arrowhead at a place, with a dark rim.
fn arrow(map: &mut Drawing, [x, y]: [f32; 2], heading_deg: f32, size: f32) {
    let heading = heading_deg.to_radians();
    let (sin, cos) = (heading.sin(), heading.cos());
    // Along the heading and to its right.
    let corners = |grow: f32| {
        [
            [1.0 + 2.2 * grow, 0.0],
            [-0.7 - grow, 0.7 + 1.2 * grow],
            [-0.7 - grow, -0.7 - 1.2 * grow],
        ]
        .map(|[along, right]| {
            [
                x + size * (along * sin + right * cos),
                y - size * (along * cos - right * sin),
            ]
        })
    };
    map.area(corners(0.16), INK);
    map.area(corners(0.0), WHITE);
}

/// One line of a legend.
#[derive(Clone, Debug, PartialEq)]
struct Entry {
    mark: Mark,
    name: String,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Mark {
    Color(Rgb),
    Zone(Rgb),
    Arrow,
    Ring,
    Trail,
    Way,
}

/// What is on a map: the objects by class, colour and pay, then walls, zones, reach and ways.
fn entries(world: &World, scene: &Scene, moves: &Moves, ground: &Picture) -> Vec<Entry> {
    let places = Places::of(scene, [ground.width, ground.height]);
    let mut entries = vec![Entry {
        mark: Mark::Arrow,
        name: if moves.way.len() > 1 {
            "agent".to_owned()
        } else {
            "agent, its start".to_owned()
        },
    }];
    // Group by name and pay: the colour is that of the first one.
    let mut groups: Vec<(String, f64, Rgb, usize)> = Vec::new();
    for (object, item) in world.objects.iter().zip(&scene.items).filter(|(_, item)| item.visible) {
        let (mut name, pay) = (named(object), pay(object));
        let ends = |condition: &EndCondition| matches!(condition, EndCondition::Touch(tag) if object.tag.as_ref() == Some(tag));
        if world.rules.failure.iter().any(ends) {
            name.push_str(", fails");
        }
        let color = item.color.map_or_else(
            || at(ground, places.pixel(item.position)),
            |color| color.map(|c| (c * 255.0) as u8),
        );
        match groups.iter_mut().find(|group| group.0 == name && group.1 == pay) {
            Some(group) => group.3 += 1,
            None => groups.push((name, pay, color, 1)),
        }
    }
    // What pays or costs most first.
    groups.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    for (name, pay, color, count) in groups {
        let count = if count > 1 {
            format!(" ×{count}")
        } else {
            String::new()
        };
        let pay = if pay == 0.0 {
            String::new()
        } else {
            format!(", {}", signed(pay))
        };
        entries.push(Entry {
            mark: Mark::Color(color),
            name: format!("{name}{count}{pay}"),
        });
    }
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
        let entry = Entry {
            mark: Mark::Zone(color),
            name: words.join(", "),
        };
        if !entries.iter().any(|other| other.name == entry.name) {
            entries.push(entry);
        }
    }
    let reaches: Vec<f32> = (0..world.objects.len())
        .filter(|index| scene.items.get(*index).is_some_and(|item| item.visible))
        .filter_map(|index| trigger_radius(world, scene, index))
        .collect();
    if let Some(first) = reaches.first() {
        let same = reaches.iter().all(|reach| (reach - first).abs() < 0.05);
        entries.push(Entry {
            mark: Mark::Ring,
            name: if same {
                format!("sets off, {first:.1} m")
            } else {
                "sets off".to_owned()
            },
        });
    }
    if !moves.trails.is_empty() {
        entries.push(Entry {
            mark: Mark::Trail,
            name: format!("ways of {} s", moves.seconds.round()),
        });
    }
    if world
        .objects
        .iter()
        .any(|object| object.motion_model == MotionModel::Patrol)
    {
        entries.push(Entry {
            mark: Mark::Trail,
            name: "waypoints (dashed)".to_owned(),
        });
    }
    if moves.way.len() > 1 {
        entries.push(Entry {
            mark: Mark::Way,
            name: "the agent's way".to_owned(),
        });
    }
    entries
}

/// What a zone does, in words.
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

/// The name of a group of objects: what is only a shape is better named by what it is for.
pub(crate) fn named(object: &Object) -> String {
    let class = object.class.to_lowercase();
    let shape = match (class.as_str(), object.model.0.as_str()) {
        ("geometric", "1") => "cube",
        ("geometric", "2") => "sphere",
        ("geometric", "3") => "cylinder",
        (class, _) => class,
    };
    object.tag.clone().unwrap_or_else(|| shape.to_owned())
}

fn signed(pay: f64) -> String {
    let sign = if pay < 0.0 { "−" } else { "+" };
    let number = format!("{:.2}", pay.abs());
    format!("{sign}{}", number.trim_end_matches('0').trim_end_matches('.'))
}

fn at(picture: &Picture, [x, y]: [f32; 2]) -> Rgb {
    let clamped = |place: f32, most: u32| (place.max(0.0) as u32).min(most.saturating_sub(1)) as usize;
    let start = (clamped(y, picture.height) * picture.width as usize + clamped(x, picture.width)) * 3;
    [picture.rgb[start], picture.rgb[start + 1], picture.rgb[start + 2]]
}

/// The legend in a column of this height, with scale and north at its foot; what has no room is counted in the last line.
fn legend(entries: &[Entry], letters: f32, height: u32, places: &Places) -> Drawing {
    let line = (letters * 1.45).round();
    let bar = Bar::of(places, (0.3 * places.size[0]).min(LONGEST_BAR));
    let arrow_side = north_size((height as f32).min(280.0));
    let foot = bar.size()[1].max(arrow_side) + 2.0;
    // In a small legend there is no room for the note.
    let note = if height as f32 > 9.0 * line + foot {
        "in even light"
    } else {
        ""
    };
    let note_height = if note.is_empty() { 0.0 } else { letters + 6.0 };
    let rooms = (((height as f32 - foot - note_height - 6.0) / line).floor().max(1.0)) as usize;
    let mut shown: Vec<(Option<Mark>, String)> = entries
        .iter()
        .map(|entry| (Some(entry.mark), entry.name.clone()))
        .collect();
    if shown.len() > rooms {
        let left_out = shown.len() - rooms + 1;
        shown.truncate(rooms - 1);
        shown.push((None, format!("and {left_out} more")));
    }
    let left = 6.0 + letters * 1.6;
    let names = shown.iter().map(|(_, name)| name.as_str()).chain([note]);
    let wide = names.map(|name| text_width(name, letters)).fold(0.0, f32::max);
    let wide = (left + wide + 6.0).max(bar.size()[0] + arrow_side + 10.0);
    let mut legend = Drawing::blank(wide.ceil() as u32, height);
    for (number, (mark, name)) in shown.iter().enumerate() {
        let y = 6.0 + line * (number as f32 + 0.5);
        let (x, r) = (6.0 + letters * 0.6, letters * 0.42);
        match mark {
            Some(Mark::Color(color)) => {
                legend.disc([x, y], r + 0.8, INK);
                legend.disc([x, y], r, *color);
            }
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
            Some(Mark::Way) => {
                legend.line([[x - r, y], [x + r, y]], 4.0, INK);
                legend.line([[x - r, y], [x + r, y]], 2.0, WHITE);
            }
            None => {}
        }
        legend.write(TextLine::new(name, [left, y], letters, INK).anchored(Side::Left, Level::Middle));
    }
    let top = height as f32 - foot;
    if !note.is_empty() {
        let words = TextLine::new(note, [6.0, top - 5.0], letters * 0.9, [110, 116, 124]);
        legend.write(words.anchored(Side::Left, Level::Bottom));
    }
    bar.draw(&mut legend, [2.0, height as f32 - bar.size()[1] - 2.0], false);
    let at = [legend.width as f32 - arrow_side - 2.0, height as f32 - arrow_side - 2.0];
    north(&mut legend, at, arrow_side);
    legend
}

#[cfg(test)]
mod tests {
    use driftworld_spec::{Color, WorldDraft};
    use proptest::prelude::*;

    use super::*;

    fn object(class: &str, at: [f64; 2], reward: f64, reach: f64) -> Object {
        let mut object = Object::new(class, at);
        object.reward = reward;
        if reach > 0.0 {
            object.range_stimulus_distance = reach;
            object.reward_once_stimulus = vec![Stimulus::AgentInRange];
        } else if reward != 0.0 {
            object.reward_once_stimulus = vec![Stimulus::AgentCollide];
        }
        object
    }

    fn world(side: f64, objects: Vec<Object>) -> World {
        let mut world = WorldDraft {
            objects,
            ..WorldDraft::default()
        };
        world.environment_params.map_size = [side, side];
        world.agent_params.coordinates = [side / 3.0, side / 3.0];
        world.check().expect("the world is sound")
    }

    fn drawn(world: &World, size: u32) -> Picture {
        map(world, &Scene::from_world(world), &Moves::none(world), size).to_picture()
    }

    fn pixel(picture: &Picture, x: usize, y: usize) -> Rgb {
        at(picture, [x as f32, y as f32])
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(12))]

        /// The bar's black pixels, counted, are as many as its words' metres are on the ground: the arena's rims, found as
        /// pixels too, say how many pixels a metre has.
        #[test]
        fn the_bar_is_as_long_as_it_says(side in 6.0..250.0_f64, size in 200_u32..500) {
            let world = world(side, Vec::new());
            let scene = Scene::from_world(&world);
            let whole = map(&world, &scene, &Moves::none(&world), size);
            let says: f32 = whole.texts().into_iter().find_map(|text| text.strip_suffix(" m")?.parse().ok()).expect("it says");
            let picture = whole.to_picture();
            let black = |x: &usize, y: usize| pixel(&picture, *x, y) == [0, 0, 0];
            let longest = (0..size as usize).map(|y| (0..size as usize).filter(|x| black(x, y)).count()).max();
            let longest = longest.expect("there are rows") as f32;
            // A map shows 6 % more than the arena.
            let metre = size as f32 / (side as f32 * 1.06);
            prop_assert!((longest - says * metre).abs() <= 1.5, "{longest} pixels for {says} m of {metre}");
            prop_assert!(longest <= 0.31 * size as f32);
        }

        /// Scale and north stand beside the map, or, on a map alone, where the agent is not, wherever it stands.
        #[test]
        fn nothing_covers_the_agent(x in -0.46..0.46_f64, y in -0.46..0.46_f64, heading in 0.0..360.0_f64, size in 80_u32..300) {
            let side = 16.0;
            let mut draft = WorldDraft::default();
            draft.environment_params.map_size = [side, side];
            draft.agent_params.coordinates = [x * side, y * side];
            draft.agent_params.heading = heading;
            let world = draft.check().expect("the world is sound");
            let scene = Scene::from_world(&world);
            let bare = annotated(&world, &scene, &Moves::none(&world), ground(&scene, [size, size])).to_picture();
            let alone = drawn(&world, size);
            let beside = map_with_legend(&world, &scene, &Moves::none(&world), size).to_picture();
            let near = f64::from(size) / 26.0;
            let middle = |share: f64| f64::from(size) * (0.5 + share / 1.06);
            for (column, row) in (0..size as usize).flat_map(|column| (0..size as usize).map(move |row| (column, row))) {
                prop_assert_eq!(pixel(&beside, column, row), pixel(&bare, column, row));
                if (column as f64 - middle(x)).hypot(row as f64 - middle(-y)) < near {
                    prop_assert_eq!(pixel(&alone, column, row), pixel(&bare, column, row), "{} {}", column, row);
                }
            }
        }

        /// A map is as oblong as its arena: the margins around it are equally wide, but where it would be a strip.
        #[test]
        fn oblong_arenas_have_oblong_maps(wide in 6.0..60.0_f64, deep in 6.0..60.0_f64, height in 60_u32..200) {
            let mut draft = WorldDraft::default();
            draft.environment_params.map_size = [wide, deep];
            let world = draft.check().expect("the world is sound");
            let scene = Scene::from_world(&world);
            let [width, same] = map_size(&scene, height);
            prop_assert_eq!(same, height);
            let places = Places::of(&scene, [width, height]);
            let [left, top] = places.pixel([-wide as f32 / 2.0, deep as f32 / 2.0]);
            prop_assert!(left >= 0.0 && top >= 0.0);
            if (0.5..2.0).contains(&(wide / deep)) {
                let share = [left / width as f32, top / height as f32];
                prop_assert!(share.iter().all(|share| (share - 0.5 * (1.0 - 1.0 / 1.06)).abs() < 0.012), "{share:?}");
            }
        }

        /// The ring's yellow pixels lie as far from the object as its trigger reaches on the ground.
        #[test]
        fn rings_have_their_radius(reach in 2.0..9.0_f64, size in 220_u32..420) {
            let world = world(24.0, vec![object("geometric", [0.0, 0.0], 1.0, reach)]);
            let picture = drawn(&world, size);
            let metre = f64::from(size) / (24.0 * 1.06);
            let middle = f64::from(size) / 2.0;
            // A cube is as high as the agent: what is left is the reach itself.
            let scene = Scene::from_world(&world);
            let height = f64::from(scene.items[0].body.height);
            let rise = (height - 1.0) / 2.0;
            let expected = (reach * reach - rise * rise).sqrt() * metre;
            let mut found = Vec::new();
            for (x, y) in (0..size as usize).flat_map(|x| (0..size as usize).map(move |y| (x, y))) {
                let [red, green, blue] = pixel(&picture, x, y);
                if red > 220 && green > 180 && green < 230 && blue < 60 {
                    found.push((x as f64 + 0.5 - middle).hypot(y as f64 + 0.5 - middle));
                }
            }
            prop_assert!(found.len() > 20, "{} pixels", found.len());
            prop_assert!(found.iter().all(|radius| (radius - expected).abs() < 2.5), "{expected}");
        }
    }

    #[test]
    fn the_legend_lists_what_is_there_and_nothing_else() {
        let mut gone = object("tent", [3.0, 3.0], 0.0, 0.0);
        gone.color = Some(Color([1.0, 0.0, 0.0]));
        let world = world(
            30.0,
            vec![
                object("geometric", [0.0, 0.0], 100.0, 0.0),
                object("geometric", [4.0, 0.0], 100.0, 0.0),
                object("geometric", [0.0, 5.0], -20.0, 0.0),
                object("tree", [-5.0, 0.0], 0.0, 0.0),
                gone,
            ],
        );
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

    /// What a zone does is in the legend, and what ends an episode as a failure.
    #[test]
    fn the_legend_says_what_zones_do() {
        let zone = |name: &str, change: &dyn Fn(&mut Zone)| {
            let mut zone = Zone::disc([0.0, 0.0], 3.0);
            zone.name = Some(name.to_owned());
            change(&mut zone);
            zone
        };
        let mut thorn = object("shrub", [4.0, 4.0], 0.0, 0.0);
        thorn.tag = Some("thorn".to_owned());
        let mut draft = WorldDraft {
            objects: vec![thorn],
            ..WorldDraft::default()
        };
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
        let world = draft.check().expect("the world is sound");
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

    /// As many signs as there are things that pay and cost.
    #[test]
    fn what_pays_has_a_plus_and_what_costs_a_minus() {
        let objects = vec![
            object("geometric", [0.0, 0.0], 100.0, 0.0),
            object("geometric", [4.0, 0.0], -1.0, 0.0),
            object("tree", [-5.0, 0.0], 0.0, 0.0),
        ];
        let world = world(30.0, objects);
        let drawing = map(&world, &Scene::from_world(&world), &Moves::none(&world), 300);
        let count = |sign: &str| drawing.texts().into_iter().filter(|text| *text == sign).count();
        assert_eq!((count("+"), count("−"), count("N")), (1, 1, 1));
    }

    /// A dark world's map is as bright as a light one's.
    #[test]
    fn dark_worlds_can_be_read() {
        let bright = |light: f64| {
            let mut draft = WorldDraft::default();
            draft.environment_params.light_intensity = light;
            draft.environment_params.fog_distance = Some(5.0);
            let world = draft.check().expect("the world is sound");
            drawn(&world, 100)
        };
        assert_eq!(bright(0.05), bright(2.3));
    }
}
