//! Brush modes that do not paint (Baxter 2004, § 6.8): the sampler, and the cleaning key, which lifts paint like a
//! vacuum cleaner while it is held and the brush moves.

use maulstick_canvas::quantum::{Counts, SLOTS, add};

use crate::brush::traits::TEXELS_PER_STRIP;
use crate::footprint::Footprint;
use crate::interface::Step;

/// Lifts the wet paint off the cells that are at least half covered, a part of it off the others, and the load of the
/// brush; returns all that was lifted.
pub fn vacuum(footprint: &Footprint, step: &mut Step<'_>) -> Counts {
    let mut lifted = [0; SLOTS];
    for (slot, plane) in step.window.planes_mut() {
        for contact in &footprint.contacts {
            let count = &mut plane[contact.cell as usize];
            let goes = ((*count * (2.0 * contact.cover).min(1.0)) as i32) as f32;
            *count -= goes;
            lifted[slot] += goes as u64;
        }
    }
    if step.window.has_sheets() {
        for slot in 0..SLOTS {
            if step.window.upper(slot).is_some() {
                let [plane, upper] = step.window.sheets_mut(slot);
                for contact in &footprint.contacts {
                    let cell = contact.cell as usize;
                    upper[cell] = upper[cell].min(plane[cell]);
                }
            }
        }
    }
    if step.load.total() > 0 {
        add(&mut lifted, &step.load.take_all());
    }
    lifted
}

/// Gives each texel that touches wet paint its colours, at the brush's full load; by slot, the paint added to the
/// brush.
pub fn sample(footprint: &Footprint, step: &mut Step<'_>) -> [i64; SLOTS] {
    let mut touched: Vec<(u32, u32)> = footprint
        .contacts
        .iter()
        .filter(|contact| contact.fraction > 0.0)
        .map(|contact| (contact.texel, contact.cell))
        .collect();
    touched.sort_unstable();
    let mut came = [0; SLOTS];
    for cells in touched.chunk_by(|a, b| a.0 == b.0) {
        let texel = cells[0].0 as usize;
        let mut seen = [0.0f64; SLOTS];
        for (slot, plane) in step.window.planes() {
            let counts = cells
                .iter()
                .map(|(_, cell)| f64::from(plane[*cell as usize]));
            seen[slot] = counts.sum();
        }
        let total: f64 = seen.iter().sum();
        if total <= 0.0 {
            continue;
        }
        let capacity = f64::from(step.head.capacity()[texel / TEXELS_PER_STRIP]);
        let full = [step.traits.film_full, step.traits.inside_full].map(|full| full * capacity);
        for (slot, seen) in seen.iter().enumerate() {
            let holds = full.map(|full| (full * seen / total) as u32);
            let before = step.load.set_texel(slot, texel, holds);
            let sum = |[film, inside]: [u32; 2]| i64::from(film) + i64::from(inside);
            came[slot] += sum(holds) - sum(before);
        }
    }
    step.load.count_films();
    came
}
