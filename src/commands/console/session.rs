//! A running world and what the console does with it. What a line says is in `line.rs`; how pictures, maps and messages
//! look is in the files of these names.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use driftworld::env::{
    Action, Category, Channels, CpuRenderer, Environment, Frame, Image, Level, Outgoing, Snapshot, Step, top_down,
};
use driftworld::spec::{Object, World, nearest};

use super::super::input::{self, WorldChoice};
use super::super::modality::{Kind, target};
use super::super::table::table;
use super::super::{Failure, pictures};
use super::editor::Names;
use super::line::{COMMANDS, Line, Picture};
use super::map;
use super::messages::{messages, shown};
use super::place::Folder;
use super::screen::{Screen, colors, half_blocks, letters};

/// The most moments that are remembered.
const MOST_SNAPSHOTS: usize = 100;

/// The most lines that one command says.
const MOST_LINES: usize = 500;

/// How many metres a level of a depth image stands for.
const METRES_PER_LEVEL: f32 = 0.01;

/// A running world with all that the console remembers.
pub(super) struct Session<'a> {
    choice: &'a WorldChoice,
    /// The world that `reset` goes back to.
    start: World,
    environment: Environment,
    channels: Channels,
    snapshots: BTreeMap<String, Snapshot>,
    renderer: CpuRenderer,
    folder: Folder,
    screen: Screen,
}

/// What comes of a line.
pub(super) enum Reply {
    Said(String),
    Quit,
}

/// A refusal in one sentence.
fn said(failure: Failure) -> String {
    match failure {
        Failure::Input(text) | Failure::Usage(text) => text,
    }
}

fn plain(error: impl std::error::Error) -> String {
    error.to_string()
}

impl<'a> Session<'a> {
    pub(super) fn new(choice: &'a WorldChoice, world: World, out: &Path, screen: Screen) -> Result<Self, Failure> {
        Ok(Self {
            choice,
            channels: Channels::new(&world),
            environment: Environment::new(world.clone())?,
            start: world,
            snapshots: BTreeMap::new(),
            renderer: CpuRenderer::new(),
            folder: Folder::new(out),
            screen,
        })
    }

    /// What stands above the first prompt.
    pub(super) fn greeting(&self) -> String {
        let hash = self.start.hash();
        let objects = self.start.objects.len();
        format!("world {:.12}, {objects} objects; help lists the commands", hash)
    }

    /// Names for completion.
    pub(super) fn names(&self) -> Names {
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

    /// Does what a line says; on error nothing is changed.
    pub(super) fn execute(&mut self, line: &str) -> Result<Reply, String> {
        let text = match Line::parse(line)? {
            Line::Quit => return Ok(Reply::Quit),
            Line::Help(command) => help(command.as_deref())?,
            Line::Info => self.info(),
            Line::Objects => self.objects(),
            Line::Agent => self.agent(),
            Line::StateJson => self.environment.state().to_json_pretty(),
            Line::StateFile(file) => {
                let text = self.environment.state().to_json_pretty();
                self.folder.write(&file, "json", text.as_bytes())?.display().to_string()
            }
            Line::Act { action, count } => self.act(action, count)?,
            Line::Reset(to) => self.reset(to.as_deref())?,
            Line::Spawn(json) => self.spawn(&json)?,
            Line::Destroy(object) => self.destroy(&object)?,
            Line::Teleport { position, heading } => {
                let heading = heading.unwrap_or(f64::from(self.environment.agent().heading_deg));
                self.environment.teleport(position, heading).map_err(plain)?;
                self.agent()
            }
            Line::Show { picture, columns } => self.show(picture, columns)?,
            Line::Screenshot { file, picture, size } => self.screenshot(&file, picture, size)?,
            Line::Snapshot(name) => self.snapshot(name)?,
            Line::Restore(name) => self.restore(&name)?,
            Line::Send(text) => self.send(&text)?,
            Line::Log(change) => self.log(change),
        };
        Ok(Reply::Said(text))
    }

    /// Simulated time since the start, as a date: a script says the same each time.
    fn time(&self) -> String {
        let seconds = f64::from(self.environment.num_steps()) * self.environment.world().agent_params.time_step;
        jiff::Timestamp::from_microsecond((seconds * 1e6) as i64)
            .unwrap_or(jiff::Timestamp::UNIX_EPOCH)
            .to_string()
    }

    /// A remark, as a line of its own, if its category is on.
    fn remark(&mut self, category: Category, text: String) -> String {
        let time = self.time();
        let remark = self.channels.remark(category, Level::Info, text, &time);
        remark.map_or_else(String::new, |message| shown(&message) + "\n")
    }

    fn agent(&self) -> String {
        let agent = self.environment.agent();
        let [x, y] = agent.position.map(short);
        let [vx, vy] = agent.velocity.map(short);
        format!(
            "agent at ({x}, {y}) m, heading {}°, velocity ({vx}, {vy}) m/s; step {}, return {}{}",
            short(agent.heading_deg),
            self.environment.num_steps(),
            short(self.environment.episode_return() as f32),
            if self.environment.ended() {
                "; the episode has ended"
            } else {
                ""
            }
        )
    }

    fn info(&self) -> String {
        let world = self.environment.world();
        let agent = &world.agent_params;
        let there = self
            .environment
            .objects()
            .iter()
            .filter(|object| object.present)
            .count();
        let [width, height] = agent.picture_size();
        let list = |names: Vec<String>| {
            if names.is_empty() {
                "none".to_owned()
            } else {
                names.join(", ")
            }
        };
        let modalities = agent.modalities.iter().map(|it| Kind::from(*it).name().to_owned());
        let limit = match world.max_steps {
            0 => "no limit".to_owned(),
            steps => format!("at most {steps}"),
        };
        let mut text = format!(
            "world      {}\nsteps      {}, {limit}\nreturn     {}{}\narena      {:?} m, map {}\nobjects    {}, of which {there} are there\n\
             actions    {:?}, {} s each\npictures   {width} × {height} pixels: {}\nwatched    {}\nsnapshots  {}",
            world.hash(),
            self.environment.num_steps(),
            short(self.environment.episode_return() as f32),
            if self.environment.ended() { ", ended" } else { "" },
            world.environment_params.arena_size(),
            world.environment_params.predefined_map,
            world.objects.len(),
            agent.action_model,
            agent.time_step,
            list(modalities.collect()),
            list(self.channels.watched().iter().map(|part| (*part).to_owned()).collect()),
            list(self.snapshots.keys().cloned().collect()),
        );
        for warning in self.environment.warnings().iter().take(10) {
            write!(text, "\nwarning    {warning}").expect("writing to a String does not fail");
        }
        text
    }

    fn objects(&self) -> String {
        let world = self.environment.world();
        let states = self.environment.objects().iter().zip(&self.environment.scene().items);
        let rows = world.objects.iter().zip(states).enumerate().take(MOST_LINES);
        let rows = rows.map(|(index, (object, (state, item)))| {
            let [x, y] = item.position.map(short);
            let name = object.unique_name.as_ref().or(object.tag.as_ref());
            [
                index.to_string(),
                format!("{} {}", object.class, object.model.0),
                name.cloned().unwrap_or_default(),
                x,
                y,
                short(item.heading_deg),
                short(state.reward as f32),
                if state.present { "" } else { "gone" }.to_owned(),
            ]
        });
        let headings = ["object", "class", "name or tag", "x", "y", "heading", "reward", ""];
        let mut text = table(headings, rows.collect(), &[0, 3, 4, 5, 6]);
        if world.objects.len() > MOST_LINES {
            write!(text, "\nand {} more", world.objects.len() - MOST_LINES).expect("writing to a String does not fail");
        }
        text
    }

    fn act(&mut self, action: Action, count: u32) -> Result<String, String> {
        self.environment.check(action).map_err(plain)?;
        let (mut text, mut lines, mut reward, mut steps) = (String::new(), 0, 0.0, 0);
        let mut last = Step::default();
        while steps < count && !last.ended() {
            last = self.environment.step(action).map_err(plain)?;
            steps += 1;
            reward += last.reward;
            for line in self.told(&last) {
                lines += 1;
                if lines <= MOST_LINES {
                    text += &(line + "\n");
                }
            }
        }
        if lines > MOST_LINES {
            text += &format!("… and {} lines more\n", lines - MOST_LINES);
        }
        text += &format!("{steps} steps, reward {}; {}", short(reward as f32), self.agent());
        if last.ended() {
            text += match (last.success, last.terminated) {
                (true, _) => ": success",
                (false, true) => ": failure",
                (false, false) => ": its last step",
            };
        }
        Ok(text)
    }

    /// What a step is worth telling.
    fn told(&mut self, step: &Step) -> Vec<String> {
        let number = self.environment.num_steps();
        let world = self.environment.world();
        let mut lines: Vec<String> = step
            .events
            .iter()
            .map(|event| {
                let (object, reward) = (&world.objects[event.object], short(event.reward as f32));
                let gone = if event.destroyed { ", destroyed" } else { "" };
                let class = &object.class;
                format!(
                    "step {number}: {:?} object {} ({class}), reward {reward}{gone}",
                    event.stimulus, event.object
                )
            })
            .collect();
        let time = self.time();
        lines.extend(
            self.channels
                .after_step(&self.environment, step, &time)
                .iter()
                .map(shown),
        );
        lines
    }

    fn reset(&mut self, to: Option<&str>) -> Result<String, String> {
        let world = match to {
            None => self.start.clone(),
            Some(text) => match text.parse() {
                Ok(index) => self.choice.numbered(index).map_err(said)?,
                Err(_) => self.choice.named(text).map_err(said)?,
            },
        };
        self.environment.reset(world.clone()).map_err(plain)?;
        self.start = world;
        let hash = self.start.hash();
        let remark = self.remark(Category::Academy, format!("a new episode of world {hash:.12}"));
        let objects = self.start.objects.len();
        Ok(format!("{remark}world {hash:.12}, {objects} objects; {}", self.agent()))
    }

    fn spawn(&mut self, json: &str) -> Result<String, String> {
        let object = Object::from_json("spawn", json).map_err(plain)?;
        let class = object.class.clone();
        let index = self.environment.spawn(object).map_err(plain)?;
        let remark = self.remark(Category::Worldmaker, format!("object {index} is a {class}"));
        Ok(format!("{remark}object {index}"))
    }

    fn destroy(&mut self, object: &str) -> Result<String, String> {
        let index = match object.parse() {
            Ok(index) => index,
            Err(_) => self.environment.find(object).ok_or_else(|| {
                let near = nearest(object, self.names().objects);
                let near = near.map_or_else(String::new, |near| format!("; did you mean {near:?}?"));
                format!("found object {object:?}, expected an index or a unique_name{near}")
            })?,
        };
        self.environment.destroy(index).map_err(plain)?;
        let remark = self.remark(Category::Worldmaker, format!("object {index} was taken away"));
        Ok(format!("{remark}object {index} is gone"))
    }

    /// What the agent sees, with colours smooth as the world asks for.
    fn seen(&mut self, kind: Kind, [width, height]: [u32; 2]) -> Result<Frame, String> {
        if !(1..=4096).contains(&width) || !(1..=4096).contains(&height) {
            return Err(format!("found {width} × {height} pixels, expected 1 to 4096 each way"));
        }
        let wanted = self.environment.world().agent_params.supersampling;
        // A picture with too many points for its smoothness is drawn less smooth.
        let samples = (1..=wanted).rev().find(|samples| width.max(height) * samples <= 8192);
        let mut frame = Frame::new(width, height);
        let mut target = target(&mut frame, &[kind], samples.unwrap_or(1));
        let camera = self.environment.camera();
        self.renderer
            .draw(self.environment.scene(), &camera, &mut target)
            .map_err(plain)?;
        Ok(frame)
    }

    fn from_above(&self, width: u32, height: u32) -> Image {
        let agent = self.environment.agent();
        let agent = Some((agent.position, agent.heading_deg));
        top_down(self.environment.scene(), width, height, agent)
    }

    fn show(&mut self, picture: Picture, columns: Option<u32>) -> Result<String, String> {
        let [width, height] = match picture {
            Picture::Seen(_) => self.environment.world().agent_params.picture_size(),
            Picture::Map => [1, 1],
        };
        let size = self.screen.size(width as f32 / height as f32, columns);
        Ok(match (picture, self.screen.colors) {
            (Picture::Map, true) => half_blocks(size[0], &self.from_above(size[0], size[1]).rgb),
            (Picture::Map, false) => map::letters(&self.environment, size[0]),
            (Picture::Seen(kind), true) => half_blocks(size[0], &colors(&self.seen(kind, size)?, kind)),
            (Picture::Seen(kind), false) => letters(&self.seen(kind, size)?, kind),
        })
    }

    fn screenshot(&mut self, file: &str, picture: Picture, size: Option<[u32; 2]>) -> Result<String, String> {
        let own = self.environment.world().agent_params.picture_size();
        let size = size.unwrap_or(match picture {
            Picture::Map => [480, 480],
            Picture::Seen(_) => own,
        });
        let bytes = match picture {
            Picture::Seen(kind) => self.seen(kind, size)?.png(kind)?,
            Picture::Map if size.iter().all(|side| (1..=4096).contains(side)) => {
                let Image { width, height, rgb } = self.from_above(size[0], size[1]);
                pictures::Picture { width, height, rgb }.to_png().map_err(said)?
            }
            Picture::Map => {
                return Err(format!(
                    "found {} × {} pixels, expected 1 to 4096 each way",
                    size[0], size[1]
                ));
            }
        };
        let path = self.folder.write(file, "png", &bytes)?;
        let unit = match picture {
            Picture::Seen(Kind::Depth) => ", 1 cm a level",
            _ => "",
        };
        Ok(format!("{}: {} × {} pixels{unit}", path.display(), size[0], size[1]))
    }

    fn snapshot(&mut self, name: Option<String>) -> Result<String, String> {
        let Some(name) = name else {
            let names: Vec<&str> = self.snapshots.keys().map(String::as_str).collect();
            return Ok(if names.is_empty() {
                "no moments yet".to_owned()
            } else {
                names.join(", ")
            });
        };
        if self.snapshots.len() >= MOST_SNAPSHOTS && !self.snapshots.contains_key(&name) {
            return Err(format!(
                "found {MOST_SNAPSHOTS} moments, expected fewer; use a name again"
            ));
        }
        self.snapshots.insert(name.clone(), self.environment.snapshot());
        Ok(format!("{name}: step {}", self.environment.num_steps()))
    }

    fn restore(&mut self, name: &str) -> Result<String, String> {
        let Some(moment) = self.snapshots.get(name) else {
            let near = nearest(name, self.snapshots.keys());
            let near = near.map_or_else(String::new, |near| format!("; did you mean {near:?}?"));
            return Err(format!(
                "found moment {name:?}, expected one that snapshot has made{near}"
            ));
        };
        self.environment.restore(moment).map_err(plain)?;
        Ok(self.agent())
    }

    fn send(&mut self, text: &str) -> Result<String, String> {
        let inline = text.starts_with(['{', '[']);
        let read = if inline {
            Ok(text.to_owned())
        } else {
            input::text(Path::new(text))
        };
        let (mut lines, mut refused) = (Vec::new(), None);
        for (channel, message) in messages(&read.map_err(said)?) {
            let time = self.time();
            let received = self.channels.receive(&mut self.environment, channel, &message, &time);
            if received.reset {
                self.start = self.environment.world().clone();
            }
            let mut answers = received.messages;
            if let Some(picture) = received.screenshot {
                let size = Some([picture.width, picture.height]);
                let written = self.screenshot(&picture.filename, Picture::Seen(Kind::Rgb), size);
                lines.extend(written.iter().cloned());
                answers.push(self.channels.answer_screenshot(&picture, written.map(drop), &time));
            }
            lines.extend(answers.iter().map(shown));
            refused = refused.or(answers.iter().find_map(refusal));
        }
        match refused {
            None => Ok(lines.join("\n")),
            // The answers that were no errors are said all the same.
            Some(text) => Err(format!("{text}\n{}", lines.join("\n"))),
        }
    }

    fn log(&mut self, change: Option<(Category, bool)>) -> String {
        if let Some((category, active)) = change {
            self.channels.set_active(category, active);
        }
        let state = |category: Category| if self.channels.is_active(category) { "on" } else { "off" };
        Category::ALL
            .map(|category| format!("{} {}", category.name(), state(category)))
            .join(", ")
    }
}

/// Why a message was refused, if this says so.
fn refusal(answer: &Outgoing) -> Option<String> {
    let texts = answer
        .payload
        .as_ref()
        .filter(|_| answer.action == "error")?
        .as_array()?;
    let texts: Vec<&str> = texts.iter().filter_map(|text| text.as_str()).collect();
    Some(format!("the message was refused: {}", texts.join("; ")))
}

/// A frame's PNG file.
trait Png {
    fn png(&self, kind: Kind) -> Result<Vec<u8>, String>;
}

impl Png for Frame {
    fn png(&self, kind: Kind) -> Result<Vec<u8>, String> {
        kind.to_png(self, METRES_PER_LEVEL).map_err(said)
    }
}

fn help(command: Option<&str>) -> Result<String, String> {
    let line = |(name, usage, what): &(&str, &str, &str)| format!("{:<46} {what}", format!("{name} {usage}"));
    let Some(command) = command else {
        return Ok(COMMANDS.iter().map(line).collect::<Vec<_>>().join("\n"));
    };
    let found = COMMANDS.iter().find(|(name, _, _)| *name == command);
    found.map(line).ok_or_else(|| {
        let near = nearest(command, COMMANDS.map(|(name, _, _)| name));
        let near = near.map_or_else(String::new, |near| format!("; did you mean {near:?}?"));
        format!("found command {command:?}, expected one that help lists{near}")
    })
}

/// A number with at most two decimals, and without those that say nothing.
fn short(number: f32) -> String {
    let text = format!("{number:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}
