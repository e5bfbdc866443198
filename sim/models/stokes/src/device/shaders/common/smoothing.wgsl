// Stages of a V-cycle on one level. On the finest one right-hand side and solution are those of the call.

// Inverses of the roots of a Chebyshev polynomial on [1/3, 2], the part of the spectrum that no coarser grid resolves.
const FIRST = 0.5695;
const SECOND = 1.732;
// Number of steps on the coarsest grid.
const COARSEST_STEPS = 16u;
// Seeded fault of tests; 1 without one.
override fault_smoothing: f32 = 1.0;

fn right_of(level: u32, component: u32) -> u32 {
    let own = call.source + (component - call.first) * window.levels[0].len;
    return select(part(level, component, RIGHT), own, level == 0u);
}

fn solution_of(level: u32, component: u32) -> u32 {
    let own = call.into + (component - call.first) * window.levels[0].len;
    return select(part(level, component, SOLUTION), own, level == 0u);
}

// Links of a place, low and high by axis.
struct Links {
    low: vec3<f32>,
    high: vec3<f32>,
}

fn links_of(level: u32, component: u32, at: u32) -> Links {
    let by = strides(level);
    let x = part(level, component, LINKS) + at;
    let y = x + window.levels[level].len;
    let z = y + window.levels[level].len;
    return Links(
        vec3(fields[x], fields[y], fields[z]),
        vec3(fields[x + by.x], fields[y + by.y], fields[z + by.z]),
    );
}

fn lower(by: vec3<u32>, at: u32) -> vec3<f32> {
    return vec3(fields[at - by.x], fields[at - by.y], fields[at - by.z]);
}

fn upper(by: vec3<u32>, at: u32) -> vec3<f32> {
    return vec3(fields[at + by.x], fields[at + by.y], fields[at + by.z]);
}

fn sum_of(values: vec3<f32>) -> f32 {
    return (values.x + values.y) + values.z;
}

// Two steps from zero: by ω, then by ψ.
fn begin_at(level: u32, component: u32, spot: Spot, omega: f32, psi: f32) {
    let inverse = part(level, component, INVERSE) + spot.at;
    let b = right_of(level, component) + spot.at;
    var value = 0.0;
    if fields[inverse] > 0.0 {
        let by = strides(level);
        let links = links_of(level, component, spot.at);
        let low = links.low * (lower(by, b) * lower(by, inverse));
        let high = links.high * (upper(by, b) * upper(by, inverse));
        let first = omega * (fields[inverse] * fields[b]);
        let pull = sum_of(low + high);
        value = first + psi * (fields[inverse] * (fields[b] + omega * pull) - first);
    }
    fields[solution_of(level, component) + spot.place] = value;
}

// A damped Jacobi step.
fn relax_at(level: u32, component: u32, spot: Spot, omega: f32, source: u32, into: u32) {
    let inverse = fields[part(level, component, INVERSE) + spot.at];
    var value = 0.0;
    if inverse > 0.0 {
        let by = strides(level);
        let links = links_of(level, component, spot.at);
        let x = source + spot.at;
        let pull = sum_of(links.low * lower(by, x) + links.high * upper(by, x));
        let b = fields[right_of(level, component) + spot.at];
        value = fields[x] + fault_smoothing * omega * (inverse * (b + pull) - fields[x]);
    }
    fields[into + spot.place] = value;
}

// Residual times the scale of interpolation.
fn leave_at(level: u32, component: u32, spot: Spot) {
    let scale = fields[part(level, component, SCALE) + spot.at];
    var value = 0.0;
    if scale > 0.0 {
        let by = strides(level);
        let links = links_of(level, component, spot.at);
        let x = solution_of(level, component) + spot.at;
        let inertia = fields[part(level, component, INERTIA) + spot.at];
        let diagonal = inertia + sum_of(links.low + links.high);
        let pull = sum_of(links.low * lower(by, x) + links.high * upper(by, x));
        let b = fields[right_of(level, component) + spot.at];
        value = scale * (b - diagonal * fields[x] + pull);
    }
    fields[part(level, component, SPARE) + spot.place] = value;
}

// Right-hand side of the next level.
fn restrict_at(level: u32, component: u32, spot: Spot) {
    let coarse = level + 1u;
    var total = 0.0;
    if fields[part(coarse, component, INVERSE) + spot.at] > 0.0 {
        let places = around(level, component, spot.cell, vec3(RESTRICTION));
        let start = part(level, component, SPARE);
        let by = strides(level);
        let first = start + index(level, places.first);
        for (var z = 0; z < places.count.z; z++) {
            for (var y = 0; y < places.count.y; y++) {
                let weight = places.y[y] * places.z[z];
                let row = first + u32(y) * by.y + u32(z) * by.z;
                for (var x = 0; x < places.count.x; x++) {
                    total += weight * places.x[x] * fields[row + u32(x)];
                }
            }
        }
    }
    fields[part(coarse, component, RIGHT) + spot.place] = total;
}

// Adds the correction of the next level.
fn prolong_at(level: u32, component: u32, spot: Spot) {
    let scale = fields[part(level, component, SCALE) + spot.at];
    if scale > 0.0 {
        let start = part(level + 1u, component, SOLUTION);
        fields[solution_of(level, component) + spot.place] += scale * between(level, component, spot.cell, start);
    }
}
