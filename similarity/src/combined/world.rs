//! Distance between two concrete worlds.

use driftworld_spec::World;

use crate::SimilarityError;
use crate::combined::matching::each_match;
use crate::combined::parts::{Parts, Sum, compare};
use crate::combined::sketch::{Sketch, Sketcher};
use crate::combined::weighted_distance::Distance;
use crate::combined::weights::Weights;
use crate::distribution::Method;

/// The distance between two worlds: a sum of parts, each in a unit of its own.
///
/// | element | parts, with the difference that counts as 1 |
/// |---|---|
/// | state | positions of objects (10 m), unmatched objects (each), their headings (180°), the agent's start (10 m), its heading (180°) |
/// | action | action model, action space (a different value), maximum speed and turn rate (the larger value) |
/// | transition | motion and solidity of objects, time step, the agent's width, map and walls, arena size |
/// | reward | object rewards (100 points), conditions and probability (never to always), step reward (1 point/s), rules, episode limit |
/// | observation | colours (black to white in Oklab), appearance of unmatched objects (each), models, sizes, light, camera |
///
/// Numbers without a unit count by their difference divided by the larger value, so that any number differs from 0 by 1; words
/// count as 1 if they differ. `docs/reference/comparison.md` lists all parts, units and keys.
///
/// Objects are matched once within each class, at minimum total cost over all features; unmatched ones count in full: their
/// presence in the state, their looks in the observation, their pay in the reward. So the order of objects in a document does
/// not matter, and adding the same object to both worlds changes nothing unless it is a better match. Fields that nothing
/// reads, such as the reward of an object without a stimulus, do not count.
///
/// Objects are matched by position, looks and behaviour; pay only breaks ties. So "the red ones pay, the blue ones cost" and its
/// reverse differ in pay and not in positions.
///
/// Symmetric, and 0 between worlds that differ only in fields that are not compared (names, tags, the mode of the game,
/// progress so far). A metric among worlds whose objects match in the same way; among others the triangle inequality may fail.
/// Time: some microseconds for 20 objects, growing with the cube of the number of objects of one class.
pub fn world_distance(a: &World, b: &World, weights: &Weights) -> Distance {
    let mut sketcher = Sketcher::default();
    let (a, b) = (sketcher.sketch(a), sketcher.sketch(b));
    explain(&a, &b, weights)
}

/// Pairs of indices of matched objects in two worlds; each object occurs once, in an order that depends on the objects alone.
pub(crate) fn match_objects(a: &World, b: &World) -> Vec<(Option<usize>, Option<usize>)> {
    let mut sketcher = Sketcher::default();
    let (a, b) = (sketcher.sketch(a), sketcher.sketch(b));
    let mut matches = Vec::new();
    for (mine, theirs) in a.classes_of_both(&b) {
        each_match(mine, theirs, |one, other| {
            matches.push((one.map(|object| object.index), other.map(|object| object.index)));
        });
    }
    matches
}

/// The distance between two sets of worlds: the mean over pairs, the first with the first and so on; worlds without a partner are
/// ignored. Each part's numbers are also means.
///
/// Draw both sets with the same seed and indices: then pairs share their random numbers, and only the difference between the
/// variants remains.
///
/// # Errors
/// [`SimilarityError::Empty`] if there is no pair.
pub fn world_sets_distance(a: &[World], b: &[World], weights: &Weights) -> Result<Distance, SimilarityError> {
    let mut sketcher = Sketcher::default();
    let mut sums = Parts(Vec::new());
    for (a, b) in a.iter().zip(b) {
        let mut parts = Parts(Vec::new());
        compare(&sketcher.sketch(a), &sketcher.sketch(b), &mut parts);
        if sums.0.is_empty() {
            sums = parts;
        } else {
            for (sum, part) in sums.0.iter_mut().zip(parts.0) {
                (sum.raw, sum.normalised) = (sum.raw + part.raw, sum.normalised + part.normalised);
            }
        }
    }
    let count = a.len().min(b.len());
    if count == 0 {
        return Err(SimilarityError::Empty);
    }
    for part in &mut sums.0 {
        (part.raw, part.normalised) = (part.raw / count as f64, part.normalised / count as f64);
        part.method = Some(Method::Samples { count });
    }
    Ok(Distance::new(sums.0, weights))
}

/// Many worlds, prepared for fast pairwise comparison: the same numbers as [`world_distance`].
///
/// # Example
/// ```
/// use driftworld_similarity::{DistanceMatrix, SimilarityError, Weights, Worlds};
/// use driftworld_spec::{Object, World};
/// let world = |x: f64| World::default().edit(|world| world.objects.push(Object::new("tree", [x, 0.0])));
/// let worlds = Worlds::new(&[world(0.0)?, world(5.0)?, world(0.0)?], Weights::default());
/// assert_eq!(worlds.distance(0, 2), 0.0);
/// let names = ["a", "b", "c"].map(String::from).to_vec();
/// let matrix = DistanceMatrix::measure(names, |a, b| Ok::<_, SimilarityError>(worlds.distance(a, b)))?;
/// assert_eq!(matrix.get(0, 1), worlds.explain(0, 1).total);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Worlds {
    sketches: Vec<Sketch>,
    weights: Weights,
}

impl Worlds {
    /// Prepares worlds; they are numbered by their index in the list.
    pub fn new(worlds: &[World], weights: Weights) -> Self {
        let mut sketcher = Sketcher::default();
        let sketches = worlds.iter().map(|world| sketcher.sketch(world)).collect();
        Self { sketches, weights }
    }

    /// Number of worlds.
    pub fn len(&self) -> usize {
        self.sketches.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.sketches.is_empty()
    }

    /// The distance between two worlds by index, at least 0.
    ///
    /// # Panics
    /// If an index is out of range.
    pub fn distance(&self, a: usize, b: usize) -> f64 {
        total(&self.sketches[a], &self.sketches[b], &self.weights)
    }

    /// The distance between two worlds by index, with its parts.
    ///
    /// # Panics
    /// If an index is out of range.
    pub fn explain(&self, a: usize, b: usize) -> Distance {
        explain(&self.sketches[a], &self.sketches[b], &self.weights)
    }
}

fn explain(a: &Sketch, b: &Sketch, weights: &Weights) -> Distance {
    let mut parts = Parts(Vec::new());
    compare(a, b, &mut parts);
    Distance::new(parts.0, weights)
}

fn total(a: &Sketch, b: &Sketch, weights: &Weights) -> f64 {
    let mut sum = Sum { weights, total: 0.0 };
    compare(a, b, &mut sum);
    sum.total
}

#[cfg(test)]
mod tests {
    use super::*;
    use driftworld_spec::{
        Color, Covering, Disc, Door, Element, Layout, Looks, Maze, Object, Portable, Stimulus, Style, Surface, Switch,
        WorldDraft, Zone, ZoneEnd,
    };
    use proptest::prelude::*;

    fn world(color: &str, reward: f64) -> World {
        let mut object = Object::new("cube", [3.0, 4.0]);
        object.color = Color::from_name(color);
        (object.reward, object.reward_stimulus) = (reward, vec![Stimulus::AgentCollide]);
        let world = WorldDraft::with_objects(vec![object, Object::new("tree", [-5.0, 1.0])]);
        world.check().unwrap()
    }

    #[test]
    fn equal_worlds_are_0_apart_in_every_part() {
        let distance = world_distance(&world("red", 1.0), &world("red", 1.0), &Weights::default());
        assert!(
            distance
                .parts
                .iter()
                .all(|part| part.normalised == 0.0 && part.raw == 0.0)
        );
        assert_eq!(distance.total, 0.0);
    }

    #[test]
    fn changed_reward_or_colour_shows_only_in_its_element() {
        let base = world("red", 1.0);
        let paid = world_distance(&base, &world("red", -1.0), &Weights::default());
        let changed = |d: &Distance| Element::ALL.map(|element| d.element(element).is_some_and(|x| x > 0.0));
        assert_eq!(changed(&paid), [false, false, false, true, false]);
        let seen = world_distance(&base, &world("blue", 1.0), &Weights::default());
        assert_eq!(changed(&seen), [false, false, false, false, true]);
    }

    #[test]
    fn unmatched_object_counts_by_presence_looks_and_pay() {
        let mut more = world("red", 1.0);
        let mut barrel = Object::new("barrel", [20.0, 20.0]);
        (barrel.reward, barrel.reward_stimulus) = (-50.0, vec![Stimulus::AgentCollide]);
        more.push(barrel).unwrap();
        let distance = world_distance(&world("red", 1.0), &more, &Weights::default());
        assert_eq!(distance.differs_in(), [Element::S, Element::R, Element::O]);
        let elements = [Element::S, Element::R, Element::O].map(|element| distance.element(element));
        assert_eq!(elements, [Some(1.0), Some(0.5), Some(1.0)]);
    }

    #[test]
    fn keys_doors_and_switches_count_beyond_their_bodies() {
        let with = |change: fn(&mut Object)| {
            let mut object = Object::new("cube", [3.0, 4.0]);
            change(&mut object);
            World::default().edit(|world| world.objects.push(object)).unwrap()
        };
        let bare = with(|_| ());
        for thing in [
            with(|object| object.portable = Some(Portable::default())),
            with(|object| object.door = Some(Door::default())),
            with(|object| object.switch = Some(Switch::of("gate"))),
        ] {
            let distance = world_distance(&bare, &thing, &Weights::default());
            assert_eq!(distance.differs_in(), [Element::T]);
            assert!(distance.total >= 1.0, "{}", distance.total);
        }
    }

    /// Looks in which each part may be given or left out.
    fn looks() -> impl Strategy<Value = Looks> {
        let surfaces = [
            Surface::Plain,
            Surface::Noise,
            Surface::Brick,
            Surface::Tile,
            Surface::Stone,
            Surface::Cobbles,
        ];
        let covering = (
            prop::sample::select(surfaces.to_vec()),
            prop::sample::select(vec![1.0, 1.5, 3.0]),
        );
        let covering = || {
            prop::option::of(
                covering
                    .clone()
                    .prop_map(|(surface, scale)| Covering { surface, scale }),
            )
        };
        let flag = || prop::option::of(any::<bool>());
        let color = prop::sample::select(vec!["white", "black", "red"]);
        let parts = (
            covering(),
            covering(),
            flag(),
            prop::option::of(color),
            flag(),
            flag(),
            any::<bool>(),
        );
        (any::<bool>(), parts).prop_map(
            |(natural, (ground, walls, ceiling, color, shadows, clouds, fog_in_depth))| {
                let own = Looks::of(if natural { Style::Natural } else { Style::Plain });
                Looks {
                    ground,
                    walls,
                    ceiling,
                    ceiling_color: color.and_then(Color::from_name).unwrap_or(own.ceiling_color),
                    shadows,
                    clouds,
                    fog_in_depth,
                    ..own
                }
            },
        )
    }

    fn drawn(looks: Looks, layout: Option<&Layout>, fog: Option<f64>) -> World {
        let edited = World::default().edit(|world| {
            let environment = &mut world.environment_params;
            (environment.looks, environment.layout, environment.fog_distance) = (looks, layout.cloned(), fog);
        });
        edited.unwrap()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 64)))]

        /// Looks count by what is visible: a part that repeats the style's own value, or that nothing reads, is
        /// ignored.
        #[test]
        fn looks_count_only_where_visible(
            looks in looks(), other in looks(), inside in any::<bool>(), fog in prop::option::of(Just(12.0)),
        ) {
            let layout = inside.then(|| Layout { maze: Some(Maze { seed: Some(1), ..Maze::default() }), ..Layout::default() });
            let layout = layout.as_ref();
            let here = drawn(looks, layout, fog);
            let d = |a: &World, b: &World| world_distance(a, b, &Weights::default());
            let has_ceiling = looks.has_ceiling(layout);
            let in_full = Looks {
                ground: Some(looks.ground(has_ceiling)),
                walls: Some(looks.walls()),
                ceiling: Some(has_ceiling),
                shadows: Some(looks.has_shadows()),
                clouds: Some(looks.has_clouds()),
                ..looks
            };
            if looks.style == Style::Natural {
                prop_assert_eq!(d(&here, &drawn(in_full, layout, fog)).total, 0.0);
            }
            let mut unread = looks;
            if has_ceiling {
                unread.clouds = Some(!looks.has_clouds());
            } else {
                unread.ceiling_color = Color([0.1, 0.2, 0.3]);
            }
            if fog.is_none() {
                unread.fog_in_depth = !looks.fog_in_depth;
            }
            if looks.style == Style::Plain {
                unread = Looks { fog_in_depth: unread.fog_in_depth, style: Style::Plain, ..other };
            }
            prop_assert_eq!(d(&here, &drawn(unread, layout, fog)).total, 0.0, "{:?}", unread);
            let there = d(&here, &drawn(other, layout, fog));
            prop_assert!(there.differs_in().iter().all(|element| *element == Element::O));
            // Natural looks are 1 farther from the plain style than from the default of the natural style.
            let natural = drawn(Looks { fog_in_depth: looks.fog_in_depth, ..Looks::of(Style::Natural) }, layout, fog);
            let plain = drawn(Looks { fog_in_depth: looks.fog_in_depth, ..Looks::default() }, layout, fog);
            if looks.style == Style::Natural {
                prop_assert!((d(&plain, &here).total - d(&natural, &here).total - 1.0).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn covers_and_texts_count_where_visible() {
        let with = |style: Style, class: &str, change: fn(&mut Object)| {
            let mut object = Object::new(class, [3.0, 4.0]);
            change(&mut object);
            let edited = World::default().edit(|world| {
                world.environment_params.looks = Looks::of(style);
                world.objects.push(object);
            });
            edited.unwrap()
        };
        let d = |style: Style, class: &str, change: fn(&mut Object)| {
            world_distance(
                &with(style, class, |_| ()),
                &with(style, class, change),
                &Weights::default(),
            )
            .total
        };
        let brick = |object: &mut Object| object.surface = Surface::Brick;
        let says = |object: &mut Object| object.text = Some("GO".to_owned());
        assert_eq!(
            (d(Style::Plain, "cube", brick), d(Style::Natural, "cube", brick)),
            (0.0, 1.0)
        );
        assert_eq!(
            (d(Style::Natural, "cube", says), d(Style::Plain, "sign", says)),
            (0.0, 1.0)
        );
    }

    #[test]
    fn ceiling_colours_are_compared_as_colours() {
        let under = |color: Color| {
            let looks = Looks {
                ceiling: Some(true),
                ceiling_color: color,
                ..Looks::of(Style::Natural)
            };
            drawn(looks, None, None)
        };
        let d = |a: Color, b: Color| world_distance(&under(a), &under(b), &Weights::default()).total;
        let (black, white) = (Color([0.0; 3]), Color([1.0; 3]));
        assert!((d(black, white) - 1.0).abs() < 1e-6);
        assert!(d(black, Color([0.01; 3])) < 0.1);
    }

    #[test]
    fn positions_colours_and_pay_are_matched_together() {
        let cube = |color: &str, reward: f64, y: f64| {
            let mut cube = Object::new("cube", [0.0, y]);
            (cube.color, cube.reward, cube.reward_stimulus) =
                (Color::from_name(color), reward, vec![Stimulus::AgentCollide]);
            cube
        };
        let world = |objects: Vec<Object>| World::default().edit(|world| world.objects = objects).unwrap();
        let north = world(vec![cube("red", 10.0, 10.0), cube("blue", -10.0, -10.0)]);
        let swapped = world(vec![cube("red", 10.0, -10.0), cube("blue", -10.0, 10.0)]);
        let shuffled = world(vec![cube("blue", -10.0, -10.0), cube("red", 10.0, 10.0)]);
        let d = |other: &World| world_distance(&north, other, &Weights::default()).total;
        assert!(d(&swapped) > 1.0);
        assert_eq!(d(&shuffled), 0.0);
        let opposite_pay = world(vec![cube("red", -10.0, 10.0), cube("blue", 10.0, -10.0)]);
        let paid = world_distance(&north, &opposite_pay, &Weights::default());
        assert_eq!((paid.differs_in(), paid.total), (vec![Element::R], 0.4));
    }

    #[test]
    fn zones_count_in_their_elements_in_any_order() {
        type Change = fn(&mut Zone);
        let plain = || {
            let mut zone = Zone::disc([3.0, 0.0], 2.0);
            zone.visible = false;
            zone
        };
        let world = |zones: Vec<Zone>| {
            World::default()
                .edit(|world| world.environment_params.zones = zones)
                .unwrap()
        };
        let between = |a: Vec<Zone>, b: Vec<Zone>| world_distance(&world(a), &world(b), &Weights::default());
        let changes: [(Element, Change); 5] = [
            (Element::T, |zone| zone.speed_factor = 0.5),
            (Element::T, |zone| zone.teleport = Some([9.0, 9.0])),
            (Element::R, |zone| zone.reward_per_second = 1.0),
            (Element::R, |zone| zone.ends = Some(ZoneEnd::Failure)),
            (Element::O, |zone| {
                (zone.visible, zone.color) = (true, Color::from_name("red"));
            }),
        ];
        assert_eq!(between(vec![plain()], vec![]).total, 0.0, "the zone has no effect");
        for (element, change) in changes {
            let mut zone = plain();
            change(&mut zone);
            assert_eq!(between(vec![zone.clone()], vec![plain()]).differs_in(), [element]);
            let mut moved = zone.clone();
            moved.disc = Some(Disc {
                center: [4.0, 0.0],
                radius: 2.0,
            });
            let distance = between(vec![zone.clone()], vec![moved.clone()]);
            assert_eq!(distance.differs_in(), [element]);
            assert!((distance.total - 0.1).abs() < 1e-9, "a metre");
            assert_eq!(between(vec![zone.clone(), moved.clone()], vec![moved, zone]).total, 0.0);
        }
    }

    fn worlds() -> impl Strategy<Value = World> {
        let place = || prop::array::uniform2(-20.0..20.0_f64);
        let color = prop::sample::select(vec!["red", "blue", "tan"]);
        let objects = prop::collection::vec((place(), color, -100.0..100.0_f64, 0.0..=1.0_f64), 0..5);
        (objects, place(), 0.0..360.0_f64, -1.0..1.0_f64, 0.0..4.0_f64).prop_map(
            |(objects, start, heading, step_reward, light)| {
                let mut world = WorldDraft::default();
                for (index, (place, color, reward, odds)) in objects.into_iter().enumerate() {
                    let mut object = Object::new(if index == 0 { "tree" } else { "pot" }, place);
                    object.color = Color::from_name(color);
                    (object.reward, object.reward_probability) = (reward, odds);
                    object.reward_stimulus = vec![Stimulus::AgentCollide];
                    world.objects.push(object);
                }
                (world.agent_params.coordinates, world.agent_params.heading) = (start, heading);
                world.rules.step_reward = step_reward;
                world.environment_params.light_intensity = light;
                world.check().unwrap()
            },
        )
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn world_distance_is_symmetric_and_zero_on_itself(a in worlds(), b in worlds()) {
            let d = |a, b| world_distance(a, b, &Weights::default());
            prop_assert_eq!(d(&a, &a).total, 0.0);
            prop_assert_eq!(d(&a, &b), d(&b, &a));
            prop_assert!(d(&a, &b).parts.iter().all(|part| part.normalised >= 0.0));
        }

        #[test]
        fn world_distance_is_a_metric_if_objects_stay_in_place(
            world in worlds(),
            pays in prop::array::uniform3(prop::array::uniform4(-300.0..300.0_f64)),
            lights in prop::array::uniform3(0.0..4.0_f64),
        ) {
            let [a, b, c] = [0, 1, 2].map(|index: usize| {
                let mut other = world.clone().into_draft();
                other.environment_params.light_intensity = lights[index];
                for (object, reward) in other.objects.iter_mut().zip(pays[index]) {
                    object.reward = reward;
                }
                other.check().unwrap()
            });
            let d = |a, b| world_distance(a, b, &Weights::default()).total;
            prop_assert!(d(&a, &c) <= d(&a, &b) + d(&b, &c) + 1e-9);
        }

        #[test]
        fn object_order_and_unread_fields_change_nothing(a in worlds(), b in worlds(), turn in 0_usize..4) {
            let d = |a: &World, b: &World| world_distance(a, b, &Weights::default());
            let mut shuffled = b.clone().into_draft();
            shuffled.objects.rotate_left(turn.min(b.objects.len()));
            shuffled.objects.iter_mut().for_each(|object| {
                object.unique_name = None;
                object.tag = Some("another".to_owned());
                object.range_stimulus_distance += 7.0;
                object.speed += 3.0;
            });
            let shuffled = shuffled.check().unwrap();
            prop_assert_eq!(d(&b, &shuffled).total, 0.0);
            prop_assert_eq!(d(&a, &b), d(&a, &shuffled));
        }

        #[test]
        fn remote_object_in_both_worlds_changes_nothing(a in worlds(), b in worlds(), reward in -300.0..300.0_f64) {
            let mut object = Object::new("lamp", [200.0, 200.0]);
            (object.reward, object.reward_stimulus) = (reward, vec![Stimulus::AgentInteract]);
            let with = |world: &World| {
                let mut world = world.clone();
                world.push(object.clone()).unwrap();
                world
            };
            let d = |a: &World, b: &World| world_distance(a, b, &Weights::default());
            prop_assert_eq!(d(&a, &b), d(&with(&a), &with(&b)));
        }

        #[test]
        fn partial_sign_change_is_at_most_the_full_reversal(world in worlds(), signs in prop::array::uniform4(any::<bool>())) {
            let signed = |signs: [bool; 4]| {
                let mut signed = world.clone().into_draft();
                for (object, negative) in signed.objects.iter_mut().zip(signs) {
                    object.reward *= if negative { -1.0 } else { 1.0 };
                }
                world_distance(&world, &signed.check().unwrap(), &Weights::default()).element(Element::R)
            };
            prop_assert!(signed(signs) <= signed([true; 4]));
        }

        #[test]
        fn prepared_worlds_give_bit_identical_distances(a in worlds(), b in worlds(), fewer in any::<bool>()) {
            let mut b = b;
            if fewer {
                b = b.edit(|b| b.objects.truncate(2)).unwrap();
            }
            let prepared = Worlds::new(&[a.clone(), b.clone()], Weights::default());
            prop_assert_eq!(prepared.distance(0, 1), world_distance(&a, &b, &Weights::default()).total);
            prop_assert_eq!(prepared.explain(0, 1), world_distance(&a, &b, &Weights::default()));
            let alone = world_sets_distance(std::slice::from_ref(&a), std::slice::from_ref(&b), &Weights::default()).unwrap();
            prop_assert_eq!(prepared.distance(0, 1), alone.total);
        }
    }
}
