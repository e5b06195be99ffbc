// The background of all objects: sky, ground and the arena's walls, computed analytically as in backdrop.rs and compose.rs.
// Each tile is one rectangle. Values shared by all pixels of an image are passed as flat vertex outputs, because software
// emulation of a GPU reads a value once per triangle far faster than once per pixel. One rectangle per row, which would avoid
// recomputing the values of rows, was ten times slower there.

struct Whole {
    @builtin(position) position: vec4f,
    // The image's middle in pixels of the atlas; metres per pixel at 1 m; the camera's height.
    @location(0) @interpolate(flat, either) middle_step_height: vec4f,
    @location(1) @interpolate(flat, either) place_right: vec4f,
    @location(2) @interpolate(flat, either) forward_up: vec4f,
    // Rise of rays: straight ahead, and per metre up; height of the walls' upper edge above the camera; 1 if there are walls.
    @location(3) @interpolate(flat, either) rise_walls: vec4f,
    @location(4) @interpolate(flat, either) wall_base: vec4f,
    @location(5) @interpolate(flat, either) wall_right: vec4f,
    @location(6) @interpolate(flat, either) wall_up: vec4f,
    @location(7) @interpolate(flat, either) wall_pixels: vec4u,
    // The ground's colour; number of squares that a pixel covers, divided by the distance squared.
    @location(8) @interpolate(flat, either) ground_blur: vec4f,
    // The sky's colour at the zenith; offset of the outermost column from the middle, at 1 m.
    @location(9) @interpolate(flat, either) zenith_width: vec4f,
    @location(10) @interpolate(flat, either) horizon: vec3f,
    @location(11) @interpolate(flat, either) number: u32,
}

struct Behind {
    @location(0) word: u32,
    @location(1) item: u32,
    @builtin(frag_depth) depth: f32,
}

@vertex
fn backdrop_vertex(@builtin(vertex_index) vertex: u32, @builtin(instance_index) number: u32) -> Whole {
    let tile = tiles[number];
    let right = select(0.0, 1.0, vertex == 2u || vertex == 3u || vertex == 5u);
    let below = select(0.0, 1.0, vertex == 1u || vertex == 4u || vertex == 5u);
    let corner = tile.place.xy + vec2f(right, below) * tile.place.zw;
    let step = tile.forward_step.w;
    let height = tile.right_height.w;

    var whole: Whole;
    whole.position = vec4f(corner.x * atlas.scale.x - 1.0, 1.0 - corner.y * atlas.scale.y, 0.0, 1.0);
    whole.middle_step_height = vec4f(tile.place.xy + tile.place.zw / 2.0, step, height);
    whole.place_right = vec4f(tile.position_walls.xy, tile.right_height.xy);
    whole.forward_up = vec4f(tile.forward_step.xy, tile.up_above.xy);
    whole.rise_walls = vec4f(tile.forward_step.z, tile.up_above.z, tile.up_above.w, tile.position_walls.w);
    whole.wall_base = tile.wall_base;
    whole.wall_right = tile.wall_right;
    whole.wall_up = tile.wall_up;
    whole.wall_pixels = tile.wall_pixels;
    whole.ground_blur = vec4f(tile.ground.xyz, step / (height * SQUARE));
    whole.zenith_width = vec4f(tile.zenith.xyz, abs((0.5 - tile.place.z / 2.0) * step));
    whole.horizon = tile.horizon.xyz;
    whole.number = number;
    return whole;
}

fn sky(whole: Whole, rise: f32) -> vec3f {
    let slope = max(rise, 0.0);
    let steepness = slope / sqrt(slope * slope + 1.0);
    let left = 1.0 - steepness;
    let share = 1.0 - left * (left * left);
    return share * (whole.zenith_width.xyz - whole.horizon) + whole.horizon;
}

// The ground's colour where a ray meets it: `inverse` is 1 / distance, `offset` the ray's offset to the right and up at 1 m.
fn ground(whole: Whole, inverse: f32, offset: vec2f) -> vec3f {
    let metres = 1.0 / max(inverse, 1e-6);
    let blur = metres * metres * whole.ground_blur.w;
    let change = max(vec2f(1.0) - blur * FADING, vec2f(0.0)) * CONTRAST;
    let ahead = whole.forward_up.xy + offset.y * whole.forward_up.zw;
    let place = (whole.place_right.xy + ahead * metres) / SQUARE;
    let across = whole.place_right.zw * metres / SQUARE;
    let furthest = abs(place) + abs(across) * whole.zenith_width.w;
    let squares = vec2u((place + SHIFT) + across * offset.x);
    let is_seen = max(furthest.x, furthest.y) < MAX_SQUARES;
    let both = select(0u, squares.x ^ squares.y, is_seen);
    let fine = select(1.0 + change.x, 1.0 - change.x, (both & 1u) != 0u);
    let share = select(fine + change.y, fine - change.y, (both & 8u) != 0u);
    return share * whole.ground_blur.xyz;
}

@fragment
fn backdrop_fragment(whole: Whole) -> Behind {
    let away = whole.position.xy - whole.middle_step_height.xy;
    let offset = vec2f(away.x, -away.y) * whole.middle_step_height.z;
    let rise = offset.y * whole.rise_walls.y + whole.rise_walls.x;
    let is_ground = rise < 0.0;
    var inverse = max(-rise, 0.0) / whole.middle_step_height.w;
    let levels = select(sky(whole, rise), ground(whole, inverse, offset), is_ground);
    var word = packed_pixel(levels, select(SKY, MAP, is_ground));

    let walls = (whole.wall_base + offset.y * whole.wall_up) + whole.wall_right * offset.x;
    let nearest = max(max(walls.x, walls.y), max(walls.z, walls.w));
    let edge = max(rise, 0.0) / whole.rise_walls.z;
    if whole.rise_walls.w > 0.0 && nearest >= edge && nearest > inverse {
        inverse = nearest;
        // Ties go to the first wall.
        word = select(whole.wall_pixels.w, whole.wall_pixels.z, walls.z == nearest);
        word = select(word, whole.wall_pixels.y, walls.y == nearest);
        word = select(word, whole.wall_pixels.x, walls.x == nearest);
    }
    if FOG {
        word = in_fog(word, inverse, whole.number);
    }
    return Behind(word, 0u, min(inverse * NEAR, 1.0));
}
