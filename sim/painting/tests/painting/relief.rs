//! Relief below a brush, as the hand feels it.

use maulstick_brush::BrushFile;
use maulstick_models::{MODELS, ModelEntry};
use maulstick_painting::edits::Dry;
use maulstick_painting::{Painting, PaintingSetup};
use maulstick_types::brush::{BrushRelief, Solve};
use maulstick_types::haptics::heights_um;
use maulstick_types::scene::CANVAS;

use crate::studio::{BRUSH, fill, painting, solve};

const WHITE: &str = "Titanium White";
/// The canvas, mm.
const WIDE_MM: f64 = 64.0;

fn file() -> BrushFile {
    BrushFile::library("round").expect("round")
}

fn bare() -> Painting {
    bare_of(&MODELS[0])
}

fn bare_of(model: &ModelEntry) -> Painting {
    let mut painting = painting(&PaintingSetup {
        cells: [256, 256],
        tooth: "panel".into(),
        model: model.name.to_owned(),
        ..PaintingSetup::default()
    });
    painting.define_brush(BRUSH, file());
    painting
}

/// The brush upright, its tip over a place, mm.
fn over(at: [f64; 2]) -> Solve {
    solve(&file(), 1, at, 0.0, [0.0, 0.0])
}

fn relief(painting: &Painting, at: [f64; 2]) -> BrushRelief {
    painting.relief_below(BRUSH, &over(at)).expect("near")
}

fn mean_um(relief: &BrushRelief) -> f64 {
    let heights: Vec<i16> = heights_um(&relief.heights_um).collect();
    heights.iter().map(|um| f64::from(*um)).sum::<f64>() / heights.len() as f64
}

#[test]
fn dry_paint_is_felt_as_high_as_it_is_and_wet_paint_by_a_share_of_its_yield_stress() {
    let middle = [0.5 * WIDE_MM; 2];
    let ground = mean_um(&relief(&bare(), middle));
    // The tooth of a panel is 10 µm deep.
    assert!((-10.0..0.0).contains(&ground), "{ground}");
    let laid = |text: &str, dried: bool| {
        let mut painting = bare();
        painting.apply(fill(text, 200.0)).expect("laid");
        if dried {
            painting.apply(Dry::whole(CANVAS)).expect("wet");
        }
        mean_um(&relief(&painting, middle)) - ground
    };
    let (wet, dry) = (laid(WHITE, false), laid(WHITE, true));
    let thin = laid("Titanium White=0.5,Thinner=0.5", false);
    println!("dry {dry:.1} µm, wet {wet:.1} µm, thinned {thin:.1} µm");
    assert!((dry - 200.0).abs() < 1.0, "{dry}");
    assert!((wet / dry - 0.2).abs() < 0.01, "{wet}");
    // Half of it thinner: no yield stress is left.
    assert!(thin.abs() < 1.0, "{thin}");
}

#[test]
fn wet_paint_bears_the_share_that_its_model_says() {
    let middle = [0.5 * WIDE_MM; 2];
    let share = |model: &ModelEntry| {
        let mut painting = bare_of(model);
        let ground = mean_um(&relief(&painting, middle));
        painting.apply(fill(WHITE, 200.0)).expect("laid");
        (mean_um(&relief(&painting, middle)) - ground) / 200.0
    };
    for model in &MODELS {
        let share = share(model);
        let off = |model: &ModelEntry| (share - model.rheology.bears).abs();
        assert!(off(model) < 0.01, "{model:?}: {share}");
        let other = MODELS
            .iter()
            .find(|other| other.rheology.bears != model.rheology.bears);
        assert!(off(other.expect("they differ")) > 0.1, "a fault passes");
    }
}

#[test]
fn heights_lie_where_they_were_painted_and_go_no_farther_than_the_canvas() {
    let mut painting = bare();
    painting.apply(fill(WHITE, 200.0)).expect("laid");
    painting.apply(Dry::whole(CANVAS)).expect("wet");
    let corner = relief(&painting, [0.5, 0.5]);
    assert_eq!((corner.cell_m, corner.side), (1e-3, 24));
    assert_eq!(corner.first, [-12, -12]);
    assert_eq!(corner.fault(), None);
    for (at, um) in heights_um(&corner.heights_um).enumerate() {
        let [x, y] = [at % 24, at / 24].map(|i| i as i32 - 12);
        let is_on = x >= 0 && y >= 0;
        assert!(is_on == (um > 150) && (is_on || um == 0), "{x} {y}: {um}");
    }
    // Patches of two places agree where both are.
    let (one, other) = (
        relief(&painting, [20.2, 30.0]),
        relief(&painting, [23.9, 33.0]),
    );
    assert_eq!(
        [other.first[0] - one.first[0], other.first[1] - one.first[1]],
        [3, 3]
    );
    let height = |relief: &BrushRelief, x: i32, y: i32| {
        let at = (y - relief.first[1]) * 24 + x - relief.first[0];
        heights_um(&relief.heights_um).nth(at as usize)
    };
    for y in other.first[1]..one.first[1] + 24 {
        for x in other.first[0]..one.first[0] + 24 {
            assert_eq!(height(&one, x, y), height(&other, x, y));
        }
    }
}

#[test]
fn a_brush_far_away_or_unknown_has_no_relief_below_it() {
    let painting = bare();
    let mut high = over([30.0, 30.0]);
    high.pose.position_m[2] += 0.06;
    assert_eq!(painting.relief_below(BRUSH, &high), None);
    assert_eq!(painting.relief_below("another", &over([30.0, 30.0])), None);
    let nowhere = Solve {
        surface: 7,
        ..over([30.0, 30.0])
    };
    assert_eq!(painting.relief_below(BRUSH, &nowhere), None);
    let mut beside = over([30.0, 30.0]);
    beside.pose.position_m[0] = 90.0;
    let beside = painting
        .relief_below(BRUSH, &beside)
        .expect("above the plane");
    assert!(heights_um(&beside.heights_um).all(|um| um == 0));
}
