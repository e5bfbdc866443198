// Cells reached by the parts of the head below the greatest height of paint so far: low_bounds of head.rs in
// maulstick-model. An invocation tests one segment of a strip, or a face of the skin.

// Widens the bounds; places are columns or rows of the grid.
fn widen(low: vec2<f32>, high: vec2<f32>) {
    let offset = vec2(step.offset_x, step.offset_y);
    let least = clamp(floor(low) - offset, vec2(-AWAY), vec2(AWAY));
    let most = clamp(ceil(high) - offset, vec2(-AWAY), vec2(AWAY));
    for (var axis = 0u; axis < 2u; axis++) {
        atomicMax(&stats[stat(LEAST) + axis], u32(BIAS - i32(least[axis])));
        atomicMax(&stats[stat(MOST) + axis], u32(BIAS + i32(most[axis])));
    }
}

fn bound_face(face: u32, height: f32) {
    let skin = step.poses + 5u * STATIONS * step.strips + 2u * step.strips;
    var low = vec2(1e9);
    var high = vec2(-1e9);
    var is_low = false;
    for (var i = 0u; i < 4u; i++) {
        let point = skin + head[4u * face + i];
        let at = vec2(poses[point], poses[point + step.vertices]);
        low = min(low, at);
        high = max(high, at);
        is_low = is_low || poses[point + 2u * step.vertices] < height;
    }
    if is_low {
        widen(low, high);
    }
}

@compute @workgroup_size(64)
fn bound_head(@builtin(global_invocation_id) id: vec3<u32>) {
    let film = f32(atomicLoad(&stats[stat(FILM)])) * step.film_cells_per_quantum;
    let ever = bitcast<f32>(atomicLoad(&stats[TOP_EVER])) * step.cells_per_quantum;
    let height = ever + film + step.reach;
    if id.x < step.faces {
        bound_face(id.x, height);
    }
    let triangles = 2u * step.faces;
    let strip = (id.x - triangles) / (STATIONS - 1u);
    if id.x < triangles || strip >= step.strips {
        return;
    }
    let count = STATIONS * step.strips;
    let station = (id.x - triangles) % (STATIONS - 1u);
    let a = step.poses + station * step.strips + strip;
    let b = a + step.strips;
    if min(poses[a + 2u * count], poses[b + 2u * count]) < height {
        let p = vec2(poses[a], poses[a + count]);
        let q = vec2(poses[b], poses[b + count]);
        widen(min(p, q), max(p, q));
    }
}
