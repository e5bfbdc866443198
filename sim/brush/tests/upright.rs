//! A brush that is set down upright bends to one side and stays closed.

use glam::DVec2;
use maulstick_brush::BrushFile;
use maulstick_brush::file::library::LIBRARY;

mod desk;
mod patch;
use patch::{Bench, middle, width};

/// Greatest width in widths of the belly, while an upright brush is set down at once and drawn aside: in the first 10
/// mm and after them.
fn widest(bench: &mut Bench, aside: DVec2) -> [f64; 2] {
    let belly = 1e-3 * bench.file.head.width_mm;
    let mut at = DVec2::new(0.1, 0.1);
    bench.pen(at, [0.0; 2], 0.0);
    let mut widest = [0.0f64; 2];
    for step in 0..80 {
        let solve = bench.pen(at, [0.0; 2], 0.3);
        let across = width(&bench.patch(&solve), aside.perp());
        let part = &mut widest[usize::from(step > 20)];
        *part = part.max(across / belly);
        at += aside * 5e-4;
    }
    widest
}

#[test]
fn an_upright_head_stays_closed() {
    for (kind, _) in LIBRARY {
        for aside in [DVec2::X, DVec2::NEG_Y, DVec2::splat(0.5f64.sqrt())] {
            let [first, closed] = widest(&mut Bench::new(kind), aside);
            println!("{kind:8} {first:5.2} {closed:5.2}");
            assert!(first < 1.6, "{kind}: {first}");
            assert!(closed < 1.4, "{kind}: {closed}");
        }
    }
    let mut loose = BrushFile::library("fude").expect("fude");
    loose.spines.bond = [0.0; 2];
    let [first, _] = widest(&mut Bench::of(loose), DVec2::X);
    assert!(first > 2.0, "without bonds it would open: {first}");
}

/// A stroke and its mirror image touch mirrored patches.
#[test]
fn a_mirrored_stroke_of_an_upright_head_is_mirrored() {
    for kind in ["fude", "liner"] {
        let run = |side: f64| {
            let mut bench = Bench::new(kind);
            let mut at = DVec2::new(0.1, 0.128);
            bench.pen(at, [0.0; 2], 0.0);
            let mut middles = Vec::new();
            for step in 0..60 {
                let turn = 0.04 * f64::from(step);
                let (sine, cosine) = maulstick_num::sin_cos(turn);
                at += DVec2::new(cosine, side * sine) * 5e-4;
                let solve = bench.pen(at, [0.0; 2], 0.3);
                let patch = bench.patch(&solve);
                let middle = middle(&patch);
                middles.push(DVec2::new(middle.x, side * (middle.y - 0.128)));
            }
            middles
        };
        let (one, two) = (run(1.0), run(-1.0));
        let apart = one.iter().zip(&two).map(|(a, b)| (*a - *b).length());
        let apart = apart.fold(0.0, f64::max);
        println!("{kind:8} {:.2} mm", 1e3 * apart);
        assert!(apart < 3e-4, "{kind}: {apart}");
    }
}
