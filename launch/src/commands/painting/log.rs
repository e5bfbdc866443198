//! `maulstick painting log`: senders, actions and times of a painting.

use std::path::PathBuf;

use clap::Args;
use maulstick_painting::edits::words::surface;
use maulstick_rig::{RigConfig, UserError, user_devices};
use maulstick_session::{Logged, LoggedWhat, painting_log};
use maulstick_types::plain;
use serde_json::{Value, json};

use maulstick_painting_setup::document::{read, wrong};

use super::log_words::{Names, words};
use super::timelapse::no_record;
use super::wall_time::{utc, utc_seconds};
use crate::commands::table::table;
use crate::commands::{print_json, print_text};

/// Greatest length of a line of the log, characters, except for JSON.
const LINE: usize = 160;

/// Options of `maulstick painting log`.
#[derive(Args, Clone, Debug)]
pub struct LogOptions {
    /// Painting
    file: PathBuf,
    /// Settings of the rig that it was painted with: its devices are called by their names [default: your own
    /// devices and those of a new rig]
    #[arg(long, value_name = "FILE")]
    rig: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Lists the actions in a painting since its record began.
///
/// # Errors
/// A [`UserError`] where it cannot be read, or has no record.
pub(super) fn run(options: &LogOptions) -> Result<i32, UserError> {
    let path = &options.file;
    let mut devices = match &options.rig {
        Some(path) => RigConfig::read(path)?.device,
        None => RigConfig::default().device,
    };
    // Devices that cannot be read now are none that stop the reading of a painting.
    let own = user_devices::path().and_then(|path| user_devices::read(&path));
    devices.extend(own.unwrap_or_default());
    let (document, opened) = read(path)?;
    if opened.beginning().is_none() {
        return Err(no_record(path));
    }
    let log = painting_log(&document, &opened).map_err(|error| wrong(path, &error))?;
    let mut names = Names::of(&devices);
    if options.json {
        let log = log.iter().map(|line| as_json(line, &mut names));
        let log: Vec<Value> = log.collect();
        print_json(&json!({ "log": log }))?;
        return Ok(0);
    }
    let rows = log.iter().map(|line| row(line, &mut names));
    let rows: Vec<[String; 3]> = rows.collect();
    print_text(&table(["time", "who", "what"], &rows))?;
    Ok(0)
}

fn row(line: &Logged, names: &mut Names) -> [String; 3] {
    let time = line.time_ms.map_or_else(String::new, utc_seconds);
    let (who, what) = match &line.what {
        LoggedWhat::Stroke(stroke) => {
            let take = if stroke.is_replayed {
                ", of a take"
            } else {
                ""
            };
            let what = format!(
                "stroke of {} on the {}, {:.1} s, {:.0} mm{take}",
                stroke.brush,
                surface(stroke.surface),
                stroke.seconds,
                1e3 * stroke.length_m
            );
            (names.device(stroke.device), what)
        }
        LoggedWhat::Command {
            client: id,
            command,
        } => (names.sender(*id), words(command, names)),
        LoggedWhat::Dropped { client: id, brush } => {
            let what = format!("undo a stroke of {brush} that was not painted yet");
            (names.sender(*id), what)
        }
        LoggedWhat::Decision(decision) => (names.sender(0), decision.to_string()),
        LoggedWhat::Brush(name) => (names.sender(0), format!("brush {name}")),
    };
    let what = match what.char_indices().nth(LINE) {
        Some((end, _)) => format!("{}…", &what[..end]),
        None => what,
    };
    [time, who, plain(&what).to_string()]
}

fn as_json(line: &Logged, names: &mut Names) -> Value {
    let mut value = match &line.what {
        LoggedWhat::Stroke(stroke) => json!({
            "kind": "stroke",
            "brush": stroke.brush,
            "device": names.device(stroke.device),
            "device_hash": format!("{:08x}", stroke.device),
            "replayed": stroke.is_replayed,
            "surface": surface(stroke.surface),
            "seconds": stroke.seconds,
            "length_m": stroke.length_m,
        }),
        LoggedWhat::Command { client, command } => {
            json!({ "kind": "command", "client": client, "command": command })
        }
        LoggedWhat::Dropped { client, brush } => {
            json!({ "kind": "dropped", "client": client, "brush": brush })
        }
        LoggedWhat::Decision(decision) => json!({ "kind": "decision", "decision": decision }),
        LoggedWhat::Brush(name) => json!({ "kind": "brush", "brush": name }),
    };
    if let Value::Object(fields) = &mut value {
        fields.insert("time".to_owned(), json!(line.time_ms.map(utc)));
    }
    value
}

#[cfg(test)]
mod tests {
    use maulstick_types::paint::Decision;

    use super::*;

    #[test]
    fn a_decision_has_its_fields_in_json_and_words_in_a_line() {
        let model = "dab".to_owned();
        let line = Logged {
            time_ms: None,
            what: LoggedWhat::Decision(Decision::LighterModel { model }),
        };
        let mut names = Names::default();
        let json = as_json(&line, &mut names);
        assert_eq!(json["decision"]["LighterModel"]["model"], "dab");
        assert_eq!(row(&line, &mut names)[2], "model dab proposed");
    }

    #[test]
    fn a_line_is_no_longer_than_a_line() {
        let line = Logged {
            time_ms: None,
            what: LoggedWhat::Brush("x".repeat(500)),
        };
        let row = row(&line, &mut Names::default());
        assert_eq!(row[2].chars().count(), LINE + 1);
    }
}
