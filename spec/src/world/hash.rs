//! Hashes of a world: of all its content, and of its positions; the latter seeds the random numbers of a world without `seed`.

use sha2::{Digest, Sha256};

use super::World;
use crate::describe::hexadecimal;

impl World {
    /// The SHA-256 of [`World::to_json`] in hexadecimal, 64 characters.
    pub fn hash(&self) -> String {
        hexadecimal(&Sha256::digest(self.to_json()))
    }

    /// The SHA-256 of the arena and the positions of the agent and of all objects, in hexadecimal, 64 characters.
    ///
    /// Looks, rewards, names and the order of the objects do not affect it: worlds that differ only in these have the same hash
    /// of positions.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::{Object, World};
    /// let world = World::default().edit(|world| world.objects.push(Object::new("tree", [3.0, 4.0])))?;
    /// let before = world.hash_of_places();
    /// let world = world.edit(|world| world.objects[0].reward = 5.0)?;
    /// assert_eq!(world.hash_of_places(), before);
    /// let world = world.edit(|world| world.objects[0].coordinates = [3.0, 5.0])?;
    /// assert_ne!(world.hash_of_places(), before);
    /// # Ok::<(), driftworld_spec::SpecError>(())
    /// ```
    pub fn hash_of_places(&self) -> String {
        let mut hash = Sha256::new();
        hash.update(b"driftworld places 1\0");
        let mut add = |points: &mut dyn Iterator<Item = [f64; 2]>| {
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
        add(&mut [arena.arena_size()].into_iter());
        for corners in self.obstacles() {
            add(&mut corners.iter().copied());
        }
        add(&mut [self.agent_params.coordinates].into_iter());
        let mut positions: Vec<[f64; 2]> = self.objects.iter().map(|object| object.coordinates).collect();
        positions.sort_unstable_by_key(|position| position.map(bits));
        add(&mut positions.into_iter());
        hexadecimal(&hash.finalize())
    }
}

/// The bits of a number, with −0 treated as 0.
fn bits(metres: f64) -> u64 {
    (metres + 0.0).to_bits()
}

#[cfg(test)]
mod tests {
    use crate::{Color, Object, WorldDraft};

    #[test]
    fn looks_rewards_names_and_order_do_not_affect_the_hash_of_places() {
        let world = WorldDraft::with_objects(vec![Object::new("tree", [3.0, 0.0]), Object::new("rock", [-1.0, 2.0])]);
        let mut other = world.clone();
        other.objects.swap(0, 1);
        other.objects[0].coordinates[1] = 2.0;
        other.objects[1].coordinates[1] = -0.0;
        other.objects[0].color = Some(Color([1.0, 0.0, 0.0]));
        other.objects[0].reward = 7.0;
        other.objects[0].tag = Some("stone".to_owned());
        other.environment_params.light_intensity = 0.3;
        other.max_steps = 9;
        let (world, other) = (world.check().unwrap(), other.check().unwrap());
        assert_eq!(other.hash_of_places(), world.hash_of_places());
        assert_ne!(other.hash(), world.hash());
        let other = other.edit(|world| world.agent_params.coordinates = [0.0, 1.0]).unwrap();
        assert_ne!(other.hash_of_places(), world.hash_of_places());
    }
}
