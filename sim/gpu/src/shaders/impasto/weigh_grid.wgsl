// What lies on each cell of the grid, how high it stands, and how thick the films are.

@compute @workgroup_size(256)
fn weigh_grid(@builtin(global_invocation_id) id: vec3<u32>) {
    let i = id.x;
    if i < step.strips {
        var thickest = 0u;
        for (var k = 0u; k < ALONG; k++) {
            thickest = max(thickest, load[1u + i * ALONG + k]);
        }
        atomicStore(&asks[thickest_of(i)], thickest);
        atomicMax(&stats[stat(FILM)], thickest);
    }
    if i >= cells() {
        return;
    }
    let cell = cell_of(i % step.width, i / step.width);
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
    atomicStore(&keys[i], NONE);
    let height = base[cell] + total * step.cells_per_quantum;
    atomicMax(&stats[stat(TOP)], bitcast<u32>(max(height, 0.0)));
    atomicMax(&stats[stat(FULLEST)], bitcast<u32>(total));
}
