//! The servo: its wake-up lateness compared with the peer under the load of a rig, the time of a tick, and its
//! stability.
//!
//! | module | rows |
//! | --- | --- |
//! | [`stability`] | `grid`: the worst of the stability grid, and the fingertips shaken by a force from afar |
//! | [`tick`] | `tick`: processor time of a tick with a hand in contact |
//! | [`lateness`] | `lateness`: from a tick's deadline to its first instruction, compared with cyclictest |
//! | [`load`] | a rig that paints as load |
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
