// Casts the shadow of a brush under one lamp, a chain of soft discs, on what lies still: light ground
// gets darker, and dark ground lighter, for on black a shadow would not be seen (Baxter 2004, § 8.4.5).

const NODES: u32 = 24u;
// Luminance of the ground from which a shadow begins to darken, and where it does nothing else.
const DARK_GROUND: vec2<f32> = vec2<f32>(0.015, 0.075);
// Value to which dark ground is lightened, as the target takes encoded values, and share to which light ground is
// darkened.
const LIFT: f32 = 0.72;
const LIFTED: f32 = 0.8;

struct Chain {
    // Pixels of the view.
    view: vec2<f32>,
    // The board that lies above the desk: its lower left corner, pixels.
    corner_of_board: vec2<f32>,
    // From pixels off that corner to shares of its sides.
    board: vec4<f32>,
    // x is 1 where only the board is shaded, -1 where all but the board is, 0 where there is none.
    shaded: vec4<f32>,
    // Radii of the board's corners, pixels: lower left, lower right, upper left, upper right.
    radii: vec4<f32>,
    // The box that the chain covers: a corner and its two sides, pixels.
    corner: vec4<f32>,
    sides: vec4<f32>,
    // x, y, radius, softness, pixels.
    nodes: array<vec4<f32>, NODES>,
    // x is the darkness.
    shades: array<vec4<f32>, NODES>,
}

// True if the target takes encoded values; one that encodes them in hardware takes linear light.
override encoded: bool = true;
// Nodes of the chain, the same for each: a loop to a uniform makes some drivers compile the shader again for every
// draw.
override count: u32;

@group(0) @binding(0) var<uniform> chain: Chain;
@group(0) @binding(1) var desk: texture_2d<f32>;

struct Corner {
    @builtin(position) position: vec4<f32>,
    // Pixels from the view's upper left.
    @location(0) at: vec2<f32>,
}

@vertex
fn cover(@builtin(vertex_index) corner: u32) -> Corner {
    let unit = vec2<f32>(f32(corner & 1u), f32(corner >> 1u));
    let at = chain.corner.xy + unit.x * chain.sides.xy + unit.y * chain.sides.zw;
    let clip = at / chain.view * vec2<f32>(2.0, -2.0) + vec2<f32>(-1.0, 1.0);
    return Corner(vec4<f32>(clip, 0.0, 1.0), at);
}

// The shadow of a bar of half width r at the distance x from its middle, blurred over `soft`.
fn shadow_of_bar(x: f32, r: f32, soft: f32) -> f32 {
    return smoothstep(-soft, soft, r - x) - smoothstep(-soft, soft, -r - x);
}

fn disc(at: vec2<f32>, node: vec4<f32>, shade: f32) -> f32 {
    return shade * shadow_of_bar(distance(at, node.xy), node.z, node.w);
}

// The darkest of the discs and of the cones between neighbours. A disc that contains its neighbour is not covered by
// the cone between them, so each disc is taken alone, too.
fn darkness(at: vec2<f32>) -> f32 {
    var b = chain.nodes[0];
    var b_shade = chain.shades[0].x;
    var dark = disc(at, b, b_shade);
    for (var i = 1u; i < count; i += 1u) {
        let a = b;
        let a_shade = b_shade;
        b = chain.nodes[i];
        b_shade = chain.shades[i].x;
        let ab = b.xy - a.xy;
        let t = clamp(dot(at - a.xy, ab) / max(dot(ab, ab), 1e-6), 0.0, 1.0);
        dark = max(dark, max(disc(at, b, b_shade), disc(at, mix(a, b, t), mix(a_shade, b_shade, t))));
    }
    return dark;
}

// Share of a pixel that the board covers.
fn on_board(at: vec2<f32>) -> f32 {
    let off = at - chain.corner_of_board;
    let place = vec2<f32>(dot(off, chain.board.xy), dot(off, chain.board.zw));
    let sides = inverseSqrt(vec2<f32>(dot(chain.board.xy, chain.board.xy), dot(chain.board.zw, chain.board.zw)));
    let p = (place - 0.5) * sides;
    let lower = select(chain.radii.x, chain.radii.y, p.x > 0.0);
    let upper = select(chain.radii.z, chain.radii.w, p.x > 0.0);
    let radius = select(lower, upper, p.y > 0.0);
    let q = abs(p) - 0.5 * sides + radius;
    let beyond = min(max(q.x, q.y), 0.0) + length(max(q, vec2<f32>(0.0))) - radius;
    return clamp(0.5 - beyond, 0.0, 1.0);
}

// Luminance of what lies at a pixel.
fn luminance(at: vec2<f32>) -> f32 {
    let size = vec2<f32>(textureDimensions(desk));
    let own = textureLoad(desk, vec2<i32>(clamp(at, vec2<f32>(0.0), size - 1.0)), 0).rgb;
    let seen = dot(own, vec3<f32>(0.2126, 0.7152, 0.0722));
    // As bright as it is when it is encoded with a power of 2.
    return select(seen, seen * seen, encoded);
}

@fragment
fn shade(in: Corner) -> @location(0) vec4<f32> {
    var dark = darkness(in.at);
    if dark < 0.002 {
        return vec4<f32>(0.0);
    }
    if chain.shaded.x != 0.0 {
        let board = on_board(in.at);
        dark *= select(1.0 - board, board, chain.shaded.x > 0.0);
    }
    let light = smoothstep(DARK_GROUND.x, DARK_GROUND.y, luminance(in.at));
    let lift = LIFTED * dark * (1.0 - light);
    dark *= light;
    if encoded {
        return vec4<f32>(vec3<f32>(LIFT * lift), dark + lift);
    }
    let alpha = 1.0 - pow(1.0 - dark, 2.2);
    return vec4<f32>(vec3<f32>(pow(LIFT * lift, 2.2)), alpha + pow(lift, 2.2));
}
