// Requests of each cell to its texel, and offers to it (Baxter 2004, Algorithm 3, by path length), summed by texel.

// Constants of transfer.rs in maulstick-model.
override SKIN: f32;
override NEAR: f32;
override POOL: f32;
override SPLITS: f32;

// Share of a gap that fills where `share` of a difference evens out: 1 − (1 − share)¹⁶.
fn filled(share: f32) -> f32 {
    var kept = (1.0 - share) * (1.0 - share);
    kept *= kept;
    kept *= kept;
    return 1.0 - kept * kept;
}

fn transfer(on_brush: f32, on_canvas: f32, lies: f32, gap: f32, share: f32, travel: f32) -> f32 {
    let free = max(on_brush - gap, 0.0);
    // A film that bridges the gap under a bristle splits.
    let splits = max(on_brush - step.evens * SPLITS * (on_brush + lies), 0.0);
    let fill = filled(share) * min(min(gap, free), splits);
    let difference = step.evens * free - on_canvas;
    let donor = select(on_canvas, on_brush - fill, difference > 0.0);
    let amount = min(min(share * abs(difference), step.most_over * travel), donor);
    return fill + select(-amount, amount, difference > 0.0);
}

// Notes the only paint of a contact's texel, and how far its mixture is from that of the upper sheet: 1 less the cosine
// of the angle between them.
fn note_sheet(i: u32, texel: u32) {
    let cell = cell_of(i % step.width, i / step.width);
    var only = NONE;
    // Sums of the squares of the texel's paints, of the sheet's, and of their products.
    var sums = vec3(0.0);
    for (var paint = 0u; paint < step.planes; paint++) {
        let above = min(planes[upper_of(paint, cell)], planes[paint * step.plane + cell]);
        let film = f32(load[film_of(paint) + texel]);
        sums += vec3(film * film, above * above, film * above);
        only = besides(only, select(NONE, paint, film > 0.0));
    }
    faces[i] = vec2(1.0 - sums.z / max(sqrt(sums.x * sums.y), 1.0), as_number(only));
}

@compute @workgroup_size(256)
fn exchange_ask(@builtin(global_invocation_id) id: vec3<u32>) {
    let i = id.x;
    if i >= cells() {
        return;
    }
    let contact = contacts[i];
    if contact.texel == NONE {
        return;
    }
    let lying = totals[i];
    let travel = length(contact.moved) * step.cell_per_reference;
    let on_brush = f32(load[1u + contact.texel]) * step.film_units_per_quantum;
    let lies = lying / QUANTA_PER_UNIT;
    let on_canvas = lies * contact.fraction * step.shear;
    let gap = max(-contact.reach, 0.0) / (step.cells_per_quantum * QUANTA_PER_UNIT);
    var net = step.flow * travel;
    var swap = 0.0;
    if step.transfer != MARKER {
        let share = 1.0 - decay(step.ln_kept * travel);
        net = transfer(on_brush, on_canvas, lies, gap, share, travel);
        let skin = min(min(max(on_brush - gap, 0.0), lies), SKIN);
        swap = min(step.swap * travel * (NEAR / (NEAR + gap)), 1.0) * skin;
    }
    let quanta = contact.cover * QUANTA_PER_UNIT;
    let pool = min(gap * QUANTA_PER_UNIT, POOL * step.most);
    let most = min(step.most + pool, step.cell_max);
    let room = max(most - lying, 0.0);
    // Exchanged paint has room on both sides, or stays on both.
    swap = min(swap * quanta, room);
    let to_canvas = trunc(min(max(net, 0.0) * quanta + swap, room));
    let to_brush = trunc(min(max(-net, 0.0) * quanta + swap, lying));
    wants[i] = vec2(to_canvas, to_brush);
    if step.sheets != 0u {
        note_sheet(i, contact.texel);
    }
    atomicAdd(&asks[contact.texel], u32(to_canvas));
    atomicAdd(&asks[texels() + contact.texel], u32(to_brush));
    atomicStore(&asks[touch_of(contact.texel / TEXELS_PER_STRIP)], 1u);
}
