//! Materials in the packed pixels of the map, as small numbers; they are replaced by texels when textures are applied.

/// Position of the material's number in a packed pixel, above the category; 0 means no material.
pub(super) const MATERIAL_SHIFT: u32 = 27;
pub(super) const MATERIAL: u32 = 31 << MATERIAL_SHIFT;

/// Category bits that are set only for items. If all of them are 0, the number above the category is a material; otherwise it
/// is the item's class, or 0.
pub(super) const ITEM_BITS: u32 = 6 << 24;

/// Bare ground in shadow, where only the shadow has been drawn.
pub(super) const BARE_IN_SHADOW: u32 = 1;
/// Zones on the ground; the next number is for zones in shadow.
pub(super) const GROUND: u32 = 2;
pub(super) const GROUND_IN_SHADOW: u32 = GROUND + 1;
/// Walls that face along x; the next numbers are for walls along y and for wall tops.
pub(super) const WALLS: u32 = 4;
