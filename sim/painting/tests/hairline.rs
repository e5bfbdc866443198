//! A fude that is hardly pressed draws hairlines.

use maulstick_brush::{BrushFile, BrushModel};
use maulstick_optics::PaintLibrary;
use maulstick_painting::picture::picture;
use maulstick_painting::{Painting, PaintingSetup, Sequencer};
use maulstick_types::brush::BrushState;
use maulstick_types::edits::Load;
use maulstick_types::scene::CANVAS;
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample};
use maulstick_types::values::BrushName;
use maulstick_types::{Flags, Header, Message as _, Origin};

const CELL_MM: f64 = 0.0625;
const SIZE_MM: [f64; 2] = [28.0, 8.0];
/// A cell is painted where its red is below this: bare ground is at 235 and more.
const PAINTED: u8 = 190;

/// Widths of a line from left to right at a pressure, mm, from thin to wide.
fn widths(file: BrushFile, pressure: f64) -> Vec<f64> {
    let setup = PaintingSetup {
        cells: SIZE_MM.map(|mm| (mm / CELL_MM) as u32),
        cell_m: 1e-3 * CELL_MM,
        tooth: "panel".into(),
        ..PaintingSetup::default()
    };
    let painting = Painting::new(&setup, PaintLibrary::measured().expect("whole")).expect("one");
    let mut sequencer = Sequencer::new(painting);
    let mut model = BrushModel::new(file.clone(), 0.5);
    model.set_scene(sequencer.painting_mut().scene());
    sequencer.define_brush("main", file);
    let load = Load {
        mixture: "Bone Black".parse().expect("a mixture"),
        beside: None,
        brush: BrushName::main(),
    };
    sequencer.edit(load).expect("loaded");
    for step in 0..70u64 {
        let sample = StylusSample {
            pose: StylusPose::Contact {
                point_m: [3e-4 * step as f64 - 0.011, 0.0, 0.0],
                tilt_rad: DEFAULT_TILT_RAD,
                twist_rad: 0.0,
                pressure: if step == 0 { 0.0 } else { pressure },
            },
            in_range: true,
            ..StylusSample::away()
        };
        let (me, event_ns) = (
            Origin {
                source: 1,
                epoch: 1,
            },
            1_000_000_000 + 8_000_000 * step,
        );
        let state = model.state(me, step, event_ns, &sample).expect("a state");
        let header = Header {
            version: BrushState::VERSION,
            schema: 0,
            source: maulstick_types::name_hash("main"),
            epoch: 1,
            flags: Flags::NONE,
            length: 0,
            seq: step,
            event_ns,
            sent_ns: event_ns,
        };
        sequencer.state("main", &header, &state).1.expect("painted");
        sequencer.drain_journal();
    }
    let shown = picture(sequencer.painting_mut(), CANVAS);
    let painted = |x: usize| {
        let column = (0..shown.height).map(|y| shown.rgb[3 * (y * shown.width + x)]);
        column.filter(|red| *red < PAINTED).count() as f64 * CELL_MM
    };
    let columns = shown.width / 4..3 * shown.width / 4;
    let mut widths: Vec<f64> = columns.map(painted).collect();
    widths.sort_by(f64::total_cmp);
    widths
}

#[test]
fn a_fude_draws_hairlines() {
    let fude = BrushFile::library("fude").expect("fude");
    let fine = widths(fude.clone(), 0.02);
    let [least, middle, most] = [0, fine.len() / 2, fine.len() - 1].map(|i| fine[i]);
    println!("{least:.2} to {most:.2} mm, in the middle {middle:.2}");
    assert!(least > 0.1 && middle <= 0.3 && most < 0.4);
    let mut blunt = fude;
    blunt.head.profile = vec![
        [0.0, 0.8],
        [0.25, 1.0],
        [0.75, 0.52],
        [0.9, 0.24],
        [1.0, 0.03],
    ];
    blunt.load.film_um = 260.0;
    let blunt = widths(blunt, 0.02);
    assert!(
        blunt[blunt.len() / 2] > 0.4,
        "a blunt point draws no hairline"
    );
}
