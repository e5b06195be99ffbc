//! Distances between distributions: of numbers, headings, words and points. How those of many parameters combine is in `combined/`.

mod circular;
mod counts;
mod energy;
mod extent;
mod gap;
mod hellinger;
mod jensen_shannon;
mod kullback_leibler;
mod law;
mod measured;
mod overlap;
mod part;
pub(crate) mod planar;
mod quadrature;
mod shape;
mod total_variation;
mod values;
mod wasserstein_1;
mod wasserstein_2;

pub use circular::circular_wasserstein_1;
pub use energy::energy;
pub use extent::{extent, widest};
pub use hellinger::hellinger;
pub use jensen_shannon::{jensen_shannon, jensen_shannon_divergence};
pub use kullback_leibler::kullback_leibler;
pub use measured::{How, Measured};
pub use planar::bures_wasserstein;
pub use total_variation::total_variation;
pub use wasserstein_1::wasserstein_1;
pub use wasserstein_2::wasserstein_2;
