// What levels under the brush while it goes the mean way of its contacts: wet paint flows under its own
// surface tension and weight until its yield stress holds it (levelling.rs in maulstick-paint). The share of
// a donor's paint that goes through each face is added to the velocities.

// ADVANCES and THINS of levelling.rs.
override ADVANCES: f32;
override THINS: f32;
// The most of a donor's paint that levels through a face.
const MOST_OF_DONOR = 0.25;

struct Film {
    // Height of the wet paint, and of its surface.
    wet: f32,
    surface: f32,
}

// A cell; beside the window it is as at its edge.
fn film_at(at: vec2<i32>) -> Film {
    let corner = vec2(i32(step.from_x), i32(step.from_y));
    let limit = vec2(i32(step.limit_x), i32(step.limit_y));
    let place = clamp(at, -corner, limit - corner - 1);
    if all(place >= vec2(0)) && all(place < vec2(i32(step.width), i32(step.height))) {
        let i = u32(place.y) * step.width + u32(place.x);
        let wet = totals[i] * step.cells_per_quantum;
        return Film(wet, totals[2u * cells() + i] + wet);
    }
    let cell = u32(corner.y + place.y) * step.row + u32(corner.x + place.x);
    var total = 0.0;
    for (var paint = 0u; paint < step.planes; paint++) {
        total += planes[paint * step.plane + cell];
    }
    let wet = total * step.cells_per_quantum;
    return Film(wet, base[cell] + wet);
}

struct Side {
    film: Film,
    curve: f32,
    // Yield stress and fluidity by those of paint from the tube.
    yields: f32,
    fluid: f32,
}

// A cell of the grid, by the films of those around it.
fn side_of(at: vec2<i32>, own: Film, below: Film, above: Film, before: Film, after: Film) -> Side {
    let curve = below.surface + above.surface + before.surface + after.surface - 4.0 * own.surface;
    let thinner = totals[3u * cells() + u32(at.y) * step.width + u32(at.x)];
    let left = max(1.0 - 2.0 * thinner, 0.0);
    return Side(own, curve, left * left * left, 1.0 / decay(-THINS * thinner));
}

// The share of the donor's paint that goes on through the face between two cells.
fn flow(own: Side, next: Side, mobility: f32) -> f32 {
    // Pressure falls where curvature grows.
    let drop = own.film.surface - next.film.surface;
    let gradient = step.tension * (next.curve - own.curve) + step.weight * drop;
    let height = 0.5 * (own.film.wet + next.film.wet);
    let yields = 0.5 * (own.yields + next.yields);
    let sheared = max(height - yields / max(abs(gradient), 1e-12), 0.0);
    let mobile = mobility * 0.5 * (own.fluid + next.fluid);
    let moves = mobile * sheared * sheared * (3.0 * height - sheared) / 6.0;
    let goes = min(moves, step.most_mobile) * gradient;
    let donor = select(next.film.wet, own.film.wet, goes > 0.0);
    let onto = select(own.film.wet, next.film.wet, goes > 0.0);
    let bare = step.stain * step.cells_per_quantum;
    if donor <= bare || (onto <= bare && abs(drop) < ADVANCES * yields) {
        return 0.0;
    }
    return clamp(goes / max(donor, 1e-9), -MOST_OF_DONOR, MOST_OF_DONOR);
}

// The mean way of the contacts, cells.
fn mean_way() -> f32 {
    let low = f32(atomicLoad(&stats[stat(WAY)]));
    let high = f32(atomicLoad(&stats[stat(WAY) + 1u])) * f32(1u << LOW_BITS);
    return (high + low) / PER_CELL / f32(atomicLoad(&stats[stat(TOUCHED)]));
}

@compute @workgroup_size(256)
fn level_paint(@builtin(global_invocation_id) id: vec3<u32>) {
    let i = id.x;
    if i >= cells() {
        return;
    }
    let cell = vec2(i % step.width, i / step.width);
    let around = around();
    if any(cell < around.low) || any(cell >= around.high) {
        wants[i] = faces[i];
        return;
    }
    let at = vec2<i32>(cell);
    let x = vec2(1, 0);
    let y = vec2(0, 1);
    let own = film_at(at);
    let right = film_at(at + x);
    let above = film_at(at + y);
    let diagonal = film_at(at + x + y);
    let here = side_of(at, own, film_at(at - y), above, film_at(at - x), right);
    let mobility = step.mobility * mean_way();
    var flows = vec2(0.0);
    // Nothing flows out of the cells around the contacts.
    if cell.x + 1u < around.high.x {
        let next = side_of(at + x, right, film_at(at + x - y), diagonal, own, film_at(at + 2 * x));
        flows.x = flow(here, next, mobility);
    }
    if cell.y + 1u < around.high.y {
        let next = side_of(at + y, above, own, film_at(at + 2 * y), film_at(at + y - x), diagonal);
        flows.y = flow(here, next, mobility);
    }
    wants[i] = faces[i] + flows;
}
