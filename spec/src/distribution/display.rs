//! Formats distributions for people to read: `normal(mean 2, std spread)`. Documents use JSON.

use std::fmt::{Display, Formatter, Result};

use serde::Serialize;
use serde_json::Value as Json;

use super::{Channel, Distribution};
use crate::describe::plain_number;

impl<N: Channel + Serialize> Display for Distribution<N> {
    fn fmt(&self, f: &mut Formatter) -> Result {
        let json = serde_json::to_value(self).unwrap_or_default();
        f.write_str(&text_of(&json))
    }
}

/// `name(key value, key value)` for a distribution, the plain value for anything else.
fn text_of(json: &Json) -> String {
    match json {
        Json::Object(map) if map.contains_key("param") => {
            let index = map.get("index").map_or_else(String::new, |index| format!("[{index}]"));
            format!("{}{index}", map["param"].as_str().unwrap_or_default())
        }
        // A plain JSON object, such as a value of a choice.
        Json::Object(map) if map.len() != 1 || !map.values().all(Json::is_object) => json.to_string(),
        Json::Object(map) => {
            let forms = map.iter().map(|(name, fields)| {
                let fields = fields.as_object().into_iter().flatten();
                let fields: Vec<String> = fields.map(|(key, value)| format!("{key} {}", text_of(value))).collect();
                format!("{name}({})", fields.join(", "))
            });
            forms.collect::<Vec<_>>().join(", ")
        }
        Json::Array(items) => format!("[{}]", items.iter().map(text_of).collect::<Vec<_>>().join(", ")),
        Json::Number(number) => number.as_f64().map_or_else(|| number.to_string(), plain_number),
        Json::String(text) => text.clone(),
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distribution::Number;

    #[test]
    fn distribution_displays_as_a_call() {
        let text = r#"{ "gaussian": { "mean": [0, 0], "std": { "param": "spread" }, "correlation": 0.5 } }"#;
        let distribution: Distribution<Number> = serde_json::from_str(text).unwrap();
        assert_eq!(
            distribution.to_string(),
            "gaussian(mean [0, 0], std spread, correlation 0.5)"
        );
        let text = r#"{ "choice": { "values": [null, [], { "delay": 5, "radius": 0.5 }, { "touch": "goal" }] } }"#;
        let distribution: Distribution<Number> = serde_json::from_str(text).unwrap();
        assert_eq!(
            distribution.to_string(),
            r#"choice(values [null, [], {"delay":5,"radius":0.5}, {"touch":"goal"}])"#
        );
    }
}
