//! [`Encounters`]: results of one time step's motions, for `interactions.rs`.

/// Results of one time step's motions. The lists are reused.
#[derive(Default)]
pub(super) struct Encounters {
    /// Objects that the agent met on its path, or that met it on theirs; may contain duplicates.
    pub(super) met: Vec<u32>,
    /// Contacts that continue although a moving object ran ahead, in ascending order.
    pub(super) kept: Vec<u32>,
    /// Objects that moved, by index, and their previous positions.
    pub(super) moved: Vec<(usize, [f32; 2])>,
    /// Objects that respawned.
    pub(super) returned: Vec<usize>,
    /// Total queries of all time steps so far.
    #[cfg(test)]
    pub(super) looked: u64,
}

impl Encounters {
    /// Clears the lists, but keeps the allocated memory.
    pub(super) fn clear(&mut self) {
        self.met.clear();
        self.kept.clear();
        self.moved.clear();
        self.returned.clear();
    }
}
