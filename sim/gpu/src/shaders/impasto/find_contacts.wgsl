// Which of the covered cells are touched: where what is lowest, with its film of paint, reaches the top
// of what lies there.

// Constants of velocity.rs.
const SQUISH = 3.0;
const STABLE = 0.3;
const FOLLOWS = 0.5;
const SLIP = 0.5;
const EASE = 4.0;

// What reaches a cell.
struct Fragment {
    texel: u32,
    bottom: f32,
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
    let along = min(u32(dot(shares, triangle.along) * f32(ALONG)), ALONG - 1u);
    let moved = vec2(dot(shares, triangle.moved_x), dot(shares, triangle.moved_y));
    return Fragment(strip * ALONG + along, dot(shares, triangle.z), moved);
}

fn of_ribbon(number: u32, x: u32, y: u32) -> Fragment {
    let ribbon = ribbon_of(number);
    let line = line_of(ribbon);
    let at = vec2(f32(x), f32(y));
    let place = place_on(ribbon, line, at[line.major]);
    let strip = (number - 2u * step.faces) / (STATIONS - 1u);
    let along = min(u32(ribbon.along.x + place.t * ribbon.along.y), ALONG - 1u);
    let bottom = ribbon.z.x + place.t * ribbon.z.y + ribbon.bottom;
    let moved = ribbon.moved + place.t * ribbon.moves;
    return Fragment(strip * ALONG + along, bottom, moved);
}

@compute @workgroup_size(256)
fn find_contacts(@builtin(global_invocation_id) id: vec3<u32>) {
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
    let reach = totals[2u * cells() + i] + wet - fragment.bottom;
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
    let follows = FOLLOWS * (1.0 - SLIP * thinner);
    contacts[i] = Contact(
        fragment.texel, cover, fragment.moved, depth, fraction, squish, follows,
    );
    atomicAdd(&stats[stat(TOUCHED)], 1u);
    atomicAdd(&stats[stat(WET)], u32(totals[i] / 256.0 + 0.5));
    atomicAdd(&stats[stat(THINNER)], u32(totals[i] * thinner / 256.0 + 0.5));
}
