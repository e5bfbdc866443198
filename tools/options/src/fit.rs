//! Command of `maulstick-fit`.

use std::path::PathBuf;

use clap::{Args, Subcommand};

/// The group of the command.
#[derive(Debug, Subcommand)]
pub enum FitGroup {
    /// Colours
    #[command(subcommand)]
    Colour(FitCommand),
}

/// The command in its group.
#[derive(Debug, Subcommand)]
pub enum FitCommand {
    /// Fit paints to measured reflectances
    Fit(FitOptions),
}

/// Options of `maulstick colour fit`.
#[derive(Args, Clone, Debug)]
pub struct FitOptions {
    /// Table of samples: a column of shares for each paint, a column of reflectances for each
    /// wavelength (docs/measuring.md)
    pub measurements: PathBuf,
    /// Paint file to write
    #[arg(short, long, value_name = "CSV")]
    pub output: PathBuf,
    /// Reference white, whose scattering is 1
    #[arg(long, value_name = "NAME")]
    pub white: Option<String>,
    /// Shares that the samples' surface reflects from outside and from inside
    #[arg(long, value_name = "K1,K2")]
    pub surface: Option<String>,
    /// Take the reflectances as internal: no surface correction
    #[arg(long, conflicts_with = "surface")]
    pub no_surface: bool,
    /// Take the readings as without gloss (45°/0°, 60°, or a sphere with an open trap)
    #[arg(long)]
    pub specular_excluded: bool,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}
