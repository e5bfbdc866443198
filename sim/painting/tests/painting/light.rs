//! Effects of light and drying on a painting.

use std::sync::Arc;

use glam::DVec3;
use maulstick_appearance::Bakery;
use maulstick_appearance::display::WetFilms;
use maulstick_appearance::lamp::lamp_over;
use maulstick_appearance::picture::{Export, Picture};
use maulstick_brush::BrushFile;
use maulstick_num::geometry::rotation;
use maulstick_optics::colour::RgbSpace;
use maulstick_optics::gamut::GamutMapping;
use maulstick_optics::icc::Profile;
use maulstick_optics::light::{Facet, Lamp, LampSetup, Spot, lit};
use maulstick_optics::{PaintLibrary, Under};
use maulstick_painting::edits::{Dry, LayerRef, Opacity};
use maulstick_painting::picture::{banded, picture_for, unlit_picture};
use maulstick_painting::{Painting, PaintingSetup};
use maulstick_types::scene::{CANVAS, Light, PALETTE};
use maulstick_types::values::{LayerName, OpacityFactor, Share};

use crate::studio::{self, BRUSH};

pub(crate) fn painting(light: Light) -> Painting {
    let setup = PaintingSetup {
        cells: [96, 64],
        wells: vec!["Yellow Ochre".parse().expect("a mixture")],
        light,
        ..PaintingSetup::default()
    };
    let mut painting = studio::painting(&setup);
    let file = BrushFile::library("round").expect("round");
    painting.define_brush("main", file.scaled_to(8.0).expect("a size"));
    painting
}

/// A stroke from left to right, `y_mm` up the canvas.
pub(crate) fn stroke(painting: &mut Painting, number: u64, load: &str, y_mm: f64) {
    painting.apply(studio::load(load)).expect("known");
    let file = BrushFile::library("round")
        .and_then(|file| file.scaled_to(8.0))
        .expect("round");
    let solve = |x_mm: f64| studio::solve(&file, number, [x_mm, y_mm], 0.6, [0.2, 0.3]);
    let state = studio::state([3.0, 12.0, 20.0].map(solve));
    painting.state(BRUSH, 1, &state).expect("it fits");
    painting.commit();
}

pub(crate) fn two_strokes(painting: &mut Painting) {
    stroke(painting, 1, "Ultramarine Blue=0.3,Titanium White=0.7", 6.0);
    stroke(painting, 2, "Hansa Yellow Opaque", 9.0);
}

fn lamp_light() -> Light {
    Light {
        illuminant: "A".into(),
        adapted: false,
        samples: 8,
        exposure: 0.8,
        ..Light::default()
    }
}

/// Most that any channel of two pictures differs by.
pub(crate) fn farthest(one: &Picture, other: &Picture) -> u8 {
    let pairs = one.rgb.iter().zip(&other.rgb);
    pairs.map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(255)
}

#[test]
fn drying_keeps_the_colour_and_the_height_whatever_the_share() {
    for share in [1.0, 0.4] {
        let mut painting = painting(Light::default());
        two_strokes(&mut painting);
        let wet = unlit_picture(&mut painting, CANVAS);
        painting
            .apply(Dry {
                share: Share::new(share).expect("in range"),
                ..Dry::whole(CANVAS)
            })
            .expect("wet");
        let dry = unlit_picture(&mut painting, CANVAS);
        assert!(
            farthest(&wet, &dry) <= 1,
            "{share}: {}",
            farthest(&wet, &dry)
        );
        painting
            .apply(Opacity {
                layer: LayerRef::Number { number: 1 },
                opacity: OpacityFactor::new(0.1).expect("in range"),
            })
            .expect("a layer");
        let thinner = unlit_picture(&mut painting, CANVAS);
        assert!(farthest(&wet, &thinner) > 4, "a fault would pass");
    }
}

/// Gloss of the first painted tile of the canvas, a cell.
pub(crate) fn gloss(painting: &mut Painting) -> Vec<f32> {
    let banded = banded(painting, CANVAS).expect("a canvas");
    let (id, tile) = banded.tiles(0).next().expect("a tile");
    banded.shown(id, tile, &mut Bakery::default()).gloss
}

/// Paint that dries on the ground is matt in its first thin coat; wet paint is as glossy however thin.
#[test]
fn a_first_thin_coat_sinks_in() {
    let first = |um: f64, dry: Option<Dry>| {
        let mut painting = painting(Light::default());
        painting
            .apply(studio::fill("Raw Sienna", um))
            .expect("laid");
        if let Some(dry) = dry {
            painting.apply(dry).expect("wet");
        }
        gloss(&mut painting)[0]
    };
    let [thin, thick] = [8.0, 120.0].map(|um| first(um, Some(Dry::whole(CANVAS))));
    let [wet, wetter] = [8.0, 120.0].map(|um| first(um, None));
    assert!(thin < 0.5 * thick && thick < wet, "{thin} {thick} {wet}");
    assert!((wet - wetter).abs() < 1e-6, "{wet} {wetter}");
}

#[test]
fn a_glaze_lets_the_dry_layer_shine_through_and_does_not_mix_with_it() {
    let stack = |dried: bool| {
        let mut painting = painting(Light::default());
        stroke(&mut painting, 1, "Hansa Yellow Opaque", 8.0);
        if dried {
            painting
                .apply(Dry {
                    share: Share::new(1.0).expect("in range"),
                    ..Dry::whole(CANVAS)
                })
                .expect("wet");
        }
        stroke(&mut painting, 2, "Ultramarine Blue=0.06,Thinner=0.94", 8.0);
        let store = painting.store(CANVAS).expect("a canvas");
        let wet_yellow = store.counts()[0];
        assert_eq!(painting.report().quanta_missing, 0);
        (wet_yellow, unlit_picture(&mut painting, CANVAS))
    };
    let (wet, stirred) = stack(false);
    let (dry, glazed) = stack(true);
    assert!(wet > 0 && dry == 0);
    assert!(farthest(&stirred, &glazed) > 8);
}

#[test]
fn a_relit_painting_is_one_that_was_painted_under_that_light() {
    let mut before = painting(lamp_light());
    let mut after = painting(Light::default());
    for painting in [&mut before, &mut after] {
        stroke(painting, 1, "Ultramarine Blue=0.3,Titanium White=0.7", 6.0);
        painting
            .apply(Dry {
                share: Share::new(0.6).expect("in range"),
                layer: LayerName::new("first").ok(),
                ..Dry::whole(CANVAS)
            })
            .expect("wet");
        stroke(painting, 2, "Pyrrole Red", 7.0);
        painting
            .apply(Dry {
                share: Share::new(1.0).expect("in range"),
                layer: LayerName::new("second").ok(),
                ..Dry::whole(CANVAS)
            })
            .expect("wet");
        stroke(painting, 3, "Yellow Ochre", 9.0);
    }
    let day = unlit_picture(&mut after, CANVAS);
    let generation = after.look().generation();
    after.relight(&lamp_light()).expect("a light");
    assert!(after.look().generation() > generation);
    let (one, other) = (
        unlit_picture(&mut before, CANVAS),
        unlit_picture(&mut after, CANVAS),
    );
    assert!(one == other);
    assert!(farthest(&one, &day) > 20, "under a lamp all is yellow");
    // The wells and the swatches of the paints change too.
    assert_eq!(before.scene().paints, after.scene().paints);
    assert_eq!(
        before.bare(1).map(|bare| bare.wells.clone()),
        after.bare(1).map(|bare| bare.wells.clone())
    );
    // A lamp that only moves changes no colour.
    let generation = after.look().generation();
    let moved = Light {
        direction: [0.5, 0.1, 0.8],
        ..lamp_light()
    };
    after.relight(&moved).expect("a light");
    assert_eq!(after.look().generation(), generation);
}

#[test]
fn the_bare_canvas_does_not_clip_at_the_start() {
    for (illuminant, adapted, intensity) in
        [("D65", true, 1.0), ("A", false, 1.0), ("D65", true, 9.0)]
    {
        let painting = painting(Light {
            illuminant: illuminant.into(),
            adapted,
            intensity,
            ..Light::default()
        });
        let bare = painting.bare(CANVAS).expect("a canvas");
        let rgb = painting.look().studio.colour(&[], bare.ground.mean());
        let light = &painting.scene().light;
        let most = rgb
            .iter()
            .map(|v| v * light.exposure * light.intensity)
            .fold(0.0, f64::max);
        assert!(most <= 0.981, "{illuminant}: {most}");
        assert!(most > 0.8, "nor is it dark: {most}");
    }
}

#[test]
fn a_light_that_is_none_changes_nothing() {
    let mut painting = painting(Light::default());
    let version = painting.scene().version;
    for light in [
        Light {
            illuminant: "D64".into(),
            ..Light::default()
        },
        Light {
            samples: 3,
            ..Light::default()
        },
        Light {
            spectrum: vec![1.0; 7],
            ..Light::default()
        },
        Light {
            spectrum: vec![0.0; 101],
            ..Light::default()
        },
        Light {
            intensity: f64::NAN,
            ..Light::default()
        },
        Light {
            direction: [0.0, 0.0, -1.0],
            ..Light::default()
        },
        Light {
            rule: "simpson".into(),
            ..Light::default()
        },
        Light {
            observer: 2006,
            ..Light::default()
        },
    ] {
        let refusal = painting.relight(&light).expect_err("no light");
        println!("{refusal}: {}", refusal.advice());
        assert_eq!(painting.scene().version, version);
    }
    let refusal = painting.relight(&Light {
        illuminant: "D64".into(),
        ..Light::default()
    });
    assert!(
        refusal
            .expect_err("unknown")
            .advice()
            .to_string()
            .contains("'D65'")
    );
}

/// A flat bare canvas, adapted or not, has the colour of a spectrometer reading under that light.
#[test]
fn a_flat_surface_shows_its_colour_and_the_colour_of_its_light() {
    for adapted in [true, false] {
        let light = Light {
            adapted,
            exposure: 1.0,
            ..lamp_light()
        };
        let painting = painting(light);
        let bare = painting.bare(CANVAS).expect("a canvas");
        let studio = &painting.look().studio;
        let read = studio.colour(&[], bare.ground.mean());
        let [r, g, b] = WetFilms::of(None).shade(studio, Under::Even(bare.ground.mean()));
        let spot = Spot {
            unlit: [r[0], g[0], b[0]],
            gloss: 0.7,
            facet: Facet::LEVEL,
        };
        let strength = painting.scene().light.exposure;
        let shown = lit(&spot, &lamp_over(painting.scene(), CANVAS));
        for (shown, read) in shown.iter().zip(read) {
            let off = (f64::from(*shown) - strength * read).abs();
            assert!(off < 1e-5, "{adapted}: {shown} for {read}");
        }
        let white = Lamp::new(&LampSetup {
            exposure: strength,
            ..LampSetup::default()
        });
        let neutral = lit(&spot, &white);
        let off = f64::from(neutral[2]) - strength * read[2];
        assert_eq!(off.abs() > 1e-3, !adapted, "a neutral surface would pass");
    }
}

#[test]
fn a_turned_palette_is_lit_from_the_same_side_of_the_desk() {
    let mut scene = PaintingSetup::default().scene();
    assert_eq!(lamp_over(&scene, PALETTE), lamp_over(&scene, CANVAS));
    let quarter = rotation(DVec3::Z, std::f64::consts::FRAC_PI_2);
    scene.surfaces[1].pose.orientation = quarter.to_array();
    let [x, y, z] = lamp_over(&scene, CANVAS).toward;
    let turned = lamp_over(&scene, PALETTE).toward;
    for (got, expected) in turned.iter().zip([y, -x, z]) {
        assert!((got - expected).abs() < 1e-6, "{turned:?}");
    }
    // The lamp stays above the desk when canvas and palette turn together.
    scene.surfaces[0].pose.orientation = quarter.to_array();
    assert!((lamp_over(&scene, PALETTE).toward[0] - x).abs() < 1e-6);
    assert_eq!(lamp_over(&scene, 7), lamp_over(&scene, CANVAS));
}

/// Bare linen does not glare, however low its lamp; with the exposure as it was chosen much of it would.
#[test]
fn the_exposure_follows_the_lamp() {
    let glares = |z: f64, fault: f64| {
        let mut painting = painting(Light {
            direction: [-0.5, 0.5, z],
            ..Light::default()
        });
        let mut light = painting.scene().light.clone();
        light.exposure *= fault;
        painting.relight(&light).expect("in range");
        let picture = picture_for(&mut painting, CANVAS, &Export::default());
        let full = picture.rgb.chunks_exact(3);
        let full = full.filter(|rgb| rgb.contains(&255)).count();
        full as f64 / (picture.width * picture.height) as f64
    };
    for z in [0.7, 0.3, 0.18, 0.1, 0.01] {
        let share = glares(z, 1.0);
        println!("lamp at {z}: {share:.3}");
        assert!(share < 0.05, "{z}: {share}");
    }
    assert!(glares(0.18, 1.2) > 0.05, "a fault would pass");
}

#[test]
fn exposure_relief_and_softness_are_the_scenes() {
    let mut scene = PaintingSetup::default().scene();
    (scene.light.intensity, scene.light.exposure) = (2.0, 0.25);
    (scene.light.relief, scene.light.softness) = (3.0, 0.4);
    let lamp = lamp_over(&scene, CANVAS);
    assert_eq!(
        (lamp.intensity, lamp.relief, lamp.softness),
        (0.5, 3.0, 0.4)
    );
}

#[test]
fn a_png_says_what_its_bytes_mean() {
    let wide = Export {
        profile: Arc::new(Profile::of(RgbSpace::DisplayP3)),
        gamut: GamutMapping::Soft,
    };
    let mut painting = Painting::new(
        &PaintingSetup {
            cells: [8, 8],
            ..PaintingSetup::default()
        },
        PaintLibrary::measured().expect("whole"),
    )
    .expect("a painting");
    let profiles = [Export::default(), wide].map(|export| {
        let picture = picture_for(&mut painting, CANVAS, &export);
        let mut file = Vec::new();
        picture.encode_png(&mut file).expect("written");
        let decoder = png::Decoder::new(std::io::Cursor::new(file));
        let reader = decoder.read_info().expect("a PNG");
        let icc = reader.info().icc_profile.as_ref().map(|icc| icc.to_vec());
        assert_eq!(icc.as_deref(), Some(export.profile.icc()));
        let size = reader.info().pixel_dims.map(|size| (size.xppu, size.unit));
        assert_eq!(size, Some((4000, png::Unit::Meter)));
        icc
    });
    assert!(profiles[0] != profiles[1]);
}
