// Each texel gets what its cells hold more, or less, than it lent them; strips over the canvas are noted, so that they
// are filled again.

@compute @workgroup_size(64)
fn give_back(@builtin(global_invocation_id) id: vec3<u32>) {
    let texel = id.x;
    if texel >= texels() || atomicLoad(&asks[texel]) == 0u {
        return;
    }
    atomicStore(&asks[texel], 0u);
    for (var paint = 0u; paint < step.planes; paint++) {
        let change = change_of(paint) + texel;
        load[film_of(paint) + texel] += atomicLoad(&asks[change]);
        atomicStore(&asks[change], 0u);
    }
    if atomicLoad(&stats[stat(TOUCHED)]) > atomicLoad(&stats[stat(BEFORE)]) {
        atomicStore(&asks[touch_of(texel / TEXELS_PER_STRIP)], 1u);
    }
}
