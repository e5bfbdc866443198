// Which of the covered cells are touched: where what is lowest, with its film of paint, reaches the top
// of what lies there.

// Constants of velocity.rs.
override SQUISH: f32;
override STABLE: f32;
override SLIP: f32;
override EASE: f32;

// What reaches a cell: its height as it was solved, and how far it keeps off what it lies on.
struct Fragment {
    texel: u32,
    z: f32,
    off: f32,
    moved: vec2<f32>,
}

fn strip_around(place: f32) -> u32 {
    let turn = place - floor(place);
    let number = min(u32(turn * f32(step.strips)), step.strips - 1u);
    return head[4u * step.faces + 2u * step.vertices + number];
}

fn of_triangle(number: u32, x: u32, y: u32) -> Fragment {
    let triangle = triangle_of(number);
    let at = vec2(f32(x), f32(y)) + 0.5;
    let inverse = 1.0 / side(triangle.a, triangle.b, triangle.c);
    let u = side(triangle.b, triangle.c, at) * inverse;
    let v = side(triangle.c, triangle.a, at) * inverse;
    let shares = vec3(u, v, 1.0 - u - v);
    let strip = strip_around(dot(shares, triangle.around));
    let along = min(u32(dot(shares, triangle.along) * f32(TEXELS_PER_STRIP)), TEXELS_PER_STRIP - 1u);
    let moved = vec2(dot(shares, triangle.moved_x), dot(shares, triangle.moved_y));
    return Fragment(strip * TEXELS_PER_STRIP + along, dot(shares, triangle.z), step.skin_bottom, moved);
}

fn of_ribbon(number: u32, x: u32, y: u32) -> Fragment {
    let ribbon = ribbon_of(number);
    let line = line_of(ribbon);
    let at = vec2(f32(x), f32(y));
    let place = place_on(ribbon, line, at[line.major]);
    let strip = (number - 2u * step.faces) / (STATIONS - 1u);
    let along = min(u32(ribbon.along.x + place.t * ribbon.along.y), TEXELS_PER_STRIP - 1u);
    let z = ribbon.z.x + place.t * ribbon.z.y;
    // A bristle is round below.
    let aside = abs(at[1u - line.major] - place.middle) * line.cosine;
    let across = min(max(aside - 0.5 * (line.soft - 1.0), 0.0) / ribbon.half, 1.0);
    let off = ribbon.bottom + step.round * across * across;
    let moved = ribbon.moved + place.t * ribbon.moves;
    return Fragment(strip * TEXELS_PER_STRIP + along, z, off, moved);
}

// What is pressed down follows the ride into the valleys of the tooth, and is lifted by what stands higher.
fn lower_side(fragment: Fragment, ride: f32) -> f32 {
    let rests = max(fragment.z + min(ride, 0.0), ride);
    return rests - step.sink + fragment.off;
}

// Notes where a contact is.
fn note_contact(at: vec2<u32>) {
    for (var axis = 0u; axis < 2u; axis++) {
        raise(stat(LEAST_TOUCHED) + axis, u32(BIAS) - at[axis]);
        raise(stat(MOST_TOUCHED) + axis, at[axis] + 1u);
    }
}

@compute @workgroup_size(256)
fn footprint(@builtin(global_invocation_id) id: vec3<u32>) {
    let i = id.x;
    if i >= cells() {
        return;
    }
    contacts[i].texel = NONE;
    let key = atomicLoad(&keys[i]);
    if key == NONE {
        return;
    }
    let number = key & ((1u << step.bits) - 1u);
    let x = i % step.width;
    let y = i / step.width;
    var fragment: Fragment;
    if number < 2u * step.faces {
        fragment = of_triangle(number, x, y);
    } else {
        fragment = of_ribbon(number, x, y);
    }
    let cover = 1.0 - decay(-f32(atomicLoad(&keys[cells() + i])) / PER_LOG);
    let wet = totals[i] * step.cells_per_quantum;
    let film = f32(load[1u + fragment.texel]) * step.film_cells_per_quantum;
    let ride = totals[4u * cells() + i];
    let reach = totals[2u * cells() + i] + wet - lower_side(fragment, ride);
    if reach + film <= 0.0 {
        return;
    }
    let depth = clamp(reach, 0.0, wet);
    var fraction = 0.0;
    if wet > 0.0 {
        fraction = depth / wet;
    }
    let thinner = totals[3u * cells() + i];
    let resists = select(0.0, wet, fraction > 0.0);
    let squish = min(SQUISH * (1.0 + EASE * thinner), STABLE / max(resists, 1e-6));
    // What lies in gaps below the bristles stays there.
    let follows = step.follows * (1.0 - SLIP * thinner) * cover * fraction;
    contacts[i] = Contact(
        fragment.texel, cover, fragment.moved, min(reach, wet), fraction, squish, follows,
    );
    note_contact(vec2(x, y));
    atomicAdd(&stats[stat(TOUCHED)], 1u);
    atomicAdd(&stats[stat(WET)], u32(totals[i] / 256.0 + 0.5));
    atomicAdd(&stats[stat(THINNER)], u32(totals[i] * thinner / 256.0 + 0.5));
}
