// Reference of the advection's benchmark: copies half of the planes, and of their sum, from one buffer to the other.

override second: u32 = 0u;

@compute @workgroup_size(256)
fn copy_planes(@builtin(global_invocation_id) id: vec3<u32>) {
    let half = cells() * (1u + step.planes) / 2u;
    if id.x < half {
        let at = second * half + id.x;
        other[at] = planes[at];
    }
}
