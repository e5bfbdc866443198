//! Conditions of a measurement: heading, brush, paint, cells.

use maulstick_brush::BrushFile;
use maulstick_rig::UserError;

use crate::easel::{Easel, Stroke, brush};
use crate::map::Frame;

/// Conditions of a measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case {
    /// Heading of the strokes against the rows of cells, degrees.
    pub heading_deg: f64,
    /// Width of the brush by that which a row names.
    pub size: f64,
    /// The paint that is measured, and the one that it meets.
    pub paints: [&'static str; 2],
    /// Side of a cell, mm.
    pub cell_mm: f64,
}

/// An earth and a white; a blue and a yellow.
const PAINTS: [[&str; 2]; 2] = [
    ["Titanium White", "Ultramarine Blue"],
    ["Hansa Yellow Opaque", "Pyrrole Red"],
];
const HEADINGS_DEG: [f64; 3] = [0.0, 30.0, 90.0];
const SIZES: [f64; 2] = [1.0, 0.6];
const CELLS_MM: [f64; 2] = [0.125, 0.0625];

/// Three headings, two sizes of brush, two pairs of paints, two sizes of cells.
pub const CASES: [Case; 24] = {
    let mut cases = [Case {
        heading_deg: 0.0,
        size: 1.0,
        paints: PAINTS[0],
        cell_mm: CELLS_MM[0],
    }; 24];
    let mut i = 0;
    while i < 24 {
        cases[i] = Case {
            heading_deg: HEADINGS_DEG[i % 3],
            size: SIZES[i / 3 % 2],
            paints: PAINTS[i / 6 % 2],
            cell_mm: CELLS_MM[i / 12],
        };
        i += 1;
    }
    cases
};

impl Case {
    /// A brush of the library, as wide as the case has it.
    pub(crate) fn brush(&self, kind: &str, width_mm: f64) -> Result<BrushFile, UserError> {
        brush(kind, width_mm * self.size)
    }

    /// An easel for strokes of a frame, up to `reach_mm` along and across, and the frame.
    pub(crate) fn easel(
        &self,
        reach_mm: [f64; 2],
        tooth: &str,
        file: BrushFile,
    ) -> Result<(Easel, Frame), UserError> {
        const BORDER_MM: f64 = 10.0;
        let (sine, cosine) = maulstick_num::sin_cos(self.heading_deg.to_radians());
        let [along, across] = reach_mm.map(|mm| mm + BORDER_MM);
        let half = [
            along * cosine.abs() + across * sine.abs(),
            along * sine.abs() + across * cosine.abs(),
        ];
        let easel = Easel::new(half.map(|mm| (2.0 * mm).ceil()), self.cell_mm, tooth, file)?;
        let frame = Frame {
            middle: half.map(|mm| 0.5 * (2.0 * mm).ceil()),
            heading_deg: self.heading_deg,
        };
        Ok((easel, frame))
    }
}

/// A straight stroke between two places of a frame.
pub(crate) fn line(frame: Frame, from: [f64; 2], to: [f64; 2], pressure: f64) -> Stroke {
    Stroke {
        from: frame.place(from),
        to: frame.place(to),
        pressure,
        lean_deg: 25.0,
    }
}

/// Fills a band across the frame between two places along it, with strokes of a wide brush across.
pub(crate) fn fill_band(
    easel: &mut Easel,
    frame: Frame,
    paint: &str,
    [from, to]: [f64; 2],
    half_width: f64,
) -> Result<(), UserError> {
    const WIDE_MM: f64 = 13.0;
    let strokes = ((to - from) / WIDE_MM).round().max(1.0);
    for i in 0..strokes as usize {
        let at = from + (i as f64 + 0.5) * (to - from) / strokes;
        easel.load(paint)?;
        let ends = [[at, -half_width], [at, half_width]];
        easel.stroke(&line(frame, ends[0], ends[1], 0.5))?;
    }
    Ok(())
}
