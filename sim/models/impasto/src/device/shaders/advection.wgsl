// A pass of the advection along one axis: conservative fluxes, van Leer's slopes (1974), in whole quanta. Each
// invocation counts the flux through the face ahead of its cell and passes it to the next through the workgroup, so
// that both sides of a face have the same count.

// The first pass reads `planes` and writes `other`, the second one the reverse.
override second: u32 = 0u;

// Greatest share that leaves a column, so that rounding never takes more than there is.
const LOOSEST = 1.0 - 1.0 / 1048576.0;

const COLUMNS = 32u;
const ROWS = 8u;

// Fluxes through the faces of a workgroup's cells, four paints at a time, in turns.
var<workgroup> through: array<vec4<f32>, 512>;

fn count(paint: u32, cell: u32) -> f32 {
    if second == 0u {
        return planes[paint * step.plane + cell];
    }
    return other[paint * step.plane + cell];
}

fn total(at: u32) -> f32 {
    return totals[second * cells() + at];
}

fn loose(at: u32) -> f32 {
    return max(total(at) - step.stain, 0.0);
}

// The cells about a face, along the axis: the one behind it at 1. Beyond the cells around the contacts nothing moves,
// and values are those of their edge.
struct Row {
    at: array<u32, 4>,
    cell: array<u32, 4>,
}

fn slope(a: f32, b: f32) -> f32 {
    if a * b <= 0.0 {
        return 0.0;
    }
    return 2.0 * a * b / (a + b);
}

fn inflow(v: f32, donor: u32) -> f32 {
    return v * (2.0 - v) * loose(donor);
}

@compute @workgroup_size(32, 8)
fn advection(
    @builtin(local_invocation_id) local: vec3<u32>,
    @builtin(local_invocation_index) index: u32,
    @builtin(workgroup_id) group: vec3<u32>,
) {
    let steps = atomicLoad(&stats[stat(STEPS)]);
    let up = along_y(second, steps);
    let axis = select(0u, 1u, up);
    let ahead = select(vec2(1, 0), vec2(0, 1), up);
    let tile = select(vec2(COLUMNS - 1u, ROWS), vec2(COLUMNS, ROWS - 1u), up);
    let size = vec2(i32(step.width), i32(step.height));
    let here = vec2<i32>(group.xy * tile + local.xy) - ahead;
    let inside = all(here >= vec2(0)) && all(here < size);
    let first = select(local.x, local.y, up) == 0u;
    let own = clamp(here, vec2(0), size - 1);
    let around = around();
    let low = min(own, vec2<i32>(around.low));
    let high = max(own, vec2<i32>(around.high) - 1);
    var row: Row;
    for (var k = 0; k < 4; k++) {
        let place = vec2<u32>(clamp(here + (k - 1) * ahead, low, high));
        row.at[k] = place.y * step.width + place.x;
        row.cell[k] = cell_of(place.x, place.y);
    }
    var v = 0.0;
    if inside {
        v = faces[row.at[1]][axis];
    }
    var share = 0.0;
    if v != 0.0 {
        let donor = select(2u, 1u, v > 0.0);
        share = min(loose(row.at[donor]) / max(total(row.at[donor]), 1.0), LOOSEST);
        let fullest = bitcast<f32>(atomicLoad(&stats[stat(FULLEST)]));
        if fullest > 0.1 * step.cell_max {
            let receiver = 3u - donor;
            let at = row.at[receiver];
            let ahead_of = max(-faces[at][axis], 0.0);
            let behind_at = select(row.at[1], row.at[0], receiver == 1u);
            var behind = 0.0;
            if behind_at != at {
                behind = max(faces[behind_at][axis], 0.0);
            }
            let next_at = select(row.at[3], row.at[2], receiver == 1u);
            var coming = 0.0;
            if behind > 0.0 {
                coming += inflow(behind, behind_at);
            }
            if ahead_of > 0.0 && next_at != at {
                coming += inflow(ahead_of, next_at);
            }
            let room = max(step.cell_max - 64.0 - total(at), 0.0);
            share *= min(1.0, room / max(coming, 1e-30));
        }
    }
    // What is in the upper sheet moves with the rest.
    let all = step.planes * (1u + step.sheets);
    var sum = 0.0;
    var turn = 0u;
    for (var paint = 0u; paint < all; paint += 4u) {
        var held = vec4(0.0);
        var flux = vec4(0.0);
        for (var k = 0u; k < 4u; k++) {
            if inside && paint + k < all {
                held[k] = count(paint + k, row.cell[1]);
                if v > 0.0 {
                    let after = count(paint + k, row.cell[2]);
                    let s = slope(held[k] - count(paint + k, row.cell[0]), after - held[k]);
                    flux[k] = trunc(v * (held[k] + 0.5 * (1.0 - v) * s) * share);
                } else if v < 0.0 {
                    let q = count(paint + k, row.cell[2]);
                    let s = slope(q - held[k], count(paint + k, row.cell[3]) - q);
                    flux[k] = trunc(v * (q - 0.5 * (1.0 + v) * s) * share);
                }
            }
        }
        through[turn + index] = flux;
        workgroupBarrier();
        if inside && !first {
            let came = through[turn + index - select(1u, COLUMNS, up)];
            let now = held + came - flux;
            for (var k = 0u; k < 4u; k++) {
                if paint + k < all {
                    sum += select(0.0, now[k], paint + k < step.planes);
                    if second == 0u {
                        other[(paint + k) * step.plane + row.cell[1]] = now[k];
                    } else {
                        planes[(paint + k) * step.plane + row.cell[1]] = now[k];
                    }
                }
            }
        }
        turn = 256u - turn;
    }
    if inside && !first {
        totals[(1u - second) * cells() + row.at[1]] = sum;
    }
}
