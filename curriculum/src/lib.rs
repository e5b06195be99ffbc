//! Variants and distances to learning and evaluation blocks, and running them into a log.
