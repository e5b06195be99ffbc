//! [`OrderArgs`]: the options by which an order is found, for every command that orders. Finding it is the library's.

use crate::ordering::OrderRequest;
use crate::similarity::Method;
use clap::Args;

/// How an order is found; shared with `curriculum`.
#[derive(Args)]
pub(crate) struct OrderArgs {
    /// The method: nearest, exact (up to 15 variants), two-opt, spectral, tree, leaf, contrast, typical-last, farthest-first,
    /// random, bottleneck, target-step or given; exact where possible if none is given, else two-opt.
    #[arg(long)]
    method: Option<Method>,
    /// The variant that comes first; whichever is best if none is given.
    #[arg(long, value_name = "TASK#VARIANT")]
    start: Option<String>,
    /// The variant that comes last; whichever is best if none is given.
    #[arg(long, value_name = "TASK#VARIANT")]
    end: Option<String>,
    /// The step that the method target-step wants between neighbours.
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
