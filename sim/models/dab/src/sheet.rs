//! Figure 4.1 of Baxter 2004: the same strokes by both of dAb's stroking algorithms, from distant heads and from close
//! ones.

use maulstick_appearance::picture::Picture;
use maulstick_brush::{BrushFile, HeadPose};
use maulstick_model::trial::Trial;
use maulstick_model_entry::{SheetError, SheetPanel};

use crate::step::Dab;
use crate::stroke::Stroker;
use crate::volume::{OPAQUE, UNIT};

/// Width of the brush, mm, and number of its strips.
const BRUSH: (f64, usize) = (5.0, 128);
/// Distances from head to head for a fast and a slow hand, mm.
const WAYS_MM: [f64; 2] = [6.0, 1.5];
/// Panels of `dab`.
pub(crate) static PANELS: [SheetPanel; 2] = [
    SheetPanel {
        name: "stroking",
        words: "a fast hand; left: one footprint a step, right: one a cell",
        draw: |size_mm, cell_mm| panel(size_mm, WAYS_MM[0], cell_mm),
    },
    SheetPanel {
        name: "stroking",
        words: "a slow hand; left: one footprint a step, right: one a cell",
        draw: |size_mm, cell_mm| panel(size_mm, WAYS_MM[1], cell_mm),
    },
];
/// Both algorithms, in the order of the panel: from left to right.
const STROKERS: [Stroker; 2] = [Stroker::Faster, Stroker::Better];
/// Grey of bare canvas, and darkening by an opaque layer.
const GREYS: [f32; 2] = [236.0, 208.0];

/// An S that a flat brush follows while it turns: position, in its width and height, and rotation, rad.
fn at(t: f64) -> ([f64; 2], f64) {
    let (sine, _) = maulstick_num::sin_cos(6.2 * t);
    ([0.2 + 0.6 * t, 0.46 + 0.22 * sine], 2.6 * t)
}

/// The two strokes from heads at this distance, side by side; a pixel a cell.
fn panel(size_mm: [f64; 2], way_mm: f64, cell_mm: f64) -> Result<Picture, SheetError> {
    let [width, height] = size_mm.map(|mm| (mm / cell_mm).round() as usize);
    let half = width / 2;
    let mut rgb = vec![0; 3 * width * height];
    for (place, stroker) in STROKERS.into_iter().enumerate() {
        let grey = stroke(stroker, (half, height), [way_mm, cell_mm])?;
        for y in 0..height {
            for x in 0..half.min(width - place * half) {
                let value = grey(x, height - 1 - y);
                rgb[3 * (y * width + place * half + x)..][..3].fill(value);
            }
        }
    }
    Ok(Picture::srgb(width, height, rgb))
}

/// Grey of each cell after a stroke.
fn stroke(
    stroker: Stroker,
    (width, height): (usize, usize),
    [way_mm, cell_mm]: [f64; 2],
) -> Result<impl Fn(usize, usize) -> u8, SheetError> {
    let mut file = BrushFile::library("flat")?;
    file.strips.count = BRUSH.1;
    let file = file.scaled_to(BRUSH.0)?;
    let trial = Trial::new(file, width.max(height) as u32, 1e-3 * cell_mm);
    let mut trial = trial.ok_or(SheetError::TooLarge)?;
    let size = [width, height].map(|cells| cells as f64);
    // The S is about twice as long as it is wide.
    let heads = (1.2 * size[0] * cell_mm / way_mm).ceil() as usize;
    let head = |i: usize| {
        let (place, turn) = at(i as f64 / heads as f64);
        trial.pose([place[0] * size[0], place[1] * size[1]], turn)
    };
    let poses: Vec<HeadPose> = (0..=heads).map(head).collect();
    trial.stroke(&mut Dab::stroking(stroker), &poses);
    let width = trial.window.width();
    let plane = trial.window.plane(1).unwrap_or_default().to_vec();
    let [bare, darker] = GREYS;
    Ok(move |x: usize, y: usize| {
        let lies = plane.get(y * width + x).copied().unwrap_or(0.0);
        (bare - darker * (lies / (OPAQUE * UNIT)).min(1.0)) as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pixels that differ between the halves of a panel, and those of the left half that are painted.
    fn differ(way_mm: f64) -> [usize; 2] {
        let panel = panel([40.0, 24.0], way_mm, 0.25).expect("a panel");
        let half = panel.width / 2;
        let pixel = |x: usize, y: usize| panel.rgb[3 * (y * panel.width + x)];
        let cells = || (0..panel.height).flat_map(|y| (0..half).map(move |x| (x, y)));
        let differ = cells().filter(|(x, y)| pixel(*x, *y) != pixel(half + x, *y));
        let painted = cells().filter(|(x, y)| pixel(*x, *y) < 100);
        [differ.count(), painted.count()]
    }

    #[test]
    fn the_algorithms_differ_most_where_the_hand_is_fast() {
        let [fast, slow] = WAYS_MM.map(differ);
        assert!(fast[1] > 500 && slow[1] > 500, "{fast:?} {slow:?}");
        assert!(fast[0] > 50, "{fast:?}");
    }
}
