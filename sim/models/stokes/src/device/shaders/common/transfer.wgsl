// Transfer between a grid and the next: multigrid/transfer.rs of maulstick-stokes. Coarse cell C covers the fine cells
// 2C and 2C + 1; across the axis of a component's faces, coarse face C is the fine face 2C.

// Kinds of weights of the four fine places from the one before the first child on.
const RESTRICTION = 0u;
const SUM = 1u;
const LINK = 2u;
const CHILDREN = 3u;

fn weights_of(kind: u32, is_faces: bool) -> vec4<f32> {
    switch kind {
        case 0u: {
            return select(vec4(0.25, 0.75, 0.75, 0.25), vec4(0.5, 1.0, 0.5, 0.0), is_faces);
        }
        case 1u: {
            return select(vec4(0.0, 1.0, 1.0, 0.0), vec4(0.5, 1.0, 0.5, 0.0), is_faces);
        }
        case 2u: {
            return select(vec4(0.0, 0.5, 0.0, 0.0), vec4(0.25, 0.25, 0.0, 0.0), is_faces);
        }
        default: {
            return select(vec4(0.0, 1.0, 1.0, 0.0), vec4(0.0, 1.0, 0.0, 0.0), is_faces);
        }
    }
}

// Fine places around a coarse one, by axis: the first, their number and weights.
struct Around {
    first: vec3<i32>,
    count: vec3<i32>,
    x: vec4<f32>,
    y: vec4<f32>,
    z: vec4<f32>,
}

fn around(fine: u32, component: u32, coarse: vec3<i32>, kinds: vec3<u32>) -> Around {
    let halved = window.levels[fine].halved == vec3(1u);
    let one = vec4(1.0, 0.0, 0.0, 0.0);
    let first = select(coarse, 2 * coarse - 1, halved);
    // Beyond the last layer there are no values.
    let room = vec3<i32>(window.levels[fine].cells) + 2 - first;
    return Around(
        first,
        min(select(vec3(1), vec3(4), halved), room),
        select(one, weights_of(kinds.x, component == 0u), halved.x),
        select(one, weights_of(kinds.y, component == 1u), halved.y),
        select(one, weights_of(kinds.z, component == 2u), halved.z),
    );
}

// Value of a fine place, interpolated linearly between the coarse ones beside it; the coarse field begins at `from`.
fn between(fine: u32, component: u32, cell: vec3<i32>, start: u32) -> f32 {
    let by = strides(fine + 1u);
    let halved = window.levels[fine].halved == vec3(1u);
    let odd = (cell & vec3(1)) == vec3(1);
    let faces = vec3(component == 0u, component == 1u, component == 2u);
    let near = select(cell, cell >> vec3(1u), halved);
    let ahead = odd | faces;
    let beside = select(near, near + select(vec3(-1), vec3(1), ahead), halved);
    let of_faces = select(vec3(1.0), vec3(0.5), odd);
    let share = select(vec3(1.0), select(vec3(0.75), of_faces, faces), halved);
    let a = vec3<u32>(near + 1) * by;
    let b = vec3<u32>(beside + 1) * by;
    let low = start + a.z;
    let high = start + b.z;
    let lowest = share.x * fields[low + a.y + a.x] + (1.0 - share.x) * fields[low + a.y + b.x];
    let lower = share.x * fields[low + b.y + a.x] + (1.0 - share.x) * fields[low + b.y + b.x];
    let higher = share.x * fields[high + a.y + a.x] + (1.0 - share.x) * fields[high + a.y + b.x];
    let highest = share.x * fields[high + b.y + a.x] + (1.0 - share.x) * fields[high + b.y + b.x];
    return share.z * (share.y * lowest + (1.0 - share.y) * lower)
        + (1.0 - share.z) * (share.y * higher + (1.0 - share.y) * highest);
}
