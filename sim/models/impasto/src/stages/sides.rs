//! Deposit along a step, as [`Spread`] has it: what contacts give to the cells beside theirs.

use maulstick_canvas::quantum::CELL_MAX;
use maulstick_canvas::window::Window;
use maulstick_model::footprint::Footprint;
use maulstick_model::interface::Step;
use maulstick_model::spread::Spread;

use super::sheets::{NONE, SEVERAL, besides, left_under, only_on};

/// Share of its capacity up to which a cell takes parts of its neighbours' deposits.
pub const TAKES: f32 = 0.25;

/// What is known of the sheets of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Layered {
    /// It is beside the contacts, and has this only paint so far.
    Beside(u8),
    /// A contact's, of one paint.
    One,
    /// Two may lie.
    Two,
}

/// The cells beside the contacts, along the step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sides {
    spread: Spread,
    /// Offset to the next cell along the step, in the window and around the contacts.
    next: [usize; 2],
    /// For each contact its place around the contacts, and a bit for each side at each distance where there is a cell.
    places: Vec<(u32, u8)>,
    /// What is known of the sheets on the cells around the contacts.
    layered: Vec<Layered>,
    /// Quanta that come over their upper sheets, of other paint.
    covered: Vec<f32>,
    /// The cells among them that are no contacts, in the window.
    beside: Vec<(usize, usize)>,
}

/// A part of a deposit: the cell that gives it and the one that takes it, in the window and around the contacts.
pub(crate) struct Part {
    pub quanta: f32,
    pub cells: [usize; 2],
    pub layered: [bool; 2],
}

impl Sides {
    /// Finds the cells beside the contacts; true if there are any.
    pub(crate) fn find(&mut self, footprint: &Footprint, step: &Step<'_>) -> bool {
        self.spread = Spread::of(step);
        let reach = self.spread.reach();
        if reach == 0 || footprint.fullest() > TAKES * CELL_MAX as f32 {
            self.spread = Spread::default();
            return false;
        }
        let (size, axis) = (footprint.around.size, self.spread.axis as usize);
        self.next = [[1, step.window.width()][axis], [1, size[0]][axis]];
        self.places.clear();
        self.places.extend(footprint.contacts.iter().map(|contact| {
            let place = [
                contact.local as usize % size[0],
                contact.local as usize / size[0],
            ][axis];
            let open = (1..=reach).fold(0, |open, off| {
                let both = u8::from(place >= off) | u8::from(place + off < size[axis]) << 1;
                open | both << (2 * (off - 1))
            });
            (contact.local, open)
        }));
        self.layered.clear();
        self.layered
            .resize(footprint.around.cells(), Layered::Beside(NONE));
        self.covered.clear();
        self.covered.resize(footprint.around.cells(), 0.0);
        self.beside.clear();
        true
    }

    /// True if deposits are spread in this step.
    pub(crate) fn are_given(&self) -> bool {
        self.spread.reach() > 0
    }

    /// Covers upper sheets: by contact, the quanta that come of a mixture that is not that of the sheet.
    pub(crate) fn cover(&mut self, contacts: impl Iterator<Item = f32>) {
        for ((local, open), quanta) in self.places.iter().zip(contacts) {
            let local = *local as usize;
            let mut rest = quanta;
            for side in self.sides(*open) {
                let part = quanta * self.spread.share(side.off);
                rest -= part;
                self.covered[side.of([0, local], self.next)[1]] += part;
            }
            self.covered[local] += rest;
        }
    }

    /// Quanta that come over the upper sheet of a contact, of other paint.
    pub(crate) fn covered(&self, contact: usize) -> f32 {
        self.covered[self.places[contact].0 as usize]
    }

    /// Notes where two sheets may lie, by the cell of each contact in the window, whether two may lie there, and the
    /// only paint of its texel.
    pub(crate) fn note_layered(
        &mut self,
        window: &Window,
        contacts: impl Iterator<Item = (usize, bool, u8)> + Clone,
    ) {
        for ((local, _), (_, is_layered, _)) in self.places.iter().zip(contacts.clone()) {
            let known = [Layered::One, Layered::Two][usize::from(is_layered)];
            self.layered[*local as usize] = known;
        }
        for ((local, open), (cell, _, on_texel)) in self.places.iter().zip(contacts) {
            for side in self.sides(*open) {
                let [cell, local] = side.of([cell, *local as usize], self.next);
                let Layered::Beside(so_far) = self.layered[local] else {
                    continue;
                };
                let there = if so_far == NONE {
                    only_on(window, cell)
                } else {
                    so_far
                };
                let only = besides(there, on_texel);
                self.layered[local] = Layered::Beside(only);
                if only == SEVERAL {
                    self.layered[local] = Layered::Two;
                    self.beside.push((cell, local));
                }
            }
        }
    }

    /// Lets the upper sheet beside the contacts sink as other paint comes over it; by cell of the window.
    pub(crate) fn sink(&self, upper: &mut [f32]) {
        for (cell, local) in &self.beside {
            upper[*cell] = (upper[*cell] * left_under(self.covered[*local])).floor();
        }
    }

    /// The parts of a deposit of `given` quanta by the contact with this number, on this cell of the window.
    pub(crate) fn parts(
        &self,
        contact: usize,
        cell: usize,
        given: f32,
    ) -> impl Iterator<Item = Part> {
        let (local, open) = self.places[contact];
        let from = [cell, local as usize];
        self.sides(open).filter_map(move |side| {
            let quanta = (given * self.spread.share(side.off)).floor();
            let to = side.of(from, self.next);
            (quanta >= 1.0).then(|| Part {
                quanta,
                cells: [from[0], to[0]],
                layered: [from[1], to[1]].map(|at| self.layered[at] == Layered::Two),
            })
        })
    }

    /// The open sides of a contact.
    fn sides(&self, open: u8) -> impl Iterator<Item = Side> + use<> {
        let sides = (1..=self.spread.reach()).flat_map(|off| [(off, false), (off, true)]);
        let sides = sides
            .enumerate()
            .filter(move |(bit, _)| open >> bit & 1 == 1);
        sides.map(|(_, (off, ahead))| Side { off, ahead })
    }
}

/// A cell beside another.
struct Side {
    off: usize,
    ahead: bool,
}

impl Side {
    /// Its places by those of the other, and by the offsets to the next cell.
    fn of(&self, from: [usize; 2], next: [usize; 2]) -> [usize; 2] {
        [0, 1].map(|i| {
            let off = self.off * next[i];
            if self.ahead {
                from[i] + off
            } else {
                from[i] - off
            }
        })
    }
}
