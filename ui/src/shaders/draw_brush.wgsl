// Draws what is round about a brush: ferrule and handle as a chain of cones seen from straight
// above, and the shadow of the whole brush as a chain of soft discs.

const NODES: u32 = 24u;

struct Chain {
    // Pixels of the view.
    view: vec2<f32>,
    // The box that the chain covers: a corner and its two sides, pixels.
    corner: vec4<f32>,
    sides: vec4<f32>,
    // Unit vectors in the view (x right, y down, z to the viewer): to the lamp, and halfway to it.
    toward: vec4<f32>,
    half: vec4<f32>,
    // x, y and radius in pixels; then height (solid) or softness (shadow), in pixels.
    nodes: array<vec4<f32>, NODES>,
    // Of the cone that begins at a node: linear colour; then opacity (solid) or darkness (shadow).
    colours: array<vec4<f32>, NODES>,
    // Of that cone: x is 1 for metal, 0 for lacquer.
    finishes: array<vec4<f32>, NODES>,
}

// Whether the target takes encoded values; one that encodes by itself takes linear light.
override encoded: bool = true;
// Nodes of the chain, the same for each: a loop to a uniform makes some drivers compile the shader
// anew for every draw.
override count: u32;

@group(0) @binding(0) var<uniform> chain: Chain;

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
fn shaded(x: f32, r: f32, soft: f32) -> f32 {
    return smoothstep(-soft, soft, r - x) - smoothstep(-soft, soft, -r - x);
}

@fragment
fn shadow(in: Corner) -> @location(0) vec4<f32> {
    var dark = 0.0;
    for (var i = 0u; i < count; i += 1u) {
        let a = chain.nodes[i];
        let b = chain.nodes[min(i + 1u, count - 1u)];
        let ab = b.xy - a.xy;
        let square = dot(ab, ab);
        // Where neighbours fall together, each is a disc.
        let t = select(0.0, clamp(dot(in.at - a.xy, ab) / max(square, 1e-6), 0.0, 1.0), square > 1e-6);
        let node = mix(a, b, t);
        let darkness = mix(chain.colours[i].w, chain.colours[min(i + 1u, count - 1u)].w, t);
        dark = max(dark, darkness * shaded(distance(in.at, node.xy), node.z, node.w));
    }
    if encoded {
        return vec4<f32>(0.0, 0.0, 0.0, dark);
    }
    return vec4<f32>(0.0, 0.0, 0.0, 1.0 - pow(1.0 - dark, 2.2));
}

// IEC 61966-2-1.
fn srgb(linear: vec3<f32>) -> vec3<f32> {
    let inside = clamp(linear, vec3<f32>(0.0), vec3<f32>(1.0));
    let high = 1.055 * pow(inside, vec3<f32>(1.0 / 2.4)) - 0.055;
    return select(high, 12.92 * inside, inside <= vec3<f32>(0.0031308));
}

fn finished(colour: vec3<f32>, metal: f32, n: vec3<f32>) -> vec3<f32> {
    let facing = dot(n, chain.toward.xyz);
    let lacquer = colour * (0.42 + 0.65 * max(facing, 0.0));
    // Metal shows the room: a window on the lamp's side, its dark frame, and the grey desk.
    let window = smoothstep(0.72, 0.9, facing);
    let frame = smoothstep(0.2, 0.5, facing) - smoothstep(0.5, 0.75, facing);
    let polished = colour * (0.42 - 0.26 * frame + 0.6 * window + 0.2 * facing);
    let gleam = pow(max(dot(n, chain.half.xyz), 0.0), 48.0);
    return mix(lacquer + 0.25 * gleam, polished + 0.2 * gleam, metal);
}

@fragment
fn solid(in: Corner) -> @location(0) vec4<f32> {
    var colour = vec3<f32>(0.0);
    var cover = 0.0;
    var opacity = 1.0;
    for (var i = 0u; i + 1u < count; i += 1u) {
        let a = chain.nodes[i];
        let b = chain.nodes[i + 1u];
        let ab = b.xy - a.xy;
        let long = length(ab);
        let rise = b.w - a.w;
        let slant = max(sqrt(long * long + rise * rise), 1e-3);
        let ahead = select(vec2<f32>(1.0, 0.0), ab / long, long > 1e-3);
        let p = in.at - a.xy;
        let along = dot(p, ahead);
        let off = dot(p, vec2<f32>(-ahead.y, ahead.x));
        let t = clamp(along / max(long, 1e-3), 0.0, 1.0);
        let r = mix(a.z, b.z, t);
        let bulge = sqrt(max(r * r - off * off, 0.0));
        // The silhouette: the discs' hull, cut where the cone before it goes on below.
        let side = r - length(vec2<f32>(along - t * long, off));
        let cut = along + bulge * rise / slant;
        let inside = clamp(min(side, cut) + 0.5, 0.0, 1.0);
        if inside <= 0.0 {
            continue;
        }
        // Of the spheres along the axis, the highest at this pixel says how the surface faces.
        let touch = clamp((along + bulge * rise / slant) / max(long, 1e-3), 0.0, 1.0);
        // A pixel beyond the edge, where it would face away.
        let off_axis = vec2<f32>(along - touch * long, off) / (r + 1.0);
        let flat = min(dot(off_axis, off_axis), 1.0);
        let across = off_axis * inverseSqrt(max(dot(off_axis, off_axis), 1.0));
        let n = vec3<f32>(
            across.x * ahead + across.y * vec2<f32>(-ahead.y, ahead.x),
            sqrt(1.0 - flat),
        );
        let shade = finished(chain.colours[i].rgb, chain.finishes[i].x, n);
        colour = mix(colour, shade, inside);
        opacity = mix(opacity, mix(chain.colours[i].w, chain.colours[i + 1u].w, t), inside);
        cover = max(cover, inside);
    }
    let alpha = cover * opacity;
    if encoded {
        return vec4<f32>(srgb(colour) * alpha, alpha);
    }
    return vec4<f32>(colour * alpha, alpha);
}
