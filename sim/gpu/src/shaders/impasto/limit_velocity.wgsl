// Slows what leaves a cell through both faces of an axis to what it holds.

// Through the face ahead of a cell; beside the grid nothing moves.
fn through(at: vec2<i32>, axis: u32) -> f32 {
    if any(at < vec2(0)) || any(at >= vec2(i32(step.width), i32(step.height))) {
        return 0.0;
    }
    return wants[u32(at.y) * step.width + u32(at.x)][axis];
}

fn limited(at: vec2<i32>, axis: u32) -> f32 {
    let ahead = select(vec2(1, 0), vec2(0, 1), axis == 1u);
    let v = through(at, axis);
    var leaving = 0.0;
    if v > 0.0 {
        leaving = v - min(through(at - ahead, axis), 0.0);
    } else {
        leaving = max(through(at + ahead, axis), 0.0) - v;
    }
    return v / max(leaving, 1.0);
}

@compute @workgroup_size(256)
fn limit_velocity(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= cells() {
        return;
    }
    let at = vec2(i32(id.x % step.width), i32(id.x / step.width));
    faces[id.x] = vec2(limited(at, 0u), limited(at, 1u));
}
