// Adds up partial sums, and computes the result. Quotients of zeros are zero: a negligible direction contributes
// nothing.

// Drag of walls on paint of thickness one, relative to its viscosity: between 3 for a film and 12 for a gap.
const GAP_DRAG = 6.0;
const SMALLEST = 1e-36;
const LARGEST = 3e38;

var<workgroup> totals: array<f32, 32>;

fn is_positive(value: f32) -> bool {
    return value > SMALLEST && value < LARGEST;
}

fn ratio(value: f32, by: f32) -> f32 {
    let whole = select(1.0, by, is_positive(by));
    let part = select(0.0, value / whole, is_positive(by));
    return select(0.0, part, abs(part) < LARGEST);
}

// Sums of up to 16 rows of partial sums.
fn add_rows(local: u32, first: u32, count: u32) {
    let row = local / 16u;
    var sum = 0.0;
    if row < count {
        let start = window.partials + (first + row) * call.groups;
        for (var i = local % 16u; i < call.groups; i += 16u) {
            sum += fields[start + i];
        }
    }
    lanes[local] = sum;
    workgroupBarrier();
    if local < count {
        var whole = 0.0;
        for (var i = 0u; i < 16u; i++) {
            whole += lanes[16u * local + i];
        }
        totals[first + local] = whole;
    }
    workgroupBarrier();
}

fn weigh() {
    let thickness = select(1.0, totals[0] / totals[1], totals[1] > 0.0);
    fields[scalar(WALL)] = window.beta * GAP_DRAG / (window.alpha * thickness * thickness);
}

fn note_norm() {
    fields[scalar(NORMS + call.axis)] = sqrt(totals[NORM_ROW]);
}

// Share of an image's square below which its remainder is orthogonalised again.
const CANCELLED = 1e-3;

fn find_shares(is_second: bool) {
    for (var i = 0u; i < call.number; i++) {
        let share = ratio(totals[i], fields[scalar(SQUARED + i)]);
        let parts = scalar(PARTS + 24u * call.number + i);
        fields[scalar(SHARES + i)] = share;
        fields[parts] = share + select(0.0, fields[parts], is_second);
    }
    fields[scalar(WHOLE)] = totals[call.number];
}

fn find_answer() {
    let is_left = totals[0] > CANCELLED * fields[scalar(WHOLE)];
    fields[scalar(AGAIN)] = select(1.0, 0.0, is_left || call.number == 0u);
    fields[scalar(SQUARED + call.number)] = select(0.0, totals[0], is_positive(totals[0]));
    fields[scalar(ANSWERS + call.number)] = ratio(totals[1], totals[0]);
}

// Weights of the unmodified directions.
fn find_weights() {
    for (var left = call.number; left > 0u; left--) {
        let number = left - 1u;
        var weight = fields[scalar(ANSWERS + number)];
        for (var later = left; later < call.number; later++) {
            weight -= fields[scalar(PARTS + 24u * later + number)] * fields[scalar(SHARES + later)];
        }
        fields[scalar(SHARES + number)] = weight;
    }
}

@compute @workgroup_size(256)
fn add_up(@builtin(local_invocation_index) local: u32) {
    // 0: columns; 1: shares, with the norm; 2: the answer, with the norm where it is the first; 3: weights, with the
    // norm; 4: the mean of the deficit; 5: the product with the preconditioned; 6: the curvature; 7 and 8: 1 and 2 of
    // the second round.
    switch call.mode {
        case 0u: {
            add_rows(local, 0u, 2u);
            if local == 0u {
                weigh();
            }
        }
        case 1u: {
            add_rows(local, 0u, min(call.number + 1u, 16u));
            add_rows(local, 16u, max(call.number + 1u, 16u) - 16u);
            add_rows(local, NORM_ROW, 1u);
            if local == 0u {
                find_shares(false);
                note_norm();
            }
        }
        case 2u: {
            add_rows(local, 0u, 2u);
            add_rows(local, NORM_ROW, 1u);
            if local == 0u {
                find_answer();
                if call.number == 0u {
                    note_norm();
                }
            }
        }
        case 3u: {
            add_rows(local, NORM_ROW, 1u);
            if local == 0u {
                find_weights();
                note_norm();
            }
        }
        case 4u: {
            add_rows(local, 0u, 3u);
            if local == 0u {
                // A place with a link to a known one makes the pressure unique.
                let mean = ratio(totals[0], totals[1]);
                fields[scalar(MEAN)] = select(0.0, mean, totals[2] == 0.0);
                fields[scalar(BEFORE)] = 0.0;
            }
        }
        case 5u: {
            add_rows(local, 0u, 1u);
            add_rows(local, NORM_ROW, 1u);
            if local == 0u {
                let now = select(0.0, totals[0], is_positive(totals[0]));
                fields[scalar(TURN)] = ratio(now, fields[scalar(BEFORE)]);
                fields[scalar(BEFORE)] = now;
                fields[scalar(PRESSURE_NORMS + call.axis)] = sqrt(totals[NORM_ROW]);
            }
        }
        case 7u: {
            add_rows(local, 0u, min(call.number + 1u, 16u));
            add_rows(local, 16u, max(call.number + 1u, 16u) - 16u);
            if local == 0u && fields[scalar(AGAIN)] > 0.0 {
                find_shares(true);
            }
        }
        case 8u: {
            add_rows(local, 0u, 2u);
            if local == 0u && fields[scalar(AGAIN)] > 0.0 {
                find_answer();
            }
        }
        default: {
            add_rows(local, 0u, 1u);
            if local == 0u {
                fields[scalar(REACH)] = ratio(fields[scalar(BEFORE)], totals[0]);
            }
        }
    }
}
