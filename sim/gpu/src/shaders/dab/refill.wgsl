// The surfaces of strips whose turn it is are filled again from their reservoirs, in whole deep units, and paint runs
// down them (reservoir.rs in maulstick-dab). What the step met is counted.

// Adds to a sum of all steps; nobody else does.
fn tally(sum: u32, which: u32) {
    let before = bitcast<f32>(atomicLoad(&stats[sum]));
    let more = f32(atomicLoad(&stats[stat(which)])) * WET_UNIT;
    atomicStore(&stats[sum], bitcast<u32>(before + more));
}

fn count_step() {
    load[0] += 1u;
    atomicAdd(&stats[0], atomicLoad(&stats[stat(TOUCHED)]));
    tally(1u, WET);
    tally(2u, THINNER);
    let top = bitcast<f32>(atomicLoad(&stats[stat(TOP)]));
    atomicMax(&stats[TOP_EVER], bitcast<u32>(top / step.cells_per_quantum));
}

// Quanta of all paints on the surface and inside of a texel.
fn held(texel: u32) -> vec2<u32> {
    var sums = vec2(0u);
    for (var paint = 0u; paint < step.planes; paint++) {
        sums += vec2(load[film_of(paint) + texel], load[inside_of(paint) + texel]);
    }
    return sums;
}

// Deep units of so much as comes on the way, in quanta.
fn deep_units(quanta: f32, first: u32, texel: u32) -> f32 {
    let threshold = first + increase(texel, blend_of.across_high, blend_of.across_low);
    return floor(blend_of.rate * quanta / blend_of.deep + threshold_of(threshold)) * blend_of.deep;
}

// Moves a share from one place to another, as far as that can count it.
fn share_out(from_at: u32, to_at: u32, share: f32) {
    let there = load[from_at];
    let goes = min(min(u32(f32(there) * share), there), 0xffffffffu - load[to_at]);
    load[from_at] = there - goes;
    load[to_at] += goes;
}

fn flow_in(texel: u32) {
    let holds = vec2<f32>(held(texel));
    let lacks = blend_of.full_surface - holds.x;
    let rises = min(deep_units(lacks, blend_of.threshold_flows, texel), holds.y);
    let room = max(blend_of.full_inside - holds.y, 0.0);
    let sinks = min(min(deep_units(-lacks, blend_of.threshold_flows, texel), room), holds.x);
    for (var paint = 0u; paint < step.planes; paint++) {
        let film = film_of(paint) + texel;
        let inside = inside_of(paint) + texel;
        if lacks > 0.0 && rises > 0.0 {
            share_out(inside, film, rises / holds.y);
        } else if lacks <= 0.0 && sinks > 0.0 {
            share_out(film, inside, sinks / holds.x);
        }
    }
}

fn run_down(texel: u32) {
    let upper = f32(held(texel - 1u).x);
    let even = 0.5 * max(upper - f32(held(texel).x), 0.0);
    let flow = min(deep_units(even, blend_of.threshold_runs, texel), upper);
    if flow <= 0.0 {
        return;
    }
    for (var paint = 0u; paint < step.planes; paint++) {
        let film = film_of(paint) + texel;
        share_out(film - 1u, film, flow / upper);
    }
}

@compute @workgroup_size(64)
fn refill(@builtin(global_invocation_id) id: vec3<u32>) {
    let strip = id.x;
    if strip == 0u {
        count_step();
    }
    if strip >= step.strips {
        return;
    }
    let over = atomicLoad(&asks[touch_of(strip)]) != 0u;
    atomicStore(&asks[touch_of(strip)], 0u);
    if atomicLoad(&stats[stat(TOUCHED)]) == 0u || blend_of.turn == NONE {
        return;
    }
    if over && strip % FLOW_STEPS == blend_of.turn {
        // From the point up: what runs down in one step goes a texel far.
        for (var k = TEXELS_PER_STRIP; k > 0u; k--) {
            let texel = strip * TEXELS_PER_STRIP + k - 1u;
            flow_in(texel);
            if k > 1u {
                run_down(texel);
            }
        }
    }
    for (var k = 0u; k < TEXELS_PER_STRIP; k++) {
        let texel = strip * TEXELS_PER_STRIP + k;
        load[1u + texel] = held(texel).x;
    }
}
