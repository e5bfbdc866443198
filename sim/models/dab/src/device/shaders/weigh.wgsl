// Thickness of the films on the brush, and height of paint where the step may touch it (`Lying` of maulstick-model).
// Nothing is drawn yet.

// Opens the whole grid to drawing.
fn open_grid() {
    for (var axis = 0u; axis < 2u; axis++) {
        atomicStore(&stats[stat(LEAST) + axis], u32(BIAS));
        atomicStore(&stats[stat(MOST) + axis], u32(2 * BIAS));
    }
}

@compute @workgroup_size(256)
fn weigh(@builtin(global_invocation_id) id: vec3<u32>) {
    let i = id.x;
    weigh_strip(i);
    if i == 0u {
        open_grid();
    }
    if i >= cells() {
        return;
    }
    if i < blend_of.first_drawn {
        clear_cell(i, blend_of.first_drawn);
    }
    let at = vec2(i % step.width, i / step.width);
    if any(vec2<i32>(at) < blend_of.low) || any(vec2<i32>(at) >= blend_of.high) {
        return;
    }
    let cell = cell_of(at.x, at.y);
    var lies = 0.0;
    for (var paint = 0u; paint < step.planes; paint++) {
        lies += planes[paint * step.plane + cell];
    }
    let height = base[cell] + lies * step.cells_per_quantum;
    raise(stat(TOP), bitcast<u32>(max(height, 0.0)));
}
