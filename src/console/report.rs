//! Descriptions of a world as text and tables, for the console.

use std::fmt::Write;

use crate::spec::{EnvironmentParams, Layout};
use driftworld_text::{amount, joined_or};

use super::session::{MAX_LINES, Session};
use crate::modality;
use crate::table::table;

impl Session<'_> {
    pub(super) fn agent(&self) -> String {
        let agent = self.environment.agent();
        let [x, y] = agent.position.map(short);
        let [vx, vy] = agent.velocity.map(short);
        format!(
            "agent at ({x}, {y}) m, heading {}°, velocity ({vx}, {vy}) m/s; step {}, return {}{}",
            short(agent.heading_deg),
            self.environment.num_steps(),
            amount(self.environment.episode_return()),
            if self.environment.ended() {
                "; the episode has ended"
            } else {
                ""
            }
        )
    }

    pub(super) fn info(&self) -> String {
        let world = self.environment.world();
        let agent = &world.agent_params;
        let num_present = self
            .environment
            .objects()
            .iter()
            .filter(|object| object.present)
            .count();
        let [width, height] = agent.picture_size();
        let list = |names: Vec<String>| joined_or(&names, ", ", "none");
        let modalities = agent.modalities.iter().map(|it| modality::name(*it).to_owned());
        let limit = match world.step_limit() {
            None => "no limit".to_owned(),
            Some(steps) => format!("at most {steps}"),
        };
        let mut text = format!(
            "world      {}\nsteps      {}, {limit}\nreturn     {}{}\narena      {:?} m, {}\nobjects    {}, of \
             which {num_present} are present\n\
             actions    {:?}, {} s each\npictures   {width} × {height} pixels: {}\nwatched    {}\nsnapshots  {}",
            world.hash(),
            self.environment.num_steps(),
            amount(self.environment.episode_return()),
            if self.environment.ended() { ", ended" } else { "" },
            world.environment_params.arena_size(),
            ground(&world.environment_params),
            world.objects.len(),
            agent.action_model,
            amount(agent.time_step * f64::from(agent.frame_skip)),
            list(modalities.collect()),
            list(self.channels.watched().iter().map(|part| (*part).to_owned()).collect()),
            list(self.snapshots.keys().cloned().collect()),
        );
        for warning in self.environment.warnings().iter().take(10) {
            write!(text, "\nwarning    {warning}").expect("writing to a String does not fail");
        }
        text
    }

    pub(super) fn objects(&self) -> String {
        let world = self.environment.world();
        let states = self.environment.objects().iter().zip(&self.environment.scene().items);
        let rows = world.objects.iter().zip(states).enumerate().take(MAX_LINES);
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
                amount(state.reward),
                if state.present { "" } else { "gone" }.to_owned(),
            ]
        });
        let headings = ["object", "class", "name or tag", "x", "y", "heading", "reward", ""];
        let mut text = table(headings, rows, &[0, 3, 4, 5, 6]);
        if world.objects.len() > MAX_LINES {
            write!(text, "\nand {} more", world.objects.len() - MAX_LINES).expect("writing to a String does not fail");
        }
        text
    }
}

/// A number with at most two decimals, without trailing zeros.
pub(super) fn short(number: f32) -> String {
    driftworld_text::short(f64::from(number), 2)
}

/// The layout or map of the arena, and the number of zones, if any.
fn ground(environment: &EnvironmentParams) -> String {
    let kind = environment.layout.as_ref().map(|layout| match layout {
        Layout { maze: Some(_), .. } => "layout maze".to_owned(),
        Layout { rooms: Some(_), .. } => "layout rooms".to_owned(),
        Layout { text: Some(_), .. } => "layout text".to_owned(),
        Layout {
            predefined: Some(number),
            ..
        } => format!("layout predefined {number}"),
        _ => "layout walls".to_owned(),
    });
    let kind = kind.unwrap_or_else(|| format!("map {}", environment.predefined_map));
    match environment.zones.len() {
        0 => kind,
        count => format!("{kind}, zones {count}"),
    }
}
