// Corners of triangles of objects and walls, and where they are on the screen, in both styles: after view.rs and raster.rs. One
// instance is one object of one tile.

struct Corner {
    @location(0) point: vec3f,
    @location(1) normal: vec3f,
    // Colour, and 1 where the object's own colour takes its place.
    @location(2) paint: vec4f,
}

struct Instance {
    // From the object's frame to column times depth, row times depth, and depth.
    @location(3) column: vec4f,
    @location(4) row: vec4f,
    @location(5) depth: vec4f,
    // Towards the sun in the object's frame.
    @location(6) sun: vec3f,
    // The object's own colour, and 1 if it has one.
    @location(7) color: vec4f,
    // Number of the tile; label, and in the natural style what covers it; number of the item plus 1.
    @location(8) numbers: vec3u,
}

fn along(row: vec4f, p: vec3f) -> f32 {
    return p.x * row.x + (p.y * row.y + (p.z * row.z + row.w));
}

// Column times depth, row times depth, and depth, from the tile's left upper corner on. Pixel centres have whole coordinates in
// view.rs, and lie half a pixel further on here.
fn on_screen(corner: Corner, instance: Instance) -> vec3f {
    let depth = along(instance.depth, corner.point);
    let column = along(instance.column, corner.point) + 0.5 * depth;
    let row = along(instance.row, corner.point) + 0.5 * depth;
    return vec3f(column, row, depth);
}

fn corner_position(at: vec3f, place: vec4f) -> vec4f {
    return vec4f(
        (at.x + place.x * at.z) * atlas.scale.x - at.z,
        at.z - (at.y + place.y * at.z) * atlas.scale.y,
        NEAR,
        at.z,
    );
}

// How far a corner is inside each edge of its tile.
fn inside_tile(at: vec3f, place: vec4f) -> array<f32, 4> {
    return array<f32, 4>(at.x, place.z * at.z - at.x, at.y, place.w * at.z - at.y);
}

fn own_color(corner: Corner, instance: Instance) -> vec3f {
    return select(corner.paint.xyz, instance.color.xyz, corner.paint.w * instance.color.w > 0.5);
}
