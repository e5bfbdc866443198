// Part of the head that covers a cell, from the segment that won it.

// Its solved height, and its distance from what it rests on.
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

fn fragment_of(number: u32, x: u32, y: u32) -> Fragment {
    if number < 2u * step.faces {
        return of_triangle(number, x, y);
    }
    return of_ribbon(number, x, y);
}

// Share of a cell that the head covers.
fn covered(cell: u32) -> f32 {
    return 1.0 - decay(-f32(atomicLoad(&keys[cells() + cell])) / PER_LOG);
}

// Records the place of the head: a contact, or a cell below it.
fn note_place(at: vec2<u32>) {
    for (var axis = 0u; axis < 2u; axis++) {
        raise(stat(LEAST_TOUCHED) + axis, u32(BIAS) - at[axis]);
        raise(stat(MOST_TOUCHED) + axis, at[axis] + 1u);
    }
}
