// Thickness of the films on the brush.

@compute @workgroup_size(64)
fn weigh_films(@builtin(global_invocation_id) id: vec3<u32>) {
    weigh_strip(id.x);
}
