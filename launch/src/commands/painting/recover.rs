//! `maulstick painting recover`.
use clap::Args;
use maulstick_rig::Fault;
/// Options.
#[derive(Args, Clone, Debug)]
pub struct RecoverOptions {}
/// Runs.
pub fn run(_: &RecoverOptions) -> Result<i32, Fault> {
    Ok(0)
}
