//! Stages 4 and 5: paint goes from brush to canvas or from canvas to brush (Baxter 2004, § 6.5).
//!
//! Algorithm 3 decides for each cell, once for both sides. Cells that draw on one brush texel have
//! their demands summed, scaled together where they exceed what it holds, and truncated once.

use super::footprint::{Contact, Footprint};
use crate::load::BrushLoad;
use crate::model::{BrushTraits, Step};
use crate::quantum::{CELL_MAX, QUANTA_PER_UNIT, SLOTS};
use crate::transfer::transfer;
use crate::window::Window;

/// Room for a step. Of the brush's many texels few touch at a time: these are numbered afresh in each
/// step, so that the others cost nothing.
#[derive(Clone, Debug, Default)]
pub struct Exchange {
    /// Quanta that each contact wants from the brush (positive) or gives to it (negative).
    wants: Vec<f32>,
    /// The place of each contact's texel in `texels`.
    places: Vec<u32>,
    /// The texels that touch.
    texels: Vec<u32>,
    /// The place of each texel of the brush in `texels`; [`NOWHERE`] but for those that touch.
    place_of: Vec<u32>,
    /// Quanta wanted of each texel that touches.
    drawn: Vec<f32>,
    /// Quanta offered to each.
    offered: Vec<f32>,
    /// Share of its wants that a texel grants, and of its offers that it takes.
    granted: Vec<[f64; 2]>,
    before: Vec<u32>,
    /// Wet quanta that lie on each contact's cell before the exchange.
    lying: Vec<f32>,
    /// Share of these that each contact gives to the brush.
    shares: Vec<f64>,
}

/// The place of a texel that does not touch.
const NOWHERE: u32 = u32::MAX;

/// Quanta that a contact wants from the brush (positive) or gives to it (negative).
#[must_use]
pub fn wanted(contact: &Contact, on_brush: f32, on_canvas: f32, traits: &BrushTraits) -> f32 {
    let [u, v] = contact.moved;
    let travel = (u * u + v * v).sqrt() * traits.cell_per_reference;
    let units = transfer(on_brush, on_canvas * contact.fraction, travel);
    units * contact.cover * QUANTA_PER_UNIT as f32
}

impl Exchange {
    /// Exchanges the paint of one step.
    pub fn run(&mut self, footprint: &Footprint, step: &mut Step<'_>) {
        self.find_texels(footprint, step.load.texels());
        self.demand(footprint, step);
        self.grant(step.load, &step.traits);
        for slot in 0..SLOTS {
            self.deposit(footprint, slot, step.load, step.window);
        }
        self.take_up(footprint, step.load, step.window);
        step.load.count_films_of(&self.texels);
    }

    fn find_texels(&mut self, footprint: &Footprint, texels: usize) {
        for texel in self.texels.drain(..) {
            self.place_of[texel as usize] = NOWHERE;
        }
        self.place_of.resize(texels, NOWHERE);
        self.places.clear();
        for contact in &footprint.contacts {
            let place = &mut self.place_of[contact.texel as usize];
            if *place == NOWHERE {
                *place = self.texels.len() as u32;
                self.texels.push(contact.texel);
            }
            self.places.push(*place);
        }
    }

    fn demand(&mut self, footprint: &Footprint, step: &Step<'_>) {
        for plane in [&mut self.drawn, &mut self.offered] {
            plane.clear();
            plane.resize(self.texels.len(), 0.0);
        }
        self.wants.clear();
        let to_units = 1.0 / QUANTA_PER_UNIT as f32;
        let cells = footprint.contacts.iter().map(|contact| contact.cell);
        step.window.totals(cells, &mut self.lying);
        let contacts = footprint.contacts.iter().zip(&self.places);
        for ((contact, place), lying) in contacts.zip(&self.lying) {
            let place = *place as usize;
            let film =
                step.load.film(contact.texel as usize) as f32 * step.traits.film_units_per_quantum;
            let wants = wanted(contact, film, lying * to_units, &step.traits);
            let room = CELL_MAX as f32 - lying;
            let wants = (wants.clamp(-*lying, room) as i32) as f32;
            if wants > 0.0 {
                self.drawn[place] += wants;
            } else {
                self.offered[place] -= wants;
            }
            self.wants.push(wants);
        }
    }

    fn grant(&mut self, load: &BrushLoad, traits: &BrushTraits) {
        self.granted.clear();
        let most = traits.film_full * BrushTraits::FILM_OVER;
        let share = |wanted: f32, there: f64| {
            let wanted = f64::from(wanted);
            if wanted > there { there / wanted } else { 1.0 }
        };
        let asked = self.drawn.iter().zip(&self.offered);
        for (texel, (drawn, offered)) in self.texels.iter().zip(asked) {
            let film = f64::from(load.film(*texel as usize));
            self.granted
                .push([share(*drawn, film), share(*offered, (most - film).max(0.0))]);
        }
    }

    /// Brush to canvas, one slot.
    fn deposit(
        &mut self,
        footprint: &Footprint,
        slot: usize,
        load: &mut BrushLoad,
        window: &mut Window,
    ) {
        let Some((film, totals)) = load.films_mut(slot) else {
            return;
        };
        self.before.clear();
        let there = self.texels.iter().map(|texel| film[*texel as usize]);
        self.before.extend(there);
        if self.before.iter().all(|count| *count == 0) {
            return;
        }
        let plane = window.plane_mut(slot);
        let contacts = footprint.contacts.iter().zip(&self.wants);
        for ((contact, wants), place) in contacts.zip(&self.places) {
            let (texel, before) = (contact.texel as usize, self.before[*place as usize]);
            if *wants <= 0.0 || before == 0 {
                continue;
            }
            // A share of what was there before the step, whatever other cells have drawn since.
            let granted = self.granted[*place as usize][0];
            let share = f64::from(before) / f64::from(totals[texel]) * granted;
            let moved = ((f64::from(*wants) * share) as u32).min(film[texel]);
            film[texel] -= moved;
            plane[contact.cell as usize] += moved as f32;
        }
    }

    /// Canvas to brush, all slots. Each cell has one contact, so what lies on those that give is what lay
    /// there before.
    fn take_up(&mut self, footprint: &Footprint, load: &mut BrushLoad, window: &mut Window) {
        self.shares.clear();
        let asked = self.wants.iter().zip(&self.places).zip(&self.lying);
        self.shares.extend(asked.map(|((wants, place), lying)| {
            let gives = *wants < 0.0 && *lying > 0.0;
            let granted = self.granted[*place as usize][1];
            match gives {
                true => f64::from(-*wants) * granted / f64::from(*lying),
                false => 0.0,
            }
        }));
        if self.shares.iter().all(|share| *share == 0.0) {
            return;
        }
        for (slot, plane) in window.planes_mut() {
            for (contact, share) in footprint.contacts.iter().zip(&self.shares) {
                let held = &mut plane[contact.cell as usize];
                let moved = (f64::from(*held) * share) as u32;
                if moved > 0 {
                    *held -= moved as f32;
                    load.add_film(slot, contact.texel as usize, moved);
                }
            }
        }
    }
}
