//! The mixing chart: every paint with every other, as painters keep one on the wall.

use maulstick_appearance::picture::Picture;
use maulstick_optics::{Blend, Coat, Paint, PaintLibrary, Viewing};
use maulstick_rig::UserError;

use maulstick::commands::colour::paints::whitest;
use maulstick::page::Page;

/// Parts of the row's and of the column's paint, from left to right.
const STEPS: [[f64; 2]; 5] = [[16.0, 1.0], [4.0, 1.0], [1.0, 1.0], [1.0, 4.0], [1.0, 16.0]];
/// Paint and white of the tint on the diagonal.
const TINT: [f64; 2] = [1.0, 10.0];
/// Width of a step, height of a patch, gap between patches, pixels.
const STEP: usize = 11;
const HEIGHT: usize = 36;
const GAP: usize = 4;
/// Margin around the chart, and height of names and of words below, pixels.
const MARGIN: usize = 18;
const NAMES: f32 = 17.0;
const WORDS: f32 = 18.0;
const LINE: usize = 26;

/// The chart of all paints.
///
/// # Errors
/// A [`UserError`] where the font cannot be read.
pub(crate) fn chart(library: &PaintLibrary, viewing: &Viewing) -> Result<Picture, UserError> {
    let paints = library.paints();
    let white = whitest(library, viewing);
    let measure = Page::new(1, 1)?;
    let lengths = paints
        .iter()
        .map(|paint| measure.length(&paint.name, NAMES));
    let name = lengths.max().unwrap_or(0) + 10;
    let cell = [STEPS.len() * STEP + GAP, HEIGHT + GAP];
    let corner = [MARGIN + name, MARGIN + name];
    let size = [0, 1].map(|i| corner[i] + paints.len() * cell[i]);
    let words = words(&white.name);
    let below = words.len() * LINE + MARGIN;
    let widest = words
        .iter()
        .map(|line| measure.length(line, WORDS) + 2 * MARGIN);
    let width = widest.fold(size[0] + MARGIN, usize::max);
    let mut page = Page::new(width, size[1] + below)?;
    let look =
        |parts: &[(&Paint, f64)]| viewing.coat(&Blend::new(parts), &Coat::masstone()).bytes();
    for (i, row) in paints.iter().enumerate() {
        let y = corner[1] + i * cell[1];
        let x = corner[0] + i * cell[0];
        let own = page.length(&row.name, NAMES);
        page.write(&row.name, [corner[0] - 10 - own, y + HEIGHT / 2 + 5], NAMES);
        let middle = STEPS.len() * STEP / 2 + 5;
        page.write_up(&row.name, [x + middle, corner[1] - 10], NAMES);
        for (j, column) in paints.iter().enumerate() {
            let x = corner[0] + j * cell[0];
            if i == j {
                let (alone, tint) = (
                    look(&[(row, 1.0)]),
                    look(&[(row, TINT[0]), (white, TINT[1])]),
                );
                page.fill([x, y], [3 * STEP, HEIGHT], alone);
                page.fill([x + 3 * STEP, y], [2 * STEP, HEIGHT], tint);
                continue;
            }
            for (step, [a, b]) in STEPS.into_iter().enumerate() {
                let colour = if i < j {
                    look(&[(row, a), (column, b)])
                } else {
                    look(&[(row, a), (column, b), (white, a + b)])
                };
                page.fill([x + step * STEP, y], [STEP, HEIGHT], colour);
            }
        }
    }
    for (i, line) in words.iter().enumerate() {
        page.write(line, [MARGIN, size[1] + (i + 1) * LINE], WORDS);
    }
    Ok(page.done())
}

/// The lines below the chart.
fn words(white: &str) -> [String; 2] {
    [
        "Each paint of a row with each paint of a column: 16, 4 and 1 parts to 1, then 1 part to 4 \
         and 16."
            .to_owned(),
        format!(
            "Above the diagonal as they are, below it with as much {} again; on it each paint alone, \
             and with {} parts of it.",
            white, TINT[1]
        ),
    ]
}
