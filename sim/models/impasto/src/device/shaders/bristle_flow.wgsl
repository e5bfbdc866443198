// Adds the exchanged paint to the films of touching strips. Paint also moves within a strip: from inside to a
// film that lacks some, from one with an excess inward, and along.

// Share by which a film of thinner alone is thinner than one of paint.
const RUNS_OFF = 0.7;

// Part of `there` by a share, at most `left`.
fn part(there: u32, share: f32, left: u32) -> u32 {
    return min(u32(f32(there) * share), left);
}

// Share of thinner in a strip's paint.
fn thinner_in(strip: u32, all: f32) -> f32 {
    if step.thinner == NONE {
        return 0.0;
    }
    var thin = 0.0;
    for (var k = 0u; k < TEXELS_PER_STRIP; k++) {
        let texel = strip * TEXELS_PER_STRIP + k;
        thin += f32(load[film_of(step.thinner) + texel] + load[inside_of(step.thinner) + texel]);
    }
    return select(0.0, thin / all, all > 0.0);
}

fn flow_in(strip: u32) {
    let first = strip * TEXELS_PER_STRIP;
    var film: array<f32, 16>;
    var inside: array<f32, 16>;
    for (var paint = 0u; paint < step.planes; paint++) {
        for (var k = 0u; k < TEXELS_PER_STRIP; k++) {
            film[k] += f32(load[film_of(paint) + first + k]);
            inside[k] += f32(load[inside_of(paint) + first + k]);
        }
    }
    let capacity = head[4u * step.faces + 2u * step.vertices + step.strips + strip];
    var all = 0.0;
    for (var k = 0u; k < TEXELS_PER_STRIP; k++) {
        all += film[k] + inside[k];
    }
    let thin = 1.0 - RUNS_OFF * thinner_in(strip, all);
    let full = step.film_full * bitcast<f32>(capacity) * thin;
    // Shares of the paint inside that go out, forward and back, and of the film that go inward.
    var out: array<f32, 16>;
    var inward: array<f32, 16>;
    var onward: array<f32, 16>;
    var back: array<f32, 16>;
    for (var k = 0u; k < TEXELS_PER_STRIP; k++) {
        let missing = full - film[k];
        if missing > 0.0 && inside[k] > 0.0 {
            out[k] = min(step.refill * missing / inside[k], step.refill);
        } else if missing < 0.0 {
            inward[k] = step.refill * -missing / film[k];
        }
        if k + 1u < TEXELS_PER_STRIP {
            let fall = step.creep * (inside[k] - inside[k + 1u]);
            if fall > 0.0 {
                onward[k] = fall / inside[k];
            } else if fall < 0.0 {
                back[k + 1u] = -fall / inside[k + 1u];
            }
        }
    }
    for (var k = 0u; k < TEXELS_PER_STRIP; k++) {
        let leaves = max(out[k] + onward[k] + back[k], 1.0);
        out[k] /= leaves;
        onward[k] /= leaves;
        back[k] /= leaves;
    }
    for (var paint = 0u; paint < step.planes; paint++) {
        var before: array<u32, 16>;
        for (var k = 0u; k < TEXELS_PER_STRIP; k++) {
            before[k] = load[inside_of(paint) + first + k];
        }
        for (var k = 0u; k < TEXELS_PER_STRIP; k++) {
            let at = inside_of(paint) + first + k;
            let film_at = film_of(paint) + first + k;
            let held = load[film_at];
            let rises = part(before[k], out[k], before[k]);
            let on = part(before[k], onward[k], before[k] - rises);
            let returns = part(before[k], back[k], before[k] - rises - on);
            let sinks = part(held, inward[k], held);
            load[film_at] = held + rises - sinks;
            load[at] = load[at] + sinks - rises - on - returns;
            if on > 0u {
                load[at + 1u] += on;
            }
            if returns > 0u {
                load[at - 1u] += returns;
            }
        }
    }
}

@compute @workgroup_size(64)
fn bristle_flow(@builtin(global_invocation_id) id: vec3<u32>) {
    let strip = id.x;
    if strip >= step.strips {
        return;
    }
    atomicStore(&asks[touch_of(strip)], 0u);
    for (var k = 0u; k < TEXELS_PER_STRIP; k++) {
        let texel = strip * TEXELS_PER_STRIP + k;
        atomicStore(&asks[texel], 0u);
        atomicStore(&asks[texels() + texel], 0u);
        for (var paint = 0u; paint < step.planes; paint++) {
            let change = change_of(paint) + texel;
            load[film_of(paint) + texel] += atomicLoad(&asks[change]);
            atomicStore(&asks[change], 0u);
        }
    }
    flow_in(strip);
    for (var k = 0u; k < TEXELS_PER_STRIP; k++) {
        let texel = strip * TEXELS_PER_STRIP + k;
        var sum = 0u;
        for (var paint = 0u; paint < step.planes; paint++) {
            sum += load[film_of(paint) + texel];
        }
        load[1u + texel] = sum;
    }
}
