// The Stokes operator (operator.rs of maulstick-stokes), and the parts of the preconditioner beside its cycles.

// Force on a face across an axis by velocities and pressure that begin at `x`.
fn force(axis: u32, at: u32, x: u32) -> f32 {
    let free = fields[field(FREE + axis) + at];
    if free == 0.0 {
        return 0.0;
    }
    let by = strides(0u);
    let len = window.levels[0].len;
    let step = by[axis];
    let u = x + axis * len + at;
    let links = links_of(0u, axis, at);
    let own = vec3(fields[u]);
    let within = links.low * (own - lower(by, u)) + links.high * (own - upper(by, u));
    var stress = sum_of(within);
    let along = others(axis);
    for (var i = 0u; i < 2u; i++) {
        let other = along[i];
        let cross = field(CROSS + 3u - axis - other) + at;
        let v = x + other * len + at;
        let side = by[other];
        stress += fields[cross] * (fields[v] - fields[v - step])
            - fields[cross + side] * (fields[v + side] - fields[v + side - step]);
    }
    let p = x + 3u * len + at;
    let pushes = fields[field(AREA + axis) + at] * (fields[p] - fields[p - step]);
    return fields[part(0u, axis, INERTIA) + at] * fields[u] + stress + pushes;
}

// Outflow of a wet cell with velocities that begin at `x`.
fn outflow(at: u32, x: u32) -> f32 {
    if fields[field(WET) + at] == 0.0 {
        return 0.0;
    }
    let by = strides(0u);
    var sum = 0.0;
    for (var axis = 0u; axis < 3u; axis++) {
        let area = field(AREA + axis) + at;
        let u = x + axis * window.levels[0].len + at;
        sum += fields[area + by[axis]] * fields[u + by[axis]] - fields[area] * fields[u];
    }
    return sum;
}

// Mode 0: the image of a direction; 1: the first residual, b − A·x.
@compute @workgroup_size(256)
fn apply_operator(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let spot = inner(0u, number_of(group, local));
    if !spot.is_one {
        return;
    }
    let component = group.z;
    var value = 0.0;
    var is_unknown = false;
    if component == 3u {
        value = outflow(spot.at, call.source);
        is_unknown = fields[field(WET) + spot.at] > 0.0;
    } else {
        value = force(component, spot.at, call.source);
        is_unknown = fields[field(FREE + component) + spot.at] > 0.0;
    }
    if call.mode == 1u {
        value = select(0.0, fields[field(B + component) + spot.place] - value, is_unknown);
    }
    fields[call.into + component * window.levels[0].len + spot.place] = value;
}

// Volume deficit: the field at `into` less the outflow of the velocities at `source`.
@compute @workgroup_size(256)
fn find_lacking(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let spot = inner(0u, number_of(group, local));
    if spot.is_one {
        let wet = fields[field(WET) + spot.place];
        let lacks = fields[call.into + spot.place] - outflow(spot.at, call.source);
        fields[field(LACKING) + spot.place] = wet * lacks;
    }
}

// The pressure of a direction (Cahouet and Chabard 1988).
@compute @workgroup_size(256)
fn mix_pressure(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let spot = inner(0u, number_of(group, local));
    if spot.is_one {
        let viscous = fields[field(BULK) + spot.place] * fields[field(LACKING) + spot.place];
        fields[call.into + spot.place] = window.alpha * fields[field(ANSWER) + spot.place] + viscous;
    }
}
