// Blends the drawn head with the canvas below it (raster.rs, touching.rs, transfer.rs of maulstick-dab): where they
// touch, V·(1 − (1 − R)^T) of each side goes over in whole units, in the same proportion for all paints. An invocation
// has a cell of the head.

// Constants of volume.rs and touching.rs.
override UNIT: f32;
override MOST_UNITS: f32;
override BRIDGED: f32;

// Sums of the workgroup: cells that touch; wet paint and thinner on them, in 16 quanta.
var<workgroup> met: array<atomic<u32>, 3>;

fn exponent_of(value: f32) -> i32 {
    return i32(bitcast<u32>(value) >> 23u);
}

fn mantissa_of(value: f32) -> u32 {
    return (bitcast<u32>(value) & 0x7fffffu) | 0x800000u;
}

// a / b, 0 ≤ a ≤ b, correctly rounded as on the processor: a device's division may be off by several roundings.
fn quotient(a: f32, b: f32) -> f32 {
    let near = a / b;
    if near <= 0.0 {
        return 0.0;
    }
    // The remainder of a is small beside b, and so exact modulo 2³².
    let shift = u32(exponent_of(a) - exponent_of(b) - exponent_of(near) + 127 + 23);
    let divisor = i32(mantissa_of(b));
    var left = i32((mantissa_of(a) << (shift & 31u)) - mantissa_of(near) * mantissa_of(b));
    var more = 0.0;
    for (var k = 0; k < 4; k++) {
        if 2 * left > divisor {
            left -= divisor;
            more += 1.0;
        } else if 2 * left < -divisor {
            left += divisor;
            more -= 1.0;
        }
    }
    return near + more * bitcast<f32>(u32(exponent_of(near) - 23) << 23u);
}

// Threshold of a cell of the step's bounds, counted from the first cell of its row below the head.
fn threshold_at(at: vec2<u32>, left: u32) -> f32 {
    let row = increase(left, blend_of.across_high, blend_of.across_low)
        + increase(at.y, blend_of.up_high, blend_of.up_low);
    let sum = threshold_of(blend_of.threshold + row) + f32(at.x - left) * blend_of.across;
    return sum - floor(sum);
}

struct Meeting {
    brush: f32,
    canvas: f32,
    rate: f32,
    way: f32,
    reach: f32,
    gap: f32,
}

// Quanta from the brush to the canvas, and from the canvas to the brush (`leaving` of transfer.rs).
fn leaving(meeting: Meeting, threshold: f32) -> vec2<f32> {
    let full = MOST_UNITS * UNIT;
    let free = min(max(meeting.brush - meeting.gap, 0.0), full);
    let loose = max(meeting.canvas - blend_of.stain, 0.0);
    let reached = min(min(meeting.canvas, full) * meeting.reach, loose);
    let rate = meeting.rate * blend_of.exchanges * (1.0 / UNIT);
    let wanted = vec2(free * rate + blend_of.flow * meeting.way, reached * rate);
    let opposite = threshold + select(-0.5, 0.5, threshold < 0.5);
    var units = floor(wanted + vec2(threshold, opposite)) * UNIT;
    units = min(units, vec2(free, loose));
    let taken = min(units.y, max(full - meeting.brush, 0.0) + units.x);
    let given = min(units.x, max(blend_of.most - meeting.canvas, 0.0) + taken);
    return vec2(given, taken);
}

// A paint on a cell of the brush, before the blend.
fn film_on(paint: u32, i: u32, texel: u32, texel_cells: u32) -> f32 {
    if (blend_of.ends & FIRST) != 0u {
        return f32(lent(load[film_of(paint) + texel], texel_cells));
    }
    return other[paint * cells() + i];
}

// Stores a paint on a cell of the brush for the next blend; after the last one its texel gets the change since it was
// lent.
fn leave_film(paint: u32, i: u32, texel: u32, texel_cells: u32, film: f32) {
    if (blend_of.ends & LAST) == 0u {
        other[paint * cells() + i] = film;
        return;
    }
    let lay = f32(lent(load[film_of(paint) + texel], texel_cells));
    if film != lay && step.transfer != SPONGE {
        // In two's complement a negative change is added as well.
        atomicAdd(&asks[change_of(paint) + texel], u32(i32(film - lay)));
    }
}

fn meet(i: u32, first: u32) {
    let head_of = drawn[i];
    if head_of.texel == NONE {
        return;
    }
    let texel_cells = atomicLoad(&asks[head_of.texel]);
    let moved = vec2(i32(i % step.width), i32(i / step.width)) + blend_of.shift;
    let on_canvas = all(moved >= blend_of.low) && all(moved < blend_of.high);
    let at = vec2<u32>(moved);
    let cell = select(0u, cell_of(at.x, at.y), on_canvas);
    var meeting = Meeting(0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for (var paint = 0u; paint < step.planes; paint++) {
        meeting.brush += film_on(paint, i, head_of.texel, texel_cells);
        if on_canvas {
            meeting.canvas += planes[paint * step.plane + cell];
        }
    }
    var goes = vec2(0.0);
    if on_canvas && head_of.cover > 0.0 {
        let to_cells = step.cells_per_quantum;
        let ride = base[step.plane + cell];
        let wet = meeting.canvas * to_cells;
        let rests = max(head_of.height + min(ride, 0.0), ride);
        let reach = base[cell] + wet - (rests - step.sink + head_of.clearance);
        if reach + meeting.brush * to_cells > 0.0 {
            let depth = min(max(reach, 0.0), wet);
            meeting.reach = select(0.0, depth / wet, wet > 0.0);
            meeting.gap = max(-reach, 0.0) * (BRIDGED / to_cells);
            meeting.rate = head_of.rate;
            meeting.way = head_of.way;
            let reached = i32(first) + blend_of.shift.x;
            let left = clamp(reached, blend_of.low.x, blend_of.high.x) + blend_of.corner.x;
            let place = vec2<u32>(moved + blend_of.corner);
            goes = leaving(meeting, threshold_at(place, u32(left)));
            atomicAdd(&met[0], 1u);
            atomicAdd(&met[1], u32(meeting.canvas / 16.0 + 0.5));
            if step.thinner != NONE {
                let thinner = planes[step.thinner * step.plane + cell];
                atomicAdd(&met[2], u32(thinner / 16.0 + 0.5));
            }
        }
    }
    let gives = quotient(goes.x, max(meeting.brush, 1.0));
    let takes = quotient(goes.y, max(meeting.canvas, 1.0));
    let lost = select(goes.y, min(goes.x, goes.y), blend_of.lasting != 0u);
    let leaves = quotient(lost, max(goes.y, 1.0));
    var lies = 0.0;
    for (var paint = 0u; paint < step.planes; paint++) {
        var film = film_on(paint, i, head_of.texel, texel_cells);
        if any(goes != vec2(0.0)) {
            let place = paint * step.plane + cell;
            let lay = planes[place];
            let given = floor(film * gives);
            let taken = floor(lay * takes);
            film += taken - given;
            let now = lay + (given - floor(taken * leaves));
            planes[place] = now;
            lies += now;
        }
        leave_film(paint, i, head_of.texel, texel_cells, film);
    }
    if lies > meeting.canvas {
        let height = base[cell] / step.cells_per_quantum + lies;
        raise(TOP_EVER, bitcast<u32>(max(height, 0.0)));
    }
}

@compute @workgroup_size(256)
fn blend(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(local_invocation_index) index: u32,
) {
    if index < 3u {
        atomicStore(&met[index], 0u);
    }
    workgroupBarrier();
    // Columns and rows below the head, as distances from a bias and from 1: none where they are 0.
    let first = u32(BIAS) - atomicLoad(&stats[stat(LEAST_TOUCHED)]);
    let low = u32(BIAS) - atomicLoad(&stats[stat(LEAST_TOUCHED) + 1u]);
    let high = atomicLoad(&stats[stat(MOST_TOUCHED) + 1u]);
    if id.x >= low * step.width && id.x < high * step.width {
        meet(id.x, first);
    }
    workgroupBarrier();
    if index == 0u {
        let touched = atomicLoad(&met[0]);
        if touched > 0u {
            atomicAdd(&stats[stat(TOUCHED)], touched);
            atomicAdd(&stats[stat(WET)], (atomicLoad(&met[1]) + 128u) >> 8u);
            atomicAdd(&stats[stat(THINNER)], (atomicLoad(&met[2]) + 128u) >> 8u);
        }
    }
}
