//! Loading from a place: a brush takes up the mixture there, wet, dry or in a well.

use maulstick_brush::BrushFile;
use maulstick_painting::edits::{Dry, LoadFrom, PaintingEdit as _, Scrape, Undo};
use maulstick_painting::{Applied, EditError, Painting, PaintingSetup, SurfaceError};
use maulstick_types::Mixture;
use maulstick_types::scene::{CANVAS, PALETTE, WellKind};
use maulstick_types::values::{BrushName, Distance, ThinnerShare};

use super::studio::{BRUSH, fill, load, mixture, painting};

fn load_from(
    painting: &mut Painting,
    surface: u32,
    [x, y]: [f64; 2],
) -> Result<Mixture, EditError> {
    let edit = LoadFrom {
        x: Distance::new(x).expect("in range"),
        y: Distance::new(y).expect("in range"),
        surface,
        thinner: ThinnerShare::NONE,
        brush: BrushName::main(),
    };
    match edit.apply(painting)? {
        Applied::Loaded(mixture) => Ok(mixture),
        other => unreachable!("{other:?}"),
    }
}

/// The share of a paint.
fn share(mixture: &Mixture, paint: &str) -> f64 {
    let part = mixture.parts.iter().find(|part| part.paint == paint);
    part.map_or(0.0, |part| part.share)
}

fn with_brush() -> Painting {
    let mut painting = painting(&PaintingSetup {
        cells: [64, 48],
        ..PaintingSetup::default()
    });
    let round = BrushFile::library("round").expect("round");
    painting.define_brush(BRUSH, round);
    painting
}

#[test]
fn what_lies_at_a_place_is_loaded_wet_or_dry() {
    let mut painting = with_brush();
    let at = [8e-3, 6e-3];
    let bare = load_from(&mut painting, CANVAS, at);
    assert_eq!(bare, Err(SurfaceError::NoPaintThere { at_m: at }.into()));
    let green = "Cobalt Blue=0.75,Hansa Yellow Opaque=0.25";
    fill(green, 60.0).apply(&mut painting).expect("a film");
    let before = painting.report().quanta_missing;
    let wet = load_from(&mut painting, CANVAS, at).expect("paint");
    assert!((share(&wet, "Cobalt Blue") - 0.75).abs() < 1e-4, "{wet}");
    Dry::whole(CANVAS).apply(&mut painting).expect("dry");
    load("Bone Black").apply(&mut painting).expect("loaded");
    let dry = load_from(&mut painting, CANVAS, at).expect("paint");
    assert!((share(&dry, "Cobalt Blue") - 0.75).abs() < 1e-4, "{dry}");
    fill("Bone Black", 20.0)
        .apply(&mut painting)
        .expect("a film");
    let above = load_from(&mut painting, CANVAS, at).expect("paint");
    assert_eq!(above, mixture("Bone Black"), "wet paint hides dry");
    assert_eq!(painting.report().quanta_missing, before);
    assert_eq!(painting.report().quanta_missing, 0);
    Undo { brush: None }.apply(&mut painting).expect("a step");
    let beside = load_from(&mut painting, CANVAS, [1.0, 1.0]);
    assert!(beside.is_err(), "beside the canvas lies nothing");
}

/// Within the reach of one place two layers end beside each other: the newest counts alone.
#[test]
fn at_the_edge_of_a_layer_the_newest_is_loaded_unmixed() {
    let mut painting = with_brush();
    fill("Cobalt Blue", 60.0)
        .apply(&mut painting)
        .expect("a film");
    Dry::whole(CANVAS).apply(&mut painting).expect("dry");
    fill("Bone Black", 20.0)
        .apply(&mut painting)
        .expect("a film");
    let left = Dry {
        region: Some("0,0,8x12".parse().expect("a region")),
        ..Dry::whole(CANVAS)
    };
    left.apply(&mut painting).expect("dry");
    let scrape = Scrape {
        region: None,
        surface: CANVAS,
    };
    scrape.apply(&mut painting).expect("wet");
    for (x, paint) in [
        (7.8e-3, "Bone Black"),
        (8.2e-3, "Bone Black"),
        (9e-3, "Cobalt Blue"),
    ] {
        let found = load_from(&mut painting, CANVAS, [x, 6e-3]);
        assert_eq!(found, Ok(mixture(paint)), "{x} m");
    }
}

#[test]
fn a_well_gives_its_mixture() {
    let mut painting = with_brush();
    let scene = painting.scene().clone();
    let palette = scene.surfaces.iter().find(|own| own.id == PALETTE);
    let wells = &palette.expect("a palette").wells;
    for well in wells {
        let picked = load_from(&mut painting, PALETTE, well.center_m);
        match &well.kind {
            WellKind::Paint { mixture } => assert_eq!(picked.as_ref(), Ok(mixture)),
            WellKind::Medium => assert_eq!(picked, Ok(Mixture::pure("Thinner"))),
            WellKind::Cleaner => assert!(picked.is_err(), "{picked:?}"),
        }
    }
}

#[test]
fn what_is_loaded_may_be_thinned_and_keeps_its_proportions() {
    let mut painting = with_brush();
    let green = "Cobalt Blue=0.45,Hansa Yellow Opaque=0.15,Thinner=0.4";
    fill(green, 60.0).apply(&mut painting).expect("a film");
    let edit = LoadFrom {
        x: Distance::in_unit(8.0).expect("in range"),
        y: Distance::in_unit(6.0).expect("in range"),
        surface: CANVAS,
        thinner: ThinnerShare::in_unit(0.5).expect("in range"),
        brush: BrushName::main(),
    };
    let Ok(Applied::Loaded(said)) = edit.apply(&mut painting) else {
        unreachable!("a load");
    };
    let report = painting.report();
    let on_brush = |paint: &str| report.paints_m3[paint]["brush"];
    let carried = report.accounts_m3["brush"];
    for (paint, expected) in [
        ("Cobalt Blue", 0.225),
        ("Hansa Yellow Opaque", 0.075),
        ("Thinner", 0.7),
    ] {
        for got in [share(&said, paint), on_brush(paint) / carried] {
            assert!((got - expected).abs() < 1e-3, "{paint}: {got}");
        }
    }
    assert_eq!(painting.report().quanta_missing, 0);
}
