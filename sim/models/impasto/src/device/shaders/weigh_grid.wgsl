// Paint on each cell of the grid, and its height where it may be touched.

@compute @workgroup_size(256)
fn weigh_grid(@builtin(global_invocation_id) id: vec3<u32>) {
    let i = id.x;
    if i >= cells() {
        return;
    }
    let at = vec2(i % step.width, i / step.width);
    let cell = cell_of(at.x, at.y);
    var total = 0.0;
    for (var paint = 0u; paint < step.planes; paint++) {
        total += planes[paint * step.plane + cell];
    }
    var thinner = 0.0;
    if step.thinner != NONE && total > 0.0 {
        thinner = planes[step.thinner * step.plane + cell] / total;
    }
    totals[i] = total;
    totals[2u * cells() + i] = base[cell];
    totals[3u * cells() + i] = thinner;
    totals[4u * cells() + i] = base[step.plane + cell];
    atomicStore(&keys[i], NONE);
    atomicStore(&keys[cells() + i], 0u);
    raise(stat(FULLEST), bitcast<u32>(total));
    let touched = inside();
    if all(at >= touched.low) && all(at < touched.high) {
        let height = base[cell] + total * step.cells_per_quantum;
        raise(stat(TOP), bitcast<u32>(max(height, 0.0)));
    }
}
