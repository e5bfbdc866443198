//! `maulstick painting import`: a picture as underpainting, as ground or as tooth.

use std::path::PathBuf;
use std::sync::Arc;

use clap::{Args, ValueEnum};
use maulstick_exchange::underpaint::{MOST_PAINTS, underpaint};
use maulstick_exchange::{ColourError, Image, ImportError, Support};
use maulstick_painting::{Painting, Sequencer, Wetness};
use maulstick_rig::{RigConfig, UserError};
use maulstick_session::Autosave;
use maulstick_types::scene::{CANVAS, WellKind};

use maulstick_painting_setup::document::{go_on, there, wrong};
use maulstick_painting_setup::refused;
use maulstick_painting_setup::surface::ground::GroundFile;
use maulstick_painting_setup::surface::picture::{no_picture, open_picture};
use maulstick_painting_setup::surface::tooth::{DEPTH, ToothPicture};

use crate::commands::{progress, progress_bar, say};

/// A mean ΔE₀₀ beyond which a picture is another one.
const FAR: f64 = 15.0;

/// Purpose of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Purpose {
    /// Paint, mixed for each cell to come nearest to its colour
    Underpainting,
    /// Ground, on which the paint lies
    Ground,
    /// Tooth: relief that catches paint; white is high
    Tooth,
}

/// Options of `maulstick painting import`.
#[derive(Args, Clone, Debug)]
pub struct ImportOptions {
    /// Painting
    file: PathBuf,
    /// Picture: PNG, JPEG, TIFF, OpenEXR, Radiance or OpenRaster
    picture: PathBuf,
    /// Use of the picture
    #[arg(long = "as", value_name = "PURPOSE", default_value = "underpainting")]
    purpose: Purpose,
    /// Thickness of an underpainting, µm
    #[arg(long, default_value_t = 60.0, allow_negative_numbers = true)]
    um: f64,
    /// Leave the underpainting wet [default]
    #[arg(long, conflicts_with = "dry")]
    wet: bool,
    /// Dry the underpainting to a layer of this name; what is wet dries before it, to a layer of its own
    #[arg(long, value_name = "LAYER", num_args = 0..=1, default_missing_value = "underpainting")]
    dry: Option<String>,
    /// Paint to mix the picture from; can be given several times [default: those in use in the painting and
    /// those of its palette]
    #[arg(long = "paint", value_name = "NAME")]
    paints: Vec<String>,
    /// Width of a tooth's picture on the canvas, mm; it repeats beyond [default: that of the canvas]
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    width_mm: Option<f64>,
    /// Depth of a tooth from white to black, µm
    #[arg(long, default_value_t = DEPTH, allow_negative_numbers = true)]
    depth_um: f64,
}

/// Imports a picture into a painting.
///
/// # Errors
/// A [`UserError`] where picture or painting cannot be read; the painting is then unchanged.
pub(super) fn run(options: &ImportOptions) -> Result<i32, UserError> {
    let path = &options.file;
    there(path)?;
    let image = open_picture(&options.picture)?;
    let (document, mut sequencer, since) = go_on(&RigConfig::default(), path)?;
    let autosave = Autosave::new(document, &mut sequencer, since);
    let done = match options.purpose {
        Purpose::Underpainting => options.paint(&mut sequencer, &image),
        Purpose::Ground => options.ground(&mut sequencer, image),
        Purpose::Tooth => options.tooth(&mut sequencer, image),
    };
    let closed = autosave.close(&mut sequencer);
    let said = done?;
    closed.map_err(|error| wrong(path, &error))?;
    say!("{}: {said}", path.display());
    Ok(0)
}

impl ImportOptions {
    fn fault(&self, error: &ImportError) -> UserError {
        match error {
            ImportError::Thickness(_) => UserError::usage(error.to_string()).at("--um"),
            ImportError::Paints(_) => UserError::usage(error.to_string()).at("--paint"),
            ImportError::Refused(refusal) => refused(refusal.clone()).at("--paint"),
            ImportError::Canvas(..) => UserError::usage(error.to_string())
                .at(self.file.display().to_string())
                .help("give it as a ground, which may be coarser than the cells"),
            other => no_picture(&self.picture, other),
        }
    }

    fn paint(&self, sequencer: &mut Sequencer, image: &Image) -> Result<String, UserError> {
        let painting = sequencer.painting_mut();
        let paints = if self.paints.is_empty() {
            paints_at_hand(painting)
        } else {
            self.paints.clone()
        };
        let wrong = |error: ImportError| self.fault(&error);
        let support = Support::of(painting, CANVAS, &paints).map_err(wrong)?;
        let bar = progress_bar(0).with_message("mixing");
        let found = underpaint(&support, image, self.um * 1e-6, &mut progress(&bar));
        bar.finish_and_clear();
        let found = found.map_err(wrong)?;
        let wetness = match &self.dry {
            Some(name) => Wetness::Dry { name: name.clone() },
            None => Wetness::Wet,
        };
        let painted = painting.underpaint(CANVAS, found.paints(), &wetness, found.tiles());
        painted.map_err(refused)?;
        let colour_error = found.colour_error();
        Ok(format!(
            "underpainted with {} paints; ΔE00 {:.2} in the mean, {:.1} for 95 %, {:.1} at most{}",
            found.paints().len(),
            colour_error.mean,
            colour_error.p95,
            colour_error.max,
            advice(colour_error)
        ))
    }

    fn ground(&self, sequencer: &mut Sequencer, image: Image) -> Result<String, UserError> {
        let picture = GroundFile::Picture(Arc::new(image), self.picture.display().to_string());
        let ground = picture.embed(sequencer.painting_mut())?;
        sequencer.edit(ground).map_err(refused)?;
        Ok("the picture is its ground".to_owned())
    }

    fn tooth(&self, sequencer: &mut Sequencer, image: Image) -> Result<String, UserError> {
        let file = self.picture.display().to_string();
        let picture = ToothPicture::new(image, &file, self.width_mm, self.depth_um)
            .map_err(|fault| fault.at("--width-mm, --depth-um"))?;
        let tooth = picture.embed(sequencer.painting_mut())?;
        sequencer.edit(tooth).map_err(refused)?;
        let depth_um = self.depth_um;
        Ok(format!("the picture is its tooth, {depth_um} µm deep"))
    }
}

/// Advice where the picture is hardly recognisable.
fn advice(colour_error: &ColourError) -> &'static str {
    if colour_error.mean > FAR {
        "; these paints do not make its colours: --paint NAME takes others, and `maulstick colour paints` lists them"
    } else {
        ""
    }
}

/// The paints in use and those of the palette, as many as can be mixed; those in use first.
fn paints_at_hand(painting: &Painting) -> Vec<String> {
    let scene = painting.scene();
    let used = scene.paints.iter().map(|slot| slot.name.clone());
    let wells = scene.surfaces.iter().flat_map(|surface| &surface.wells);
    let squeezed = wells.filter_map(|well| match &well.kind {
        WellKind::Paint { mixture } => Some(mixture.parts.iter().map(|part| part.paint.clone())),
        _ => None,
    });
    let mut names: Vec<String> = Vec::new();
    for name in used.chain(squeezed.flatten()) {
        if names.len() < MOST_PAINTS && !names.contains(&name) {
            names.push(name);
        }
    }
    names.sort();
    names
}

#[cfg(test)]
mod tests {
    use maulstick_optics::PaintLibrary;
    use maulstick_painting::PaintingSetup;
    use maulstick_painting::edits::{Fill, Form as _};
    use maulstick_painting::setup::PALETTE_PAINTS;

    use super::*;

    #[test]
    fn a_picture_is_mixed_from_the_palette_too_where_little_was_used() {
        let setup = PaintingSetup {
            cells: [64, 64],
            ..PaintingSetup::default()
        };
        let library = PaintLibrary::measured().expect("whole");
        let mut painting = Painting::new(&setup, library).expect("a painting");
        let palette = paints_at_hand(&painting);
        assert_eq!(palette.len(), PALETTE_PAINTS.len());
        painting
            .apply(Fill::example().expect("in range"))
            .expect("a film");
        let used: Vec<_> = painting.scene().paints.clone();
        assert!(!used.is_empty());
        let now = paints_at_hand(&painting);
        assert!(now.len() >= palette.len() && now.len() <= MOST_PAINTS);
        assert!(used.iter().all(|slot| now.contains(&slot.name)));
        assert!(palette.iter().all(|name| now.contains(name)));
    }
}
