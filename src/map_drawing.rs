//! Draws annotated maps: the ground from above with a scale, north, the agent's start, signs of rewards, trigger ranges and
//! paths.

#![expect(clippy::disallowed_methods, reason = "only positions of lines and labels on a map")]

use std::convert::Infallible;

use driftworld_env::{Scene, top_down};
use driftworld_report::picture::{Drawing, Level, Picture, Rgb, Shape, Side, TextLine, ring};
use driftworld_spec::{MotionModel, Object, Stimulus, World};

use crate::map_scale::{Bar, CORNERS, MapProjection, freest, north, north_size};

pub(crate) const INK: Rgb = [20, 24, 30];
pub(crate) const WHITE: Rgb = [255, 255, 255];
/// Colour of trigger ranges.
pub(crate) const RING: Rgb = [255, 214, 0];
/// Colour of paths of objects.
pub(crate) const TRAIL: Rgb = [255, 120, 200];
const PAYS: Rgb = [0, 110, 50];
const COSTS: Rgb = [190, 0, 20];
/// Maximum number of rewarding objects that have signs; if there are more, none has a sign.
const MAX_SIGNS: usize = 60;
/// Smallest map, in pixels, that has signs: on a smaller one they would hide the objects beside them.
const MIN_SIZE_FOR_SIGNS: u32 = 100;
/// Smallest map without a legend, in pixels, that has a scale: a smaller one has no room for it.
const MIN_SIZE_FOR_SCALE: u32 = 80;
/// Largest aspect ratio of a map.
const MAX_ASPECT: f32 = 2.0;

/// Movements to show on a map.
#[derive(Clone, Debug, Default)]
pub(crate) struct Moves {
    /// The agent's position, and its heading in degrees.
    pub(crate) agent: ([f32; 2], f32),
    /// The path that the agent took.
    pub(crate) path: Vec<[f32; 2]>,
    /// The paths of objects that moved.
    pub(crate) trails: Vec<Vec<[f32; 2]>>,
    /// Duration of the movements in seconds.
    pub(crate) seconds: f64,
}

impl Moves {
    /// No movements: the agent at its start.
    pub(crate) fn none(world: &World) -> Self {
        let agent = &world.agent_params;
        Self {
            agent: (agent.coordinates.map(|metres| metres as f32), agent.heading as f32),
            ..Self::default()
        }
    }
}

/// Draws a square map without a legend; scale and north are in the corners where they cover least.
pub(crate) fn map(world: &World, scene: &Scene, moves: &Moves, size: u32) -> Drawing {
    let mut map = annotated(world, scene, moves, ground(scene, [size, size]));
    if size < MIN_SIZE_FOR_SCALE {
        return map;
    }
    let projection = MapProjection::of(scene, [size, size]);
    let visible = scene.items.iter().filter(|item| item.visible);
    // The agent's position has the highest priority.
    let mut marks = vec![(projection.pixel(moves.agent.0), 1_000.0)];
    marks.extend(visible.map(|item| (projection.pixel(item.position), 1.0)));
    marks.extend(projection.pixels(&moves.path).into_iter().map(|pixel| (pixel, 0.01)));
    let mut corners = CORNERS.to_vec();
    let bar = Bar::of(&projection, size as f32 * 0.3);
    let at = freest(&mut corners, bar.size(), projection.size, &marks);
    bar.draw(&mut map, at, true);
    corners.reverse();
    let side = north_size(size as f32);
    north(&mut map, freest(&mut corners, [side; 2], projection.size, &marks), side);
    map
}

/// Width and height in pixels of a map with this height: the arena's aspect ratio, within limits.
pub(crate) fn map_size(scene: &Scene, height: u32) -> [u32; 2] {
    let [wide, deep] = scene.arena_size();
    let aspect = (wide / deep.max(1e-3)).clamp(1.0 / MAX_ASPECT, MAX_ASPECT);
    [((height as f32 * aspect).round() as u32).max(1), height]
}

/// The scene from above, in neutral light, with smooth edges unless the picture is very large.
pub(crate) fn ground(scene: &Scene, size: [u32; 2]) -> Picture {
    let scene = scene.clone().in_neutral_light();
    let Ok(picture) = Picture::smooth(size, |[width, height]| {
        Ok::<_, Infallible>(top_down(&scene, width, height, None).rgb)
    });
    picture
}

/// The reward or loss that the agent can get from an object.
pub(crate) fn pay(object: &Object) -> f64 {
    if object.reward_stimulus.is_empty() && object.reward_once_stimulus.is_empty() {
        0.0
    } else {
        object.reward
    }
}

/// The distance, in metres on the ground, at which the agent triggers an object; `None` without a stimulus that works at a
/// distance.
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
    // Range is measured between the centres of agent and object, each at half its height.
    let item = scene.items.get(index)?;
    let rise = (item.body.height * item.scale - world.agent_params.agent_height as f32) / 2.0;
    let square = reach * reach - rise * rise;
    (square > 0.0).then(|| square.sqrt())
}

/// Annotates a picture of the ground with rings, paths, signs, and the agent.
pub(crate) fn annotated(world: &World, scene: &Scene, moves: &Moves, ground: Picture) -> Drawing {
    let size = ground.width.min(ground.height);
    let projection = MapProjection::of(scene, [ground.width, ground.height]);
    let thin = (size as f32 / 240.0).max(1.0);
    let mut map = Drawing::from(ground);
    let visible = || (0..world.objects.len()).filter(|index| scene.items.get(*index).is_some_and(|item| item.visible));
    for index in visible() {
        let at = projection.pixel(scene.items[index].position);
        if let Some(radius) = trigger_radius(world, scene, index) {
            for (width, color) in [(2.4 * thin, INK), (1.2 * thin, RING)] {
                map.line(ring(at, radius * projection.scale), width, color);
            }
        }
        let object = &world.objects[index];
        if object.motion_model == MotionModel::Patrol && !object.waypoints.is_empty() {
            let mut points: Vec<[f32; 2]> = vec![scene.items[index].position];
            points.extend(object.waypoints.iter().map(|point| point.map(|metres| metres as f32)));
            map.shapes.push(Shape::Line {
                points: projection.pixels(&points),
                width: 1.5 * thin,
                color: TRAIL,
                alpha: 1.0,
                dash: Some(4.0 * thin),
            });
        }
    }
    let radius = |index: usize| {
        let item = &scene.items[index];
        (item.asset.radius * item.scale * projection.scale).max(0.015 * size as f32)
    };
    let discs: Vec<([f32; 2], f32)> = visible()
        .map(|index| (projection.pixel(scene.items[index].position), radius(index)))
        .collect();
    for trail in &moves.trails {
        let points = projection.pixels(trail);
        let own = discs
            .iter()
            .find(|(at, _)| points.first().is_some_and(|start| distance(*at, *start) < 0.5));
        // Leave the pixel of an object uncovered even if the object is smaller than a pixel.
        let rim = |radius: f32| radius.max(1.5) + 1.5 * thin;
        let points = own.map_or_else(|| points.clone(), |(_, radius)| outside_disc(&points, rim(*radius)));
        map.line(points.clone(), 3.0 * thin, INK);
        map.line(points.clone(), 1.8 * thin, TRAIL);
        if let Some(end) = points.last() {
            map.disc(*end, 2.2 * thin, TRAIL);
        }
    }
    if moves.path.len() > 1 {
        let points = projection.pixels(&moves.path);
        map.line(points.clone(), 4.0 * thin, INK);
        map.line(points, 2.0 * thin, WHITE);
    }
    arrow(
        &mut map,
        projection.pixel(moves.agent.0),
        moves.agent.1,
        (size as f32 / 26.0).max(6.0),
    );
    let signs: Vec<usize> = visible().filter(|index| pay(&world.objects[*index]) != 0.0).collect();
    if signs.len() <= MAX_SIGNS && size >= MIN_SIZE_FOR_SIGNS {
        for index in signs {
            let at = projection.pixel(scene.items[index].position);
            sign(&mut map, at, radius(index), pay(&world.objects[index]), size, &discs);
        }
    }
    map
}

fn distance(one: [f32; 2], other: [f32; 2]) -> f32 {
    (one[0] - other[0]).hypot(one[1] - other[1])
}

/// The part of a path outside a disc around its start, so that the path does not hide what is there; may be empty.
fn outside_disc(points: &[[f32; 2]], radius: f32) -> Vec<[f32; 2]> {
    let Some(start) = points.first().copied() else {
        return Vec::new();
    };
    let Some(out) = points.iter().position(|point| distance(*point, start) > radius) else {
        return Vec::new();
    };
    let (from, to) = (points[out.max(1) - 1], points[out]);
    // The path leaves the disc between these two points: bisects to a fraction of a pixel.
    let (mut low, mut high) = (0.0_f32, 1.0_f32);
    let at = |share: f32| [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]));
    for _ in 0..12 {
        let middle = f32::midpoint(low, high);
        if distance(at(middle), start) > radius {
            high = middle;
        } else {
            low = middle;
        }
    }
    let mut rest = vec![at(high)];
    rest.extend_from_slice(&points[out..]);
    rest
}

/// Draws a plus or a minus beside an object with this centre and radius, at the corner where it covers objects least.
fn sign(map: &mut Drawing, [x, y]: [f32; 2], radius: f32, pay: f64, size: u32, discs: &[([f32; 2], f32)]) {
    let (text, color) = if pay > 0.0 { ("+", PAYS) } else { ("−", COSTS) };
    let font_size = (size as f32 / 17.0).clamp(9.0, 30.0);
    // Distance from a sign's centre to its rim.
    let reach = 0.42 * font_size;
    let off = 0.71 * radius + reach;
    let covers = |at: [f32; 2]| -> f32 {
        let overlap = |(center, radius): &([f32; 2], f32)| (radius + reach - distance(*center, at)).max(0.0);
        discs.iter().map(overlap).sum()
    };
    let mut best = [x + off, y - off];
    for corner in [[x + off, y + off], [x - off, y - off], [x - off, y + off]] {
        // Prefer the first corner unless another is clearly better, so that signs are aligned.
        if covers(corner) + 0.5 < covers(best) {
            best = corner;
        }
    }
    let words = TextLine::new(text, best, font_size, color);
    map.write(words.anchored(Side::Middle, Level::Middle).rimmed(WHITE));
}

/// An arrowhead with a dark rim.
pub(crate) fn arrow(map: &mut Drawing, [x, y]: [f32; 2], heading_deg: f32, size: f32) {
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

/// A square arena with only the agent, whose position is given as a share of the side from the centre.
#[cfg(test)]
pub(crate) fn world_of_agent(side: f64, place: [f64; 2], heading: f64) -> World {
    let mut draft = driftworld_spec::WorldDraft::default();
    draft.environment_params.map_size = [side, side];
    draft.agent_params.coordinates = place.map(|share| share * side);
    draft.agent_params.heading = heading;
    draft.check().expect("the agent is within the arena")
}

#[cfg(test)]
mod tests {
    use driftworld_spec::WorldDraft;
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
        let mut world = WorldDraft::with_objects(objects);
        world.environment_params.map_size = [side, side];
        world.agent_params.coordinates = [side / 3.0, side / 3.0];
        world.check().expect("the world is valid")
    }

    fn drawn(world: &World, size: u32) -> Picture {
        map(world, &Scene::from_world(world), &Moves::none(world), size).to_picture()
    }

    fn pixel(picture: &Picture, x: usize, y: usize) -> Rgb {
        let start = 3 * (y * picture.width as usize + x);
        [picture.rgb[start], picture.rgb[start + 1], picture.rgb[start + 2]]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(12))]

        /// The number of the bar's black pixels matches its label in metres.
        #[test]
        fn scale_bar_has_its_labelled_length(side in 6.0..250.0_f64, size in 200_u32..500) {
            let world = world(side, Vec::new());
            let scene = Scene::from_world(&world);
            let drawing = map(&world, &scene, &Moves::none(&world), size);
            let label: f32 = drawing.texts().into_iter().find_map(|text| text.strip_suffix(" m")?.parse().ok()).expect("the bar has a label");
            let picture = drawing.to_picture();
            let black = |x: &usize, y: usize| pixel(&picture, *x, y) == [0, 0, 0];
            let longest = (0..size as usize).map(|y| (0..size as usize).filter(|x| black(x, y)).count()).max();
            let longest = longest.expect("there are rows") as f32;
            // A map shows 6 % more than the arena.
            let metre = size as f32 / (side as f32 * 1.06);
            prop_assert!((longest - label * metre).abs() <= 1.5, "{longest} pixels for {label} m of {metre}");
            prop_assert!(longest <= 0.31 * size as f32);
        }

        /// Scale and north avoid the agent, wherever it is.
        #[test]
        fn nothing_covers_the_agent(x in -0.46..0.46_f64, y in -0.46..0.46_f64, heading in 0.0..360.0_f64, size in 80_u32..300) {
            let world = world_of_agent(16.0, [x, y], heading);
            let scene = Scene::from_world(&world);
            let bare = annotated(&world, &scene, &Moves::none(&world), ground(&scene, [size, size])).to_picture();
            let alone = drawn(&world, size);
            let radius = f64::from(size) / 26.0;
            let middle = |share: f64| f64::from(size) * (0.5 + share / 1.06);
            for (column, row) in (0..size as usize).flat_map(|column| (0..size as usize).map(move |row| (column, row))) {
                if (column as f64 - middle(x)).hypot(row as f64 - middle(-y)) < radius {
                    prop_assert_eq!(pixel(&alone, column, row), pixel(&bare, column, row), "{} {}", column, row);
                }
            }
        }

        /// A map has the arena's aspect ratio with equal margins on all sides, unless it would be a strip.
        #[test]
        fn oblong_arenas_have_oblong_maps(wide in 6.0..60.0_f64, deep in 6.0..60.0_f64, height in 60_u32..200) {
            let mut draft = WorldDraft::default();
            draft.environment_params.map_size = [wide, deep];
            let world = draft.check().expect("the world is valid");
            let scene = Scene::from_world(&world);
            let [width, same] = map_size(&scene, height);
            prop_assert_eq!(same, height);
            let places = MapProjection::of(&scene, [width, height]);
            let [left, top] = places.pixel([-wide as f32 / 2.0, deep as f32 / 2.0]);
            prop_assert!(left >= 0.0 && top >= 0.0);
            if (0.5..2.0).contains(&(wide / deep)) {
                let share = [left / width as f32, top / height as f32];
                prop_assert!(share.iter().all(|share| (share - 0.5 * (1.0 - 1.0 / 1.06)).abs() < 0.012), "{share:?}");
            }
        }

        /// A sign never hides a rewarding object, for any map size and number of objects around it.
        #[test]
        fn signs_hide_nothing(places in prop::collection::vec((-4_i32..=4, -4_i32..=4), 1..6), size in 48_u32..400) {
            let objects = |reward: f64| -> Vec<Object> {
                let at = |(x, y): &(i32, i32)| object("geometric", [f64::from(*x) * 6.0, f64::from(*y) * 6.0], reward, 0.0);
                places.iter().map(at).collect()
            };
            let drawn = |reward: f64| {
                let world = world(60.0, objects(reward));
                let scene = Scene::from_world(&world);
                let drawing = annotated(&world, &scene, &Moves::none(&world), ground(&scene, [size, size]));
                (MapProjection::of(&scene, [size, size]), drawing.to_picture())
            };
            let ((scale, with), (_, without)) = (drawn(5.0), drawn(0.0));
            for (x, y) in &places {
                let [x, y] = scale.pixel([*x as f32 * 6.0, *y as f32 * 6.0]);
                prop_assert_eq!(pixel(&with, x as usize, y as usize), pixel(&without, x as usize, y as usize));
            }
        }

        /// Paths start beside their object, which stays visible, and their end is drawn.
        #[test]
        fn paths_do_not_hide_their_objects(angle in 0.0..6.2_f32, far in 4.0..20.0_f32, size in 64_u32..400) {
            let world = world(60.0, vec![object("geometric", [1.0, 2.0], 0.0, 0.0)]);
            let scene = Scene::from_world(&world);
            let trail: Vec<[f32; 2]> = (0..50)
                .map(|step| step as f32 / 49.0 * far)
                .map(|out| [1.0 + out * angle.cos(), 2.0 + out * angle.sin()])
                .collect();
            let end = trail[49];
            let moves = Moves { trails: vec![trail], ..Moves::none(&world) };
            let drawn = |moves: &Moves| annotated(&world, &scene, moves, ground(&scene, [size, size])).to_picture();
            let (with, without) = (drawn(&moves), drawn(&Moves::none(&world)));
            let at = |place: [f32; 2]| {
                let [x, y] = MapProjection::of(&scene, [size, size]).pixel(place);
                [&with, &without].map(|picture| pixel(picture, x as usize, y as usize))
            };
            let [shown, bare] = at([1.0, 2.0]);
            prop_assert_eq!(shown, bare);
            let [shown, bare] = at(end);
            prop_assert!(shown != bare);
        }

        /// The ring's yellow pixels are as far from the object as its trigger reaches on the ground.
        #[test]
        fn rings_have_their_radius(reach in 2.0..9.0_f64, size in 220_u32..420) {
            let world = world(24.0, vec![object("geometric", [0.0, 0.0], 1.0, reach)]);
            let picture = drawn(&world, size);
            let metre = f64::from(size) / (24.0 * 1.06);
            let middle = f64::from(size) / 2.0;
            // A cube is as high as the agent, so only the range itself matters.
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
    fn positive_rewards_have_a_plus_and_negative_ones_a_minus() {
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

    /// The map of a dark world is as bright as that of a light one.
    #[test]
    fn dark_worlds_have_readable_maps() {
        let bright = |light: f64| {
            let mut draft = WorldDraft::default();
            draft.environment_params.light_intensity = light;
            draft.environment_params.fog_distance = Some(5.0);
            let world = draft.check().expect("the world is valid");
            drawn(&world, 100)
        };
        assert_eq!(bright(0.05), bright(2.3));
    }
}
