//! `maulstick snapshot`: the picture of a running rig as a file.

use std::path::PathBuf;

use clap::Args;
use maulstick_rig::UserError;
use maulstick_rig::files::Kind;
use maulstick_types::command::TakeCommand;
use serde_json::json;

use maulstick_painting_setup::outputs::{Relayed, UsedFile, check_outputs};

use crate::commands::client::{Client, Target};
use crate::commands::open::LONGEST;
use crate::commands::{print_json_line, say};

/// Options of `maulstick snapshot`.
#[derive(Args, Clone, Debug)]
pub struct SnapshotOptions {
    /// Picture to write, a PNG
    #[arg(short, long, value_name = "PNG")]
    output: PathBuf,
    /// Ledger of the paint to write, JSON
    #[arg(long, value_name = "FILE")]
    ledger: Option<PathBuf>,
    /// Print a line of JSON with the picture and its place in the painting's journal
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    target: Target,
}

/// Writes a picture of the canvas.
///
/// # Errors
/// A [`UserError`] where it cannot be written, or where no rig runs.
pub fn snapshot(options: &SnapshotOptions) -> Result<i32, UserError> {
    let picture = UsedFile::new("the picture", &options.output).of(Kind::Png);
    let ledger = UsedFile::written("the ledger", options.ledger.as_ref(), Kind::Ledger);
    let outputs: Vec<_> = std::iter::once(picture).chain(ledger).collect();
    check_outputs(&outputs, &[])?;
    let picture = Relayed::new(&options.output, Kind::Png)?;
    let ledger = options.ledger.as_ref();
    let ledger = ledger.map(|path| Relayed::new(path, Kind::Ledger));
    let ledger = ledger.transpose()?;
    let command = TakeCommand::Snapshot {
        path: picture.asked()?,
        ledger: ledger.as_ref().map(Relayed::asked).transpose()?,
    };
    let done = Client::open(&options.target)?.carry_out(command, LONGEST)?;
    if let Some(ledger) = ledger {
        ledger.arrive("")?;
    }
    let said = picture.arrive(&done.detail.to_string())?;
    if options.json {
        print_json_line(&json!({ "picture": options.output, "place": done.journal }))?;
    } else {
        say!("place {} of the painting's journal: {said}", done.journal);
    }
    Ok(0)
}
