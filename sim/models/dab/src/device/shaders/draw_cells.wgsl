// The head over each cell of the grid (`Drawn` of maulstick-model), and the number of cells of each texel.

@compute @workgroup_size(256)
fn draw_cells(@builtin(global_invocation_id) id: vec3<u32>) {
    let i = id.x;
    if i >= cells() {
        return;
    }
    drawn[i].texel = NONE;
    let key = atomicLoad(&keys[i]);
    if key == NONE {
        return;
    }
    let at = vec2(i % step.width, i / step.width);
    let fragment = fragment_of(key & ((1u << step.bits) - 1u), at.x, at.y);
    let cover = covered(i);
    let way = sqrt(dot(fragment.moved, fragment.moved)) * blend_of.by_travel + blend_of.evenly;
    let rate = 1.0 - decay(step.ln_kept * way);
    drawn[i] = Drawn(
        fragment.texel, cover, rate * cover, way * cover, fragment.z, fragment.off, vec2(0.0),
    );
    atomicAdd(&asks[fragment.texel], 1u);
    note_place(at);
}
