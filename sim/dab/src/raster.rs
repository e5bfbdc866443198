//! The brush as a raster of the canvas's cells (Baxter 2004, § 4.5.1, 4.5.3): the film of each texel is parted among the
//! cells that it touches, blended there as if the raster were the brush, and goes back to its texel.

use maulstick_canvas::quantum::{QUANTA_PER_UNIT, SLOTS};
use maulstick_canvas::window::Area;
use maulstick_model::brush::load::BrushLoad;
use maulstick_model::footprint::Footprint;
use maulstick_model::interface::Step;

use crate::dither::Dither;
use crate::transfer::{Limits, Paints, Row, blend};

/// The place of a texel that does not touch.
const ABSENT: u32 = u32::MAX;

/// Share of a gap between brush and canvas up to which the brush's paint only bridges it: what lies on ridges sags into
/// the hollows between them.
const BRIDGED: f32 = 0.4;

/// How far a blend goes.
#[derive(Clone, Copy, Debug)]
pub enum Way {
    /// As far as each strip moves in the step.
    OfStrips,
    /// So many cells.
    Cells(f32),
}

/// A touching texel while its film is on the raster.
#[derive(Clone, Copy, Debug)]
struct Lender {
    texel: u32,
    /// Cells that it touches.
    cells: u32,
}

/// The brush over the cells around a footprint.
#[derive(Debug, Default)]
pub struct Raster {
    /// The cells of the window.
    area: Area,
    rate: Vec<f32>,
    way: Vec<f32>,
    reach: Vec<f32>,
    gap: Vec<f32>,
    /// The brush's paint by slot, quanta a cell.
    film: Vec<(usize, Vec<f32>)>,
    lenders: Vec<Lender>,
    /// The place of each texel among the lenders.
    place_of: Vec<u32>,
    /// Of one paint: quanta that each lender's cells have.
    lent: Vec<u32>,
    /// Of one paint: quanta that come back to each lender.
    back: Vec<i64>,
}

impl Raster {
    /// The texels that touch.
    pub fn texels(&self) -> impl Iterator<Item = u32> + '_ {
        self.lenders.iter().map(|lender| lender.texel)
    }

    /// Parts the films of the touching texels among their cells; they stay in the load until they come
    /// [back](Self::give_back).
    pub fn lend(&mut self, footprint: &Footprint, step: &Step<'_>, way: Way) {
        self.area = footprint.around;
        self.meet(footprint, step, way);
        self.find_lenders(footprint, step.load.texels());
        let texel_cells = texel_cells(step);
        let mut planes = std::mem::take(&mut self.film);
        planes.truncate(SLOTS);
        let slots = (0..SLOTS).filter(|slot| step.load.has(*slot) || step.window.has(*slot));
        let mut used = 0;
        for slot in slots {
            if planes.len() == used {
                planes.push((slot, Vec::new()));
            }
            let (own, plane) = &mut planes[used];
            *own = slot;
            plane.clear();
            plane.resize(self.area.cells(), 0.0);
            used += 1;
            let Some(film) = step.load.film_of(slot) else {
                continue;
            };
            self.lent.clear();
            self.lent.extend(self.lenders.iter().map(|lender| {
                let held = f64::from(film[lender.texel as usize]);
                (held / texel_cells.max(f64::from(lender.cells))) as u32
            }));
            for contact in &footprint.contacts {
                let place = self.place_of[contact.texel as usize];
                plane[contact.local as usize] = self.lent[place as usize] as f32;
            }
        }
        planes.truncate(used);
        self.film = planes;
    }

    /// Where, how far and how deep brush and canvas meet.
    fn meet(&mut self, footprint: &Footprint, step: &Step<'_>, way: Way) {
        let cells = self.area.cells();
        let traits = &step.traits;
        let planes = [
            &mut self.rate,
            &mut self.way,
            &mut self.reach,
            &mut self.gap,
        ];
        for plane in planes {
            plane.clear();
            plane.resize(cells, 0.0);
        }
        let even = match way {
            Way::OfStrips => None,
            Way::Cells(cells) => {
                let travel = cells * traits.cell_per_reference;
                Some((travel, traits.exchanging.share(travel)))
            }
        };
        let quanta_per_cell = 1.0 / traits.cells_per_quantum;
        for contact in &footprint.contacts {
            let place = contact.local as usize;
            let (travel, share) = even.unwrap_or_else(|| {
                let travel = contact.travel(traits);
                (travel, traits.exchanging.share(travel))
            });
            self.rate[place] = share * contact.cover;
            self.way[place] = travel * contact.cover;
            self.reach[place] = match way {
                Way::OfStrips => contact.fraction,
                Way::Cells(_) => 1.0,
            };
            self.gap[place] = BRIDGED * contact.gap * quanta_per_cell;
        }
    }

    fn find_lenders(&mut self, footprint: &Footprint, texels: usize) {
        for lender in self.lenders.drain(..) {
            if let Some(place) = self.place_of.get_mut(lender.texel as usize) {
                *place = ABSENT;
            }
        }
        self.place_of.resize(texels, ABSENT);
        for contact in &footprint.contacts {
            let place = &mut self.place_of[contact.texel as usize];
            if *place == ABSENT {
                *place = self.lenders.len() as u32;
                self.lenders.push(Lender {
                    texel: contact.texel,
                    cells: 0,
                });
            }
            self.lenders[*place as usize].cells += 1;
        }
    }

    /// Blends brush and canvas with the raster moved by whole cells.
    pub fn blend(&mut self, step: &mut Step<'_>, shift: [i64; 2], dither: Dither) {
        let limits = Limits::of(step);
        let within = step.window.area(step.bounds.0, step.bounds.1);
        let (window, area) = (&mut *step.window, self.area);
        let (width, origin) = (window.width(), window.origin());
        // The part of the raster that the step may reach there.
        let span = |i: usize| {
            let from = area.from[i] as i64 + shift[i];
            let (low, high) = (within.from[i], within.from[i] + within.size[i]);
            let first = (low as i64 - from).clamp(0, area.size[i] as i64);
            let last = (high as i64 - from).clamp(first, area.size[i] as i64);
            (first as usize..last as usize, from)
        };
        let ((columns, left), (rows, bottom)) = (span(0), span(1));
        if columns.is_empty() {
            return;
        }
        for (slot, _) in &self.film {
            window.plane_mut(*slot);
        }
        let slots = self.film.iter().map(|(slot, _)| *slot);
        let mut slots = slots.peekable();
        let planes = window.planes_mut();
        let planes = planes.filter(|(slot, _)| slots.next_if_eq(slot).is_some());
        let mut canvas: Vec<&mut Vec<f32>> = planes.map(|(_, plane)| plane).collect();
        for row in rows {
            let first = row * area.size[0];
            let own = first + columns.start..first + columns.end;
            let (x, y) = (left + columns.start as i64, bottom + row as i64);
            let meetings = Row {
                rate: &self.rate[own.clone()],
                way: &self.way[own.clone()],
                reach: &self.reach[own.clone()],
                gap: &self.gap[own.clone()],
            };
            let mut paints = Paints {
                brush: &mut self.film,
                canvas: &mut canvas,
                starts: [own.start, y as usize * width + x as usize],
            };
            let threshold = dither.at([origin[0] + x, origin[1] + y]);
            blend(&meetings, &limits, threshold, &mut paints);
        }
    }

    /// Gives each texel what its cells hold now. By slot, what the brush has more than before.
    pub fn give_back(&mut self, footprint: &Footprint, step: &mut Step<'_>) -> [i64; SLOTS] {
        let mut gained = [0; SLOTS];
        let texel_cells = texel_cells(step);
        for (slot, plane) in &self.film {
            self.back.clear();
            self.back.resize(self.lenders.len(), 0);
            for contact in &footprint.contacts {
                let place = self.place_of[contact.texel as usize];
                self.back[place as usize] += plane[contact.local as usize] as i64;
            }
            let held = |load: &BrushLoad, texel: u32| {
                let film = load.film_of(*slot);
                f64::from(film.map_or(0, |film| film[texel as usize]))
            };
            for (lender, back) in self.lenders.iter().zip(&self.back) {
                let share =
                    held(step.load, lender.texel) / texel_cells.max(f64::from(lender.cells));
                let change = back - i64::from(share as u32) * i64::from(lender.cells);
                if change != 0 {
                    step.load
                        .change_film(*slot, lender.texel as usize, change as i32);
                    gained[*slot] += change;
                }
            }
        }
        gained
    }
}

/// Cells that a texel's film is as large as.
fn texel_cells(step: &Step<'_>) -> f64 {
    1.0 / (QUANTA_PER_UNIT * f64::from(step.traits.film_units_per_quantum))
}
