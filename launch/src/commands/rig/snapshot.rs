//! `maulstick snapshot`: the picture of a running rig as a file.

use std::path::PathBuf;

use clap::Args;
use maulstick_rig::UserError;
use maulstick_rig::files::Kind;
use maulstick_types::command::TakeCommand;

use crate::commands::client::{Client, Target};
use crate::commands::say;
use crate::outputs::{Relayed, UsedFile, check_outputs};

/// Options of `maulstick snapshot`.
#[derive(Args, Clone, Debug)]
pub struct SnapshotOptions {
    /// Picture to write, a PNG
    #[arg(short, long, value_name = "PNG")]
    output: PathBuf,
    /// Ledger of the paint to write, JSON
    #[arg(long, value_name = "FILE")]
    ledger: Option<PathBuf>,
    #[command(flatten)]
    target: Target,
}

/// Has the picture of the canvas written.
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
    let said = Client::command(&options.target, command)?;
    if let Some(ledger) = ledger {
        ledger.arrive("")?;
    }
    say!("{}", picture.arrive(&said)?);
    Ok(0)
}
