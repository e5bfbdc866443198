//! Stages 4 and 5: paint goes from brush to canvas or from canvas to brush (Baxter 2004, § 6.5).
//!
//! Algorithm 3 computes the transfer of each cell, once for both sides. Where both carry paint, their films are also
//! swapped, so a brush that is full, or that carries as much as the canvas, still takes on its colour. The demands of
//! cells on one brush texel are summed, scaled together where they exceed its stock, and truncated once.

mod granted;
mod meeting;

use maulstick_canvas::quantum::SLOTS;
use maulstick_canvas::window::Window;
use maulstick_num::fork_join::{Balance, each};
use maulstick_num::select::smaller;
use maulstick_num::wide;
use std::ops::Range;

use maulstick_model::brush::load::BrushLoad;
use maulstick_model::footprint::Footprint;
use maulstick_model::footprint::contact::Contact;
use maulstick_model::footprint::shares_of;
use maulstick_model::interface::{Step, Transfer};

use granted::Granted;
use meeting::{Meetings, want};

use super::sheets::{OnTexel, SheetExchange, Sheets, look};
use super::sides::Sides;

/// Buffers of a step. Few of the brush's many texels touch at a time: these are renumbered in each step, so that the
/// others cost nothing.
#[derive(Clone, Debug, Default)]
pub struct Exchange {
    /// Contacts distributed to the cores; shares beyond `used` are left from other steps.
    shares: Vec<Share>,
    used: usize,
    texels: Vec<u32>,
    /// Index of each texel of the brush in `texels`; [`ABSENT`] unless it touches.
    place_of: Vec<u32>,
    granted: Granted,
    /// What is in the film of each of these texels.
    on_texels: Vec<OnTexel>,
    sides: Sides,
    balance: Balance,
    /// For one paint, the share of the demand that each of these texels grants.
    gives: Vec<f32>,
    /// For one paint, the quanta on each of these texels.
    held: Vec<f32>,
}

/// One core's contacts, in order.
#[derive(Clone, Debug, Default)]
struct Share {
    /// Number of its first contact.
    first: usize,
    /// Share of what bristles reach that they shear in the step.
    shear: f32,
    meetings: Meetings,
    /// Quanta that each contact demands from the brush, and offers to it.
    wants: [Vec<f32>; 2],
    /// Cell of each contact.
    cells: Vec<u32>,
    /// Index of each contact's texel among those that touch.
    places: Vec<u32>,
    /// Share of the wet paint on each contact's cell that goes to the brush.
    shares: Vec<f32>,
    /// Share of the paint taken up that leaves each contact's cell.
    leaves: Vec<f32>,
    /// The two sheets of its cells, where there may be two.
    sheets: Option<Sheets>,
    /// Change of one paint on each of the texels, quanta: a wide one exceeds the exact range of `f32`.
    change: Vec<i32>,
}

/// Index of a texel that does not touch.
const ABSENT: u32 = u32::MAX;
wide! {
    /// One paint, both ways: `change` is the amount added to each texel.
    fn swap_paint(own: &mut Share, gives: &[f32], plane: &mut Cells<'_>) {
        let asked = own.wants[0].iter().zip(&own.shares);
        let ways = own.cells.iter().zip(&own.places);
        for (((cell, place), (given, share)), leaves) in ways.zip(asked).zip(&own.leaves) {
            let count = &mut plane.cells[*cell as usize - plane.first];
            let place = *place as usize;
            let given = (given * gives[place]).floor();
            let taken = (*count * share).floor();
            *count += given - (leaves * taken).floor();
            own.change[place] += (taken - given) as i32;
        }
    }
}

wide! {
    /// One paint, both ways, where it may lie in two sheets.
    fn swap_sheets(own: &mut Share, gives: &[f32], planes: &mut [Cells<'_>; 2]) {
        let [plane, upper] = planes;
        let Some(Sheets { parted: [from_top, from_body, kept, fits], .. }) = &own.sheets else {
            return;
        };
        for (i, cell) in own.cells.iter().enumerate() {
            let at = *cell as usize - plane.first;
            let (count, above) = (&mut plane.cells[at], &mut upper.cells[at]);
            let place = own.places[i] as usize;
            let given = (own.wants[0][i] * gives[place]).floor();
            let top = smaller(*above, *count);
            let off = [(top * from_top[i]).floor(), ((*count - top) * from_body[i]).floor()];
            let taken = off[0] + off[1];
            *count += given - (own.leaves[i] * taken).floor();
            let left = ((top - (own.leaves[i] * off[0]).floor()) * kept[i]).floor();
            *above = ((left + given) * fits[i]).floor();
            own.change[place] += (taken - given) as i32;
        }
    }
}

/// Cells of a plane from the place `first` on.
struct Cells<'a> {
    first: usize,
    cells: &'a mut [f32],
}

impl Exchange {
    /// Exchanges the paint of one step; by slot, the uncounted quanta added to the canvas.
    pub fn run(&mut self, footprint: &Footprint, step: &mut Step<'_>) -> [i64; SLOTS] {
        self.run_as(footprint, step, true)
    }

    /// [`run`](Self::run) that changes no cells beside the contacts: deposits are not spread along the step.
    pub fn run_in_place(&mut self, footprint: &Footprint, step: &mut Step<'_>) -> [i64; SLOTS] {
        self.run_as(footprint, step, false)
    }

    fn run_as(
        &mut self,
        footprint: &Footprint,
        step: &mut Step<'_>,
        may_spread: bool,
    ) -> [i64; SLOTS] {
        let contacts = footprint.contacts.len();
        let ranges = self.balance.cut(contacts, shares_of(contacts));
        self.find_texels(footprint, &ranges, step.load.texels());
        let (texels, used) = (self.texels.len(), &mut self.shares[..self.used]);
        let (shared, contacts) = (&*step, &footprint.contacts);
        let mut shares: Vec<_> = used.iter_mut().zip(ranges).collect();
        self.balance.each(&mut shares, |(share, range)| {
            share.demand(&contacts[range.clone()], shared);
        });
        let granted = &mut self.granted;
        granted.asked.clear();
        granted.asked.resize(texels, [0.0; 2]);
        for share in &*used {
            share.ask(&mut granted.asked);
        }
        let sponge = step.handling.transfer == Transfer::Sponge;
        granted.grant(&self.texels, step.load, &step.traits, sponge);
        let (granted, lasting) = (&*granted, step.lasting);
        let layered = step.may_have_sheets();
        if layered {
            look(&self.texels, step.load, &mut self.on_texels);
        }
        let on_texels = layered.then_some((&self.texels[..], &self.on_texels[..]));
        let shared = &*step;
        each(used, |share| {
            share.share(granted, lasting);
            share.weigh(shared, on_texels);
        });
        let spreads = self.sides.begin(footprint, step, may_spread);
        if spreads && layered {
            let covers = used.iter().flat_map(|share| share.covers(granted));
            self.sides.cover(covers);
        }
        let sides = spreads.then_some(&self.sides);
        each(used, |share| share.part(granted, sides));
        if spreads && layered {
            let contacts = self.shares[..self.used].iter().flat_map(Share::layered);
            let on_texels = &self.on_texels;
            let contacts = contacts.map(|(cell, is_layered, place)| {
                (cell as usize, is_layered, on_texels[place as usize].only)
            });
            self.sides.note_layered(step.window, contacts);
        }
        self.exchange_all(step)
    }

    /// Exchanges all slots; by slot, the uncounted quanta.
    fn exchange_all(&mut self, step: &mut Step<'_>) -> [i64; SLOTS] {
        let sponge = step.handling.transfer == Transfer::Sponge;
        let mut from_nowhere = [0; SLOTS];
        for slot in 0..SLOTS {
            if !step.load.has(slot) && !step.window.has(slot) {
                continue;
            }
            let change = self.exchange(slot, step);
            from_nowhere[slot] = change;
            if !sponge {
                self.note_on_brush(slot, step.load);
            }
        }
        step.load.count_films_of(&self.texels);
        from_nowhere
    }

    fn find_texels(&mut self, footprint: &Footprint, ranges: &[Range<usize>], texels: usize) {
        for texel in self.texels.drain(..) {
            self.place_of[texel as usize] = ABSENT;
        }
        self.place_of.resize(texels, ABSENT);
        self.used = ranges.len();
        let shares = self.shares.len().max(self.used);
        self.shares.resize_with(shares, Share::default);
        for (share, range) in self.shares.iter_mut().zip(ranges) {
            share.places.clear();
            share.first = range.start;
            for contact in &footprint.contacts[range.clone()] {
                let place = &mut self.place_of[contact.texel as usize];
                if *place == ABSENT {
                    *place = self.texels.len() as u32;
                    self.texels.push(contact.texel);
                }
                share.places.push(*place);
            }
        }
    }

    /// Exchanges one slot, both ways, and returns the uncounted quanta. The gain of the brush is in the shares'
    /// `change`.
    fn exchange(&mut self, slot: usize, step: &mut Step<'_>) -> i64 {
        self.hold(slot, step.load);
        let on_brush = self.held.iter().any(|count| *count > 0.0);
        let shares = &mut self.shares[..self.used];
        shares.iter_mut().for_each(|share| share.change.clear());
        if !on_brush && !step.window.has(slot) {
            return 0;
        }
        for share in shares {
            share.change.resize(self.texels.len(), 0);
        }
        let held = self.held.iter().zip(&self.granted.asked);
        self.gives.clear();
        self.gives
            .extend(held.map(|(held, [drawn, _])| held * drawn));
        let sponge = step.handling.transfer == Transfer::Sponge;
        let counted = sponge || step.lasting;
        let before = if counted {
            self.on_cells(step.window.plane_mut(slot))
        } else {
            0
        };
        let layered = self.swap(slot, step.window);
        if self.sides.are_given() {
            if layered {
                self.sides.sink(step.window.sheets_mut(slot));
            }
            if on_brush {
                self.spread(slot, step.window);
            }
        }
        // Counted paint: one side gains what the other loses.
        if !counted {
            return 0;
        }
        let changes = self.in_use().iter().flat_map(|share| &share.change);
        let onto_brush: i64 = if sponge {
            0
        } else {
            changes.map(|change| i64::from(*change)).sum()
        };
        self.on_cells(step.window.plane_mut(slot)) - before + onto_brush
    }

    /// Looks up the quanta of a paint on the touching texels.
    fn hold(&mut self, slot: usize, load: &BrushLoad) {
        self.held.clear();
        match load.film_of(slot) {
            Some(film) => {
                let there = self.texels.iter().map(|texel| film[*texel as usize] as f32);
                self.held.extend(there);
            }
            None => self.held.resize(self.texels.len(), 0.0),
        }
    }

    /// Exchanges one paint on the cells of all contacts; true where it may lie in two sheets.
    fn swap(&mut self, slot: usize, window: &mut Window) -> bool {
        let layered = self.in_use().iter().any(|share| share.sheets.is_some());
        let mut planes = if layered {
            window.sheets_mut(slot).map(|plane| &mut plane[..])
        } else {
            [&mut window.plane_mut(slot)[..], &mut []]
        };
        let gives = &self.gives;
        // Contacts are in the order of their cells, so the last share has the last of them.
        let shares = self.shares[..self.used].iter_mut().rev();
        let shares = shares.filter_map(|share| {
            let first = *share.cells.first()? as usize;
            let cells = planes.each_mut().map(|rest| Cells {
                first,
                cells: rest.split_off_mut(first..).unwrap_or_default(),
            });
            Some((share, cells))
        });
        each(&mut shares.collect::<Vec<_>>(), |(share, cells)| {
            if share.sheets.is_some() {
                swap_sheets(share, gives, cells);
            } else {
                swap_paint(share, gives, &mut cells[0]);
            }
        });
        layered
    }

    /// Spreads one paint that was given along the step.
    fn spread(&mut self, slot: usize, window: &mut Window) {
        let gives = &self.gives;
        let given = self.shares[..self.used].iter().flat_map(|share| {
            let wants = share.wants[0].iter().zip(&share.places);
            wants.map(|(given, place)| (given * gives[*place as usize]).floor())
        });
        self.sides.spread_paint((window, slot), given);
    }

    /// Quanta of a plane on the contacts.
    fn on_cells(&self, plane: &[f32]) -> i64 {
        let cells = self.in_use().iter().flat_map(|share| &share.cells);
        cells.map(|cell| plane[*cell as usize] as i64).sum()
    }

    fn note_on_brush(&mut self, slot: usize, load: &mut BrushLoad) {
        let Some((sums, others)) = self.shares[..self.used].split_first_mut() else {
            return;
        };
        for other in others {
            let changes = sums.change.iter_mut().zip(&other.change);
            changes.for_each(|(sum, change)| *sum += change);
        }
        for (texel, change) in self.texels.iter().zip(&sums.change) {
            if *change != 0 {
                load.change_film(slot, *texel as usize, *change);
            }
        }
    }

    /// Shares of this step.
    fn in_use(&self) -> &[Share] {
        &self.shares[..self.used]
    }
}

impl Share {
    /// Demand of each contact on its texel, and its offer to it.
    fn demand(&mut self, contacts: &[Contact], step: &Step<'_>) {
        self.cells.clear();
        self.cells
            .extend(contacts.iter().map(|contact| contact.cell));
        step.window.totals(&self.cells, &mut self.meetings.lying);
        let (exchanging, press) = (&step.traits.exchanging, step.sweep.to.press);
        self.shear = exchanging.shear(press);
        self.meetings.of(contacts, step.load.films(), &step.traits);
        want(
            &self.meetings,
            &exchanging.pressed(press),
            &step.handling,
            &mut self.wants,
        );
    }

    /// Sums the demands on each texel, and the offers to it.
    fn ask(&self, asked: &mut [[f32; 2]]) {
        let [given, taken] = &self.wants;
        for (place, (given, taken)) in self.places.iter().zip(given.iter().zip(taken)) {
            let asked = &mut asked[*place as usize];
            asked[0] += given;
            asked[1] += taken;
        }
    }

    /// Computes the paint of each contact's cell that goes to the brush.
    ///
    /// Paint that lasts loses only as much as it gains: it takes on the brush's colour without loss of volume.
    fn share(&mut self, granted: &Granted, lasting: bool) {
        self.shares.clear();
        let offers = self.wants[1].iter().zip(&self.places);
        let offers = offers.zip(&self.meetings.lying);
        self.shares.extend(offers.map(|((offered, place), lying)| {
            let goes = offered * granted.taken[*place as usize];
            if *lying > 0.0 { goes / lying } else { 0.0 }
        }));
        self.leaves.clear();
        if !lasting {
            self.leaves.resize(self.cells.len(), 1.0);
            return;
        }
        let [given, offered] = &self.wants;
        let amounts = given.iter().zip(offered).zip(&self.places);
        self.leaves.extend(amounts.map(|((given, offered), place)| {
            let place = *place as usize;
            let comes = given * granted.asked[place][0] * granted.film[place];
            let goes = offered * granted.taken[place];
            if goes > comes { comes / goes } else { 1.0 }
        }));
    }

    /// For each contact its cell, whether two sheets may lie there, and the place of its texel.
    fn layered(&self) -> impl Iterator<Item = (u32, bool, u32)> + Clone {
        let fits = self.sheets.iter().flat_map(|sheets| &sheets.parted[3]);
        let cells = self.cells.iter().zip(&self.places).zip(fits);
        cells.map(|((cell, place), fits)| (*cell, *fits > 0.0, *place))
    }

    /// Weighs the sheets of its cells, where there may be two; with the touching texels, and what is on them.
    fn weigh(&mut self, step: &Step<'_>, on: Option<(&[u32], &[OnTexel])>) {
        let Some((texels, found)) = on else {
            self.sheets = None;
            return;
        };
        let sheets = self.sheets.get_or_insert_default();
        let on_texels = self.places.iter().map(|place| {
            let place = *place as usize;
            (texels[place], found[place])
        });
        sheets.weigh(step.window, step.load, &self.cells, on_texels);
    }

    /// Quanta that a contact's texel gives.
    fn comes(&self, i: usize, granted: &Granted) -> f32 {
        let place = self.places[i] as usize;
        self.wants[0][i] * granted.asked[place][0] * granted.film[place]
    }

    /// By contact, the quanta that come of a mixture that is not that of the upper sheet.
    fn covers(&self, granted: &Granted) -> impl Iterator<Item = f32> {
        let differ = self.sheets.iter().flat_map(Sheets::differ).enumerate();
        differ.map(|(i, differs)| differs * self.comes(i, granted))
    }

    /// Parts the sheets of its cells, where there may be two.
    fn part(&mut self, granted: &Granted, sides: Option<&Sides>) {
        let Some(mut sheets) = self.sheets.take() else {
            return;
        };
        let meetings = &self.meetings;
        sheets.part(|i, top, differs| {
            let comes = self.comes(i, granted);
            SheetExchange {
                top,
                lying: meetings.lying[i],
                fraction: self.shear * meetings.fraction[i],
                travel: meetings.travel[i],
                comes,
                goes: self.wants[1][i] * granted.taken[self.places[i] as usize],
                leaves: self.leaves[i],
                covered: match sides {
                    Some(sides) => sides.covered(self.first + i),
                    None => differs * comes,
                },
            }
        });
        self.sheets = Some(sheets);
    }
}
