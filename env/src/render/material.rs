//! Numbers of coverings in packed pixels of the map; they are replaced when texels are added.

/// Position of the covering's number in a packed pixel, above the category; the number 0 means no covering.
pub(super) const MATERIAL_SHIFT: u32 = 27;
pub(super) const MATERIAL: u32 = 31 << MATERIAL_SHIFT;

/// Category bits that are set only for items. If all of them are 0, the number above the category is a covering; otherwise it
/// is the item's class, or 0.
pub(super) const ITEM_BITS: u32 = 6 << 24;

/// Bare ground in shadow, where only the shadow has been drawn.
pub(super) const BARE_IN_SHADOW: u32 = 1;
/// Zones on the ground; the next number stands for zones in shadow.
pub(super) const GROUND: u32 = 2;
pub(super) const GROUND_IN_SHADOW: u32 = GROUND + 1;
/// Walls that face along x; the next numbers stand for walls along y and for tops of walls.
pub(super) const WALLS: u32 = 4;
