//! [`OrderArgs`]: the options by which an order is found, for every command that orders. Finding it is the library's.

use crate::ordering::OrderRequest;
use crate::similarity::Method;
use clap::Args;

/// How an order is found; shared with `curriculum`.
#[derive(Args)]
pub(crate) struct OrderArgs {
    /// Ordering method [default: exact if there are few enough variants, else two-opt].
    ///
    /// One of nearest, exact (up to 15 variants), two-opt, spectral, tree, leaf, contrast, typical-last,
    /// farthest-first, random, bottleneck, target-step, gradual, outward, given.
    #[arg(long)]
    method: Option<Method>,
    /// First variant [default: the one named first, or whichever is best of one whole task].
    #[arg(long, value_name = "TASK#VARIANT")]
    start: Option<String>,
    /// Last variant [default: whichever is best].
    #[arg(long, value_name = "TASK#VARIANT")]
    end: Option<String>,
    /// Step between neighbours for the method target-step.
    #[arg(long, value_name = "DISTANCE")]
    target_step: Option<f64>,
}

impl OrderArgs {
    /// The same for the library.
    pub(crate) fn request(&self) -> OrderRequest {
        OrderRequest {
            method: self.method,
            start: self.start.clone(),
            end: self.end.clone(),
            target_step: self.target_step,
        }
    }
}
