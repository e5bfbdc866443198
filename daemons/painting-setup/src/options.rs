//! Options of a painting, and what they change in the settings of a rig.

use std::path::PathBuf;

use clap::Args;
use maulstick_optics::PaintLibrary;
use maulstick_rig::UserError;
use maulstick_rig::config::{BACKENDS, BrushSection, RigConfig};
use maulstick_types::Mixture;
use maulstick_types::limits::CELLS_MAX;
use maulstick_types::region::sides;
use thiserror::Error;

use crate::brushes::brush_file;
use crate::cells::{check_canvas, parse_cell_mm};
use crate::paints::mixture_of;

/// Tools and canvas of a painting.
#[derive(Args, Clone, Debug, Default, PartialEq)]
pub struct KitOptions {
    /// Size of the canvas in cells, such as 1024x1024
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub size: Option<[u32; 2]>,
    /// Side of a cell, mm, .02 to 2 [default: that of the take or of rig.toml; 0.125 where a take or a
    /// script is painted without either]
    #[arg(long, value_name = "MM", value_parser = parse_cell_mm, allow_negative_numbers = true)]
    pub cell_mm: Option<f64>,
    /// Brush: of rig.toml, of the library, or a brush file
    #[arg(long, value_name = "NAME")]
    pub brush: Option<String>,
    /// Mixture to load, such as "Cobalt Blue=0.7,Titanium White=0.3"; given several times, strokes load
    /// them in turn. Without a take, what the brush carries at the start
    #[arg(long, value_name = "MIX")]
    pub load: Vec<String>,
    /// Paint file of your own, as `maulstick colour fit` makes it
    #[arg(long, value_name = "FILE")]
    pub paints: Option<PathBuf>,
    /// Light: A, D50, D65, FL2, FL8, FL11, or a CSV file of nm,power
    #[arg(long, value_name = "NAME|FILE")]
    pub illuminant: Option<String>,
    /// Surroundings that gloss mirrors: even, room, window, or a picture by latitude and longitude, twice as wide as high
    #[arg(long, value_name = "NAME|FILE")]
    pub environment: Option<String>,
    /// Ground: gesso, grey, black, a CSV file of nm,reflectance, or a picture
    #[arg(long, value_name = "NAME|FILE")]
    pub ground: Option<String>,
    /// Keep the cast of the light: no white balance
    #[arg(long)]
    pub no_adapt: bool,
}

/// Options of a painting. Absent ones come from the take, else from rig.toml.
#[derive(Args, Clone, Debug, Default)]
pub struct PaintingOptions {
    /// Brush, canvas, loads and light.
    #[command(flatten)]
    pub kit: KitOptions,
    /// Memory for a painting in a file, at most, such as 512M [default: that of rig.toml]
    #[arg(long, value_name = "SIZE")]
    pub memory: Option<String>,
    /// Room for its history, at most, such as 2G; beyond that the oldest steps are merged. The painting
    /// remembers it
    #[arg(long, value_name = "SIZE")]
    pub history: Option<String>,
    /// Room for the record of what was painted, of which time lapses are made, at most, such as 512M; beyond that it
    /// begins anew, and 0 keeps none. The painting remembers it
    #[arg(long, value_name = "SIZE")]
    pub record: Option<String>,
    /// Where paint and colour are computed; auto uses a graphics processor if there is one [default: that
    /// of rig.toml]
    #[arg(long, value_name = "NAME", value_parser = BACKENDS)]
    pub backend: Option<String>,
    /// Paint model of a new painting's canvas: impasto; dab, the light one; stokes, paint with a depth; marker, an even film
    /// that nothing pushes or takes up; or auto, which is impasto and proposes dab where painting falls behind [default: that of rig.toml]
    #[arg(long, value_name = "NAME")]
    pub model: Option<String>,
    /// Ledger of the paint to write, JSON
    #[arg(long, value_name = "FILE")]
    pub ledger: Option<PathBuf>,
}

/// Text that is no size of a canvas.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum SizeError {
    /// No two numbers.
    #[error("'{0}' is not a size such as 1024x768")]
    Malformed(String),
    /// Too few cells, or too many.
    #[error("a canvas has 1 to {CELLS_MAX} cells either way, not {0}")]
    OutOfRange(String),
}

/// Reads `WxH`, cells.
///
/// # Errors
/// A [`SizeError`] for another text.
pub fn parse_size(text: &str) -> Result<[u32; 2], SizeError> {
    let size = sides(text).ok_or_else(|| SizeError::Malformed(text.to_owned()))?;
    if size.iter().any(|side| !(1..=CELLS_MAX).contains(side)) {
        return Err(SizeError::OutOfRange(text.to_owned()));
    }
    Ok(size)
}

impl KitOptions {
    /// Writes size, cells, brush, paints and light into the rig's settings, and returns the brush's section.
    ///
    /// # Errors
    /// A [`UserError`] for an unknown brush, with the nearest name, and for too many cells.
    pub fn apply(&self, config: &mut RigConfig) -> Result<BrushSection, UserError> {
        if let Some(cell_mm) = self.cell_mm {
            config.canvas.cell_mm = cell_mm;
        }
        if let Some(size) = self.size {
            config.canvas.width_mm = f64::from(size[0]) * config.canvas.cell_mm;
            config.canvas.height_mm = f64::from(size[1]) * config.canvas.cell_mm;
        }
        if self.size.is_some() || self.cell_mm.is_some() {
            check_canvas(&config.canvas)?;
        }
        if let Some(paints) = &self.paints {
            config.paint.paints = Some(paints.clone());
        }
        if let Some(illuminant) = &self.illuminant {
            config.light.illuminant.clone_from(illuminant);
        }
        if let Some(environment) = &self.environment {
            config.light.environment.clone_from(environment);
        }
        if let Some(ground) = &self.ground {
            config.canvas.ground.clone_from(ground);
        }
        config.light.adapt &= !self.no_adapt;
        let section = match &self.brush {
            None => config.brush[0].clone(),
            Some(name) => match config.brush_named(name) {
                Some(section) => section.clone(),
                None => BrushSection {
                    kind: name.clone(),
                    size_mm: None,
                    ..config.brush[0].clone()
                },
            },
        };
        brush_file(&section)?;
        if let Some(place) = config
            .brush
            .iter()
            .position(|brush| brush.name == section.name)
        {
            config.brush[place] = section.clone();
        }
        Ok(section)
    }

    /// The first of the options that only a new painting takes.
    #[must_use]
    pub fn for_a_new_one(&self) -> Option<&'static str> {
        let given = [
            (self.size.is_some(), "--size"),
            (self.cell_mm.is_some(), "--cell-mm"),
            (self.paints.is_some(), "--paints"),
            (self.illuminant.is_some(), "--illuminant"),
            (self.environment.is_some(), "--environment"),
            (self.ground.is_some(), "--ground"),
            (self.no_adapt, "--no-adapt"),
        ];
        given
            .into_iter()
            .find(|(given, _)| *given)
            .map(|(_, name)| name)
    }

    /// The loads, each with the paints' names as the library spells them; `embedded` are those of the
    /// take, where the options have none.
    ///
    /// # Errors
    /// A [`UserError`] for a bad mixture or an unknown paint, with the nearest name.
    pub fn mixtures(
        &self,
        embedded: &[String],
        library: &PaintLibrary,
    ) -> Result<Vec<Mixture>, UserError> {
        let (loads, whose) = if self.load.is_empty() {
            (embedded, "the take's load")
        } else {
            (self.load.as_slice(), "--load")
        };
        let mixture = |text: &String| {
            mixture_of(text, library).map_err(|fault| fault.at(format!("{whose} {text:?}")))
        };
        loads.iter().map(mixture).collect()
    }
}

impl PaintingOptions {
    /// The first of the options that only a new painting takes.
    #[must_use]
    pub fn for_a_new_one(&self) -> Option<&'static str> {
        let model = self.model.as_ref().map(|_| "--model");
        model.or_else(|| self.kit.for_a_new_one())
    }

    /// [`KitOptions::apply`] with memory, history, record, backend and paint model.
    ///
    /// # Errors
    /// As there, and for invalid sizes.
    pub fn apply(&self, config: &mut RigConfig) -> Result<BrushSection, UserError> {
        if let Some(memory) = &self.memory {
            config.paint.memory.clone_from(memory);
        }
        if let Some(backend) = &self.backend {
            config.paint.backend.clone_from(backend);
        }
        if let Some(model) = &self.model {
            config.paint.model.clone_from(model);
        }
        if self.history.is_some() {
            config.paint.history.clone_from(&self.history);
        }
        if self.record.is_some() {
            config.paint.record.clone_from(&self.record);
        }
        config.paint.room().map_err(|error| {
            UserError::usage(error.to_string())
                .at("--memory, --history, --record")
                .help("write sizes as 512M or 2G; 64M is the least memory")
        })?;
        self.kit.apply(config)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read_or_refused() {
        assert_eq!(parse_size("640x480"), Ok([640, 480]));
        for text in ["640", "x480", "0x10", "640x-1", "1e3x2", "70000x1"] {
            assert!(parse_size(text).is_err(), "{text}");
        }
    }

    #[test]
    fn a_brush_may_come_from_the_rig_the_library_or_a_file() {
        let apply = |name: &str| {
            let options = KitOptions {
                brush: Some(name.into()),
                ..Default::default()
            };
            options
                .apply(&mut RigConfig::default())
                .map(|section| (section.name, section.kind))
        };
        assert_eq!(apply("main"), Ok(("main".into(), "round".into())));
        assert_eq!(apply("round"), Ok(("main".into(), "round".into())));
        assert!(
            apply("ruond")
                .expect_err("misspelt")
                .what
                .contains("'round'")
        );
        assert!(
            apply("no/such.toml")
                .expect_err("no file")
                .what
                .contains("read")
        );
    }
}
