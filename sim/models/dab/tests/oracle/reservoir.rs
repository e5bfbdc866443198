//! Fig. 4.2: the surface layer is replenished from the reservoir, in deep units of 32.

use maulstick_dab::reservoir::{flows, runs};
use proptest::prelude::*;

/// Quanta of a deep unit of a texel of 3.5 cells.
const DEEP: f64 = 32.0 * 512.0 * 3.5;

fn mean(both: [f64; 2], full: [f64; 2], rate: f64) -> f64 {
    let flow = |i: i32| flows(both, full, DEEP, (rate, (i as f32 + 0.5) / 2048.0));
    (0..2048).map(flow).sum::<f64>() / 2048.0
}

proptest! {
    #[test]
    fn a_part_of_what_is_lacking_comes_on_the_average(
        surface in 0.0..6.0f64, inside in 4.0..9.0f64, rate in 0.01..0.5f64,
    ) {
        let (both, full) = ([surface * DEEP, inside * DEEP], [6.0 * DEEP, 9.0 * DEEP]);
        let expected = rate * (full[0] - both[0]);
        let got = mean(both, full, rate);
        prop_assert!((got - expected).abs() < 2e-3 * DEEP, "{got} {expected}");
        let faulty = mean(both, full, 1.01 * rate);
        prop_assert!((faulty - expected).abs() > 2e-3 * DEEP || expected < 0.3 * DEEP, "a fault passes");
    }

    #[test]
    fn whole_units_go_as_far_as_there_are_any(
        surface in 0.0..20.0f64, inside in 0.0..9.0f64, rate in 0.0..1.0f64, threshold in 0.0..1.0f32,
    ) {
        let both = [surface * DEEP, inside * DEEP];
        let flow = flows(both, [6.0 * DEEP, 9.0 * DEEP], DEEP, (rate, threshold));
        prop_assert!(flow <= both[1] && -flow <= both[0]);
        prop_assert!(both[1] - flow <= (9.0 * DEEP).max(both[1]) + 1e-6);
        let whole = (flow / DEEP).fract().abs();
        let all = flow == both[1] || -flow == both[0] || (both[1] - flow - 9.0 * DEEP).abs() < 1e-6;
        prop_assert!(!(1e-9..=1.0 - 1e-9).contains(&whole) || all, "{flow}");
    }
}

/// Half of the difference between successive texels evens out at the full rate.
#[test]
fn paint_runs_down_a_bristle_and_never_up() {
    let mean = |both: [f64; 2]| -> f64 {
        let flow = |i: i32| runs(both, DEEP, (0.2, (i as f32 + 0.5) / 512.0));
        (0..512).map(flow).sum::<f64>() / 512.0
    };
    assert!((mean([9.0 * DEEP, 2.0 * DEEP]) - 0.7 * DEEP).abs() < 0.01 * DEEP);
    assert_eq!(mean([2.0 * DEEP, 9.0 * DEEP]), 0.0, "a fault would pass");
}

#[test]
fn an_empty_reservoir_gives_nothing_and_a_full_brush_wants_nothing() {
    assert_eq!(
        flows([0.0, 0.0], [6.0 * DEEP, DEEP], DEEP, (1.0, 0.99)),
        0.0
    );
    assert_eq!(
        flows([6.0 * DEEP, DEEP], [6.0 * DEEP, DEEP], DEEP, (1.0, 0.99)),
        0.0
    );
}
