//! An episode as a few frames: chooses the steps, their captions, and their pictures.

use std::convert::Infallible;

use driftworld_env::{
    Agent, Catalogue, Effect, EndedBy, Environment, Event, Recorder, Recording, Renderer, Replay, Step,
    top_down_with_way,
};
use driftworld_report::picture::{Picture, SheetRow};
use driftworld_spec::{Modality, Object, Stimulus, World};
use driftworld_text::{amount, whole};

use crate::Failure;
use crate::film::{FilmModality, FilmOptions, FilmView};
use crate::modality::{number_color, to_rgb};

/// The events of one step as text, and their importance: 0 if there are none.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Deed {
    pub(crate) words: Vec<String>,
    weight: u8,
}

/// Records an agent's episode in a world, to its end or a step limit.
pub(crate) fn recorded(
    world: &World,
    catalogue: &Catalogue,
    agent: &mut dyn Agent,
    seed: u64,
    most: u32,
) -> Result<Recording, Failure> {
    let mut environment = Environment::with_catalogue(world.clone(), catalogue.clone());
    let mut recorder = Recorder::default();
    recorder.begin(world.clone());
    agent.begin(seed);
    let mut ended_by = None;
    while !environment.ended() && recorder.num_steps() < most {
        let action = agent.act(&environment);
        ended_by = environment.step(action)?.ended_by;
        recorder.step(action);
    }
    Ok(recorder.recording(&environment, ended_by))
}

/// A recorded episode as rows of a sheet: the agent's view, the map with the path since the previous row, or both. At
/// an event, the view shows what the agent saw when it acted, and the map shows the result.
///
/// Contains the start, the end, and as many events as fit into `most` rows; if there are few, also steps between them.
pub(crate) fn rows(
    recording: &Recording,
    catalogue: &Catalogue,
    options: &FilmOptions,
    most: usize,
) -> Result<Vec<SheetRow>, Failure> {
    let mut replay = Replay::new(recording, catalogue);
    replay.environment().set_renderer(Renderer::new(options.renderer)?);
    let mut deeds = vec![Deed::default()];
    let mut last = None;
    while let Some(step) = replay.step()? {
        deeds.push(deed(replay.environment().world(), &step));
        last = Some(step);
    }
    // Replays the episode, bit for bit, to draw the chosen steps.
    replay.restart();
    let (mut rows, mut way, mut taken) = (Vec::new(), vec![replay.environment().agent().position], 0);
    for number in chosen(&deeds, most) {
        let mut seen = None;
        while taken < number {
            if taken + 1 == number && deeds[number].weight > 0 && options.view != FilmView::Above {
                seen = Some(seen_by(replay.environment(), options)?);
            }
            replay.step()?;
            way.push(replay.environment().agent().position);
            taken += 1;
        }
        let environment = replay.environment();
        let end = last.as_ref().filter(|_| number + 1 == deeds.len());
        let (title, words) = if options.captions {
            (title(number, &deeds[number]), words(environment, end))
        } else {
            (title(number, &Deed::default()), String::new())
        };
        let pictures = options.pictures(environment, &way, &mut |environment| {
            seen.take().map_or_else(|| seen_by(environment, options), Ok)
        })?;
        rows.push(SheetRow::new(
            title,
            words,
            pictures.into_iter().map(Into::into).collect(),
        ));
        way.drain(..way.len() - 1);
    }
    Ok(rows)
}

/// The chosen steps: the first, the last, the most important ones, then the middles of the longest gaps.
fn chosen(deeds: &[Deed], most: usize) -> Vec<usize> {
    let last = deeds.len() - 1;
    if last == 0 {
        return vec![0];
    }
    let mut shown = vec![0, last];
    let mut done: Vec<usize> = (1..last).filter(|number| deeds[*number].weight > 0).collect();
    done.sort_by_key(|number| std::cmp::Reverse(deeds[*number].weight));
    shown.extend(done.into_iter().take(most.saturating_sub(2)));
    shown.sort_unstable();
    shown.dedup();
    while shown.len() < most {
        let gaps = shown.windows(2).enumerate();
        let Some((place, gap)) = gaps.max_by_key(|(place, pair)| (pair[1] - pair[0], usize::MAX - place)) else {
            break;
        };
        if gap[1] - gap[0] < 2 {
            break;
        }
        shown.insert(place + 1, usize::midpoint(gap[0], gap[1]));
    }
    shown
}

/// The events of a step.
pub(crate) fn deed(world: &World, step: &Step) -> Deed {
    let mut deed = Deed::default();
    for event in &step.events {
        let own = match event.effect {
            Some(Effect::Closed) => 2,
            Some(_) => 3,
            None if event.destroyed || event.reward != 0.0 => 1,
            None => continue,
        };
        deed.weight = deed.weight.max(own);
        deed.words.push(said(world, event));
    }
    deed
}

/// An event as text, such as "opens the door".
fn said(world: &World, event: &Event) -> String {
    let class = world.objects.get(event.object).map_or("object", |object| &object.class);
    let what = match event.effect {
        Some(Effect::Opened) => format!("opens the {class}"),
        Some(Effect::Closed) => format!("closes the {class}"),
        Some(Effect::Switched) => format!("sets off the {class}"),
        Some(Effect::PickedUp) => format!("picks up the {class}"),
        Some(Effect::PutDown) => format!("puts down the {class}"),
        None => {
            // A tag says what an object is for, which is better than the name of a plain shape.
            let name = event.tag.as_deref().unwrap_or(class);
            let alike = |other: &&Object| match &event.tag {
                Some(tag) => other.tag.as_deref() == Some(&**tag),
                None => other.tag.is_none() && other.class == *class,
            };
            let what = one_of(name, world.objects.iter().filter(alike).count());
            match event.stimulus {
                Stimulus::AgentCollide => format!("touches {what}"),
                Stimulus::AgentInteract => format!("uses {what}"),
                Stimulus::AgentInRange => format!("comes near {what}"),
            }
        }
    };
    if event.reward == 0.0 {
        what
    } else {
        format!("{what}: {}", number(event.reward, "+"))
    }
}

/// Names one thing out of `count`: groups may be named in the plural, as "targets", or in the singular.
fn one_of(name: &str, count: usize) -> String {
    match (count, name.ends_with('s'), name.starts_with(['a', 'e', 'i', 'o', 'u'])) {
        (0 | 1, ..) => format!("the {name}"),
        (_, true, _) => format!("one of the {name}"),
        (_, false, true) => format!("an {name}"),
        (_, false, false) => format!("a {name}"),
    }
}

fn title(step: usize, deed: &Deed) -> String {
    match (step, &deed.words[..]) {
        (0, _) => "Start".to_owned(),
        (_, []) => format!("Step {step}"),
        (_, [one]) => format!("Step {step}: {one}"),
        (_, [first, rest @ ..]) => format!("Step {step}: {first}, and {} more", rest.len()),
    }
}

/// A number with its sign and one decimal, so that its width stays constant; small numbers with the decimals needed.
pub(crate) fn number(value: f64, plus: &str) -> String {
    let size = amount(value.abs());
    let text = match value.abs() {
        _ if size == "0" => return "0.0".to_owned(),
        small if small < 0.05 => size,
        size => format!("{size:.1}"),
    };
    format!("{}{text}", if value < 0.0 { "−" } else { plus })
}

/// The [`facts`] as one text whose lines do not break inside a fact.
pub(crate) fn words(environment: &Environment, end: Option<&Step>) -> String {
    let facts: Vec<String> = facts(environment, end).iter().map(|fact| whole(fact)).collect();
    // Lines may break after the dot.
    facts.join("\u{a0}· ")
}

/// The time, the return, the remaining energy, the agent's zones, carried objects, and why the episode ended.
pub(crate) fn facts(environment: &Environment, end: Option<&Step>) -> Vec<String> {
    let mut parts = vec![
        format!("{:.1} s", environment.seconds()),
        format!("return {}", number(environment.episode_return(), "")),
    ];
    if let Some(energy) = environment.energy() {
        parts.push(format!("energy {energy:.0}"));
    }
    let here = environment.agent().position.map(f64::from);
    let zones = environment.world().environment_params.zones.iter().enumerate();
    let names: Vec<String> = zones
        .filter(|(_, zone)| zone.contains(here))
        .map(|(number, zone)| zone.name.clone().unwrap_or_else(|| format!("zone {number}")))
        .collect();
    if !names.is_empty() {
        parts.push(format!("in {}", names.join(", ")));
    }
    let objects = environment.world().objects.iter().zip(environment.objects());
    let carried: Vec<&str> = objects
        .filter(|(_, own)| own.carried)
        .map(|(object, _)| object.class.as_str())
        .collect();
    if !carried.is_empty() {
        parts.push(format!("carries: {}", carried.join(", ")));
    }
    if let Some(step) = end {
        let word = step.ended_by.map(EndedBy::word);
        parts.push(match word.map(|word| word.replace('_', " ")) {
            Some(word) => format!("ended by {word}{}", if step.success { ", success" } else { "" }),
            None => "has no end".to_owned(),
        });
    }
    parts
}

/// The agent's view: in colours with smooth edges, otherwise pixel by pixel.
pub(crate) fn seen_by(environment: &mut Environment, options: &FilmOptions) -> Result<Picture, Failure> {
    let size = options.size;
    let kind = match options.modality {
        FilmModality::Rgb => {
            return Picture::smooth([size; 2], |[width, height]| {
                Ok(environment.observe_at(width, height)?.rgb)
            });
        }
        FilmModality::Segmentation => Modality::Segmentation,
        FilmModality::Depth => Modality::Depth,
    };
    let frame = environment.observe_at(size, size)?;
    Ok(Picture::new(size, size, to_rgb(kind, &frame, number_color)))
}

/// The map with the agent, and its path.
pub(crate) fn map_of(environment: &Environment, size: [u32; 2], way: &[[f32; 2]]) -> Picture {
    let agent = environment.agent();
    let agent = Some((agent.position, agent.heading_deg));
    let Ok(picture) = Picture::smooth(size, |[width, height]| {
        Ok::<_, Infallible>(top_down_with_way(environment.scene(), width, height, agent, way).rgb)
    });
    picture
}

#[cfg(test)]
mod tests {
    use driftworld_env::StillAgent;
    use driftworld_spec::{Energy, WorldDraft, Zone};
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn numbers_have_a_sign_and_the_decimals_needed() {
        for (value, expected) in [
            (100.729_999_999_999_99, "+100.7"),
            (-0.3, "−0.3"),
            (0.0, "0.0"),
            (-0.0, "0.0"),
            (1e-12, "0.0"),
            (-0.001, "−0.001"),
            (0.049, "+0.049"),
            (0.05, "+0.1"),
            (-1e6, "−1000000.0"),
        ] {
            assert_eq!(number(value, "+"), expected);
        }
        assert_eq!(number(2.0, ""), "2.0");
    }

    #[test]
    fn one_of_several_things_has_no_definite_article() {
        for (name, count, said) in [
            ("targets", 5, "one of the targets"),
            ("targets", 1, "the targets"),
            ("fruit", 10, "a fruit"),
            ("animal", 2, "an animal"),
            ("goal", 1, "the goal"),
        ] {
            assert_eq!(one_of(name, count), said);
        }
    }

    /// The caption names the agent's zone and its remaining energy; without an energy limit it shows no energy.
    #[test]
    fn captions_show_zones_and_remaining_energy() {
        let mut draft = WorldDraft::default();
        draft.agent_params.energy = Some(Energy {
            start: 30.0,
            per_second: -10.0,
            ..Energy::default()
        });
        let mut pond = Zone::disc([0.0, 0.0], 2.0);
        pond.name = Some("pond".to_owned());
        draft.environment_params.zones = vec![pond, Zone::disc([20.0, 0.0], 1.0)];
        let world = draft.check().expect("the world is sound");
        let mut environment = Environment::new(world.clone());
        let said = |environment: &Environment| words(environment, None).replace('\u{a0}', " ");
        assert_eq!(said(&environment), "0.0 s · return 0.0 · energy 30 · in pond");
        assert!(words(&environment, None).starts_with(&format!("{}\u{a0}· ", whole("0.0 s"))));
        while environment.seconds() < 0.95 {
            environment.step(StillAgent.act(&environment)).expect("it steps");
        }
        assert!(
            said(&environment).ends_with("· energy 20 · in pond"),
            "{}",
            said(&environment)
        );
        let elsewhere = world.edit(|draft| {
            draft.agent_params.coordinates = [9.0, 9.0];
            draft.agent_params.energy = None;
        });
        let environment = Environment::new(elsewhere.expect("the world is sound"));
        assert_eq!(said(&environment), "0.0 s · return 0.0");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        /// The frames are ascending, include the start and the end, are as many as requested if there are enough steps, and
        /// omit nothing more important than what they show.
        #[test]
        fn frames_show_the_most_important_steps(weights in prop::collection::vec(0u8..4, 1..200), most in 2usize..30) {
            let deeds: Vec<Deed> = weights.iter().map(|weight| Deed { words: Vec::new(), weight: *weight }).collect();
            let shown = chosen(&deeds, most);
            prop_assert!(shown.is_sorted_by(|a, b| a < b));
            prop_assert_eq!((shown[0], *shown.last().expect("there is one")), (0, deeds.len() - 1));
            prop_assert_eq!(shown.len(), most.min(deeds.len()));
            let inner = || 1..deeds.len().saturating_sub(1);
            let least = inner().filter(|number| shown.contains(number)).map(|number| weights[number]).min();
            let left_out = inner().filter(|number| !shown.contains(number)).map(|number| weights[number]).max();
            if let (Some(least), Some(left_out)) = (least, left_out) {
                prop_assert!(left_out <= least || left_out == 0, "{left_out} is left out, {least} is shown");
            }
        }
    }
}
