//! Finds the subjects of a picture of a world, such as rewarding or moving objects. Measures how much of them a camera sees, in
//! pixels, and the free space before the camera.

use driftworld_env::{Camera, Renderer, Scene, Target};
use driftworld_spec::{MotionModel, World};

use crate::Failure;

/// Width and height of the pictures whose pixels are counted.
const SIDE: u32 = 64;

/// Number of columns at each side that do not count: objects there are cut off, or easily overlooked.
const MARGIN: u32 = SIDE / 8;

/// An object with at least this many pixels counts as visible: a thousandth of the picture, or a 1 m cube seen from 30 m.
pub(crate) const ENOUGH: u32 = SIDE * SIDE / 1000;

/// The subjects of a picture: objects that pay, move, have a function or a place in an order; if there are none, objects that
/// cost or can be pushed; else all objects.
pub(crate) fn subjects(world: &World) -> Vec<usize> {
    let objects = || world.objects.iter().enumerate();
    let select = |is_subject: &dyn Fn(&driftworld_spec::Object) -> bool| -> Vec<usize> {
        objects()
            .filter(|(_, object)| is_subject(object))
            .map(|(index, _)| index)
            .collect()
    };
    let main = select(&|object| {
        object.is_target()
            || object.is_used()
            || object.motion_model != MotionModel::Stationary
            || object.order.is_some()
    });
    if !main.is_empty() {
        return main;
    }
    let costly = select(&|object| object.reward != 0.0 || object.pushable.is_some());
    if costly.is_empty() { select(&|_| true) } else { costly }
}

/// How much of its subjects a camera sees.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Sight {
    /// Subjects with enough pixels.
    pub(crate) seen: u32,
    /// Pixels of all subjects, out of 4,096, without the margins.
    pub(crate) pixels: u32,
}

impl Sight {
    /// Whether a reader can find the picture's subject.
    pub(crate) fn is_enough(self) -> bool {
        self.seen > 0
    }
}

/// How much a camera sees of some of the scene's items.
pub(crate) fn sight(
    renderer: &mut Renderer,
    scene: &Scene,
    camera: &Camera,
    subjects: &[usize],
) -> Result<Sight, Failure> {
    let mut instances = vec![0_u32; (SIDE * SIDE) as usize];
    let mut target = Target {
        width: SIDE,
        height: SIDE,
        instance: Some(&mut instances),
        ..Target::default()
    };
    renderer.draw(scene, camera, &mut target)?;
    let mut counts = vec![0_u32; scene.items.len()];
    let counted = MARGIN as usize..(SIDE - MARGIN) as usize;
    let is_counted = |(index, _): &(usize, u32)| counted.contains(&(index % SIDE as usize));
    for (_, instance) in instances.into_iter().enumerate().filter(is_counted) {
        if let Some(count) = (instance as usize)
            .checked_sub(1)
            .and_then(|index| counts.get_mut(index))
        {
            *count += 1;
        }
    }
    let own = || subjects.iter().filter_map(|index| counts.get(*index)).copied();
    Ok(Sight {
        seen: own().filter(|pixels| *pixels >= ENOUGH).count() as u32,
        pixels: own().sum(),
    })
}

/// Distances are capped at this many metres in the measure of free space.
const OPEN_METRES: f32 = 30.0;

/// Free space before a camera: the mean distance in metres to what it sees, up to 30.
pub(crate) fn openness(renderer: &mut Renderer, scene: &Scene, camera: &Camera) -> Result<f32, Failure> {
    let mut depth = vec![0.0_f32; (SIDE * SIDE) as usize];
    let mut target = Target {
        width: SIDE,
        height: SIDE,
        depth: Some(&mut depth),
        ..Target::default()
    };
    renderer.draw(scene, camera, &mut target)?;
    Ok(depth.iter().map(|metres| metres.min(OPEN_METRES)).sum::<f32>() / depth.len() as f32)
}

#[expect(clippy::disallowed_methods, reason = "only the position of a cube before a camera")]
#[cfg(test)]
mod tests {
    use driftworld_spec::{Object, WorldDraft};
    use proptest::prelude::*;

    use super::*;
    use crate::views::agent_camera;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 40)))]

        /// A cube is visible if it lies entirely between the margins, and not if it lies entirely in a margin.
        #[test]
        fn objects_in_a_margin_are_not_visible(share in -1.2..1.2_f64) {
            let mut draft = WorldDraft::default();
            draft.environment_params.map_size = [60.0, 60.0];
            draft.agent_params.coordinates = [0.0, -5.0];
            draft.agent_params.heading = 0.0;
            let half = (draft.agent_params.field_of_view / 2.0).to_radians().tan() * 10.0;
            let mut object = Object::new("geometric", [share * half, 5.0]);
            object.scale = 1.0;
            draft.objects.push(object);
            let world = draft.check().expect("the world is valid");
            let (scene, camera) = (Scene::from_world(&world), agent_camera(&world, 0.0));
            let seen = sight(&mut Renderer::default(), &scene, &camera, &[0]).expect("it renders");
            let (inner, rim) = (1.0 - 2.0 * f64::from(MARGIN) / f64::from(SIDE), 0.8 / half);
            if share.abs() < inner - rim {
                prop_assert!(seen.is_enough(), "{seen:?}");
            }
            if share.abs() > inner + rim {
                prop_assert_eq!(seen, Sight::default());
            }
        }
    }
}
