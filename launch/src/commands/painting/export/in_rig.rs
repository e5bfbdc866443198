//! `maulstick painting export` without a file: the painting of a running rig for other programs, while it is painted on.

use maulstick_paint_node::exporter::kind_of;
use maulstick_rig::UserError;
use maulstick_rig::files::Kind;
use maulstick_types::command::{ExportOrder, FileCommand};
use maulstick_types::scene::{CANVAS, PALETTE};

use maulstick_painting_setup::outputs::{Relayed, UsedFile, check_outputs, named_by};

use super::ExportOptions;
use crate::commands::client::Client;
use crate::commands::open::LONGEST;
use crate::commands::say;

/// Writes the current painting through the rig.
///
/// # Errors
/// A [`UserError`] where it cannot be written, where another export is running, or where no rig runs.
pub(super) fn run(options: &ExportOptions) -> Result<i32, UserError> {
    let client = Client::open(&options.target)?;
    let Some(file) = &options.output else {
        client.send(FileCommand::StopExport)?;
        return Ok(0);
    };
    let config = client.config()?;
    let document = config.paint.document.iter();
    let inputs: Vec<_> = named_by(&config)
        .into_iter()
        .chain(document.map(|path| UsedFile::painting(path)))
        .collect();
    // The node rejects a name without a known format.
    let kind = options.known_format(file).map_or(Kind::Own, kind_of);
    check_outputs(&[UsedFile::new("the export", file).of(kind)], &inputs)?;
    let file = Relayed::new(file, kind)?;
    let command = FileCommand::Export(ExportOrder {
        format: options.format.clone().unwrap_or_default(),
        surface: if options.palette { PALETTE } else { CANVAS },
        bits: options.bits,
        base_m: options.base_mm * 1e-3,
        exaggeration: options.exaggeration,
        step: options.step.unwrap_or(0),
        profile: options.profile.clone().unwrap_or_default(),
        gamut: options.gamut.clone().unwrap_or_default(),
        ..ExportOrder::to(file.asked()?)
    });
    let done = client.send_within(command, LONGEST)?;
    say!("{}", file.arrive(&done)?);
    Ok(0)
}
