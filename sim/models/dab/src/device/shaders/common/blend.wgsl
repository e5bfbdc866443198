// What the stages of dAb share: the parameters of a blend, and the head over the cells of the grid, which may go
// beyond the window.

// Parameters of a blend, and of the step that it is a part of; `BlendRecord` of record.rs.
struct Blend {
    // The grid's cells that lie on the surface and may be touched: from, up to but not with.
    low: vec2<i32>,
    high: vec2<i32>,
    // The cells by which the drawn head is moved.
    shift: vec2<i32>,
    // The grid's lower left cell, from that of the step's bounds.
    corner: vec2<i32>,
    // Way of a cell of the head, reference cells: by the cells that its strip goes, and besides.
    by_travel: f32,
    evenly: f32,
    // Cells that a texel's film is as large as; the share of it on each of so many, in parts of 2⁻⁶⁴.
    large: f32,
    share_high: u32,
    share_low: u32,
    // Whether it is the first (1) and the last (2) of a drawing.
    ends: u32,
    // `Limits` of transfer.rs; whether nothing is lost by the canvas beyond what it gains.
    most: f32,
    stain: f32,
    exchanges: f32,
    flow: f32,
    lasting: u32,
    // Threshold of the lower left cell of the step's bounds in parts of 2⁻³², and how thresholds increase across and up in parts of
    // 2⁻⁶⁴ and, across, in floating point.
    threshold: u32,
    across_high: u32,
    across_low: u32,
    up_high: u32,
    up_low: u32,
    across: f32,
    // `Refill` of reservoir.rs; 0 to 1 is which strips it is the turn of, NONE of none. Thresholds of the first texel.
    deep: f32,
    full_surface: f32,
    full_inside: f32,
    rate: f32,
    turn: u32,
    threshold_flows: u32,
    threshold_runs: u32,
    // Cells of the grid on which the step draws first.
    first_drawn: u32,
}

// The lowest part of the head over a cell: `Drawn` of maulstick-model, and what goes over there.
struct Drawn {
    // NONE where nothing is over it.
    texel: u32,
    // Share of the cell that is covered.
    cover: f32,
    // Share that goes over, and way, both by the cover.
    rate: f32,
    way: f32,
    // Height of the middle line, and of the lower side over that.
    height: f32,
    clearance: f32,
    room: vec2<f32>,
}

const FIRST = 1u;
const LAST = 2u;

// Of a step's statistics: cells touched before the head was drawn last.
const BEFORE = 4u;
// Wet paint and thinner are counted in so many of 256 quanta.
const WET_UNIT = 16.0;

@group(0) @binding(10) var<storage, read_write> drawn: array<Drawn>;
@group(0) @binding(16) var<uniform> blend_of: Blend;

// Nothing is drawn on a cell of a grid of so many.
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

// The threshold in floating point of one in parts of 2⁻³².
fn threshold_of(parts: u32) -> f32 {
    return min(f32(parts) * 2.3283064365386963e-10, 1.0 - 1.1920929e-7);
}

// How much a threshold increases from a cell to one so many farther on.
fn increase(count: u32, high: u32, low: u32) -> u32 {
    return count * high + product_high(count, low);
}

// Quanta of a film that lie on each of the cells that its texel is over.
fn lent(held: u32, texel_cells: u32) -> u32 {
    if f32(texel_cells) > blend_of.large {
        return held / texel_cells;
    }
    let low = held * blend_of.share_high;
    let sum = low + product_high(held, blend_of.share_low);
    return product_high(held, blend_of.share_high) + select(0u, 1u, sum < low);
}

// Gives a texel what its cells hold more, or less, than it lent them, and notes that its strip was over the canvas.
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
