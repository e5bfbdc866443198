// A V-cycle, stage by stage on the fine levels, and as a whole from the first level that one workgroup does as fast.

fn level_spot(level: u32, group: vec3<u32>, local: u32) -> Spot {
    return inner(level, number_of(group, local));
}

@compute @workgroup_size(256)
fn begin_cycle(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let spot = level_spot(call.level, group, local);
    if spot.is_one {
        begin_at(call.level, call.first + group.z, spot, FIRST, SECOND);
    }
}

@compute @workgroup_size(256)
fn leave_residual(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let spot = level_spot(call.level, group, local);
    if spot.is_one {
        leave_at(call.level, call.first + group.z, spot);
    }
}

@compute @workgroup_size(256)
fn restrict_residual(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let spot = level_spot(call.level + 1u, group, local);
    if spot.is_one {
        restrict_at(call.level, call.first + group.z, spot);
    }
}

@compute @workgroup_size(256)
fn prolong_solution(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let spot = level_spot(call.level, group, local);
    if spot.is_one {
        prolong_at(call.level, call.first + group.z, spot);
    }
}

// Mode 0: from the solution into the spare field; 1: back.
@compute @workgroup_size(256)
fn relax_solution(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let level = call.level;
    let component = call.first + group.z;
    let spot = level_spot(level, group, local);
    if spot.is_one {
        let x = solution_of(level, component);
        let spare = part(level, component, SPARE);
        let is_back = call.mode == 1u;
        relax_at(level, component, spot, select(SECOND, FIRST, is_back), select(x, spare, is_back), select(spare, x, is_back));
    }
}

// Factors of the coarsest grid's steps: inverses of the roots of the Chebyshev polynomial on [1/50, 2], large and small in turn
// so that rounding stays small.
fn omega_of(step: u32) -> f32 {
    var omegas = array<f32, 16>(
        0.50119466, 40.37611, 0.9033122, 1.0953346, 0.56329131, 4.0863085, 0.61048222, 2.6181393,
        0.51088937, 15.967027, 0.77078311, 1.3838567, 0.53103867, 7.3047114, 0.67719352, 1.8405453,
    );
    return omegas[step];
}

// All levels from the call's on, by one workgroup a component.
@compute @workgroup_size(256)
fn cycle_rest(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let component = call.first + group.z;
    let last = window.count - 1u;
    for (var level = call.level; level < last; level++) {
        let count = inner_count(level);
        for (var id = local; id < count; id += 256u) {
            begin_at(level, component, inner(level, id), FIRST, SECOND);
        }
        storageBarrier();
        for (var id = local; id < count; id += 256u) {
            leave_at(level, component, inner(level, id));
        }
        storageBarrier();
        let coarse = inner_count(level + 1u);
        for (var id = local; id < coarse; id += 256u) {
            restrict_at(level, component, inner(level + 1u, id));
        }
        storageBarrier();
    }
    let fewest = inner_count(last);
    let solution = solution_of(last, component);
    let spare = part(last, component, SPARE);
    for (var id = local; id < fewest; id += 256u) {
        begin_at(last, component, inner(last, id), omega_of(0u), omega_of(1u));
    }
    storageBarrier();
    for (var step = 2u; step < COARSEST_STEPS; step++) {
        let is_back = (step & 1u) == 1u;
        let source = select(solution, spare, is_back);
        let into = select(spare, solution, is_back);
        for (var id = local; id < fewest; id += 256u) {
            relax_at(last, component, inner(last, id), omega_of(step), source, into);
        }
        storageBarrier();
    }
    for (var up = last; up > call.level; up--) {
        let level = up - 1u;
        let count = inner_count(level);
        let x = solution_of(level, component);
        let room = part(level, component, SPARE);
        for (var id = local; id < count; id += 256u) {
            prolong_at(level, component, inner(level, id));
        }
        storageBarrier();
        for (var id = local; id < count; id += 256u) {
            relax_at(level, component, inner(level, id), SECOND, x, room);
        }
        storageBarrier();
        for (var id = local; id < count; id += 256u) {
            relax_at(level, component, inner(level, id), FIRST, room, x);
        }
        storageBarrier();
    }
}
