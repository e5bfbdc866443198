//! Thinner that a brush soaks up in a jar.

use maulstick_canvas::quantum::{Counts, SLOTS};

use super::BrushLoad;

impl BrushLoad {
    /// Replaces paint by thinner: moves the thinner's share of the load a `part` of the distance to
    /// `share`. Returns the removed paint, by slot.
    pub fn soak(&mut self, thinner: usize, share: f64, part: f64) -> Counts {
        let held = self.share(thinner);
        let washed = ((share - held) * part / (1.0 - held)).clamp(0.0, 1.0);
        let mut gone = [0; SLOTS];
        if held >= 1.0 || washed <= 0.0 {
            return gone;
        }
        let mut places = [vec![0u32; self.texels], vec![0u32; self.texels]];
        let paints = self.held.iter_mut().enumerate();
        for (slot, paint) in paints.filter(|(slot, _)| *slot != thinner) {
            let Some(paint) = paint else { continue };
            for (counts, places) in [&mut paint.film, &mut paint.inside]
                .into_iter()
                .zip(&mut places)
            {
                for (count, place) in counts.iter_mut().zip(places) {
                    let goes = (f64::from(*count) * washed) as u32;
                    (*count, *place) = (*count - goes, *place + goes);
                    gone[slot] += u64::from(goes);
                }
            }
        }
        let own = self.held_mut(thinner);
        for (counts, places) in [&mut own.film, &mut own.inside].into_iter().zip(&places) {
            counts
                .iter_mut()
                .zip(places)
                .for_each(|(count, place)| *count += place);
        }
        gone
    }
}
