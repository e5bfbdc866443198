// How thick the films on the brush are.

@compute @workgroup_size(64)
fn weigh_films(@builtin(global_invocation_id) id: vec3<u32>) {
    let strip = id.x;
    if strip >= step.strips {
        return;
    }
    var thickest = 0u;
    for (var k = 0u; k < TEXELS_PER_STRIP; k++) {
        thickest = max(thickest, load[1u + strip * TEXELS_PER_STRIP + k]);
    }
    atomicStore(&asks[thickest_of(strip)], thickest);
    atomicMax(&stats[stat(FILM)], thickest);
}
