//! Curves over two axes, drawn on a page.

use maulstick_appearance::picture::Picture;
use maulstick_rig::UserError;

use crate::page::Page;

/// Colours of successive curves, from Okabe and Ito's palette for colour-blind readers.
const COLOURS: [[u8; 3]; 7] = [
    [0, 114, 178],
    [213, 94, 0],
    [0, 158, 115],
    [204, 121, 167],
    [86, 180, 233],
    [230, 159, 0],
    [40, 36, 33],
];
const GRID: [u8; 3] = [222, 217, 208];
const AXIS: [u8; 3] = [120, 112, 104];
/// Size of the words and of the title, pixels.
const WORDS: f32 = 18.0;
const TITLE: f32 = 22.0;
/// Margins of a panel, pixels: left, top, right, bottom.
const MARGIN: [usize; 4] = [92, 64, 110, 66];
/// A panel within its margins, pixels.
const PANEL: [usize; 2] = [560, 420];

/// Label and range of an axis.
#[derive(Clone, Debug)]
pub struct Axis {
    /// Its name with its unit.
    pub label: String,
    /// Its ends.
    pub range: [f64; 2],
}

/// A curve.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Name for the legend.
    pub name: String,
    /// Its points, in the units of the axes.
    pub points: Vec<[f64; 2]>,
}

/// One pair of axes with its curves.
#[derive(Clone, Debug)]
pub struct Panel {
    /// Title.
    pub title: String,
    /// To the right.
    pub x: Axis,
    /// Upward.
    pub y: Axis,
    /// The curves.
    pub curves: Vec<Curve>,
}

/// The ends of an axis from 0 that contains all `values`, with a margin.
#[must_use]
pub fn from_zero(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let most = values.fold(0.0, f64::max);
    [0.0, if most > 0.0 { 1.05 * most } else { 1.0 }]
}

/// Panels beside each other.
///
/// # Errors
/// A [`UserError`] where the font cannot be read.
pub fn plot(panels: &[Panel]) -> Result<Picture, UserError> {
    let width = MARGIN[0] + PANEL[0] + MARGIN[2];
    let mut page = Page::new(width * panels.len(), MARGIN[1] + PANEL[1] + MARGIN[3])?;
    for (number, panel) in panels.iter().enumerate() {
        draw(&mut page, panel, number * width);
    }
    Ok(page.done())
}

fn draw(page: &mut Page, panel: &Panel, left: usize) {
    let [x0, y0] = [left + MARGIN[0], MARGIN[1] + PANEL[1]];
    let share = |axis: &Axis, value: f64| {
        let [low, high] = axis.range;
        (value - low) / (high - low)
    };
    let across = |value: f64| x0 as f32 + (share(&panel.x, value) * PANEL[0] as f64) as f32;
    let upward = |value: f64| y0 as f32 - (share(&panel.y, value) * PANEL[1] as f64) as f32;
    let [right, top] = [(x0 + PANEL[0]) as f32, (y0 - PANEL[1]) as f32];
    let [x, y] = [x0 as f32, y0 as f32];
    for tick in ticks(panel.x.range) {
        let at = across(tick);
        page.line([at, y], [at, top], 1.0, GRID);
        let words = number(tick, panel.x.range);
        let from = at as usize - page.length(&words, WORDS) / 2;
        page.write(&words, [from, y0 + 22], WORDS);
    }
    for tick in ticks(panel.y.range) {
        let at = upward(tick);
        page.line([x, at], [right, at], 1.0, GRID);
        let words = number(tick, panel.y.range);
        let from = x0 - 8 - page.length(&words, WORDS);
        page.write(&words, [from, at as usize + 6], WORDS);
    }
    page.line([x, y], [right, y], 1.5, AXIS);
    page.line([x, y], [x, top], 1.5, AXIS);
    page.write(&panel.title, [x0, MARGIN[1] - 24], TITLE);
    let from = x0 + (PANEL[0] - page.length(&panel.x.label, WORDS)) / 2;
    page.write(&panel.x.label, [from, y0 + 50], WORDS);
    let from = y0 - (PANEL[1] - page.length(&panel.y.label, WORDS)) / 2;
    page.write_up(&panel.y.label, [left + 26, from], WORDS);
    for (place, curve) in panel.curves.iter().enumerate() {
        let colour = COLOURS[place % COLOURS.len()];
        for pair in curve.points.windows(2) {
            let [from, to] = [pair[0], pair[1]].map(|[a, b]| [across(a), upward(b)]);
            page.line(from, to, 2.5, colour);
        }
        // Beside the panel: no curve crosses it.
        let line = (MARGIN[1] + 10 + 26 * place) as f32;
        page.line([right + 14.0, line], [right + 38.0, line], 2.5, colour);
        page.write(&curve.name, [right as usize + 46, line as usize + 6], WORDS);
    }
}

/// Round places of an axis: steps of 1, 2 or 5 by a power of ten, five to ten of them.
fn ticks([low, high]: [f64; 2]) -> Vec<f64> {
    let step = step([low, high]);
    let (first, last) = ((low / step).ceil() as i64, (high / step).floor() as i64);
    (first..=last).map(|i| i as f64 * step).collect()
}

fn step([low, high]: [f64; 2]) -> f64 {
    let mut step = 1e-9;
    for factor in [2.0, 2.5, 2.0].into_iter().cycle() {
        if (high - low) / step <= 10.0 {
            break;
        }
        step *= factor;
    }
    step
}

/// A tick in as few digits as its steps need.
fn number(tick: f64, range: [f64; 2]) -> String {
    let digits = (0..9).find(|d| step(range) * 10f64.powi(*d) > 0.999);
    format!("{tick:.*}", digits.unwrap_or(9) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round() {
        let told = |range| {
            ticks(range)
                .iter()
                .map(|tick| number(*tick, range))
                .collect::<Vec<_>>()
                .join(" ")
        };
        assert_eq!(told([0.0, 40.0]), "0 5 10 15 20 25 30 35 40");
        assert_eq!(told([0.0, 0.93]), "0.0 0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8 0.9");
        assert_eq!(told([0.0, 525.0]), "0 100 200 300 400 500");
    }

    #[test]
    fn a_curve_is_drawn_in_its_colour_within_its_axes() {
        let axis = |label: &str| Axis {
            label: label.into(),
            range: [0.0, 1.0],
        };
        let panel = Panel {
            title: "A line".into(),
            x: axis("depth (mm)"),
            y: axis("force (N)"),
            curves: vec![Curve {
                name: "0°".into(),
                points: vec![[0.0, 0.0], [1.0, 1.0]],
            }],
        };
        let picture = plot(&[panel]).expect("a picture");
        let pixel = |x: usize, y: usize| {
            let at = 3 * (y * picture.width + x);
            [0, 1, 2].map(|i| picture.rgb[at + i])
        };
        let [middle_x, middle_y] = [MARGIN[0] + PANEL[0] / 2, MARGIN[1] + PANEL[1] / 2];
        assert_eq!(pixel(middle_x, middle_y), COLOURS[0]);
        assert_ne!(pixel(middle_x, middle_y + 40), COLOURS[0]);
    }
}
