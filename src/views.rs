//! [`Views`]: the pictures of one world, as the agent sees it, from above and from near by.

#![expect(clippy::disallowed_methods, reason = "where a camera stands for a picture")]

use std::cell::RefCell;
use std::rc::Rc;

use driftworld_env::{Camera, Catalogue, Frame, Renderer, Scene, category_color, depth_to_gray, top_down};
use driftworld_report::picture::Picture;
use driftworld_spec::World;

use crate::Failure;

/// The pictures of one world.
pub(crate) struct Views<'a> {
    world: &'a World,
    scene: Scene,
    size: u32,
    turn: f32,
    renderer: Rc<RefCell<Renderer>>,
}

/// The three modalities of one view.
pub(crate) struct Seen {
    pub(crate) rgb: Picture,
    pub(crate) depth: Picture,
    pub(crate) segmentation: Picture,
}

impl<'a> Views<'a> {
    pub(crate) fn new(world: &'a World, size: u32, turn: f32) -> Self {
        Self::with_catalogue(world, &Catalogue::default(), size, turn)
    }

    /// The same with assets from a catalogue.
    pub(crate) fn with_catalogue(world: &'a World, catalogue: &Catalogue, size: u32, turn: f32) -> Self {
        Self {
            world,
            scene: Scene::from_world_with(world, catalogue),
            size,
            turn,
            renderer: Rc::default(),
        }
    }

    /// The same, drawn by another renderer than the processor's.
    pub(crate) fn drawn_by(self, renderer: Renderer) -> Self {
        Self {
            renderer: Rc::new(RefCell::new(renderer)),
            ..self
        }
    }

    /// The same in another size.
    pub(crate) fn of_size(&self, size: u32) -> Self {
        Self {
            size,
            renderer: Rc::clone(&self.renderer),
            ..Self::with_catalogue(self.world, self.scene.catalogue(), size, self.turn)
        }
    }

    /// From outside, above a corner of the arena.
    pub(crate) fn overview(&self, width: u32) -> Result<Picture, Failure> {
        let scene = self.scene.clone().with_wall_tops();
        self.smooth(&scene, &self.above(&scene), width)
    }

    /// The camera of the overview: higher, and looking down at the same ground, where walls would hide a small arena.
    fn above(&self, scene: &Scene) -> Camera {
        let camera = Camera::overview(scene);
        let layout = self.world.plan().into_iter().flat_map(|plan| &plan.walls);
        let wall = layout
            .filter_map(|wall| wall.height)
            .fold(self.world.environment_params.wall_height, f64::max) as f32;
        let span = scene.arena_size().into_iter().fold(4.0, f32::max);
        let hidden = wall - span / 12.0;
        if hidden <= 0.0 {
            return camera;
        }
        let [x, y, z] = camera.position;
        let height = z + (2.0 * hidden).min(span);
        let ahead = z / -camera.pitch_deg.to_radians().tan();
        Camera {
            position: [x, y, height],
            pitch_deg: -(height / ahead).atan().to_degrees(),
            ..camera
        }
    }

    /// What the agent sees at the start.
    pub(crate) fn first_person(&self) -> Result<Seen, Failure> {
        let camera = self.agent_camera(self.turn);
        let frame = self.frame(&self.scene, &camera, self.size, self.size)?;
        let picture = |rgb| Picture {
            width: self.size,
            height: self.size,
            rgb,
        };
        Ok(Seen {
            rgb: self.smooth(&self.scene, &camera, self.size)?,
            depth: picture(
                depth_to_gray(&frame.depth)
                    .into_iter()
                    .flat_map(|gray| [gray; 3])
                    .collect(),
            ),
            segmentation: picture(
                frame
                    .category
                    .iter()
                    .flat_map(|category| category_color(*category))
                    .collect(),
            ),
        })
    }

    /// What the agent sees ahead, to its right, behind and to its left.
    pub(crate) fn all_around(&self) -> Result<Vec<Picture>, Failure> {
        let look = |turn: f32| {
            let camera = Camera {
                field_of_view_deg: 90.0,
                ..self.agent_camera(self.turn + turn)
            };
            self.smooth(&self.scene, &camera, self.size)
        };
        [0.0, 90.0, 180.0, 270.0].into_iter().map(look).collect()
    }

    /// The first object of each class that is nearest to the agent, from near by, with the name of its class.
    pub(crate) fn close_ups(&self, most: usize) -> Result<Vec<(String, Picture)>, Failure> {
        let start = self.world.agent_params.coordinates;
        let far = |index: &usize| {
            let [x, y] = self.world.objects[*index].coordinates;
            (x - start[0]).hypot(y - start[1])
        };
        let mut indices: Vec<usize> = (0..self.world.objects.len()).collect();
        // What pays first, then by distance.
        indices.sort_by(|a, b| {
            let pays = |index: &usize| self.world.objects[*index].is_target();
            pays(b).cmp(&pays(a)).then(far(a).total_cmp(&far(b)))
        });
        let mut shown: Vec<(String, Picture)> = Vec::new();
        for index in indices {
            let class = self.world.objects[index].class.to_lowercase();
            if shown.len() < most && !shown.iter().any(|(other, _)| *other == class) {
                shown.push((class, self.smooth(&self.scene, &self.close_to(index), self.size)?));
            }
        }
        Ok(shown)
    }

    /// A camera that looks at an object from where the agent is, so near that the object fills the picture.
    fn close_to(&self, index: usize) -> Camera {
        let item = &self.scene.items[index];
        let start = self.world.agent_params.coordinates.map(|metres| metres as f32);
        let way = [item.position[0] - start[0], item.position[1] - start[1]];
        let heading = if way == [0.0; 2] { 0.0_f32 } else { way[0].atan2(way[1]) };
        let size = item.asset.height.max(item.asset.radius * 1.6) * item.scale;
        let back = 1.9 * size + item.asset.radius * item.scale;
        let height = size * 0.75 + 0.3;
        Camera {
            position: [
                item.position[0] - heading.sin() * back,
                item.position[1] - heading.cos() * back,
                height,
            ],
            heading_deg: heading.to_degrees(),
            pitch_deg: -((height - item.asset.height * item.scale * 0.5) / back)
                .atan()
                .to_degrees(),
            field_of_view_deg: 42.0,
        }
    }

    /// The map with the agent's start on it.
    pub(crate) fn top_down(&self) -> Picture {
        let agent = &self.world.agent_params;
        let marker = Some((agent.coordinates.map(|metres| metres as f32), agent.heading as f32));
        let twice = if self.size <= 2048 { 2 } else { 1 };
        let image = top_down(&self.scene, self.size * twice, self.size * twice, marker);
        let picture = Picture {
            width: image.width,
            height: image.height,
            rgb: image.rgb,
        };
        if twice == 2 { picture.halved() } else { picture }
    }

    fn agent_camera(&self, turn: f32) -> Camera {
        let agent = &self.world.agent_params;
        Camera::first_person(
            agent.coordinates.map(|metres| metres as f32),
            agent.heading as f32 + turn,
            agent.agent_height as f32,
            agent.field_of_view as f32,
        )
    }

    /// A colour picture with smooth edges: drawn at twice the size where that is allowed.
    fn smooth(&self, scene: &Scene, camera: &Camera, width: u32) -> Result<Picture, Failure> {
        let twice = if self.size.max(width) <= 2048 { 2 } else { 1 };
        let frame = self.frame(scene, camera, width * twice, self.size * twice)?;
        let picture = Picture {
            width: frame.width,
            height: frame.height,
            rgb: frame.rgb,
        };
        Ok(if twice == 2 { picture.halved() } else { picture })
    }

    fn frame(&self, scene: &Scene, camera: &Camera, width: u32, height: u32) -> Result<Frame, Failure> {
        let mut frame = Frame::new(width, height);
        self.renderer.borrow_mut().render(scene, camera, &mut frame)?;
        Ok(frame)
    }
}
