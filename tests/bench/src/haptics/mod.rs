//! The servo: how late it wakes beside the peer under the load of a rig, what a tick takes, and how
//! stable it is.
//!
//! | module | rows |
//! | --- | --- |
//! | [`stability`] | `grid`: the worst of the stability grid, and the fingertips that a sent force shakes |
//! | [`tick`] | `tick`: time of the processor that a tick takes, a hand in contact |
//! | [`lateness`] | `lateness`: from a tick's deadline to its first instruction, beside cyclictest |
//! | [`load`] | a rig that paints meanwhile |
//! | [`cyclictest`] | the peer |
//! | [`histogram`] | shares of late ticks, for both alike |

mod cyclictest;
mod histogram;
mod lateness;
mod load;
mod stability;
mod tick;

use maulstick_rig::UserError;

use crate::report::Report;

/// Measures and reports.
pub(crate) fn run(report: &mut Report) -> Result<(), UserError> {
    stability::run(report)?;
    tick::run(report)?;
    lateness::run(report)
}

fn fault(error: impl std::fmt::Display) -> UserError {
    UserError::failure(error.to_string())
}
