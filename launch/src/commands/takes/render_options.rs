//! Options of `maulstick render`.

use std::path::PathBuf;

use clap::Args;
use maulstick_painting_setup::PaintingOptions;

/// Options of `maulstick render`.
#[derive(Args, Clone, Debug)]
pub struct RenderOptions {
    /// Take, or a recorded session
    #[arg(required_unless_present = "script", conflicts_with = "script")]
    pub(super) take: Option<PathBuf>,
    /// Script instead of a take: brushes, loads, takes, drying, light, step by step
    #[arg(long, value_name = "FILE")]
    pub(super) script: Option<PathBuf>,
    /// Picture to write, a PNG
    #[arg(short, long, value_name = "PNG")]
    pub(super) output: PathBuf,
    /// Of a recorded session, paint up to this place of the painting's journal, as `maulstick snapshot` prints it [default:
    /// its end]
    #[arg(long, value_name = "PLACE", conflicts_with = "script")]
    pub(super) until: Option<u64>,
    /// Settings of the rig
    #[arg(long, value_name = "FILE")]
    pub(super) rig: Option<PathBuf>,
    /// Colour profile: srgb, display-p3, or the ICC file of a display or printer [default: that of
    /// rig.toml]
    #[arg(long, value_name = "PROFILE")]
    pub(super) profile: Option<String>,
    /// Gamut mapping: soft, clamp [default: that of rig.toml]
    #[arg(long, value_name = "MAPPING")]
    pub(super) gamut: Option<String>,
    /// Painting to paint in and save; begun if it does not exist
    #[arg(long, value_name = "FILE")]
    pub(super) document: Option<PathBuf>,
    #[command(flatten)]
    pub(super) painting: PaintingOptions,
}
