//! `maulstick echo`: the messages of a topic, as they come.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use clap::Args;
use maulstick_rig::UserError;
use maulstick_streams::{FieldTable, Value};
use maulstick_types::{CATALOGUE, HEADER_BYTES, plain};
use serde_json::json;

use super::listener::{Listener, ReceivedMessage};
use crate::commands::print_text;
use crate::commands::session::Target;

/// Options of `maulstick echo`.
#[derive(Args, Clone, Debug)]
pub struct EchoOptions {
    /// Topic, such as stylus/*/sample: * stands for one part, ** for any number
    topic: String,
    /// Print only this field, such as pose.Contact.point_m.0; may be given several times
    #[arg(long, value_name = "PATH")]
    field: Vec<String>,
    /// Print a line of JSON for each message
    #[arg(long)]
    json: bool,
    /// Print a table of comma-separated values
    #[arg(long, conflicts_with = "json")]
    csv: bool,
    /// Print one message
    #[arg(long)]
    once: bool,
    #[command(flatten)]
    target: Target,
}

/// How long `--once` waits for a message.
const PATIENCE: Duration = Duration::from_secs(10);

/// Prints messages until Ctrl-C.
///
/// # Errors
/// A [`UserError`] for a rig that does not run, or a field that a message does not have.
pub fn run(options: &EchoOptions) -> Result<i32, UserError> {
    let mut listener = Listener::open(&options.target, &options.topic)?;
    let mut printer = Printer::new(options);
    let give_up = options.once.then(|| Instant::now() + PATIENCE);
    while !listener.is_over() {
        let soon = Instant::now() + Duration::from_secs(1);
        let Some(received) = listener.next(give_up.unwrap_or(soon)) else {
            if give_up.is_some_and(|at| Instant::now() >= at) {
                let what = format!("nothing came on {} within 10 s", options.topic);
                return Err(UserError::failure(what)
                    .help("`maulstick topics` lists what the rig sends now"));
            }
            if !listener.has_rig() {
                break;
            }
            continue;
        };
        printer.print(&received)?;
        if options.once {
            break;
        }
    }
    Ok(0)
}

/// Prints messages of any kind.
struct Printer<'a> {
    options: &'a EchoOptions,
    tables: BTreeMap<u32, Option<FieldTable>>,
    /// Columns of the table, once its head is printed.
    columns: Option<Vec<String>>,
}

impl<'a> Printer<'a> {
    fn new(options: &'a EchoOptions) -> Self {
        Self {
            options,
            tables: BTreeMap::new(),
            columns: None,
        }
    }

    fn print(&mut self, received: &ReceivedMessage) -> Result<(), UserError> {
        let header = &received.message.header;
        let table = self.tables.entry(header.schema).or_insert_with(|| {
            let mut entries = CATALOGUE.iter();
            let entry = entries.find(|entry| (entry.schema)().hash == header.schema)?;
            FieldTable::of((entry.schema)()).ok()
        });
        let Some(table) = table else {
            eprintln!(
                "{}: a message of version {} and hash {:#010x}, which this program does not know",
                plain(&received.topic),
                header.version,
                header.schema
            );
            return Ok(());
        };
        let wrong = self.options.field.iter().find(|path| !table.has(path));
        let value = match table.decode(&received.bytes[HEADER_BYTES..]) {
            Ok(value) => value,
            Err(error) => {
                eprintln!("{}: {error}", plain(&received.topic));
                return Ok(());
            }
        };
        if let Some(path) = wrong {
            let columns = value.columns();
            let what = format!("{} has no field '{path}'", table.name());
            return Err(UserError::unknown(
                what,
                path,
                columns.iter().map(String::as_str),
            ));
        }
        let name = table.name().to_owned();
        let chosen = self.chosen(&value);
        if self.options.csv {
            return self.row(received, &value);
        }
        if self.options.json {
            let shown = match &chosen[..] {
                [] => json!(value),
                fields => json!(fields.iter().cloned().collect::<BTreeMap<_, _>>()),
            };
            let line = json!({
                "topic": received.topic,
                "message": name,
                "seq": header.seq,
                "event_ns": header.event_ns,
                "sent_ns": header.sent_ns,
                "arrived_ns": received.message.arrived_ns,
                "value": shown,
            });
            return print_text(&format!("{line}\n"));
        }
        let mut text = format!("{}  {} {}\n", received.topic, name, header.seq);
        let shown = match (&value, chosen.is_empty()) {
            (Value::Fields(fields), true) => {
                let fields = fields.iter();
                fields
                    .map(|(name, value)| (name.to_string(), value.clone()))
                    .collect()
            }
            _ => chosen,
        };
        for (name, value) in shown {
            text += &format!("    {name}  {}\n", value.cell());
        }
        print_text(&text)
    }

    /// The fields that were asked for; absent are those of another alternative.
    fn chosen(&self, value: &Value) -> Vec<(String, Value)> {
        let fields = self.options.field.iter();
        fields
            .map(|path| {
                (
                    path.clone(),
                    value.at(path).cloned().unwrap_or(Value::Absent),
                )
            })
            .collect()
    }

    /// A row of the table; its head before the first.
    fn row(&mut self, received: &ReceivedMessage, value: &Value) -> Result<(), UserError> {
        if self.columns.is_none() {
            let columns = match self.options.field.is_empty() {
                true => value.columns(),
                false => self.options.field.clone(),
            };
            print_text(&format!("topic,seq,event_ns,{}\n", columns.join(",")))?;
            self.columns = Some(columns);
        }
        let header = &received.message.header;
        let mut row = format!("{},{},{}", received.topic, header.seq, header.event_ns);
        for path in self.columns.iter().flatten() {
            row.push(',');
            row += &quoted(&value.at(path).map(Value::cell).unwrap_or_default());
        }
        print_text(&(row + "\n"))
    }
}

/// A cell of comma-separated values (RFC 4180).
#[must_use]
pub(super) fn quoted(cell: &str) -> String {
    match cell.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", cell.replace('"', "\"\"")),
        false => cell.to_owned(),
    }
}
