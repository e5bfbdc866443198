// Number of workgroups of the stages after the footprint: none where nothing is touched.

fn covering(cells: u32, each: u32) -> u32 {
    return (cells + each - 1u) / each;
}

// Adds to a sum of all steps, without other writers.
fn tally(sum: u32, which: u32) {
    let before = bitcast<f32>(atomicLoad(&stats[sum]));
    let more = f32(atomicLoad(&stats[stat(which)]));
    atomicStore(&stats[sum], bitcast<u32>(before + more));
}

@compute @workgroup_size(1)
fn plan_step() {
    let touched = atomicLoad(&stats[stat(TOUCHED)]);
    let steps = load[0];
    atomicStore(&stats[stat(STEPS)], steps);
    let top = bitcast<f32>(atomicLoad(&stats[stat(TOP)]));
    atomicMax(&stats[TOP_EVER], bitcast<u32>(top / step.cells_per_quantum));
    if touched == 0u {
        for (var i = 0u; i < 6u; i++) {
            groups[i] = vec4(0u);
        }
        return;
    }
    load[0] = steps + 1u;
    atomicAdd(&stats[0], touched);
    tally(1u, WET);
    tally(2u, THINNER);
    groups[0] = vec4(covering(cells(), 256u), 1u, 1u, 0u);
    groups[1] = vec4(covering(step.strips, 64u), 1u, 1u, 0u);
    groups[4] = select(vec4(0u), groups[0], step.push != 0u);
    groups[5] = vec4(covering(texels() / 2u, 64u), 1u, 1u, 0u);
    for (var second = 0u; second < 2u; second++) {
        var size = vec4(0u);
        if step.push != 0u {
            // A workgroup's first cells along the axis are only read.
            let tile = select(vec2(31u, 8u), vec2(32u, 7u), along_y(second, steps));
            size = vec4(covering(step.width, tile.x), covering(step.height, tile.y), 1u, 0u);
        }
        groups[2u + second] = size;
    }
}
