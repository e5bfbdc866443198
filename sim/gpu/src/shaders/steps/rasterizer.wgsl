// Segments of strips (ribbons whose flat side faces the surface) and faces of the skin: the lowest is kept in each
// cell. One invocation draws one segment.

// Greatest height added to a ribbon that covers a cell only in part.
const EDGE_PENALTY = 0.9;

// Scale of scores: the highest paint, and the additional sinking of the head, cells; the thickest film, cells; and
// the growth of a key with a score.
struct Scale {
    top: f32,
    film: f32,
    per_cell: f32,
}

fn scale() -> Scale {
    let top = bitcast<f32>(atomicLoad(&stats[stat(TOP)])) + step.sink + step.ride_below;
    let film = f32(atomicLoad(&stats[stat(FILM)])) * step.film_cells_per_quantum;
    return Scale(top, film, most() / (top + film + step.span));
}

// The largest score of a key.
fn most() -> f32 {
    return f32((NONE >> step.bits) - 1u);
}

// Keeps a segment on a cell where it is the lowest: the lower its score, the smaller its key.
fn keep(cell: u32, score: f32, per_cell: f32, segment: u32) {
    let place = clamp((score - step.low) * per_cell, 0.0, most());
    let key = (u32(place) << step.bits) | segment;
    // Most are above what was drawn before, and a read costs less than a write.
    if key < atomicLoad(&keys[cell]) {
        atomicMin(&keys[cell], key);
    }
}

// −ln of a share above 0; a device's own log may be off by 1e-4 near 1.
fn minus_ln(share: f32) -> f32 {
    let bits = bitcast<u32>(share);
    var power = i32(bits >> 23u) - 127;
    var part = bitcast<f32>((bits & 0x7fffffu) | 0x3f800000u);
    if part > 1.4142135 {
        part *= 0.5;
        power += 1;
    }
    let s = (part - 1.0) / (part + 1.0);
    let t = s * s;
    let series = 1.0 + t * (1.0 / 3.0 + t * (0.2 + t * (1.0 / 7.0 + t / 9.0)));
    return -(f32(power) * 0.6931472 + 2.0 * s * series);
}

// Multiplies the open share of a cell by `share`, as a sum of whole numbers that is independent of the order.
fn leave_open(cell: u32, share: f32) {
    atomicAdd(&keys[cells() + cell], u32(minus_ln(max(share, 1e-6)) * PER_LOG));
}

fn draw_triangle(number: u32, scale: Scale) {
    let height = scale.top + scale.film;
    let face = number / 2u;
    var corners: array<u32, 4>;
    var is_low = false;
    let z = step.poses + 5u * STATIONS * step.strips + 2u * step.strips + 2u * step.vertices;
    for (var i = 0u; i < 4u; i++) {
        corners[i] = head[4u * face + i];
        is_low = is_low || poses[z + corners[i]] + step.skin_bottom < height;
    }
    if !is_low {
        return;
    }
    let triangle = triangle_of(number);
    let area = side(triangle.a, triangle.b, triangle.c);
    if abs(area) < 1e-9 {
        return;
    }
    let inverse = 1.0 / area;
    let low = min(min(triangle.a, triangle.b), triangle.c);
    let high = max(max(triangle.a, triangle.b), triangle.c);
    let touched = inside();
    let in_low = vec2<f32>(touched.low);
    let in_high = vec2<f32>(touched.high);
    let begin = vec2<u32>(clamp(low + 0.5, in_low, in_high));
    let end = vec2<u32>(clamp(high + 0.5, in_low, in_high));
    for (var y = begin.y; y < end.y; y++) {
        for (var x = begin.x; x < end.x; x++) {
            let at = vec2(f32(x), f32(y)) + 0.5;
            let u = side(triangle.b, triangle.c, at) * inverse;
            let v = side(triangle.c, triangle.a, at) * inverse;
            let w = 1.0 - u - v;
            if u < 0.0 || v < 0.0 || w < 0.0 {
                continue;
            }
            let score = dot(vec3(u, v, w), triangle.z) + step.skin_bottom;
            let cell = y * step.width + x;
            leave_open(cell, 0.0);
            keep(cell, score, scale.per_cell, number);
        }
    }
}

struct Point {
    at: vec3<f32>,
    moved: vec2<f32>,
    along: f32,
}

fn point(strip: u32, station: u32) -> Point {
    let count = STATIONS * step.strips;
    let i = step.poses + station * step.strips + strip;
    return Point(
        vec3(poses[i], poses[i + count], poses[i + 2u * count]),
        vec2(poses[i + 3u * count], poses[i + 4u * count]),
        f32(station) * (f32(TEXELS_PER_STRIP) / f32(STATIONS - 1u)),
    );
}

fn toward(a: Point, b: Point, t: f32) -> Point {
    return Point(
        a.at + (b.at - a.at) * t,
        a.moved + (b.moved - a.moved) * t,
        a.along + (b.along - a.along) * t,
    );
}

fn draw_segment(number: u32, strip: u32, station: u32, scale: Scale) {
    let poses_end = step.poses + 5u * STATIONS * step.strips;
    let bottom = poses[poses_end + strip];
    let rank = poses[poses_end + step.strips + strip];
    let thickest = f32(atomicLoad(&asks[thickest_of(strip)])) * step.film_cells_per_quantum;
    let height = scale.top + thickest - bottom;
    var a = point(strip, station - 1u);
    var b = point(strip, station);
    if min(a.at.z, b.at.z) >= height {
        return;
    }
    let ends = select(0.0, 1.0, a.at.z > height)
        + select(0.0, 2.0, b.at.z > height || station == STATIONS - 1u);
    if a.at.z > height {
        a = toward(a, b, (a.at.z - height) / (a.at.z - b.at.z));
    } else if b.at.z > height {
        b = toward(a, b, (height - a.at.z) / (b.at.z - a.at.z));
    }
    let half_width = step.half_widths[(station - 1u) / 4u][(station - 1u) % 4u];
    let start = a.at.xy - vec2(step.offset_x, step.offset_y);
    let way = b.at - a.at;
    let ribbon = Ribbon(
        start, way.xy, vec2(a.at.z, way.z), bottom, rank, vec2(a.along, b.along - a.along),
        half_width, ends, a.moved, b.moved - a.moved,
    );
    store_ribbon(number, ribbon);
    let line = line_of(ribbon);
    let major = line.major;
    let touched = inside();
    let in_low = vec2<f32>(touched.low);
    let in_high = vec2<f32>(touched.high);
    let first = u32(clamp(line.low + 0.5, in_low[major], in_high[major]));
    let last = u32(clamp(line.high + 0.5, in_low[major], in_high[major]));
    let across = reach_of(ribbon, line) / line.cosine;
    for (var m = first; m < last; m++) {
        let place = place_on(ribbon, line, f32(m));
        let minor = 1u - major;
        let begin = u32(clamp(place.middle - across + 1.0, in_low[minor], in_high[minor]));
        let end = u32(clamp(place.middle + across + 1.0, in_low[minor], in_high[minor]));
        let lowest = ribbon.z.x + place.t * ribbon.z.y + ribbon.bottom + ribbon.rank;
        for (var n = begin; n < end; n++) {
            let cover = cover_of(ribbon, line, place, f32(n));
            if cover > 0.0 {
                let score = lowest + (1.0 - cover) * EDGE_PENALTY;
                let at = select(m * step.width + n, n * step.width + m, major == 0u);
                leave_open(at, 1.0 - cover);
                keep(at, score, scale.per_cell, number);
            }
        }
    }
}

@compute @workgroup_size(64)
fn rasterizer(@builtin(global_invocation_id) id: vec3<u32>) {
    let triangles = 2u * step.faces;
    let scale = scale();
    if id.x < triangles {
        draw_triangle(id.x, scale);
        return;
    }
    let segment = id.x - triangles;
    let strip = segment / (STATIONS - 1u);
    if strip < step.strips {
        draw_segment(id.x, strip, segment % (STATIONS - 1u) + 1u, scale);
    }
}
