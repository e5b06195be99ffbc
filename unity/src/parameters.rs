//! [`Parameters`]: numbers that clients set by name. They override the settings of each world when it is reset.

use std::collections::BTreeMap;

use driftworld_spec::{World, WorldDraft, nearest};

use crate::side_channel::Setting;

/// Known parameters: settings that L2Explorer's reset files lack, or that a client may want to set independently of those files.
const KNOWN: [&str; 8] = [
    "time_step",
    "frame_skip",
    "max_steps",
    "field_of_view",
    "supersampling",
    "light_intensity",
    "max_linear_speed",
    "max_angular_speed",
];

/// The integer parameters, with the minimum of each.
const INTEGERS: [(&str, u32); 3] = [("frame_skip", 1), ("max_steps", 0), ("supersampling", 1)];

/// The parameters that are set.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Parameters(BTreeMap<&'static str, f64>);

impl Parameters {
    /// Sets a parameter, with effect from the next reset.
    ///
    /// # Errors
    /// The reason why it is unknown or invalid; the previous value stays.
    pub(crate) fn set(&mut self, setting: &Setting) -> Result<(), String> {
        let Setting { key, value } = setting;
        let Some(known) = KNOWN.into_iter().find(|known| known.eq_ignore_ascii_case(key)) else {
            let near = nearest(key, KNOWN).map_or_else(String::new, |near| format!("; did you mean {near:?}?"));
            return Err(format!("{key:?} = {value}: ignored, it has no meaning here{near}"));
        };
        // Converts through decimal digits, so that the f32 0.1 becomes the f64 0.1.
        let number = value.to_string().parse().unwrap_or(f64::NAN);
        check(known, number).map_err(|expected| format!("{known} = {value}: ignored, expected {expected}"))?;
        self.0.insert(known, number);
        Ok(())
    }

    /// Whether a name is known.
    pub(crate) fn knows(key: &str) -> bool {
        KNOWN.iter().any(|known| known.eq_ignore_ascii_case(key))
    }

    /// Applies the parameters to a world.
    pub(crate) fn apply(&self, world: &mut WorldDraft) {
        for (key, number) in &self.0 {
            let agent = &mut world.agent_params;
            match *key {
                "time_step" => agent.time_step = *number,
                "frame_skip" => agent.frame_skip = *number as u32,
                "max_steps" => world.limit_steps(*number as u32),
                "field_of_view" => agent.field_of_view = *number,
                "supersampling" => agent.supersampling = *number as u32,
                "light_intensity" => world.environment_params.light_intensity = *number,
                "max_linear_speed" => agent.max_linear_speed = *number,
                "max_angular_speed" => agent.max_angular_speed = *number,
                other => unreachable!("{other} is not a known parameter"),
            }
        }
    }

    /// Whether no parameter is set.
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Applies the parameters to a world; returns the problem if the result is invalid.
    pub(crate) fn try_world(&self, world: World) -> Result<World, String> {
        world.edit(|world| self.apply(world)).map_err(|error| {
            let first = error.problems().first();
            first.map_or_else(
                || error.to_string(),
                |problem| format!("found {}, expected {}", problem.found, problem.expected),
            )
        })
    }
}

/// Checks a number as in a document; the error states what was expected.
fn check(known: &'static str, number: f64) -> Result<(), String> {
    let min = INTEGERS.iter().find(|(key, _)| *key == known).map(|(_, min)| *min);
    match min {
        None if !number.is_finite() => return Err("a number".to_owned()),
        // Checked before the conversion to an integer, which would truncate the number.
        Some(min) if number.fract() != 0.0 || number < f64::from(min) => {
            return Err(format!("a whole number from {min}"));
        }
        _ => {}
    }
    let parameters = Parameters(BTreeMap::from([(known, number)]));
    let world = World::default().edit(|world| parameters.apply(world));
    world.map(drop).map_err(|error| {
        let first = error.problems().first();
        first.map_or_else(|| error.to_string(), |problem| problem.expected.clone())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(parameters: &mut Parameters, key: &str, value: f32) -> Result<(), String> {
        let key = key.to_owned();
        parameters.set(&Setting { key, value })
    }

    #[test]
    fn every_known_parameter_changes_the_world() {
        for key in KNOWN {
            let mut parameters = Parameters::default();
            let value = if key == "max_steps" { 7.0 } else { 3.0 };
            set(&mut parameters, key, value).expect("the value is in range");
            let mut world = WorldDraft::default();
            parameters.apply(&mut world);
            assert_ne!(world, WorldDraft::default(), "{key}");
            let changed = world.check().expect("the world is valid").to_json();
            assert!(changed.contains(&format!("\"{key}\":{value}")), "{key}: {changed}");
        }
    }

    #[test]
    fn numbers_keep_their_decimal_digits() {
        let mut parameters = Parameters::default();
        set(&mut parameters, "Time_Step", 0.1).expect("upper and lower case are equivalent in names");
        let mut world = WorldDraft::default();
        parameters.apply(&mut world);
        assert_eq!(world.agent_params.time_step, 0.1);
    }

    #[test]
    fn invalid_values_are_ignored_with_a_reason() {
        let mut parameters = Parameters::default();
        set(&mut parameters, "frame_skip", 4.0).expect("4 is valid");
        let before = parameters.clone();
        for row in r#"
frame_skip 0 => frame_skip = 0: ignored, expected a whole number from 1
frame_skip 2.5 => expected a whole number from 1
frame_skip 1e10 => frame_skip = 10000000000: ignored, expected at most 1000
max_steps -1 => max_steps = -1: ignored, expected a whole number from 0
max_steps NaN => max_steps = NaN: ignored, expected a whole number from 0
max_steps inf => max_steps = inf: ignored, expected a whole number from 0
max_steps 1e10 => max_steps = 10000000000: ignored, expected at most 1000000000
field_of_view NaN => expected a number
field_of_view 500 => 170
feld_of_view 50 => did you mean "field_of_view"?
gravity 9.8 => it has no meaning here"#
            .trim()
            .lines()
        {
            let (setting, expected) = row.split_once(" => ").expect("a row has two parts");
            let (key, value) = setting.split_once(' ').expect("a setting has a value");
            let value = value.parse().expect("the value is a number");
            let reason = set(&mut parameters, key, value).expect_err("the setting is invalid");
            assert!(reason.contains(expected), "{reason}");
        }
        assert_eq!(parameters, before);
    }
}
