//! Appearance of paint in numbers ([`maulstick_looks`]).

use maulstick_rig::UserError;

use crate::report::Report;

/// Measures and reports.
pub(crate) fn run(report: &mut Report) -> Result<(), UserError> {
    maulstick_looks::measure(|row| match row.target {
        Some(target) => report.beside(row.name, row.value, row.unit, ("target", target)),
        None => report.row(row.name, row.value, row.unit),
    })
}
