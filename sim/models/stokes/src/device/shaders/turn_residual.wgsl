// Generalised conjugate residuals (Eisenstat, Elman and Schultz 1983): residuals.rs of maulstick-stokes. Direction and image of
// step j are the fields at DIRECTIONS + 8j, four of each.

// A value of the four components.
struct Element {
    // Index within four fields.
    place: u32,
    is_one: bool,
    is_own: bool,
}

fn element(group: u32, local: u32, k: u32) -> Element {
    let id = (group * OWN + k) * 256u + local;
    let count = inner_count(0u);
    let component = id / count;
    let spot = inner(0u, id % count);
    return Element(component * window.levels[0].len + spot.place, component < 4u, spot.is_own);
}

fn image(number: u32) -> u32 {
    return field(DIRECTIONS + 8u * number + 4u);
}

var<workgroup> is_wanted: u32;

// True in the first round, or where the first has left so little of the image that rounding matters.
fn goes_on(local: u32) -> bool {
    if local == 0u {
        is_wanted = select(0u, 1u, call.mode == 0u || fields[scalar(AGAIN)] > 0.0);
    }
    return workgroupUniformLoad(&is_wanted) == 1u;
}

// Products of an image with earlier ones, and with itself. Mode 1 is the second round.
@compute @workgroup_size(256)
fn multiply_images(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    if !goes_on(local) {
        return;
    }
    let number = call.number;
    var places: array<u32, 8>;
    var own: array<f32, 8>;
    for (var k = 0u; k < OWN; k++) {
        let one = element(group.x, local, k);
        let counts = one.is_one && one.is_own;
        places[k] = select(0u, one.place, counts);
        own[k] = select(0.0, fields[image(number) + one.place], counts);
    }
    for (var first = 0u; first <= number; first += SUMS) {
        let some = min(SUMS, number + 1u - first);
        for (var i = 0u; i < some; i++) {
            let other = image(first + i);
            var sum = 0.0;
            for (var k = 0u; k < OWN; k++) {
                sum += own[k] * fields[other + places[k]];
            }
            lanes[256u * i + local] = sum;
        }
        add_lanes(local, group.x, first, some);
    }
}

// Subtracts shares of earlier images from an image; its square and its product with the residual. Mode 1 is the second
// round.
@compute @workgroup_size(256)
fn take_shares(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    if !goes_on(local) {
        return;
    }
    let number = call.number;
    var sums = vec2(0.0);
    for (var k = 0u; k < OWN; k++) {
        let one = element(group.x, local, k);
        if !one.is_one {
            continue;
        }
        let at = image(number) + one.place;
        var q = fields[at];
        for (var i = 0u; i < number; i++) {
            q -= fields[scalar(SHARES + i)] * fields[image(i) + one.place];
        }
        fields[at] = q;
        let r = fields[field(R) + one.place];
        sums += select(vec2(0.0), vec2(q * q, q * r), one.is_own);
    }
    lanes[local] = sums.x;
    lanes[256u + local] = sums.y;
    add_lanes(local, group.x, 0u, 2u);
}

// Subtracts a direction's part from the residual, or nothing in mode 1; the square of the result.
@compute @workgroup_size(256)
fn answer_residual(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    var sum = 0.0;
    for (var k = 0u; k < OWN; k++) {
        let one = element(group.x, local, k);
        if !one.is_one {
            continue;
        }
        var r = fields[field(R) + one.place];
        if call.mode == 0u {
            r -= fields[scalar(ANSWERS + call.number)] * fields[image(call.number) + one.place];
            fields[field(R) + one.place] = r;
        }
        sum += select(0.0, r * r, one.is_own);
    }
    lanes[local] = sum;
    add_lanes(local, group.x, NORM_ROW, 1u);
}

// Adds the directions, weighted, to the solution.
@compute @workgroup_size(256)
fn add_directions(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let spot = inner(0u, number_of(group, local));
    if !spot.is_one {
        return;
    }
    let place = group.z * window.levels[0].len + spot.place;
    var x = fields[field(X) + place];
    for (var i = 0u; i < call.number; i++) {
        x += fields[scalar(SHARES + i)] * fields[field(DIRECTIONS + 8u * i) + place];
    }
    fields[field(X) + place] = x;
}
