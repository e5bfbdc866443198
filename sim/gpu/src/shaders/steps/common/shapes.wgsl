// Segments of ribbons and triangles of skin, both as drawn and as looked up in the cells that they won.

// A piece of a strip's middle line with its attributes: values at its beginning, and their change.
struct Ribbon {
    start: vec2<f32>,
    way: vec2<f32>,
    z: vec2<f32>,
    // Distance from what it rests on, and penalty in comparisons of equal depth.
    bottom: f32,
    rank: f32,
    // Place along the strip, texels.
    along: vec2<f32>,
    // Half its width.
    half: f32,
    // Flags: contact begins here (1), contact ends here (2).
    ends: f32,
    moved: vec2<f32>,
    moves: vec2<f32>,
}

fn store_ribbon(number: u32, ribbon: Ribbon) {
    let at = 4u * (number - 2u * step.faces);
    segments[at] = vec4(ribbon.start, ribbon.way);
    segments[at + 1u] = vec4(ribbon.z, ribbon.bottom, ribbon.rank);
    segments[at + 2u] = vec4(ribbon.along, ribbon.half, ribbon.ends);
    segments[at + 3u] = vec4(ribbon.moved, ribbon.moves);
}

fn ribbon_of(number: u32) -> Ribbon {
    let at = 4u * (number - 2u * step.faces);
    let a = segments[at];
    let b = segments[at + 1u];
    let c = segments[at + 2u];
    let d = segments[at + 3u];
    return Ribbon(a.xy, a.zw, b.xy, b.z, b.w, c.xy, c.z, c.w, d.xy, d.zw);
}

// Direction of a ribbon: its major axis, its slope, and its motion over the cells in the step.
struct Line {
    major: u32,
    inverse: f32,
    slope: f32,
    cosine: f32,
    // Width of a soft edge, cells: a cell, or the path across; and the greatest cover of a cell.
    soft: f32,
    most: f32,
    // Columns from its lower to its upper end, and its extension beyond them.
    low: f32,
    high: f32,
    // Fade per column before the lower and after the upper end; 0 where other segments continue.
    fades: vec2<f32>,
}

// Least width of a soft end, cells.
const SHARP = 0.25;
// Extension of a strip beyond its tip, cells.
const TIP = 0.5;

fn line_of(ribbon: Ribbon) -> Line {
    let major = select(0u, 1u, abs(ribbon.way.y) > abs(ribbon.way.x));
    let long = abs(ribbon.way[major]) > 1e-4;
    let inverse = select(0.0, 1.0 / ribbon.way[major], long);
    let slope = ribbon.way[1u - major] * inverse;
    let cosine = 1.0 / sqrt(1.0 + slope * slope);
    let way = ribbon.moved + 0.5 * ribbon.moves;
    let soft = max(abs(way[1u - major] - slope * way[major]) * cosine, 1.0);
    let along = abs(way[major] + slope * way[1u - major]) * cosine * cosine;
    let blurred = max(along, SHARP);
    let begins = ribbon.ends == 1.0 || ribbon.ends == 3.0;
    let stops = ribbon.ends >= 2.0;
    var on = vec2(
        select(0.0, 0.5 * blurred, begins),
        select(0.0, 0.5 * blurred + TIP, stops),
    );
    let length = abs(ribbon.way[major]);
    var low = ribbon.start[major];
    if ribbon.way[major] < 0.0 {
        low -= length;
        on = on.yx;
    }
    let whole = length + select(0.0, TIP, stops);
    let dwells = select(1.0, min(whole / blurred, 1.0), begins && stops);
    return Line(
        major, inverse, slope, cosine, soft,
        min(ribbon.half / soft + 0.5, 1.0) * dwells,
        low - on.x, low + length + on.y,
        select(vec2(0.0), vec2(1.0 / blurred), on > vec2(0.0)),
    );
}

// Distance from its middle line within which a ribbon covers cells.
fn reach_of(ribbon: Ribbon, line: Line) -> f32 {
    return ribbon.half + 0.5 * line.soft;
}

// Crossing of a column of cells (or a row, along `major`) with the ribbon.
struct Crossing {
    t: f32,
    middle: f32,
    // Share of the path on which the ribbon is present.
    fade: f32,
}

fn place_on(ribbon: Ribbon, line: Line, m: f32) -> Crossing {
    let off = m + 0.5 - ribbon.start[line.major];
    let middle = ribbon.start[1u - line.major] + off * line.slope - 0.5;
    let ends = vec2(m + 0.5 - line.low, line.high - m - 0.5) * line.fades;
    let fades = select(vec2(1.0), ends, line.fades > vec2(0.0));
    let fade = clamp(min(fades.x, fades.y), 0.0, 1.0);
    return Crossing(clamp(off * line.inverse, 0.0, 1.0), middle, fade);
}

// Share of a cell that the ribbon covers; 0 or negative outside it.
fn cover_of(ribbon: Ribbon, line: Line, place: Crossing, n: f32) -> f32 {
    let off = abs(n - place.middle) * line.cosine;
    return min((reach_of(ribbon, line) - off) / line.soft, line.most) * place.fade;
}

// Half a face of the skin, in the grid's coordinates.
struct Triangle {
    a: vec2<f32>,
    b: vec2<f32>,
    c: vec2<f32>,
    // For each corner: height, motion, place around and along the head.
    z: vec3<f32>,
    moved_x: vec3<f32>,
    moved_y: vec3<f32>,
    around: vec3<f32>,
    along: vec3<f32>,
}

fn side(p: vec2<f32>, q: vec2<f32>, at: vec2<f32>) -> f32 {
    return (q.x - p.x) * (at.y - p.y) - (q.y - p.y) * (at.x - p.x);
}

fn triangle_of(number: u32) -> Triangle {
    let face = 4u * (number / 2u);
    let second = 1u + number % 2u;
    let corners = vec3(head[face], head[face + second], head[face + second + 1u]);
    let skin = step.poses + 5u * STATIONS * step.strips + 2u * step.strips;
    let places = 4u * step.faces;
    let first = bitcast<f32>(head[places + 2u * corners.x]);
    var triangle: Triangle;
    var at: array<vec2<f32>, 3>;
    for (var i = 0u; i < 3u; i++) {
        let corner = corners[i];
        let point = skin + corner;
        at[i] = vec2(
            poses[point] - step.offset_x,
            poses[point + step.vertices] - step.offset_y,
        );
        triangle.z[i] = poses[point + 2u * step.vertices];
        triangle.moved_x[i] = poses[point + 3u * step.vertices];
        triangle.moved_y[i] = poses[point + 4u * step.vertices];
        // A face over the seam continues beyond 1.
        let around = bitcast<f32>(head[places + 2u * corner]);
        triangle.around[i] = around + round(first - around);
        triangle.along[i] = bitcast<f32>(head[places + 2u * corner + 1u]);
    }
    triangle.a = at[0];
    triangle.b = at[1];
    triangle.c = at[2];
    return triangle;
}
