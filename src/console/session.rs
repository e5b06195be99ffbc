//! Executes the console's commands on a world.

use std::collections::BTreeMap;
use std::path::Path;

use crate::env::{Action, Category, Channels, CpuRenderer, Environment, Event, Level, Snapshot, Step};
use crate::spec::{Object, World, did_you_mean};
use driftworld_text::{ShownPath, amount, counted, joined_or};

use super::arguments::{Picture, action, category, columns, number, object, screenshot, show, step, words};
use super::line::{help, misused};
use super::messages::shown;
use super::place::Folder;
use super::screen::Screen;
use crate::Failure;
use crate::Warn;
use crate::worlds::WorldRequest;

/// Maximum number of snapshots kept.
const MAX_SNAPSHOTS: usize = 100;

/// Maximum number of output lines per command.
pub(super) const MAX_LINES: usize = 500;

/// A running world with the console's state.
pub(crate) struct Session<'a> {
    choice: WorldRequest,
    /// Receives warnings about worlds being read.
    warn: Warn<'a>,
    /// The world that `reset` restores.
    pub(super) start: World,
    pub(super) environment: Environment,
    pub(super) channels: Channels,
    pub(super) snapshots: BTreeMap<String, Snapshot>,
    pub(super) renderer: CpuRenderer,
    pub(super) folder: Folder,
    pub(super) screen: Screen,
}

/// The result of executing a line.
pub(crate) enum Reply {
    Text(String),
    /// A JSON document.
    Json(String),
    /// A picture made of characters or colour codes.
    Picture(String),
    Quit,
}

/// A failure as one sentence.
#[expect(clippy::needless_pass_by_value, reason = "`map_err` passes it by value")]
pub(super) fn failure_text(failure: Failure) -> String {
    failure.for_command()
}

pub(super) fn to_text(error: impl std::error::Error) -> String {
    error.to_string()
}

impl<'a> Session<'a> {
    pub(crate) fn new((choice, warn): (WorldRequest, Warn<'a>), world: World, out: &Path, screen: Screen) -> Self {
        Self {
            choice,
            warn,
            channels: Channels::new(&world),
            environment: Environment::new(world.clone()),
            start: world,
            snapshots: BTreeMap::new(),
            renderer: CpuRenderer::new(),
            folder: Folder::new(out),
            screen,
        }
    }

    /// The text above the first prompt.
    pub(crate) fn greeting(&self) -> String {
        let hash = self.start.hash();
        let objects = self.start.objects.len();
        format!("world {hash:.12}, {objects} objects; help lists the commands")
    }

    /// The names offered for completion.
    pub(crate) fn names(&self) -> Names {
        let objects = &self.environment.world().objects;
        Names {
            objects: objects
                .iter()
                .filter_map(|object| object.unique_name.clone())
                .take(1000)
                .collect(),
            snapshots: self.snapshots.keys().cloned().collect(),
        }
    }

    /// Executes a line. If it fails, nothing is changed, except by messages of a file that were accepted before the failure.
    pub(crate) fn execute(&mut self, line: &str) -> Result<Reply, String> {
        let line = line.trim();
        let (name, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        let rest = rest.trim();
        if rest.starts_with(['{', '[']) {
            match name {
                "send_message" => return self.send(rest).map(Reply::Text),
                "spawn" => return self.spawn(rest).map(Reply::Text),
                _ => {}
            }
        }
        let words = words(rest)?;
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let text = match (name, &words[..]) {
            ("help", words) if words.len() < 2 => help(words.first().copied())?,
            ("info", []) => self.info(),
            ("objects", []) => self.objects(),
            ("state", []) => self.agent(),
            ("state", ["--json"]) => return Ok(Reply::Json(self.environment.state().to_json_pretty())),
            ("state", [file]) if !file.starts_with('-') => {
                let text = self.environment.state().to_json_pretty();
                self.folder.write(file, "json", text.as_bytes())?.shown().to_string()
            }
            ("step", words) => self.act(step(words)?)?,
            ("action", words) => self.act(action(words)?)?,
            ("reset", words) if words.len() < 2 => self.reset(words.first().copied())?,
            ("spawn", [class, x, y, keys @ ..]) => self.spawn(&object(class, [number(x)?, number(y)?], keys)?)?,
            ("destroy", [object]) => self.destroy(object)?,
            ("teleport", [x, y, rest @ ..]) if rest.len() < 2 => {
                let position = [number(x)?, number(y)?];
                let heading = rest.first().map(|heading| number(heading)).transpose()?;
                let heading = heading.unwrap_or(f64::from(self.environment.agent().heading_deg));
                self.environment.teleport(position, heading).map_err(to_text)?;
                self.agent()
            }
            ("show", words) if words.len() <= 2 => return self.show(show(words)?).map(Reply::Picture),
            ("map", words) if words.len() <= 1 => {
                let columns = words.first().map(|word| columns(word)).transpose()?;
                return self.show((Picture::Map, columns)).map(Reply::Picture);
            }
            ("screenshot", [file, rest @ ..]) if rest.len() <= 2 => self.screenshot(file, screenshot(rest)?)?,
            ("snapshot", words) if words.len() < 2 => self.snapshot(words.first().copied())?,
            ("restore", [name]) => self.restore(name)?,
            ("send_message", [file]) => self.send(file)?,
            ("log", []) => self.log(),
            ("log", [name, change @ ("on" | "off")]) => {
                self.channels.set_active(category(name)?, *change == "on");
                self.log()
            }
            ("quit" | "exit", []) => return Ok(Reply::Quit),
            (name, _) => return Err(misused(name)),
        };
        Ok(Reply::Text(text))
    }

    /// Simulated time since the start, formatted as a date: scripts then print the same in every run.
    pub(super) fn time(&self) -> String {
        let agent = &self.environment.world().agent_params;
        let seconds = f64::from(self.environment.num_steps()) * agent.time_step * f64::from(agent.frame_skip);
        jiff::Timestamp::from_microsecond((seconds * 1e6) as i64)
            .unwrap_or(jiff::Timestamp::UNIX_EPOCH)
            .to_string()
    }

    /// A remark as a separate line, if its category is on.
    fn remark(&mut self, category: Category, text: String) -> String {
        let time = self.time();
        let remark = self.channels.remark(category, Level::Log, text, &time);
        remark.map_or_else(String::new, |message| shown(&message) + "\n")
    }

    fn act(&mut self, (action, count): (Action, u32)) -> Result<String, String> {
        self.environment.check(action).map_err(to_text)?;
        let (mut lines, mut left_out, mut reward, mut steps) = (Vec::new(), 0, 0.0, 0);
        let mut last = Step::default();
        while steps < count && !last.ended() {
            last = self.environment.step(action).map_err(to_text)?;
            steps += 1;
            reward += last.reward;
            left_out += self.add_event_lines(&last, &mut lines);
        }
        if left_out > 0 {
            lines.push(format!("… and {left_out} more lines"));
        }
        let outcome = match (last.ended(), last.success, last.terminated) {
            (false, ..) => "",
            (true, true, _) => ": success",
            (true, false, true) => ": failure",
            (true, false, false) => ": its last step",
        };
        let (reward, agent) = (amount(reward), self.agent());
        lines.push(format!(
            "{}, reward {reward}; {agent}{outcome}",
            counted(steps as usize, "step")
        ));
        Ok(lines.join("\n"))
    }

    /// Adds lines about the events of a step, up to [`MAX_LINES`] lines in all; returns how many were left out.
    fn add_event_lines(&mut self, step: &Step, lines: &mut Vec<String>) -> usize {
        let number = self.environment.num_steps();
        let world = self.environment.world();
        let event = |event: &Event| {
            let (object, reward) = (&world.objects[event.object], amount(event.reward));
            let gone = if event.destroyed { ", destroyed" } else { "" };
            let effect = event
                .effect
                .map(|effect| format!(", {}", effect.name().replace('_', " ")));
            let effect = effect.unwrap_or_default();
            let (class, stimulus) = (&object.class, event.stimulus);
            format!(
                "step {number}: {stimulus:?} object {} ({class}), reward {reward}{gone}{effect}",
                event.object
            )
        };
        let room = MAX_LINES.saturating_sub(lines.len());
        lines.extend(step.events.iter().take(room).map(event));
        let time = self.time();
        let messages = self.channels.after_step(&self.environment, step, &time);
        let rest = MAX_LINES.saturating_sub(lines.len());
        lines.extend(messages.iter().take(rest).map(shown));
        step.events.len().saturating_sub(room) + messages.len().saturating_sub(rest)
    }

    fn reset(&mut self, to: Option<&str>) -> Result<String, String> {
        let world = match to {
            None => self.start.clone(),
            Some(text) => match text.parse() {
                Ok(index) => self.choice.numbered(index).map_err(failure_text)?,
                Err(_) => self.choice.named(text, self.warn).map_err(failure_text)?,
            },
        };
        self.environment.reset(world.clone());
        self.start = world;
        let hash = self.start.hash();
        let remark = self.remark(Category::Academy, format!("a new episode of world {hash:.12}"));
        let objects = self.start.objects.len();
        Ok(format!("{remark}world {hash:.12}, {objects} objects; {}", self.agent()))
    }

    fn spawn(&mut self, json: &str) -> Result<String, String> {
        let object = Object::from_json("spawn", json).map_err(to_text)?;
        let class = object.class.clone();
        let index = self.environment.spawn(object).map_err(to_text)?;
        let remark = self.remark(Category::Worldmaker, format!("object {index} is a {class}"));
        Ok(format!("{remark}object {index}"))
    }

    fn destroy(&mut self, object: &str) -> Result<String, String> {
        let index = match object.parse() {
            Ok(index) => index,
            Err(_) => self.environment.find(object).ok_or_else(|| {
                let near = did_you_mean(object, self.names().objects);
                format!("found object {object:?}, expected an index or a unique_name{near}")
            })?,
        };
        self.environment.destroy(index).map_err(to_text)?;
        let remark = self.remark(Category::Worldmaker, format!("object {index} was removed"));
        Ok(format!("{remark}object {index} is gone"))
    }

    fn snapshot(&mut self, name: Option<&str>) -> Result<String, String> {
        let Some(name) = name else {
            let names: Vec<&str> = self.snapshots.keys().map(String::as_str).collect();
            return Ok(joined_or(&names, ", ", "no snapshots yet"));
        };
        if self.snapshots.len() >= MAX_SNAPSHOTS && !self.snapshots.contains_key(name) {
            return Err(format!("found {MAX_SNAPSHOTS} snapshots, expected fewer; reuse a name"));
        }
        self.snapshots.insert(name.to_owned(), self.environment.snapshot());
        Ok(format!("{name}: step {}", self.environment.num_steps()))
    }

    fn restore(&mut self, name: &str) -> Result<String, String> {
        let Some(snapshot) = self.snapshots.get(name) else {
            let near = did_you_mean(name, self.snapshots.keys());
            return Err(format!("found snapshot {name:?}, expected an existing one{near}"));
        };
        self.environment.restore(snapshot);
        Ok(self.agent())
    }

    fn log(&self) -> String {
        let state = |category| if self.channels.is_active(category) { "on" } else { "off" };
        let each = Category::ALL
            .iter()
            .map(|&category| format!("{} {}", category.name(), state(category)));
        each.collect::<Vec<_>>().join(", ")
    }
}

/// Names of objects in the current world, and of snapshots.
#[derive(Default)]
#[cfg_attr(
    not(feature = "line-editor"),
    expect(dead_code, reason = "only read with the feature")
)]
pub(crate) struct Names {
    pub(super) objects: Vec<String>,
    pub(super) snapshots: Vec<String>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::WorldDraft;

    #[test]
    fn error_for_a_wrong_line_says_what_was_expected() {
        let choice = WorldRequest {
            world: String::new(),
            seed: 0,
            index: 0,
            l2explorer: false,
            maps: None,
        };
        let world = WorldDraft::default().check().expect("open ground is valid");
        let mut session = Session::new((choice, &|_| ()), world, Path::new("out"), Screen::PLAIN);
        for (line, expected) in [
            ("step 0", "1 to 100000"),
            ("step 1 2 3", "write: step 1 1 2 3"),
            ("step 1 2 nan 3", "found \"nan\", expected a number"),
            ("action 2 0 1", "action: expected [-c N] -a"),
            ("spawn barrel 1", "spawn: expected CLASS X Y"),
            ("spawn barrel 1 north", "found \"north\", expected a number"),
            ("spawn barrel 1 2 reward", "expected KEY=VALUE"),
            ("spawn barrel 1 2 class=tree", "found class twice"),
            ("show dept", "did you mean \"depth\"?"),
            ("screenshot a.png 3by4", "expected WIDTHxHEIGHT"),
            ("map 4", "8 to 400"),
            ("telport 1 2", "did you mean \"teleport\"?"),
            ("xyzzy", "expected one listed by help"),
            ("objects all", "objects: expected no arguments"),
            ("log agnet on", "did you mean \"agent\"?"),
            ("destroy 'oak", "found ' once"),
        ] {
            let error = session.execute(line).err().unwrap_or_default();
            assert!(error.contains(expected), "{line}: {error}");
        }
        let spawned = session.execute(r#"spawn  { "class": "tree", "coordinates": [1, 2], "tag": "a b" }"#);
        assert!(matches!(spawned, Ok(Reply::Text(text)) if text == "object 0"));
    }
}
