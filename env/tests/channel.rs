//! The three channels as a client uses them: the original's own messages, and hostile ones, which must not change anything.

use driftworld_env::Channel::{Debug, Reset, State};
use driftworld_env::{Action, Category, Channel, Channels, Environment, MAX_MESSAGE_BYTES, Outgoing};
use driftworld_spec::{Object, WorldDraft};
use serde_json::{Value, json};

use crate::reference_data::reference;

const NOW: &str = "2026-01-01T00:00:00";

fn start() -> (Environment, Channels) {
    let mut tree = Object::new("tree", [3.0, 4.0]);
    tree.unique_name = Some("oak".to_owned());
    let world = WorldDraft::with_objects(vec![tree]);
    let world = world.check().expect("the world is valid");
    let channels = Channels::new(&world);
    (Environment::new(world), channels)
}

fn ask(environment: &mut Environment, channels: &mut Channels, message: &Value) -> Vec<Outgoing> {
    let action = message["action"].as_str().unwrap_or_default();
    let channel = Channel::for_action(action).expect("a channel accepts the action");
    channels
        .receive(environment, channel, &message.to_string(), NOW)
        .messages
}

/// The original's messages; if they are missing, prints that the test is skipped.
fn original() -> Option<Value> {
    let path = reference("l2explorer/channel_messages.json")?;
    let text = std::fs::read_to_string(path).expect("the original's messages are text");
    Some(serde_json::from_str(&text).expect("the original's messages are JSON"))
}

#[test]
fn every_message_of_the_original_is_understood() {
    let Some(messages) = original() else { return };
    let (mut environment, mut channels) = start();
    let mut answers = Vec::new();
    for test in messages["tests"].as_array().expect("a list of messages") {
        let channel = Channel::from_name(test["channel"].as_str().expect("it has a channel")).expect("it is known");
        let text = test["message"].to_string();
        let received = channels.receive(&mut environment, channel, &text, NOW);
        if let Some(picture) = &received.screenshot {
            assert_eq!(
                (picture.filename.as_str(), picture.width, picture.height),
                ("l2explorer_screenshot.png", 84, 84)
            );
            answers.push(channels.answer_screenshot(picture, Ok(()), NOW));
        }
        answers.extend(received.messages);
    }
    let actions: Vec<&str> = answers
        .iter()
        .map(|answer| answer.action)
        .filter(|action| *action != "debug_message")
        .collect();
    assert_eq!(
        actions,
        ["ok", "ok", "ok", "debug_categories", "ok", "observer_list", "ok"]
    );
    assert_eq!(
        environment.find("thing"),
        Some(3),
        "the new object comes after the world's three"
    );
    assert!(channels.is_active(Category::Agent) && !channels.is_active(Category::Academy));
    let step = environment
        .step(Action::Continuous([1.0, 0.0, 0.0]))
        .expect("the episode continues");
    let told = channels.after_step(&environment, &step, NOW);
    assert_eq!(told.len(), 1);
    let state = told[0].payload.as_ref().expect("a state has a payload");
    assert_eq!(state.as_object().expect("it is an object").len(), 1);
    let y = state["agent_params"]["coordinates"][1].as_f64().expect("a number");
    assert!((y - 10.1).abs() < 1e-5, "1 m/s for 0.1 s from 10: {y}");
}

/// The original's client looks up `payload` in every message on the State channel, and fails if it is missing.
#[test]
fn answers_have_every_key_that_clients_look_up() {
    let (mut environment, mut channels) = start();
    let watch = json!({ "action": "set_active_observers", "payload": { "state": ["agent_params"] } });
    let answer = &ask(&mut environment, &mut channels, &watch)[0];
    let read: Value = serde_json::from_str(&answer.to_json()).expect("messages are JSON");
    let keys: Vec<&str> = read
        .as_object()
        .expect("it is an object")
        .keys()
        .map(String::as_str)
        .collect();
    assert_eq!(keys, ["token", "req_token", "msg_time", "action", "payload"]);
    assert_eq!(read["payload"], Value::Null);
    assert_eq!(
        read["req_token"], "00000000-0000-0000-0000-000000000000",
        "the request had no token"
    );
}

#[test]
fn reported_objects_are_present_and_named() {
    let (mut environment, mut channels) = start();
    for _ in 0..2 {
        let spawn = json!({ "action": "object_create", "payload": { "class": "rock", "coordinates": [9, 9] } });
        ask(&mut environment, &mut channels, &spawn);
    }
    environment.destroy(1).expect("the first rock exists");
    let watch = json!({ "action": "set_active_observers", "payload": { "state": ["objects", "game_mode"] } });
    ask(&mut environment, &mut channels, &watch);
    let step = environment
        .step(Action::Continuous([0.0; 3]))
        .expect("the episode continues");
    let told = channels.after_step(&environment, &step, NOW);
    let state = told[0].payload.as_ref().expect("a state has a payload");
    assert_eq!(state["game_mode"], "learn");
    let names: Vec<&str> = state["objects"]
        .as_array()
        .expect("it is a list")
        .iter()
        .filter_map(|object| object["unique_name"].as_str())
        .collect();
    assert_eq!(names, ["oak", "object-2"]);
}

/// Checks that a message is answered by an error and changes nothing.
#[track_caller]
fn check(channel: Channel, text: &str, expected: &str) {
    let (mut environment, mut channels) = start();
    channels.set_active(Category::Agent, true);
    let before = (environment.state(), format!("{:?}", environment.snapshot()));
    let received = channels.receive(&mut environment, channel, text, NOW);
    assert_eq!(received.messages.len(), 1, "{text:.80}");
    assert!(received.screenshot.is_none() && !received.reset, "{text:.80}");
    let answer = &received.messages[0];
    assert_eq!((answer.action, answer.channel), ("error", channel), "{text:.80}");
    let texts = answer
        .payload
        .as_ref()
        .and_then(Value::as_array)
        .expect("a list of texts");
    let said = texts[0].as_str().expect("a text");
    assert!(said.contains(expected) && said.len() < 2000, "{text:.80}: {said}");
    assert_eq!(
        before,
        (environment.state(), format!("{:?}", environment.snapshot())),
        "{text:.80}"
    );
    assert!(
        channels.watched().is_empty() && channels.is_active(Category::Agent),
        "{text:.80}"
    );
}

#[test]
fn errors_do_not_give_positions_in_our_own_copy_of_the_message() {
    let (mut environment, mut channels) = start();
    let spawn =
        json!({ "action": "object_create", "unique_name": "", "payload": { "class": "rock", "coordinates": [9, 9] } });
    let answers = ask(&mut environment, &mut channels, &spawn);
    let said = answers[0].payload.as_ref().expect("an error has reasons")[0].to_string();
    assert!(said.contains("/unique_name") && !said.contains("object:"), "{said}");
}

#[test]
fn hostile_resets_and_objects_change_nothing() {
    check(Reset, &" ".repeat(MAX_MESSAGE_BYTES + 1), "expected at most");
    check(Reset, &"{\"action\":".repeat(1000), "not valid JSON");
    let tree = r#""class": "tree", "coordinates": [1, 2]"#;
    for row in r#"
not JSON => not valid JSON
null => found null
{ "action": "reset_enviroment" } => did you mean "reset_environment"?
{ "action": "get_observers" } => expected it on the State channel
{ "action": "reset_environment" } => payload: found none
{ "action": "reset_environment", "payload": [] } => payload (/): found []
{ "action": "reset_environment", "payload": { "agent_params": { "heading": "east" }, "max_steps": -1 } } => payload (/max_steps): found -1
{ "action": "object_create", "payload": { "coordinates": [1, 2] } } => class
{ "action": "object_create", "payload": { "class": "tree", "coordinates": [1, 1e9] } } => (/coordinates/1): found
{ "action": "object_create", "unique_name": "oak", "payload": { TREE } } => object 0 has too
{ "action": "object_create", "unique_name": 7, "payload": { TREE } } => unique_name: found a number"#
        .trim()
        .lines()
    {
        let (text, expected) = row.split_once(" => ").expect("a row has two parts");
        check(Reset, &text.replace("TREE", tree), expected);
    }
}

#[test]
fn hostile_observer_requests_change_nothing() {
    for (more, expected) in [
        ("", "found no state"),
        (
            r#", "payload": { "state": ["objects", "object"] }"#,
            "did you mean \"objects\"?",
        ),
        (r#", "state": "objects""#, "found a string"),
    ] {
        check(
            State,
            &format!(r#"{{ "action": "set_active_observers"{more} }}"#),
            expected,
        );
    }
}

#[test]
fn hostile_debug_requests_change_nothing() {
    check(Debug, r#"{ "action": "save_screenshot", "payload": {} }"#, "filename");
    for factor in ["0", "49", "1.5", "\"2\"", "-1", "1e300"] {
        let text = format!(
            r#"{{ "action": "save_screenshot", "payload": {{ "filename": "a.png", "upscale_factor": {factor} }} }}"#
        );
        check(Debug, &text, "a whole number from 1 to 48");
    }
    let categories = |listed: &str| format!(r#"{{ "action": "set_debug_categories", "payload": [{listed}] }}"#);
    let all = categories(r#"{ "category": "agent", "active": false }, { "category": "all", "active": true }"#);
    check(Debug, &all, "expected one of agent, communications");
    check(Debug, &categories(r#"{ "category": "agent" }"#), "expected entries");
    let unknown = r#"{ "action": "debug_message" }"#;
    check(Debug, unknown, "expected one of save_screenshot");
}

#[test]
fn observed_parts_are_sent_each_step_without_absent_objects() {
    let (mut environment, mut channels) = start();
    let told = |environment: &mut Environment, channels: &mut Channels| {
        let step = environment
            .step(Action::Continuous([0.0; 3]))
            .expect("the episode continues");
        channels.after_step(environment, &step, NOW)
    };
    assert_eq!(told(&mut environment, &mut channels), [], "nothing is requested");
    let watch = json!({ "action": "set_active_observers", "payload": { "state": ["Objects", "objects"] } });
    assert_eq!(ask(&mut environment, &mut channels, &watch)[0].action, "ok");
    let objects = |messages: &[Outgoing]| {
        let payload = messages[0].payload.clone().expect("a state has a payload");
        payload["objects"].as_array().expect("it is a list").len()
    };
    let first = told(&mut environment, &mut channels);
    assert_eq!((first[0].action, objects(&first)), ("state", 1));
    environment.destroy(0).expect("the oak exists");
    assert_eq!(objects(&told(&mut environment, &mut channels)), 0);
    let nothing = json!({ "action": "set_active_observers", "payload": { "state": [] } });
    ask(&mut environment, &mut channels, &nothing);
    assert_eq!(told(&mut environment, &mut channels), []);
}

#[test]
fn tokens_are_unique_deterministic_uuids() {
    let run = || {
        let (mut environment, mut channels) = start();
        let list = json!({ "token": "x", "action": "get_observers" });
        let reset = json!({ "action": "reset_environment", "payload": { "max_steps": 9 } });
        [&list, &list, &reset, &list].map(|message| ask(&mut environment, &mut channels, message)[0].to_json())
    };
    let first = run();
    assert_eq!(first, run());
    let token = |text: &String| {
        let message: Value = serde_json::from_str(text).expect("messages are JSON");
        message["token"].as_str().expect("each has a token").to_owned()
    };
    let tokens: std::collections::BTreeSet<String> = first.iter().map(token).collect();
    assert_eq!(tokens.len(), 4);
    for token in tokens {
        let lengths: Vec<usize> = token.split('-').map(str::len).collect();
        assert_eq!(lengths, [8, 4, 4, 4, 12], "{token}");
        assert_eq!(
            (&token[14..15], &token[19..20]),
            ("8", "8"),
            "version and variant: {token}"
        );
    }
    assert!(
        first[0].contains(r#""req_token":"x""#) && first[2].contains(r#""req_token":"00000000-"#),
        "{first:?}"
    );
}

#[test]
fn remarks_come_when_their_category_is_on() {
    let (mut environment, mut channels) = start();
    for &category in Category::ALL {
        channels.set_active(category, true);
    }
    let reset = json!({ "action": "reset_environment", "payload": { "max_steps": "1", "objects": [
        { "class": "dragon", "coordinates": [0, 0], "reward": 2, "reward_stimulus": ["AgentCollide"] }] } });
    let mut messages = ask(&mut environment, &mut channels, &reset);
    let step = environment
        .step(Action::Continuous([0.0; 3]))
        .expect("the world has one step");
    messages.extend(channels.after_step(&environment, &step, NOW));
    let said: Vec<String> = messages
        .iter()
        .map(|message| match (message.action, &message.payload) {
            ("debug_message", Some(payload)) => format!(
                "{} {}: {}",
                payload["category"].as_str().unwrap_or_default(),
                payload["level"].as_str().unwrap_or_default(),
                payload["message"].as_str().unwrap_or_default()
            ),
            (action, _) => action.to_owned(),
        })
        .collect();
    insta::assert_snapshot!(said.join("\n"));
}
