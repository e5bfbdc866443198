// Shows the desk, and a lit surface where it lies on it, from its detail and, where that does not reach,
// from its base: linear light of the display's gamut is filtered first, then encoded as the display
// takes it.

struct Place {
    // Pixels of the view times their depth: the surface's lower left corner, and its sides from there.
    corner: vec2<f32>,
    right: vec2<f32>,
    up: vec2<f32>,
    view: vec2<f32>,
    // Half the distance of the samples of a pixel, in shares of the surface; 0 for one sample.
    spread: vec2<f32>,
    // Reach of the shadow of a board that lies over others, pixels (0 for a canvas), and its strength.
    shade: vec2<f32>,
    // Depth of the corner, and what the sides add to it; 1 is that of the desk.
    depth: vec4<f32>,
    // Radii of the corners, pixels: lower left, lower right, upper left, upper right.
    radii: vec4<f32>,
    // Lengths of the sides, pixels.
    sides: vec2<f32>,
    pad: vec2<f32>,
    detail: Region,
    // Its extent is 0 where there is none.
    base: Region,
}

// Part of the surface that a sheet shows.
struct Region {
    // Cells of the surface at the sheet's level: a coarse level's last cells reach beyond it.
    extent: vec2<f32>,
    // The same in whole cells.
    texels: vec2<f32>,
    // Texels of the sheet, which continues at its other side.
    size: vec2<f32>,
    // The cells that may be shown.
    low: vec2<f32>,
    high: vec2<f32>,
    pad: vec2<f32>,
}

// True if the target takes encoded values; one that encodes them in hardware takes linear light.
override encoded: bool = true;
// True if the display has a profile of its own: the cube holds the values that it is sent for encoded light.
override foreign: bool = false;
// Grey of the desk, as the target takes it.
override grey: f32 = 0.0;

@group(0) @binding(0) var<uniform> place: Place;
@group(0) @binding(1) var detail_sheet: texture_2d<f32>;
@group(0) @binding(2) var smooth_sampler: sampler;
@group(0) @binding(3) var cube: texture_3d<f32>;
@group(0) @binding(4) var base_sheet: texture_2d<f32>;
@group(0) @binding(5) var torus_sampler: sampler;

struct Corner {
    @builtin(position) position: vec4<f32>,
    // From the lower left corner, in shares of the surface.
    @location(0) at: vec2<f32>,
}

@vertex
fn lay(@builtin(vertex_index) corner: u32) -> Corner {
    // A pixel wider than the surface, for its soft edge; farther by its shadow.
    let unit = vec2<f32>(f32(corner & 1u), f32(corner >> 1u));
    let margin = 1.0 + 1.5 * place.shade.x;
    let at = unit + (2.0 * unit - 1.0) * margin / max(place.sides, vec2<f32>(1.0));
    let pixel = place.corner + at.x * place.right + at.y * place.up;
    let depth = dot(place.depth.xyz, vec3<f32>(1.0, at));
    let clip = pixel / place.view * vec2<f32>(2.0, -2.0) + depth * vec2<f32>(-1.0, 1.0);
    return Corner(vec4<f32>(clip, 0.0, depth), at);
}

fn sampled(at: vec2<f32>) -> vec3<f32> {
    let inside = clamp(at, vec2<f32>(0.0), vec2<f32>(1.0));
    let fine = place.detail;
    var cell = inside * fine.extent;
    let shown = all(cell >= fine.low) && all(cell <= fine.high);
    if shown || place.base.extent.x == 0.0 {
        cell = clamp(clamp(cell, fine.low, fine.high), vec2<f32>(0.5), fine.texels - 0.5);
        return textureSampleLevel(detail_sheet, torus_sampler, cell / fine.size, 0.0).rgb;
    }
    let coarse = place.base;
    cell = clamp(inside * coarse.extent, vec2<f32>(0.5), coarse.texels - 0.5);
    return textureSampleLevel(base_sheet, torus_sampler, cell / coarse.size, 0.0).rgb;
}

// Where a cell is several pixels wide, a cubic B-spline between cells: the edge of a film is a curve there, and no
// staircase. Four samples between cells make the sixteen of the spline.
fn magnified(at: vec2<f32>) -> vec3<f32> {
    let light = sampled(at);
    let cells = max(place.detail.extent, vec2<f32>(1.0));
    let pixels = place.sides / cells;
    let share = smoothstep(2.0, 4.0, min(pixels.x, pixels.y));
    if share == 0.0 {
        return light;
    }
    let cell = at * cells - 0.5;
    let whole = floor(cell);
    let t = cell - whole;
    let u = 1.0 - t;
    let before = u * u * u / 6.0;
    let near = (4.0 - 6.0 * t * t + 3.0 * t * t * t) / 6.0;
    let after = t * t * t / 6.0;
    let lower = before + near;
    let upper = 1.0 - lower;
    let low = (whole - 0.5 + near / lower) / cells;
    let high = (whole + 1.5 + after / upper) / cells;
    let spline = lower.y * (lower.x * sampled(low) + upper.x * sampled(vec2<f32>(high.x, low.y)))
        + upper.y * (lower.x * sampled(vec2<f32>(low.x, high.y)) + upper.x * sampled(high));
    return mix(light, spline, share);
}

@vertex
fn cover(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(vec2<f32>(f32(corner & 1u), f32(corner >> 1u)) * 2.0 - 1.0, 0.0, 1.0);
}

@fragment
fn fill() -> @location(0) vec4<f32> {
    return vec4<f32>(grey, grey, grey, 1.0);
}

// IEC 61966-2-1.
fn srgb(linear: vec3<f32>) -> vec3<f32> {
    let inside = clamp(linear, vec3<f32>(0.0), vec3<f32>(1.0));
    let high = 1.055 * pow(inside, vec3<f32>(1.0 / 2.4)) - 0.055;
    return select(high, 12.92 * inside, inside <= vec3<f32>(0.0031308));
}

fn linear(encoded_light: vec3<f32>) -> vec3<f32> {
    let high = pow((encoded_light + 0.055) / 1.055, vec3<f32>(2.4));
    return select(high, encoded_light / 12.92, encoded_light <= vec3<f32>(0.04045));
}

// Values that the target takes for linear light of the gamut.
fn sent(light: vec3<f32>) -> vec3<f32> {
    if !foreign {
        if encoded {
            return srgb(light);
        }
        return light;
    }
    let side = f32(textureDimensions(cube).x);
    // Nodes are in the middle of their texels.
    let at = (srgb(light) * (side - 1.0) + 0.5) / side;
    let own = textureSampleLevel(cube, smooth_sampler, at, 0.0).rgb;
    if encoded {
        return own;
    }
    return linear(own);
}

// Distance from the edge of the board, pixels; negative within.
fn beyond(at: vec2<f32>) -> f32 {
    let half = 0.5 * place.sides;
    let p = at * place.sides - half;
    let lower = select(place.radii.x, place.radii.y, p.x > 0.0);
    let upper = select(place.radii.z, place.radii.w, p.x > 0.0);
    let radius = select(lower, upper, p.y > 0.0);
    let q = abs(p) - half + radius;
    return min(max(q.x, q.y), 0.0) + length(max(q, vec2<f32>(0.0))) - radius;
}

@fragment
fn show(in: Corner) -> @location(0) vec4<f32> {
    var light = magnified(in.at);
    if place.spread.x > 0.0 {
        let s = place.spread;
        light = 0.25 * (sampled(in.at - s) + sampled(in.at + s)
            + sampled(in.at + vec2<f32>(s.x, -s.y)) + sampled(in.at + vec2<f32>(-s.x, s.y)));
    }
    let inner = clamp(min(in.at, 1.0 - in.at) * place.sides + 0.5, vec2<f32>(0.0), vec2<f32>(1.0));
    if place.shade.x == 0.0 {
        let cover = inner.x * inner.y;
        return vec4<f32>(sent(light) * cover, cover);
    }
    // A board: rounded, with a rim, and a shadow to the lower right.
    let edge = beyond(in.at);
    let cover = clamp(0.5 - edge, 0.0, 1.0);
    let rim = mix(0.72, 1.0, smoothstep(0.0, 2.5, -edge));
    let aside = vec2<f32>(0.3, -0.3) * place.shade.x / max(place.sides, vec2<f32>(1.0));
    let away = smoothstep(-0.5 * place.shade.x, place.shade.x, beyond(in.at - aside));
    let shadow = place.shade.y * (1.0 - away);
    return vec4<f32>(sent(light * rim) * cover, cover + (1.0 - cover) * shadow);
}
