//! Command of `maulstick-recover`.

use std::path::PathBuf;

use clap::{Args, Subcommand};

/// The group of the command.
#[derive(Debug, Subcommand)]
pub enum RecoverGroup {
    /// Paintings
    #[command(subcommand)]
    Painting(RecoverCommand),
}

/// The command in its group.
#[derive(Debug, Subcommand)]
pub enum RecoverCommand {
    /// Recover what is intact in a damaged painting
    Recover(RecoverOptions),
}

/// Options of `maulstick painting recover`.
#[derive(Args, Clone, Debug)]
pub struct RecoverOptions {
    /// Damaged painting, which is not changed
    pub file: PathBuf,
    /// Painting to write
    #[arg(short, long, value_name = "NEW.maul")]
    pub output: PathBuf,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}
