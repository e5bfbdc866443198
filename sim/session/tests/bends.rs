//! The bend that stays in a brush goes with the painting: undone, done again, saved and opened, and ended by an edit.

mod desk;

use desk::Desk;
use maulstick_painting::edits::{Clean, Redo, Reshape, Undo};
use maulstick_types::stylus::{StylusPose, StylusSample, axes};
use maulstick_types::values::BrushName;

const MS: u64 = 1_000_000;

type Set = Vec<[f32; 2]>;

impl Desk {
    /// Holds a pen over the canvas, or presses it.
    fn pen(&mut self, x_m: f64, pressure: f64) {
        let sample = StylusSample {
            senses: axes::POSITION | axes::PRESSURE,
            in_range: true,
            pose: StylusPose::Contact {
                point_m: [x_m, 0.0, 0.0],
                tilt_rad: [0.4, 0.0],
                twist_rad: 0.0,
                pressure,
            },
            ..StylusSample::away()
        };
        self.now_ns += 10 * MS;
        self.offline.sample(self.now_ns, &sample).expect("painted");
    }

    fn stroke(&mut self, pressure: f64) -> Set {
        for step in 0..=20 {
            self.pen(1e-3 * f64::from(step) - 0.01, pressure);
        }
        self.pen(0.01, 0.0);
        self.set()
    }

    /// The bend of the brush in the air, as the brush says an hour later.
    fn set(&mut self) -> Set {
        self.now_ns += 3_600_000 * MS;
        self.pen(0.01, 0.0);
        self.kept()
    }

    /// The bend that the painting keeps for its brush.
    fn kept(&mut self) -> Set {
        let scene = self.offline.painting_mut().scene();
        let set = scene.set("main").map(|set| set.angles_rad.clone());
        set.unwrap_or_default()
    }

    fn edit(&mut self, edit: impl Into<maulstick_types::Edit>) -> Set {
        self.offline.edit(edit).expect("done");
        self.set()
    }

    fn close(mut self) {
        self.autosave
            .close(self.offline.sequencer_mut())
            .expect("closed");
    }
}

/// Greatest difference of two bends, rad.
fn apart(one: &Set, other: &Set) -> f32 {
    assert_eq!(one.len(), other.len());
    let angles = one.as_flattened().iter().zip(other.as_flattened());
    angles.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

#[test]
fn a_bend_is_undone_saved_and_taken_out() {
    // A thousandth of the bend.
    const SAME: f32 = 2e-5;
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("bends.maul");
    let mut desk = Desk::with(&path, "mop");
    let unbent = desk.set();
    let light = desk.stroke(0.2);
    let heavy = desk.stroke(0.8);
    assert!(apart(&light, &heavy) > 10.0 * SAME && apart(&light, &unbent) > 10.0 * SAME);
    let undo = Undo { brush: None };
    let undone = desk.edit(undo.clone());
    assert!(apart(&undone, &light) < SAME, "{}", apart(&undone, &light));
    let redone = desk.edit(Redo { brush: None });
    assert!(apart(&redone, &heavy) < SAME, "{}", apart(&redone, &heavy));
    desk.close();
    let mut again = Desk::with(&path, "mop");
    let opened = again.kept();
    assert!(apart(&opened, &heavy) < SAME, "{}", apart(&opened, &heavy));
    let undone = again.edit(undo);
    assert!(apart(&undone, &light) < SAME);
    let brush = BrushName::main();
    let reshaped = again.edit(Reshape {
        brush: brush.clone(),
    });
    assert!(apart(&reshaped, &unbent) < SAME);
    again.stroke(0.8);
    let clean = again.edit(Clean { brush });
    assert!(apart(&clean, &unbent) < SAME);
}
