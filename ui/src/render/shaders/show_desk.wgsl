// Shows what was drawn of the desk before, pixel by pixel.

@group(0) @binding(0) var desk: texture_2d<f32>;

struct Corner {
    @builtin(position) position: vec4<f32>,
    // From the upper left corner, in shares of the picture.
    @location(0) at: vec2<f32>,
}

@vertex
fn cover(@builtin(vertex_index) corner: u32) -> Corner {
    let at = vec2<f32>(f32(corner & 1u), f32(corner >> 1u));
    return Corner(vec4<f32>(at * vec2<f32>(2.0, -2.0) + vec2<f32>(-1.0, 1.0), 0.0, 1.0), at);
}

@fragment
fn copy(in: Corner) -> @location(0) vec4<f32> {
    let size = vec2<f32>(textureDimensions(desk));
    return textureLoad(desk, vec2<i32>(min(in.at * size, size - 1.0)), 0);
}
