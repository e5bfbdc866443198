// Velocity of the paint under the brush through the right and the upper face of each cell. Paint follows the brush, and
// is pressed aside down the gradient of the penetration.

struct Side {
    touched: bool,
    push: f32,
    pressed: f32,
    squish: f32,
}

// A cell of the grid, along an axis; one beside the grid is not touched.
fn side_of(at: vec2<i32>, axis: u32) -> Side {
    let size = vec2(i32(step.width), i32(step.height));
    if any(at < vec2(0)) || any(at >= size) {
        return Side(false, 0.0, 0.0, 0.0);
    }
    let contact = contacts[at.y * size.x + at.x];
    if contact.texel == NONE {
        return Side(false, 0.0, 0.0, 0.0);
    }
    return Side(
        true,
        contact.follows * contact.moved[axis],
        max(contact.reach, 0.0) * contact.cover,
        contact.squish,
    );
}

// Velocity through the face between two cells; the second may be beside the surface.
fn through(i: Side, j: Side, on_surface: bool) -> f32 {
    if !on_surface || !(i.touched || j.touched) {
        return 0.0;
    }
    var push = i.push + j.push;
    var squish = i.squish + j.squish;
    if i.touched && j.touched {
        push *= 0.5;
        squish = min(i.squish, j.squish);
    }
    let v = clamp(push + squish * (i.pressed - j.pressed), -1.0, 1.0);
    return select(0.0, v, select(j.touched, i.touched, v > 0.0));
}

// Velocity through the face of a cell toward the next along an axis; a cell loses at most all it has.
fn face_velocity(at: vec2<i32>, axis: u32) -> f32 {
    var ahead = vec2(1, 0);
    var last = i32(step.limit_x) - i32(step.from_x) - 1;
    var first = -i32(step.from_x);
    if axis == 1u {
        ahead = vec2(0, 1);
        last = i32(step.limit_y) - i32(step.from_y) - 1;
        first = -i32(step.from_y);
    }
    let place = at[axis];
    let before = side_of(at - ahead, axis);
    let i = side_of(at, axis);
    let j = side_of(at + ahead, axis);
    let after = side_of(at + 2 * ahead, axis);
    let v = through(i, j, place < last);
    var leaving = 0.0;
    if v > 0.0 {
        leaving = v - min(through(before, i, place > first), 0.0);
    } else {
        leaving = max(through(j, after, place + 1 < last), 0.0) - v;
    }
    return v / max(leaving, 1.0);
}

@compute @workgroup_size(256)
fn velocity(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= cells() {
        return;
    }
    let at = vec2(i32(id.x % step.width), i32(id.x / step.width));
    faces[id.x] = vec2(face_velocity(at, 0u), face_velocity(at, 1u));
}
