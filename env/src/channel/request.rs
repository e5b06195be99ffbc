//! Parses the payloads of requests: objects, parts to observe, screenshots, categories.

use driftworld_spec::Object;
use serde_json::Value;

use super::category::Category;
use super::message::{Message, Refusal, kind, unknown};
use crate::{EnvError, Environment};

/// The parts of a world that a client can observe.
pub(super) const PARTS: [&str; 4] = ["agent_params", "environment_params", "objects", "game_mode"];

/// Maximum width and height of a screenshot in pixels.
const MAX_SIDE: u32 = 4096;

/// A request for a colour image of what the agent sees now.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Screenshot {
    /// The requested file name; the caller decides whether and where such a file may be written.
    pub filename: String,
    /// Width in pixels, at most 4096.
    pub width: u32,
    /// Height in pixels, at most 4096.
    pub height: u32,
    /// The token of the request.
    pub(super) token: Option<String>,
}

/// A warning without its position, which would refer to our own copy of the text.
pub(super) fn remark_of(warning: &driftworld_spec::Warning) -> String {
    format!("({}): {}", warning.pointer, warning.text)
}

/// Adds an object to the world; returns its index and remarks on it.
pub(super) fn create(environment: &mut Environment, message: &Message) -> Result<(usize, Vec<String>), Refusal> {
    let payload = message.payload("an object as in L2Explorer's reset files")?;
    let (mut object, warnings) =
        Object::from_l2explorer("payload", &payload.to_string()).map_err(|error| Refusal::of_document(&error))?;
    match message.all.get("unique_name") {
        None | Some(Value::Null) => {}
        Some(Value::String(name)) => object.unique_name = Some(name.clone()),
        Some(other) => {
            return Err(Refusal::new(format!(
                "unique_name: found {}, expected a string",
                kind(other)
            )));
        }
    }
    let index = environment.spawn(object).map_err(|error| match &error {
        EnvError::BadObject { problem } => Refusal::of_document(problem),
        other => Refusal::new(other.to_string()),
    })?;
    let own = environment
        .warnings_of(index)
        .into_iter()
        .map(|warning| warning.to_string());
    Ok((index, warnings.iter().map(remark_of).chain(own).collect()))
}

/// The parts that `set_active_observers` names, in its payload or as a key of the message itself.
pub(super) fn parts(message: &Message) -> Result<Vec<&'static str>, Refusal> {
    let own = message.payload.as_ref().and_then(|payload| payload.get("state"));
    let beside = own.or(message.all.get("state"));
    let Some(list) = beside.or(message.payload.as_ref().filter(|payload| payload.is_array())) else {
        return Err(Refusal::new(
            "payload: found no state, expected a list of parts of the world",
        ));
    };
    let Value::Array(names) = list else {
        return Err(Refusal::new(format!("state: found {}, expected a list", kind(list))));
    };
    let part = |name: &Value| {
        let Some(name) = name.as_str() else {
            return Err(Refusal::new(format!("state: found {}, expected strings", kind(name))));
        };
        let known = PARTS.into_iter().find(|part| part.eq_ignore_ascii_case(name));
        known.ok_or_else(|| unknown("state", name, &PARTS))
    };
    let mut found = names.iter().map(part).collect::<Result<Vec<_>, _>>()?;
    found.sort_unstable();
    found.dedup();
    Ok(found)
}

pub(super) fn screenshot(environment: &Environment, message: &Message) -> Result<Screenshot, Refusal> {
    let payload = message.payload("a filename")?;
    let Some(filename) = payload.get("filename").and_then(Value::as_str) else {
        return Err(Refusal::new(
            "payload/filename: found no string, expected the name of a PNG file",
        ));
    };
    let [width, height] = environment.world().agent_params.picture_size();
    let most = MAX_SIDE / width.max(height);
    let factor = match payload.get("upscale_factor") {
        None | Some(Value::Null) => 1.0,
        Some(factor) => factor.as_f64().unwrap_or(f64::NAN),
    };
    if factor.fract() != 0.0 || !(1.0..=f64::from(most)).contains(&factor) {
        return Err(Refusal::new(format!(
            "payload/upscale_factor: expected a whole number from 1 to {most}, so that no side is longer than {MAX_SIDE} pixels"
        )));
    }
    let factor = factor as u32;
    Ok(Screenshot {
        filename: filename.to_owned(),
        width: width * factor,
        height: height * factor,
        token: None,
    })
}

/// The settings of `set_debug_categories`; if one entry is invalid, all of them are refused.
pub(super) fn categories(message: &Message) -> Result<Vec<(Category, bool)>, Refusal> {
    let payload = message.payload("a list of {category, active}")?;
    let list = match payload {
        Value::Array(list) => list.as_slice(),
        single @ Value::Object(_) => std::slice::from_ref(single),
        other => {
            return Err(Refusal::new(format!(
                "payload: found {}, expected a list of {{category, active}}",
                kind(other)
            )));
        }
    };
    let one = |entry: &Value| {
        let (name, active) = (entry.get("category").and_then(Value::as_str), entry.get("active"));
        let (Some(name), Some(Value::Bool(active))) = (name, active) else {
            return Err(Refusal::new(
                "payload: expected entries such as {\"category\": \"agent\", \"active\": true}",
            ));
        };
        let category = name
            .parse()
            .map_err(|_| unknown("category", name, &Category::names()))?;
        Ok((category, *active))
    };
    list.iter().map(one).collect()
}
