//! Levelling on coarser grids, each cell the mean of four.
//!
//! On cells of side a, an explicit round is stable only for mobilities up to a bound (`STABLE`), and the number of
//! rounds that level a wave grows with the fourth power of its length in cells. A grid twice as coarse allows sixteen
//! times the flow. The mobility used by the finer grid is subtracted, so each share of the flow counts once. A flux
//! through a coarse face is split over the fine faces on it; a fine face halfway between two coarse ones gets their
//! mean. So volumes are conserved, and the two cells between change alike.

use maulstick_canvas::window::Area;
use maulstick_num::select::{larger, smaller};

use super::{BLOCK, HALO, LARGEST_SHARE, Levelling, Round};

impl Round {
    /// The round on cells twice as large, less the mobility of the finer ones.
    fn twice(&self) -> Self {
        Self {
            tension: 0.5 * self.tension,
            weight: 2.0 * self.weight,
            most: 2.0 * self.most,
            // Heights in cells halve on the coarser grid, and mobility is proportional to their cube: the finer grid's
            // bound is 1/8.
            finer: 0.125 * self.most,
            coarser: self.coarser - 1,
            to_cells: 0.5 * self.to_cells,
            ..*self
        }
    }
}

impl Levelling {
    /// Lets paint flow on coarser grids, if any; returns the largest flow of a round there.
    pub(super) fn flow_on_coarser(
        &mut self,
        area: &Area,
        round: &Round,
        rounds: (u32, f32),
    ) -> f32 {
        if round.coarser == 0 {
            return 0.0;
        }
        let twice = Area {
            from: [0; 2],
            size: area.size.map(|cells| cells.div_ceil(2)),
        };
        let mut coarse = self.halved(area, &twice);
        let most = coarse.run(&twice, &round.twice(), rounds);
        self.take_flows(area, &coarse, round.bare * round.to_cells);
        for row in 0..area.size[1] {
            self.carry(row, &(0..area.size[0]));
        }
        most
    }

    /// The means of each four cells, in cells twice as large.
    fn halved(&self, area: &Area, twice: &Area) -> Self {
        let width = twice.size[0] + 2 * HALO;
        let height = twice.size[1] + 2 * HALO;
        // Beyond the halo values are those of its edge.
        let fine = |coarse: usize, axis: usize| {
            let last = area.size[axis] + 2 * HALO - 1;
            [0, 1].map(|of| (2 * coarse + of).saturating_sub(HALO).min(last))
        };
        let columns: Vec<_> = (0..width).map(|x| fine(x, 0)).collect();
        let mean = |plane: &[f32], scale: f32| {
            let mut means = Vec::with_capacity(width * height + BLOCK);
            for y in 0..height {
                let [low, high] = fine(y, 1).map(|row| &plane[row * self.width..][..self.width]);
                let sum = |[a, b]: &[usize; 2]| (low[*a] + low[*b]) + (high[*a] + high[*b]);
                means.extend(columns.iter().map(|cells| scale * sum(cells)));
            }
            means.resize(width * height + BLOCK, 0.0);
            means
        };
        // Bare cells have no body.
        let wets: Vec<f32> = (self.wet.iter())
            .map(|wet| if *wet > 0.0 { 1.0 } else { 0.0 })
            .collect();
        let counts = mean(&wets, 1.0);
        let of_paint = |plane: usize| {
            let own: Vec<f32> = (self.body[plane].iter().zip(&wets))
                .map(|(own, wet)| own * wet)
                .collect();
            let mut sums = mean(&own, 1.0);
            let cells = sums.iter_mut().zip(&counts);
            cells.for_each(|(sum, count)| *sum /= larger(*count, 1.0));
            sums
        };
        let still = || vec![0.0; width * height + BLOCK];
        Self {
            width,
            wet: mean(&self.wet, 0.125),
            surface: mean(&self.surface, 0.125),
            curve: still(),
            body: [0, 1].map(of_paint),
            flows: [still(), still()],
            sums: [still(), still()],
            before: Vec::new(),
        }
    }

    /// Adds the flows of the coarser grid to those of the finer one, except through bare cells.
    fn take_flows(&mut self, area: &Area, coarse: &Self, bare: f32) {
        for (axis, next) in [1, self.width].into_iter().enumerate() {
            let beside = [1, coarse.width][axis];
            let sums = &coarse.sums[axis];
            for y in 0..area.size[1] {
                for x in 0..area.size[0] {
                    let at = (y + HALO) * self.width + x + HALO;
                    let place = [x, y][axis];
                    if place + 1 == area.size[axis] {
                        self.flows[axis][at] = 0.0;
                        continue;
                    }
                    let on = (y / 2 + HALO) * coarse.width + x / 2 + HALO;
                    // A flow of one coarse cell's height is one of four through either of its two faces.
                    let goes = match place % 2 {
                        1 => 4.0 * sums[on],
                        _ => 2.0 * (sums[on - beside] + sums[on]),
                    };
                    let (own, other) = (self.wet[at] - bare, self.wet[at + next] - bare);
                    let most = LARGEST_SHARE * if goes > 0.0 { own } else { other };
                    let dry = (own <= 0.0) | (other <= 0.0);
                    let goes = larger(smaller(goes, most), -most);
                    self.flows[axis][at] = if dry { 0.0 } else { goes };
                }
            }
        }
    }
}
