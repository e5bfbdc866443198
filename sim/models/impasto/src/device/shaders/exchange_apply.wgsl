// Applies the exchange: the truncated amount that its texel grants each cell of each paint is taken from one side and
// given to the other.

// Threshold of a request that nearly empties a donor: above it shares are reduced by more than rounding adds, so that
// their sum never exceeds the stock; below it rounding takes no quantum of a whole one.
const NEXT_TO_ALL = 0.9999;
const SHORT = 1.0 - 1.0 / 1048576.0;
const LONG = 1.0 + 1.0 / 2097152.0;

fn rounded(share: f32, asked: f32, there: f32) -> f32 {
    return share * select(LONG, SHORT, asked > NEXT_TO_ALL * there);
}

// Records the height of paint under the brush, and beside it.
fn note_left(i: u32, total: f32) {
    let at = vec2(i % step.width, i / step.width);
    let touched = inside();
    if any(at + 1u < touched.low) || any(at > touched.high) {
        return;
    }
    let height = total + totals[2u * cells() + i] / step.cells_per_quantum;
    raise(TOP_EVER, bitcast<u32>(max(height, 0.0)));
}

@compute @workgroup_size(256)
fn exchange_apply(@builtin(global_invocation_id) id: vec3<u32>) {
    let i = id.x;
    if i >= cells() {
        return;
    }
    let texel = contacts[i].texel;
    if texel == NONE {
        note_left(i, totals[i]);
        return;
    }
    let film = f32(load[1u + texel]);
    let drawn = f32(atomicLoad(&asks[texel]));
    let offered = f32(atomicLoad(&asks[texels() + texel]));
    var granted = vec2(1.0, 1.0);
    if step.transfer == SPONGE {
        granted.x = select(0.0, 1.0, film > 0.0);
    } else {
        granted.x = min(1.0, film / max(drawn, 1.0));
        let room = step.film_most - film + drawn * granted.x;
        granted.y = clamp(room / max(offered, 1.0), 0.0, 1.0);
    }
    let goes = wants[i] * granted;
    // Lasting paint loses only the amount that arrives.
    var leaves = 1.0;
    if step.lasting != 0u && goes.y > goes.x {
        leaves = goes.x / goes.y;
    }
    let share = vec2(
        rounded(goes.x / max(film, 1.0), drawn, film),
        rounded(goes.y / max(totals[i], 1.0), goes.y, totals[i]),
    );
    let cell = cell_of(i % step.width, i / step.width);
    var sum = 0.0;
    for (var paint = 0u; paint < step.planes; paint++) {
        let at = paint * step.plane + cell;
        let there = planes[at];
        let left = trunc(f32(load[film_of(paint) + texel]) * share.x);
        let taken = min(trunc(there * share.y), there);
        let now = there + left - trunc(leaves * taken);
        sum += now;
        if left != 0.0 || taken != 0.0 {
            planes[at] = now;
            if step.transfer != SPONGE {
                // In two's complement a negative change is added as well.
                let change = u32(i32(taken) - i32(left));
                atomicAdd(&asks[change_of(paint) + texel], change);
            }
        }
    }
    note_left(i, sum);
}
