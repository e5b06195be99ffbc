//! What the world has names for at this moment: whoever edits lines completes them.

/// Names that the world gives at this moment.
#[derive(Default)]
#[cfg_attr(
    not(feature = "line-editor"),
    expect(dead_code, reason = "read where there is the feature")
)]
pub(crate) struct Names {
    pub(super) objects: Vec<String>,
    pub(super) snapshots: Vec<String>,
}
