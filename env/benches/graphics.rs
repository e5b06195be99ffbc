//! How many pictures a second the graphics card draws, in batches: `cargo bench -p driftworld-env --features gpu
//! --bench graphics`. Without the feature there is nothing to measure, and it ends at once.

#[cfg(feature = "gpu")]
#[path = "graphics/batches.rs"]
mod batches;

fn main() {
    #[cfg(feature = "gpu")]
    batches::run();
}
