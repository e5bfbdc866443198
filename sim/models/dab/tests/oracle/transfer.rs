//! § 4.5.2: V_l = V_i·(1 − (1 − R)^T), at most V_i, of either side, and colours by volumes.

use maulstick_dab::transfer::{Limits, Meeting, Paints, Row, blend, leaving};
use proptest::prelude::*;
use rand_pcg::Pcg32;

/// Quanta of a unit, and units of a full layer, as documented.
const UNIT: f64 = 512.0;
const FULL: f64 = 255.0;

const FREE: Limits = Limits {
    most: 255.0 * 512.0,
    stain: 0.0,
    exchanges: 1.0,
    flow: 0.0,
    lasting: false,
};

/// Unrounded quanta that leave either side for a transfer rate R along a reference cell.
fn powers([brush, canvas]: [f64; 2], r: f64, t: f64) -> [f64; 2] {
    let kept = maulstick_num::powf(1.0 - r, t);
    [brush, canvas].map(|quanta| quanta.min(FULL * UNIT) * (1.0 - kept))
}

/// The printed V_l = V_i + T·R, in units.
fn printed([brush, canvas]: [f64; 2], r: f64, t: f64) -> [f64; 2] {
    [brush, canvas].map(|quanta| quanta + t * r * UNIT)
}

/// Mean of what leaves over thresholds that fill 0 to 1.
fn mean(meeting: &Meeting, limits: &Limits) -> [f64; 2] {
    let mut sum = [0.0; 2];
    for i in 0..4096 {
        let threshold = (i as f32 + 0.5) / 4096.0;
        let goes = leaving(meeting, limits, threshold);
        sum = [0, 1].map(|side| sum[side] + f64::from(goes[side]) / 4096.0);
    }
    sum
}

fn meeting([brush, canvas]: [f64; 2], r: f64, t: f64) -> Meeting {
    Meeting {
        brush: brush as f32,
        canvas: canvas as f32,
        rate: (1.0 - maulstick_num::powf(1.0 - r, t)) as f32,
        way: t as f32,
        reach: 1.0,
        gap: 0.0,
    }
}

proptest! {
    #[test]
    fn what_leaves_is_the_power_on_the_average_and_whole_units_each_time(
        brush in 2.0..250.0f64, canvas in 2.0..250.0f64, r in 0.02..0.6f64, t in 0.1..2.0f64,
    ) {
        let both = [brush * UNIT, canvas * UNIT].map(f64::floor);
        let meeting = meeting(both, r, t);
        let expected = powers(both, r, t);
        // Near a full layer one side waits for the other, and no more than the rest of the last unit goes over.
        let left = |side: usize| both[side] - expected[side];
        prop_assume!(brush + canvas < FULL && left(0) > UNIT && left(1) > UNIT);
        let got = mean(&meeting, &FREE);
        for side in 0..2 {
            prop_assert!((got[side] - expected[side]).abs() < 0.01 * UNIT, "{got:?} {expected:?}");
            let once = f64::from(leaving(&meeting, &FREE, 0.3)[side]);
            prop_assert!(once == both[side] || once % UNIT == 0.0);
            prop_assert!(once <= both[side]);
        }
        let wrong = printed(both, r, t);
        prop_assert!(wrong.iter().zip(both).all(|(wrong, both)| *wrong > both), "it creates paint");
    }

    /// Two halves of a path give the result of the whole.
    #[test]
    fn the_way_may_be_cut(volume in 1.0..200.0f64, r in 0.05..0.5f64, t in 0.2..2.0f64) {
        let [whole, _] = powers([volume * UNIT, 0.0], r, t);
        let [half, _] = powers([volume * UNIT, 0.0], r, 0.5 * t);
        let [rest, _] = powers([volume * UNIT - half, 0.0], r, 0.5 * t);
        prop_assert!((half + rest - whole).abs() < 1e-6);
        let mean = mean(&meeting([volume * UNIT, 0.0], r, t), &FREE)[0];
        prop_assert!((mean - whole).abs() < 0.01 * UNIT + 1.0);
    }

    /// Saturation: neither side exceeds its capacity, and no volume wraps.
    #[test]
    fn full_layers_take_no_more(
        brush in 0.0..1000.0f64, canvas in 0.0..1000.0f64, rate in 0.0..1.0f32, threshold in 0.0..1.0f32,
        most in 0.0..255.0f32, stain in 0.0..20.0f32,
    ) {
        let both = [brush * UNIT, canvas * UNIT].map(f64::floor);
        let limits = Limits { most: (most * 512.0).floor(), stain: (stain * 512.0).floor(), ..FREE };
        let meeting = Meeting { rate, ..meeting(both, 0.1, 1.0) };
        let [given, taken] = leaving(&meeting, &limits, threshold);
        let (brush, canvas) = (both[0] as f32, both[1] as f32);
        prop_assert!((0.0..=brush).contains(&given) && (0.0..=canvas).contains(&taken));
        prop_assert!(canvas + given - taken <= canvas.max(limits.most));
        prop_assert!(canvas - taken >= canvas.min(limits.stain));
    }
}

/// Fault of an oracle of saturation.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    None,
    /// The brush exceeds its capacity.
    FullBrush,
    /// The canvas exceeds its capacity.
    FullCanvas,
    /// A volume beyond 255 units wraps to 0.
    Wraps,
    /// The stain goes over with the rest.
    Stain,
}

/// Transferred quanta in f64: whole units, as far as there are any and room for them.
fn goes(
    [brush, canvas]: [f64; 2],
    rate: f64,
    limits: [f64; 2],
    threshold: f64,
    fault: Fault,
) -> [f64; 2] {
    let [most, stain] = limits;
    let full = FULL * UNIT;
    let layer = |quanta: f64| match fault {
        Fault::Wraps => quanta % (full + UNIT),
        _ => quanta.min(full),
    };
    let stays = if fault == Fault::Stain { 0.0 } else { stain };
    let loose = (canvas - stays).max(0.0);
    let opposite = (threshold + 0.5).fract();
    let units = |quanta: f64, threshold: f64| (quanta * rate / UNIT + threshold).floor() * UNIT;
    let given = units(layer(brush), threshold).min(layer(brush));
    let taken = units(layer(canvas).min(loose), opposite).min(loose);
    let taken = match fault {
        Fault::FullBrush => taken,
        _ => taken.min((full - brush).max(0.0) + given),
    };
    let given = match fault {
        Fault::FullCanvas => given,
        _ => given.min((most - canvas).max(0.0) + taken),
    };
    [given, taken]
}

#[test]
fn saturation_is_that_of_the_oracle_and_each_fault_is_found() {
    let mut random = Pcg32::new(7, 1);
    let mut unit = || f64::from(random.next_u32()) / 4_294_967_296.0;
    let cases: Vec<_> = (0..4000)
        .map(|_| {
            let both = [unit(), unit()].map(|share| (share * 400.0 * UNIT).floor());
            let limits = [255.0 * unit(), 40.0 * unit()].map(|units| (units * UNIT).floor());
            (both, unit(), limits, unit())
        })
        .collect();
    let off = |fault: Fault| {
        let wrong = cases.iter().filter(|(both, rate, limits, threshold)| {
            let [most, stain] = limits.map(|quanta| quanta as f32);
            let limits_of = Limits {
                most,
                stain,
                ..FREE
            };
            let meeting = Meeting {
                rate: *rate as f32,
                ..meeting(*both, 0.1, 1.0)
            };
            let got = leaving(&meeting, &limits_of, *threshold as f32).map(f64::from);
            let expected = goes(*both, *rate, *limits, f64::from(*threshold as f32), fault);
            got != expected
        });
        wrong.count()
    };
    // A volume and its threshold that make a whole unit but for rounding.
    let rounded = off(Fault::None);
    assert!(rounded < 20, "{rounded}");
    for fault in [
        Fault::FullBrush,
        Fault::FullCanvas,
        Fault::Wraps,
        Fault::Stain,
    ] {
        let found = off(fault);
        println!("{fault:?} {found}");
        assert!(found > 80, "{fault:?}: {found}");
    }
}

/// A row of two paints: one side gains what the other loses, in the proportions of the donor.
#[test]
fn paints_go_over_alike_and_none_is_lost() {
    let cells = 500;
    let number = |i: usize, factor: usize| (i * factor % 997) as f32 * 300.0;
    let plane = |factor: usize| (0..cells).map(|i| number(i, factor)).collect::<Vec<f32>>();
    let mut held = [plane(7), plane(13)];
    let mut canvas = [plane(3), plane(29)];
    let sum = |planes: &[Vec<f32>; 2]| -> Vec<f32> {
        planes[0]
            .iter()
            .zip(&planes[1])
            .map(|(a, b)| a + b)
            .collect()
    };
    let before = (held.clone(), canvas.clone());
    let totals = (sum(&before.0), sum(&before.1));
    let even = |value: f32| vec![value; cells];
    let planes = [even(0.19), even(2.0), even(1.0), even(0.0)];
    let row = Row {
        rate: &planes[0],
        way: &planes[1],
        reach: &planes[2],
        gap: &planes[3],
    };
    let mut paints = Paints {
        brush: &mut held.each_mut().map(|plane| &mut plane[..]),
        canvas: &mut canvas.each_mut().map(|plane| &mut plane[..]),
        starts: [0; 2],
    };
    blend(&row, &FREE, 0.4, &mut paints);
    let brush = held;
    let mut mixed = 0;
    for i in 0..cells {
        for slot in 0..2 {
            let gained = canvas[slot][i] - before.1[slot][i];
            assert_eq!(gained, before.0[slot][i] - brush[slot][i], "cell {i}");
        }
        // C_new = (V_r·C_i + V'_l·C'_i)/(V_r + V'_l): the shares of a paint afterwards.
        let [given, taken] = leaving(
            &Meeting {
                brush: totals.0[i],
                canvas: totals.1[i],
                rate: 0.19,
                way: 2.0,
                reach: 1.0,
                gap: 0.0,
            },
            &FREE,
            (0.4 + i as f32 * 0.754_877_7).fract(),
        )
        .map(f64::from);
        let (b, c) = (f64::from(totals.0[i]), f64::from(totals.1[i]));
        let after = sum(&canvas)[i];
        if b > 0.0 && c > 0.0 && after > 10_000.0 {
            let (own, other) = (f64::from(before.1[0][i]) / c, f64::from(before.0[0][i]) / b);
            let expected = ((c - taken) * own + given * other) / (c - taken + given);
            let got = f64::from(canvas[0][i]) / f64::from(after);
            // A threshold near 1 may round either way.
            if (got - expected).abs() < 1e-3 {
                mixed += 1;
            }
            let swapped = ((c - taken) * other + given * own) / (c - taken + given);
            assert!(
                (got - swapped).abs() > 1e-4 || (own - other).abs() < 0.05,
                "a fault passes"
            );
        }
    }
    assert!(mixed > 450, "{mixed}");
}
