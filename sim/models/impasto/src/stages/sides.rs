//! Deposit along a step, as [`Spread`] has it: what contacts give to the cells beside theirs, as far as their bristles
//! touch these, too.

use maulstick_canvas::quantum::CELL_MAX;
use maulstick_canvas::window::{Area, Window};
use maulstick_model::footprint::Footprint;
use maulstick_model::interface::Step;
use maulstick_model::spread::Spread;
use maulstick_num::select::{larger, smaller};
use maulstick_num::wide;

use super::sheets::{NONE, SEVERAL, besides, left_under, only_on};

/// Share of its capacity up to which cells take parts of their neighbours' deposits.
pub const TAKES: f32 = 0.25;

/// What is known of the sheets of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Layered {
    /// It is beside the contacts, and has this only paint so far.
    Beside(u8),
    /// It is a contact's.
    Touched,
    /// It is beside the contacts, and two sheets may lie.
    Two,
}

/// Deposits on the cells around the contacts, row after row.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sides {
    spread: Spread,
    around: Area,
    /// Place of each contact.
    places: Vec<u32>,
    /// Height that a cell shows to bristles from beside, all of it where it is touched, and the height beside a contact
    /// from which its bristles touch, cells.
    heights: [Vec<f32>; 2],
    layered: Vec<Layered>,
    /// 1 where two sheets may lie.
    two: Vec<f32>,
    /// Quanta that come over the upper sheets, of other paint.
    covered: Vec<f32>,
    /// The cells beside the contacts where two sheets may lie, in the window and here.
    beside: Vec<(usize, usize)>,
    /// Quanta of a deposit where the contacts are, quanta that leave each cell and those that come to it.
    given: Vec<f32>,
    moved: [Vec<f32>; 2],
}

wide! {
    /// Parts of what is given at each cell: those that leave, and those that come.
    fn share_out(
        given: &[f32],
        heights: &[Vec<f32>; 2],
        moved: &mut [Vec<f32>; 2],
        size: [usize; 2],
        spread: Spread,
    ) {
        let [sent, came] = moved;
        let count = given.len();
        let (shows, from) = (&heights[0][..count], &heights[1][..count]);
        for plane in [&mut *sent, &mut *came] {
            plane.clear();
            plane.resize(given.len(), 0.0);
        }
        let [width, height] = size;
        for off in 1..=spread.reach() {
            let (share, [dx, dy]) = (spread.share(off), spread.offset(off));
            let (dx, dy, back) = (dx.unsigned_abs(), dy.unsigned_abs(), (dx < 0) != (dy < 0));
            // Columns of the lower of two rows, and of the upper one.
            let columns = if back { [dx, 0] } else { [0, dx] };
            let inner = width.saturating_sub(dx);
            for row in 0..height.saturating_sub(dy) {
                let [low, high] = [row * width + columns[0], (row + dy) * width + columns[1]];
                for i in 0..inner {
                    let open = shows[high + i] > from[low + i];
                    let part = if open { (given[low + i] * share).floor() } else { 0.0 };
                    sent[low + i] += part;
                    came[high + i] += part;
                }
                for i in 0..inner {
                    let open = shows[low + i] > from[high + i];
                    let part = if open { (given[high + i] * share).floor() } else { 0.0 };
                    sent[high + i] += part;
                    came[low + i] += part;
                }
            }
        }
    }
}

wide! {
    /// Moves what left and came, in the rows of a plane and of what of it is in the upper sheet.
    fn take(moved: [&[f32]; 2], two: &[f32], plane: &mut [f32], upper: Option<&mut [f32]>) {
        let [sent, came] = moved;
        let count = plane.len();
        let (sent, came, two) = (&sent[..count], &came[..count], &two[..count]);
        for i in 0..count {
            plane[i] += came[i] - sent[i];
        }
        if let Some(upper) = upper {
            let upper = &mut upper[..count];
            for i in 0..count {
                upper[i] = larger(upper[i] - two[i] * sent[i], 0.0) + two[i] * came[i];
            }
        }
    }
}

impl Sides {
    /// Begins a step whose deposits may be spread; true if they are.
    pub(crate) fn begin(
        &mut self,
        footprint: &Footprint,
        step: &Step<'_>,
        may_spread: bool,
    ) -> bool {
        self.spread = Spread::of(step);
        if !may_spread || self.spread.reach() == 0 || footprint.fullest() > TAKES * CELL_MAX as f32
        {
            self.spread = Spread::default();
            return false;
        }
        self.around = footprint.around;
        let places = footprint.contacts.iter().map(|contact| contact.local);
        self.places.clear();
        self.places.extend(places);
        let cells = self.around.cells();
        for plane in [&mut self.given, &mut self.two] {
            plane.clear();
            plane.resize(cells, 0.0);
        }
        self.layered.clear();
        self.beside.clear();
        self.measure(footprint, step);
        true
    }

    /// Measures how high the cells are, and from where on the bristles touch.
    fn measure(&mut self, footprint: &Footprint, step: &Step<'_>) {
        const TOUCHED: f32 = 1e9;
        let (window, traits) = (&*step.window, &step.traits);
        let [shows, from] = &mut self.heights;
        shows.resize(self.around.cells(), 0.0);
        window.weigh(&self.around, shows);
        let rows = self.around.rows(window.width());
        for (shows, row) in shows.chunks_exact_mut(self.around.size[0].max(1)).zip(rows) {
            for (height, base) in shows.iter_mut().zip(&window.base()[row]) {
                *height = base + *height * traits.cells_per_quantum;
            }
        }
        from.clear();
        from.resize(self.around.cells(), 0.0);
        for contact in &footprint.contacts {
            let place = contact.local as usize;
            let film =
                step.load.film(contact.texel as usize) as f32 * traits.film_cells_per_quantum;
            from[place] = shows[place] - contact.depth + contact.gap - film;
        }
        for contact in &footprint.contacts {
            shows[contact.local as usize] = TOUCHED;
        }
    }

    /// True if deposits are spread in this step.
    pub(crate) fn are_given(&self) -> bool {
        self.spread.reach() > 0
    }

    /// Spreads what the contacts give, in their order.
    fn spread(&mut self, given: impl Iterator<Item = f32>) {
        for (place, given) in self.places.iter().zip(given) {
            self.given[*place as usize] = given;
        }
        let size = self.around.size;
        share_out(
            &self.given,
            &self.heights,
            &mut self.moved,
            size,
            self.spread,
        );
    }

    /// Covers upper sheets: by contact, the quanta that come of a mixture that is not that of the sheet.
    pub(crate) fn cover(&mut self, contacts: impl Iterator<Item = f32>) {
        self.spread(contacts);
        let [sent, came] = &self.moved;
        let stays = self.given.iter().zip(sent);
        let covered = stays
            .zip(came)
            .map(|((given, sent), came)| given - sent + came);
        self.covered.clear();
        self.covered.extend(covered);
    }

    /// Quanta that come over the upper sheet of a contact, of other paint.
    pub(crate) fn covered(&self, contact: usize) -> f32 {
        self.covered[self.places[contact] as usize]
    }

    /// Notes where two sheets may lie, by the cell of each contact in the window, whether two may lie there, and the
    /// only paint of its texel.
    pub(crate) fn note_layered(
        &mut self,
        window: &Window,
        contacts: impl Iterator<Item = (usize, bool, u8)> + Clone,
    ) {
        self.layered
            .resize(self.around.cells(), Layered::Beside(NONE));
        for (place, (_, two, _)) in self.places.iter().zip(contacts.clone()) {
            let place = *place as usize;
            self.layered[place] = Layered::Touched;
            self.two[place] = f32::from(u8::from(two));
        }
        let (size, width) = (self.around.size, window.width() as isize);
        let spread = self.spread;
        for (place, (cell, _, on_texel)) in self.places.iter().zip(contacts) {
            let local = *place as usize;
            let at = [local % size[0], local / size[0]];
            let sides = (1..=spread.reach()).flat_map(|off| {
                let [dx, dy] = spread.offset(off);
                [[dx, dy], [-dx, -dy]]
            });
            let beside = sides.filter_map(|[dx, dy]| {
                let [x, y] = [at[0].checked_add_signed(dx)?, at[1].checked_add_signed(dy)?];
                let cell = cell.checked_add_signed(dy * width + dx)?;
                (x < size[0] && y < size[1]).then_some([cell, y * size[0] + x])
            });
            let [shows, from] = &self.heights;
            for [cell, beside] in beside {
                let Layered::Beside(so_far) = self.layered[beside] else {
                    continue;
                };
                if shows[beside] <= from[local] {
                    continue;
                }
                let there = if so_far == NONE {
                    only_on(window, cell)
                } else {
                    so_far
                };
                let only = besides(there, on_texel);
                self.layered[beside] = Layered::Beside(only);
                if only == SEVERAL {
                    self.layered[beside] = Layered::Two;
                    self.two[beside] = 1.0;
                    self.beside.push((cell, beside));
                }
            }
        }
    }

    /// Lets the upper sheet of a paint beside the contacts sink as other paint comes over it.
    pub(crate) fn sink(&self, [plane, upper]: [&mut Vec<f32>; 2]) {
        for (cell, local) in &self.beside {
            let above = smaller(upper[*cell], plane[*cell]);
            upper[*cell] = (above * left_under(self.covered[*local])).floor();
        }
    }

    /// Spreads a paint, by what the contacts have given their cells.
    pub(crate) fn spread_paint(
        &mut self,
        (window, slot): (&mut Window, usize),
        given: impl Iterator<Item = f32>,
    ) {
        self.spread(given);
        let (layered, width) = (window.has_sheets(), window.width());
        let (plane, mut upper) = if layered {
            let [plane, upper] = window.sheets_mut(slot);
            (plane, Some(upper))
        } else {
            (window.plane_mut(slot), None)
        };
        for (row, cells) in self.around.rows(width).enumerate() {
            let here = row * cells.len()..(row + 1) * cells.len();
            let moved = self.moved.each_ref().map(|plane| &plane[here.clone()]);
            let upper = upper.as_mut().map(|upper| &mut upper[cells.clone()]);
            take(moved, &self.two[here.clone()], &mut plane[cells], upper);
        }
    }
}
