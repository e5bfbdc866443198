//! The sheet of brushes: each with its marks, and the six marks of one-stroke painting.
//!
//! | module | holds |
//! | --- | --- |
//! | [`effects`] | effects of the paint model |
//! | [`gesture`] | a gesture of the hand, and its painting |
//! | [`marks`] | the marks of a brush |
//! | [`one_stroke`] | the six marks of a double-loaded one |
//! | [`softening`] | a blender between two wet colours |

pub(crate) mod effects;
pub(crate) mod gesture;
pub(crate) mod marks;
pub(crate) mod one_stroke;
pub(crate) mod softening;
#[cfg(test)]
mod tests;

use maulstick_appearance::picture::Picture;
use maulstick_brush::BrushFile;
use maulstick_brush::file::library::LIBRARY;
use maulstick_optics::PaintLibrary;
use maulstick_painting::edits::common;
use maulstick_painting::picture::picture;
use maulstick_painting::{Painting, PaintingSetup};
use maulstick_rig::UserError;
use maulstick_session::Offline;
use maulstick_types::Mixture;
use maulstick_ui::render::brush::thumbnail::brush_thumbnail;

use maulstick::page::Page;
use maulstick_painting_setup::refused;
use maulstick_script::paintings::Board;

use self::gesture::Hand;

/// Margin and gaps, mm.
const GAP_MM: f64 = 3.0;
/// Width of a brush's portrait and words, mm.
const SIDE_MM: f64 = 52.5;
/// Size of a portrait beside that of the brush.
const PORTRAIT_SCALE: f64 = 0.75;
/// Greatest number of pixels of a sheet.
const MOST_PIXELS: usize = 100_000_000;
/// A brush's name in its own painting.
const BRUSH: &str = "main";
/// The share of its head's length by which full pressure presses a brush in.
const DEPTH_SHARE: f64 = 0.5;
/// Width of a panel of marks, mm.
const MARKS_MM: f64 = 290.0;
/// Width of that brush, mm.
const ONE_STROKE_MM: f64 = 13.5;
/// The two colours of a double-loaded brush.
const DOUBLE: [&str; 2] = ["Quinacridone Magenta=0.6,Pyrrole Red=0.4", "Titanium White"];

/// A page laid out in mm, whose pixels are the cells of its panels.
struct Sheet {
    page: Page,
    cell_mm: f64,
}

impl Sheet {
    fn new(size_mm: [f64; 2], cell_mm: f64) -> Result<Self, UserError> {
        let [width, height] = size_mm.map(|mm| pixels(mm, cell_mm));
        if width.saturating_mul(height) > MOST_PIXELS {
            let what = format!("a sheet of {width}×{height} pixels with cells of {cell_mm} mm");
            return Err(UserError::usage(what).at("--cell-mm").help(format!(
                "choose larger cells: {} million pixels are the most",
                MOST_PIXELS / 1_000_000
            )));
        }
        let page = Page::new(width, height)?;
        Ok(Self { page, cell_mm })
    }

    fn pixels(&self, mm: f64) -> usize {
        pixels(mm, self.cell_mm)
    }

    /// A page laid out in mm, whose pixels are the cells of its panels.
    fn write(&mut self, words: &str, at_mm: [f64; 2], height_mm: f64) {
        let at = at_mm.map(|mm| self.pixels(mm));
        self.page
            .write(words, at, (height_mm / self.cell_mm) as f32);
    }

    /// Copies a picture here with its upper left corner.
    fn paste(&mut self, picture: &Picture, at_mm: [f64; 2]) {
        let at = at_mm.map(|mm| self.pixels(mm));
        self.page.paste(picture, at);
    }

    /// Copies a panel beside its words, with its upper edge here.
    fn put(&mut self, panel: &Picture, y_mm: f64) {
        self.paste(panel, [SIDE_MM + GAP_MM, y_mm]);
    }

    /// Portrait, name and width of a brush beside its panel, whose upper edge is here.
    fn portray(&mut self, kind: &str, file: &BrushFile, y_mm: f64) {
        let [across, up] = [SIDE_MM - 20.0, marks::PANEL_MM[1]].map(|mm| self.pixels(mm));
        let scale = 1e3 * PORTRAIT_SCALE / self.cell_mm;
        let head = brush_thumbnail(file, across, up, scale);
        let at = [18.75, y_mm].map(|mm| self.pixels(mm));
        self.page.portray(&head, at);
        self.write(kind, [GAP_MM, y_mm + 6.5], 6.0);
        let width = format!("{} mm", file.head.width_mm);
        self.write(&width, [GAP_MM, y_mm + 12.0], 4.0);
    }

    /// A title and lines of words beside a panel whose upper edge is here.
    fn caption(&mut self, title: &str, lines: &[&str], y_mm: f64) {
        self.write(title, [GAP_MM, y_mm + 6.5], 6.0);
        for (i, line) in lines.iter().enumerate() {
            self.write(line, [GAP_MM, y_mm + 12.5 + 5.0 * i as f64], 4.0);
        }
    }
}

/// Pixels of a length on a sheet.
fn pixels(mm: f64, cell_mm: f64) -> usize {
    (mm / cell_mm).round() as usize
}

/// A panel being painted.
struct Panel {
    offline: Offline,
    hand: Hand,
}

impl Panel {
    fn new(
        (size_mm, board): ([f64; 2], Board),
        ground: &str,
        file: BrushFile,
        library: PaintLibrary,
    ) -> Result<Self, UserError> {
        let setup = PaintingSetup {
            ground: ground.to_owned(),
            cells: size_mm.map(|mm| pixels(mm, board.cell_mm) as u32),
            cell_m: 1e-3 * board.cell_mm,
            model: board.model.name.to_owned(),
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

    fn load(&mut self, brush: &str, mixture: &str) -> Result<(), UserError> {
        self.load_beside(brush, mixture, None)
    }

    /// Loads a brush with a mixture, and its right half with another one.
    fn load_beside(
        &mut self,
        brush: &str,
        mixture: &str,
        beside: Option<&str>,
    ) -> Result<(), UserError> {
        let beside = beside.map(mixture_of).transpose()?;
        let load = common::load(brush, mixture_of(mixture)?, beside)?;
        self.offline.edit(load).map_err(refused)?;
        Ok(())
    }

    fn paint(&mut self, gesture: &gesture::Gesture) -> Result<(), UserError> {
        self.hand.paint(&mut self.offline, gesture).map_err(refused)
    }

    fn picture(mut self) -> Picture {
        picture(self.offline.painting_mut(), maulstick_types::scene::CANVAS)
    }
}

fn mixture_of(text: &str) -> Result<Mixture, UserError> {
    text.parse()
        .map_err(|error| refused(maulstick_optics::PaintError::Mixture(error)))
}

/// The marks of one brush, on cells of this side.
///
/// # Errors
/// A [`UserError`] where a brush or a paint is refused.
pub(crate) fn brush_panel(
    file: &BrushFile,
    library: PaintLibrary,
    cell_mm: f64,
) -> Result<Picture, UserError> {
    let mut panel = Panel::new(
        (marks::PANEL_MM, Board::new(cell_mm)),
        "gesso",
        file.clone(),
        library,
    )?;
    for mark in marks::marks(file) {
        if let Some(mixture) = mark.load {
            panel.load(BRUSH, mixture)?;
        }
        panel.paint(&mark.gesture)?;
    }
    Ok(panel.picture())
}

/// The six marks of a double-loaded brush, on cells of this side.
///
/// # Errors
/// As [`brush_panel`].
pub(crate) fn one_stroke_panel(
    file: &BrushFile,
    library: PaintLibrary,
    cell_mm: f64,
) -> Result<Picture, UserError> {
    let mut panel = Panel::new(
        (one_stroke::PANEL_MM, Board::new(cell_mm)),
        "grey",
        file.clone(),
        library,
    )?;
    for gesture in one_stroke::marks(file) {
        panel.load_beside(BRUSH, DOUBLE[0], Some(DOUBLE[1]))?;
        panel.paint(&gesture)?;
    }
    Ok(panel.picture())
}

/// Two wet colours, softened on the right by a blender, on cells of this side.
///
/// # Errors
/// As [`brush_panel`].
pub(crate) fn softening_panel(
    blender: &BrushFile,
    library: PaintLibrary,
    cell_mm: f64,
) -> Result<Picture, UserError> {
    let flat = library_brush("flat")?;
    let mut panel = Panel::new(
        (softening::PANEL_MM, Board::new(cell_mm)),
        "gesso",
        flat,
        library,
    )?;
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

fn library_brush(kind: &str) -> Result<BrushFile, UserError> {
    BrushFile::library(kind).map_err(|error| UserError::failure(error.to_string()))
}

/// The whole sheet, on cells of this side; `told` receives each panel's progress.
///
/// # Errors
/// As [`brush_panel`], and where it would have too many pixels.
pub(crate) fn sheet(
    library: &PaintLibrary,
    cell_mm: f64,
    mut told: impl FnMut(usize, usize),
) -> Result<Picture, UserError> {
    let double = ["flat", "filbert"];
    let blenders = ["badger", "chisel"];
    let panels = LIBRARY.len() + double.len() + blenders.len();
    let [across, row] = marks::PANEL_MM;
    let (wide_row, soft_row) = (one_stroke::PANEL_MM[1], softening::PANEL_MM[1]);
    let height = GAP_MM
        + LIBRARY.len() as f64 * (row + GAP_MM)
        + double.len() as f64 * (wide_row + GAP_MM)
        + blenders.len() as f64 * (soft_row + GAP_MM);
    let mut sheet = Sheet::new([SIDE_MM + across + 2.0 * GAP_MM, height], cell_mm)?;
    let mut y = GAP_MM;
    let mut done = 0;
    let mut tell = || {
        done += 1;
        told(done, panels);
    };
    for (kind, _) in LIBRARY {
        let file = library_brush(kind)?;
        sheet.portray(kind, &file, y);
        sheet.put(&brush_panel(&file, library.clone(), cell_mm)?, y);
        y += row + GAP_MM;
        tell();
    }
    for kind in double {
        let file = library_brush(kind)?
            .scaled_to(ONE_STROKE_MM)
            .map_err(|error| UserError::failure(error.to_string()))?;
        let words = [
            &*format!("double-loaded {kind}"),
            "petal, leaf, shell,",
            "comma, chisel line,",
            "C-stroke",
        ];
        sheet.caption("one stroke", &words, y);
        sheet.put(&one_stroke_panel(&file, library.clone(), cell_mm)?, y);
        y += wide_row + GAP_MM;
        tell();
    }
    for kind in blenders {
        let file = library_brush(kind)?;
        let words = [
            &*format!("two wet colours, {kind}"),
            "drawn over the right half",
        ];
        sheet.caption("softening", &words, y);
        sheet.put(&softening_panel(&file, library.clone(), cell_mm)?, y);
        y += soft_row + GAP_MM;
        tell();
    }
    Ok(sheet.page.done())
}
