//! `maulstick painting export FILE`: a painting in a file for other programs.

use std::path::Path;

use indicatif::ProgressBar;
use maulstick_exchange::{ExchangeError, Format, Order};
use maulstick_paint_node::exporter::kind_of;
use maulstick_rig::config::ViewSection;
use maulstick_rig::{UserError, files};
use maulstick_types::scene::{CANVAS, PALETTE};

use maulstick_painting_setup::destination::export;
use maulstick_painting_setup::document::{read, wrong};
use maulstick_painting_setup::outputs::{UsedFile, check_outputs};
use maulstick_painting_setup::refused;

use super::ExportOptions;
use crate::commands::{progress, progress_bar, say};

/// Writes a painting for other programs, from its file.
///
/// # Errors
/// A [`UserError`] where the painting cannot be read or the file not be written.
pub(super) fn run(options: &ExportOptions, [file, out]: [&Path; 2]) -> Result<i32, UserError> {
    let (format, depth) = (options.format(out)?, options.depth());
    let view = ViewSection {
        profile: options.profile.clone().unwrap_or_else(|| "srgb".to_owned()),
        gamut: options.gamut.clone().unwrap_or_else(|| "soft".to_owned()),
    };
    let look = export(&view, "--profile, --gamut")?;
    let inputs: Vec<_> = std::iter::once(UsedFile::painting(file))
        .chain(UsedFile::given("the profile", view.file()))
        .collect();
    check_outputs(
        &[UsedFile::new("the export", out).of(kind_of(format))],
        &inputs,
    )?;
    let (_document, opened) = read(file)?;
    let mut sequencer = opened.sequencer().map_err(refused)?;
    let painting = sequencer.painting_mut();
    let surface = if options.palette { PALETTE } else { CANVAS };
    let bar = progress_bar(0).with_message("exporting");
    let mut tell = progress(&bar);
    let order = Order {
        format,
        surface,
        depth,
        export: look,
        base_mm: options.base_mm,
        exaggeration: options.exaggeration,
        step: options.step,
    };
    let said = write([file, out], format, &bar, |file| {
        order.write(painting, file, &mut tell)
    })?;
    if !said.is_empty() {
        say!("{said}");
    }
    say!("{}", out.display());
    Ok(0)
}

/// Writes the file, whole or not at all.
fn write<T>(
    [painting, out]: [&Path; 2],
    format: Format,
    bar: &ProgressBar,
    fill: impl FnOnce(&mut std::io::BufWriter<std::fs::File>) -> Result<T, ExchangeError>,
) -> Result<T, UserError> {
    let (mut made, mut failed) = (None, None);
    let written = files::write_whole(out, kind_of(format), |file| {
        match fill(file) {
            Ok(done) => made = Some(done),
            Err(ExchangeError::Write(error)) => return Err(error),
            Err(other) => {
                failed = Some(other);
                return Err(std::io::Error::other("not written"));
            }
        }
        Ok(())
    });
    bar.finish_and_clear();
    if let Some(error) = failed {
        return Err(match error {
            ExchangeError::Damaged(what) => {
                wrong(painting, &maulstick_document::DocumentError::Damaged(what))
            }
            other => UserError::usage(other.to_string()).at(out.display().to_string()),
        });
    }
    written.map_err(|error| UserError::writing(out, &error))?;
    made.ok_or_else(|| UserError::failure("nothing was written"))
}
