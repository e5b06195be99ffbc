//! Shows an episode in a few frames: chooses the steps, and makes their captions and pictures.

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

/// The events of one step as text, with the weight of the most important one: 0 if there are none.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct StepEvents {
    pub(crate) words: Vec<String>,
    weight: u8,
}

/// Records an agent's episode in a world, to its end or a step limit.
pub(crate) fn record_episode(
    world: &World,
    catalogue: &Catalogue,
    agent: &mut dyn Agent,
    seed: u64,
    max_steps: u32,
) -> Result<Recording, Failure> {
    let mut environment = Environment::with_catalogue(world.clone(), catalogue.clone());
    let mut recorder = Recorder::default();
    recorder.begin(world.clone());
    agent.begin(seed);
    let mut ended_by = None;
    while !environment.ended() && recorder.num_steps() < max_steps {
        let action = agent.act(&environment);
        ended_by = environment.step(action)?.ended_by;
        recorder.step(action);
    }
    Ok(recorder.recording(&environment, ended_by))
}

/// A recorded episode as rows of a sheet: the agent's view, the map with the path since the previous row, or both. At
/// an event, the view shows what the agent saw when it acted, and the map shows the result.
///
/// Contains the start, the end, and the most important events that fit into `max_rows` rows. If there are few events, steps
/// between them fill the remaining rows.
pub(crate) fn rows(
    recording: &Recording,
    catalogue: &Catalogue,
    options: &FilmOptions,
    max_rows: usize,
) -> Result<Vec<SheetRow>, Failure> {
    let mut replay = Replay::new(recording, catalogue);
    replay.environment().set_renderer(Renderer::new(options.renderer)?);
    let mut events = vec![StepEvents::default()];
    let mut last = None;
    while let Some(step) = replay.step()? {
        events.push(events_of(replay.environment().world(), &step));
        last = Some(step);
    }
    // Replay the episode once more, bit for bit, to draw the chosen steps.
    replay.restart();
    let (mut rows, mut path, mut taken) = (Vec::new(), vec![replay.environment().agent().position], 0);
    for number in frame_steps(&events, max_rows) {
        let mut seen = None;
        while taken < number {
            if taken + 1 == number && events[number].weight > 0 && options.view != FilmView::Above {
                seen = Some(first_person(replay.environment(), options)?);
            }
            replay.step()?;
            path.push(replay.environment().agent().position);
            taken += 1;
        }
        let environment = replay.environment();
        let end = last.as_ref().filter(|_| number + 1 == events.len());
        let (title, words) = if options.captions {
            (title(number, &events[number]), words(environment, end))
        } else {
            (title(number, &StepEvents::default()), String::new())
        };
        let pictures = options.pictures(environment, &path, &mut |environment| {
            seen.take().map_or_else(|| first_person(environment, options), Ok)
        })?;
        rows.push(SheetRow::new(
            title,
            words,
            pictures.into_iter().map(Into::into).collect(),
        ));
        path.drain(..path.len() - 1);
    }
    Ok(rows)
}

/// Chooses the steps to show: the first, the last, those with the most important events, then the middles of the longest gaps.
fn frame_steps(events: &[StepEvents], max_rows: usize) -> Vec<usize> {
    let last = events.len() - 1;
    if last == 0 {
        return vec![0];
    }
    let mut shown = vec![0, last];
    let mut eventful: Vec<usize> = (1..last).filter(|number| events[*number].weight > 0).collect();
    eventful.sort_by_key(|number| std::cmp::Reverse(events[*number].weight));
    shown.extend(eventful.into_iter().take(max_rows.saturating_sub(2)));
    shown.sort_unstable();
    shown.dedup();
    while shown.len() < max_rows {
        let gaps = shown.windows(2).enumerate();
        let Some((index, gap)) = gaps.max_by_key(|(index, pair)| (pair[1] - pair[0], usize::MAX - index)) else {
            break;
        };
        if gap[1] - gap[0] < 2 {
            break;
        }
        shown.insert(index + 1, usize::midpoint(gap[0], gap[1]));
    }
    shown
}

/// The events of a step.
pub(crate) fn events_of(world: &World, step: &Step) -> StepEvents {
    let mut events = StepEvents::default();
    for event in &step.events {
        let weight = match event.effect {
            Some(Effect::Closed) => 2,
            Some(_) => 3,
            None if event.destroyed || event.reward != 0.0 => 1,
            None => continue,
        };
        events.weight = events.weight.max(weight);
        events.words.push(describe(world, event));
    }
    events
}

/// An event as text, such as "opens the door".
fn describe(world: &World, event: &Event) -> String {
    let class = world.objects.get(event.object).map_or("object", |object| &object.class);
    let what = match event.effect {
        Some(Effect::Opened) => format!("opens the {class}"),
        Some(Effect::Closed) => format!("closes the {class}"),
        Some(Effect::Switched) => format!("sets off the {class}"),
        Some(Effect::PickedUp) => format!("picks up the {class}"),
        Some(Effect::PutDown) => format!("puts down the {class}"),
        None => {
            // A tag says what an object is for, which tells the reader more than the name of a shape.
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

/// Refers to one of `count` things, with an article. Tags may be plural, such as "targets", or singular.
fn one_of(name: &str, count: usize) -> String {
    match (count, name.ends_with('s'), name.starts_with(['a', 'e', 'i', 'o', 'u'])) {
        (0 | 1, ..) => format!("the {name}"),
        (_, true, _) => format!("one of the {name}"),
        (_, false, true) => format!("an {name}"),
        (_, false, false) => format!("a {name}"),
    }
}

fn title(step: usize, events: &StepEvents) -> String {
    match (step, &events.words[..]) {
        (0, _) => "Start".to_owned(),
        (_, []) => format!("Step {step}"),
        (_, [one]) => format!("Step {step}: {one}"),
        (_, [first, rest @ ..]) => format!("Step {step}: {first}, and {} more", rest.len()),
    }
}

/// A number with its sign and one decimal, so that its width stays constant; small numbers get more decimals.
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
    // A line may break only after the dot.
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
pub(crate) fn first_person(environment: &mut Environment, options: &FilmOptions) -> Result<Picture, Failure> {
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
pub(crate) fn map_of(environment: &Environment, size: [u32; 2], path: &[[f32; 2]]) -> Picture {
    let agent = environment.agent();
    let agent = Some((agent.position, agent.heading_deg));
    let Ok(picture) = Picture::smooth(size, |[width, height]| {
        Ok::<_, Infallible>(top_down_with_way(environment.scene(), width, height, agent, path).rgb)
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
        for (name, count, expected) in [
            ("targets", 5, "one of the targets"),
            ("targets", 1, "the targets"),
            ("fruit", 10, "a fruit"),
            ("animal", 2, "an animal"),
            ("goal", 1, "the goal"),
        ] {
            assert_eq!(one_of(name, count), expected);
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
        let world = draft.check().expect("the world is valid");
        let mut environment = Environment::new(world.clone());
        let caption = |environment: &Environment| words(environment, None).replace('\u{a0}', " ");
        assert_eq!(caption(&environment), "0.0 s · return 0.0 · energy 30 · in pond");
        assert!(words(&environment, None).starts_with(&format!("{}\u{a0}· ", whole("0.0 s"))));
        while environment.seconds() < 0.95 {
            environment.step(StillAgent.act(&environment)).expect("it steps");
        }
        assert!(
            caption(&environment).ends_with("· energy 20 · in pond"),
            "{}",
            caption(&environment)
        );
        let elsewhere = world.edit(|draft| {
            draft.agent_params.coordinates = [9.0, 9.0];
            draft.agent_params.energy = None;
        });
        let environment = Environment::new(elsewhere.expect("the world is valid"));
        assert_eq!(caption(&environment), "0.0 s · return 0.0");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        /// The steps ascend and include the start and the end. There are as many as requested if the episode is long enough, and
        /// no omitted step is more important than a shown one.
        #[test]
        fn frames_show_the_most_important_steps(weights in prop::collection::vec(0u8..4, 1..200), max_rows in 2usize..30) {
            let events: Vec<StepEvents> = weights.iter().map(|weight| StepEvents { words: Vec::new(), weight: *weight }).collect();
            let shown = frame_steps(&events, max_rows);
            prop_assert!(shown.is_sorted_by(|a, b| a < b));
            prop_assert_eq!((shown[0], *shown.last().expect("there is one")), (0, events.len() - 1));
            prop_assert_eq!(shown.len(), max_rows.min(events.len()));
            let inner = || 1..events.len().saturating_sub(1);
            let least = inner().filter(|number| shown.contains(number)).map(|number| weights[number]).min();
            let left_out = inner().filter(|number| !shown.contains(number)).map(|number| weights[number]).max();
            if let (Some(least), Some(left_out)) = (least, left_out) {
                prop_assert!(left_out <= least || left_out == 0, "{left_out} is left out, {least} is shown");
            }
        }
    }
}
