//! dAb in a painting: colours that drying keeps, and a palette of its own.

use maulstick_painting::edits::Dry;
use maulstick_painting::picture::{picture, unlit_picture};
use maulstick_painting::{Painting, PaintingSetup};
use maulstick_types::brush::Solve;
use maulstick_types::scene::{CANVAS, Light, PALETTE};
use maulstick_types::values::Share;

use crate::studio::{BRUSH, fill, load, mixture, painting, round, solve, state};

const BLUE: &str = "Ultramarine Blue=0.6,Titanium White=0.4";

fn easel(palette_model: &str) -> Painting {
    let setup = PaintingSetup {
        cells: [150, 100],
        wells: vec![mixture(BLUE)],
        model: "dab".to_owned(),
        palette_model: palette_model.to_owned(),
        ..PaintingSetup::default()
    };
    let mut painting = painting(&setup);
    painting.define_brush(BRUSH, round(6.0, 48));
    painting
}

fn stroke(painting: &mut Painting, number: u64, surface: u32, x: &[f64], y: f64) {
    let file = round(6.0, 48);
    let solve = |stroke: u64, x: f64| Solve {
        surface,
        ..solve(&file, stroke, [x, y], 0.6, [0.2, 0.3])
    };
    let mut solves: Vec<Solve> = x.iter().map(|x| solve(number, *x)).collect();
    solves.push(solve(0, 0.0));
    painting.state(BRUSH, 1, &state(solves)).expect("it fits");
}

fn dry(painting: &mut Painting, share: f32) {
    let dry = Dry {
        share: Share::new(share).expect("in range"),
        ..Dry::whole(CANVAS)
    };
    painting.apply(dry).expect("wet");
}

/// Largest difference of a channel.
fn apart(one: &[u8], other: &[u8]) -> u8 {
    let pairs = one.iter().zip(other);
    pairs.map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
}

/// Half of a veil dries, then half of the rest, then a stroke comes over it.
#[test]
fn what_dries_in_parts_looks_as_before() {
    let mut painting = easel("impasto");
    painting.apply(fill("Yellow Ochre", 20.0)).expect("laid");
    dry(&mut painting, 1.0);
    painting.apply(fill(BLUE, 30.0)).expect("laid");
    painting.apply(load(BLUE)).expect("loaded");
    stroke(&mut painting, 1, CANVAS, &[4.0, 12.0, 22.0], 6.0);
    let wet = picture(&mut painting, CANVAS).rgb;
    for share in [0.5, 0.5, 0.8] {
        dry(&mut painting, share);
        let dried = picture(&mut painting, CANVAS).rgb;
        assert!(apart(&wet, &dried) <= 2, "{}", apart(&wet, &dried));
    }
    // The scene of plain layers: all dried paint, without the wet paint over it.
    let whole = |share: f32| {
        let mut painting = easel("impasto");
        painting.apply(fill(BLUE, 30.0)).expect("laid");
        dry(&mut painting, share);
        painting.apply(fill("Yellow Ochre", 10.0)).expect("laid");
        picture(&mut painting, CANVAS).rgb
    };
    assert!(
        apart(&whole(1.0), &whole(0.3)) > 5,
        "a fault would pass: drying shows under new paint"
    );
    assert_eq!(painting.report().quanta_missing, 0);
}

/// The text's bumpiness is the relief of the scene's light.
#[test]
fn the_lights_relief_is_how_strongly_paint_is_embossed() {
    let relit = |painting: &mut Painting, relief: f64| {
        let light = Light {
            relief,
            ..painting.scene().light.clone()
        };
        painting.relight(&light).expect("a light");
        (painting.look().generation(), painting.look().print())
    };
    let mut painting = easel("impasto");
    painting.apply(load(BLUE)).expect("loaded");
    stroke(&mut painting, 1, CANVAS, &[4.0, 12.0, 22.0], 6.0);
    let [flat, embossed, strongly] = [0.0, 1.0, 3.0].map(|relief| {
        let look = relit(&mut painting, relief);
        assert_eq!(look, relit(&mut painting, relief), "nothing changes");
        (look, unlit_picture(&mut painting, CANVAS))
    });
    let by = [&embossed, &strongly].map(|(_, picture)| apart(&picture.rgb, &flat.1.rgb));
    println!("{by:?}");
    assert!(by[0] > 5 && by[1] > by[0], "{by:?}");
    assert!(flat.0.0 < embossed.0.0 && flat.0.1 != embossed.0.1);
    // The colours of other models have no relief, and stay.
    let mut oil = painting_of_oil();
    let [flat, strongly] = [0.0, 3.0].map(|relief| relit(&mut oil, relief));
    assert_eq!(flat, strongly);
}

fn painting_of_oil() -> Painting {
    painting(&PaintingSetup {
        cells: [150, 100],
        ..PaintingSetup::default()
    })
}

#[test]
fn a_brush_is_filled_on_a_palette_of_dab() {
    let mut painting = easel("dab");
    let well = painting.scene().surfaces[1].wells[0]
        .center_m
        .map(|m| m * 1e3);
    let ways = [well[0] - 2.0, well[0], well[0] + 2.0, well[0] - 2.0];
    stroke(&mut painting, 1, PALETTE, &ways, well[1]);
    let fullness = painting.fullness(maulstick_types::name_hash("main"));
    println!("{fullness:.2} full");
    assert!(fullness > 0.05, "{fullness}");
    assert_eq!(painting.report().quanta_missing, 0);
}
