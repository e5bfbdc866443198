//! Tables of measurements: comma-separated values (RFC 4180), a record for each figure, as in `docs/measurements`.

use std::fs::File;
use std::io::{Read as _, Write as _};
use std::path::{Path, PathBuf};

use maulstick_rig::UserError;

/// Columns of a table, its first line.
pub(crate) const COLUMNS: Record<&str> = [
    "date", "machine", "adapter", "command", "what", "value", "unit", "note",
];

/// A figure in these columns.
pub(crate) type Record<T = String> = [T; 8];

/// A table that records are appended to.
#[derive(Debug)]
pub(crate) struct Measurements {
    path: PathBuf,
    file: File,
}

impl Measurements {
    /// Opens a table, or begins one where the file is absent or empty.
    ///
    /// # Errors
    /// A [`UserError`] for a file that cannot be written, or that begins with other columns.
    pub(crate) fn open(path: &Path) -> Result<Self, UserError> {
        let fault = |error: std::io::Error| UserError::writing(path, &error);
        let file = File::options()
            .read(true)
            .append(true)
            .create(true)
            .open(path);
        let mut table = Self {
            path: path.to_owned(),
            file: file.map_err(fault)?,
        };
        let columns = line(&COLUMNS);
        let mut head = Vec::new();
        let first_line = (&table.file)
            .take(columns.len() as u64)
            .read_to_end(&mut head);
        first_line.map_err(fault)?;
        if head.is_empty() {
            table.file.write_all(columns.as_bytes()).map_err(fault)?;
        } else if head != columns.as_bytes() {
            return Err(UserError::usage("the file is no table of measurements")
                .at(path.display().to_string())
                .help(format!("its first line must be {}", columns.trim_end())));
        }
        Ok(table)
    }

    /// Appends records, all of them in one write.
    ///
    /// # Errors
    /// A [`UserError`] where the file cannot be written.
    pub(crate) fn append(&mut self, records: &[Record]) -> Result<(), UserError> {
        let text: String = records.iter().map(line).collect();
        let written = self.file.write_all(text.as_bytes());
        written.map_err(|error| UserError::writing(&self.path, &error))
    }
}

/// A record as a line.
fn line<T: AsRef<str>>(record: &Record<T>) -> String {
    let cells: Vec<String> = record.iter().map(|cell| quoted(cell.as_ref())).collect();
    cells.join(",") + "\n"
}

/// A cell, in quotes where it would not be read as one without them.
fn quoted(cell: &str) -> String {
    if cell.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", cell.replace('"', "\"\""))
    } else {
        cell.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_are_appended_below_the_columns() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("machine.csv");
        let record = |value: &str| -> Record {
            let machine = "EPYC, 2 cores";
            [
                "2026-11-27",
                machine,
                "cpu",
                "maulstick bench bus",
                "sample.p50",
                value,
                "µs",
                "",
            ]
            .map(str::to_owned)
        };
        for value in ["140", "141"] {
            let mut table = Measurements::open(&path).expect("a table");
            table.append(&[record(value)]).expect("written");
        }
        let expected = "date,machine,adapter,command,what,value,unit,note\n\
            2026-11-27,\"EPYC, 2 cores\",cpu,maulstick bench bus,sample.p50,140,µs,\n\
            2026-11-27,\"EPYC, 2 cores\",cpu,maulstick bench bus,sample.p50,141,µs,\n";
        assert_eq!(std::fs::read_to_string(&path).expect("text"), expected);
    }

    #[test]
    fn a_file_with_other_columns_stays_as_it_is() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("strokes.csv");
        std::fs::write(&path, "t,x,y\n0,1,2\n").expect("written");
        let error = Measurements::open(&path).expect_err("not its columns");
        assert!(error.to_string().contains("strokes.csv"), "{error}");
        assert_eq!(std::fs::read(&path).expect("bytes"), b"t,x,y\n0,1,2\n");
    }
}
