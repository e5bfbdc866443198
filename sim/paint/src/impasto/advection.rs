//! Stage 3: conservative advection (Baxter 2004, § 6.4.1), counted in quanta.
//!
//! The column of paint on a cell shifts by its velocity and is shared out among the cells that it
//! then covers: its own, one beside, one above or below, one across. Each share is truncated to
//! quanta, taken from the donor and given to the receiver, so nothing is lost or created.

use super::footprint::Footprint;
use crate::quantum::CELL_MAX;
use crate::window::Window;

/// What stays on a cell however hard it is brushed, quanta: 3 µm of stain (§ 6.4.1, size).
pub const STAIN: f32 = 2013.0;

/// Room for a step.
#[derive(Clone, Debug, Default)]
pub struct Advection {
    donors: Vec<Donor>,
    sent: Vec<[f32; 3]>,
    inflow: Vec<f32>,
    full: Vec<bool>,
    /// Wet quanta on each contact's cell.
    totals: Vec<f32>,
}

/// A cell that gives paint away.
#[derive(Clone, Copy, Debug)]
struct Donor {
    cell: u32,
    /// The cells beside, above or below, and across.
    to: [u32; 3],
    /// Share of its paint that goes to each.
    share: [f32; 3],
}

impl Advection {
    /// Moves the wet paint of the contacts by their velocities.
    pub fn run(&mut self, footprint: &Footprint, window: &mut Window) {
        self.find_donors(footprint, window);
        if self.donors.is_empty() {
            return;
        }
        // A cell and its eight neighbours with a tenth of the most each always fit.
        if self.most_of_any(window) > 0.1 * CELL_MAX as f32 {
            self.leave_out_what_has_no_room(window);
        }
        for (_, plane) in window.planes_mut() {
            self.sent.clear();
            // All shares are taken before any is given: order does not matter.
            for donor in &self.donors {
                let held = plane[donor.cell as usize];
                let sent = donor.share.map(|share| ((held * share) as i32) as f32);
                plane[donor.cell as usize] = held - (sent[0] + sent[1] + sent[2]);
                self.sent.push(sent);
            }
            for (donor, sent) in self.donors.iter().zip(&self.sent) {
                for (to, quanta) in donor.to.iter().zip(sent) {
                    plane[*to as usize] += quanta;
                }
            }
        }
    }

    fn find_donors(&mut self, footprint: &Footprint, window: &Window) {
        self.donors.clear();
        let width = window.width() as i64;
        let [right, top] = window.limit().map(|limit| limit as i64);
        let cells = footprint.contacts.iter().map(|contact| contact.cell);
        window.totals(cells, &mut self.totals);
        for (contact, total) in footprint.contacts.iter().zip(&self.totals) {
            let [u, v] = contact.velocity;
            if *total <= STAIN || (u == 0.0 && v == 0.0) {
                continue;
            }
            let loose = (total - STAIN) / total;
            let cell = i64::from(contact.cell);
            let (x, y) = (cell % width, cell / width);
            let side = |step: f32, at: i64, last: i64| {
                let to = at + if step < 0.0 { -1 } else { 1 };
                (0..last).contains(&to).then_some(to)
            };
            let (beside, above) = (side(u, x, right), side(v, y, top));
            // At the edge of the surface paint stays.
            let u = if beside.is_some() { u.abs() } else { 0.0 };
            let v = if above.is_some() { v.abs() } else { 0.0 };
            let (bx, ay) = (beside.unwrap_or(x), above.unwrap_or(y));
            self.donors.push(Donor {
                cell: contact.cell,
                to: [y * width + bx, ay * width + x, ay * width + bx].map(|cell| cell as u32),
                share: [u * (1.0 - v), v * (1.0 - u), u * v].map(|share| share * loose),
            });
        }
    }

    /// At least as many quanta as the fullest of the cells that give or receive holds.
    fn most_of_any(&self, window: &Window) -> f32 {
        let most_of = |plane: &[f32]| {
            self.donors.iter().fold(0.0f32, |most, donor| {
                let [beside, above, across] = donor.to.map(|to| plane[to as usize]);
                most.max(plane[donor.cell as usize])
                    .max(beside)
                    .max(above)
                    .max(across)
            })
        };
        window.planes().map(|(_, plane)| most_of(plane)).sum()
    }

    /// A cell holds at most one unit: inflow beyond it stays with its donors. A donor that keeps its
    /// paint may itself have no room, so the full cells are found until there are no more.
    fn leave_out_what_has_no_room(&mut self, window: &Window) {
        let cells = window.width() * window.height();
        self.full.clear();
        self.full.resize(cells, false);
        loop {
            self.inflow.clear();
            self.inflow.resize(cells, 0.0);
            for donor in &self.donors {
                let held = window.total(donor.cell as usize);
                for (to, share) in donor.to.iter().zip(donor.share) {
                    if !self.full[*to as usize] {
                        self.inflow[*to as usize] += held * share;
                        self.inflow[donor.cell as usize] -= ((held * share) as i32 - 16) as f32;
                    }
                }
            }
            let mut more = false;
            for donor in &self.donors {
                for to in donor.to {
                    let to = to as usize;
                    let after = window.total(to) + self.inflow[to].max(0.0);
                    if !self.full[to] && after > CELL_MAX as f32 - 64.0 {
                        self.full[to] = true;
                        more = true;
                    }
                }
            }
            if !more {
                break;
            }
        }
        for donor in &mut self.donors {
            for (to, share) in donor.to.iter().zip(&mut donor.share) {
                if self.full[*to as usize] {
                    *share = 0.0;
                }
            }
        }
    }
}
