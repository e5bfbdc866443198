//! `maulstick painting log`: who did what in a painting, and when.

use std::path::PathBuf;

use clap::Args;
use maulstick_rig::{RigConfig, UserError};
use maulstick_session::{Logged, LoggedWhat, painting_log};
use maulstick_types::scene::{CANVAS, PALETTE};
use maulstick_types::{name_hash, plain};
use serde_json::{Value, json};

use super::timelapse::no_record;
use super::wall_time::{utc, utc_seconds};
use crate::commands::table::table;
use crate::commands::{print_json, print_text};
use crate::document::{read, wrong};

/// Characters of a line of the log at most, but for JSON.
const LINE: usize = 160;

/// Options of `maulstick painting log`.
#[derive(Args, Clone, Debug)]
pub struct LogOptions {
    /// Painting
    file: PathBuf,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Lists what was done in a painting since its record began.
///
/// # Errors
/// A [`UserError`] where it cannot be read, or has no record.
pub(super) fn run(options: &LogOptions) -> Result<i32, UserError> {
    let path = &options.file;
    let (document, opened) = read(path)?;
    if opened.beginning().is_none() {
        return Err(no_record(path));
    }
    let log = painting_log(&document, &opened).map_err(|error| wrong(path, &error))?;
    if options.json {
        let log: Vec<Value> = log.iter().map(as_json).collect();
        print_json(&json!({ "log": log }))?;
        return Ok(0);
    }
    let rows: Vec<[String; 3]> = log.iter().map(row).collect();
    print_text(&table(["time", "who", "what"], &rows))?;
    Ok(0)
}

/// Name of a device by the hash of it, if it is one of those that every rig may have; else the hash.
fn device(hash: u32) -> String {
    let known = RigConfig::default().device;
    let names = known.iter().map(|device| device.name.as_str());
    let mut names = names.chain(["mouse", "player"]);
    let found = names.find(|name| name_hash(name) == hash);
    found.map_or_else(|| format!("device {hash:08x}"), str::to_owned)
}

fn surface(id: u32) -> String {
    match id {
        CANVAS => "canvas".to_owned(),
        PALETTE => "palette".to_owned(),
        other => format!("surface {other}"),
    }
}

fn client(id: u64) -> String {
    match id {
        0 => "maulstick".to_owned(),
        id => format!("client {id:016x}"),
    }
}

fn row(line: &Logged) -> [String; 3] {
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
            (device(stroke.device), what)
        }
        LoggedWhat::Command {
            client: id,
            command,
        } => {
            let value = serde_json::to_value(command).unwrap_or_default();
            (client(*id), words(value))
        }
        LoggedWhat::Dropped { client: id, brush } => {
            let what = format!("undo of a stroke of {brush} that was not painted yet");
            (client(*id), what)
        }
        LoggedWhat::Decision(what) => (client(0), what.clone()),
        LoggedWhat::Brush(name) => (client(0), format!("brush {name}")),
    };
    let what = match what.char_indices().nth(LINE) {
        Some((end, _)) => format!("{}…", &what[..end]),
        None => what,
    };
    [time, who, plain(&what).to_string()]
}

/// A command as its name and its fields.
fn words(command: Value) -> String {
    match command {
        Value::Object(fields) if fields.len() == 1 => {
            let Some((name, value)) = fields.into_iter().next() else {
                return String::new();
            };
            match &value {
                Value::Object(inner) if name == "Edit" && inner.len() == 1 => words(value),
                Value::Object(inner) if name == "Take" && inner.len() == 1 => words(value),
                Value::Object(inner) if inner.is_empty() => name,
                value => format!("{name} {value}"),
            }
        }
        Value::String(name) => name,
        other => other.to_string(),
    }
}

fn as_json(line: &Logged) -> Value {
    let mut value = match &line.what {
        LoggedWhat::Stroke(stroke) => json!({
            "kind": "stroke",
            "brush": stroke.brush,
            "device": device(stroke.device),
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
        LoggedWhat::Decision(what) => json!({ "kind": "decision", "what": what }),
        LoggedWhat::Brush(name) => json!({ "kind": "brush", "brush": name }),
    };
    if let Value::Object(fields) = &mut value {
        fields.insert("time".to_owned(), json!(line.time_ms.map(utc)));
    }
    value
}

#[cfg(test)]
mod tests {
    use maulstick_types::command::Command;
    use maulstick_types::edits::{GoTo, Undo};

    use super::*;

    #[test]
    fn commands_are_named_with_their_fields() {
        let of = |command: Command| words(serde_json::to_value(command).expect("JSON"));
        assert_eq!(of(Undo { brush: None }.into()), "Undo {\"brush\":null}");
        assert_eq!(of(GoTo { step: 7 }.into()), "GoTo {\"step\":7}");
        let line = Logged {
            time_ms: None,
            what: LoggedWhat::Decision("x".repeat(500)),
        };
        assert_eq!(row(&line)[2].chars().count(), LINE + 1);
        assert_eq!(device(name_hash("mouse")), "mouse");
        assert_eq!(device(7), "device 00000007");
    }
}
