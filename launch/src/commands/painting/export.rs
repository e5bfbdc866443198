//! `maulstick painting export`.
use clap::Args;
use maulstick_rig::Fault;
/// Options.
#[derive(Args, Clone, Debug)]
pub struct ExportOptions {}
/// Runs.
pub fn run(_: &ExportOptions) -> Result<i32, Fault> { Ok(0) }
