//! Stages 4 and 5: paint goes from brush to canvas or from canvas to brush (Baxter 2004, § 6.5).
//!
//! Algorithm 3 computes the transfer of each cell, once for both sides. Where both carry paint, their films are also
//! swapped, so a brush that is full, or that carries as much as the canvas, still takes on its colour. The demands of
//! cells on one brush texel are summed, scaled together where they exceed its stock, and truncated once.

use maulstick_canvas::quantum::{CELL_MAX, QUANTA_PER_UNIT, SLOTS};
use maulstick_num::fork_join::{Balance, each};
use maulstick_num::select::{larger, smaller};
use maulstick_num::wide;
use std::ops::Range;

use maulstick_model::brush::load::BrushLoad;
use maulstick_model::brush::traits::BrushTraits;
use maulstick_model::footprint::Footprint;
use maulstick_model::footprint::contact::Contact;
use maulstick_model::footprint::shares_of;
use maulstick_model::interface::{Handling, Step, Transfer};
use maulstick_model::transfer::{Exchanging, POOL};

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
    balance: Balance,
    /// For one paint, the share of the demand that each of these texels grants.
    gives: Vec<f32>,
    /// For one paint, the quanta on each of these texels.
    held: Vec<f32>,
}

/// Paint that each touching texel gives and takes.
#[derive(Clone, Debug, Default)]
struct Granted {
    /// Quanta demanded from the texel, and offered to it; later the grant per quantum in its film.
    asked: Vec<[f32; 2]>,
    /// Share of the offers that the texel takes.
    taken: Vec<f32>,
    /// Quanta in its film.
    film: Vec<f32>,
}

/// One core's contacts, in order.
#[derive(Clone, Debug, Default)]
struct Share {
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
    /// Change of one paint on each of the texels, quanta: a wide one exceeds the exact range of `f32`.
    change: Vec<i32>,
}

/// [`Meeting`]s, a plane each.
#[derive(Clone, Debug, Default)]
struct Meetings {
    travel: Vec<f32>,
    cover: Vec<f32>,
    on_brush: Vec<f32>,
    lying: Vec<f32>,
    fraction: Vec<f32>,
    gap: Vec<f32>,
}

impl Meetings {
    fn of(&mut self, contacts: &[Contact], films: &[u32], traits: &BrushTraits) {
        let on_brush = |contact: &Contact| {
            films[contact.texel as usize] as f32 * traits.film_units_per_quantum
        };
        for plane in [
            &mut self.travel,
            &mut self.cover,
            &mut self.on_brush,
            &mut self.fraction,
            &mut self.gap,
        ] {
            plane.clear();
        }
        self.travel
            .extend(contacts.iter().map(|contact| contact.travel(traits)));
        self.cover
            .extend(contacts.iter().map(|contact| contact.cover));
        self.on_brush.extend(contacts.iter().map(on_brush));
        self.fraction
            .extend(contacts.iter().map(|contact| contact.fraction));
        let gap = |contact: &Contact| contact.gap * traits.units_per_cell;
        self.gap.extend(contacts.iter().map(gap));
    }
}

/// Index of a texel that does not touch.
const ABSENT: u32 = u32::MAX;
/// Greatest share of a film used up at once: reduced so that rounding never takes more than there is.
const SAFE_SHARE: f32 = 1.0 - 1.0 / 1_048_576.0;

/// State of a contact before the exchange.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Meeting {
    /// Path of the brush, reference cells.
    pub travel: f32,
    /// Share of the cell that is covered, 0 to 1.
    pub cover: f32,
    /// The brush's film, units.
    pub on_brush: f32,
    /// Wet paint on the cell, quanta.
    pub lying: f32,
    /// Share of it that the brush reaches.
    pub fraction: f32,
    /// Gap between brush and paint, units.
    pub gap: f32,
}

/// Demand of a contact: quanta from the brush, and to it.
#[must_use]
#[inline(always)]
pub(crate) fn wanted(meeting: &Meeting, rule: &Exchanging, handling: &Handling) -> [f32; 2] {
    let quanta = meeting.cover * QUANTA_PER_UNIT as f32;
    let lying = meeting.lying * (1.0 / QUANTA_PER_UNIT as f32);
    let on_canvas = lying * meeting.fraction;
    let (net, swap) = match handling.transfer {
        Transfer::Marker { flow } => (flow * meeting.travel, 0.0),
        _ => {
            let share = rule.share(meeting.travel);
            let amounts = [meeting.on_brush, on_canvas, lying, meeting.gap];
            let net = rule.transfer(amounts, meeting.travel, share);
            let wet = [meeting.on_brush, lying, larger(meeting.gap, 0.0)];
            (net, rule.swapped(wet, meeting.travel))
        }
    };
    let hollow = larger(meeting.gap, 0.0) * QUANTA_PER_UNIT as f32;
    let pool = smaller(hollow, POOL * handling.most);
    let most = smaller(handling.most + pool, CELL_MAX as f32);
    let room = larger(most - meeting.lying, 0.0);
    // Swapped paint has room on both sides, or stays on both.
    let swap = smaller(swap * quanta, room);
    let given = smaller(larger(net, 0.0) * quanta + swap, room);
    let taken = smaller(larger(-net, 0.0) * quanta + swap, meeting.lying);
    [given.floor(), taken.floor()]
}

wide! {
    /// Demands of all contacts: quanta from the brush, and to it.
    fn want(
        meetings: &Meetings,
        rule: &Exchanging,
        handling: &Handling,
        wants: &mut [Vec<f32>; 2],
    ) {
        let count = meetings.travel.len();
        let [given, taken] = wants;
        for plane in [&mut *given, &mut *taken] {
            plane.clear();
            plane.resize(count, 0.0);
        }
        let (given, taken) = (&mut given[..count], &mut taken[..count]);
        let (travel, cover) = (&meetings.travel[..count], &meetings.cover[..count]);
        let (on_brush, lying) = (&meetings.on_brush[..count], &meetings.lying[..count]);
        let (fraction, gap) = (&meetings.fraction[..count], &meetings.gap[..count]);
        for i in 0..count {
            let meeting = Meeting {
                travel: travel[i],
                cover: cover[i],
                on_brush: on_brush[i],
                lying: lying[i],
                fraction: fraction[i],
                gap: gap[i],
            };
            [given[i], taken[i]] = wanted(&meeting, rule, handling);
        }
    }
}

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

/// Cells of a plane from the place `first` on.
struct Cells<'a> {
    first: usize,
    cells: &'a mut [f32],
}

impl Exchange {
    /// Exchanges the paint of one step; by slot, the uncounted quanta added to the canvas.
    pub fn run(&mut self, footprint: &Footprint, step: &mut Step<'_>) -> [i64; SLOTS] {
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
        each(used, |share| share.share(granted, lasting));
        let mut from_nowhere = [0; SLOTS];
        for slot in 0..SLOTS {
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
        self.held.clear();
        match step.load.film_of(slot) {
            Some(film) => {
                let there = self.texels.iter().map(|texel| film[*texel as usize] as f32);
                self.held.extend(there);
            }
            None => self.held.resize(self.texels.len(), 0.0),
        }
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
        let plane = step.window.plane_mut(slot);
        let sponge = step.handling.transfer == Transfer::Sponge;
        let counted = sponge || step.lasting;
        let before = if counted { self.on_cells(plane) } else { 0 };
        let (gives, mut rest) = (&self.gives, &mut plane[..]);
        // Contacts are in the order of their cells, so the last share has the last of them.
        let shares = self.shares[..self.used].iter_mut().rev();
        let shares = shares.filter_map(|share| {
            let first = *share.cells.first()? as usize;
            let cells = rest.split_off_mut(first..)?;
            Some((share, Cells { first, cells }))
        });
        each(&mut shares.collect::<Vec<_>>(), |(share, cells)| {
            swap_paint(share, gives, cells);
        });
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
        self.meetings.of(contacts, step.load.films(), &step.traits);
        want(
            &self.meetings,
            &step.traits.exchanging,
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
}

impl Granted {
    /// Scales the demands on each texel, and the offers to it, to its stock and capacity.
    fn grant(&mut self, texels: &[u32], load: &BrushLoad, traits: &BrushTraits, sponge: bool) {
        let most = traits.film_most as f32;
        self.taken.clear();
        self.film.clear();
        for (texel, [drawn, offered]) in texels.iter().zip(&mut self.asked) {
            let film = load.film(*texel as usize) as f32;
            let granted = if *drawn > film && !sponge {
                SAFE_SHARE * film / *drawn
            } else {
                1.0
            };
            let room = (most - film + *drawn * granted).max(0.0);
            let taken = if *offered > room && !sponge {
                room / *offered
            } else {
                1.0
            };
            // By quantum of all paints in the film, from which each paint's share follows.
            *drawn = if film > 0.0 { granted / film } else { 0.0 };
            self.taken.push(taken);
            self.film.push(film);
        }
    }
}
