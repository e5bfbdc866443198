//! How much paint goes between brush and canvas (Baxter 2004, Algorithm 3), by path length.
//!
//! The constants of the text hold for a step of one cell. Here the transfer is a function of the
//! travel s in reference cells of .25 mm: a share 1 − (1 − .1)^s of the paint, at most .001·s units.
//! No travel, no transfer; this takes the place of the text's speed cut-off, and the result does not
//! depend on how a motion is cut into steps.

use maulstick_num::exp_f32;

/// ln(1 − XFER_FRACTION), XFER_FRACTION = .1.
pub const LN_KEPT: f32 = -0.105_360_516;
/// The most that goes over, units a reference cell: 100 µm. The text's MAX_XFER_QUANTITY of 25 µm keeps oil
/// from filling the tooth.
pub const MAX_TRANSFER: f32 = 0.004;

/// Share of the paint that goes over along a travel in reference cells, where `ln_kept` of one stays.
#[must_use]
#[inline(always)]
pub fn share(travel: f32, ln_kept: f32) -> f32 {
    1.0 - exp_f32(ln_kept * travel)
}

/// Paint that leaves the brush for the canvas (positive) or the canvas for the brush (negative),
/// units, where the brush carries `on_brush` and reaches `on_canvas` units, after `travel`, along
/// which `share` goes over. `on_canvas` is negative by a gap that the brush's film bridges.
///
/// The text's EQUAL_PAINT_CUTOFF is a constant of 833 µm, which makes films of oil (80 to 420 µm) go over
/// by their square. Here it is the donor's amount: the difference evens out, whatever the scale.
#[must_use]
#[inline(always)]
pub fn transfer(on_brush: f32, on_canvas: f32, travel: f32, share: f32) -> f32 {
    let difference = on_brush - on_canvas;
    let donor = if difference > 0.0 {
        on_brush
    } else {
        on_canvas
    };
    let amount = (share * difference.abs().min(donor)).min(MAX_TRANSFER * travel);
    if difference > 0.0 { amount } else { -amount }
}

/// Share of the thinner film that changes places along a reference cell, by that which goes over.
pub const SWAP: f32 = 0.03;
/// How deep the films reach that change places, units: 100 µm.
pub const SWAP_FILM: f32 = 0.004;

/// Paint that goes both ways at once where brush and canvas are wet, units: their films mix as the
/// bristles go through them, but no deeper than a film, however high the paint lies.
#[must_use]
#[inline(always)]
pub fn swap(on_brush: f32, on_canvas: f32, share: f32) -> f32 {
    SWAP * share * on_brush.min(on_canvas).min(SWAP_FILM)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Algorithm 3 as printed, for one cell of travel at full speed, but for its cut-off, which is the donor's
    /// amount, and its most, which is 100 µm.
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
            let got = f64::from(transfer(a_b as f32, a_c as f32, 1.0, share(1.0, LN_KEPT)));
            let want = printed(a_c, a_b);
            prop_assert!((got - want).abs() < 1e-8, "{got} {want}");
        }

        #[test]
        fn nothing_moves_without_travel_and_more_with_more(
            a_b in 0.0..0.1f32, a_c in 0.0..0.1f32, s in 0.0..1.0f32,
        ) {
            let over = |s: f32| transfer(a_b, a_c, s, share(s, LN_KEPT)).abs();
            prop_assert_eq!(over(0.0), 0.0);
            prop_assert_eq!(swap(a_b, a_c, share(0.0, LN_KEPT)), 0.0);
            let (less, more) = (over(s), over(1.0));
            prop_assert!(less <= more + 1e-9);
            prop_assert!(less <= a_b.max(a_c));
        }
    }

    #[test]
    fn a_wrong_share_would_be_found() {
        let faulty = f64::from(transfer(0.009, 0.0, 1.0, share(1.0, LN_KEPT))) * 1.001;
        assert!((faulty - printed(0.0, 0.009)).abs() > 1e-8);
    }
}
