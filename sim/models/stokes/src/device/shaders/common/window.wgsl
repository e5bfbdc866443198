// The window of the flow: its grids, and its fields with their layout. Indices are those of maulstick_stokes::grid: x
// fastest, one more layer below and two above. Beyond a periodic side each field has the values of the opposite cells:
// a stage that writes a field writes them too, so no stage wraps it.

// A grid of the hierarchy.
struct Level {
    cells: vec3<u32>,
    // Length of a field.
    len: u32,
    // 1 for each axis along which the next grid has half the cells.
    halved: vec3<u32>,
    // Offset of its fields.
    base: u32,
}

// Parameters of all dispatches of a step.
struct Window {
    levels: array<Level, 12>,
    // By axis: 0 no-slip, 1 slip, 2 periodic.
    low: vec3<u32>,
    count: u32,
    high: vec3<u32>,
    // Offsets of partial sums and scalars.
    partials: u32,
    // Velocity added by the body force.
    pull: vec3<f32>,
    scalars: u32,
    // Weights of mass and of viscosity; νΔt/h².
    alpha: f32,
    beta: f32,
    tau: f32,
    // Fill from which a cell resists pressure.
    least_fill: f32,
    // Outflow of a cell per excess of volume, as a velocity.
    relief: f32,
    // Pressure per velocity that it causes.
    to_pressure: f32,
    // 1/h, yield stress by viscosity, n − 1, 1/reference rate, the least rate.
    per_cell: f32,
    yields: f32,
    thins: f32,
    per_rate: f32,
    least_rate: f32,
    // 1 where bristles resist.
    resists: u32,
    // Quanta that fill a cell, Δt/h of a part of a step, number of paints, index of the first part's order of axes.
    capacity: f32,
    courant: f32,
    paints: u32,
    turn: u32,
    // Number of directions that fit.
    memory: u32,
    padding_a: u32,
    padding_b: u32,
    padding_c: u32,
}

// Parameters of one dispatch.
struct Call {
    level: u32,
    // First component: 0 to 2 are velocities, 3 is the pressure.
    first: u32,
    // On the finest grid, right-hand side and solution of the first component.
    source: u32,
    into: u32,
    // Number of the direction, of the partial sums, of the requested sum.
    number: u32,
    groups: u32,
    mode: u32,
    axis: u32,
}

@group(0) @binding(0) var<uniform> call: Call;
@group(0) @binding(1) var<uniform> window: Window;
@group(0) @binding(2) var<storage, read_write> fields: array<f32>;

// Fields of the finest grid, by number.
const FILL = 0u;
const DISTANCE = 1u;
const OF_SOLID = 2u;
const RESISTANCE = 5u;
const WET = 8u;
const VOLUME = 9u;
const SOLID = 10u;
const FREE = 13u;
const AREA = 16u;
const MASS = 19u;
const NEAR = 22u;
const EDGE = 25u;
const SLOPE = 28u;
const VISCOSITY = 34u;
const WEIGHT = 35u;
const CROSS = 38u;
const BULK = 41u;
const LACKING = 42u;
const ANSWER = 43u;
const X = 44u;
const B = 48u;
const R = 52u;
const DIRECTIONS = 56u;

// Fields of a component on a level of the hierarchy; the finest has no solution and right-hand side there.
const LINKS = 0u;
const INERTIA = 3u;
const ACTIVE = 4u;
const KNOWN = 5u;
const INVERSE = 6u;
const SCALE = 7u;
const SPARE = 8u;
const SOLUTION = 9u;
const RIGHT = 10u;

// Number of workgroups in a row.
const ROW = 32768u;

fn field(number: u32) -> u32 {
    return number * window.levels[0].len;
}

// Offset of a field of a component on a level.
fn part(level: u32, component: u32, number: u32) -> u32 {
    let of_component = select(11u, 9u, level == 0u);
    return window.levels[level].base + (component * of_component + number) * window.levels[level].len;
}

fn strides(level: u32) -> vec3<u32> {
    let row = window.levels[level].cells.x + 3u;
    return vec3(1u, row, row * (window.levels[level].cells.y + 3u));
}

fn is_periodic(axis: u32) -> bool {
    return window.low[axis] == 2u;
}

// A place written by an invocation.
struct Spot {
    // Its index, and that of the cell that it copies.
    place: u32,
    at: u32,
    cell: vec3<i32>,
    // False where there is nothing to do.
    is_one: bool,
    // True if it is no copy.
    is_own: bool,
}

fn wrap(level: u32, cell: vec3<i32>) -> vec3<i32> {
    let cells = vec3<i32>(window.levels[level].cells);
    let periodic = window.low == vec3(2u);
    return select(cell, (cell + cells) % cells, periodic);
}

fn index(level: u32, cell: vec3<i32>) -> u32 {
    let by = strides(level);
    let up = vec3<u32>(cell + 1);
    return up.x + up.y * by.y + up.z * by.z;
}

fn spot(level: u32, id: u32, start: vec3<i32>, size: vec3<u32>) -> Spot {
    let row = size.x;
    let plane = row * size.y;
    let cell = vec3<i32>(vec3(id % row, id % plane / row, id / plane)) + start;
    let wrapped = wrap(level, cell);
    return Spot(
        index(level, cell),
        index(level, wrapped),
        wrapped,
        id < plane * size.z,
        all(wrapped == cell),
    );
}

// Size of the block of cells, with the copies beyond periodic sides.
fn inner_size(level: u32) -> vec3<u32> {
    return window.levels[level].cells + select(vec3(0u), vec3(3u), window.low == vec3(2u));
}

fn inner(level: u32, id: u32) -> Spot {
    let start = select(vec3(0), vec3(-1), window.low == vec3(2u));
    return spot(level, id, start, inner_size(level));
}

fn inner_count(level: u32) -> u32 {
    let size = inner_size(level);
    return size.x * size.y * size.z;
}

// All places of a field.
fn outer(level: u32, id: u32) -> Spot {
    return spot(level, id, vec3(-1), window.levels[level].cells + 3u);
}

fn number_of(group: vec3<u32>, local: u32) -> u32 {
    return (group.y * ROW + group.x) * 256u + local;
}

// The two other axes, in order.
fn others(axis: u32) -> vec2<u32> {
    return select(select(vec2(0u, 1u), vec2(0u, 2u), axis == 1u), vec2(1u, 2u), axis == 0u);
}

// Scalars of the solver: squares of images, answers, shares of earlier images in one or weights of directions, norms of
// the residual, the walls' drag; those of conjugate gradients; the square of an image, and the flag of a second round;
// the shares of all images; norms of the volume deficit.
const SQUARED = 0u;
const ANSWERS = 24u;
const SHARES = 48u;
const NORMS = 80u;
const WALL = 120u;
const MEAN = 121u;
const BEFORE = 122u;
const TURN = 123u;
const REACH = 124u;
const WHOLE = 125u;
const AGAIN = 126u;
const PARTS = 128u;
const PRESSURE_NORMS = 704u;

fn scalar(number: u32) -> u32 {
    return window.scalars + number;
}

// Row of the norm's partial sums.
const NORM_ROW = 31u;
