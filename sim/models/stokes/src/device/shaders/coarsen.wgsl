// The operator of a coarser grid, and the weight of interpolated values on the finer one.

// Mass of a fine place, and half of its links with known places within one coarse cell.
fn lost(level: u32, component: u32, cell: vec3<i32>, at: u32) -> f32 {
    var sum = fields[part(level, component, INERTIA) + at];
    let unknown = part(level, component, ACTIVE) + at;
    if fields[unknown] == 0.0 {
        return sum;
    }
    let by = strides(level);
    for (var axis = 0u; axis < 3u; axis++) {
        if axis == component || window.levels[level].halved[axis] == 0u {
            continue;
        }
        let links = part(level, component, LINKS + axis) + at;
        let c = cell[axis];
        let step = by[axis];
        let is_second = (c & 1) == 1;
        let last = select(c + 1, c, is_second);
        if c < 0 || last >= i32(window.levels[level].cells[axis]) {
            continue;
        }
        let link = select(links + step, links, is_second);
        let other = select(unknown + step, unknown - step, is_second);
        sum += 0.5 * fields[link] * (1.0 - fields[other]);
    }
    return sum;
}

@compute @workgroup_size(256)
fn coarsen(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let fine = call.level;
    let coarse = fine + 1u;
    let spot = outer(coarse, number_of(group, local));
    if !spot.is_one {
        return;
    }
    // Fields of the operator, mass, and masks of active and known places.
    let what = group.z % 6u;
    let component = group.z / 6u;
    var total = 0.0;
    let most = vec3<i32>(window.levels[coarse].cells);
    if all(spot.cell >= vec3(0)) && all(spot.cell <= most) {
        var kinds = vec3(SUM);
        if what < 3u {
            kinds[what] = LINK;
        } else if what > 3u {
            kinds = vec3(CHILDREN);
        }
        let places = around(fine, component, spot.cell, kinds);
        let start = part(fine, component, what);
        for (var z = 0; z < places.count.z; z++) {
            for (var y = 0; y < places.count.y; y++) {
                for (var x = 0; x < places.count.x; x++) {
                    let weight = places.x[x] * places.y[y] * places.z[z];
                    if weight == 0.0 {
                        continue;
                    }
                    let cell = places.first + vec3(x, y, z);
                    if what == INERTIA {
                        let wrapped = wrap(fine, cell);
                        total += weight * lost(fine, component, wrapped, index(fine, wrapped));
                    } else {
                        total += weight * fields[start + index(fine, cell)];
                    }
                }
            }
        }
    }
    if what > 3u {
        total = select(0.0, 1.0, total > 0.0);
    }
    if what < 3u && is_periodic(what) && window.levels[coarse].cells[what] == 1u {
        total = 0.0;
    }
    fields[part(coarse, component, what) + spot.place] = total;
}

// Scale of interpolated values: the inverse of the weights of the existing places.
@compute @workgroup_size(256)
fn find_scale(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let spot = inner(call.level, number_of(group, local));
    if !spot.is_one {
        return;
    }
    let component = group.z;
    var scale = 0.0;
    if fields[part(call.level, component, ACTIVE) + spot.place] > 0.0 {
        let weight = between(call.level, component, spot.cell, part(call.level + 1u, component, KNOWN));
        scale = select(0.0, 1.0 / weight, weight > 0.0);
    }
    fields[part(call.level, component, SCALE) + spot.place] = scale;
}
