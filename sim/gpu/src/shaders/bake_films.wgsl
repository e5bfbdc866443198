// Internal reflectance of films, a plane a wavelength.

@compute @workgroup_size(256)
fn bake_films(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(workgroup_id) group: vec3<u32>,
) {
    let tile = tiles[group.y];
    for (var quad = 0u; quad < quads; quad++) {
        let ratio = film(tile, id.x, quad);
        let reflectance = clamp(ratio.n / ratio.m, vec4(0.0), vec4(1.0));
        for (var i = 0u; i < 4u; i++) {
            let sample = 4u * quad + i;
            if sample < samples {
                out[(group.y * samples + sample) * CELLS + id.x] = reflectance[i];
            }
        }
    }
}
