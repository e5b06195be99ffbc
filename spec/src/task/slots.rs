//! The table of places in a world and in an object where a spec may put a parameter or a distribution. How holes are found is in `template.rs`.

use super::value::{ParameterType, Value};
use crate::world::{ActionModel, Modality, Model, MotionModel, Object, Stimulus, World};

/// A place in a `T` that can be filled by a value. `*` in the pointer stands for the index in a list.
pub(crate) struct Slot<T> {
    /// JSON pointer from the `T`.
    pub(crate) pointer: &'static str,
    /// The type of value that goes there.
    pub(crate) kind: ParameterType,
    /// Puts a value there; the index is that of the `*`. `None` if the value cannot stand there.
    pub(crate) set: fn(&mut T, usize, &Value) -> Option<()>,
}

impl<T> Slot<T> {
    /// The slot of a table that a pointer names, and the index in it.
    pub(crate) fn find(table: &'static [Self], pointer: &str) -> Option<(&'static Self, usize)> {
        let exact = table.iter().find(|slot| slot.pointer == pointer).map(|slot| (slot, 0));
        exact.or_else(|| {
            let (list, index) = pointer.rsplit_once('/')?;
            let index = index.parse().ok()?;
            let slot = table
                .iter()
                .find(|slot| slot.pointer.strip_suffix("/*") == Some(list))?;
            Some((slot, index))
        })
    }
}

const fn slot<T>(pointer: &'static str, kind: ParameterType, set: fn(&mut T, usize, &Value) -> Option<()>) -> Slot<T> {
    Slot { pointer, kind, set }
}

use ParameterType::{Boolean, Color, Heading, Integer, Number, Point, String, Vector};

/// Writes one row of a table: pointer, type, the field, how to read the value.
macro_rules! row {
    ($pointer:literal, $kind:ident, $($field:ident).+, $read:expr) => {
        slot($pointer, $kind, |target, _, value| {
            target.$($field).+ = $read(value)?;
            Some(())
        })
    };
    ($pointer:literal, $kind:ident, $($field:ident).+ [], $read:expr) => {
        slot($pointer, $kind, |target, index, value| {
            *target.$($field).+.get_mut(index)? = $read(value)?;
            Some(())
        })
    };
}

/// Where a world's template may vary, its objects apart.
pub(crate) const WORLD: &[Slot<World>] = &[
    row!("/max_steps", Integer, max_steps, whole),
    row!("/max_seconds", Number, max_seconds, number),
    row!(
        "/environment_params/bounding_wall_color",
        Color,
        environment_params.bounding_wall_color,
        color
    ),
    row!(
        "/environment_params/light_intensity",
        Number,
        environment_params.light_intensity,
        number
    ),
    row!(
        "/environment_params/predefined_map",
        Integer,
        environment_params.predefined_map,
        whole
    ),
    row!(
        "/environment_params/map_size",
        Point,
        environment_params.map_size,
        point
    ),
    row!("/environment_params/map_size/*", Number, environment_params.map_size[], number),
    row!(
        "/environment_params/wall_height",
        Number,
        environment_params.wall_height,
        number
    ),
    row!(
        "/environment_params/sun_direction",
        Vector,
        environment_params.sun_direction,
        triple
    ),
    row!("/environment_params/sun_direction/*", Number, environment_params.sun_direction[], number),
    row!(
        "/environment_params/light_color",
        Color,
        environment_params.light_color,
        color
    ),
    row!(
        "/environment_params/ambient_light",
        Number,
        environment_params.ambient_light,
        number
    ),
    row!(
        "/environment_params/sky_color",
        Color,
        environment_params.sky_color,
        color
    ),
    row!(
        "/environment_params/ground_color",
        Color,
        environment_params.ground_color,
        color
    ),
    slot("/environment_params/fog_distance", Number, |world, _, value| {
        world.environment_params.fog_distance = Some(number(value)?);
        Some(())
    }),
    row!(
        "/agent_params/action_model",
        String,
        agent_params.action_model,
        word::<ActionModel>
    ),
    row!("/agent_params/agent_height", Number, agent_params.agent_height, number),
    row!("/agent_params/agent_width", Number, agent_params.agent_width, number),
    row!(
        "/agent_params/max_linear_speed",
        Number,
        agent_params.max_linear_speed,
        number
    ),
    row!(
        "/agent_params/max_angular_speed",
        Number,
        agent_params.max_angular_speed,
        number
    ),
    row!(
        "/agent_params/observation_size",
        Integer,
        agent_params.observation_size,
        whole
    ),
    slot("/agent_params/observation_width", Integer, |world, _, value| {
        world.agent_params.observation_width = Some(whole(value)?);
        Some(())
    }),
    row!(
        "/agent_params/supersampling",
        Integer,
        agent_params.supersampling,
        whole
    ),
    row!("/agent_params/coordinates", Point, agent_params.coordinates, point),
    row!("/agent_params/coordinates/*", Number, agent_params.coordinates[], number),
    row!("/agent_params/heading", Heading, agent_params.heading, number),
    row!("/agent_params/time_step", Number, agent_params.time_step, number),
    row!("/agent_params/frame_skip", Integer, agent_params.frame_skip, whole),
    row!("/agent_params/interact", Boolean, agent_params.interact, truth),
    row!(
        "/agent_params/field_of_view",
        Number,
        agent_params.field_of_view,
        number
    ),
    row!("/agent_params/modalities/*", String, agent_params.modalities[], word::<Modality>),
    row!("/rules/step_reward", Number, rules.step_reward, number),
    row!("/rules/reward_per_second", Number, rules.reward_per_second, number),
    row!("/rules/order_penalty", Number, rules.order_penalty, number),
    slot("/rules/shaping/scale", Number, |world, _, value| {
        world.rules.shaping.as_mut()?.scale = number(value)?;
        Some(())
    }),
    slot("/rules/shaping/discount", Number, |world, _, value| {
        world.rules.shaping.as_mut()?.discount = number(value)?;
        Some(())
    }),
];

/// Where an object's template may vary.
pub(crate) const OBJECT: &[Slot<Object>] = &[
    row!("/class", String, class, text),
    slot("/model", String, |object, _, value| {
        object.model = Model(text(value)?);
        Some(())
    }),
    row!("/coordinates", Point, coordinates, point),
    row!("/coordinates/*", Number, coordinates[], number),
    row!("/heading", Heading, heading, number),
    row!("/scale", Number, scale, number),
    slot("/color", Color, |object, _, value| {
        object.color = Some(color(value)?);
        Some(())
    }),
    row!("/solid", Boolean, solid, truth),
    slot("/pushable/mass", Number, |object, _, value| {
        object.pushable.as_mut()?.mass = number(value)?;
        Some(())
    }),
    slot("/pushable/friction", Number, |object, _, value| {
        object.pushable.as_mut()?.friction = number(value)?;
        Some(())
    }),
    row!("/reward", Number, reward, number),
    row!("/reward_probability", Number, reward_probability, number),
    row!("/reward_stimulus/*", String, reward_stimulus[], word::<Stimulus>),
    row!("/reward_once_stimulus/*", String, reward_once_stimulus[], word::<Stimulus>),
    row!("/destroy_stimulus/*", String, destroy_stimulus[], word::<Stimulus>),
    row!("/range_stimulus_distance", Number, range_stimulus_distance, number),
    row!("/motion_model", String, motion_model, word::<MotionModel>),
    row!("/speed", Number, speed, number),
    slot("/turn_rate", Number, |object, _, value| {
        object.turn_rate = Some(number(value)?);
        Some(())
    }),
    slot("/sight_range", Number, |object, _, value| {
        object.sight_range = Some(number(value)?);
        Some(())
    }),
];

fn number(value: &Value) -> Option<f64> {
    value.as_number()
}

fn whole<T: TryFrom<i64>>(value: &Value) -> Option<T> {
    value.as_integer().and_then(|whole| T::try_from(whole).ok())
}

fn truth(value: &Value) -> Option<bool> {
    if let Value::Boolean(truth) = value {
        Some(*truth)
    } else {
        None
    }
}

fn point(value: &Value) -> Option<[f64; 2]> {
    if let Value::Point(point) = value {
        Some(*point)
    } else {
        None
    }
}

fn triple(value: &Value) -> Option<[f64; 3]> {
    // A direction of no length is none.
    value
        .as_vector()?
        .try_into()
        .ok()
        .filter(|numbers: &[f64; 3]| *numbers != [0.0; 3])
}

fn text(value: &Value) -> Option<std::string::String> {
    match value {
        Value::Text(text) if (1..=100).contains(&text.chars().count()) => Some(text.clone()),
        _ => None,
    }
}

fn color(value: &Value) -> Option<crate::Color> {
    match value.cast(Color)? {
        Value::Color(color) => Some(color),
        _ => None,
    }
}

fn word<T: serde::de::DeserializeOwned>(value: &Value) -> Option<T> {
    serde_json::from_value(value.to_json()).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Serialize;

    fn example(kind: ParameterType, pointer: &str) -> Value {
        match (kind, pointer) {
            (Number | Heading, _) => Value::Number(0.625),
            (Vector, _) => Value::Vector(vec![0.5, 0.25, 2.0]),
            (Integer, _) => Value::Integer(3),
            (Boolean, _) => Value::Boolean(false),
            (Point, _) => Value::Point([7.0, 9.0]),
            (ParameterType::Distribution, _) => unreachable!("no place in a world holds a distribution"),
            (Color, _) => Value::Color(crate::Color([0.125, 0.25, 0.5])),
            (String, "/agent_params/action_model") => Value::Text("onrails".into()),
            (String, "/agent_params/modalities/*") => Value::Text("segmentation".into()),
            (String, "/motion_model") => Value::Text("prey".into()),
            (String, pointer) if pointer.ends_with("stimulus/*") => Value::Text("AgentInRange".into()),
            (String, _) => Value::Text("word".into()),
        }
    }

    fn check<T: Clone + Serialize>(table: &[Slot<T>], blank: &T) {
        for slot in table {
            let mut filled = blank.clone();
            let value = example(slot.kind, slot.pointer);
            (slot.set)(&mut filled, 1, &value).unwrap_or_else(|| panic!("{} took no value", slot.pointer));
            let mut expected = serde_json::to_value(blank).unwrap();
            let place = slot.pointer.replace('*', "1");
            let (parent, key) = place.rsplit_once('/').unwrap();
            let parent = expected.pointer_mut(parent).unwrap();
            match parent {
                serde_json::Value::Array(list) => list[1] = value.to_json(),
                other => other[key] = value.to_json(),
            }
            assert_eq!(
                serde_json::to_value(&filled).unwrap(),
                expected,
                "{} sets its own place and no other",
                slot.pointer
            );
        }
    }

    #[test]
    fn every_slot_sets_the_place_that_its_pointer_names_and_no_other() {
        let mut world = World::default();
        world.rules.shaping = Some(crate::Shaping {
            toward: Some("goal".into()),
            scale: 1.0,
            discount: 1.0,
        });
        check(WORLD, &world);
        let mut object = Object::new("cube", [1.0, 2.0]);
        object.reward_stimulus = vec![Stimulus::AgentCollide; 2];
        object.reward_once_stimulus = vec![Stimulus::AgentCollide; 2];
        object.destroy_stimulus = vec![Stimulus::AgentCollide; 2];
        object.pushable = Some(crate::Pushable {
            mass: 1.0,
            friction: 1.0,
        });
        object.reward_probability = 0.5;
        object.range_stimulus_distance = 1.0;
        object.speed = 1.0;
        object.turn_rate = Some(1.0);
        object.sight_range = Some(1.0);
        check(OBJECT, &object);
    }

    #[test]
    fn a_pointer_finds_its_slot_also_inside_a_list() {
        let (slot, index) = Slot::find(OBJECT, "/coordinates/1").unwrap();
        assert_eq!((slot.pointer, index), ("/coordinates/*", 1));
        assert!(Slot::find(OBJECT, "/color/1").is_none());
        assert!(Slot::find(WORLD, "/max_steps").is_some());
    }
}
