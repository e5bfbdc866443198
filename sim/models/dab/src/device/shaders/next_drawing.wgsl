// Resets the drawing of the head.

@compute @workgroup_size(256)
fn next_drawing(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x == 0u {
        for (var axis = 0u; axis < 2u; axis++) {
            atomicStore(&stats[stat(LEAST_TOUCHED) + axis], 0u);
            atomicStore(&stats[stat(MOST_TOUCHED) + axis], 0u);
        }
        atomicStore(&stats[stat(BEFORE)], atomicLoad(&stats[stat(TOUCHED)]));
    }
    if id.x < cells() {
        clear_cell(id.x, cells());
    }
}
