//! The brush's solver, beside slsqp; a whole head; its strips.
//!
//! | module | holds |
//! | --- | --- |
//! | [`stroke`] | the seeded stroke that all follow |
//! | [`angles`] | the same energy for a general optimiser |
//! | [`spine`] | one spine |
//! | [`head`] | a brush of the library |

mod angles;
mod head;
mod spine;
mod stroke;

use maulstick_rig::UserError;

use crate::report::Report;

/// Measures and reports.
pub(crate) fn run(report: &mut Report) -> Result<(), UserError> {
    for joints in [3, 5, 10] {
        spine::beside_slsqp(report, joints)?;
    }
    spine::throughput(report);
    head::run(report)
}
