// What the shaders of both styles share: the target of a pass, and how colours become bytes. The constants come from shade.rs.

struct Atlas {
    // From pixels to clip space: 2 / width and 2 / height.
    scale: vec2f,
    // Patches that each tile has, in the natural style.
    patches: u32,
}

// What a fragment may write: bytes of colour and label; the item's number.
struct Pixel {
    @location(0) word: u32,
    @location(1) item: u32,
}

struct Behind {
    @location(0) word: u32,
    @location(1) item: u32,
    @builtin(frag_depth) depth: f32,
}

@group(0) @binding(0) var<storage, read> tiles: array<Tile>;
@group(0) @binding(1) var<uniform> atlas: Atlas;

// Whether any tile of the pass has fog.
override FOG: bool = false;

// A corner of the rectangle of a tile in pixels of the atlas, by the number of its vertex.
fn tile_corner(place: vec4f, vertex: u32) -> vec2f {
    let right = select(0.0, 1.0, vertex == 2u || vertex == 3u || vertex == 5u);
    let below = select(0.0, 1.0, vertex == 1u || vertex == 4u || vertex == 5u);
    return place.xy + vec2f(right, below) * place.zw;
}

fn in_clip_space(corner: vec2f) -> vec4f {
    return vec4f(corner.x * atlas.scale.x - 1.0, 1.0 - corner.y * atlas.scale.y, 0.0, 1.0);
}

fn packed_pixel(levels: vec3f, label: u32) -> u32 {
    let bytes = vec3u(min(levels + ROUNDING, vec3f(FULL_LEVEL)));
    return (label << 24u) | (bytes.z << 16u) | (bytes.y << 8u) | bytes.x;
}
