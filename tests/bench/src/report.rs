//! Rows and their table.

use std::io::Write as _;

use maulstick_rig::UserError;
use serde::Serialize;

/// One measured number, with that of a peer measured in the same run.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Row {
    name: String,
    value: f64,
    unit: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    peer: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    peer_value: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    ratio: Option<f64>,
}

/// What was measured, and on what.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Report {
    machine: String,
    adapter: String,
    rows: Vec<Row>,
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
        }
    }

    /// What else it was measured on.
    pub(crate) fn on(&mut self, adapter: &str) {
        adapter.clone_into(&mut self.adapter);
    }

    /// A number alone.
    pub(crate) fn row(&mut self, name: &str, value: f64, unit: &'static str) {
        let name = name.to_owned();
        self.rows.push(Row {
            name,
            value,
            unit,
            peer: None,
            peer_value: None,
            ratio: None,
        });
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
        peer: (&'static str, f64),
    ) {
        self.rows.push(Row {
            name: name.to_owned(),
            value,
            unit,
            peer: Some(peer.0),
            peer_value: Some(peer.1),
            ratio: Some(value / peer.1),
        });
    }

    /// Numbers of ours and of a peer, measured in turn: the median of each, and of their ratio.
    pub(crate) fn paired(
        &mut self,
        name: &str,
        unit: &'static str,
        peer: &'static str,
        pairs: &[(f64, f64)],
    ) {
        let median =
            |of: fn(&(f64, f64)) -> f64| quantile(&sorted(pairs.iter().map(of).collect()), 0.5);
        self.rows.push(Row {
            name: name.to_owned(),
            value: median(|pair| pair.0),
            unit,
            peer: Some(peer),
            peer_value: Some(median(|pair| pair.1)),
            ratio: Some(median(|pair| pair.0 / pair.1)),
        });
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
