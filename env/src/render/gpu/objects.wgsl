// Triangles of objects and of walls that are not the arena's own: lit and labelled corner by corner, after shade.rs, which has
// the constants. Where they are is in corner.wgsl.

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

@vertex
fn objects_vertex(corner: Corner, instance: Instance) -> Seen {
    let number = instance.numbers.x;
    let place = tiles[number].place;
    let light = tiles[number].tint_ambient;
    let at = on_screen(corner, instance);

    let sun = max(dot(corner.normal, instance.sun), 0.0);
    let share = sun * (1.0 - light.w) + light.w + SKY_SHARE * ((corner.normal.z + 1.0) * (1.0 - sun));
    let color = own_color(corner, instance);

    var seen: Seen;
    seen.position = corner_position(at, place);
    // CLIP seen.inside = inside_tile(at, place);
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
