// How many workgroups the blends of a drawing have: as many as cover what the head is over, none where it is over
// nothing.

@compute @workgroup_size(1)
fn plan_blends() {
    var groups_of = vec4(0u, 0u, 1u, 0u);
    var texel_groups = 0u;
    for (var axis = 0u; axis < 2u; axis++) {
        let least = atomicLoad(&stats[stat(LEAST_TOUCHED) + axis]);
        let most = atomicLoad(&stats[stat(MOST_TOUCHED) + axis]);
        if most > 0u {
            let low = u32(BIAS) - least;
            atomicStore(&stats[stat(REACH) + axis], low);
            atomicStore(&stats[stat(REACH_SIZE) + axis], most - low);
            groups_of[axis] = (most - low + 15u) / 16u;
            texel_groups = (texels() + 63u) / 64u;
        }
        // The next drawing of the step begins anew.
        atomicStore(&stats[stat(LEAST_TOUCHED) + axis], 0u);
        atomicStore(&stats[stat(MOST_TOUCHED) + axis], 0u);
        atomicStore(&stats[stat(LEAST) + axis], 0u);
        atomicStore(&stats[stat(MOST) + axis], 0u);
    }
    atomicStore(&stats[stat(BEFORE)], atomicLoad(&stats[stat(TOUCHED)]));
    groups[0] = groups_of;
    groups[1] = vec4(texel_groups, 1u, 1u, 0u);
}
