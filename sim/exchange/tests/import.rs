//! Pictures become grounds, teeth and paint.

use std::io::Cursor;
use std::sync::Arc;

use image::{DynamicImage, GrayImage, ImageFormat, Luma, Rgb, RgbImage};
use maulstick_canvas::quantum::QUANTUM_M;
use maulstick_canvas::tile::{Tile, TileId, Version};
use maulstick_exchange::underpaint::underpaint;
use maulstick_exchange::{Image, ImportError, Support, Underpainting, embed};
use maulstick_optics::PaintLibrary;
use maulstick_optics::colour::{apply, delta_e_2000, inverse, lab, srgb_decode, srgb_encode};
use maulstick_painting::edits::{Ground, Tooth};
use maulstick_painting::setup::PALETTE_PAINTS;
use maulstick_painting::{Painting, PaintingSetup, Wetness};
use maulstick_types::paint::StepName;
use maulstick_types::scene::CANVAS;
use maulstick_types::values::MaterialName;

const FILM_M: f64 = 60e-6;

fn read(pixels: impl Into<DynamicImage>) -> Image {
    let mut bytes = Cursor::new(Vec::new());
    let pixels = pixels.into();
    pixels
        .write_to(&mut bytes, ImageFormat::Png)
        .expect("written");
    Image::read(&bytes.into_inner()).expect("a picture")
}

fn painting(cells: [u32; 2]) -> Painting {
    let setup = PaintingSetup {
        cells,
        ..PaintingSetup::default()
    };
    Painting::new(&setup, PaintLibrary::measured().expect("whole")).expect("a painting")
}

fn paints() -> Vec<String> {
    PALETTE_PAINTS.map(str::to_owned).to_vec()
}

fn solved(painting: &Painting, image: &Image, thickness_m: f64) -> Underpainting {
    let support = Support::of(painting, CANVAS, &paints()).expect("a surface");
    let mut told = Vec::new();
    let found = underpaint(&support, image, thickness_m, &mut |done, all| {
        told.push((done, all));
    });
    let all = told[0].1;
    assert_eq!((told[0], told.last()), ((0, all), Some(&(all, all))));
    assert!(told.windows(2).all(|two| two[0].0 <= two[1].0));
    found.expect("solved")
}

fn lay(painting: &mut Painting, under: &Underpainting, wetness: &Wetness) -> Option<String> {
    painting
        .underpaint(CANVAS, under.paints(), wetness, under.tiles())
        .expect("laid")
}

/// Thickness of each paint in a cell, m, by slot.
fn films(painting: &Painting, [x, y]: [u32; 2]) -> Vec<(usize, f64)> {
    let id = TileId {
        x: x / 64,
        y: y / 64,
    };
    let cell = (y % 64 * 64 + x % 64) as usize;
    let version = painting.store(CANVAS).expect("a canvas").version(id);
    let wet = version.tile.as_deref().map(Tile::wet).unwrap_or_default();
    wet.iter()
        .map(|(slot, plane)| (*slot, f64::from(plane[cell]) * QUANTUM_M))
        .collect()
}

/// CIELAB of encoded sRGB under the painting's light.
fn lab_of(painting: &Painting, rgb: [u8; 3]) -> [f64; 3] {
    let studio = &painting.look().studio;
    let linear = rgb.map(|byte| srgb_decode(f64::from(byte) / 255.0));
    lab(apply(&inverse(studio.to_rgb()), linear), studio.white())
}

/// ΔE₀₀ of a cell from sRGB bytes.
fn off(painting: &Painting, cell: [u32; 2], rgb: [u8; 3]) -> f64 {
    let ground = painting.bare(CANVAS).expect("a canvas").ground.mean();
    let seen = painting.look().studio.lab(&films(painting, cell), ground);
    delta_e_2000(seen, lab_of(painting, rgb))
}

fn versions(painting: &Painting) -> Vec<Option<Arc<Tile>>> {
    let store = painting.store(CANVAS).expect("a canvas");
    let tiles = store.iter();
    tiles
        .map(|(_, Version { tile, .. })| tile.clone())
        .collect()
}

/// A picture of many colours.
fn colourful(size: u32) -> RgbImage {
    let side = f64::from(size);
    RgbImage::from_fn(size, size, |x, y| {
        let (u, v) = (f64::from(x) / side, f64::from(y) / side);
        Rgb([0.3 + 0.6 * u, 0.35 + 0.4 * v, 0.7 - 0.4 * u * v].map(|v| (v * 255.0) as u8))
    })
}

#[test]
fn a_flat_grey_picture_is_one_grey_film_everywhere() {
    let mut painting = painting([100, 70]);
    let image = read(GrayImage::from_pixel(7, 3, Luma([140])));
    let under = solved(&painting, &image, FILM_M);
    let colour_error = *under.colour_error();
    assert_eq!((colour_error.cells, colour_error.colours), (7000, 1));
    assert!(colour_error.max < 0.1 && colour_error.mean <= colour_error.max);
    lay(&mut painting, &under, &Wetness::Wet);
    let first = films(&painting, [0, 0]);
    let thick: f64 = first.iter().map(|(_, d)| d).sum();
    assert!((thick - FILM_M).abs() < QUANTUM_M, "{thick}");
    assert_eq!(films(&painting, [99, 69]), first);
    assert!(films(&painting, [100, 69]).iter().all(|(_, d)| *d == 0.0));
    let near = off(&painting, [50, 50], [140; 3]);
    println!("{near:.4}, {colour_error:?}");
    assert!(near < 0.1);
    assert!(
        off(&painting, [50, 50], [142; 3]) > 0.1,
        "a fault would pass"
    );
}

#[test]
fn a_mixture_of_the_paints_is_found_again() {
    for shares in [
        [("Titanium White", 0.7), ("Ultramarine Blue", 0.3)],
        [("Yellow Ochre", 0.5), ("Burnt Sienna", 0.5)],
        [("Cadmium Orange", 0.9), ("Titanium White", 0.1)],
    ] {
        let mut painting = painting([64, 64]);
        let mut studio = painting.look().studio.clone();
        let films = shares.map(|(name, share)| {
            let paint = painting.library().find(name).expect("known");
            (studio.add(paint), share * FILM_M)
        });
        let ground = painting.bare(CANVAS).expect("a canvas").ground.mean();
        let rgb = studio.colour(&films, ground);
        let bytes = rgb.map(|channel| (srgb_encode(channel) * 255.0).round() as u8);
        if rgb.iter().any(|channel| !(0.0..=1.0).contains(channel)) {
            println!("{shares:?} is no colour of sRGB");
            continue;
        }
        let under = solved(
            &painting,
            &read(RgbImage::from_pixel(1, 1, Rgb(bytes))),
            FILM_M,
        );
        lay(&mut painting, &under, &Wetness::Wet);
        let near = off(&painting, [9, 9], bytes);
        println!("{shares:?}: {near:.4}");
        assert!(near < 0.3);
        let moved = bytes.map(|byte| byte.saturating_add(4));
        assert!(off(&painting, [9, 9], moved) > 0.3, "a fault would pass");
    }
}

#[test]
fn the_books_balance_and_undo_and_redo_give_the_same_tiles() {
    let mut painting = painting([150, 130]);
    let under = solved(&painting, &read(colourful(120)), FILM_M);
    println!("{:?}", under.colour_error());
    assert!(under.colour_error().p95 < 1.0);
    let bare = versions(&painting);
    let slots = painting.scene().paints.len();
    lay(&mut painting, &under, &Wetness::Wet);
    let laid = versions(&painting);
    let report = painting.report();
    assert_eq!(report.quanta_missing, 0);
    let volume = -report.accounts_m3["tube"];
    let expected = 150.0 * 130.0 * 2.5e-4 * 2.5e-4 * FILM_M;
    assert!(
        (volume / expected - 1.0).abs() < 1e-4,
        "{volume} {expected}"
    );
    assert!((report.accounts_m3["canvas"] - volume).abs() < 1e-18);
    assert!(slots < painting.scene().paints.len());
    assert_eq!(painting.undo(None), Ok(StepName::Underpainting));
    assert!(versions(&painting) == bare && painting.report().quanta_missing == 0);
    assert!(versions(&painting) != laid, "a fault would pass");
    painting.redo(None).expect("redone");
    let again = versions(&painting);
    let same = again
        .iter()
        .zip(&laid)
        .all(|(one, other)| match (one, other) {
            (Some(one), Some(other)) => one.is(other),
            _ => false,
        });
    assert!(same && painting.report().quanta_missing == 0);
}

#[test]
fn what_shall_be_dry_dries_in_the_same_step() {
    let mut painting = painting([70, 70]);
    let under = solved(&painting, &read(colourful(70)), FILM_M);
    let name = "dead colour".to_owned();
    let layer = lay(&mut painting, &under, &Wetness::Dry { name });
    assert_eq!(layer.as_deref(), Some("dead colour"));
    assert_eq!(painting.scene().layers.len(), 1);
    let report = painting.report();
    assert_eq!(
        (report.quanta_missing, report.accounts_m3["canvas"]),
        (0, 0.0)
    );
    assert!(report.accounts_m3["dry"] > 0.0);
    assert!(
        versions(&painting)
            .iter()
            .flatten()
            .all(|tile| tile.wet_page().is_none())
    );
    painting.undo(None).expect("undone");
    assert!(painting.scene().layers.is_empty() && versions(&painting).iter().all(Option::is_none));
    assert_eq!(painting.history_depth(), (0, 1));
    painting.redo(None).expect("redone");
    assert_eq!(
        (
            painting.scene().layers.len(),
            painting.report().quanta_missing
        ),
        (1, 0)
    );
}

#[test]
fn the_same_picture_gives_the_same_paint() {
    let painting = painting([130, 64]);
    let image = read(colourful(64));
    let [one, two] = [0, 1].map(|_| solved(&painting, &image, FILM_M));
    let tiles = |under: &Underpainting| under.tiles().collect::<Vec<_>>();
    assert!(tiles(&one) == tiles(&two) && one.colour_error() == two.colour_error());
    let thicker = solved(&painting, &image, 2.0 * FILM_M);
    assert!(tiles(&one) != tiles(&thicker), "a fault would pass");
}

#[test]
fn a_single_pixel_and_a_slim_picture_are_painted() {
    let mut painting = painting([64, 40]);
    let under = solved(
        &painting,
        &read(RgbImage::from_pixel(1, 1, Rgb([150, 120, 90]))),
        FILM_M,
    );
    lay(&mut painting, &under, &Wetness::Wet);
    assert!(off(&painting, [63, 39], [150, 120, 90]) < 0.1);
    let slim = GrayImage::from_fn(20_000, 10, |x, _| {
        Luma([if x < 10_000 { 100 } else { 200 }])
    });
    painting.undo(None).expect("undone");
    let under = solved(&painting, &read(slim), FILM_M);
    lay(&mut painting, &under, &Wetness::Wet);
    let (left, right) = (
        off(&painting, [2, 20], [100; 3]),
        off(&painting, [61, 20], [200; 3]),
    );
    println!("{left:.3} {right:.3}");
    assert!(left < 0.1 && right < 0.1);
    assert!(
        off(&painting, [2, 20], [200; 3]) > 10.0,
        "a fault would pass"
    );
}

#[test]
fn a_picture_is_a_ground_and_is_painted_over() {
    let mut painting = painting([96, 80]);
    let image = read(colourful(96));
    let png = embed::ground(&image, [96, 80]).expect("a ground");
    let hash = painting.embed(png).expect("taken");
    let refused = painting
        .apply(Ground::named(CANVAS, "image:00").expect("valid"))
        .expect_err("no hash");
    assert!(refused.to_string().contains("hash"));
    painting
        .apply(Ground::named(CANVAS, &format!("image:{hash}")).expect("valid"))
        .expect("a ground");
    let pixel = maulstick_exchange::fit_to::colours(&image, [96, 80]).expect("fitted");
    let picture = maulstick_painting::picture::unlit_picture(&mut painting, CANVAS);
    let mut worst = 0.0f64;
    for (x, y) in [(0, 0), (40, 70), (95, 79), (64, 64)] {
        let want = pixel.rgb[y * 96 + x];
        let got = &picture.rgb[((79 - y) * 96 + x) * 3..][..3];
        let [got, want] = [[got[0], got[1], got[2]], want].map(|rgb| lab_of(&painting, rgb));
        worst = worst.max(delta_e_2000(got, want));
    }
    println!("worst {worst:.3}");
    assert!(worst < 1.0, "it is shown as it is, to the last byte");
    // An inverted picture over it.
    let mut inverse = colourful(96);
    image::imageops::invert(&mut inverse);
    let under = solved(&painting, &read(inverse), FILM_M);
    println!("{:?}", under.colour_error());
    assert!(under.colour_error().p95 < 3.0);
    lay(&mut painting, &under, &Wetness::Wet);
    assert_eq!(painting.report().quanta_missing, 0);
    painting.undo(None).expect("paint");
    painting.undo(None).expect("ground");
    assert_eq!(painting.scene().surfaces[0].ground, "gesso");
    painting.redo(None).expect("ground");
    let again = maulstick_painting::picture::unlit_picture(&mut painting, CANVAS);
    assert!(again == picture);
    painting
        .apply(Ground::named(CANVAS, "grey").expect("valid"))
        .expect("another ground");
    let other = maulstick_painting::picture::unlit_picture(&mut painting, CANVAS);
    assert!(other != picture, "a fault would pass");
}

#[test]
fn a_picture_is_a_tooth_of_its_depth() {
    let mut painting = painting([80, 80]);
    let ramp = GrayImage::from_fn(256, 2, |x, _| Luma([x as u8]));
    let png = embed::tooth(&read(ramp), 20.0, 2.5e-4).expect("a tooth");
    let hash = painting.embed(png).expect("taken");
    let name = format!("image:{hash}@20mm,100um");
    painting
        .apply(Tooth {
            tooth: MaterialName::new(&*name).expect("valid"),
            seed: 1,
            surface: CANVAS,
        })
        .expect("a tooth");
    let tile = |painting: &Painting| {
        let relief = &painting.bare(CANVAS).expect("a canvas").relief;
        relief.tile(TileId { x: 0, y: 0 })
    };
    let heights = tile(&painting);
    for x in [1usize, 20, 40, 63] {
        // The mean of the 3.2 pixels of a cell.
        let expected = -100e-6 * (1.0 - ((x as f64 + 0.5) * 3.2 - 0.5) / 255.0);
        let off = (f64::from(heights[64 * 7 + x]) - expected).abs();
        assert!(off < 1e-6, "{x}: {} {expected}", heights[64 * 7 + x]);
    }
    painting
        .apply(Tooth {
            tooth: MaterialName::new(format!("image:{hash}@20mm,50um")).expect("valid"),
            seed: 1,
            surface: CANVAS,
        })
        .expect("a tooth");
    let lower = tile(&painting);
    assert!((lower[9] - 0.5 * heights[9]).abs() < 1e-9);
    assert!((lower[9] - heights[9]).abs() > 1e-6, "a fault would pass");
    let refused = painting.apply(Tooth {
        tooth: MaterialName::new(format!("image:{hash}")).expect("valid"),
        seed: 1,
        surface: CANVAS,
    });
    assert!(
        refused
            .expect_err("no size")
            .advice()
            .to_string()
            .contains("@120mm")
    );
    painting.undo(None).expect("undone");
    assert_eq!(tile(&painting), heights);
    // A new painting may begin with it.
    let setup = PaintingSetup {
        cells: [64, 64],
        tooth: name,
        embedded: painting.embedded().clone(),
        ..PaintingSetup::default()
    };
    let library = PaintLibrary::measured().expect("whole");
    let new = Painting::new(&setup, library).expect("a painting");
    assert_eq!(tile(&new), heights);
}

#[test]
fn what_cannot_be_painted_is_refused() {
    let painting = painting([64, 64]);
    let image = read(colourful(4));
    let support = |surface: u32, paints: &[String]| Support::of(&painting, surface, paints);
    assert!(matches!(
        support(7, &paints()),
        Err(ImportError::Refused(_))
    ));
    assert!(matches!(support(CANVAS, &[]), Err(ImportError::Paints(0))));
    let unknown = support(CANVAS, &["Blu".to_owned()]);
    assert!(matches!(unknown, Err(ImportError::Refused(_))));
    let whole = support(CANVAS, &paints()).expect("a surface");
    for thickness_m in [0.0, 1e-7, 0.1, f64::NAN] {
        let error = underpaint(&whole, &image, thickness_m, &mut |_, _| {});
        assert!(matches!(error, Err(ImportError::Thickness(_))));
    }
}

#[test]
fn few_paints_do_what_they_can() {
    let painting = painting([64, 64]);
    let image = read(colourful(40));
    let two = ["Burnt Sienna", "Titanium White"].map(str::to_owned);
    let of = |paints: &[String]| {
        let support = Support::of(&painting, CANVAS, paints).expect("a surface");
        *underpaint(&support, &image, FILM_M, &mut |_, _| {})
            .expect("solved")
            .colour_error()
    };
    let (one, two, all) = (of(&two[..1]), of(&two), of(&paints()));
    println!("{one:?}\n{two:?}\n{all:?}");
    assert!(one.mean > two.mean && two.mean > all.mean);
}
