// Removes the remaining divergence of a velocity by conjugate gradients with multigrid: Unified::project of
// maulstick-stokes. The residual is the field LACKING, z is ANSWER, and the residual's first three fields are
// direction, image and solution.

fn direction() -> u32 {
    return field(R);
}

fn image_of_direction() -> u32 {
    return field(R + 1u);
}

fn solution() -> u32 {
    return field(R + 2u);
}

// A place of the pressure that is no copy.
fn cell_of(group: u32, local: u32, k: u32) -> Spot {
    return inner(0u, (group * OWN + k) * 256u + local);
}

// Links of a cell with places that have no pressure of their own.
fn links_to_known(at: u32) -> f32 {
    let by = strides(0u);
    let links = links_of(0u, 3u, at);
    let unknown = part(0u, 3u, ACTIVE) + at;
    return sum_of(links.low * (vec3(1.0) - lower(by, unknown)) + links.high * (vec3(1.0) - upper(by, unknown)));
}

@compute @workgroup_size(256)
fn weigh_lacking(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    var sums = vec3(0.0);
    for (var k = 0u; k < OWN; k++) {
        let spot = cell_of(group.x, local, k);
        if !spot.is_one {
            continue;
        }
        fields[solution() + spot.place] = 0.0;
        fields[direction() + spot.place] = 0.0;
        let inverse = fields[part(0u, 3u, INVERSE) + spot.place];
        if inverse > 0.0 && spot.is_own {
            let is_known = links_to_known(spot.at) * inverse > 1e-6;
            sums += vec3(fields[field(LACKING) + spot.place], 1.0, select(0.0, 1.0, is_known));
        }
    }
    lanes[local] = sums.x;
    lanes[256u + local] = sums.y;
    lanes[512u + local] = sums.z;
    add_lanes(local, group.x, 0u, 3u);
}

// Removes the mean, which no pressure reduces where none is known.
@compute @workgroup_size(256)
fn level_lacking(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    var sum = 0.0;
    for (var k = 0u; k < OWN; k++) {
        let spot = cell_of(group.x, local, k);
        if !spot.is_one {
            continue;
        }
        let unknown = fields[part(0u, 3u, ACTIVE) + spot.place];
        let left = fields[field(LACKING) + spot.place] - unknown * fields[scalar(MEAN)];
        fields[field(LACKING) + spot.place] = left;
        sum += select(0.0, left * left, spot.is_own);
    }
    lanes[local] = sum;
    add_lanes(local, group.x, NORM_ROW, 1u);
}

@compute @workgroup_size(256)
fn multiply_answer(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    var sum = 0.0;
    for (var k = 0u; k < OWN; k++) {
        let spot = cell_of(group.x, local, k);
        if spot.is_one && spot.is_own {
            sum += fields[field(LACKING) + spot.place] * fields[field(ANSWER) + spot.place];
        }
    }
    lanes[local] = sum;
    add_lanes(local, group.x, 0u, 1u);
}

@compute @workgroup_size(256)
fn turn_direction(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let spot = inner(0u, number_of(group, local));
    if spot.is_one {
        let at = direction() + spot.place;
        fields[at] = fields[scalar(TURN)] * fields[at] + fields[field(ANSWER) + spot.place];
    }
}

@compute @workgroup_size(256)
fn bend_direction(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    var sum = 0.0;
    for (var k = 0u; k < OWN; k++) {
        let spot = cell_of(group.x, local, k);
        if !spot.is_one {
            continue;
        }
        var value = 0.0;
        if fields[part(0u, 3u, INVERSE) + spot.place] > 0.0 {
            let by = strides(0u);
            let p = direction() + spot.at;
            let own = vec3(fields[p]);
            let links = links_of(0u, 3u, spot.at);
            value = sum_of(links.low * (own - lower(by, p)) + links.high * (own - upper(by, p)));
        }
        fields[image_of_direction() + spot.place] = value;
        sum += select(0.0, value * fields[direction() + spot.place], spot.is_own);
    }
    lanes[local] = sum;
    add_lanes(local, group.x, 0u, 1u);
}

@compute @workgroup_size(256)
fn follow_direction(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let reach = fields[scalar(REACH)];
    var sum = 0.0;
    for (var k = 0u; k < OWN; k++) {
        let spot = cell_of(group.x, local, k);
        if !spot.is_one {
            continue;
        }
        var left = fields[field(LACKING) + spot.place];
        if reach > 0.0 {
            left -= reach * fields[image_of_direction() + spot.place];
            fields[field(LACKING) + spot.place] = left;
            fields[solution() + spot.place] += reach * fields[direction() + spot.place];
        }
        sum += select(0.0, left * left, spot.is_own);
    }
    lanes[local] = sum;
    add_lanes(local, group.x, NORM_ROW, 1u);
}

// Adds the solution to velocities and pressure.
@compute @workgroup_size(256)
fn correct_flow(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let spot = inner(0u, number_of(group, local));
    if !spot.is_one {
        return;
    }
    let component = group.z;
    let phi = solution() + spot.at;
    if component == 3u {
        fields[field(X + 3u) + spot.place] += window.alpha * fields[phi];
        return;
    }
    let area = fields[field(AREA + component) + spot.place];
    if area > 0.0 {
        let heft = fields[field(MASS + component) + spot.place] + fields[scalar(WALL)];
        let rise = fields[phi] - fields[phi - strides(0u)[component]];
        fields[field(X + component) + spot.place] -= area / heft * rise;
    }
}
