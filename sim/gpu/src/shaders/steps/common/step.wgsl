// Shared parameters and buffers of the stages of steps, for all paint models. An entry point is appended. Lengths are
// in cells of the surface, paint in quanta: whole numbers, in f32 exact up to 2²⁴.

// Parameters of a step; `StepRecord` of record.rs.
struct Step {
    // Half the width of a strip by segment.
    half_widths: array<vec4<f32>, 2>,
    // Grid: its lower left cell in the window, its columns and rows.
    from_x: u32,
    from_y: u32,
    width: u32,
    height: u32,
    // Window: cells of a row and of a plane, columns and rows on the surface.
    row: u32,
    plane: u32,
    limit_x: u32,
    limit_y: u32,
    // Surface coordinates of the grid's lower left corner.
    offset_x: f32,
    offset_y: f32,
    planes: u32,
    strips: u32,
    faces: u32,
    vertices: u32,
    // Offset of its poses.
    poses: u32,
    // Number of the step in its batch.
    number: u32,
    // Least score of a segment, and its greatest height above the highest paint on surface and brush, without the
    // additional sinking of the head.
    low: f32,
    span: f32,
    // Bits of a key that number the segment.
    bits: u32,
    // Distance of the skin from what it rests on.
    skin_bottom: f32,
    cells_per_quantum: f32,
    film_cells_per_quantum: f32,
    film_units_per_quantum: f32,
    cell_per_reference: f32,
    film_full: f32,
    refill: f32,
    creep: f32,
    // Quanta that stay on a cell however hard it is brushed.
    stain: f32,
    // Plane of the thinner, or NONE.
    thinner: u32,
    // Kind of transfer: PAINT, SPONGE or MARKER.
    transfer: u32,
    // Units that a marker deposits along a reference cell.
    flow: f32,
    // Quanta on a cell up to which a brush deposits paint.
    most: f32,
    // 1 where paint is pushed.
    push: u32,
    // Columns and rows of the grid that may be touched; elsewhere paint is only pushed. Then the cells below the low
    // parts of the head (see `inside`).
    in_x0: u32,
    in_y0: u32,
    in_x1: u32,
    in_y1: u32,
    // Capacity of a cell, quanta.
    cell_max: f32,
    // Greatest additional sinking of the head below its solved height.
    reach: f32,
    // Reach of a strip beyond its middle line.
    border: i32,
    // 1 where no cell loses paint to the brush.
    lasting: u32,
    // Sinking of the head into what it rests on, and greatest depth of the ride.
    sink: f32,
    ride_below: f32,
    // Height of a strip's edges above its middle.
    round: f32,
    // Share of the brush's motion that paint follows in a part of the step.
    follows: f32,
    // Parameters of transfer (`Exchanging` of transfer.rs): ln of the share kept along a reference cell, whether the
    // two sides even out, and the greatest amount.
    ln_kept: f32,
    evens: f32,
    most_over: f32,
    // Share of a skin that changes places along a reference cell without a gap.
    swap: f32,
    // Greatest film of a texel, quanta.
    film_most: f32,
    // Share of the difference between films that evens out in a step, between strips and along them.
    seep_beside: f32,
    seep_along: f32,
    // Quanta of a texel's film that cling to a strip.
    clings: f32,
    // Spread of maulstick-model and more: bit 0 the axis, from bit 1 the cells along it, from bit 8 whether the surface
    // ends at the window's left, right, lower, upper limit, from bit 12 the parts in which paint moves, from bit 24 the
    // slope.
    packed: u32,
    // 1 where as many planes follow with what is in the upper sheet.
    sheets: u32,
    // Share of what bristles reach that they shear under this press.
    shear: f32,
}

// A cell in contact.
struct Contact {
    // Texel of the brush; NONE where the cell is not touched.
    texel: u32,
    cover: f32,
    moved: vec2<f32>,
    // Depth of the brush in the wet paint, negative by the gap above it, and that depth divided by the paint's
    // thickness.
    reach: f32,
    fraction: f32,
    // c of the squish, and the share of the brush's motion that the cell's paint follows.
    squish: f32,
    follows: f32,
}

const NONE = 0xffffffffu;
// Fixed-point scale of −ln of the open share of a cell.
const PER_LOG = 262144.0;
const STATIONS = 9u;
const TEXELS_PER_STRIP = 16u;
const QUANTA_PER_UNIT = 16777216.0;
const PAINT = 0u;
const SPONGE = 1u;
const MARKER = 2u;

@group(0) @binding(0) var<uniform> step: Step;
// Poses: x, y, z in the middle of the step, and motion in x and y of all stations; by strip its distance from what it
// rests on, and its rank; x, y, z and motion of the skin's points.
@group(0) @binding(1) var<storage, read> poses: array<f32>;
// Faces of the skin, four points each; places of its points around and along; the strips in their order around the
// head; the strips' capacities; the strips in two orders in which neighbours are adjacent.
@group(0) @binding(2) var<storage, read> head: array<u32>;
// Segments as they are drawn, four vectors each.
@group(0) @binding(3) var<storage, read_write> segments: array<vec4<f32>>;
// Counts on the window's cells, a plane a paint, then a plane a paint with what is in the upper sheet; and an equal
// amount of scratch memory.
@group(0) @binding(4) var<storage, read_write> planes: array<f32>;
@group(0) @binding(5) var<storage, read_write> other: array<f32>;
// Height of the surface that catches paint; height at which a pressed bristle rests on it.
@group(0) @binding(6) var<storage, read> base: array<f32>;
// Steps with contact; then by texel all paints in the film, each paint in the film, each paint inside.
@group(0) @binding(7) var<storage, read_write> load: array<u32>;
// By texel the amounts drawn and offered in the step, and the change of each paint's film; by strip whether it
// touches, and its thickest film.
@group(0) @binding(8) var<storage, read_write> asks: array<atomic<u32>>;
// By cell of the grid the lowest score and its segment; then the open share of all segments, as −ln of it times
// PER_LOG.
@group(0) @binding(9) var<storage, read_write> keys: array<atomic<u32>>;
@group(0) @binding(10) var<storage, read_write> contacts: array<Contact>;
// Velocities through the right and the upper face of each cell of the grid; from the requests on, for a contact, how far
// its mixture is from that of the upper sheet, and its paints.
@group(0) @binding(11) var<storage, read_write> faces: array<vec2<f32>>;
// By cell of the grid: all paint, all paint between the passes of the advection, height of the surface that catches
// paint, share of thinner, height of the ride.
@group(0) @binding(12) var<storage, read_write> totals: array<f32>;
// Cells touched; wet paint and thinner on them before their steps, as bits of f32, in 256 quanta; the greatest height
// of paint, as bits of f32, quanta. Then STEP_STATS words of each step of the batch, see below.
@group(0) @binding(13) var<storage, read_write> stats: array<atomic<u32>>;
// Workgroups of the stages that follow the footprint.
@group(0) @binding(14) var<storage, read_write> groups: array<vec4<u32>>;
// Quanta to the canvas and to the brush by cell of the grid; before, velocities as in `faces`.
@group(0) @binding(15) var<storage, read_write> wants: array<vec2<f32>>;

// The highest paint, cells; the thickest film and the fullest cell, quanta (as bits; none is negative).
const TOP = 0u;
const FILM = 1u;
const FULLEST = 2u;
// Cells in contact.
const TOUCHED = 3u;
// Steps with contact before this one.
const STEPS = 4u;
// Wet paint and thinner on the cells in contact, in 256 quanta.
const WET = 5u;
const THINNER = 6u;
// The least and the greatest column and row of the grid below low parts of the head: as distances from a bias, 0
// where nothing is low.
const LEAST = 7u;
const MOST = 9u;
const BIAS = 65536;
const AWAY = 60000.0;
// The least and the greatest column and row of the contacts, as distances from a bias and from 1.
const LEAST_TOUCHED = 11u;
const MOST_TOUCHED = 13u;
const STEP_STATS = 20u;

// The greatest height of paint over all steps.
const TOP_EVER = 3u;

fn stat(which: u32) -> u32 {
    return 4u + STEP_STATS * step.number + which;
}

// Raises a statistic to at least `value`. Most values are lower, and a read costs less than a write.
fn raise(which: u32, value: u32) {
    if value > atomicLoad(&stats[which]) {
        atomicMax(&stats[which], value);
    }
}

// Records the thickest film of a strip, if it is one, and of all.
fn weigh_strip(strip: u32) {
    if strip >= step.strips {
        return;
    }
    var thickest = 0u;
    for (var k = 0u; k < TEXELS_PER_STRIP; k++) {
        thickest = max(thickest, load[1u + strip * TEXELS_PER_STRIP + k]);
    }
    atomicStore(&asks[thickest_of(strip)], thickest);
    atomicMax(&stats[stat(FILM)], thickest);
}

// Columns and rows of the grid, half-open.
struct Part {
    low: vec2<u32>,
    high: vec2<u32>,
}

// The contacts and one more cell on each side, within the surface: the cells where paint may move.
fn around() -> Part {
    let least = vec2(
        atomicLoad(&stats[stat(LEAST_TOUCHED)]), atomicLoad(&stats[stat(LEAST_TOUCHED) + 1u]),
    );
    let most = vec2(
        atomicLoad(&stats[stat(MOST_TOUCHED)]), atomicLoad(&stats[stat(MOST_TOUCHED) + 1u]),
    );
    let low = max(BIAS - 1 - vec2<i32>(least), vec2(0));
    return Part(vec2<u32>(low), min(most + 1u, vec2(step.width, step.height)));
}

// The columns and rows that may be touched.
fn inside() -> Part {
    let from_low = vec2<i32>(vec2(step.in_x0, step.in_y0));
    let to_high = vec2<i32>(vec2(step.in_x1, step.in_y1));
    var low = to_high;
    var high = from_low;
    for (var axis = 0u; axis < 2u; axis++) {
        let least = atomicLoad(&stats[stat(LEAST) + axis]);
        let most = atomicLoad(&stats[stat(MOST) + axis]);
        if least != 0u {
            low[axis] = clamp(BIAS - i32(least) - step.border, from_low[axis], to_high[axis]);
            high[axis] = clamp(i32(most) - BIAS + step.border + 1, low[axis], to_high[axis]);
        }
    }
    return Part(vec2<u32>(low), vec2<u32>(high));
}

fn cells() -> u32 {
    return step.width * step.height;
}

fn texels() -> u32 {
    return step.strips * TEXELS_PER_STRIP;
}

// The window's cell at a place of the grid.
fn cell_of(x: u32, y: u32) -> u32 {
    return (step.from_y + y) * step.row + step.from_x + x;
}

// Offset of each part of `load` and `asks`.
fn film_of(paint: u32) -> u32 {
    return 1u + (1u + paint) * texels();
}

fn inside_of(paint: u32) -> u32 {
    return 1u + (1u + step.planes + paint) * texels();
}

fn change_of(paint: u32) -> u32 {
    return (2u + paint) * texels();
}

fn touch_of(strip: u32) -> u32 {
    return (2u + step.planes) * texels() + strip;
}

fn thickest_of(strip: u32) -> u32 {
    return touch_of(step.strips) + strip;
}

// exp_f32 of maulstick-num, for x ≤ 0.
fn decay(t: f32) -> f32 {
    let x = max(t, -87.0);
    let n = round(x * 1.44269504);
    let r = x - n * 0.693359375 - n * -2.12194442e-4;
    var p = 1.0 / 5040.0;
    p = p * r + 1.0 / 720.0;
    p = p * r + 1.0 / 120.0;
    p = p * r + 1.0 / 24.0;
    p = p * r + 1.0 / 6.0;
    p = p * r + 0.5;
    let mean = p * r + 1.0;
    return (mean * r + 1.0) * bitcast<f32>((i32(n) + 127) << 23u);
}
