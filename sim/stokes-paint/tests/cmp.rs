//! Compared with impasto.
use maulstick_brush::{BrushFile, Head};
use maulstick_canvas::{relief::Relief, store::TileStore, window::Window};
use maulstick_model::brush::head::Waypoint;
use maulstick_model::brush::load::{BrushLoad, Half};
use maulstick_model::brush::{scale::Scale, traits::BrushTraits};
use maulstick_model::interface::{Handling, PaintModel, Step};
use maulstick_model::path::PathStepper;
use maulstick_types::{Pose, brush::Solve};
const SCALE: Scale = Scale {
    cell_m: 2.5e-4,
    zoom: 1.0,
};
fn run(model: &mut dyn PaintModel, ground: f32, height: f64, load_it: bool) {
    let file = BrushFile::library("round").unwrap();
    let head = Head::of(&file);
    let tooth_on = true;
    let _ = tooth_on;
    let mut store = TileStore::new([192; 2]);
    let all = store.around([0, 0], [192; 2]).unwrap();
    let mut window = Window::open(
        &mut store,
        all,
        &Relief::new(
            maulstick_canvas::relief::tooth::Tooth::new("linen", 1, SCALE.cell_m).unwrap(),
            SCALE.cell_m,
        ),
    )
    .unwrap();
    window.plane_mut(3).fill(ground * 167772.0);
    let traits = BrushTraits::of(&file, SCALE.cell_m, SCALE.zoom);
    let mut load = BrushLoad::clean(head.strips());
    if load_it {
        load.fill(&head, &traits, &[(0, 1.0)], None, (Half::Both, 1));
    }
    let at = |x_m: f64| {
        let solve = Solve {
            event_ns: 0,
            stroke: 1,
            surface: 0,
            flags: 0,
            pose: Pose {
                position_m: [x_m, 0.016, height * file.length_m()],
                ..Pose::IDENTITY
            },
            zoom: 1.0,
            angles_rad: vec![[0.2, 0.3]; file.spines.all_joints()],
            contacts: Vec::new(),
        };
        Waypoint::of(&solve, SCALE, 1.0)
    };
    let mut path = PathStepper::begin(&head, at(0.004), SCALE);
    let t = std::time::Instant::now();
    let mut n = 0;
    path.advance(&head, (at(0.020), 0), |sweep, _| {
        n += 1;
        model.step(&mut Step {
            window: &mut window,
            head: &head,
            sweep,
            bounds: ([0, 0], [192; 2]),
            load: &mut load,
            traits,
            handling: Handling::default(),
            stain: 0.0,
            lasting: false,
            thinner: None,
        });
    });
    let e = t.elapsed();
    let mut max = 0.0f32;
    let mut min = f32::MAX;
    for c in 0..192 * 192 {
        max = max.max(window.total(c));
        min = min.min(window.total(c));
    }
    let left: f32 = window.plane(0).map_or(0.0, |p| p.iter().sum());
    println!(
        "{} ground {ground} height {height}: steps {n} {:?}/step laid {:.2e} max {:.2} min {:.2}",
        model.name(),
        e / n,
        left,
        max / 167772.0,
        min / 167772.0
    );
    let best = (0..192 * 192)
        .max_by(|a, b| window.total(*a).total_cmp(&window.total(*b)))
        .unwrap();
    let (bx, by) = (best % 192, best / 192);
    println!(
        "  at {bx} {by}, blue there {:.2}",
        window.plane(0).map_or(0.0, |p| p[best] / 167772.0)
    );
    for y in by.saturating_sub(4)..(by + 5).min(192) {
        let r: Vec<String> = (bx.saturating_sub(6)..(bx + 7).min(192))
            .map(|x| format!("{:.1}", window.total(y * 192 + x) / 167772.0))
            .collect();
        println!("  y{y}: {}", r.join(" "));
    }
    for x in [60, 70, 80, 90, 100, 110, 120, 130, 140] {
        let r: Vec<String> = (30..110)
            .step_by(2)
            .map(|y| format!("{:.1}", window.total(y * window.width() + x) / 167772.0))
            .collect();
        println!("  x{x}: {}", r.join(" "));
    }
}
#[test]
fn compare() {
    for (g, h) in [(0.0, 0.65), (2.0, 0.65)] {
        for l in [true] {
            run(&mut maulstick_impasto::Impasto::default(), g, h, l);
            run(&mut maulstick_stokes_paint::StokesPaint::default(), g, h, l);
        }
    }
}
