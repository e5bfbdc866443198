// Linear sRGB of films through the surface, three planes a tile.

// The surface: the share reflected back from inside, and the share that leaves, (1−k₁)(1−k₂).
override k2: f32 = 0.65;
override open: f32 = 0.3395;

@compute @workgroup_size(256)
fn shade_films(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(workgroup_id) group: vec3<u32>,
) {
    let tile = tiles[group.y];
    var rgb = vec3(0.0);
    for (var quad = 0u; quad < quads; quad++) {
        let ratio = film(tile, id.x, quad);
        let leaving = open * ratio.n / (ratio.m - k2 * ratio.n);
        let at = 3u * quad;
        rgb += vec3(
            dot(optics[at], leaving),
            dot(optics[at + 1u], leaving),
            dot(optics[at + 2u], leaving),
        );
    }
    let at = 3u * CELLS * group.y + id.x;
    out[at] = rgb.x;
    out[at + CELLS] = rgb.y;
    out[at + 2u * CELLS] = rgb.z;
}
