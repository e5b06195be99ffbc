//! The name of a world by where things stand in it: what the chance of a world without a `seed` grows from. Its name by all of
//! its content is [`World::hash`].

use sha2::{Digest, Sha256};

use super::World;

impl World {
    /// The SHA-256 of the arena and of the places of the agent and of all objects, in hexadecimal, 64 characters.
    ///
    /// What things look like, pay or are called has no part in it, nor has the order of the objects: worlds that differ in
    /// nothing else have one hash of places.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::{Object, World};
    /// let mut world = World { objects: vec![Object::new("tree", [3.0, 4.0])], ..World::default() };
    /// let before = world.hash_of_places();
    /// world.objects[0].reward = 5.0;
    /// assert_eq!(world.hash_of_places(), before);
    /// world.objects[0].coordinates = [3.0, 5.0];
    /// assert_ne!(world.hash_of_places(), before);
    /// ```
    pub fn hash_of_places(&self) -> String {
        let mut hash = Sha256::new();
        hash.update(b"driftworld places 1\0");
        let mut take = |points: &mut dyn Iterator<Item = [f64; 2]>| {
            let mut count: u64 = 0;
            for point in points {
                for metres in point {
                    hash.update(bits(metres).to_le_bytes());
                }
                count += 1;
            }
            hash.update(count.to_le_bytes());
        };
        let arena = &self.environment_params;
        take(&mut [arena.arena_size()].into_iter());
        for region in arena.regions() {
            take(&mut region.iter().copied());
        }
        for wall in &arena.walls {
            take(&mut wall.polygon.iter().copied());
        }
        take(&mut [self.agent_params.coordinates].into_iter());
        let mut places: Vec<[f64; 2]> = self.objects.iter().map(|object| object.coordinates).collect();
        places.sort_unstable_by_key(|place| place.map(bits));
        take(&mut places.into_iter());
        super::hexadecimal(&hash.finalize())
    }
}

/// The bits of a number; 0 has one form.
fn bits(metres: f64) -> u64 {
    (metres + 0.0).to_bits()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Color, Object};

    #[test]
    fn looks_pay_names_and_order_have_no_part_in_it() {
        let world = World {
            objects: vec![Object::new("tree", [3.0, 0.0]), Object::new("rock", [-1.0, 2.0])],
            ..World::default()
        };
        let mut other = world.clone();
        other.objects.swap(0, 1);
        other.objects[0].coordinates[1] = 2.0;
        other.objects[1].coordinates[1] = -0.0;
        other.objects[0].color = Some(Color([1.0, 0.0, 0.0]));
        other.objects[0].reward = 7.0;
        other.objects[0].tag = Some("stone".to_owned());
        other.environment_params.light_intensity = 0.3;
        other.max_steps = 9;
        assert_eq!(other.hash_of_places(), world.hash_of_places());
        assert_ne!(other.hash(), world.hash());
        other.agent_params.coordinates = [0.0, 1.0];
        assert_ne!(other.hash_of_places(), world.hash_of_places());
    }
}
