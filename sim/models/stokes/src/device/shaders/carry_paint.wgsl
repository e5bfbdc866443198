// Transport of counted paint: volume/ of maulstick-stokes. Counts are whole numbers below 2²⁴, which f32 holds exactly;
// one side loses and the other gains the flux through a face. Fields of the solver serve as scratch.

const LEAST_ROOM = 0.3;
const LARGEST_COURANT = 0.5;
const LEAST_GRADIENT = 1e-3;
// Division may be off by 2.5 in the last place, so the shares of two faces add up to less than a cell.
const BELOW_ONE = 0.99999905;
// Capacity, fill, occupied share, requested share of a cell through a face; all quanta, requested quanta, granted
// share.
const ROOM = 48u;
const FULL = 49u;
const TAKEN = 50u;
const COURANT = 51u;
const TOTAL = 52u;
const ASKS = 53u;
const SHARE = 54u;
// Seeded fault of tests; 0 without one.
override fault_lost: f32 = 0.0;

fn order(turn: u32, number: u32) -> u32 {
    var orders = array<vec3<u32>, 6>(
        vec3(0u, 1u, 2u), vec3(2u, 1u, 0u), vec3(1u, 2u, 0u), vec3(0u, 2u, 1u), vec3(2u, 0u, 1u), vec3(1u, 0u, 2u),
    );
    let axes = orders[turn % 6u];
    return axes[number];
}

// Axis of the call: its part of the step is the mode, its place in the part's order the number.
fn axis_of_call() -> u32 {
    return order(window.turn + call.mode, call.number);
}

fn open_field() -> u32 {
    return field(DIRECTIONS + 8u * window.memory);
}

fn paint_field(paint: u32) -> u32 {
    return field(DIRECTIONS + 8u * window.memory + 1u + paint);
}

fn next_field(paint: u32) -> u32 {
    return field(DIRECTIONS + paint);
}

fn near_corner(cell: vec3<i32>) -> f32 {
    let most = vec3<i32>(window.levels[0].cells) + 1;
    return fields[field(DISTANCE) + index(0u, min(cell, most))];
}

fn room_of(open: f32) -> f32 {
    return window.capacity * max(open, LEAST_ROOM);
}

// Open share and fill of each cell, before the flow.
@compute @workgroup_size(256)
fn fill_window(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let spot = inner(0u, number_of(group, local));
    if !spot.is_one {
        return;
    }
    var every = 0.0;
    var positive = 0.0;
    for (var bits = 0; bits < 8; bits++) {
        let near = near_corner(spot.cell + vec3(bits & 1, (bits >> 1u) & 1, bits >> 2u));
        every += abs(near);
        positive += max(near, 0.0);
    }
    let share = select(0.0, positive / every, every > 0.0);
    let open = select(share, 1.0, near_corner(spot.cell) > 2.0);
    var total = 0.0;
    for (var paint = 0u; paint < window.paints; paint++) {
        total += fields[paint_field(paint) + spot.place];
    }
    fields[open_field() + spot.place] = open;
    fields[field(FILL) + spot.place] = total / room_of(open);
}

// Adds the counts found by the previous call if its `first` is 1; resets the capacity where its `axis` is 1.
@compute @workgroup_size(256)
fn take_counts(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let spot = inner(0u, number_of(group, local));
    if !spot.is_one {
        return;
    }
    var total = 0.0;
    for (var paint = 0u; paint < window.paints; paint++) {
        var count = fields[paint_field(paint) + spot.place];
        if call.first == 1u {
            count = fields[next_field(paint) + spot.place];
            fields[paint_field(paint) + spot.place] = count;
        }
        total += count;
    }
    let open = fields[open_field() + spot.place];
    let room = select(fields[field(ROOM) + spot.place], room_of(open), call.axis == 1u);
    let full = total / max(room, LEAST_ROOM * window.capacity);
    fields[field(TOTAL) + spot.place] = total;
    fields[field(ROOM) + spot.place] = room;
    fields[field(FULL) + spot.place] = full;
    fields[field(TAKEN) + spot.place] = 1.0 - open * (1.0 - min(full, 1.0));
}

// Quanta requested through each face, upward.
@compute @workgroup_size(256)
fn ask_faces(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let spot = inner(0u, number_of(group, local));
    if !spot.is_one {
        return;
    }
    let axis = axis_of_call();
    let by = strides(0u);
    var courant = 0.0;
    var asks = 0.0;
    if fields[field(FREE + axis) + spot.at] > 0.0 {
        let goes = fields[field(AREA + axis) + spot.at] * window.courant * fields[field(X + axis) + spot.at];
        courant = clamp(goes, -LARGEST_COURANT, LARGEST_COURANT);
        let is_up = courant > 0.0;
        let donor = select(spot.at, spot.at - by[axis], is_up);
        let fill = fields[field(FULL) + donor];
        let taken = field(TAKEN) + donor;
        let slope = upper(by, taken) - lower(by, taken);
        let sum = sum_of(abs(slope));
        let across = select(0.0, slope[axis] / max(sum, LEAST_GRADIENT), sum >= LEAST_GRADIENT && fill < 1.0);
        let reach = abs(courant);
        // Paint lies on the side that it leaves to, or behind air.
        let piled = select(max(reach - (1.0 - fill), 0.0), min(reach, fill), (across > 0.0) == is_up);
        let share = abs(across) * piled + (1.0 - abs(across)) * reach * fill;
        let wanted = min(floor(share * window.capacity), fields[field(TOTAL) + donor]);
        asks = select(-wanted, wanted, is_up);
    }
    fields[field(COURANT) + spot.place] = courant;
    fields[field(ASKS) + spot.place] = asks;
}

// Requests as shares of the donors' content, or of all requests to a donor where those exceed it.
@compute @workgroup_size(256)
fn share_faces(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let spot = inner(0u, number_of(group, local));
    if !spot.is_one {
        return;
    }
    let by = strides(0u)[axis_of_call()];
    let asks = field(ASKS) + spot.at;
    let here = fields[asks];
    var share = 0.0;
    if here != 0.0 {
        let is_up = here > 0.0;
        let other = max(select(fields[asks + by], -fields[asks - by], is_up), 0.0);
        let has = fields[field(TOTAL) + select(spot.at, spot.at - by, is_up)];
        let whole = max(max(abs(here) + other, has), 1.0);
        share = here / whole * BELOW_ONE;
        if abs(here) == whole {
            share = select(-1.0, 1.0, is_up);
        }
    }
    fields[field(SHARE) + spot.place] = share;
    let courant = field(COURANT) + spot.at;
    fields[field(ROOM) + spot.place] += window.capacity * (fields[courant] - fields[courant + by]);
}

// Quanta of a paint through a face, upward.
fn goes_through(paint: u32, face: u32, by: u32) -> f32 {
    let share = fields[field(SHARE) + face];
    if share == 0.0 {
        return 0.0;
    }
    let has = fields[paint_field(paint) + select(face, face - by, share > 0.0)];
    let goes = select(has, floor(abs(share) * has), abs(share) < 1.0);
    return select(-goes, goes, share > 0.0);
}

@compute @workgroup_size(256)
fn carry_paint(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let spot = inner(0u, number_of(group, local));
    if !spot.is_one {
        return;
    }
    let by = strides(0u)[axis_of_call()];
    let comes = goes_through(group.z, spot.at, by);
    let leaves = goes_through(group.z, spot.at + by, by);
    let lost = select(0.0, fault_lost, leaves > 0.0);
    fields[next_field(group.z) + spot.place] = fields[paint_field(group.z) + spot.place] + (comes - leaves) - lost;
}

// True for a drop that is too small to flow and has room below.
fn sinks(at: u32) -> bool {
    let below = at - strides(0u).z;
    let own = fields[field(TOTAL) + at] / room_of(fields[open_field() + at]);
    let under = fields[field(TOTAL) + below] / room_of(fields[open_field() + below]);
    let is_drop = fields[field(WET) + at] == 0.0 && own < window.least_fill;
    return is_drop && own + under <= 1.0 && fields[field(SOLID + 2u) + at] == 0.0;
}

@compute @workgroup_size(256)
fn settle_drops(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let spot = inner(0u, number_of(group, local));
    if !spot.is_one {
        return;
    }
    let above = spot.at + strides(0u).z;
    let paint = paint_field(group.z);
    let stays = select(fields[paint + spot.at], 0.0, sinks(spot.at));
    fields[next_field(group.z) + spot.place] = stays + select(0.0, fields[paint + above], sinks(above));
}
