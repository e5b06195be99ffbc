//! How fast worlds are drawn and documents checked.

use std::time::Duration;

use crate::generator::Sampler;
use crate::spec::{TaskSpec, World};
use crate::tasks;

use crate::Failure;

use super::{Figures, rate, rates};

/// The scene of about 86 objects on the backslash map.
const SETTLEMENT: &str = include_str!("../../examples/tasks/settlement.json");

/// Worlds and validations each second.
pub(crate) fn measure(round: Duration) -> Result<Figures, Failure> {
    let settlement = TaskSpec::from_json("settlement.json", SETTLEMENT)?.variant("near")?;
    let of_86 = Sampler::new(&settlement, 7);
    let find_objects = Sampler::new(&tasks::variant("find_objects#red")?, 7);
    let small = of_86.world(0)?.edit(|world| world.objects.truncate(30))?;
    let text = small.to_json();
    Ok(rates([
        (
            "worlds_per_second_per_core_map_86",
            rate(round, |index| of_86.world(index).map(drop))?,
        ),
        (
            "worlds_per_second_per_core_find_objects",
            rate(round, |index| find_objects.world(index).map(drop))?,
        ),
        (
            "validations_per_second_per_core",
            rate(round, |_| World::from_json("world.json", &text).map(drop))?,
        ),
    ]))
}
