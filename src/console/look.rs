//! Pictures of a running world: shown in the terminal, or saved as files.

use crate::env::{Frame, Image, Target, top_down};
use driftworld_text::ShownPath;

use super::arguments::Picture;
use super::map;
use super::screen::{ascii_picture, color_of, half_blocks};
use super::session::{Session, to_text};
use crate::map_drawing::{self, Moves};
use crate::modality::{self, to_rgb};
use crate::report::picture;
use crate::spec::Modality;

/// Metres per level of a depth image.
const METRES_PER_LEVEL: f32 = 0.01;

impl Session<'_> {
    /// The agent's view, with smooth edges if the world asks for them.
    fn view(&mut self, kind: Modality, [width, height]: [u32; 2]) -> Result<Frame, String> {
        let limit = self.environment.world().agent_params.supersampling;
        // Supersample less if the picture would have too many samples.
        let samples = (1..=limit).rev().find(|samples| width.max(height) * samples <= 8192);
        let mut frame = Frame::new(width, height);
        let mut target = Target {
            supersampling: samples.unwrap_or(1),
            ..frame.target().only(&[kind])
        };
        let camera = self.environment.camera();
        self.renderer
            .draw(self.environment.scene(), &camera, &mut target)
            .map_err(to_text)?;
        self.environment.draw_carried(&mut self.renderer, &mut target);
        Ok(frame)
    }

    /// The map, with the agent on it.
    fn bird_view(&self, width: u32, height: u32) -> Image {
        let agent = self.environment.agent();
        let agent = Some((agent.position, agent.heading_deg));
        // Neutral light makes the map of a dark world readable.
        let scene = self.environment.scene().clone().in_neutral_light();
        top_down(&scene, width, height, agent)
    }

    pub(super) fn show(&mut self, (picture, columns): (Picture, Option<u32>)) -> Result<String, String> {
        let [width, height] = match picture {
            Picture::Seen(_) => self.environment.world().agent_params.picture_size(),
            Picture::Map => [1, 1],
        };
        let size = self.screen.size(width as f32 / height as f32, columns);
        Ok(match (picture, self.screen.colors) {
            (Picture::Map, true) => half_blocks(size[0], &self.bird_view(size[0], size[1]).rgb),
            (Picture::Map, false) => map::ascii_map(&self.environment, size[0]),
            (Picture::Seen(kind), true) => half_blocks(size[0], &to_rgb(kind, &self.view(kind, size)?, color_of)),
            (Picture::Seen(kind), false) => ascii_picture(&self.view(kind, size)?, kind),
        })
    }

    pub(super) fn screenshot(
        &mut self,
        file: &str,
        (picture, size): (Picture, Option<[u32; 2]>),
    ) -> Result<String, String> {
        let own = self.environment.world().agent_params.picture_size();
        let size = size.unwrap_or(match picture {
            Picture::Map => [480, 480],
            Picture::Seen(_) => own,
        });
        let [width, height] = size;
        if !(1..=4096).contains(&width) || !(1..=4096).contains(&height) {
            return Err(format!("found {width} × {height} pixels, expected 1 to 4096 each way"));
        }
        let bytes = match picture {
            Picture::Seen(kind) => {
                modality::to_png(kind, &self.view(kind, size)?, METRES_PER_LEVEL).map_err(to_text)?
            }
            // Only square maps are annotated with a scale, north, triggers and signs.
            Picture::Map if width == height => {
                let agent = self.environment.agent();
                let moves = Moves {
                    agent: (agent.position, agent.heading_deg),
                    ..Moves::default()
                };
                let drawing = map_drawing::map(self.environment.world(), self.environment.scene(), &moves, width);
                drawing.to_png().map_err(to_text)?
            }
            Picture::Map => {
                let Image { width, height, rgb } = self.bird_view(width, height);
                picture::Picture { width, height, rgb }.to_png().map_err(to_text)?
            }
        };
        let path = self.folder.write(file, "png", &bytes)?;
        let unit = match picture {
            Picture::Seen(Modality::Depth) => ", 1 cm per level",
            _ => "",
        };
        Ok(format!("{}: {width} × {height} pixels{unit}", path.shown()))
    }
}
