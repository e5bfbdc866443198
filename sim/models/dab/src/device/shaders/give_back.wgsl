// Returns the cells' quanta to their texels, before the head is drawn anew. An invocation has one.

@compute @workgroup_size(16)
fn give_back(@builtin(global_invocation_id) id: vec3<u32>) {
    give_back_to(id.x);
}
