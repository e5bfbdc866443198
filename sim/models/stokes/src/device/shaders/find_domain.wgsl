// Domain of the equations: domain/ of maulstick-stokes. Faces, then cells, then the faces that are unknowns, then
// edges.

const LEAST_MASS = 0.05;
const LEAST_DISTANCE = 0.1;
const TOUCHES = 1e-4;
// Seeded faults of tests; 1 without one.
override fault_slope: f32 = 1.0;

fn corner(cell: vec3<i32>) -> f32 {
    let most = vec3<i32>(window.levels[0].cells) + 1;
    return fields[field(DISTANCE) + index(0u, min(cell, most))];
}

fn share_of(all: f32, positive: f32, first: f32) -> f32 {
    let share = select(0.0, positive / all, all > 0.0);
    // No solid is near.
    return select(share, 1.0, first > 2.0);
}

// True for faces across an axis in the sides of the grid and beyond them.
fn is_side(axis: u32, cell: vec3<i32>) -> bool {
    var found = false;
    for (var along = 0u; along < 3u; along++) {
        if is_periodic(along) {
            continue;
        }
        let is_across = along == axis;
        let last = i32(window.levels[0].cells[along]) + select(0, 1, is_across);
        let at = cell[along];
        found = found || (is_across && (at == 0 || at == last - 1));
        found = found || (at == -1 && window.low[along] == 0u);
        found = found || (at >= last && window.high[along] == 0u);
    }
    return found;
}

@compute @workgroup_size(256)
fn find_faces(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let spot = outer(0u, number_of(group, local));
    if !spot.is_one {
        return;
    }
    let axis = group.z;
    let along = others(axis);
    var one = vec3(0);
    var two = vec3(0);
    one[along.x] = 1;
    two[along.y] = 1;
    let a = corner(spot.cell);
    let b = corner(spot.cell + one);
    let c = corner(spot.cell + two);
    let d = corner(spot.cell + one + two);
    let distance = 0.25 * ((a + b) + (c + d));
    let all = abs(a) + abs(b) + abs(c) + abs(d);
    let positive = max(a, 0.0) + max(b, 0.0) + max(c, 0.0) + max(d, 0.0);
    let is_solid = distance <= TOUCHES || is_side(axis, spot.cell);
    fields[field(NEAR + axis) + spot.place] = distance;
    fields[field(SOLID + axis) + spot.place] = select(0.0, 1.0, is_solid);
    fields[field(AREA + axis) + spot.place] = select(share_of(all, positive, a), 0.0, is_solid);
}

@compute @workgroup_size(256)
fn find_cells(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let spot = outer(0u, number_of(group, local));
    if !spot.is_one {
        return;
    }
    var wet = 0.0;
    var volume = 0.0;
    let is_cell = all(spot.cell >= vec3(0)) && all(spot.cell < vec3<i32>(window.levels[0].cells));
    if is_cell {
        let by = strides(0u);
        var closed = 1.0;
        for (var axis = 0u; axis < 3u; axis++) {
            let solid = field(SOLID + axis) + spot.at;
            closed *= fields[solid] * fields[solid + by[axis]];
        }
        let fill = fields[field(FILL) + spot.place];
        if fill >= window.least_fill && closed == 0.0 {
            var every = 0.0;
            var positive = 0.0;
            for (var bits = 0; bits < 8; bits++) {
                let near = corner(spot.cell + vec3(bits & 1, (bits >> 1u) & 1, bits >> 2u));
                every += abs(near);
                positive += max(near, 0.0);
            }
            wet = 1.0;
            volume = min(fill, 1.0) * share_of(every, positive, corner(spot.cell));
        }
    }
    fields[field(WET) + spot.place] = wet;
    fields[field(VOLUME) + spot.place] = volume;
}

@compute @workgroup_size(256)
fn find_free(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let spot = outer(0u, number_of(group, local));
    if !spot.is_one {
        return;
    }
    let axis = group.z;
    let by = strides(0u)[axis];
    var is_free = false;
    var mass = 0.0;
    if spot.cell[axis] >= 0 {
        let wet = field(WET) + spot.at;
        let volume = field(VOLUME) + spot.at;
        is_free = fields[wet - by] + fields[wet] > 0.0 && fields[field(SOLID + axis) + spot.place] == 0.0;
        mass = max(0.5 * (fields[volume - by] + fields[volume]), LEAST_MASS);
    }
    fields[field(FREE + axis) + spot.place] = select(0.0, 1.0, is_free);
    fields[field(MASS + axis) + spot.place] = select(0.0, mass, is_free);
    if !is_free {
        fields[field(AREA + axis) + spot.place] = 0.0;
    }
}

// Faces across an axis on both sides of an edge.
struct Pair {
    free: f32,
    solid: f32,
    distance: f32,
}

fn pair(axis: u32, here: u32, before: u32) -> Pair {
    let f = field(FREE + axis);
    let s = field(SOLID + axis);
    let n = field(NEAR + axis);
    let free = vec2(fields[f + here], fields[f + before]);
    let solid = vec2(fields[s + here], fields[s + before]);
    let near = vec2(fields[n + here], fields[n + before]);
    let is_first = free.x > 0.0;
    let of_paint = select(near.y, near.x, is_first);
    let of_solid = select(near.x, near.y, is_first);
    let behind = min(of_solid, 0.0);
    let share = max(of_paint / (of_paint - behind), LEAST_DISTANCE);
    // The grid's own side is in the middle.
    let distance = select(share, 0.5, of_solid > TOUCHES);
    let is_wall = free.x * solid.y + free.y * solid.x > 0.0;
    return Pair(free.x + free.y, solid.x + solid.y, select(1.0, distance, is_wall));
}

@compute @workgroup_size(256)
fn find_edges(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let spot = outer(0u, number_of(group, local));
    if !spot.is_one {
        return;
    }
    let edge = group.z;
    let axes = others(edge);
    var share = 0.0;
    var slopes = vec2(1.0);
    if spot.cell[axes.x] >= 0 && spot.cell[axes.y] >= 0 {
        let by = strides(0u);
        let by_a = by[axes.x];
        let by_b = by[axes.y];
        let one = pair(axes.x, spot.at, spot.at - by_b);
        let two = pair(axes.y, spot.at, spot.at - by_a);
        let solid = one.solid + two.solid;
        let free = one.free + two.free;
        if free + solid > 3.5 && free > 0.0 {
            let fill = field(FILL) + spot.at;
            let low = min(fields[fill], 1.0) + min(fields[fill - by_a], 1.0);
            let lower = min(fields[fill - by_b], 1.0) + min(fields[fill - by_a - by_b], 1.0);
            let mean = select(0.25 * (low + lower), 1.0, solid > 0.0);
            share = mean * one.distance * two.distance;
            slopes = vec2(fault_slope / one.distance, 1.0 / two.distance);
        }
    }
    fields[field(EDGE + edge) + spot.place] = share;
    fields[field(SLOPE + 2u * edge) + spot.place] = slopes.x;
    fields[field(SLOPE + 2u * edge + 1u) + spot.place] = slopes.y;
}
