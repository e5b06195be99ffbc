//! A door obeys its last order, even if something blocks it in the meantime. The simulator is compared with a minimal reference
//! implementation.

use driftworld_env::{Action, Effect, Environment};
use driftworld_spec::{Door, Object, Stimulus, Switch, SwitchAction, World, WorldDraft};
use proptest::prelude::*;

const TIME_STEP: f64 = 0.1;
const DOOR: usize = 0;

/// Two cells with a door between them, and around it pads that move it when the agent comes near.
fn doorway(door: Door, pads: &[([f64; 2], SwitchAction)]) -> World {
    let mut world = WorldDraft::default();
    world.environment_params.map_size = [2.0, 4.0];
    let mut leaf = Object::new("door", [0.0, 0.0]);
    (leaf.tag, leaf.scale, leaf.door) = (Some("door".to_owned()), 2.0, Some(door));
    world.objects = vec![leaf];
    for (at, action) in pads {
        let mut pad = Object::new("switch", *at);
        (pad.solid, pad.range_stimulus_distance) = (false, 0.4);
        pad.switch = Some(Switch {
            on: vec![Stimulus::AgentInRange],
            action: *action,
            ..Switch::of("door")
        });
        world.objects.push(pad);
    }
    (world.agent_params.coordinates, world.agent_params.agent_width) = ([0.0, -1.0], 0.6);
    world.agent_params.time_step = TIME_STEP;
    world.check().expect("the world is valid")
}

/// A reference door, driven only by its orders.
struct Orders {
    is_open: bool,
    due: Option<u64>,
}

fn ticks(seconds: f64) -> u64 {
    ((seconds / TIME_STEP - 1e-6).ceil() as u64).max(1)
}

impl Orders {
    fn open(&mut self, door: &Door, tick: u64) {
        self.is_open = true;
        self.due = door.closes_after.map(|seconds| tick + ticks(seconds));
    }

    fn close(&mut self, tick: u64) {
        if self.is_open {
            self.due = Some(self.due.map_or(tick - 1, |due| due.min(tick - 1)));
        }
    }

    fn apply(&mut self, action: SwitchAction, door: &Door, tick: u64) {
        let is_to_be_open = self.is_open && self.due.is_none_or(|due| due >= tick);
        match action {
            SwitchAction::Close => self.close(tick),
            SwitchAction::Toggle if is_to_be_open => self.close(tick),
            SwitchAction::Open | SwitchAction::Toggle => self.open(door, tick),
        }
    }
}

/// Distance from the agent's body to the leaf of the closed door, negative inside.
fn distance_to_leaf(environment: &Environment) -> f64 {
    let [x, y] = environment.agent().position.map(f64::from);
    libm::hypot((x.abs() - 1.0).max(0.0), (y.abs() - 0.195).max(0.0)) - 0.3
}

fn action() -> impl Strategy<Value = Action> {
    (-2.0..3.0_f64, -60.0..60.0_f64, 0..4_u8)
        .prop_map(|(speed, turn, hand)| Action::Continuous([speed, turn, f64::from(u8::from(hand == 0))]))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 200)))]

    #[test]
    fn door_obeys_its_last_order(
        open in any::<bool>(), closes_after in prop::option::of(0.1..4.0_f64), period in prop::option::of(0.5..6.0_f64),
        (opens, closes) in (any::<bool>(), any::<bool>()),
        pads in prop::collection::vec(((-0.9..0.9_f64, -0.7..0.7_f64), 0..3_u8), 1..5),
        actions in prop::collection::vec(action(), 100..300),
    ) {
        let by_hand = |wanted| if wanted { vec![Stimulus::AgentInteract] } else { Vec::new() };
        let door = Door { open, closes_after, period, opens_on: by_hand(opens), closes_on: by_hand(closes), ..Door::default() };
        let pads: Vec<([f64; 2], SwitchAction)> = pads.into_iter().map(|((x, y), action)| {
            ([x, y], [SwitchAction::Toggle, SwitchAction::Open, SwitchAction::Close][usize::from(action)])
        }).collect();
        let mut environment = Environment::new(doorway(door.clone(), &pads));
        let mut orders = Orders { is_open: open, due: closes_after.filter(|_| open).map(ticks) };
        for (number, action) in actions.into_iter().enumerate() {
            let tick = number as u64 + 1;
            let step = environment.step(action).expect("the episode never ends");
            for event in &step.events {
                match event.effect {
                    Some(Effect::Opened) => orders.open(&door, tick),
                    Some(Effect::Closed) => orders.close(tick),
                    Some(Effect::Switched) => orders.apply(pads[event.object - 1].1, &door, tick),
                    _ => {}
                }
            }
            if let Some(period) = door.period {
                let is_first_half = |tick: u64| (((tick as f64 * TIME_STEP) / (period / 2.0) + 1e-6).floor() as u64).is_multiple_of(2);
                if is_first_half(tick) != is_first_half(tick - 1) {
                    if is_first_half(tick) == open { orders.open(&door, tick) } else { orders.close(tick) }
                }
            }
            let found = environment.objects()[DOOR].open;
            let apart = distance_to_leaf(&environment);
            if orders.is_open && orders.due.is_some_and(|due| due <= tick) {
                // If the leaf just touches the agent, either is correct.
                let is_clear = if apart.abs() < 0.02 { !found } else { apart > 0.0 };
                if is_clear {
                    (orders.is_open, orders.due) = (false, None);
                }
            }
            prop_assert_eq!(found, orders.is_open, "time step {}, the agent {} m from the leaf", tick, apart);
        }
    }
}
