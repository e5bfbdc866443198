//! Amount of paint transferred between brush and canvas (Baxter 2004, Algorithm 3), by path length.
//!
//! The constants of the text hold for a step of one cell. Here the transfer is a function of the travel s in reference
//! cells of .25 mm: a share 1 − (1 − .1)^s of the paint, at most .001·s units. No travel, no transfer; this replaces
//! the text's speed cut-off, and the result is independent of the subdivision of a motion.

use maulstick_num::exp_f32;

/// ln(1 − XFER_FRACTION), XFER_FRACTION = .1.
pub(crate) const LN_KEPT: f32 = -0.105_360_516;
/// The most that goes over, units a reference cell: 100 µm. The text's MAX_XFER_QUANTITY of 25 µm keeps oil
/// from filling the tooth.
pub(crate) const MAX_TRANSFER: f32 = 0.004;

/// Parameters of the transfer between a head and the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exchanging {
    /// ln of the share that stays where it is along a reference cell.
    pub ln_kept: f32,
    /// 1 where the two sides even out; 0 where all paint within reach is taken up and only gaps are filled.
    pub evens: f32,
    /// The most that goes over along a reference cell, units.
    pub most: f32,
    /// Share of a skin ([`SKIN`]) that changes places along a reference cell without a gap, where both sides are wet.
    pub swap: f32,
    /// Share of the shear that a light touch lacks, 0 to 1.
    pub glides: f32,
    /// Share of the wet paint within reach that it shears, and so evens out with: less under a light touch, 0 to 1.
    pub shears: f32,
    /// Part of its film that does not hang below it while it hardly presses, 0 to 1.
    pub holds: f32,
}

/// Press from which bristles shear paint as deep as they reach.
const SHEARS_AT: f32 = 0.45;

impl Exchanging {
    /// Bristles, which paint wets: their paint and the paint within reach even out.
    pub const BRISTLES: Self = Self {
        ln_kept: LN_KEPT,
        evens: 1.0,
        most: MAX_TRANSFER,
        swap: 1.0,
        glides: 1.0,
        shears: 1.0,
        holds: 0.6,
    };
    /// Soft hair that comes to a point: its paint hangs in a drop.
    pub(crate) const SOFT: Self = Self {
        holds: 0.0,
        ..Self::BRISTLES
    };
    /// Soft hair that flares: it hardly takes paint up, and blends the paint that it moves through.
    pub(crate) const BLENDER: Self = Self {
        swap: 0.05,
        most: 0.00027,
        glides: 0.0,
        shears: 1.0,
        holds: 0.0,
        ..Self::BRISTLES
    };
    /// A blade: it scrapes off paint above its edge, and fills hollows below it; ln(1 − .6).
    pub const BLADE: Self = Self {
        ln_kept: -0.916_290_7,
        evens: 0.0,
        most: 1.0,
        swap: 0.01,
        glides: 0.0,
        shears: 1.0,
        holds: 0.0,
    };

    /// Share of their full shear that bristles have under a press of 0 to 1: a loaded brush glides on wet paint that it
    /// hardly presses, and leaves it as it lies.
    #[must_use]
    pub fn shear(&self, press: f32) -> f32 {
        let share = (press / SHEARS_AT).clamp(0.0, 1.0);
        1.0 - self.glides * (1.0 - share * share)
    }

    /// The exchange under a press of 0 to 1.
    #[must_use]
    pub fn pressed(self, press: f32) -> Self {
        let shears = self.shear(press);
        let swap = self.swap * shears;
        Self {
            swap,
            shears,
            ..self
        }
    }

    /// The exchange's numbers for a graphics device: ln of the share kept, whether the two sides even out, the most, the
    /// share of a skin.
    #[must_use]
    pub fn numbers(&self) -> [f32; 4] {
        [self.ln_kept, self.evens, self.most, self.swap]
    }

    /// Share of the paint that goes over along a travel in reference cells.
    #[must_use]
    #[inline(always)]
    pub fn share(&self, travel: f32) -> f32 {
        1.0 - exp_f32(self.ln_kept * travel)
    }

    /// Paint transferred from the brush to the canvas (positive) or back (negative), units, where the brush carries
    /// `on_brush`, reaches `on_canvas` units of the `lying` paint and is `gap` units above it, after `travel`, along
    /// which `share` goes over.
    ///
    /// The text's EQUAL_PAINT_CUTOFF is a constant of 833 µm, which makes films of oil (80 to 420 µm) go over by their
    /// square. Here it is the donor's amount: the difference evens out, whatever the scale. A gap fills faster with the
    /// excess beyond it, because the film is pressed into it; but a film that bridges the gap under a bristle splits as
    /// the bristle lifts off, which keeps [`SPLITS`] of it.
    #[must_use]
    #[inline(always)]
    pub fn transfer(
        &self,
        [on_brush, on_canvas, lying, gap]: [f32; 4],
        travel: f32,
        share: f32,
    ) -> f32 {
        let free = (on_brush - gap).max(0.0);
        let splits = (on_brush - self.evens * SPLITS * (on_brush + lying)).max(0.0);
        let fill = filled(share) * gap.min(free).min(splits);
        let difference = self.evens * free - on_canvas;
        let donor = if difference > 0.0 {
            on_brush - fill
        } else {
            on_canvas
        };
        let amount = (share * difference.abs())
            .min(self.most * travel)
            .min(donor);
        fill + if difference > 0.0 { amount } else { -amount }
    }

    /// Paint swapped along a travel in reference cells, units: where the films touch across the gap, bristle and paint
    /// shear a skin of at most [`SKIN`] between them, however deep either is; the wider the gap, the less. `on_brush`,
    /// `lying` and `gap` are in units.
    #[must_use]
    #[inline(always)]
    pub fn swapped(&self, [on_brush, lying, gap]: [f32; 3], travel: f32) -> f32 {
        let skin = (on_brush - gap).max(0.0).min(lying).min(SKIN);
        (self.swap * travel * (NEAR / (NEAR + gap))).min(1.0) * skin
    }
}

/// Share of a gap that fills where `share` of a difference evens out: 1 − (1 − share)¹⁶.
#[inline(always)]
fn filled(share: f32) -> f32 {
    let kept = (1.0 - share) * (1.0 - share);
    let kept = kept * kept;
    let kept = kept * kept;
    1.0 - kept * kept
}

/// Share of a film bridging a gap that stays on the bristle as it splits.
pub const SPLITS: f32 = 0.3;

/// Thickness of the skin of a bristle that is exchanged with the paint under it, units: 90 µm.
pub const SKIN: f32 = 0.0036;
/// Gap at which half as much is sheared as where bristle and surface touch, units: 15 µm.
pub const NEAR: f32 = 0.0006;

/// Additional deposit of a film-limited brush in the hollows under its bristles, in multiples of its film: thin paint
/// is dragged off the ridges and gathers there.
pub const POOL: f32 = 1.0;

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Algorithm 3 as printed, for one cell of travel at full speed, except its cut-off, which is the donor's amount,
    /// and its maximum, which is 100 µm.
    fn printed(a_c: f64, a_b: f64) -> f64 {
        let difference = a_b - a_c;
        let donor = if difference > 0.0 { a_b } else { a_c };
        let cutoff = (difference.abs() / donor.max(1e-30)).clamp(0.0, 1.0);
        let amount = (donor * 0.1 * cutoff).clamp(0.0, 0.004);
        if difference > 0.0 { amount } else { -amount }
    }

    proptest! {
        #[test]
        fn over_one_cell_it_is_the_printed_algorithm(a_c in 0.0..0.2f64, a_b in 0.0..0.2f64) {
            let share = Exchanging::BRISTLES.share(1.0);
            let got = Exchanging::BRISTLES.transfer([a_b as f32, a_c as f32, a_c as f32, 0.0], 1.0, share);
            let got = f64::from(got);
            let want = printed(a_c, a_b);
            prop_assert!((got - want).abs() < 1e-8, "{got} {want}");
        }

        #[test]
        fn nothing_moves_without_travel_and_more_with_more(
            a_b in 0.0..0.1f32, a_c in 0.0..0.1f32, s in 0.0..1.0f32,
        ) {
            let rule = Exchanging::BRISTLES;
            let over = |s: f32| rule.transfer([a_b, a_c, a_c, 0.0], s, rule.share(s)).abs();
            prop_assert_eq!(over(0.0), 0.0);
            prop_assert_eq!(rule.swapped([a_b, a_c, 0.0], 0.0), 0.0);
            let (less, more) = (over(s), over(1.0));
            prop_assert!(less <= more + 1e-9);
            prop_assert!(less <= a_b.max(a_c));
        }
    }

    #[test]
    fn a_wrong_share_would_be_found() {
        let rule = Exchanging::BRISTLES;
        let faulty = f64::from(rule.transfer([0.009, 0.0, 0.0, 0.0], 1.0, rule.share(1.0))) * 1.001;
        assert!((faulty - printed(0.0, 0.009)).abs() > 1e-8);
    }
}
