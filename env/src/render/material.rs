//! Numbers of coverings in packed pixels: what a pixel of the map shows until its texels are added.

/// Position in a packed pixel of the covering's number, above the category; 0 means no covering.
pub(super) const MATERIAL_SHIFT: u32 = 27;
pub(super) const MATERIAL: u32 = 31 << MATERIAL_SHIFT;

/// Bits of a category that the map's pixels never have: if all are 0, the number above them is that of the covering; otherwise
/// it is the item's class, or 0.
pub(super) const NO_MAP: u32 = 6 << 24;

/// Bare ground in shadow, on which only the shadow was drawn.
pub(super) const BARE: u32 = 1;
/// Zones on the ground; the next number is for those in shadow.
pub(super) const GROUND: u32 = 2;
pub(super) const GROUND_IN_SHADOW: u32 = GROUND + 1;
/// Walls that face along x; the next numbers are for those along y, and for their tops.
pub(super) const WALLS: u32 = 4;
