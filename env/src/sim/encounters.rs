//! [`Encounters`]: the results of all motions in one time step, for `interactions.rs`.

/// The results of all motions in one time step. The lists are reused.
#[derive(Default)]
pub(super) struct Encounters {
    /// Objects that the agent met on its path, or that met it on theirs; may contain duplicates.
    pub(super) met_objects: Vec<u32>,
    /// Contacts that still held after the agent's motion, so that they continue, in ascending order.
    pub(super) lasting: Vec<u32>,
    /// Objects that moved, by index, and their previous positions.
    pub(super) moved: Vec<(usize, [f32; 2])>,
    /// Objects that respawned.
    pub(super) returned: Vec<usize>,
    /// Total number of queries in all time steps so far.
    #[cfg(test)]
    pub(super) num_queries: u64,
}

impl Encounters {
    /// Clears the lists, but keeps the allocated memory.
    pub(super) fn clear(&mut self) {
        self.met_objects.clear();
        self.lasting.clear();
        self.moved.clear();
        self.returned.clear();
    }
}
