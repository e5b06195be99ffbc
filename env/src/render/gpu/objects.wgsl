// Triangles of objects and of walls other than the arena's own: projected, lit and labelled per corner, as in view.rs,
// raster.rs and, for light, shade.rs, which defines the constants. An instance is one object in one tile.

struct Corner {
    @location(0) point: vec3f,
    @location(1) normal: vec3f,
    // Colour, and 1 if the object's own colour replaces it.
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
    // Number of the tile; label; number of the item plus 1.
    @location(8) numbers: vec3u,
}

struct Seen {
    @builtin(position) position: vec4f,
    // CLIP @builtin(clip_distances) inside: array<f32, 4>,
    // Packed pixel, item, tile.
    @location(0) @interpolate(flat, either) numbers: vec3u,
}

struct Fragment {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat, either) numbers: vec3u,
}

fn along(row: vec4f, p: vec3f) -> f32 {
    return p.x * row.x + (p.y * row.y + (p.z * row.z + row.w));
}

@vertex
fn objects_vertex(corner: Corner, instance: Instance) -> Seen {
    let number = instance.numbers.x;
    let place = tiles[number].place;
    let light = tiles[number].tint_ambient;
    // Pixel centres have integer coordinates in view.rs; here they are half a pixel further.
    let depth = along(instance.depth, corner.point);
    let column = along(instance.column, corner.point) + 0.5 * depth;
    let row = along(instance.row, corner.point) + 0.5 * depth;

    let sun = max(dot(corner.normal, instance.sun), 0.0);
    let share = sun * (1.0 - light.w) + light.w + SKY_SHARE * ((corner.normal.z + 1.0) * (1.0 - sun));
    let own = corner.paint.w * instance.color.w > 0.5;
    let color = select(corner.paint.xyz, instance.color.xyz, own);

    var seen: Seen;
    seen.position = vec4f(
        (column + place.x * depth) * atlas.scale.x - depth,
        depth - (row + place.y * depth) * atlas.scale.y,
        NEAR,
        depth,
    );
    // CLIP seen.inside = array<f32, 4>(column, place.z * depth - column, row, place.w * depth - row);
    seen.numbers = vec3u(packed_pixel(color * light.xyz * FULL_LEVEL * share, 0u) | instance.numbers.y, instance.numbers.z, number);
    return seen;
}

@fragment
fn objects_fragment(seen: Fragment) -> Pixel {
    var word = seen.numbers.x;
    if FOG {
        word = in_fog(word, seen.position.z / NEAR, seen.numbers.z);
    }
    return Pixel(word, seen.numbers.y);
}
