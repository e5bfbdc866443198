//! What commands may say.

use super::*;
use crate::mixture::Part;

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
