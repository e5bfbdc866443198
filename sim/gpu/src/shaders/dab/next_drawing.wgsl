// The head is drawn anew: it is over nothing yet.

@compute @workgroup_size(1)
fn next_drawing() {
    for (var axis = 0u; axis < 2u; axis++) {
        atomicStore(&stats[stat(LEAST_TOUCHED) + axis], 0u);
        atomicStore(&stats[stat(MOST_TOUCHED) + axis], 0u);
    }
    atomicStore(&stats[stat(BEFORE)], atomicLoad(&stats[stat(TOUCHED)]));
}
