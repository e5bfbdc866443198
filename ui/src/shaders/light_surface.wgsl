// Lights a surface: takes unlit colour, gloss and height, gives linear colour within the gamut.
//
// The formula is that of maulstick_optics::light, term by term, and the clamp that of
// maulstick_optics::colour; a test compares them. A pixel of the target is a cell, row 0 the lowest.

struct Lamp {
    toward: vec3<f32>,
    intensity: f32,
    half: vec3<f32>,
    peak: f32,
    flat: f32,
    cell_m: f32,
}

// Share of the light that comes from all around.
override ambient: f32;
// Exponent of the highlight, as a power of two. No uniform: a loop to one makes some drivers compile
// the shader anew for every draw.
override sharpness: u32;

@group(0) @binding(0) var<uniform> lamp: Lamp;
// Linear red, green, blue, and gloss.
@group(0) @binding(1) var colours: texture_2d<f32>;
// m.
@group(0) @binding(2) var heights: texture_2d<f32>;

@vertex
fn cover(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4<f32> {
    // One triangle over the whole target; the scissor says which cells.
    let x = f32(i32(corner & 1u) * 4 - 1);
    let y = f32(i32(corner >> 1u) * 4 - 1);
    return vec4<f32>(x, y, 0.0, 1.0);
}

// dh/dx and dh/dy: central differences, one-sided at the border.
fn slope(cell: vec2<i32>) -> vec2<f32> {
    let last = vec2<i32>(textureDimensions(heights)) - 1;
    let low = max(cell - 1, vec2<i32>(0));
    let high = min(cell + 1, last);
    let rise = vec2<f32>(
        textureLoad(heights, vec2<i32>(high.x, cell.y), 0).r
            - textureLoad(heights, vec2<i32>(low.x, cell.y), 0).r,
        textureLoad(heights, vec2<i32>(cell.x, high.y), 0).r
            - textureLoad(heights, vec2<i32>(cell.x, low.y), 0).r,
    );
    return rise / (vec2<f32>(max(high - low, vec2<i32>(1))) * lamp.cell_m);
}

fn sharpened(x: f32) -> f32 {
    var power = max(x, 0.0);
    for (var i = 0u; i < sharpness; i += 1u) {
        power *= power;
    }
    return power;
}

fn lit(unlit: vec3<f32>, gloss: f32, rise: vec2<f32>) -> vec3<f32> {
    let n = vec3<f32>(-rise, 1.0) / sqrt(dot(rise, rise) + 1.0);
    let incidence = max(dot(n, lamp.toward), 0.0) / lamp.toward.z;
    let diffuse = ambient + (1.0 - ambient) * incidence;
    let lobe = max(sharpened(dot(n, lamp.half)) - lamp.flat, 0.0);
    let highlight = gloss * lamp.peak * lobe * incidence;
    return (diffuse * unlit + highlight) * lamp.intensity;
}

fn clamp_chromaticity(rgb: vec3<f32>) -> vec3<f32> {
    let least = min(rgb.r, min(rgb.g, rgb.b));
    if least >= 0.0 {
        return rgb;
    }
    let sum = rgb.r + rgb.g + rgb.b;
    if sum <= 0.0 {
        return vec3<f32>(0.0);
    }
    let third = 1.0 / 3.0;
    let t = third / (third - least / sum);
    return max((third + t * (rgb / sum - third)) * sum, vec3<f32>(0.0));
}

@fragment
fn light(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let cell = vec2<i32>(at.xy);
    let texel = textureLoad(colours, cell, 0);
    return vec4<f32>(clamp_chromaticity(lit(texel.rgb, texel.a, slope(cell))), 1.0);
}
