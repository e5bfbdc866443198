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

/// Transfer rate and path in a row.
const RATE: f32 = 0.19;
const WAY: f32 = 2.0;
/// Threshold of the row's first cell.
const THRESHOLD: f32 = 0.4;

/// Counts of two paints by cell.
type TwoPaints = [Vec<f32>; 2];

fn sum(planes: &TwoPaints) -> Vec<f32> {
    let pairs = planes[0].iter().zip(&planes[1]);
    pairs.map(|(a, b)| a + b).collect()
}

/// Brush and canvas after a transfer along a row.
fn blended(brush: &TwoPaints, canvas: &TwoPaints) -> [TwoPaints; 2] {
    let [mut brush, mut canvas] = [brush.clone(), canvas.clone()];
    let even = |value: f32| vec![value; brush[0].len()];
    let planes = [even(RATE), even(WAY), even(1.0), even(0.0)];
    let row = Row {
        rate: &planes[0],
        way: &planes[1],
        reach: &planes[2],
        gap: &planes[3],
    };
    let mut paints = Paints {
        brush: &mut brush.each_mut().map(|plane| &mut plane[..]),
        canvas: &mut canvas.each_mut().map(|plane| &mut plane[..]),
        starts: [0; 2],
    };
    blend(&row, &FREE, THRESHOLD, &mut paints);
    [brush, canvas]
}

/// Quanta that leave brush and canvas on a cell of the row.
fn leaving_on(i: usize, brush: f32, canvas: f32) -> [f64; 2] {
    let meeting = Meeting {
        brush,
        canvas,
        rate: RATE,
        way: WAY,
        reach: 1.0,
        gap: 0.0,
    };
    let threshold = (THRESHOLD + i as f32 * 0.754_877_7).fract();
    leaving(&meeting, &FREE, threshold).map(f64::from)
}

/// A row of two paints: one side gains what the other loses, in the proportions of the donor.
#[test]
fn paints_go_over_alike_and_none_is_lost() {
    let cells = 500;
    let number = |i: usize, factor: usize| (i * factor % 997) as f32 * 300.0;
    let plane = |factor: usize| (0..cells).map(|i| number(i, factor)).collect::<Vec<f32>>();
    let before = [[plane(7), plane(13)], [plane(3), plane(29)]];
    let [brush_before, canvas_before] = &before;
    let [brush, canvas] = blended(brush_before, canvas_before);
    let [brush_total, canvas_total] = before.each_ref().map(sum);
    let total_after = sum(&canvas);
    let mut mixed = 0;
    for i in 0..cells {
        for slot in 0..2 {
            let gained = canvas[slot][i] - canvas_before[slot][i];
            assert_eq!(gained, brush_before[slot][i] - brush[slot][i], "cell {i}");
        }
        // C_new = (V_r·C_i + V'_l·C'_i)/(V_r + V'_l): the shares of a paint afterwards.
        let [given, taken] = leaving_on(i, brush_total[i], canvas_total[i]);
        let [b, c, after] = [brush_total[i], canvas_total[i], total_after[i]].map(f64::from);
        if b <= 0.0 || c <= 0.0 || after <= 10_000.0 {
            continue;
        }
        let own = f64::from(canvas_before[0][i]) / c;
        let other = f64::from(brush_before[0][i]) / b;
        let expected = ((c - taken) * own + given * other) / (c - taken + given);
        let got = f64::from(canvas[0][i]) / after;
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
    assert!(mixed > 450, "{mixed}");
}
