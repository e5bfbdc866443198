//! Contact of brush and canvas and its depth (Baxter 2004, § 4.2): the parts of the brush near enough to the top of the
//! surface, with their film.

use maulstick_num::wide;

use crate::transfer::{PLACES, RUN, run, sums};

/// Share of a gap between brush and canvas up to which the brush's paint only bridges it: paint on ridges sags into the
/// hollows between them.
pub const BRIDGED: f32 = 0.4;

/// The brush over the cells of a row; planes may extend beyond it.
#[derive(Debug)]
pub struct Brush<'a> {
    /// Number of cells in the row.
    pub count: usize,
    /// Share of the cell that is covered.
    pub cover: &'a [f32],
    /// Transferred share of either side, and path, as in a [meeting](crate::transfer::Meeting).
    pub rate: &'a [f32],
    /// Path, as in a [meeting](crate::transfer::Meeting).
    pub way: &'a [f32],
    /// Solved height of the bristle's middle line, cells.
    pub height: &'a [f32],
    /// Height of its lower side over the middle line, cells.
    pub clearance: &'a [f32],
    /// Paints of the brush, quanta; the row starts at `start`.
    pub film: &'a [&'a mut [f32]],
    /// Offset of the row in them.
    pub start: usize,
    /// Depth to which it sinks into the surface below it, cells.
    pub sink: f32,
}

/// The canvas under it.
#[derive(Debug)]
pub struct Canvas<'a> {
    /// Height of the surface that catches paint, cells.
    pub base: &'a [f32],
    /// Height of a bristle resting on it, cells.
    pub ride: &'a [f32],
    /// Its wet paints, quanta.
    pub wet: &'a [&'a mut [f32]],
    /// Index of the thinner among them.
    pub thinner: Option<usize>,
    /// Offset of the row in them.
    pub start: usize,
    /// Height of wet paint by its count, cells.
    pub cells_per_quantum: f32,
}

/// Contacts by cell of a row; see [`Meeting`](crate::transfer::Meeting).
#[derive(Clone, Debug, Default)]
pub struct Touching {
    /// Transferred share; 0 without contact.
    pub rate: Vec<f32>,
    /// Path; 0 without contact.
    pub way: Vec<f32>,
    /// Share of the canvas's paint that the brush reaches.
    pub reach: Vec<f32>,
    /// Gap that the brush's paint bridges, quanta.
    pub gap: Vec<f32>,
    /// Number of touching cells.
    pub cells: f64,
    /// Wet quanta on them, and those of thinner among them.
    pub wet: [f64; 2],
}

impl Touching {
    /// Resizes the buffers for a row and the rest of its last run, and resets the counts.
    pub fn begin(&mut self, cells: usize) {
        for plane in [
            &mut self.rate,
            &mut self.way,
            &mut self.reach,
            &mut self.gap,
        ] {
            plane.resize(cells.next_multiple_of(RUN), 0.0);
        }
        (self.cells, self.wet) = (0.0, [0.0; 2]);
    }
}

wide! {
    /// Finds the contacts of brush and canvas on a row, and counts them.
    ///
    /// A pressed bristle has its solved height at 0: it follows the ride into the valleys of the tooth, and is lifted by
    /// higher parts.
    pub fn touch<L>(brush: &Brush<'_>, canvas: &Canvas<'_>, found: &mut Touching) {
        let count = brush.count;
        let (none, one) = (L::splat(0.0), L::splat(1.0));
        let to_cells = L::splat(canvas.cells_per_quantum);
        let to_bridge = L::splat(BRIDGED / canvas.cells_per_quantum);
        let sink = L::splat(brush.sink);
        let mut cells = none;
        let [mut quanta, mut thin] = [[0.0f64; RUN]; 2];
        for at in (0..count).step_by(RUN) {
            let [mut reaches, mut gaps, mut rates, mut ways] = [none; 4];
            // None beyond the row.
            let inside = (L::splat((count - at) as f32) - L::of(&PLACES)).most(none);
            let cover: L = run::<L>(brush.cover, at).least(inside);
            if none.less(cover).any() {
                let [height, clearance]: [L; 2] =
                    [brush.height, brush.clearance].map(|plane| run(plane, at));
                let [base, ride]: [L; 2] = [canvas.base, canvas.ride].map(|plane| run(plane, at));
                let [rate, way]: [L; 2] = [brush.rate, brush.way].map(|plane| run(plane, at));
                let film: L = sums(brush.film, brush.start + at);
                let lies: L = sums(canvas.wet, canvas.start + at);
                let wet = lies * to_cells;
                let rests = (height + ride.least(none)).most(ride);
                let reach = base + wet - (rests - sink + clearance);
                let near = none.less(reach + film * to_cells);
                let touches = none.less(cover).choose(near.choose(one, none), none);
                let depth = reach.most(none).least(wet);
                reaches = none.less(wet).choose(depth / wet, none);
                gaps = (none - reach).most(none) * to_bridge;
                rates = rate * touches;
                ways = way * touches;
                cells = cells + touches;
                let touched = (touches * lies).values();
                (0..RUN).for_each(|i| quanta[i] += f64::from(touched[i]));
                if let Some(thinner) = canvas.thinner {
                    let lies: L = run(canvas.wet[thinner], canvas.start + at);
                    let touched = (touches * lies).values();
                    (0..RUN).for_each(|i| thin[i] += f64::from(touched[i]));
                }
            }
            let planes = [&mut found.reach, &mut found.gap, &mut found.rate, &mut found.way];
            for (plane, values) in planes.into_iter().zip([reaches, gaps, rates, ways]) {
                if let Some(run) = plane[at..].first_chunk_mut() {
                    *run = values.values();
                }
            }
        }
        found.cells += cells.values().iter().map(|count| f64::from(*count)).sum::<f64>();
        found.wet[0] += quanta.iter().sum::<f64>();
        found.wet[1] += thin.iter().sum::<f64>();
    }
}
