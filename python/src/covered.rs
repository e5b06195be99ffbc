//! Detects options of environments that hide a difference between variants: options that override a key in which they differ,
//! or leave out the only images that show it. With such an option the variants would be the same.

use std::collections::BTreeMap;

use driftworld_curriculum::Plan;
use driftworld_generator::Sampler;
use driftworld_spec::{DEFAULT_VARIANT, EnvironmentParams, Modality, Resolved, Value, Variant, World, WorldDraft};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde_json::{Value as Json, json};

use crate::errors::Result;
use crate::supply::overrides_of;
use crate::variant::PyVariant;

/// An option: its name, the keys of a world that it overrides, and how to read them from a world.
struct EnvOption {
    name: &'static str,
    keys: &'static [&'static str],
    /// Whether it may make worlds of different tasks alike, so that one learner can run through them.
    joins_tasks: bool,
    read: fn(&WorldDraft) -> Json,
}

const OPTIONS: [EnvOption; 7] = [
    EnvOption {
        name: "modalities",
        keys: &["/agent_params/modalities"],
        joins_tasks: false,
        read: |world| json!(world.agent_params.modalities),
    },
    EnvOption {
        name: "size",
        keys: &["/agent_params/observation_size", "/agent_params/observation_width"],
        joins_tasks: true,
        read: |world| {
            let agent = &world.agent_params;
            let height = agent.observation_size;
            json!([height, agent.observation_width.unwrap_or(height)])
        },
    },
    EnvOption {
        name: "actions",
        keys: &["/agent_params/actions"],
        joins_tasks: false,
        read: |world| json!(world.agent_params.actions),
    },
    EnvOption {
        name: "interact",
        keys: &["/agent_params/interact"],
        joins_tasks: false,
        read: |world| json!(world.agent_params.interact),
    },
    EnvOption {
        name: "frame_skip",
        keys: &["/agent_params/frame_skip"],
        joins_tasks: false,
        read: |world| json!(world.agent_params.frame_skip.max(1)),
    },
    EnvOption {
        name: "supersampling",
        keys: &["/agent_params/supersampling"],
        joins_tasks: false,
        read: |world| json!(world.agent_params.supersampling),
    },
    EnvOption {
        name: "max_steps",
        keys: &["/max_steps", "/max_seconds"],
        joins_tasks: true,
        read: |world| json!({ "max_steps": world.max_steps, "max_seconds": world.max_seconds }),
    },
];

/// The values of a variant's worlds for the keys of all options, and the pointers of values drawn for each world.
struct Said {
    name: String,
    task: String,
    values: WorldDraft,
    drawn: Vec<String>,
    /// The values of the task's default variant.
    usual: Option<WorldDraft>,
    variant: Option<Variant>,
}

impl Said {
    fn of_variant(variant: &Variant, max_steps: Option<u32>) -> Self {
        let (values, drawn) = said(variant, max_steps);
        let usual = variant.task().variant(DEFAULT_VARIANT).ok();
        Self {
            name: variant.id(),
            task: variant.task().name().to_owned(),
            values,
            drawn,
            usual: usual.map(|usual| said(&usual, max_steps).0),
            variant: Some(variant.clone()),
        }
    }

    fn of_world(name: &str, world: &World, max_steps: Option<u32>) -> Self {
        let mut values = world.clone().into_draft();
        if let Some(max_steps) = max_steps {
            values.limit_steps(max_steps);
        }
        Self {
            name: name.to_owned(),
            task: name.to_owned(),
            values,
            drawn: Vec::new(),
            usual: None,
            variant: None,
        }
    }
}

/// A variant's template with the variant's values for the keys of all options, and the pointers of drawn values.
fn said(variant: &Variant, max_steps: Option<u32>) -> (WorldDraft, Vec<String>) {
    let template = variant.task().world();
    let (mut values, mut drawn) = (template.base.clone(), Vec::new());
    for hole in &template.holes {
        if !OPTIONS.iter().any(|option| option.covers(&hole.pointer)) {
            continue;
        }
        match variant.resolve(&hole.source) {
            // Invalid values are refused when worlds are made.
            Resolved::Value(value) => drop(hole.fill(&mut values, &value)),
            Resolved::Draw(_) | Resolved::Randomized(_) => drawn.push(hole.pointer.clone()),
        }
    }
    if let Some(max_steps) = max_steps {
        values.limit_steps(max_steps);
        drawn.retain(|pointer| !pointer.starts_with("/max_"));
    }
    (values, drawn)
}

impl EnvOption {
    fn covers(&self, pointer: &str) -> bool {
        self.keys.iter().any(|key| pointer.starts_with(key))
    }

    /// The difference that the option hides, if any: its key, with the variants and their values without the option. `laid`
    /// applies all options to a world.
    fn taken(&self, all: &[Said], is_given: bool, laid: &dyn Fn(&WorldDraft) -> WorldDraft) -> Option<Json> {
        let keys: Vec<String> = self.keys.iter().map(|key| key[1..].replace('/', ".")).collect();
        let finding = |said: Vec<(&str, Json)>| json!({ "option": self.name, "key": keys.join(", "), "said": said });
        // Keyed by values with the options applied: the first variant with them, and its values without the options.
        let mut first: BTreeMap<(String, &str), (&str, Json)> = BTreeMap::new();
        for said in all {
            if is_given && said.drawn.iter().any(|pointer| self.covers(pointer)) {
                return Some(finding(vec![(&said.name, json!("drawn anew in each world"))]));
            }
            let (before, after) = ((self.read)(&said.values), (self.read)(&laid(&said.values)));
            let task = if self.joins_tasks { said.task.as_str() } else { "" };
            let (other, theirs) = first
                .entry((after.to_string(), task))
                .or_insert_with(|| (&said.name, before.clone()));
            if *theirs != before {
                return Some(finding(vec![(*other, theirs.clone()), (&said.name, before)]));
            }
            if let Some(usual) = &said.usual {
                let (theirs, same) = ((self.read)(usual), (self.read)(&laid(usual)));
                if after != before && theirs != before && same == after {
                    let defaults = format!("{}#{DEFAULT_VARIANT}", said.task);
                    return Some(finding(vec![(&said.name, before), (&defaults, theirs)]));
                }
            }
        }
        None
    }
}

/// Number of worlds compared before two variants count as the same.
const HIDDEN_WORLDS: u64 = 3;

/// The first two variants whose worlds differ only in colours and light, if no image shows colours. `laid` applies all options
/// to a world.
fn hidden(all: &[Said], laid: &dyn Fn(&WorldDraft) -> WorldDraft) -> Option<Json> {
    let worlds = |variant: &Variant| -> Option<Vec<WorldDraft>> {
        let sampler = Sampler::new(variant, 0);
        let drawn = (0..HIDDEN_WORLDS).map(|index| Some(laid(&sampler.world(index).ok()?.into_draft())));
        drawn.collect()
    };
    // Keyed by the worlds without colours: the first variant with them, and its worlds.
    let mut first: BTreeMap<String, (&str, &Variant, Vec<WorldDraft>)> = BTreeMap::new();
    for said in all {
        let Some(variant) = &said.variant else { continue };
        // Errors in drawing are reported when worlds are made.
        let Some(plain) = worlds(variant) else { continue };
        if plain
            .iter()
            .any(|world| world.agent_params.modalities.contains(&Modality::Rgb))
        {
            continue;
        }
        let colorless: Vec<WorldDraft> = plain.iter().cloned().map(without_colors).collect();
        let key = json!([said.task, colorless]).to_string();
        let (name, other, theirs) = first.entry(key).or_insert_with(|| (&said.name, variant, plain.clone()));
        if *theirs != plain {
            let (other, variant) = (other.as_read(), variant.as_read());
            let differs = |(name, value): &(&String, &Value)| other.value(name) != Some(*value);
            let names = variant.values().iter().filter(differs).map(|(name, _)| name.as_str());
            let names = names.collect::<Vec<_>>().join(", ");
            return Some(json!({ "option": "modalities", "hidden": names, "said": [[name, ""], [said.name, ""]] }));
        }
    }
    None
}

/// A world in which all values that only affect colours are the defaults.
fn without_colors(mut world: WorldDraft) -> WorldDraft {
    let (usual, environment) = (EnvironmentParams::default(), &mut world.environment_params);
    environment.bounding_wall_color = usual.bounding_wall_color;
    environment.light_intensity = usual.light_intensity;
    environment.light_color = usual.light_color;
    environment.ambient_light = usual.ambient_light;
    environment.sky_color = usual.sky_color;
    environment.ground_color = usual.ground_color;
    for object in &mut world.objects {
        object.color = None;
    }
    world
}

/// The differences that options hide, as a JSON list: the first one for each option.
fn taken(all: &[Said], overrides: &str, shown: Option<&str>) -> Result<String> {
    let overrides = overrides_of(overrides)?;
    let shown: Option<Vec<Modality>> = shown
        .map(serde_json::from_str)
        .transpose()
        .map_err(|error| PyValueError::new_err(format!("modalities: {error}")))?;
    let laid = |world: &WorldDraft| {
        let mut world = world.clone();
        overrides.apply(&mut world);
        if let Some(shown) = &shown {
            world
                .agent_params
                .modalities
                .retain(|modality| shown.contains(modality));
        }
        world
    };
    let given = json!(overrides);
    let is_given = |option: &str| !given[option].is_null();
    let found = OPTIONS
        .iter()
        .filter_map(|option| option.taken(all, is_given(option.name), &laid));
    let mut found: Vec<Json> = found.collect();
    if (is_given("modalities") || shown.is_some()) && !found.iter().any(|each| each["option"] == "modalities") {
        found.extend(hidden(all, &laid));
    }
    Ok(Json::from(found).to_string())
}

/// The differences between variants that options hide: a JSON list. `shown` are the modalities of observations, as a JSON list.
#[pyfunction]
pub(crate) fn covered(variants: Vec<Bound<'_, PyVariant>>, overrides: &str, shown: Option<&str>) -> Result<String> {
    let all: Vec<Said> = variants
        .iter()
        .map(|variant| Said::of_variant(&variant.get().0, None))
        .collect();
    taken(&all, overrides, shown)
}

/// Like `covered`, for all variants and worlds of a plan.
pub(crate) fn covered_in(plan: &Plan, overrides: &str, shown: Option<&str>) -> Result<String> {
    let variants = plan.variants().into_iter();
    let worlds = plan.world_files().into_iter();
    let all: Vec<Said> = variants
        .map(|(variant, limit)| Said::of_variant(variant, limit))
        .chain(worlds.map(|(name, world, limit)| Said::of_world(name, world, limit)))
        .collect();
    taken(&all, overrides, shown)
}
