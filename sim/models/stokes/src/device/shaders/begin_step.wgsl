// Beginning of a step: bristles drag, solids and air get their velocities, and each cell its viscosity.

const LARGEST_RELATIVE_VISCOSITY = 2000.0;
const THINNEST = 1e-3;

@compute @workgroup_size(256)
fn choose_velocity(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let spot = outer(0u, number_of(group, local));
    if !spot.is_one {
        return;
    }
    let axis = group.z;
    let free = fields[field(FREE + axis) + spot.place];
    let of_solid = fields[field(OF_SOLID + axis) + spot.place];
    var u = fields[field(X + axis) + spot.place];
    if window.resists > 0u {
        // Brinkman: flow::drag of maulstick-stokes.
        let drags = window.tau * fields[field(RESISTANCE + axis) + spot.place] * free;
        u = (u + drags * (of_solid - window.pull[axis])) / (1.0 + drags);
        fields[field(MASS + axis) + spot.place] *= 1.0 + drags;
    }
    let solid = fields[field(SOLID + axis) + spot.place];
    let other = select(0.0, of_solid, solid > 0.0);
    fields[field(X + axis) + spot.place] = select(other, u, free > 0.0);
    if axis == 0u {
        let wet = fields[field(WET) + spot.place];
        let p = fields[field(X + 3u) + spot.place];
        fields[field(X + 3u) + spot.place] = select(0.0, p / window.to_pressure, wet > 0.0);
    }
}

// Square of the shear at an edge, in velocities per cell; 0 where there is no paint.
fn squared_shear(edge: u32, at: u32) -> f32 {
    let axes = others(edge);
    let by = strides(0u);
    let u = field(X + axes.x) + at;
    let v = field(X + axes.y) + at;
    let slope = field(SLOPE + 2u * edge) + at;
    let shear = fields[slope] * (fields[u] - fields[u - by[axes.y]])
        + fields[slope + window.levels[0].len] * (fields[v] - fields[v - by[axes.x]]);
    return select(0.0, shear * shear, fields[field(EDGE + edge) + at] > 0.0);
}

@compute @workgroup_size(256)
fn find_viscosity(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let spot = inner(0u, number_of(group, local));
    if !spot.is_one {
        return;
    }
    if window.yields == 0.0 && window.thins == 0.0 {
        fields[field(VISCOSITY) + spot.place] = 1.0;
        return;
    }
    let by = strides(0u);
    var squared = 0.0;
    for (var axis = 0u; axis < 3u; axis++) {
        let u = field(X + axis) + spot.at;
        let stretch = fields[u + by[axis]] - fields[u];
        squared += 2.0 * (stretch * stretch);
    }
    for (var edge = 0u; edge < 3u; edge++) {
        let axes = others(edge);
        let a = by[axes.x];
        let b = by[axes.y];
        let low = squared_shear(edge, spot.at) + squared_shear(edge, spot.at + a);
        let high = squared_shear(edge, spot.at + b) + squared_shear(edge, spot.at + a + b);
        squared += 0.25 * (low + high);
    }
    let rate = max(max(sqrt(squared) * window.per_cell, window.least_rate), 1e-12);
    var relative = 1.0;
    if window.thins != 0.0 {
        relative = pow(rate * window.per_rate, window.thins);
    }
    relative = clamp(relative + window.yields / rate, THINNEST, LARGEST_RELATIVE_VISCOSITY);
    fields[field(VISCOSITY) + spot.place] = relative;
}

@compute @workgroup_size(256)
fn weigh_edges(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let spot = outer(0u, number_of(group, local));
    if !spot.is_one {
        return;
    }
    let edge = group.z;
    let axes = others(edge);
    var weight = 0.0;
    let share = fields[field(EDGE + edge) + spot.place];
    if share > 0.0 {
        let by = strides(0u);
        let w = field(WET) + spot.at;
        let m = field(VISCOSITY) + spot.at;
        let a = by[axes.x];
        let b = by[axes.y];
        let wet = vec4(fields[w], fields[w - a], fields[w - b], fields[w - a - b]);
        let viscosity = vec4(fields[m], fields[m - a], fields[m - b], fields[m - a - b]);
        let count = (wet.x + wet.y) + (wet.z + wet.w);
        // Only cells with paint have a viscosity.
        weight = share * (window.beta * dot(wet, viscosity) / max(count, 1.0));
    }
    let slope = field(SLOPE + 2u * edge) + spot.place;
    fields[field(WEIGHT + edge) + spot.place] = weight;
    fields[field(CROSS + edge) + spot.place] = weight * fields[slope] * fields[slope + window.levels[0].len];
}

@compute @workgroup_size(256)
fn find_right(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let spot = inner(0u, number_of(group, local));
    if !spot.is_one {
        return;
    }
    let component = group.z;
    if component < 3u {
        let inertia = fields[part(0u, component, INERTIA) + spot.place];
        let u = fields[field(X + component) + spot.place];
        fields[field(B + component) + spot.place] = inertia * (u + window.pull[component]);
        return;
    }
    let by = strides(0u);
    let wet = field(WET) + spot.at;
    var displaced = 0.0;
    var inside = 1.0;
    for (var axis = 0u; axis < 3u; axis++) {
        let solid = field(SOLID + axis) + spot.at;
        let free = field(FREE + axis) + spot.at;
        let area = field(AREA + axis) + spot.at;
        let u = field(OF_SOLID + axis) + spot.at;
        let step = by[axis];
        let low = (fields[solid] + fields[free] * (1.0 - fields[area])) * fields[u];
        let high = (fields[solid + step] + fields[free + step] * (1.0 - fields[area + step])) * fields[u + step];
        displaced -= high - low;
        inside *= fields[wet - step] * fields[wet + step];
    }
    // Wet cells expel a share of their excess, and those within the paint take in a share of their deficit.
    let excess = fields[field(FILL) + spot.place] - 1.0;
    if excess > 1e-3 || (excess < -1e-3 && inside > 0.0) {
        displaced += window.relief * min(excess, 1.0);
    }
    fields[field(B + 3u) + spot.place] = fields[wet] * displaced;
}

// End of a step: velocities of air beside paint become the mean of those around it, and the pressure its physical
// value.
@compute @workgroup_size(256)
fn end_step(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let spot = inner(0u, number_of(group, local));
    if !spot.is_one {
        return;
    }
    let component = group.z;
    if component == 3u {
        fields[field(X + 3u) + spot.place] *= window.to_pressure;
        return;
    }
    let free = field(FREE + component) + spot.at;
    if fields[free] + fields[field(SOLID + component) + spot.at] > 0.0 {
        return;
    }
    let by = strides(0u);
    let u = field(X + component) + spot.at;
    var count = 0.0;
    var sum = 0.0;
    for (var axis = 0u; axis < 3u; axis++) {
        let step = by[axis];
        count += fields[free - step] + fields[free + step];
        sum += fields[free - step] * fields[u - step] + fields[free + step] * fields[u + step];
    }
    if count > 0.0 {
        fields[field(X + component) + spot.place] = sum / count;
    }
}
