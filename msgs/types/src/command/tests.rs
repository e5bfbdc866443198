//! What commands may say.

use super::*;
use crate::mixture::Part;
use crate::scene::{Well, WellKind};

#[test]
fn what_is_too_long_or_too_far_is_refused_in_few_words() {
    let long = "x".repeat(70_000);
    let part = Part {
        paint: long.clone(),
        share: 1.0,
    };
    let load = |mixture: Mixture| Command::Load {
        brush: "main".into(),
        mixture,
    };
    let hostile = [
        Command::Clean {
            brush: long.clone(),
        },
        Command::Snapshot {
            path: long.clone(),
            ledger: None,
        },
        Command::Snapshot {
            path: "p.png".into(),
            ledger: Some(long.clone()),
        },
        load(Mixture { parts: vec![part] }),
        load(Mixture {
            parts: vec![Mixture::pure("A").parts[0].clone(); 5000],
        }),
        Command::Take {
            brush: "main".into(),
            device: 1,
            device_epoch: 1,
            loads: vec![Mixture::pure(&long)],
            again: false,
        },
    ];
    for command in hostile {
        let what = command.check().expect_err("too long");
        assert!(what.len() < 200, "{what}");
    }
    let place = |x: f64| Command::Place {
        surface: 0,
        pose: Pose {
            position_m: [x, 0.0, 0.0],
            ..Pose::IDENTITY
        },
        zoom: 1.0,
    };
    assert!(place(1e30).check().is_err() && place(f64::NAN).check().is_err());
    assert_eq!(place(-0.1).check(), Ok(()));
    assert_eq!(load(Mixture::pure("Bone Black")).check(), Ok(()));
    assert_eq!(Command::Mark.check(), Ok(()));
}

#[test]
fn canvases_and_paths_are_sound_or_refused_with_what_to_do() {
    let new = |width_m: f64, cell_m: f64| Command::New {
        path: None,
        canvas: NewCanvas {
            width_m,
            height_m: 0.2,
            cell_m,
            ground: "gesso".into(),
            tooth: "linen".into(),
            tooth_seed: 1,
            stain_m: 3e-6,
        },
        forget: false,
    };
    assert_eq!(new(0.3, 2.5e-4).check(), Ok(()));
    for (width_m, cell_m, word) in [
        (0.0, 2.5e-4, "0×20 cm"),
        (1e4, 2.5e-4, "1638 cm"),
        (f64::NAN, 2.5e-4, "NaN"),
        (0.3, 0.0, "cells of 0 mm"),
        (0.3, f64::INFINITY, "cells of inf mm"),
        (0.6, 1e-5, "million cells"),
    ] {
        let what = new(width_m, cell_m).check().expect_err("refused");
        assert!(what.contains(word) && what.contains("choose"), "{what}");
    }
    let open = |path: &str| Command::Open {
        path: path.into(),
        forget: false,
    };
    assert_eq!(open("/tmp/a.maul").check(), Ok(()));
    for path in ["", "a.maul", "/a\0b", &format!("/{}", "x".repeat(PATH_MAX))] {
        assert!(open(path).check().is_err(), "{path:?}");
    }
    let bits = |bits: u32| Command::Export {
        order: ExportOrder {
            bits,
            ..ExportOrder::to("/a.png")
        },
    };
    assert!(bits(16).check().is_ok() && bits(12).check().is_err());
}

#[test]
fn a_layer_has_a_name_that_can_be_read() {
    let named = |name: &str| Command::NameLayer {
        layer: 1,
        name: name.to_owned(),
    };
    assert_eq!(named("Sky").check(), Ok(()));
    for name in ["", "  ", "a\nb", &"x".repeat(LAYER_NAME_MAX + 1)] {
        let what = named(name).check().expect_err(name);
        assert!(what.contains("give"), "{what}");
    }
}

#[test]
fn wells_are_few_round_and_near() {
    let check = |radius_m: f64, x: f64, count: usize| {
        let well = Well {
            center_m: [x, 0.0],
            radius_m,
            kind: WellKind::Cleaner,
        };
        let surface = crate::scene::PALETTE;
        let wells = vec![well; count];
        Command::Wells { surface, wells }.check()
    };
    assert_eq!(check(0.01, 0.1, WELLS_MAX), Ok(()));
    let many = check(0.01, 0.1, WELLS_MAX + 1).expect_err("too many");
    assert!(many.contains("at most 64"), "{many}");
    for (radius_m, x) in [(0.0, 0.1), (f64::NAN, 0.1), (1e9, 0.1), (0.01, f64::NAN)] {
        let error = check(radius_m, x, 1).expect_err("no well");
        assert!(error.contains("within the surface"), "{error}");
    }
}
