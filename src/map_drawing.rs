//! Maps that can be read: the ground from above with a scale, north, where the agent starts, what pays and what costs,
//! how far triggers reach and where things move; beside it, what is on it. How the ground is drawn is `env`'s.

#![expect(clippy::disallowed_methods, reason = "where lines and words stand on a map")]

use driftworld_env::{Scene, top_down, top_down_scale};
use driftworld_report::picture::{Drawing, Level, Picture, Rgb, Shape, Side, TextLine, ring, text_width};
use driftworld_spec::{MotionModel, Object, Stimulus, World};

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

/// A map of so many pixels along each side, and the legend to its right.
pub(crate) fn map_with_legend(world: &World, scene: &Scene, moves: &Moves, size: u32) -> Drawing {
    let ground = ground(scene, size);
    let entries = entries(world, scene, moves, &ground);
    let map = annotated(world, scene, moves, ground);
    let letters = (size as f32 / 17.0).clamp(9.0, LEGEND);
    let legend = legend(&entries, letters, size);
    let mut drawing = Drawing::blank(size + legend.width, size);
    drawing.put(map, [0, 0]);
    drawing.put(legend, [size, 0]);
    drawing
}

/// The map alone.
pub(crate) fn map(world: &World, scene: &Scene, moves: &Moves, size: u32) -> Drawing {
    annotated(world, scene, moves, ground(scene, size))
}

/// The ground from above with what stands on it, in neutral light, with smooth edges where that is allowed.
fn ground(scene: &Scene, size: u32) -> Picture {
    let twice = if size <= 2048 { 2 } else { 1 };
    let image = top_down(&scene.clone().in_neutral_light(), size * twice, size * twice, None);
    let picture = Picture {
        width: image.width,
        height: image.height,
        rgb: image.rgb,
    };
    if twice == 2 { picture.halved() } else { picture }
}

/// From metres to pixels of a square map.
struct Places {
    size: f32,
    scale: f32,
}

impl Places {
    fn of(scene: &Scene, size: u32) -> Self {
        Self {
            size: size as f32,
            scale: top_down_scale(scene, size, size),
        }
    }

    fn pixel(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        [self.size / 2.0 + x * self.scale, self.size / 2.0 - y * self.scale]
    }

    fn pixels(&self, metres: &[[f32; 2]]) -> Vec<[f32; 2]> {
        metres.iter().map(|place| self.pixel(*place)).collect()
    }
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
    let size = ground.width;
    let places = Places::of(scene, size);
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
    scale_bar(&mut map, &places);
    north(&mut map);
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

/// The length in metres of the bar: a round one that takes at most three tenths of the map.
fn bar_metres(metres: f32) -> f32 {
    let most = 0.3 * metres;
    let power = 10_f32.powf(most.log10().floor());
    let steps = [5.0, 2.0, 1.0].into_iter().map(|step| step * power);
    steps.into_iter().find(|step| *step <= most).unwrap_or(power)
}

/// A bar with its length, on a light ground in the lower left corner.
fn scale_bar(map: &mut Drawing, places: &Places) {
    let metres = bar_metres(places.size / places.scale);
    let long = metres * places.scale;
    let letters = (places.size / 22.0).clamp(9.0, 20.0);
    let label = format!("{metres} m");
    let thick = (places.size / 100.0).clamp(2.0, 8.0).round();
    let edge = (places.size / 40.0).round();
    let wide = long.max(text_width(&label, letters)) + 8.0;
    let high = letters * 1.1 + thick + 7.0;
    let top = places.size - edge - high;
    map.shapes.push(Shape::Area {
        points: vec![
            [edge, top],
            [edge + wide, top],
            [edge + wide, top + high],
            [edge, top + high],
        ],
        color: WHITE,
        alpha: 0.75,
    });
    map.write(TextLine::new(label, [edge + 4.0, top + 3.0], letters, INK));
    map.rectangle([edge + 4.0, top + high - thick - 3.0, long, thick], [0, 0, 0]);
}

/// An arrow to the north in the upper right corner.
fn north(map: &mut Drawing) {
    let size = map.width as f32;
    let high = (size / 14.0).clamp(12.0, 44.0);
    let (x, top) = (size - high * 0.75 - size / 50.0, size / 40.0 + 2.0);
    map.shapes.push(Shape::Disc {
        middle: [x, top + high * 0.72],
        radius: high * 0.86,
        color: WHITE,
        alpha: 0.75,
    });
    let half = high * 0.26;
    map.area(
        [
            [x, top],
            [x + half, top + 0.72 * high],
            [x, top + 0.55 * high],
            [x - half, top + 0.72 * high],
        ],
        INK,
    );
    let words = TextLine::new("N", [x, top + 0.8 * high], high * 0.62, INK);
    map.write(words.anchored(Side::Middle, Level::Top));
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
    Arrow,
    Ring,
    Trail,
    Way,
}

/// What is on a map: the objects by class, colour and pay, then walls, zones, reach and ways.
#[expect(clippy::too_many_lines, reason = "one entry after the other")]
fn entries(world: &World, scene: &Scene, moves: &Moves, ground: &Picture) -> Vec<Entry> {
    let places = Places::of(scene, ground.width);
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
        let (name, pay) = (named(object), pay(object));
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
        let color = zone
            .color
            .map_or([128; 3], |color| color.to_f32().map(|c| (c * 255.0) as u8));
        let name = zone.name.clone().unwrap_or_else(|| format!("zone {number}"));
        let pay = zone.reward_per_second;
        let pay = if pay == 0.0 {
            String::new()
        } else {
            format!(", {}/s", signed(pay))
        };
        let entry = Entry {
            mark: Mark::Color(color),
            name: format!("{name}{pay}"),
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

/// The name of a group of objects: what is only a shape is better named by what it is for.
fn named(object: &Object) -> String {
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

/// The legend in a column of this height; what has no room is counted in the last line.
fn legend(entries: &[Entry], letters: f32, height: u32) -> Drawing {
    let line = (letters * 1.45).round();
    let rooms = (((height as f32 - letters - 6.0) / line).floor().max(1.0)) as usize;
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
    let note = "in even light";
    let names = shown.iter().map(|(_, name)| name.as_str()).chain([note]);
    let wide = names.map(|name| text_width(name, letters)).fold(0.0, f32::max);
    let mut legend = Drawing::blank((left + wide + 6.0).ceil() as u32, height);
    for (number, (mark, name)) in shown.iter().enumerate() {
        let y = 6.0 + line * (number as f32 + 0.5);
        let (x, r) = (6.0 + letters * 0.6, letters * 0.42);
        match mark {
            Some(Mark::Color(color)) => {
                legend.disc([x, y], r + 0.8, INK);
                legend.disc([x, y], r, *color);
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
    let words = TextLine::new(note, [left, height as f32 - 5.0], letters * 0.9, [110, 116, 124]);
    legend.write(words.anchored(Side::Left, Level::Bottom));
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
