//! [`regrets`]: compares two worlds by what their experts earn in each other's.

use driftworld_env::{EnvError, ExpertRun, Expertise};
use driftworld_spec::World;

/// Maximum number of pairs of worlds, also for pictures and dynamics.
pub(crate) const MAX_BEHAVIOR_WORLDS: u64 = 1_000;

/// Points of regret that count as a distance of 1.
pub(crate) const POINTS: f64 = 100.0;

/// Exchanges the experts of two worlds, whose `own` runs are known.
///
/// In a foreign world an expert knows where everything is, but expects the rewards of its own world; [`Expertise::abroad`]
/// describes this in detail. Experts are greedy: they visit the nearest rewarding object first. If the foreign expert's route
/// happens to be better, the regret is negative.
///
/// Returns how many points fewer the foreign expert earns than the world's own expert in the first world and in the second, and
/// the success rate of own experts minus that of foreign ones, −1 to 1.
pub(crate) fn regrets(expertise: &Expertise, worlds: [&World; 2], own: [ExpertRun; 2]) -> Result<[f64; 3], EnvError> {
    let foreign = [
        expertise.abroad(worlds[1], worlds[0])?,
        expertise.abroad(worlds[0], worlds[1])?,
    ];
    let successes = |runs: [ExpertRun; 2]| runs.map(|run| f64::from(u8::from(run.success))).iter().sum::<f64>();
    Ok([
        own[0].earned - foreign[0].earned,
        own[1].earned - foreign[1].earned,
        (successes(own) - successes(foreign)) / 2.0,
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use driftworld_spec::{Object, Stimulus, WorldDraft};

    use crate::{generator, tasks};

    /// The trap's expert keeps away from a cube that pays in one world and costs in the other; the first world's touches it.
    #[test]
    fn regret_is_the_advantage_of_the_worlds_own_expert() {
        let expertise = Expertise::default();
        let mut cube = Object::new("geometric", [0.0, 8.0]);
        cube.reward = 10.0;
        cube.reward_once_stimulus = vec![Stimulus::AgentCollide];
        let mut world = WorldDraft::with_objects(vec![cube]);
        world.max_steps = 50;
        let home = world.check().expect("the world is valid");
        let trap = home.clone().edit(|world| world.objects[0].reward = -30.0);
        let worlds = [&home, &trap.expect("the world is valid")];
        let own = worlds.map(|world| expertise.at_home(world).expect("it can be run"));
        assert_eq!(own.map(|run| run.earned), [10.0, 0.0]);
        let found = regrets(&expertise, worlds, own).expect("both can be run");
        assert_eq!(found, [10.0, 30.0, 0.0]);
    }

    #[test]
    fn regrets_are_0_at_home_and_swap_with_the_worlds() {
        let expertise = Expertise::default();
        let [red, penalty] = ["find_objects#red", "find_objects#penalty"].map(|name| {
            let variant = tasks::variant(name).expect("it is built in");
            let world = generator::sample(&variant, 0, 0).expect("it can be drawn");
            let own = expertise.at_home(&world).expect("it can be run");
            (world, own)
        });
        assert!(red.1.earned > 0.0);
        let between = |a: &(World, ExpertRun), b: &(World, ExpertRun)| {
            regrets(&expertise, [&a.0, &b.0], [a.1, b.1]).expect("both can be run")
        };
        assert_eq!(between(&red, &red), [0.0; 3]);
        let [in_red, in_penalty, success] = between(&red, &penalty);
        assert!(in_red + in_penalty > 0.0);
        assert_eq!(between(&penalty, &red), [in_penalty, in_red, success]);
    }
}
