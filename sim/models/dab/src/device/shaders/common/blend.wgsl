// Shared parts of dAb's stages: the parameters of a blend, and the head over the cells of the grid, which may extend
// beyond the window.

// Parameters of a blend, and of its step; `BlendRecord` of record.rs.
struct Blend {
    // The grid's cells on the surface that may be touched, half-open.
    low: vec2<i32>,
    high: vec2<i32>,
    // Shift of the drawn head, cells.
    shift: vec2<i32>,
    // Lower left cell of the grid relative to the step's bounds.
    corner: vec2<i32>,
    // Path of a cell of the head, reference cells: a factor on the motion of its strip, and a summand.
    by_travel: f32,
    evenly: f32,
    // Cells with the volume of a texel's film; its share on each of its cells, in parts of 2⁻⁶⁴.
    large: f32,
    share_high: u32,
    share_low: u32,
    // Flags: first (1) and last (2) blend of a drawing.
    ends: u32,
    // `Limits` of transfer.rs, with the flag that the canvas loses at most what it gains.
    most: f32,
    stain: f32,
    exchanges: f32,
    flow: f32,
    lasting: u32,
    // Threshold of the lower left cell of the step's bounds in parts of 2⁻³², and its increase across and up in parts
    // of 2⁻⁶⁴ and, across, in floating point.
    threshold: u32,
    across_high: u32,
    across_low: u32,
    up_high: u32,
    up_low: u32,
    across: f32,
    // `Refill` of reservoir.rs; `refills` is 0 for a sponge, whose strips do not refill. Thresholds of the first
    // texel.
    deep: f32,
    full_surface: f32,
    full_inside: f32,
    rate: f32,
    refills: u32,
    threshold_flows: u32,
    threshold_runs: u32,
    // Number of cells of the grid of the step's first drawing.
    first_drawn: u32,
}

// The lowest part of the head over a cell: `Drawn` of maulstick-model, and its transfer there.
struct Drawn {
    // Texel; NONE where the head is not over the cell.
    texel: u32,
    // Share of the cell that is covered.
    cover: f32,
    // Transferred share, and path, both times the cover.
    rate: f32,
    way: f32,
    // Height of the middle line, and of the lower side over it.
    height: f32,
    clearance: f32,
    room: vec2<f32>,
}

const FIRST = 1u;
const LAST = 2u;

// Cells touched in the step before the last drawing of the head.
const BEFORE = 4u;
// Unit of wet paint and thinner in sums, as a divisor of 256 quanta.
const WET_UNIT = 16.0;

@group(0) @binding(10) var<storage, read_write> drawn: array<Drawn>;
@group(0) @binding(16) var<uniform> blend_of: Blend;

// Clears a cell of the drawing on a grid of `grid_cells`.
fn clear_cell(cell: u32, grid_cells: u32) {
    atomicStore(&keys[cell], NONE);
    atomicStore(&keys[grid_cells + cell], 0u);
}

// The upper half of a product.
fn product_high(a: u32, b: u32) -> u32 {
    let a_low = a & 0xffffu;
    let a_high = a >> 16u;
    let b_low = b & 0xffffu;
    let b_high = b >> 16u;
    let cross = a_high * b_low + ((a_low * b_low) >> 16u);
    let other = a_low * b_high + (cross & 0xffffu);
    return a_high * b_high + (cross >> 16u) + (other >> 16u);
}

// Floating-point value of a threshold in parts of 2⁻³².
fn threshold_of(parts: u32) -> f32 {
    return min(f32(parts) * 2.3283064365386963e-10, 1.0 - 1.1920929e-7);
}

// Increase of a threshold over `count` cells.
fn increase(count: u32, high: u32, low: u32) -> u32 {
    return count * high + product_high(count, low);
}

// Quanta of a film on each of the cells that its texel covers.
fn lent(held: u32, texel_cells: u32) -> u32 {
    if f32(texel_cells) > blend_of.large {
        return held / texel_cells;
    }
    let low = held * blend_of.share_high;
    let sum = low + product_high(held, blend_of.share_low);
    return product_high(held, blend_of.share_high) + select(0u, 1u, sum < low);
}

// Adds to a texel the difference between its cells' quanta and what it lent them, and marks its strip as having been
// over the canvas.
fn give_back_to(texel: u32) {
    if atomicLoad(&asks[texel]) == 0u {
        return;
    }
    atomicStore(&asks[texel], 0u);
    for (var paint = 0u; paint < step.planes; paint++) {
        let change = change_of(paint) + texel;
        load[film_of(paint) + texel] += atomicLoad(&asks[change]);
        atomicStore(&asks[change], 0u);
    }
    if atomicLoad(&stats[stat(TOUCHED)]) > atomicLoad(&stats[stat(BEFORE)]) {
        atomicStore(&asks[touch_of(texel / TEXELS_PER_STRIP)], 1u);
    }
}
