//! Rows and their table.

use std::io::Write as _;

use maulstick_rig::UserError;
use serde::Serialize;

use crate::measurements::Record;

/// One measured number, with that of a peer measured in the same run.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Row {
    name: String,
    value: f64,
    unit: &'static str,
    /// Reason why there is no number.
    #[serde(skip_serializing_if = "Option::is_none")]
    unmeasured: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    peer: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    peer_value: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    ratio: Option<f64>,
    #[serde(skip)]
    run: Run,
}

/// Conditions of a row.
#[derive(Clone, Debug)]
struct Run {
    command: String,
    adapter: String,
}

impl Run {
    /// A run on the processor.
    fn of(command: String) -> Self {
        let adapter = "cpu".to_owned();
        Self { command, adapter }
    }
}

/// Measured rows, and the machine.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Report {
    machine: String,
    adapter: String,
    rows: Vec<Row>,
    /// Conditions of the following rows.
    #[serde(skip)]
    run: Run,
}

impl Report {
    /// An empty report of this machine.
    pub(crate) fn new() -> Self {
        let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let model = info
            .lines()
            .find_map(|line| line.strip_prefix("model name"))
            .unwrap_or("");
        let model = model.trim_start_matches([' ', '\t', ':']);
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        Self {
            machine: format!("{model}, {cores} cores, {}", std::env::consts::OS),
            adapter: "cpu".to_owned(),
            rows: Vec::new(),
            run: Run::of("maulstick bench".to_owned()),
        }
    }

    /// The rows that follow are measured by `command`, on the processor until [`Report::on`] names another adapter.
    pub(crate) fn begin(&mut self, command: String) {
        self.run = Run::of(command);
    }

    /// Adds an adapter to the conditions.
    pub(crate) fn on(&mut self, adapter: &str) {
        adapter.clone_into(&mut self.adapter);
        adapter.clone_into(&mut self.run.adapter);
    }

    /// A number alone.
    pub(crate) fn row(&mut self, name: &str, value: f64, unit: &'static str) {
        self.push(name, (value, unit), None);
    }

    /// A number with its unit, and that of a peer with our ratio to it.
    fn push(
        &mut self,
        name: &str,
        (value, unit): (f64, &'static str),
        beside: Option<(&'static str, f64, f64)>,
    ) {
        self.rows.push(Row {
            name: name.to_owned(),
            value,
            unit,
            unmeasured: None,
            peer: beside.map(|(peer, _, _)| peer),
            peer_value: beside.map(|(_, value, _)| value),
            ratio: beside.map(|(_, _, ratio)| ratio),
            run: self.run.clone(),
        });
    }

    /// A number that cannot be had here, and why.
    pub(crate) fn unmeasured(&mut self, name: &str, why: String) {
        self.row(name, f64::NAN, "");
        if let Some(row) = self.rows.last_mut() {
            row.unmeasured = Some(why);
        }
    }

    /// The median of numbers.
    pub(crate) fn median(&mut self, name: &str, unit: &'static str, values: Vec<f64>) {
        self.row(name, quantile(&sorted(values), 0.5), unit);
    }

    /// A number and that of a peer; `ratio` is ours over theirs.
    pub(crate) fn beside(
        &mut self,
        name: &str,
        value: f64,
        unit: &'static str,
        (peer, theirs): (&'static str, f64),
    ) {
        self.push(name, (value, unit), Some((peer, theirs, value / theirs)));
    }

    /// Our numbers and a peer's, measured in turn: the median of each, and of their ratio.
    pub(crate) fn paired(
        &mut self,
        name: &str,
        unit: &'static str,
        peer: &'static str,
        pairs: &[(f64, f64)],
    ) {
        let median =
            |of: fn(&(f64, f64)) -> f64| quantile(&sorted(pairs.iter().map(of).collect()), 0.5);
        let beside = (peer, median(|pair| pair.1), median(|pair| pair.0 / pair.1));
        self.push(name, (median(|pair| pair.0), unit), Some(beside));
    }

    /// The figures in the columns of [`measurements`](crate::measurements), a record each; a row without one has none.
    pub(crate) fn records(&self, date: &str) -> Vec<Record> {
        let measured = self.rows.iter().filter(|row| row.value.is_finite());
        let record = |row: &Row| {
            let note = match (row.peer, row.peer_value, row.ratio) {
                (Some(peer), Some(value), Some(ratio)) => {
                    format!("{peer} {}, ratio {}", rounded(value), rounded(ratio))
                }
                _ => String::new(),
            };
            [
                date.to_owned(),
                self.machine.clone(),
                row.run.adapter.clone(),
                row.run.command.clone(),
                row.name.clone(),
                rounded(row.value),
                row.unit.to_owned(),
                note,
            ]
        };
        measured.map(record).collect()
    }

    /// Prints the report as JSON.
    pub(crate) fn print_json(&self) -> Result<(), UserError> {
        let text = serde_json::to_string_pretty(self)
            .map_err(|error| UserError::failure(error.to_string()))?;
        out(&(text + "\n"))
    }

    /// Prints the report as a table.
    pub(crate) fn print_table(&self) -> Result<(), UserError> {
        let mut text = format!("{}; {}\n", self.machine, self.adapter);
        for row in &self.rows {
            if let Some(why) = &row.unmeasured {
                text += &format!("{:<28} {why}\n", row.name);
                continue;
            }
            text += &format!("{:<28} {:>12} {:<8}", row.name, short(row.value), row.unit);
            if let (Some(peer), Some(value), Some(ratio)) = (row.peer, row.peer_value, row.ratio) {
                text += &format!(" {peer} {value:.4}, ratio {ratio:.3}");
            }
            text += "\n";
        }
        out(&text)
    }
}

/// Prints; a reader that has seen enough is no error.
fn out(text: &str) -> Result<(), UserError> {
    match std::io::stdout().lock().write_all(text.as_bytes()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(UserError::failure(format!("cannot print: {error}")))
        }
        _ => Ok(()),
    }
}

/// A number in four decimals, or in four digits where these would not show it.
fn short(value: f64) -> String {
    if value == 0.0 || value.abs() >= 1e-2 {
        format!("{value:.4}")
    } else {
        format!("{value:.3e}")
    }
}

/// A number in six digits.
fn rounded(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    rounded.to_string()
}

/// The value at a share of sorted ones.
pub(crate) fn quantile(sorted: &[f64], share: f64) -> f64 {
    let place = (share * (sorted.len().max(1) - 1) as f64).round() as usize;
    sorted.get(place).copied().unwrap_or(f64::NAN)
}

/// Sorts.
pub(crate) fn sorted(mut values: Vec<f64>) -> Vec<f64> {
    values.sort_by(f64::total_cmp);
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_figure_is_a_record_with_its_own_command_and_adapter() {
        let mut report = Report::new();
        report.machine = "a machine, 2 cores".into();
        report.begin("maulstick bench optics".into());
        report.beside("km.tiles_per_s", 2750.0, "tiles/s", ("memcpy", 44000.0));
        report.on("a GPU");
        report.row("relight", 0.049_000_04, "s");
        report.unmeasured("km.gpu", "no device".into());
        report.begin("maulstick bench bus".into());
        report.row("sample.p50", 1.0 / 3.0, "µs");

        let machine = "a machine, 2 cores";
        let expected = [
            [
                "cpu",
                "optics",
                "km.tiles_per_s",
                "2750",
                "tiles/s",
                "memcpy 44000, ratio 0.0625",
            ],
            ["a GPU", "optics", "relight", "0.049", "s", ""],
            ["cpu", "bus", "sample.p50", "0.333333", "µs", ""],
        ]
        .map(|[adapter, area, what, value, unit, note]| {
            let command = format!("maulstick bench {area}");
            [
                "2026-11-27",
                machine,
                adapter,
                &command,
                what,
                value,
                unit,
                note,
            ]
            .map(str::to_owned)
        });
        assert_eq!(report.records("2026-11-27"), expected);
    }
}
