//! What a picture of a world is about, and whether a camera sees it: what pays, costs, moves or is used, counted by
//! pixels. Which camera is taken is the contact sheet's choice.

use driftworld_env::{Camera, Renderer, Scene, Target};
use driftworld_spec::{MotionModel, World};

use crate::Failure;

/// Pixels along each side of the pictures that are counted.
const SIDE: u32 = 64;

/// From so many pixels on an object counts as seen: a thousandth of the picture, a cube of 1 m from 30 m.
pub(crate) const ENOUGH: u32 = SIDE * SIDE / 1000;

/// The objects that a picture is about: those that pay, cost, move or are used; where there are none, all.
pub(crate) fn subjects(world: &World) -> Vec<usize> {
    let objects = || world.objects.iter().enumerate();
    let chosen = |is_subject: &dyn Fn(&driftworld_spec::Object) -> bool| -> Vec<usize> {
        objects()
            .filter(|(_, object)| is_subject(object))
            .map(|(index, _)| index)
            .collect()
    };
    let main = chosen(&|object| {
        object.is_target()
            || object.is_used()
            || object.motion_model != MotionModel::Stationary
            || object.order.is_some()
    });
    if !main.is_empty() {
        return main;
    }
    let costly = chosen(&|object| object.reward != 0.0 || object.pushable.is_some());
    if costly.is_empty() { chosen(&|_| true) } else { costly }
}

/// How much of its subjects a camera sees.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Sight {
    /// Subjects of which there is enough.
    pub(crate) seen: u32,
    /// Pixels of all subjects, of 4,096.
    pub(crate) pixels: u32,
}

impl Sight {
    /// Whether a reader finds what the picture is about.
    pub(crate) fn is_enough(self) -> bool {
        self.seen > 0
    }
}

/// What a camera sees of some of the scene's items.
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
    for instance in instances {
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
