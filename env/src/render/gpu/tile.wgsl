// Shared by all shaders: the images of a pass, and the conversion of colours to bytes. Follows shade.rs and compose.rs, which
// define the constants.

// One image of a pass, as written by `tile.rs`. Units are those of view.rs.
struct Tile {
    // Its upper left corner in the atlas, then its width and height, all in pixels.
    place: vec4f,
    // The camera's axes. Fourth components: metres per pixel at 1 m; the camera's height; height of the walls' upper edge above it.
    forward_step: vec4f,
    right_height: vec4f,
    up_above: vec4f,
    // The camera's position, and 1 if the arena's walls are computed analytically.
    position_walls: vec4f,
    wall_base: vec4f,
    wall_right: vec4f,
    wall_up: vec4f,
    wall_pixels: vec4u,
    // Colour levels, 0 to 255 and above.
    ground: vec4f,
    zenith: vec4f,
    horizon: vec4f,
    // The light's colour, and the share of ambient light.
    tint_ambient: vec4f,
    // Colour of fog, and the distance at which fog has half its effect; 0 without fog.
    fog: vec4f,
}

struct Atlas {
    // From pixels to clip space: 2 / width and 2 / height.
    scale: vec2f,
}

// The output of a fragment: bytes of colour and label; the item's number.
struct Pixel {
    @location(0) word: u32,
    @location(1) item: u32,
}

@group(0) @binding(0) var<storage, read> tiles: array<Tile>;
@group(0) @binding(1) var<uniform> atlas: Atlas;

// Whether any tile of the pass has fog.
override FOG: bool = false;

fn packed_pixel(levels: vec3f, label: u32) -> u32 {
    let bytes = vec3u(min(levels + ROUNDING, vec3f(FULL_LEVEL)));
    return (label << 24u) | (bytes.z << 16u) | (bytes.y << 8u) | bytes.x;
}

// Blends a word's colour into the fog with distance; the sky stays unchanged.
fn in_fog(word: u32, inverse: f32, tile: u32) -> u32 {
    let fog = tiles[tile].fog;
    if fog.w <= 0.0 || inverse <= 0.0 {
        return word;
    }
    let reach = inverse * fog.w;
    let share = 1.0 / (reach * reach + 1.0);
    let levels = vec3f(vec3u(word & 255u, (word >> 8u) & 255u, (word >> 16u) & 255u));
    return packed_pixel(levels + (fog.xyz - levels) * share, word >> 24u);
}
