//! Levelling: wet paint flows under its own surface tension and weight until its yield stress holds it.
//!
//! The film is a thin layer of a Bingham fluid (Balmforth, Craster, Rust and Sassi 2006, "Viscoplastic flow over an
//! inclined surface"): its flux under a pressure gradient G is
//!
//! q = −Y²(3h − Y)/6η · ∇p,  Y = max(0, h − τ_y/|G|),  p = ρg·s − γ∇²s,
//!
//! s the height of its surface. Without a yield stress that is Orchard's levelling (1962), by h³/3η, in
//! which a ripple of wave number k decays at γh³k⁴/3η; with one a ripple of amplitude τ_y/(γhk³) is left
//! (Smith, Orchard and Rhind-Tutt 1961). Edges are pinned: paint flows onto bare ground only
//! down a steep slope.
//!
//! A round is explicit, so on fine cells its flux is bounded. The rest, above all of long waves, flows on grids of
//! cells twice as large, up to those of [`COARSEST_M`] ([`coarse`]).

mod body;
mod coarse;

pub use self::body::{Body, Paints, thinned};

use std::ops::Range;

use maulstick_canvas::window::{Area, Window};
use maulstick_num::select::{larger, smaller};
use maulstick_num::wide;

/// Surface tension of linseed oil, N/m.
pub(crate) const TENSION_N_PER_M: f64 = 0.03;
/// Weight of oil paint, N/m³: 1,800 kg/m³ (lead-free tube colours lie at 1,200 to 2,200).
pub(crate) const WEIGHT_N_PER_M3: f64 = 1800.0 * 9.81;
/// Greatest share of the difference of curvature between two cells that flows in one round, of a cell's height: an
/// explicit scheme of fourth order is stable up to 1/32 in two dimensions.
pub const STABLE: f64 = 1.0 / 40.0;

/// Slope at which an edge of wet paint advances onto bare ground; without a yield stress it wets all.
pub const ADVANCES: f32 = 1.0;

/// Largest part of a cell's paint that flows through a face at once.
const LARGEST_SHARE: f32 = 0.25;
/// Largest cells of a coarser grid, m: so large that thinned paint drains within seconds from ridges as far apart as a
/// brush's marks.
const COARSEST_M: f64 = 1e-3;

/// Scaling of the flow of one round: all in cells of `cell_m`, for `seconds`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Round {
    /// Gradient by difference of curvature between two cells, in yields of paint one cell thick.
    tension: f32,
    /// Gradient by difference of height between two cells, in yields of paint one cell thick.
    weight: f32,
    /// Mobility of paint one cell thick, divided by `tension`.
    mobility: f32,
    /// Greatest mobility.
    most: f32,
    /// Mobility that the finer grid has already used.
    finer: f32,
    /// Number of coarser grids.
    coarser: u32,
    /// Height of a quantum, cells.
    to_cells: f32,
    /// Quanta at or below which a cell counts as bare.
    bare: f32,
}

impl Round {
    /// A round of `seconds` of a body on cells of `cell_m`; cells with at most `bare` quanta are dry.
    #[must_use]
    pub fn new(body: Body, cell_m: f64, seconds: f64, to_cells: f32, bare: f32) -> Self {
        // A yield stress of zero is replaced by one that holds nothing.
        let yields = body.yield_pa.max(1e-9);
        let mobility = seconds * yields / body.viscosity_pa_s.max(1e-9);
        let sides = (1..).map(|level| cell_m * f64::from(1 << level));
        let coarser = sides.take_while(|side| *side <= COARSEST_M * (1.0 + 1e-9));
        Self {
            tension: (TENSION_N_PER_M / (cell_m * yields)) as f32,
            weight: (WEIGHT_N_PER_M3 * cell_m / yields) as f32,
            mobility: mobility as f32,
            most: (STABLE * cell_m * yields / TENSION_N_PER_M) as f32,
            finer: 0.0,
            coarser: coarser.count() as u32,
            to_cells,
            bare,
        }
    }
}

/// Buffers for the flow of an area.
#[derive(Clone, Debug, Default)]
pub struct Levelling {
    /// Cells of a row, including two on either side.
    width: usize,
    /// Height of the wet paint, cells.
    wet: Vec<f32>,
    /// Height of its surface, cells.
    surface: Vec<f32>,
    /// Laplacian of the surface.
    curve: Vec<f32>,
    /// Yield stress and fluidity relative to the round's body.
    body: [Vec<f32>; 2],
    /// Flow through the right and the upper face of each cell in a round, and in total, cells.
    flows: [Vec<f32>; 2],
    sums: [Vec<f32>; 2],
    /// Height of the wet paint before the rounds, cells.
    before: Vec<f32>,
}

/// Columns and rows of a block, which rests as a whole.
pub(super) const BLOCK: usize = 16;

/// Blocks of an area, row by row.
#[derive(Clone, Debug, Default)]
struct Blocks {
    /// Largest flow through a face in each block in the last round, by column; empty before the first round.
    peaks: Vec<[f32; BLOCK]>,
    /// Runs of columns whose blocks may flow in this round, for each row of blocks.
    active: Vec<Vec<Range<usize>>>,
}

impl Blocks {
    /// Begins a round: it activates the blocks in which at least `rests` flowed in the last, and their neighbours; in
    /// the first all.
    fn begin(&mut self, area: &Area, rests: f32) {
        let [across, up] = area.size.map(|cells| cells.div_ceil(BLOCK));
        let is_first = self.peaks.len() != across * up;
        let flowed: Vec<bool> = (self.peaks.iter())
            .map(|peak| peak.iter().any(|flow| *flow >= rests))
            .collect();
        let around = |i: usize, most: usize| i.saturating_sub(1)..(i + 2).min(most);
        let may_flow = |x: usize, y: usize| {
            is_first || around(y, up).any(|j| around(x, across).any(|i| flowed[j * across + i]))
        };
        let columns = |y: usize| {
            let mut runs: Vec<Range<usize>> = Vec::new();
            for x in (0..across).filter(|x| may_flow(*x, y)) {
                let (from, to) = (x * BLOCK, area.size[0].min((x + 1) * BLOCK));
                match runs.last_mut() {
                    Some(run) if run.end == from => run.end = to,
                    _ => runs.push(from..to),
                }
            }
            runs
        };
        self.active = (0..up).map(columns).collect();
        self.peaks.clear();
        self.peaks.resize(across * up, [0.0; BLOCK]);
    }

    /// Largest flow of the last round.
    fn most(&self) -> f32 {
        self.peaks.iter().flatten().copied().fold(0.0, larger)
    }
}

/// Number of cells beside the area that are read.
pub const HALO: usize = 2;

impl Levelling {
    /// Adds the flow of several rounds to the velocities through the right and upper faces of an area's cells: shares
    /// of a donor's paint. Nothing leaves the area; values beyond the window are those of its edge. Returns the largest
    /// flow of a round.
    ///
    /// Only heights go through the rounds; paint follows once, by their sum. A block in which less than `rests` flowed
    /// in the last round, as in all its neighbours, is skipped in the next.
    pub fn add(
        &mut self,
        window: &Window,
        area: &Area,
        round: &Round,
        paints: &Paints,
        (rounds, rests): (u32, f32),
        faces: [&mut [f32]; 2],
    ) -> f32 {
        if area.is_empty() {
            return 0.0;
        }
        self.look(window, area, round.to_cells);
        self.soften(window, area, round.to_cells, paints);
        self.before.clone_from(&self.wet);
        for plane in self.flows.iter_mut().chain(&mut self.sums) {
            plane.clear();
            plane.resize(self.wet.len(), 0.0);
        }
        let most = self.run(area, round, (rounds, rests));
        let bare = round.bare * round.to_cells;
        for (axis, faces) in faces.into_iter().enumerate() {
            share_out(self, area, bare, axis, faces);
        }
        most
    }

    /// Lets heights flow for several rounds, on coarser grids first; returns the largest flow of a round.
    fn run(&mut self, area: &Area, round: &Round, (rounds, rests): (u32, f32)) -> f32 {
        let mut blocks = Blocks::default();
        let mut most = self.flow_on_coarser(area, round, (rounds, rests));
        for _ in 0..rounds {
            blocks.begin(area, rests);
            flow_once(self, area, round, &mut blocks);
            let flowed = blocks.most();
            most = most.max(flowed);
            if flowed < rests {
                break;
            }
        }
        most
    }

    /// Wet heights and surfaces of the area and its halo, and the curvature.
    fn look(&mut self, window: &Window, area: &Area, to_cells: f32) {
        let limit = window.limit();
        self.width = area.size[0] + 2 * HALO;
        let height = area.size[1] + 2 * HALO;
        for plane in [&mut self.wet, &mut self.surface, &mut self.curve] {
            plane.clear();
            // The last block is read as a whole.
            plane.resize(self.width * height + BLOCK, 0.0);
        }
        // Columns of the window under the halo.
        let first = area.from[0].saturating_sub(HALO);
        let last = (area.from[0] + area.size[0] + HALO).min(limit[0]);
        let inset = first + HALO - area.from[0];
        for row in 0..height {
            let y = (area.from[1] + row).saturating_sub(HALO).min(limit[1] - 1);
            let from = y * window.width();
            let start = row * self.width;
            let wet = &mut self.wet[start..start + self.width];
            for (_, plane) in window.planes() {
                let counts = &plane[from + first..from + last];
                let into = wet[inset..].iter_mut().zip(counts);
                into.for_each(|(wet, count)| *wet += count);
            }
            wet.iter_mut().for_each(|wet| *wet *= to_cells);
            let surface = &mut self.surface[start..start + self.width];
            let base = &window.base()[from + first..from + last];
            surface[inset..inset + base.len()].copy_from_slice(base);
            let end = inset + base.len();
            let ends = [
                (wet[inset], surface[inset]),
                (wet[end - 1], surface[end - 1]),
            ];
            for k in 0..inset {
                (wet[k], surface[k]) = ends[0];
            }
            for k in end..wet.len() {
                (wet[k], surface[k]) = ends[1];
            }
            surface.iter_mut().zip(wet).for_each(|(s, wet)| *s += *wet);
        }
    }
}

/// Inputs of levelling for adjacent cells of a row.
struct Run<'a> {
    wet: &'a [f32; BLOCK],
    surface: &'a [f32; BLOCK],
    curve: &'a [f32; BLOCK],
    yields: &'a [f32; BLOCK],
    fluid: &'a [f32; BLOCK],
}

/// A block's width of cells of a plane.
#[inline(always)]
fn run(plane: &[f32], at: usize) -> &[f32; BLOCK] {
    plane[at..].first_chunk().expect("planes go on beyond")
}

impl<'a> Run<'a> {
    #[inline(always)]
    fn of(levelling: &'a Levelling, at: usize) -> Self {
        let [yields, fluid] = &levelling.body;
        Self {
            wet: run(&levelling.wet, at),
            surface: run(&levelling.surface, at),
            curve: run(&levelling.curve, at),
            yields: run(yields, at),
            fluid: run(fluid, at),
        }
    }
}

/// Factor from the pressure gradient of finite differences to that of the wave itself. `bends` and `drop` are the falls
/// of the surface's Laplacian and of its height between two cells, in cells; their ratio gives the wavelength.
///
/// Over a wave that advances by θ a cell, differences have the factor (sin ½θ/½θ)³ of the third derivative; the square
/// of 2 sin ½θ is the fall of curvature by that of height, and this is (½θ/sin ½θ)³ within 1 % for waves of three cells
/// and more, within 14 % for shorter ones.
#[inline(always)]
#[must_use]
fn wave_by_differences(bends: f32, drop: f32) -> f32 {
    let short = bends * drop / larger(drop * drop, 1e-12);
    let short = larger(smaller(short, 4.0), 0.0);
    let cube = short * short * short;
    1.0 + short * (0.125 + short * WAVE_BY_DIFFERENCES[0])
        + WAVE_BY_DIFFERENCES[1] * cube * cube * cube
}

/// Coefficients that make [`wave_by_differences`] exact at waves of four and of three cells.
const WAVE_BY_DIFFERENCES: [f32; 2] = [0.0295, 6.48e-6];

/// The flow from a cell to its neighbour, as a share of the donor's available paint, and that paint.
#[inline(always)]
fn flow(round: &Round, bare: f32, own: &Run<'_>, next: &Run<'_>, i: usize) -> [f32; 2] {
    let (wet, wet_next) = (own.wet[i], next.wet[i]);
    let drop = own.surface[i] - next.surface[i];
    // Pressure falls where curvature grows.
    let gradient = round.tension * (next.curve[i] - own.curve[i]) + round.weight * drop;
    let height = 0.5 * (wet + wet_next);
    // A bare cell has no body of its own: paint brings its along.
    let wets = [wet, wet_next].map(|wet| if wet > 0.0 { 1.0 } else { 0.0f32 });
    let of_paint = |[a, b]: [f32; 2]| (wets[0] * a + wets[1] * b) / larger(wets[0] + wets[1], 1.0);
    let yields = of_paint([own.yields[i], next.yields[i]]);
    let by = wave_by_differences(next.curve[i] - own.curve[i], drop);
    let sheared = larger(height - yields / larger(by * gradient.abs(), 1e-12), 0.0);
    let mobility = round.mobility * by * of_paint([own.fluid[i], next.fluid[i]]);
    let mobility = mobility * sheared * sheared * (3.0 * height - sheared) / 6.0;
    let goes = (smaller(mobility, round.most) - smaller(mobility, round.finer)) * gradient;
    let donor = if goes > 0.0 { wet } else { wet_next };
    let onto = if goes > 0.0 { wet_next } else { wet };
    let pinned = (donor <= bare) | (onto <= bare) & (drop.abs() < ADVANCES * yields);
    let share = goes / larger(donor, 1e-9);
    let share = if pinned { 0.0 } else { share };
    [
        larger(smaller(share, LARGEST_SHARE), -LARGEST_SHARE),
        larger(donor - bare, 0.0),
    ]
}

wide! {
    /// A round in the active blocks, row by row while they are in the cache. A row is updated once the rows that read
    /// it have flowed.
    fn flow_once(levelling: &mut Levelling, area: &Area, round: &Round, blocks: &mut Blocks) {
        let [across, rows] = area.size;
        let Blocks { peaks, active } = blocks;
        for row in 0..rows + LAG {
            if row < rows {
                let peaks = &mut peaks[row / BLOCK * across.div_ceil(BLOCK)..];
                for columns in &active[row / BLOCK] {
                    if row % BLOCK == 0 {
                        levelling.bend(row, columns);
                    }
                    levelling.bend(row + 1, columns);
                    levelling.flow(area, round, row, columns, peaks);
                }
            }
            if let Some(row) = row.checked_sub(LAG) {
                for columns in &active[row / BLOCK] {
                    levelling.carry(row, columns);
                }
            }
        }
    }
}

wide! {
    /// Adds the flows through the faces of an axis, as shares of the donors' paint.
    fn share_out(levelling: &Levelling, area: &Area, bare: f32, axis: usize, faces: &mut [f32]) {
        let next = [1, levelling.width][axis];
        for (row, faces) in faces.chunks_exact_mut(area.size[0]).enumerate() {
            let at = (row + HALO) * levelling.width + HALO;
            let flows = &levelling.sums[axis][at..at + faces.len()];
            let own = &levelling.before[at..at + faces.len()];
            let beside = &levelling.before[at + next..at + next + faces.len()];
            for (i, face) in faces.iter_mut().enumerate() {
                let donor = if flows[i] > 0.0 { own[i] } else { beside[i] };
                let share = flows[i] / larger(donor - bare, 1e-9);
                *face += larger(smaller(share, 1.0), -1.0);
            }
        }
    }
}

/// Number of rows by which updates lag behind flows: updating row k changes the heights of rows k and k + 1, and the
/// curvature of row k + 2 reads that of k + 1.
const LAG: usize = 2;

impl Levelling {
    /// Index of a cell of the area.
    fn at(&self, row: usize, column: usize) -> usize {
        (row + HALO) * self.width + HALO + column
    }

    /// The five-point Laplacian of a row's columns and the one to the right of them.
    #[inline(always)]
    fn bend(&mut self, row: usize, columns: &Range<usize>) {
        let (width, cells) = (self.width, columns.len() + 1);
        let at = self.at(row, columns.start);
        let surface = |at: usize| &self.surface[at..at + cells];
        let (low, high) = (surface(at - width), surface(at + width));
        let (left, own, right) = (surface(at - 1), surface(at), surface(at + 1));
        for (x, out) in self.curve[at..at + cells].iter_mut().enumerate() {
            *out = low[x] + high[x] + left[x] + right[x] - 4.0 * own[x];
        }
    }

    /// The flow through the right and upper faces of a row's columns, and its peaks in each block.
    #[inline(always)]
    fn flow(
        &mut self,
        area: &Area,
        round: &Round,
        row: usize,
        columns: &Range<usize>,
        peaks: &mut [[f32; BLOCK]],
    ) {
        let bare = round.bare * round.to_cells;
        // Nothing crosses the border of the area, where it would be lost.
        let last = [
            area.size[0] - 1,
            if row + 1 < area.size[1] {
                area.size[0]
            } else {
                0
            },
        ];
        for from in columns.clone().step_by(BLOCK) {
            let at = self.at(row, from);
            let cells = BLOCK.min(columns.end - from);
            let peak = &mut peaks[from / BLOCK];
            for (axis, next) in [1, self.width].into_iter().enumerate() {
                let (own, beside) = (Run::of(self, at), Run::of(self, at + next));
                let inner = last[axis].saturating_sub(from);
                let mut flows = [0.0f32; BLOCK];
                for i in 0..BLOCK {
                    let [share, loose] = flow(round, bare, &own, &beside, i);
                    let share = if i < inner { share } else { 0.0 };
                    flows[i] = share * loose;
                    peak[i] = larger(share.abs(), peak[i]);
                }
                self.flows[axis][at..at + cells].copy_from_slice(&flows[..cells]);
            }
        }
    }

    /// Applies the flows through the faces of a row's columns.
    #[inline(always)]
    fn carry(&mut self, row: usize, columns: &Range<usize>) {
        let (at, cells, width) = (self.at(row, columns.start), columns.len(), self.width);
        for (sums, flows) in self.sums.iter_mut().zip(&self.flows) {
            let sums = sums[at..at + cells].iter_mut();
            sums.zip(&flows[at..at + cells])
                .for_each(|(sum, flow)| *sum += flow);
        }
        // The flow from the left is applied with its own columns.
        self.flows[0][at - 1] = 0.0;
        let right = &self.flows[0][at..at + cells];
        let left = &self.flows[0][at - 1..at - 1 + cells];
        let above = &self.flows[1][at..at + cells];
        for plane in [&mut self.wet, &mut self.surface] {
            let (own, beyond) = plane[at..].split_at_mut(width);
            for (x, height) in own[..cells].iter_mut().enumerate() {
                *height -= right[x] - left[x] + above[x];
            }
            own[cells] += right[cells - 1];
            let up = beyond[..cells].iter_mut();
            up.zip(above).for_each(|(height, flow)| *height += flow);
        }
    }
}
