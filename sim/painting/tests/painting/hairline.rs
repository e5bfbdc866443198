//! A fude that is hardly pressed draws hairlines.

use maulstick_brush::BrushFile;
use maulstick_painting::picture::picture;
use maulstick_types::scene::CANVAS;

use crate::studio::Drawing;

const CELL_MM: f64 = 0.0625;
const SIZE_MM: [f64; 2] = [28.0, 8.0];
/// A cell is painted where its red is below this: bare ground is at 235 and more.
const PAINTED: u8 = 190;

/// Widths of a line from left to right at a pressure, mm, from thin to wide.
fn widths(file: BrushFile, pressure: f64) -> Vec<f64> {
    let mut drawing = Drawing::new(file, SIZE_MM, CELL_MM);
    for step in 0..70u64 {
        let pressure = if step == 0 { 0.0 } else { pressure };
        drawing.sample(8 * step, 3e-4 * step as f64 - 0.011, [0.0, pressure], 1);
    }
    let shown = picture(drawing.sequencer.painting_mut(), CANVAS);
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
