//! The bundled paintings: each a script of strokes, painted at any size of cell.

use std::path::Path;

use clap::Args;
use clap::builder::PossibleValuesParser;
use indicatif::ProgressBar;
use maulstick_brush::BrushFile;
use maulstick_models::{MODELS, ModelEntry, model_called, model_names};
use maulstick_optics::PaintLibrary;
use maulstick_painting::{Painting, PaintingSetup};
use maulstick_rig::UserError;
use maulstick_session::Offline;

use maulstick_painting_setup::cells::SheetCells;
use maulstick_painting_setup::refused;

use crate::Script;
use crate::ScriptRunner;

/// Names and scripts of the paintings.
pub const PAINTINGS: [(&str, &str); 5] = [
    ("still-life", include_str!("../paintings/still-life.toml")),
    ("flower", include_str!("../paintings/flower.toml")),
    ("landscape", include_str!("../paintings/landscape.toml")),
    ("portrait", include_str!("../paintings/portrait.toml")),
    ("wheat-field", include_str!("../paintings/wheat-field.toml")),
];

/// A brush's name until the script takes one up.
const BRUSH: &str = "main";
/// The share of its head's length by which full pressure presses that brush in.
const DEPTH_SHARE: f64 = 0.5;

/// Canvas of a bundled painting.
#[derive(Clone, Copy, Debug)]
pub struct Board {
    /// Side of a cell, mm.
    pub cell_mm: f64,
    /// The paint model.
    pub model: &'static ModelEntry,
}

impl Board {
    /// The first paint model on cells of this side, mm.
    #[must_use]
    pub fn new(cell_mm: f64) -> Self {
        Self {
            cell_mm,
            model: &MODELS[0],
        }
    }
}

/// Options of the canvas.
#[derive(Args, Clone, Debug)]
pub struct BoardOptions {
    #[command(flatten)]
    cells: SheetCells,
    /// Paint model [default: impasto]
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(model_names()))]
    model: Option<String>,
}

impl BoardOptions {
    /// The requested canvas.
    ///
    /// # Errors
    /// A [`UserError`] for an unknown model.
    pub fn board(&self) -> Result<Board, UserError> {
        let board = Board::new(self.cells.side_mm());
        let Some(model) = &self.model else {
            return Ok(board);
        };
        let model = model_called(model).map_err(refused)?;
        Ok(Board { model, ..board })
    }
}

/// The script of a painting.
///
/// # Errors
/// A [`UserError`] for a name that none has.
pub fn script(name: &str, library: &PaintLibrary) -> Result<Script, UserError> {
    let Some((_, text)) = PAINTINGS.iter().find(|(known, _)| *known == name) else {
        let names = PAINTINGS.map(|(known, _)| known);
        return Err(UserError::usage(format!("there is no painting '{name}'"))
            .help(maulstick_types::nearest::choice(name, names)));
    };
    Script::parse(text, &format!("{name}.toml"), Path::new(""), library)
}

/// Paints one of the paintings on such a board; `bar` shows how far it is.
///
/// # Errors
/// A [`UserError`] for a name that none has, or where the painting refuses a step.
pub fn paint(
    name: &str,
    board: Board,
    library: PaintLibrary,
    bar: ProgressBar,
) -> Result<Offline, UserError> {
    let script = script(name, &library)?;
    let size_mm = script.canvas_mm.ok_or_else(|| {
        UserError::failure(format!("the painting '{name}' does not say its size"))
    })?;
    let setup = PaintingSetup {
        cells: size_mm.map(|mm| (mm / board.cell_mm).round() as u32),
        cell_m: 1e-3 * board.cell_mm,
        model: board.model.name.to_owned(),
        // Strokes that go over the canvas's edge come to a clean board.
        wells: Vec::new(),
        ..PaintingSetup::default()
    };
    let painting = Painting::new(&setup, library).map_err(refused)?;
    let file = BrushFile::library("flat").map_err(|error| UserError::failure(error.to_string()))?;
    let offline = Offline::new(painting, BRUSH, file, DEPTH_SHARE, Vec::new()).map_err(refused)?;
    let mut autosave = None;
    bar.set_length(script.length_ns() / 1_000_000);
    let mut runner = ScriptRunner::new(offline, &mut autosave, bar);
    runner.follow_script(script)?;
    Ok(runner.offline)
}

#[cfg(test)]
mod tests;
