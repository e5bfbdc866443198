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

// Constants of sheets.rs and sides.rs.
override SHEET_MOST: f32;
override COVERS: f32;
override LN_ON_TOP: f32;
override TAKES: f32;

// What goes between a contact's cell and its texel.
struct Going {
    // Quanta that come from the brush, and go to it.
    quanta: vec2<f32>,
    // Share of the texel's film that comes, and of the cell's paint that goes.
    share: vec2<f32>,
}

fn going(i: u32, texel: u32) -> Going {
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
    let share = vec2(
        rounded(goes.x / max(film, 1.0), drawn, film),
        rounded(goes.y / max(totals[i], 1.0), goes.y, totals[i]),
    );
    return Going(goes, share);
}

// Cells to one side that get parts of a deposit along the step, and the share of one that is `off` cells away (Spread of
// maulstick-model).
fn reach_of_spread() -> u32 {
    let fullest = bitcast<f32>(atomicLoad(&stats[stat(FULLEST)]));
    return select(0u, (length_of_spread() + 1u) / 2u, fullest <= TAKES * step.cell_max);
}

fn part_at(off: u32) -> f32 {
    let length = length_of_spread();
    let ahead = 2 * i32(off) - i32(length);
    let whole = select(0.5, 1.0, ahead < -1);
    return select(whole, select(0.125, 0.875, ahead < 0), abs(ahead) == 1) / f32(length);
}

fn length_of_spread() -> u32 {
    return (step.packed >> 1u) & 127u;
}

// Height of the paint on a cell, cells.
fn top_of(i: u32) -> f32 {
    return totals[2u * cells() + i] + totals[i] * step.cells_per_quantum;
}

// True if the bristles on a contact's cell touch another, too.
fn gives(giver: u32, taker: u32) -> bool {
    let contact = contacts[giver];
    if contact.texel == NONE || contacts[taker].texel != NONE {
        return contact.texel != NONE;
    }
    let film = f32(load[1u + contact.texel]) * step.film_cells_per_quantum;
    return top_of(taker) > top_of(giver) - contact.reach - film;
}

// The cells to both sides of a cell of the grid along the step, nearest first, up to 4; NONE where paint cannot move.
fn beside(i: u32, reach: u32) -> array<u32, 8> {
    var found: array<u32, 8>;
    let around = around();
    let low = vec2<i32>(around.low);
    let high = vec2<i32>(around.high);
    let at = vec2<i32>(vec2(i % step.width, i / step.width));
    let within = all(at >= low) && all(at < high);
    let slope = i32(step.packed) >> 24u;
    for (var n = 0u; n < 2u * reach; n++) {
        let off = i32(n / 2u + 1u);
        let aside = (off * slope + 32) >> 6u;
        let way = select(-1, 1, (n & 1u) == 1u);
        let place = at + way * select(vec2(off, aside), vec2(aside, off), (step.packed & 1u) == 1u);
        let open = within && all(place >= low) && all(place < high);
        found[n] = select(NONE, u32(place.y) * step.width + u32(place.x), open);
    }
    return found;
}

// Shares of the upper sheet and of the body that go to the brush, and the share of the rest of the upper sheet that does
// not sink under `covered` quanta of other paint, and the share of that and the paint that comes which stays on top.
fn parted(i: u32, top: f32, going: Going, leaves: f32, covered: f32) -> vec4<f32> {
    let lying = totals[i];
    let contact = contacts[i];
    let goes = going.quanta;
    let reach = max(step.shear * contact.fraction * lying, goes.y);
    let over = top / max(reach, 1.0);
    let off_top = min(goes.y * min(over, 1.0), top);
    let body = lying - top;
    let travel = length(contact.moved) * step.cell_per_reference;
    let ploughed = LN_ON_TOP * travel * max(1.0 - over, 0.0);
    let kept = decay(min(ploughed - covered / COVERS, 0.0));
    let left = (top - leaves * off_top) * kept + goes.x;
    return vec4(
        rounded(off_top / max(top, 1.0), off_top, top),
        rounded((goes.y - off_top) / max(body, 1.0), goes.y - off_top, body),
        kept,
        min(SHEET_MOST / max(left, 1.0), 1.0),
    );
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

// Share of a cell's paint that the step pushes over the border of the surface.
fn over_border(i: u32, total: f32) -> f32 {
    let at = vec2(step.from_x + i % step.width, step.from_y + i / step.width);
    let limit = vec2(step.limit_x, step.limit_y);
    let contact = contacts[i];
    let parts = f32((step.packed >> 12u) & 4095u);
    let pressed = contact.squish * max(contact.reach, 0.0) * contact.cover;
    var share = 0.0;
    for (var axis = 0u; axis < 2u; axis++) {
        let ends = (step.packed >> (8u + 2u * axis)) & 3u;
        let low = (ends & 1u) == 1u && at[axis] == 0u;
        if low || ((ends & 2u) == 2u && at[axis] + 1u == limit[axis]) {
            let moved = select(1.0, -1.0, low) * contact.moved[axis];
            share += clamp(parts * (contact.follows * moved + pressed), 0.0, 1.0);
        }
    }
    return min(share, 1.0) * max(total - step.stain, 0.0) / max(total, 1.0);
}

@compute @workgroup_size(256)
fn exchange_apply(@builtin(global_invocation_id) id: vec3<u32>) {
    let i = id.x;
    if i >= cells() {
        return;
    }
    let texel = contacts[i].texel;
    let touched = texel != NONE;
    let reach = reach_of_spread();
    if !touched && reach == 0u {
        note_left(i, totals[i]);
        return;
    }
    let layered = step.sheets != 0u;
    let cell = cell_of(i % step.width, i / step.width);
    // Its own deposit goes to the open sides; it gets those of the contacts among them.
    var sides = beside(i, reach);
    var texel_of: array<u32, 8>;
    var share_of: array<f32, 8>;
    var gets = false;
    var covered = 0.0;
    // Of paint that comes from beside only those kinds count that come onto a cell without a contact.
    var comes_beside = NONE;
    var open = 0.0;
    for (var n = 0u; n < 2u * reach; n++) {
        texel_of[n] = NONE;
        if sides[n] == NONE {
            continue;
        }
        let part = part_at(n / 2u + 1u);
        let opens = gives(i, sides[n]);
        open += select(0.0, part, opens);
        let giver_at = sides[n];
        let giver = contacts[giver_at].texel;
        let got = gives(giver_at, i);
        if !opens {
            sides[n] = NONE;
        }
        if !got {
            continue;
        }
        gets = true;
        let came = going(giver_at, giver);
        texel_of[n] = giver;
        share_of[n] = came.share.x;
        if layered {
            let note = faces[giver_at];
            covered += part * came.quanta.x * note.x;
            comes_beside = besides(comes_beside, as_paints(note.y));
        }
    }
    if !touched && !gets {
        note_left(i, totals[i]);
        return;
    }
    var own = Going(vec2(0.0), vec2(0.0));
    var only = comes_beside;
    if touched {
        own = going(i, texel);
        only = NONE;
        if layered {
            covered += (1.0 - open) * own.quanta.x * faces[i].x;
            only = as_paints(faces[i].y);
        }
    }
    // Lasting paint loses only the amount that arrives.
    var leaves = 1.0;
    if step.lasting != 0u && own.quanta.y > own.quanta.x {
        leaves = own.quanta.x / own.quanta.y;
    }
    var sheets = vec4(0.0, own.share.y, 0.0, 0.0);
    if layered {
        var top = 0.0;
        for (var paint = 0u; paint < step.planes; paint++) {
            let there = planes[paint * step.plane + cell];
            top += min(planes[upper_of(paint, cell)], there);
            only = besides(only, select(NONE, paint, there > 0.0));
        }
        if touched {
            sheets = parted(i, top, own, leaves, covered);
        } else {
            sheets = vec4(0.0, 0.0, decay(-covered / COVERS), 1.0);
        }
    }
    let two = layered && only == SEVERAL;
    var over = 0.0;
    if touched && step.push != 0u {
        over = over_border(i, totals[i]);
    }
    var sum = 0.0;
    for (var paint = 0u; paint < step.planes; paint++) {
        let at = paint * step.plane + cell;
        let there = planes[at];
        var left = 0.0;
        if touched {
            left = trunc(f32(load[film_of(paint) + texel]) * own.share.x);
        }
        var sent = 0.0;
        var came = 0.0;
        for (var n = 0u; n < 2u * reach; n++) {
            let part = part_at(n / 2u + 1u);
            if sides[n] != NONE {
                sent += trunc(left * part);
            }
            if texel_of[n] != NONE {
                let given = trunc(f32(load[film_of(paint) + texel_of[n]]) * share_of[n]);
                came += trunc(given * part);
            }
        }
        var above = 0.0;
        if layered {
            above = min(planes[upper_of(paint, cell)], there);
        }
        let off_top = min(trunc(above * sheets.x), above);
        let taken = off_top + min(trunc((there - above) * sheets.y), there - above);
        if layered {
            let stays = trunc((above - trunc(leaves * off_top)) * sheets.z);
            let upper = max(trunc((stays + left) * sheets.w) - sent, 0.0) + came;
            if touched || two {
                planes[upper_of(paint, cell)] = select(0.0, upper, two);
            }
        }
        var now = there + left - sent + came - trunc(leaves * taken);
        now -= trunc(now * over);
        sum += now;
        if left != 0.0 || taken != 0.0 || came != 0.0 || over > 0.0 {
            planes[at] = now;
        }
        if touched && (left != 0.0 || taken != 0.0) && step.transfer != SPONGE {
            // In two's complement a negative change is added as well.
            let change = u32(i32(taken) - i32(left));
            atomicAdd(&asks[change_of(paint) + texel], change);
        }
    }
    note_left(i, sum);
}
