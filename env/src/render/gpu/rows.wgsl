// What lies behind all objects: sky, ground and the arena's walls by formula, after backdrop.rs and compose.rs. A tile is drawn
// row by row, as there: what a row's pixels share is reckoned once in the vertex shader.

struct Row {
    @builtin(position) position: vec4f,
    // Of sky; or of the ground's light and dark squares, in light and in dark blocks.
    @location(0) @interpolate(flat, either) inks: vec4u,
    // Squares along x and y: at the row's middle, and how they change to the right.
    @location(1) @interpolate(flat, either) squares: vec4f,
    // 1 / distance of each wall: at the row's middle, and how it changes to the right.
    @location(2) @interpolate(flat, either) walls: vec4f,
    @location(3) @interpolate(flat, either) slopes: vec4f,
    // 1 / distance of the ground; that at which a wall's upper edge is seen; whether there are squares; whether there are walls.
    @location(4) @interpolate(flat, either) bounds: vec4f,
    // The column of the row's middle in the atlas; metres per pixel at 1 m.
    @location(5) @interpolate(flat, either) columns: vec2f,
    @location(6) @interpolate(flat, either) number: u32,
}

struct Behind {
    @location(0) word: u32,
    @location(1) item: u32,
    @builtin(frag_depth) depth: f32,
}

// How much squares, or blocks of them, differ from the ground where a pixel covers so many of them.
fn contrast(blur: f32) -> vec2f {
    return max(vec2f(1.0) - blur * FADING, vec2f(0.0)) * CONTRAST;
}

fn sky(tile: Tile, rise: f32) -> u32 {
    let slope = max(rise, 0.0);
    let steepness = slope / sqrt(slope * slope + 1.0);
    let left = 1.0 - steepness;
    let share = 1.0 - left * (left * left);
    return ink(share * (tile.zenith.xyz - tile.horizon.xyz) + tile.horizon.xyz, SKY);
}

// Inks of the ground in a row, and 1 where its squares can be told apart.
fn ground_inks(tile: Tile, inverse: f32) -> vec4u {
    let metres = 1.0 / max(inverse, 1e-6);
    let blur = metres * metres * (tile.forward_step.w / (tile.right_height.w * SQUARE));
    let change = contrast(blur);
    let light = 1.0 + change.x;
    let dark = 1.0 - change.x;
    let color = tile.ground.xyz;
    return vec4u(
        ink((light + change.y) * color, MAP),
        ink((dark + change.y) * color, MAP),
        ink((light - change.y) * color, MAP),
        ink((dark - change.y) * color, MAP),
    );
}

@vertex
fn rows_vertex(@builtin(vertex_index) vertex: u32, @builtin(instance_index) number: u32) -> Row {
    let tile = tiles[number];
    let y = f32(vertex / 6u);
    let corner = vertex % 6u;
    let right = select(0.0, 1.0, corner == 2u || corner == 3u || corner == 5u);
    let below = select(0.0, 1.0, corner == 1u || corner == 4u || corner == 5u);
    let x = tile.place.x + right * tile.place.z;

    let step = tile.forward_step.w;
    let offset = -((y + 0.5 - tile.place.w / 2.0) * step);
    let rise = offset * tile.up_above.z + tile.forward_step.z;

    var row: Row;
    row.position = vec4f(x * atlas.scale.x - 1.0, 1.0 - (tile.place.y + y + below) * atlas.scale.y, 0.0, 1.0);
    row.columns = vec2f(tile.place.x + tile.place.z / 2.0, step);
    row.number = number;
    row.bounds = vec4f(0.0);
    row.squares = vec4f(0.0);
    if rise < 0.0 {
        let inverse = -rise / tile.right_height.w;
        row.bounds.x = inverse;
        row.inks = ground_inks(tile, inverse);
        if any(row.inks != row.inks.xxxx) {
            let metres = 1.0 / inverse;
            let ahead = tile.forward_step.xy + offset * tile.up_above.xy;
            let place = (tile.position_walls.xy + ahead * metres) / SQUARE;
            let across = tile.right_height.xy * metres / SQUARE;
            let half_width = abs((0.5 - tile.place.z / 2.0) * step);
            let furthest = abs(place) + abs(across) * half_width;
            row.squares = vec4f(place.x + SHIFT, across.x, place.y + SHIFT, across.y);
            row.bounds.z = select(0.0, 1.0, max(furthest.x, furthest.y) < MOST_SQUARES);
        }
    } else {
        row.inks = vec4u(sky(tile, rise));
    }
    row.walls = tile.wall_base + offset * tile.wall_up;
    row.slopes = tile.wall_right;
    row.bounds.y = max(rise, 0.0) / tile.up_above.w;
    row.bounds.w = tile.position_walls.w;
    return row;
}

@fragment
fn rows_fragment(row: Row) -> Behind {
    var word = row.inks.x;
    var inverse = row.bounds.x;
    let offset = (row.position.x - row.columns.x) * row.columns.y;
    if row.bounds.z > 0.0 {
        let squares = vec2u(row.squares.xz + row.squares.yw * offset);
        let both = squares.x ^ squares.y;
        let light = select(row.inks.x, row.inks.y, (both & 1u) != 0u);
        let dark = select(row.inks.z, row.inks.w, (both & 1u) != 0u);
        word = select(light, dark, (both & 8u) != 0u);
    }
    if row.bounds.w > 0.0 {
        let walls = row.walls + row.slopes * offset;
        let nearest = max(max(walls.x, walls.y), max(walls.z, walls.w));
        if nearest >= row.bounds.y && nearest > inverse {
            inverse = nearest;
            let inks = tiles[row.number].wall_inks;
            // The first of the nearest.
            word = select(inks.w, inks.z, walls.z == nearest);
            word = select(word, inks.y, walls.y == nearest);
            word = select(word, inks.x, walls.x == nearest);
        }
    }
    if FOG {
        word = in_fog(word, inverse, row.number);
    }
    return Behind(word, 0u, min(inverse * NEAR, 1.0));
}
