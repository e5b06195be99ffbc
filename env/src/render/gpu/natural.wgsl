// The natural style: what lies behind row by row, objects with what covers them, and where shadows fall, after natural.rs,
// rows.rs and shadows.rs. What rows and patches look like is reckoned on the processor, by the renderer's own code; here texels
// are found in them. Bytes are multiplied as whole numbers, as there.

// One picture of a pass, as `natural.rs` writes it.
struct Tile {
    // Its left upper corner in the atlas, then its width and height, all in pixels.
    place: vec4f,
    // The camera's axis ahead, over the ground; metres per pixel at 1 m; the distance at which half is fog, 0 for none.
    forward_step_fog: vec4f,
    // Its axis to the right, over the ground; towards the sun, over the ground, 0 where nothing glows.
    right_sun: vec4f,
    // Shares of a colour: from the sun, from all around, and for a face that looks up.
    sun: vec4f,
    around: vec4f,
    above: vec4f,
    // Colours of fog away from the sun and towards it; what shadow leaves of the ground's light.
    words: vec4u,
}

// A row of a tile, as rows.rs has it.
struct Row {
    inverse: f32,
    base: u32,
    sunward: u32,
    cloud: u32,
    u: vec2f,
    v: vec2f,
    side: u32,
    detail: f32,
    // What it shows; above the lowest byte, how much of the detail is seen.
    shows: u32,
    // Where its tile of texels begins.
    texels: u32,
}

// What covers faces that lie in one direction, as natural.rs has it.
struct Patch {
    u: vec4f,
    v: vec4f,
    facing_sharpness: vec4f,
    // Where its tile of texels begins, and 1 where there is one.
    texels: vec4u,
}

@group(0) @binding(2) var<storage, read> rows: array<Row>;
@group(0) @binding(3) var<storage, read> patches: array<Patch>;
@group(0) @binding(4) var<storage, read> texels: array<u32>;
@group(1) @binding(0) var shadows: texture_2d<u32>;

fn bytes_of(word: u32) -> vec3u {
    return vec3u(word & 255u, (word >> 8u) & 255u, (word >> 16u) & 255u);
}

fn word_of(bytes: vec3u, label: u32) -> u32 {
    return label | (bytes.z << 16u) | (bytes.y << 8u) | bytes.x;
}

fn modulated(a: vec3u, b: vec3u) -> vec3u {
    return min((a * b + 64u) >> vec3u(7u), vec3u(255u));
}

fn mixed(a: vec3u, b: vec3u, share: vec3u) -> vec3u {
    return (a * (255u - share) + b * share + 255u) >> vec3u(8u);
}

// How much a column shows of the sky towards the sun, 0 to 255.
fn glow(tile: u32, offset: f32) -> vec3u {
    let sun = tiles[tile].right_sun.zw;
    if sun.x == 0.0 && sun.y == 0.0 {
        return vec3u(0u);
    }
    let ahead = tiles[tile].right_sun.xy * offset + tiles[tile].forward_step_fog.xy;
    let toward = ahead.x * sun.x + ahead.y * sun.y;
    let length = sqrt(max(ahead.x * ahead.x + ahead.y * ahead.y, 1e-6));
    let part = (toward / length + 1.0) * 0.5;
    let share = max(part * (part * part), 0.0);
    return vec3u(u32(min(share * FULL_LEVEL, FULL_LEVEL)));
}

// A row's texel in a column, of a tile that is so many times as fine.
fn found(row: Row, offset: f32, finer: f32) -> vec3u {
    let u = u32(i32((row.u.y * finer) * offset + row.u.x * finer)) & (row.side - 1u);
    let v = u32(i32((row.v.y * finer) * offset + row.v.x * finer)) & (row.side - 1u);
    return bytes_of(texels[row.texels + row.side * (row.side + v) + u]);
}

// The texel of a row of ground or ceiling.
fn row_texel(row: Row, offset: f32) -> vec3u {
    if row.side <= 1u || (row.shows & 255u) == SHOWS_SKY {
        return vec3u(128u);
    }
    var texel = found(row, offset, 1.0);
    if row.detail > 0.0 {
        let detail = mixed(vec3u(128u), found(row, offset, row.detail), vec3u(row.shows >> 8u));
        texel = modulated(texel, detail);
    }
    return texel;
}

// The number of a texel along a side of a tile of so many.
fn part_of_tile(at: vec4f, offset: vec2f, depth: f32, side: f32) -> f32 {
    let slope = at.z * offset.x + (at.y + offset.y * at.w);
    let tiles_on = depth * slope + (at.x + PATCH_SHIFT);
    return floor((tiles_on - floor(tiles_on)) * side);
}

fn patch_texel(number: u32, offset: vec2f, inverse: f32) -> vec3u {
    let cover = patches[number];
    if cover.texels.y == 0u {
        return vec3u(128u);
    }
    let depth = 1.0 / max(inverse, 1e-4);
    let look = cover.facing_sharpness;
    let facing = max(abs(look.y * offset.x + (look.x + offset.y * look.z)), GRAZING);
    let most = clamp((inverse * facing) * look.w, 1.0, SIDE);
    let side = bitcast<f32>(bitcast<u32>(most) & 0x7F800000u);
    let u = part_of_tile(cover.u, offset, depth, side);
    let v = part_of_tile(cover.v, offset, depth, side);
    return bytes_of(texels[cover.texels.x + u32(side * (side + v) + u)]);
}

// Bytes turned into the fog's with distance; the sky stays.
fn in_fog(bytes: vec3u, inverse: f32, tile: u32, offset: f32) -> vec3u {
    let distance = tiles[tile].forward_step_fog.w;
    if distance <= 0.0 || inverse <= 0.0 {
        return bytes;
    }
    let reach = inverse * distance;
    let share = u32(1.0 / (reach * reach + 1.0) * FULL_LEVEL + ROUNDING);
    let words = tiles[tile].words;
    let fog = mixed(bytes_of(words.x), bytes_of(words.y), glow(tile, offset));
    return mixed(bytes, fog, vec3u(share));
}

fn in_shadow(bytes: vec3u, position: vec4f, tile: u32) -> vec3u {
    if textureLoad(shadows, vec2u(position.xy), 0).x == 0u {
        return bytes;
    }
    return modulated(bytes, bytes_of(tiles[tile].words.z));
}

// How far a pixel is from the picture's middle, to the right and up, at 1 m.
fn offset_of(position: vec4f, tile: u32) -> vec2f {
    let place = tiles[tile].place;
    let away = position.xy - place.xy - place.zw / 2.0;
    return vec2f(away.x, -away.y) * tiles[tile].forward_step_fog.z;
}

fn row_of(position: vec4f, tile: u32) -> Row {
    let place = tiles[tile].place;
    return rows[tile * u32(place.w) + u32(position.y - place.y)];
}

struct Whole {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat, either) number: u32,
}

@vertex
fn backdrop_vertex(@builtin(vertex_index) vertex: u32, @builtin(instance_index) number: u32) -> Whole {
    return Whole(in_clip_space(tile_corner(tiles[number].place, vertex)), number);
}

@fragment
fn backdrop_fragment(whole: Whole) -> Behind {
    let number = whole.number;
    let offset = offset_of(whole.position, number).x;
    let row = row_of(whole.position, number);
    let base = bytes_of(row.base);
    var bytes = base;
    if (row.shows & 255u) == SHOWS_SKY {
        if row.sunward != row.base {
            bytes = mixed(base, bytes_of(row.sunward), glow(number, offset));
        }
        if row.side > 1u {
            bytes = mixed(bytes, bytes_of(row.cloud), found(row, offset, 1.0));
        }
    } else {
        bytes = modulated(base, row_texel(row, offset));
        if (row.shows & 255u) == SHOWS_FLOOR {
            bytes = in_shadow(bytes, whole.position, number);
        }
    }
    if FOG {
        bytes = in_fog(bytes, row.inverse, number, offset);
    }
    return Behind(word_of(bytes, row.base & 0xFF000000u), 0u, min(row.inverse * NEAR, 1.0));
}

struct Seen {
    @builtin(position) position: vec4f,
    // CLIP @builtin(clip_distances) inside: array<f32, 4>,
    // Packed pixel, item, tile, what covers it.
    @location(0) @interpolate(flat, either) numbers: vec4u,
}

struct Fragment {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat, either) numbers: vec4u,
}

@vertex
fn objects_vertex(corner: Corner, instance: Instance) -> Seen {
    let number = instance.numbers.x;
    let place = tiles[number].place;
    let at = on_screen(corner, instance);

    let full = own_color(corner, instance) * FULL_LEVEL;
    let sun = max(dot(corner.normal, instance.sun), 0.0);
    let by_sky = corner.normal.z * (full * tiles[number].above.xyz) + full * tiles[number].around.xyz;
    let levels = select(sun * (full * tiles[number].sun.xyz) + by_sky, full, (instance.numbers.y & IS_LIT) != 0u);
    var cover = instance.numbers.y & COVER;
    if cover >= OBJECTS {
        let size = abs(corner.normal);
        cover += select(select(0u, 1u, size.y > size.x), 2u, size.z > max(size.x, size.y));
    }

    var seen: Seen;
    seen.position = corner_position(at, place);
    // CLIP seen.inside = inside_tile(at, place);
    let label = instance.numbers.y & 0xFF000000u;
    seen.numbers = vec4u(packed_pixel(levels, 0u) | label, instance.numbers.z, number, cover);
    return seen;
}

@fragment
fn objects_fragment(seen: Fragment) -> Pixel {
    let tile = seen.numbers.z;
    let cover = seen.numbers.w;
    let offset = offset_of(seen.position, tile);
    let inverse = seen.position.z / NEAR;
    var bytes = bytes_of(seen.numbers.x);
    if cover == GROUND {
        bytes = modulated(bytes, row_texel(row_of(seen.position, tile), offset.x));
        bytes = in_shadow(bytes, seen.position, tile);
    } else if cover >= WALLS {
        bytes = modulated(bytes, patch_texel(tile * atlas.patches + cover - WALLS, offset, inverse));
    }
    if FOG {
        bytes = in_fog(bytes, inverse, tile, offset.x);
    }
    return Pixel(word_of(bytes, seen.numbers.x & 0xFF000000u), seen.numbers.y);
}

struct Shadow {
    @builtin(position) position: vec4f,
    // CLIP @builtin(clip_distances) inside: array<f32, 4>,
}

@vertex
fn shadow_vertex(corner: Corner, instance: Instance) -> Shadow {
    let place = tiles[instance.numbers.x].place;
    let at = on_screen(corner, instance);
    var seen: Shadow;
    seen.position = corner_position(at, place);
    // CLIP seen.inside = inside_tile(at, place);
    return seen;
}

@fragment
fn shadow_fragment() -> @location(0) u32 {
    return 1u;
}
