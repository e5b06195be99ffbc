//! Batched rendering throughput of the GPU: `cargo bench -p driftworld-env --features gpu --bench graphics`. Without the
//! feature it exits at once.

#[cfg(feature = "gpu")]
#[path = "graphics/batches.rs"]
mod batches;

fn main() {
    #[cfg(feature = "gpu")]
    batches::run();
}
