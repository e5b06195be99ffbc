//! What the motions of one time step led to: who met whom, who moved, who came back. `interactions.rs` makes stimuli of
//! it.

/// The events of one time step's motions. The lists are used again in the next.
#[derive(Default)]
pub(super) struct Encounters {
    /// Objects that the agent met on its way, and that met it on theirs; some of them twice.
    pub(super) met: Vec<u32>,
    /// Contacts that last although a moving object ran ahead, in rising order.
    pub(super) kept: Vec<u32>,
    /// Objects that moved, by index, and where they came from.
    pub(super) moved: Vec<(usize, [f32; 2])>,
    /// Objects that came back.
    pub(super) returned: Vec<usize>,
    /// How much the time steps so far looked at.
    #[cfg(test)]
    pub(super) looked: u64,
}

impl Encounters {
    /// Forgets the last time step, and keeps the memory.
    pub(super) fn clear(&mut self) {
        self.met.clear();
        self.kept.clear();
        self.moved.clear();
        self.returned.clear();
    }
}
