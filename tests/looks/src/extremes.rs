//! Paint, tools and grounds beyond a painter's: all stays finite and no quantum is lost.

use maulstick_painting::edits::{Fill, FillPaint};
use maulstick_types::scene::CANVAS;
use maulstick_types::values::FilmThickness;

use super::easel::{Easel, Stroke, brush};

/// Checks that all paint is accounted for, in finite amounts that are not negative.
fn whole(easel: &mut Easel) {
    assert_eq!(easel.offline.painting_mut().report().quanta_missing, 0);
    for map in [easel.film(None), easel.ground()] {
        assert!(map.cells.iter().all(|height| height.is_finite()));
    }
    assert!(easel.film(None).cells.iter().all(|film| *film >= 0.0));
}

fn easel(kind: &str) -> Easel {
    let file = brush(kind, 14.0).expect("of the library");
    Easel::new([40.0, 30.0], 0.25, "linen", file).expect("an easel")
}

fn fill(easel: &mut Easel, film_mm: f64) {
    let fill = Fill {
        paint: FillPaint::Mixture {
            mixture: "Titanium White".parse().expect("a mixture"),
        },
        thickness: FilmThickness::new(1e-3 * film_mm).expect("in range"),
        surface: CANVAS,
    };
    easel.edit(fill).expect("filled");
}

#[test]
fn a_film_of_a_metre_is_refused() {
    let mut file = brush("flat", 14.0).expect("flat");
    file.load.film_um = 1e6;
    let text = file.to_toml().expect("text");
    let said = maulstick_brush::BrushFile::parse(&text).expect_err("refused");
    assert!(said.to_string().contains("load.film_um"), "{said}");
    let mut easel = easel("flat");
    assert!(FilmThickness::new(1.0).is_err());
    whole(&mut easel);
}

#[test]
fn a_brush_full_of_thinner_alone_paints() {
    let mut easel = easel("flat");
    easel.load("Thinner").expect("loaded");
    easel
        .stroke(&Stroke::along(15.0, 10.0, 30.0, 0.5))
        .expect("painted");
    whole(&mut easel);
    fill(&mut easel, 0.3);
    easel
        .stroke(&Stroke::along(15.0, 10.0, 30.0, 1.0))
        .expect("painted");
    whole(&mut easel);
}

#[test]
fn a_knife_at_full_pressure_scrapes_and_loses_nothing() {
    for lean_deg in [0.0, 60.0, 89.0] {
        let mut easel = easel("knife");
        fill(&mut easel, 1.0);
        let stroke = Stroke {
            lean_deg,
            ..Stroke::along(15.0, 10.0, 30.0, 1.0)
        };
        easel.stroke(&stroke).expect("painted");
        whole(&mut easel);
    }
}

#[test]
fn a_relief_of_five_millimetres_is_painted_over() {
    let mut easel = easel("flat");
    fill(&mut easel, 5.0);
    easel.dry().expect("dried");
    let before = easel.ground().mean();
    assert!(before > 4_000.0, "{before}");
    easel.load("Ultramarine Blue").expect("loaded");
    for pressure in [0.01, 1.0] {
        easel
            .stroke(&Stroke::along(15.0, 10.0, 30.0, pressure))
            .expect("painted");
        whole(&mut easel);
    }
    assert!(easel.film(None).mean() > 1.0, "it is reached");
}

#[test]
fn strokes_over_the_edge_lose_nothing() {
    for kind in ["flat", "knife", "mop", "badger"] {
        let mut easel = easel(kind);
        easel.load("Ultramarine Blue").expect("loaded");
        for y in [-3.0, 0.0, 29.0] {
            easel
                .stroke(&Stroke::along(y, -20.0, 60.0, 0.7))
                .expect("painted");
            whole(&mut easel);
        }
    }
}

#[test]
fn a_stroke_of_ten_metres_loses_nothing() {
    let mut easel = easel("flat");
    easel.load("Ultramarine Blue").expect("loaded");
    easel
        .stroke(&Stroke::along(15.0, -5_000.0, 5_000.0, 0.5))
        .expect("painted");
    whole(&mut easel);
    assert!(easel.film(None).mean() > 1.0, "it crosses the canvas");
}

#[test]
fn all_colours_on_one_head_are_painted_and_seen() {
    let library = maulstick_optics::PaintLibrary::measured().expect("whole");
    let parts = library.paints().iter();
    let parts: Vec<String> = parts.map(|paint| format!("{}=1", paint.name)).collect();
    let mut easel = easel("flat");
    for (place, y) in [10.0, 20.0, 15.0].into_iter().enumerate() {
        let mixtures = [
            parts[..14].join(","),
            parts[14..].join(","),
            parts.join(","),
        ];
        easel.load(&mixtures[place]).expect("loaded");
        easel
            .stroke(&Stroke::along(y, 5.0, 35.0, 0.4))
            .expect("painted");
        whole(&mut easel);
    }
    assert_eq!(library.paints().len(), 28);
    for map in easel.colours() {
        assert!(map.cells.iter().all(|value| value.is_finite()));
    }
}

#[test]
fn a_rake_of_four_thousand_bristles_paints() {
    let mut file = brush("flat", 14.0).expect("flat");
    file.strips.count = 4_000;
    let text = file.to_toml().expect("text");
    let file = maulstick_brush::BrushFile::parse(&text).expect("a brush");
    let mut easel = Easel::new([40.0, 30.0], 0.25, "linen", file).expect("an easel");
    easel.load("Titanium White").expect("loaded");
    easel
        .stroke(&Stroke::along(15.0, 10.0, 30.0, 0.5))
        .expect("painted");
    whole(&mut easel);
}
