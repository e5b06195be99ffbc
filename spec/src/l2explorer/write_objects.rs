//! The objects of a world, written as L2Explorer has them; what they lose is counted in `write.rs`.

use serde_json::{Value as Json, json};

use super::write::{Writer, changed};
use super::{ASSUMED_SPEED, PARTS, black_is_chosen, map_of, moves};
use crate::world::{MotionModel, Object};

const BLACK: [f64; 3] = [0.0, 0.0, 0.0];

impl Writer {
    pub(super) fn objects(&mut self, objects: &[Object]) -> Json {
        let written = objects.iter().enumerate().map(|(index, object)| {
            let full = map_of(object);
            for key in changed(&PARTS.object, &full) {
                let is_said = match key {
                    "speed" => moves(object.motion_model),
                    "body_model" => object.body_model.as_ref() == Some(&object.model),
                    _ => false,
                };
                if !is_said {
                    self.left_out.of_object(index, key);
                }
            }
            if moves(object.motion_model) && object.speed != ASSUMED_SPEED {
                // Speed 0 is not written, the motion model is.
                let becomes = "left out, L2Explorer has no such key; it reads back as 2 m/s";
                self.lose(index, "motion_model", "speed", becomes);
            }
            let known = objects_keys().filter_map(|key| {
                let value = match key {
                    "class" => Some(self.class(index, &object.class)),
                    "color" => self.color(index, object),
                    "motion_model" => Some(self.motion_model(index, object.motion_model)),
                    key => full.get(key).cloned(),
                };
                Some((key.to_owned(), value?))
            });
            known.collect()
        });
        Json::Array(written.collect())
    }

    /// The class in lower case, as reading makes it.
    fn class(&mut self, index: usize, class: &str) -> Json {
        let lower = class.to_ascii_lowercase();
        if lower != class {
            let becomes = "written in lower case, L2Explorer does not tell cases apart";
            self.lose(index, "class", "class", becomes);
        }
        json!(lower)
    }

    /// The colour, where "the asset's own" is black unless black is a choice; then it is no colour at all.
    fn color(&mut self, index: usize, object: &Object) -> Option<Json> {
        let chosen = black_is_chosen(&object.class.to_ascii_lowercase());
        match object.color {
            None if chosen => {
                let becomes = "left open, L2Explorer's default is black";
                self.lose(index, "color", "missing color", becomes);
                None
            }
            None => Some(json!(BLACK)),
            Some(color) => {
                if color.0 == BLACK && !chosen {
                    let becomes = "reads back as the asset's own colours, [0.01, 0.01, 0.01] would stay";
                    self.lose(index, "color", "color black", becomes);
                }
                Some(json!(color))
            }
        }
    }

    fn motion_model(&mut self, index: usize, model: MotionModel) -> Json {
        if model != MotionModel::Patrol {
            return json!(model);
        }
        let becomes = "becomes stationary, L2Explorer has no such motion model";
        self.lose(index, "motion_model", "motion_model patrol", becomes);
        json!(MotionModel::Stationary)
    }
}

/// The original's keys of an object in the order in which its files have them: the motion model in front of the reward.
fn objects_keys() -> impl Iterator<Item = &'static str> {
    let others = PARTS
        .object
        .original
        .iter()
        .copied()
        .filter(|key| *key != "motion_model");
    others.flat_map(|key| (key == "reward").then_some("motion_model").into_iter().chain([key]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::l2explorer::write::tests::{check, with_objects};
    use crate::{Color, Respawn, World};

    #[test]
    fn objects_that_lose_the_same_thing_share_one_warning() {
        let plain = Object::new("tree", [0.0, 0.0]);
        let mut turned = plain.clone();
        turned.heading = 45.0;
        turned.tag = Some("trees".into());
        let mut guard = Object::new("barrel", [1.0, 1.0]);
        guard.heading = 90.0;
        guard.scale = 2.0;
        guard.solid = false;
        guard.reward_probability = 0.5;
        guard.motion_model = MotionModel::Patrol;
        guard.speed = 1.0;
        guard.waypoints = vec![[1.0, 1.0], [2.0, 2.0]];
        guard.order = Some(1);
        guard.respawn = Some(Respawn {
            delay: 1.0,
            radius: 0.0,
        });
        check(
            &with_objects(vec![plain, turned.clone(), guard, turned]),
            &[
                "world (/objects/1/heading): left out, L2Explorer has no such keys: /objects/*/heading, /objects/*/tag, \
                 /objects/*/scale, /objects/*/solid, /objects/*/reward_probability, /objects/*/speed, \
                 /objects/*/waypoints, /objects/*/order, /objects/*/respawn",
                "world (/objects/2/motion_model): motion_model patrol of this object: becomes stationary, L2Explorer has no such motion model",
            ],
        );
    }

    #[test]
    fn colours_and_classes_that_the_original_cannot_tell_apart_are_warned_about() {
        let black = Some(Color(BLACK));
        let object = |class: &str, color| {
            let mut object = Object::new(class, [0.0, 0.0]);
            object.color = color;
            object
        };
        let world = with_objects(vec![
            object("tree", None),
            object("cube", black),
            object("cube", None),
            object("Tree", black),
            object("icosphere", None),
        ]);
        check(
            &world,
            &[
                "world (/objects/2/color): missing color of 2 objects, this one first: left open, L2Explorer's default is black",
                "world (/objects/3/class): class of this object: written in lower case, L2Explorer does not tell cases apart",
                "world (/objects/3/color): color black of this object: reads back as the asset's own colours, [0.01, 0.01, 0.01] would stay",
            ],
        );
        let (back, warnings) =
            World::from_l2explorer("written.json", &world.check().unwrap().to_l2explorer().0).unwrap();
        let read: Vec<_> = back
            .objects
            .iter()
            .map(|object| (object.class.as_str(), object.color))
            .collect();
        let expected = [
            ("tree", None),
            ("cube", black),
            ("cube", None),
            ("tree", None),
            ("icosphere", None),
        ];
        assert_eq!(read, expected);
        assert_eq!(warnings, []);
    }
}
