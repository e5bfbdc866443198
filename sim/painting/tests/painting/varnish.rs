//! Varnish: it shines alike on all that is dry, is clear, and comes off where no paint lies on it.

use maulstick_optics::colour::srgb_decode;
use maulstick_painting::edits::common::convert;
use maulstick_painting::edits::{Applied, Dry, Finish, Undo, Varnish};
use maulstick_painting::picture::{picture, unlit_picture};
use maulstick_painting::{LayerError, Painting};
use maulstick_types::scene::{CANVAS, Environment, Light};
use maulstick_types::values::ModelName;

use crate::light::{farthest, gloss, painting, stroke, two_strokes};
use crate::studio;

fn varnish(finish: Finish, region: Option<&str>) -> Varnish {
    let region = region.map(|region| region.parse().expect("a region"));
    Varnish { finish, region }
}

#[test]
fn varnish_shines_alike_on_all_that_is_dry_and_comes_off_whole() {
    let mut painting = painting(Light::default());
    two_strokes(&mut painting);
    let nothing = painting.apply(varnish(Finish::Off, None));
    assert_eq!(nothing, Err(LayerError::NoVarnish(None).into()));
    painting.apply(Dry::whole(CANVAS)).expect("wet");
    stroke(&mut painting, 3, "Bone Black", 3.0);
    let before = (unlit_picture(&mut painting, CANVAS), gloss(&mut painting));
    let layers = painting.scene().layers.len();
    for (finish, shine) in [
        (Finish::Gloss, 0.9..1.0),
        (Finish::Satin, 0.45..0.6),
        (Finish::Matt, 0.05..0.2),
    ] {
        painting.apply(varnish(finish, None)).expect("dry");
        let after = (unlit_picture(&mut painting, CANVAS), gloss(&mut painting));
        assert!(farthest(&before.0, &after.0) <= 1, "it is clear");
        let cells = before.1.iter().zip(&after.1);
        let (wet, dry): (Vec<_>, Vec<_>) = cells.partition(|(before, _)| **before > 0.7);
        assert!(wet.len() > 100 && wet.iter().all(|(before, after)| before == after));
        // Where paint has dried thick enough the coat does not sink in; on the bare ground it does.
        let on_paint = dry.iter().filter(|(before, _)| **before > 0.2);
        let shines: Vec<f32> = on_paint.map(|(_, after)| **after).collect();
        println!("{finish:?}: {} cells, {:.3}", shines.len(), shines[0]);
        let dull = |own: &&f32| !(0.75 * shine.start..shine.end).contains(*own);
        assert!(shines.len() > 100 && shines.iter().filter(dull).count() == 0);
        assert_eq!(painting.report().quanta_missing, 0);
        painting
            .apply(varnish(Finish::Off, None))
            .expect("varnished");
        let off = (unlit_picture(&mut painting, CANVAS), gloss(&mut painting));
        assert!(off == before && painting.scene().layers.len() == layers);
        assert_eq!(painting.report().quanta_missing, 0);
        painting.apply(Undo { brush: None }).expect("a step");
        assert!(gloss(&mut painting) == after.1, "varnished again");
        painting.apply(Undo { brush: None }).expect("a step");
    }
}

/// A viewer sees in a glossy surface the dim wall behind himself, in a matt one the light of the whole room.
#[test]
fn varnish_deepens_a_dark_passage_of_a_room_and_not_of_an_even_one() {
    let mean = |painting: &mut Painting| {
        let rgb = picture(painting, CANVAS).rgb;
        let light = rgb.iter().map(|byte| srgb_decode(f64::from(*byte) / 255.0));
        light.sum::<f64>() / rgb.len() as f64
    };
    for (environment, share) in [
        (Environment::Even, 0.95..1.05),
        (Environment::Room, 0.4..0.75),
        (Environment::Window, 0.4..0.75),
    ] {
        let mut painting = painting(Light {
            environment: environment.clone(),
            ..Light::default()
        });
        painting
            .apply(studio::fill("Bone Black=0.5,Burnt Umber=0.5", 60.0))
            .expect("laid");
        painting.apply(Dry::whole(CANVAS)).expect("wet");
        painting.apply(varnish(Finish::Matt, None)).expect("dry");
        let matt = mean(&mut painting);
        painting.apply(varnish(Finish::Gloss, None)).expect("dry");
        let glossy = mean(&mut painting) / matt;
        println!("{environment:?}: {glossy:.2} of {matt:.4}");
        assert!(share.contains(&glossy), "{environment:?}: {glossy}");
    }
}

#[test]
fn varnish_comes_off_a_part_and_stays_under_later_paint() {
    let mut painting = painting(Light::default());
    painting
        .apply(studio::fill("Raw Sienna", 60.0))
        .expect("laid");
    let wet = painting.apply(varnish(Finish::Gloss, None));
    assert_eq!(wet, Err(LayerError::AllWet(None).into()));
    painting.apply(Dry::whole(CANVAS)).expect("wet");
    painting.apply(varnish(Finish::Gloss, None)).expect("dry");
    painting
        .apply(varnish(Finish::Off, Some("0,0,4x16")))
        .expect("varnished");
    let shine = gloss(&mut painting);
    let edge = 16 * maulstick_types::paint::TILE..;
    let row = &shine[edge][..maulstick_types::paint::TILE];
    let shiny = row.iter().filter(|gloss| **gloss > 0.8).count();
    assert!(
        shiny > 8 && shiny < row.len() - 8 && row[0] < 0.5,
        "{row:?}"
    );
    painting
        .apply(studio::fill("Bone Black", 20.0))
        .expect("laid");
    painting.apply(Dry::whole(CANVAS)).expect("wet");
    let off = painting.apply(varnish(Finish::Off, None));
    assert_eq!(off, Err(LayerError::NoVarnish(None).into()));
    assert_eq!(painting.report().quanta_missing, 0);
}

#[test]
fn varnish_comes_off_beside_later_paint_of_the_same_tile() {
    let mut painting = painting(Light::default());
    painting
        .apply(studio::fill("Raw Sienna", 60.0))
        .expect("laid");
    painting.apply(Dry::whole(CANVAS)).expect("wet");
    let bare = gloss(&mut painting);
    painting.apply(varnish(Finish::Gloss, None)).expect("dry");
    stroke(&mut painting, 1, "Bone Black", 6.0);
    painting.apply(Dry::whole(CANVAS)).expect("wet");
    let shiny = gloss(&mut painting);
    let layers = painting.scene().layers.len();
    painting.apply(varnish(Finish::Off, None)).expect("beside");
    let off = gloss(&mut painting);
    let cells = bare.iter().zip(&shiny).zip(&off);
    let (beside, under): (Vec<_>, Vec<_>) = cells.partition(|((_, shiny), _)| **shiny > 0.9);
    assert!(beside.len() > 100 && beside.iter().all(|((bare, _), off)| bare == off));
    assert!(
        under.len() > 100
            && under
                .iter()
                .all(|((_, shiny), off)| (*shiny - *off).abs() < 1e-6)
    );
    assert_eq!(
        painting.scene().layers.len(),
        layers,
        "some is left under the paint"
    );
    assert_eq!(painting.report().quanta_missing, 0);
    let again = painting.apply(varnish(Finish::Off, None));
    assert_eq!(again, Err(LayerError::NoVarnish(None).into()));
    painting.apply(Undo { brush: None }).expect("a step");
    assert!(gloss(&mut painting) == shiny);
}

#[test]
fn varnish_stays_clear_in_the_colours_of_dab() {
    let converted = |coat: &str| {
        let mut painting = painting(Light::default());
        two_strokes(&mut painting);
        painting.apply(Dry::whole(CANVAS)).expect("wet");
        match coat {
            "varnish" => painting.apply(varnish(Finish::Satin, None)),
            "none" => Ok(Applied::Done),
            paint => painting.apply(studio::fill(paint, 15.0)),
        }
        .expect("laid");
        let model = ModelName::new("dab").expect("a name");
        painting.apply(convert(CANVAS, model)).expect("another");
        unlit_picture(&mut painting, CANVAS)
    };
    let plain = converted("none");
    let coated = converted("varnish");
    // A fit of colours may take another way where the layers are others, by a few of 255.
    assert!(farthest(&plain, &coated) <= 4);
    assert!(
        farthest(&plain, &converted("Bone Black")) > 40,
        "a fault would pass"
    );
}
