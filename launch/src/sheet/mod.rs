//! The sheet of brushes: each with its marks, and the six marks of one-stroke painting.
//!
//! | module | holds |
//! | --- | --- |
//! | [`effects`] | what the paint model is for |
//! | [`gesture`] | what a hand does, and how it paints |
//! | [`marks`] | the marks of a brush |
//! | [`one_stroke`] | the six marks of a double-loaded one |
//! | [`softening`] | what a blender does between two wet colours |

pub mod effects;
pub mod gesture;
pub mod marks;
pub mod one_stroke;
pub mod softening;
#[cfg(test)]
mod tests;

use maulstick_brush::BrushFile;
use maulstick_brush::file::library::LIBRARY;
use maulstick_nodes::Offline;
use maulstick_optics::PaintLibrary;
use maulstick_paint::picture::{Picture, picture};
use maulstick_paint::setup::PaintingSetup;
use maulstick_paint::{PaintRefusal, Painting};
use maulstick_rig::Fault;
use maulstick_types::Mixture;
use maulstick_types::command::Command;

use self::gesture::Hand;
use crate::page::Page;
use crate::performance::refused;

/// Cell of the marks, mm: a pixel of the sheet.
const CELL_MM: f64 = 0.25;
/// Margin and gaps, pixels.
const GAP: usize = 12;
/// Width of a brush's portrait and words, pixels.
const SIDE: usize = 210;
/// Pixels a metre of a portrait.
const PORTRAIT_SCALE: f64 = 3000.0;
/// A brush's name in its own painting.
const BRUSH: &str = "main";
/// The share of its head's length by which full pressure presses a brush in.
const DEPTH_SHARE: f64 = 0.5;
/// Width of that brush, mm.
const ONE_STROKE_MM: f64 = 13.5;
/// The two colours of a double-loaded brush.
const DOUBLE: [&str; 2] = ["Quinacridone Magenta=0.6,Pyrrole Red=0.4", "Titanium White"];

/// A panel being painted.
struct Panel {
    offline: Offline,
    hand: Hand,
}

impl Panel {
    fn new(
        size_mm: [f64; 2],
        ground: &str,
        file: BrushFile,
        library: PaintLibrary,
    ) -> Result<Self, Fault> {
        let setup = PaintingSetup {
            ground: ground.to_owned(),
            cells: size_mm.map(|mm| (mm / CELL_MM) as u32),
            cell_m: 1e-3 * CELL_MM,
            ..PaintingSetup::default()
        };
        let painting = Painting::new(&setup, library).map_err(refused)?;
        let offline =
            Offline::new(painting, BRUSH, file, DEPTH_SHARE, Vec::new()).map_err(refused)?;
        Ok(Self {
            offline,
            hand: Hand::over(size_mm),
        })
    }

    fn load(&mut self, brush: &str, mixture: &str) -> Result<(), Fault> {
        let command = Command::Load {
            brush: brush.to_owned(),
            mixture: mixture_of(mixture)?,
        };
        self.offline.command(command).map_err(refused)
    }

    fn paint(&mut self, gesture: &gesture::Gesture) -> Result<(), Fault> {
        self.hand.paint(&mut self.offline, gesture).map_err(refused)
    }

    fn picture(mut self) -> Picture {
        picture(self.offline.painting_mut(), maulstick_types::scene::CANVAS)
    }
}

fn mixture_of(text: &str) -> Result<Mixture, Fault> {
    let error = |error| {
        refused(PaintRefusal::paint(maulstick_optics::PaintError::Mixture(
            error,
        )))
    };
    text.parse().map_err(error)
}

/// The marks of one brush.
///
/// # Errors
/// A [`Fault`] where a brush or a paint is refused.
pub fn brush_panel(file: &BrushFile, library: PaintLibrary) -> Result<Picture, Fault> {
    let mut panel = Panel::new(marks::PANEL_MM, "gesso", file.clone(), library)?;
    for mark in marks::marks(file) {
        if let Some(mixture) = mark.load {
            panel.load(BRUSH, mixture)?;
        }
        panel.paint(&mark.gesture)?;
    }
    Ok(panel.picture())
}

/// The six marks of a double-loaded brush.
///
/// # Errors
/// As [`brush_panel`].
pub fn one_stroke_panel(file: &BrushFile, library: PaintLibrary) -> Result<Picture, Fault> {
    let mut panel = Panel::new(one_stroke::PANEL_MM, "grey", file.clone(), library)?;
    for gesture in one_stroke::marks(file.head.width_mm) {
        let command = Command::LoadBeside {
            brush: BRUSH.to_owned(),
            left: mixture_of(DOUBLE[0])?,
            right: mixture_of(DOUBLE[1])?,
        };
        panel.offline.command(command).map_err(refused)?;
        panel.paint(&gesture)?;
    }
    Ok(panel.picture())
}

/// Two wet colours, softened on the right by a blender.
///
/// # Errors
/// As [`brush_panel`].
pub fn softening_panel(blender: &BrushFile, library: PaintLibrary) -> Result<Picture, Fault> {
    let flat = library_brush("flat")?;
    let mut panel = Panel::new(softening::PANEL_MM, "gesso", flat, library)?;
    for (mixture, gesture) in softening::bands() {
        panel.load(BRUSH, mixture)?;
        panel.paint(&gesture)?;
    }
    panel
        .offline
        .take_up("blender", blender.clone(), DEPTH_SHARE)
        .map_err(refused)?;
    for gesture in softening::sweeps() {
        panel.paint(&gesture)?;
    }
    Ok(panel.picture())
}

fn library_brush(kind: &str) -> Result<BrushFile, Fault> {
    BrushFile::library(kind).map_err(|error| Fault::failure(error.to_string()))
}

/// The whole sheet; `told` hears of each panel.
///
/// # Errors
/// As [`brush_panel`].
pub fn sheet(library: &PaintLibrary, mut told: impl FnMut(usize, usize)) -> Result<Picture, Fault> {
    let pixels = |mm: f64| (mm / CELL_MM) as usize;
    let across = pixels(marks::PANEL_MM[0]);
    let (row, wide_row) = (pixels(marks::PANEL_MM[1]), pixels(one_stroke::PANEL_MM[1]));
    let soft_row = pixels(softening::PANEL_MM[1]);
    let double = ["flat", "filbert"];
    let blenders = ["badger", "chisel"];
    let panels = LIBRARY.len() + double.len() + blenders.len();
    let width = SIDE + across + 2 * GAP;
    let height = GAP
        + LIBRARY.len() * (row + GAP)
        + double.len() * (wide_row + GAP)
        + blenders.len() * (soft_row + GAP);
    let mut page = Page::new(width, height)?;
    let mut y = GAP;
    let mut done = 0;
    let mut tell = || {
        done += 1;
        told(done, panels);
    };
    for (kind, _) in LIBRARY {
        let file = library_brush(kind)?;
        let head = maulstick_ui::portrait::portrait(&file, SIDE - 80, row, PORTRAIT_SCALE);
        page.portray(&head, [75, y]);
        page.write(kind, [GAP, y + 26], 24.0);
        page.write(&format!("{} mm", file.head.width_mm), [GAP, y + 48], 16.0);
        page.paste(&brush_panel(&file, library.clone())?, [SIDE + GAP, y]);
        y += row + GAP;
        tell();
    }
    for kind in double {
        let file = library_brush(kind)?
            .scaled_to(ONE_STROKE_MM)
            .map_err(|error| Fault::failure(error.to_string()))?;
        let words = [
            "one stroke",
            &format!("double-loaded {kind}"),
            "petal, leaf, shell,",
            "comma, chisel line,",
            "C-stroke",
        ];
        caption(&mut page, &words, y);
        page.paste(&one_stroke_panel(&file, library.clone())?, [SIDE + GAP, y]);
        y += wide_row + GAP;
        tell();
    }
    for kind in blenders {
        let file = library_brush(kind)?;
        let words = [
            "softening",
            &format!("two wet colours, {kind}"),
            "drawn over the right half",
        ];
        caption(&mut page, &words, y);
        page.paste(&softening_panel(&file, library.clone())?, [SIDE + GAP, y]);
        y += soft_row + GAP;
        tell();
    }
    Ok(page.done())
}

fn caption(page: &mut Page, words: &[&str], y: usize) {
    let Some((title, lines)) = words.split_first() else {
        return;
    };
    page.write(title, [GAP, y + 26], 24.0);
    for (i, line) in lines.iter().enumerate() {
        page.write(line, [GAP, y + 50 + 20 * i], 16.0);
    }
}
