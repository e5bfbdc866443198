//! Journal of a painting, up to its first gap.

use maulstick_document::DocumentError;
use maulstick_document::file::database::Database;
use maulstick_document::journal;
use maulstick_painting::snapshot::SequencerSnapshot;

use super::intact_rows::{IntactRows, RowAge};
use super::report::SalvageReport;

/// Writes the rows of the journal that continue the state of `sequencer` without a gap. An older state (`age`) is
/// continued by none: the tiles may include those records already.
///
/// # Errors
/// The error of SQLite.
pub(super) fn write(
    rows: &IntactRows,
    sequencer: &mut SequencerSnapshot,
    age: RowAge,
    report: &mut SalvageReport,
    database: &Database,
) -> Result<(), DocumentError> {
    let from = sequencer.serial;
    let mut next = from;
    let mut is_broken = age == RowAge::Older;
    for (first, row) in &rows.journal {
        let (first, last) = (*first as u64, row.int(1) as u64);
        if last < from {
            continue;
        }
        let records = journal::read(first, row.blob(2)).unwrap_or_default();
        let is_intact = records.last().is_some_and(|record| record.serial == last);
        let follows = first == next || (first < next && next == from);
        is_broken |= !(is_intact && follows);
        if age == RowAge::Older {
            // New records must not get the numbers of lost ones.
            sequencer.serial = sequencer.serial.max(last.saturating_add(1));
            let index = records.last().map_or(0, |record| record.next());
            sequencer.next = sequencer.next.max(index);
        }
        let count = last.saturating_sub(first.max(next)).saturating_add(1);
        if is_broken {
            report.lost_records += count
        } else {
            row.write(database)?;
            report.records += count;
            next = last + 1;
        }
    }
    Ok(())
}
