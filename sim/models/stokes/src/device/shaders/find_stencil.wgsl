// Seven-point operators: those of the components of the velocity and of the pressure on the finest grid, then of each coarser
// one: operator.rs and multigrid/ of maulstick-stokes.

// Seeded fault of tests; 1 without one.
override fault_link: f32 = 1.0;

fn is_beside_itself(axis: u32) -> bool {
    return is_periodic(axis) && window.levels[0].cells[axis] == 1u;
}

// Link of the pressure at a face.
fn pressure_link(axis: u32, at: u32) -> f32 {
    let mass = fields[field(MASS + axis) + at];
    let area = fields[field(AREA + axis) + at];
    let wall = fields[scalar(WALL)];
    return select(0.0, area * area / (mass + wall), mass > 0.0 && !is_beside_itself(axis));
}

@compute @workgroup_size(256)
fn find_stencil(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let spot = outer(0u, number_of(group, local));
    if !spot.is_one {
        return;
    }
    let component = group.z;
    let by = strides(0u);
    let most = vec3<i32>(window.levels[0].cells);
    let links = part(0u, component, LINKS) + spot.place;
    let len = window.levels[0].len;
    if component == 3u {
        var sum = 0.0;
        for (var axis = 0u; axis < 3u; axis++) {
            let link = pressure_link(axis, spot.at);
            fields[links + axis * len] = link;
            sum += link;
            if spot.cell[axis] <= most[axis] {
                sum += pressure_link(axis, spot.at + by[axis]);
            }
        }
        let wet = fields[field(WET) + spot.place];
        fields[part(0u, 3u, INERTIA) + spot.place] = 0.0;
        fields[part(0u, 3u, ACTIVE) + spot.place] = wet;
        // Air beside paint has no unknown pressure.
        fields[part(0u, 3u, KNOWN) + spot.place] = select(wet, 1.0, sum > 0.0);
        return;
    }
    for (var axis = 0u; axis < 3u; axis++) {
        var link = 0.0;
        if is_beside_itself(axis) {
            link = 0.0;
        } else if axis == component {
            if spot.cell[axis] >= 0 {
                let low = spot.at - by[axis];
                link = 2.0 * window.beta * fields[field(VOLUME) + low] * fields[field(VISCOSITY) + low];
            }
        } else {
            let edge = 3u - axis - component;
            let second = select(0u, 1u, others(edge).y == component);
            let slope = fields[field(SLOPE + 2u * edge + second) + spot.place];
            link = fault_link * fields[field(WEIGHT + edge) + spot.place] * slope * slope;
        }
        fields[links + axis * len] = link;
    }
    let free = fields[field(FREE + component) + spot.place];
    let mass = fields[field(MASS + component) + spot.place];
    fields[part(0u, component, INERTIA) + spot.place] = window.alpha * mass * free;
    fields[part(0u, component, ACTIVE) + spot.place] = free;
    fields[part(0u, component, KNOWN) + spot.place] = free + fields[field(SOLID + component) + spot.place];
}

// Sum of the links of a place.
fn all_links(level: u32, component: u32, at: u32) -> f32 {
    let by = strides(level);
    let links = part(level, component, LINKS) + at;
    let len = window.levels[level].len;
    let x = fields[links] + fields[links + by.x];
    let y = fields[links + len] + fields[links + len + by.y];
    let z = fields[links + 2u * len] + fields[links + 2u * len + by.z];
    return x + y + z;
}

@compute @workgroup_size(256)
fn invert_diagonal(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let level = call.level;
    let spot = inner(level, number_of(group, local));
    if !spot.is_one {
        return;
    }
    let component = group.z;
    let inertia = fields[part(level, component, INERTIA) + spot.place];
    let links = all_links(level, component, spot.at);
    let sum = fields[part(level, component, ACTIVE) + spot.place] * (inertia + links);
    fields[part(level, component, INVERSE) + spot.place] = select(0.0, 1.0 / sum, sum > 0.0);
}

// The viscous part of the inverse Schur complement by cell.
@compute @workgroup_size(256)
fn find_bulk(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let spot = inner(0u, number_of(group, local));
    if !spot.is_one {
        return;
    }
    let by = strides(0u);
    var sum = 0.0;
    for (var axis = 0u; axis < 3u; axis++) {
        for (var side = 0u; side < 2u; side++) {
            let at = spot.at + side * by[axis];
            let area = fields[field(AREA + axis) + at];
            if area > 0.0 {
                let links = all_links(0u, axis, at);
                sum += select(0.0, area * area / links, links > 0.0);
            }
        }
    }
    let wet = fields[field(WET) + spot.place];
    fields[field(BULK) + spot.place] = select(0.0, wet * 1.5 / sum, sum > 0.0);
}
