//! Tests the laws of distances by worlds on random worlds and on worlds of the built-in tasks.

use std::sync::LazyLock;

use driftworld::generator::Sampler;
use driftworld::similarity::{Distance, Weights, world_distance};
use driftworld::spec::{Element, Object, Variant, World};
use driftworld::tasks;
use proptest::prelude::*;

use super::drawn_worlds::{OTHER_CLASS, objects, worlds};

static VARIANTS: LazyLock<Vec<Variant>> = LazyLock::new(|| {
    let of = |(name, _): &(&str, &str)| tasks::variants(name).unwrap_or_else(|error| panic!("{error}"));
    tasks::BUILT_IN.iter().flat_map(of).collect()
});

/// Pairs of worlds of the built-in tasks: one of any variant, and one of its task's first variant under the same seed.
fn built_in() -> impl Strategy<Value = (World, World)> {
    (0..VARIANTS.len(), 0..4_u64).prop_map(|(index, seed)| {
        let variant = &VARIANTS[index];
        let first = variant.task().all_variants().swap_remove(0);
        let draw = |variant: &Variant| {
            Sampler::new(variant, seed)
                .world(0)
                .unwrap_or_else(|error| panic!("{error}"))
        };
        (draw(variant), draw(&first))
    })
}

fn any_two() -> impl Strategy<Value = (World, World)> {
    prop_oneof![(worlds(), worlds()), built_in()]
}

fn d(a: &World, b: &World) -> Distance {
    world_distance(a, b, &Weights::default())
}

fn reward(distance: &Distance) -> f64 {
    distance.element(Element::R).unwrap_or(0.0)
}

/// The world with its objects changed.
fn with(world: &World, change: impl FnOnce(&mut Vec<Object>)) -> World {
    let edited = world.clone().edit(|world| change(&mut world.objects));
    edited.unwrap_or_else(|error| panic!("{error}"))
}

fn is_paid(object: &Object) -> bool {
    !(object.reward_stimulus.is_empty() && object.reward_once_stimulus.is_empty())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: crate::tier::quick_or_full(24, 128), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn object_order_and_names_do_not_matter((a, b) in any_two(), keys in prop::collection::vec(any::<u32>(), 60)) {
        let shuffled = with(&b, |objects| {
            let mut keyed: Vec<(u32, Object)> = keys.iter().cycle().copied().zip(objects.drain(..)).collect();
            keyed.sort_by_key(|(key, _)| *key);
            objects.extend(keyed.into_iter().map(|(_, object)| object));
            for object in objects {
                object.seed = Some(7);
            }
        });
        prop_assert_eq!(d(&b, &shuffled).total, 0.0);
        prop_assert_eq!(d(&a, &b), d(&a, &shuffled));
        prop_assert_eq!(d(&a, &b), d(&b, &a));
    }

    #[test]
    fn equal_objects_do_not_matter((a, b) in any_two(), object in objects(), is_other in any::<bool>()) {
        let mut object = object;
        if is_other {
            OTHER_CLASS.clone_into(&mut object.class);
        }
        let more = |world: &World| with(world, |objects| objects.push(object.clone()));
        let (before, after) = (d(&a, &b), d(&more(&a), &more(&b)));
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-12 * (1.0 + a);
        // Among matchings of equal cost, objects with equal rewards are matched: a detour via the new object is not cheaper.
        prop_assert!(near(before.total, after.total), "{before:#?} and {after:#?}");
    }

    #[test]
    fn swapped_pay_differs((world, _) in any_two(), first in any::<prop::sample::Index>(), second in any::<prop::sample::Index>()) {
        let paid: Vec<usize> = (0..world.objects.len()).filter(|index| is_paid(&world.objects[*index])).collect();
        prop_assume!(paid.len() >= 2);
        let (i, j) = (*first.get(&paid), *second.get(&paid));
        let swapped = with(&world, |objects| {
            (objects[i].reward, objects[j].reward) = (objects[j].reward, objects[i].reward);
        });
        let found = d(&world, &swapped);
        let gap = (world.objects[i].reward - world.objects[j].reward).abs();
        prop_assert!((reward(&found) - 2.0 * gap / 100.0).abs() < 1e-12, "{found:#?}");
        prop_assert_eq!(found.total, reward(&found));
    }

    #[test]
    fn partial_sign_change_is_at_most_the_full_reversal((world, _) in any_two(), signs in prop::collection::vec(any::<bool>(), 60)) {
        let signed = |flips: &dyn Fn(usize) -> bool| d(&world, &with(&world, |objects| {
            for (index, object) in objects.iter_mut().enumerate() {
                object.reward *= if flips(index) { -1.0 } else { 1.0 };
            }
        }));
        let (full, partial) = (signed(&|_| true), signed(&|index| signs[index % signs.len()]));
        prop_assert!(reward(&partial) <= reward(&full));
        let pays: f64 = world.objects.iter().filter(|object| is_paid(object)).map(|object| object.reward.abs()).sum();
        prop_assert!((reward(&full) - 2.0 * pays / 100.0).abs() < 1e-9);
        prop_assert!(full.differs_in().iter().all(|element| *element == Element::R), "{full:#?}");
    }

    #[test]
    fn unread_fields_do_not_count((world, other) in any_two(), more in 1.0..9.0_f64) {
        let idle = with(&world, |objects| {
            for object in objects {
                if !is_paid(object) {
                    (object.reward, object.reward_probability) = (object.reward + more, 0.25);
                }
                if object.motion_model == driftworld::spec::MotionModel::Stationary {
                    (object.speed, object.turn_rate) = (object.speed + more, Some(more));
                }
                object.tag = None;
            }
        });
        prop_assert_eq!(d(&world, &idle).total, 0.0);
        prop_assert_eq!(d(&other, &world), d(&other, &idle));
    }

    #[test]
    fn changes_of_one_number_are_graded((world, _) in any_two(), near in 0.01..0.4_f64, far in 0.6..0.9_f64) {
        type Change = fn(&mut driftworld::spec::WorldDraft, f64);
        let changes: [Change; 8] = [
            |world, share| world.agent_params.max_linear_speed *= 1.0 - share,
            |world, share| world.agent_params.agent_width *= 1.0 - share / 2.0,
            |world, share| world.agent_params.heading = (world.agent_params.heading + 180.0 * share) % 360.0,
            |world, share| world.environment_params.light_intensity = (world.environment_params.light_intensity + 1.0) * (1.0 - share),
            |world, share| world.environment_params.fog_distance = Some(60.0 * (1.0 - share)),
            |world, share| world.rules.reward_per_second += share,
            |world, share| world.max_seconds = 30.0 * (1.0 - share),
            |world, share| if let Some(object) = world.objects.first_mut() {
                object.scale *= 1.0 - share;
            },
        ];
        for (index, change) in changes.into_iter().enumerate() {
            let moved = |share: f64| {
                let mut draft = world.clone().into_draft();
                draft.max_steps = 0;
                draft.environment_params.light_intensity += 1.0;
                change(&mut draft, share);
                draft.check().unwrap_or_else(|error| panic!("{error}"))
            };
            let (base, small, large) = (moved(0.0), moved(near), moved(far));
            let (small, large) = (d(&base, &small).total, d(&base, &large).total);
            let applies = index != 7 || !world.objects.is_empty();
            prop_assert!(!applies || (0.0 < small && small < large), "change {index}: {small} and {large}");
        }
    }
}
