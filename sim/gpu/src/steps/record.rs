//! A step in the layout of the shaders.

use bytemuck::{Pod, Zeroable};
use maulstick_brush::head::STATIONS;
use maulstick_canvas::quantum::CELL_MAX;
use maulstick_model::brush::head::border;
use maulstick_model::footprint::ribbons::{middle, rank};
use maulstick_model::interface::{Step, Sweep, Transfer};
use maulstick_model::spread::Spread;

use super::device_layout::DeviceLayout;

/// Margins of scores below the lowest reach and above the highest paint, cells: for ranks, and for partly covered
/// cells.
const MARGIN: [f32; 2] = [0.1, 0.95];
/// Number of an absent plane.
const NONE: u32 = u32::MAX;

/// `Step` of step.wgsl.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct StepRecord {
    half_widths: [f32; 8],
    from: [u32; 2],
    size: [u32; 2],
    row: u32,
    plane: u32,
    limit: [u32; 2],
    offset: [f32; 2],
    planes: u32,
    strips: u32,
    faces: u32,
    vertices: u32,
    poses: u32,
    number: u32,
    low: f32,
    span: f32,
    bits: u32,
    skin_bottom: f32,
    cells_per_quantum: f32,
    film_cells_per_quantum: f32,
    film_units_per_quantum: f32,
    cell_per_reference: f32,
    film_full: f32,
    refill: f32,
    creep: f32,
    stain: f32,
    thinner: u32,
    transfer: u32,
    flow: f32,
    most: f32,
    push: u32,
    inside: [[u32; 2]; 2],
    cell_max: f32,
    reach: f32,
    border: i32,
    lasting: u32,
    sink: f32,
    ride_below: f32,
    round: f32,
    follows: f32,
    transfers: [f32; 4],
    film_most: f32,
    seep: [f32; 3],
    /// Spread, borders and parts, and 1 where there may be two sheets.
    packed: [u32; 2],
    shear: f32,
}

/// Bytes from one record to the next.
pub const RECORD_BYTES: u64 = size_of::<StepRecord>() as u64;
/// Words of a record, of a step or of a blend.
pub const RECORD_WORDS: usize = size_of::<StepRecord>() / 4;

/// The cells on which a step works.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grid {
    /// Its lower left cell relative to the window, which it may exceed.
    pub from: [i64; 2],
    /// Its columns and rows.
    pub size: [u32; 2],
    /// Cells that may be touched, half-open.
    pub inside: [[u32; 2]; 2],
}

impl Grid {
    /// How many cells it has.
    pub fn cells(&self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1])
    }
}

/// Number of a transfer for the shaders, and a marker's flow.
fn number_and_flow(transfer: Transfer) -> (u32, f32) {
    match transfer {
        Transfer::Sponge => (1, 0.0),
        Transfer::Marker { flow } => (2, flow),
        Transfer::Paint | Transfer::Sampler | Transfer::Vacuum => (0, 0.0),
    }
}

/// Spread, borders and parts of a step, as step.wgsl has them.
fn packed(step: &Step<'_>) -> u32 {
    let spread = Spread::of(step);
    let ends = step.window.borders();
    let borders = ends.as_flattened().iter().rev();
    let borders = borders.fold(0, |bits, ends| bits << 1 | u32::from(*ends));
    let parts = step.traits.parts;
    let slope = spread.slope as u32;
    spread.axis | spread.cells << 1 | borders << 8 | parts << 12 | slope << 24
}

impl StepRecord {
    /// A motion of a step, for a brush and a window on the device, without a drawing of the head.
    pub fn new(
        step: &Step<'_>,
        sweep: &Sweep<'_>,
        on: &DeviceLayout,
        (grid, number): (&Grid, usize),
    ) -> Self {
        let (traits, after) = (&step.traits, sweep.to);
        let (origin, limit) = (step.window.origin(), step.window.limit());
        let (transfer, flow) = number_and_flow(step.handling.transfer);
        let exchanging = traits.exchanging.pressed(after.press);
        Self {
            half_widths: std::array::from_fn(|i| traits.half_width_before(i + 1)),
            // Modulo 2³²: beyond the window no cell is read.
            from: grid.from.map(|cell| cell as u32),
            size: grid.size,
            row: step.window.width() as u32,
            plane: (step.window.width() * step.window.height()) as u32,
            limit: limit.map(|cells| cells as u32),
            offset: [0, 1].map(|i| (origin[i] + grid.from[i]) as f32),
            planes: on.slots.len() as u32,
            strips: on.strips as u32,
            faces: on.faces as u32,
            vertices: on.vertices as u32,
            poses: 0,
            number: number as u32,
            low: -MARGIN[0],
            span: MARGIN[0] + MARGIN[1],
            bits: on.segment_bits(),
            skin_bottom: traits.recede * after.splay,
            cells_per_quantum: traits.cells_per_quantum,
            film_cells_per_quantum: traits.film_cells_per_quantum,
            film_units_per_quantum: traits.film_units_per_quantum,
            cell_per_reference: traits.cell_per_reference,
            film_full: traits.film_full as f32,
            refill: traits.refill as f32,
            creep: traits.creep as f32,
            stain: step.stain,
            thinner: step.thinner.map_or(NONE, |slot| on.plane_of(slot)),
            transfer,
            flow,
            most: step.handling.most.min(CELL_MAX as f32),
            push: u32::from(step.handling.push),
            inside: grid.inside,
            cell_max: CELL_MAX as f32,
            reach: traits.sink + step.window.ride_below(),
            border: border(traits) as i32,
            lasting: u32::from(step.lasting),
            sink: traits.sink * after.press,
            ride_below: step.window.ride_below(),
            round: 2.0 * traits.half_thickness,
            follows: traits.follows / traits.parts as f32,
            transfers: exchanging.numbers(),
            film_most: traits.film_most as f32,
            seep: [traits.seep.beside, traits.seep.along, traits.seep.clings].map(|v| v as f32),
            packed: [packed(step), u32::from(on.sheets)],
            shear: exchanging.shear(after.press),
        }
    }

    /// Adds the drawing of the head in this motion, and appends its poses to `poses`.
    pub fn draw(mut self, step: &Step<'_>, sweep: &Sweep<'_>, poses: &mut Vec<f32>) -> Self {
        let head = step.head;
        let (after, before) = (sweep.to, sweep.from);
        let strips = head.strips();
        let loose = step.traits.loose(after.press);
        self.poses = poses.len() as u32;
        debug_assert_eq!(after.x.len(), strips * STATIONS);
        let motion = |after: &[f32], before: &[f32], poses: &mut Vec<f32>| {
            poses.extend(
                after
                    .iter()
                    .zip(before)
                    .map(|(after, before)| after - before),
            );
        };
        // Strips are drawn at their place in the middle of the step.
        for (after, before) in [
            (&after.x, &before.x),
            (&after.y, &before.y),
            (&after.z, &before.z),
        ] {
            poses.extend(after.iter().zip(before).map(|(a, b)| middle(*a, *b)));
        }
        motion(&after.x, &before.x, poses);
        motion(&after.y, &before.y, poses);
        let lift = head.lift();
        // Another load has other bristles stand out.
        let turned = step.load.seed() as usize;
        poses.extend((0..strips).map(|strip| loose * lift[(strip + turned) % strips]));
        poses.extend((0..strips).map(|strip| rank(head, after, strip)));
        if self.vertices > 0 {
            for plane in [&after.skin.x, &after.skin.y, &after.skin.z] {
                poses.extend_from_slice(plane);
            }
            motion(&after.skin.x, &before.skin.x, poses);
            motion(&after.skin.y, &before.skin.y, poses);
        }
        self
    }

    /// A square of cells in a window of that size with a `stain`, quanta, for tests of moving paint alone.
    #[must_use]
    pub fn of_square(side: u32, planes: u32, stain: f32) -> Self {
        Self {
            size: [side; 2],
            row: side,
            plane: side * side,
            limit: [side; 2],
            planes,
            stain,
            push: 1,
            cell_max: CELL_MAX as f32,
            ..Self::default()
        }
    }

    /// Cells of the grid.
    pub fn cells(&self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1])
    }
}
