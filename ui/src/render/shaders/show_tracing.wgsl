// A picture thrown on a surface that is drawn already: what is there is multiplied by its light.

struct Place {
    // Pixels of the view times their depth: the picture's lower left corner, and its sides from there.
    corner: vec2<f32>,
    right: vec2<f32>,
    up: vec2<f32>,
    view: vec2<f32>,
    // Depth of the corner, and what the sides add to it; 1 is that of the desk.
    depth: vec4<f32>,
    // Opacity of the picture, 0 to 1.
    strength: f32,
    pad: f32,
}

// True if the target takes encoded values; one that encodes them in hardware takes linear light.
override encoded: bool = true;

@group(0) @binding(0) var<uniform> place: Place;
@group(0) @binding(1) var picture: texture_2d<f32>;
@group(0) @binding(2) var smooth_sampler: sampler;

struct Corner {
    @builtin(position) position: vec4<f32>,
    // From the picture's upper left corner, in shares of it.
    @location(0) at: vec2<f32>,
}

@vertex
fn lay(@builtin(vertex_index) corner: u32) -> Corner {
    let unit = vec2<f32>(f32(corner & 1u), f32(corner >> 1u));
    let pixel = place.corner + unit.x * place.right + unit.y * place.up;
    let depth = dot(place.depth.xyz, vec3<f32>(1.0, unit));
    let clip = pixel / place.view * vec2<f32>(2.0, -2.0) + depth * vec2<f32>(-1.0, 1.0);
    return Corner(vec4<f32>(clip, 0.0, depth), vec2<f32>(unit.x, 1.0 - unit.y));
}

// IEC 61966-2-1.
fn srgb(linear: vec3<f32>) -> vec3<f32> {
    let high = 1.055 * pow(linear, vec3<f32>(1.0 / 2.4)) - 0.055;
    return select(high, 12.92 * linear, linear <= vec3<f32>(0.0031308));
}

// The factor on the light of the surface. The encoding is nearly a power, so the product of encoded values is nearly
// the encoded product.
@fragment
fn show(in: Corner) -> @location(0) vec4<f32> {
    let light = textureSample(picture, smooth_sampler, in.at).rgb;
    let factor = mix(vec3<f32>(1.0), light, place.strength);
    if encoded {
        return vec4<f32>(srgb(factor), 1.0);
    }
    return vec4<f32>(factor, 1.0);
}
