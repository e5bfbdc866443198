// After the last blend, returns the cells' quanta to the texels; then refills the surfaces of the strips that touch
// from their reservoirs, in whole deep units, and paint runs down them (reservoir.rs in maulstick-dab). Counts the
// step's contacts. A workgroup has a strip; an invocation one of its texels, and some of each texel's paints.

const LANES = 16u;

// Quanta of each paint on the surfaces of the strip's texels, and inside, for at most 64 paints.
var<workgroup> surface: array<u32, 1024>;
var<workgroup> inside_it: array<u32, 1024>;

// Adds to a sum of all steps, without other writers.
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

fn place_of(paint: u32, k: u32) -> u32 {
    return paint * TEXELS_PER_STRIP + k;
}

// Quanta of all paints on the surface and inside of a texel.
fn held(k: u32) -> vec2<f32> {
    var sums = vec2(0u);
    for (var paint = 0u; paint < step.planes; paint++) {
        sums += vec2(surface[place_of(paint, k)], inside_it[place_of(paint, k)]);
    }
    return vec2<f32>(sums);
}

// Whole deep units of an amount, in quanta.
fn deep_units(quanta: f32, first: u32, texel: u32) -> f32 {
    let threshold = first + increase(texel, blend_of.across_high, blend_of.across_low);
    return floor(blend_of.rate * quanta / blend_of.deep + threshold_of(threshold)) * blend_of.deep;
}

// Part of a count by a share, as far as the other count has room for it.
fn part(there: u32, share: f32, other_one: u32) -> u32 {
    return min(min(u32(f32(there) * share), there), 0xffffffffu - other_one);
}

// Share that rises from inside a texel, and share that sinks into it.
fn flow_of(strip: u32, k: u32) -> vec2<f32> {
    let holds = held(k);
    let texel = strip * TEXELS_PER_STRIP + k;
    let lacks = blend_of.full_surface - holds.x;
    if lacks > 0.0 {
        let rises = min(deep_units(lacks, blend_of.threshold_flows, texel), holds.y);
        return vec2(select(0.0, rises / holds.y, rises > 0.0), 0.0);
    }
    let room = max(blend_of.full_inside - holds.y, 0.0);
    let sinks = min(min(deep_units(-lacks, blend_of.threshold_flows, texel), room), holds.x);
    return vec2(0.0, select(0.0, sinks / holds.x, sinks > 0.0));
}

// Share that runs down from the texel above.
fn run_of(strip: u32, k: u32) -> f32 {
    let upper = held(k - 1u).x;
    let even = 0.5 * max(upper - held(k).x, 0.0);
    let texel = strip * TEXELS_PER_STRIP + k;
    let flow = min(deep_units(even, blend_of.threshold_runs, texel), upper);
    return select(0.0, flow / upper, flow > 0.0);
}

fn flow_in(shares: vec2<f32>, k: u32, lane: u32) {
    for (var paint = lane; paint < step.planes; paint += LANES) {
        let at = place_of(paint, k);
        let rises = part(inside_it[at], shares.x, surface[at]);
        let sinks = part(surface[at], shares.y, inside_it[at]);
        surface[at] += rises - sinks;
        inside_it[at] += sinks - rises;
    }
}

fn run_down(share: f32, k: u32, lane: u32) {
    for (var paint = lane; paint < step.planes; paint += LANES) {
        let at = place_of(paint, k);
        let runs = part(surface[at - 1u], share, surface[at]);
        surface[at - 1u] -= runs;
        surface[at] += runs;
    }
}

@compute @workgroup_size(16)
fn refill(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let strip = group.x;
    let texel = strip * TEXELS_PER_STRIP + lane;
    if strip == 0u && lane == 0u {
        count_step();
    }
    give_back_to(texel);
    for (var paint = 0u; paint < step.planes; paint++) {
        surface[place_of(paint, lane)] = load[film_of(paint) + texel];
        inside_it[place_of(paint, lane)] = load[inside_of(paint) + texel];
    }
    storageBarrier();
    workgroupBarrier();
    let touched = atomicLoad(&stats[stat(TOUCHED)]) != 0u && blend_of.refills != 0u;
    let over = atomicLoad(&asks[touch_of(strip)]) != 0u;
    let flows = touched && over;
    // From the point up, so that paint runs down by one texel a step.
    for (var k = TEXELS_PER_STRIP; k > 0u; k--) {
        var shares = vec2(0.0);
        if flows {
            shares = flow_of(strip, k - 1u);
        }
        workgroupBarrier();
        flow_in(shares, k - 1u, lane);
        workgroupBarrier();
        if k > 1u {
            var share = 0.0;
            if flows {
                share = run_of(strip, k - 1u);
            }
            workgroupBarrier();
            run_down(share, k - 1u, lane);
            workgroupBarrier();
        }
    }
    if touched {
        var film = 0u;
        for (var paint = 0u; paint < step.planes; paint++) {
            let at = place_of(paint, lane);
            load[film_of(paint) + texel] = surface[at];
            load[inside_of(paint) + texel] = inside_it[at];
            film += surface[at];
        }
        load[1u + texel] = film;
    }
    if lane == 0u {
        atomicStore(&asks[touch_of(strip)], 0u);
    }
}
