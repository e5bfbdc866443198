//! `maulstick painting import`.
use clap::Args;
use maulstick_rig::Fault;
/// Options.
#[derive(Args, Clone, Debug)]
pub struct ImportOptions {}
/// Runs.
pub fn run(_: &ImportOptions) -> Result<i32, Fault> {
    Ok(0)
}
