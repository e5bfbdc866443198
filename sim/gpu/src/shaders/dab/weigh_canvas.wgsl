// How high paint stands where the step may touch it (`Lying` of maulstick-model); nothing is drawn yet.

@compute @workgroup_size(256)
fn weigh_canvas(@builtin(global_invocation_id) id: vec3<u32>) {
    let i = id.x;
    if i >= cells() {
        return;
    }
    atomicStore(&keys[i], NONE);
    atomicStore(&keys[cells() + i], 0u);
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
