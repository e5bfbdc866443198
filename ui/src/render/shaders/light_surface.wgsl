// Lights a surface: takes unlit colour, gloss and height, gives linear light within the gamut of the
// display.
//
// The formulas are those of maulstick_optics::light, its shadows, and maulstick_optics::gamut, term by
// term; a test compares them. A pixel of the target is a cell, lower rows first.

const TAPS: u32 = 16u;
const DIRECTIONS: u32 = 8u;
const RINGS: u32 = 5u;

struct Lamp {
    toward: vec3<f32>,
    intensity: f32,
    // From its middle to its upper edge.
    upper: vec3<f32>,
    relief: f32,
    // Slope that mirrors it to the viewer.
    mirror: vec2<f32>,
    peak: f32,
    // Square of the tangent of its angle from straight above.
    graze: f32,
    cell_m: f32,
    rise: f32,
    sharpness: f32,
    softness: f32,
    // The lamp in the plane of its direction: across the surface and out of it.
    along: vec2<f32>,
    // The light's own colour, and what makes an albedo of an unlit one.
    colour: vec3<f32>,
    albedo: vec3<f32>,
    // 1 where the gloss mirrors the environment map, 0 in an even room.
    mapped: f32,
    // The two cells of each place on the way to the lamp; share of the second, and the run to it.
    cells: array<vec4<i32>, TAPS>,
    runs: array<vec4<f32>, TAPS>,
    // Unit vectors of the directions of the sky; columns, rows and steepness of the places in each.
    ways: array<vec4<f32>, DIRECTIONS>,
    sky: array<vec4<f32>, 40>,
}

struct Rows {
    x: vec4<f32>,
    y: vec4<f32>,
    z: vec4<f32>,
}

struct Gamut {
    from_working: Rows,
    to_cones: Rows,
    from_cones: Rows,
    to_lab: Rows,
    from_lab: Rows,
}

// The cells of the surface that the textures hold: cell c at c modulo their size.
struct Window {
    low: vec2<i32>,
    last: vec2<i32>,
}

// Share of the light that comes from all around.
override ambient: f32;
// Share of the light that the surface itself reflects, and how much dimmer the room is below.
override surface: f32;
override dimming: f32;
// Roughness of the glossiest film, and of the most matte ground.
override smoothest: f32;
// Roughness of the sharpest level of an environment map, and its steps from texel to texel.
override sharpest: f32;
override steps: u32;
override roughest: f32;
// Halvings of the search for the gamut's edge. No uniform: a loop to one makes some drivers compile the shader again
// for every draw.
override halvings: u32;
// Least denominator of a horizon.
override least: f32;
// Share of the way to the edge of the gamut that is left as it is; how much lightness goes for colour.
override knee: f32;
override for_colour: f32;
// True if colours are moved softly into the gamut.
override soft: bool;

@group(0) @binding(0) var<uniform> lamp: Lamp;
// Linear red, green, blue, and gloss.
@group(0) @binding(1) var colours: texture_2d<f32>;
// m.
@group(0) @binding(2) var heights: texture_2d<f32>;
@group(0) @binding(3) var<uniform> gamut: Gamut;
@group(0) @binding(4) var<uniform> window: Window;
// Levels of an environment map above each other.
@group(0) @binding(5) var environment: texture_2d<f32>;

@vertex
fn cover(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4<f32> {
    // One triangle over the whole target; the scissor says which cells.
    let x = f32(i32(corner & 1u) * 4 - 1);
    let y = f32(i32(corner >> 1u) * 4 - 1);
    return vec4<f32>(x, y, 0.0, 1.0);
}

// A place among the cells: which cell, and its texel.
struct Spot {
    cell: vec2<i32>,
    texel: vec2<i32>,
    size: vec2<i32>,
}

fn spot_of(texel: vec2<i32>) -> Spot {
    let size = vec2<i32>(textureDimensions(heights));
    // A window is no larger than the textures.
    let off = (texel - window.low) % size;
    return Spot(window.low + select(off, off + size, off < vec2<i32>(0)), texel, size);
}

// Height of a cell of the window, less than the size of the textures away.
fn height(spot: Spot, cell: vec2<i32>) -> f32 {
    let texel = spot.texel + (cell - spot.cell);
    let up = select(texel, texel + spot.size, texel < vec2<i32>(0));
    return textureLoad(heights, select(up, up - spot.size, up >= spot.size), 0).r;
}

// dh/dx and dh/dy: central differences, one-sided at the border.
fn slope(spot: Spot) -> vec2<f32> {
    let cell = spot.cell;
    let low = max(cell - 1, window.low);
    let high = min(cell + 1, window.last);
    let rise = vec2<f32>(
        height(spot, vec2<i32>(high.x, cell.y)) - height(spot, vec2<i32>(low.x, cell.y)),
        height(spot, vec2<i32>(cell.x, high.y)) - height(spot, vec2<i32>(cell.x, low.y)),
    );
    return rise / (vec2<f32>(max(high - low, vec2<i32>(1))) * lamp.cell_m);
}

// Share of the lamp that the relief does not hide.
fn seen(spot: Spot) -> f32 {
    let own = height(spot, spot.cell);
    var horizon = -1.0;
    for (var k = 0u; k < TAPS; k += 1u) {
        let at = lamp.cells[k];
        let run = lamp.runs[k];
        let low = height(spot, clamp(spot.cell + at.xy, window.low, window.last));
        let high = height(spot, clamp(spot.cell + at.zw, window.low, window.last));
        let rise = (low - own + (high - low) * run.x) * lamp.rise;
        let above = rise * lamp.along.x - run.z;
        let ahead = rise * lamp.along.y + run.y;
        horizon = max(horizon, above / max(ahead, least) * lamp.sharpness);
    }
    let u = 0.5 - 0.5 * min(horizon, 1.0);
    return u * u * (3.0 - 2.0 * u);
}

// Covariance of the slopes within a cell: xx, xy, yy.
fn spread(spot: Spot) -> vec3<f32> {
    let low = max(spot.cell - 1, window.low);
    let high = min(spot.cell + 1, window.last);
    let cell = spot.cell;
    let middle = 2.0 * height(spot, cell);
    let xx = height(spot, vec2<i32>(low.x, cell.y)) + height(spot, vec2<i32>(high.x, cell.y)) - middle;
    let yy = height(spot, vec2<i32>(cell.x, low.y)) + height(spot, vec2<i32>(cell.x, high.y)) - middle;
    let xy = 0.25 * (height(spot, high) + height(spot, low)
        - height(spot, vec2<i32>(low.x, high.y)) - height(spot, vec2<i32>(high.x, low.y)));
    let scale = 0.5 / (lamp.cell_m * lamp.cell_m);
    return vec3<f32>(xx * xx + xy * xy, (xx + yy) * xy, yy * yy + xy * xy) * scale;
}

// Light that comes to a facet from one direction over a horizon.
fn above(tangent: f32, facing: f32, up: f32) -> f32 {
    let square = 1.0 / (1.0 + tangent * tangent);
    let cosine = sqrt(square);
    let sine = tangent * cosine;
    let polynomial = 1.5707288 + sine * (-0.2121144 + sine * (0.074261 - 0.0187293 * sine));
    let from_zenith = sqrt(max(1.0 - sine, 0.0)) * polynomial;
    return 0.5 * (facing * (from_zenith - sine * cosine) + up * square);
}

// Share of the light from all around that comes to a facet of normal `n`.
fn open_sky(spot: Spot, n: vec3<f32>) -> f32 {
    let own = height(spot, spot.cell);
    var sum = 0.0;
    for (var way = 0u; way < DIRECTIONS; way += 1u) {
        var highest = 0.0;
        for (var ring = 0u; ring < RINGS; ring += 1u) {
            let tap = lamp.sky[way * RINGS + ring];
            let at = clamp(spot.cell + vec2<i32>(tap.xy), window.low, window.last);
            highest = max(highest, (height(spot, at) - own) * tap.z);
        }
        sum += above(highest, dot(n.xy, lamp.ways[way].xy), n.z);
    }
    return clamp(sum * (2.0 / f32(DIRECTIONS)), 0.0, 1.0);
}

// Light that it receives, with the light that surroundings of these albedos throw back.
fn bounced(open: f32, albedo: vec3<f32>) -> vec3<f32> {
    let a = 2.0404 * albedo - 0.3324;
    let b = -4.7951 * albedo + 0.6417;
    let c = 2.7552 * albedo + 0.6903;
    return min(max(((open * a + b) * open + c) * open, vec3<f32>(open)), vec3<f32>(1.0));
}

// GGX's density of slopes, times pi.
fn density(own: f32, covariance: vec3<f32>, off: vec2<f32>) -> f32 {
    let xx = own + 2.0 * covariance.x;
    let xy = 2.0 * covariance.y;
    let yy = own + 2.0 * covariance.z;
    let determinant = xx * yy - xy * xy;
    let far = off.x * off.x * yy - 2.0 * off.x * off.y * xy + off.y * off.y * xx;
    let tail = 1.0 + far / determinant;
    return 1.0 / (sqrt(determinant) * tail * tail);
}

// Bilinear interpolation of a level of the environment map.
fn between(level: u32, toward: vec2<f32>) -> vec3<f32> {
    let side = steps >> level;
    let at = clamp((0.5 * toward + 0.5) * f32(side), vec2<f32>(0.0), vec2<f32>(f32(side)));
    let low = min(vec2<u32>(at), vec2<u32>(side - 1u));
    let share = at - vec2<f32>(low);
    // Below it lie the sharper levels, each of one row more than it has steps.
    let first = low + vec2<u32>(0u, 2u * (steps - side) + level);
    let a = textureLoad(environment, first, 0).rgb;
    let b = textureLoad(environment, first + vec2<u32>(1u, 0u), 0).rgb;
    let c = textureLoad(environment, first + vec2<u32>(0u, 1u), 0).rgb;
    let d = textureLoad(environment, first + vec2<u32>(1u, 1u), 0).rgb;
    let lower = a + (b - a) * share.x;
    let upper = c + (d - c) * share.x;
    return lower + (upper - lower) * share.y;
}

// Radiance that facets about a slope mirror to a viewer straight above.
fn mirrored_map(rise: vec2<f32>, rough: f32) -> vec3<f32> {
    let toward = -rise / max(sqrt(dot(rise, rise)), 1.0);
    let times = rough / sharpest;
    let rougher = select(1.0 + 0.25 * times, 0.5 * times, times < 4.0);
    let place = clamp(select(rougher, times - 1.0, times < 2.0), 0.0, 3.0);
    let level = min(u32(place), 2u);
    let sharp = between(level, toward);
    return sharp + (between(level + 1u, toward) - sharp) * (place - f32(level));
}

fn lit(spot: Spot, unlit: vec3<f32>, gloss: f32) -> vec3<f32> {
    let rise = slope(spot) * lamp.relief;
    let n = vec3<f32>(-rise, 1.0) / sqrt(dot(rise, rise) + 1.0);
    let visible = seen(spot);
    let open = open_sky(spot, n);
    let facing = dot(n, lamp.toward) + (1.0 - visible) * dot(n, lamp.upper);
    let incidence = visible * max(facing, 0.0) / lamp.toward.z;
    let direct = (1.0 - ambient) * incidence + ambient * open;
    let dull = 1.0 - gloss;
    let rough = smoothest + (roughest - smoothest) * dull * dull;
    let own = rough * rough + 0.125 * lamp.softness * lamp.softness;
    let hidden = spread(spot) * (lamp.relief * lamp.relief);
    let flat = density(own, vec3<f32>(0.0), lamp.mirror);
    let more = max(density(own, hidden, lamp.mirror - rise) - flat, 0.0);
    let unmasked = 2.0 / (1.0 + sqrt(1.0 + rough * rough * lamp.graze));
    let pane = visible * lamp.peak * unmasked * more;
    let grazing = 1.0 - n.z;
    let twice = grazing * grazing;
    let mirrored = surface + (1.0 - surface) * twice * twice * grazing;
    var around = vec3<f32>(1.0 - dimming + dimming * (2.0 * n.z * n.z - 1.0));
    if lamp.mapped > 0.0 {
        around = mirrored_map(rise, sqrt(rough * rough + hidden.x + hidden.z));
    }
    let room = mirrored * open * open * around;
    let albedo = clamp(unlit * lamp.albedo, vec3<f32>(0.0), vec3<f32>(1.0));
    let diffuse = direct + (bounced(open, albedo) - open);
    return (diffuse * unlit + lamp.colour * (room + pane)) * lamp.intensity;
}

fn times(m: Rows, v: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(dot(m.x.xyz, v), dot(m.y.xyz, v), dot(m.z.xyz, v));
}

fn cube_root(x: vec3<f32>) -> vec3<f32> {
    let size = abs(x);
    var y = bitcast<vec3<f32>>(bitcast<vec3<u32>>(size) / 3u + 0x2a514067u);
    for (var i = 0u; i < 3u; i += 1u) {
        y = (2.0 * y + size / (y * y)) * (1.0 / 3.0);
    }
    return select(select(y, -y, x < vec3<f32>(0.0)), vec3<f32>(0.0), size < vec3<f32>(1e-30));
}

// A colour at a share of the way from a grey.
fn on_ray(grey: f32, way: vec3<f32>, share: f32) -> vec3<f32> {
    let root = grey + share * way;
    return times(gamut.from_cones, root * root * root);
}

fn outside(grey: f32, way: vec3<f32>, share: f32) -> f32 {
    let rgb = on_ray(grey, way, share);
    let off = max(-rgb, rgb - 1.0);
    return max(off.r, max(off.g, off.b));
}

fn edge(grey: f32, way: vec3<f32>) -> f32 {
    var low = 0.0;
    var high = 1.0 / knee;
    for (var i = 0u; i < halvings; i += 1u) {
        let middle = 0.5 * (low + high);
        let inside = outside(grey, way, middle) <= 0.0;
        low = select(low, middle, inside);
        high = select(middle, high, inside);
    }
    let inner = min(outside(grey, way, low), 0.0);
    let outer = max(outside(grey, way, high), 1e-9);
    return max(low + (high - low) * (-inner / (outer - inner)), 1e-6);
}

fn softly(rgb: vec3<f32>) -> vec3<f32> {
    if !(max(rgb.r, max(rgb.g, rgb.b)) > 0.0) {
        return vec3<f32>(0.0);
    }
    let lab = times(gamut.to_lab, cube_root(times(gamut.to_cones, rgb)));
    let from_middle = lab.x - 0.5;
    let side = select(1.0, -1.0, from_middle < 0.0);
    let e = 0.5 + abs(from_middle) + for_colour * sqrt(dot(lab.yz, lab.yz));
    let root = sqrt(max(e * e - 2.0 * abs(from_middle), 0.0));
    let grey = clamp(0.5 + 0.5 * side * (e - root), 0.0, 1.0);
    let way = lab.x - grey + vec3<f32>(
        dot(gamut.from_lab.x.yz, lab.yz),
        dot(gamut.from_lab.y.yz, lab.yz),
        dot(gamut.from_lab.z.yz, lab.yz),
    );
    if outside(grey, way, 1.0 / knee) <= 0.0 {
        return rgb;
    }
    let r = 1.0 / edge(grey, way);
    let z = clamp(r, knee, 2.0 - knee) - knee;
    let kept = (knee + z - z * z / (4.0 * (1.0 - knee))) / r;
    return clamp(on_ray(grey, way, min(kept, 1.0)), vec3<f32>(0.0), vec3<f32>(1.0));
}

fn clamp_chromaticity(rgb: vec3<f32>) -> vec3<f32> {
    let smallest = min(rgb.r, min(rgb.g, rgb.b));
    if smallest >= 0.0 {
        return rgb;
    }
    let sum = rgb.r + rgb.g + rgb.b;
    if sum <= 0.0 {
        return vec3<f32>(0.0);
    }
    let third = 1.0 / 3.0;
    let t = third / (third - smallest / sum);
    return max((third + t * (rgb / sum - third)) * sum, vec3<f32>(0.0));
}

fn mapped(working: vec3<f32>) -> vec3<f32> {
    let rgb = times(gamut.from_working, working);
    if soft {
        return softly(rgb);
    }
    return clamp(clamp_chromaticity(rgb), vec3<f32>(0.0), vec3<f32>(1.0));
}

@fragment
fn light(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let spot = spot_of(vec2<i32>(at.xy));
    let texel = textureLoad(colours, spot.texel, 0);
    let colour = lit(spot, texel.rgb, texel.a);
    return vec4<f32>(mapped(colour), 1.0);
}
