//! `maulstick topic echo`: the messages of a topic, as they come.

use std::time::{Duration, Instant};

use clap::Args;
use maulstick_recorder::listener::{Listener, ReceivedMessage};
use maulstick_rig::UserError;
use maulstick_streams::Value;
use maulstick_streams::catalogue::KnownTables;
use maulstick_types::{HEADER_BYTES, plain};

use super::message_lines::{MessageLine, head};
use crate::commands::client::Target;
use crate::commands::print_text;

/// Options of `maulstick topic echo`.
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

/// Longest time that `--once` waits for a message.
const PATIENCE: Duration = Duration::from_secs(10);

/// Prints messages until Ctrl-C.
///
/// # Errors
/// A [`UserError`] if no rig runs, or for a field that a message lacks.
pub(super) fn run(options: &EchoOptions) -> Result<i32, UserError> {
    let mut listener = Listener::open(options.target.rig(), &options.topic)?;
    let mut printer = Printer::new(options);
    let give_up = options.once.then(|| Instant::now() + PATIENCE);
    while !listener.is_over() {
        let soon = Instant::now() + Duration::from_secs(1);
        let Some(received) = listener.next(give_up.unwrap_or(soon)) else {
            if give_up.is_some_and(|at| Instant::now() >= at) {
                let what = format!("nothing came on {} within 10 s", options.topic);
                return Err(UserError::failure(what)
                    .help("`maulstick topic list` lists what the rig sends now"));
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
    tables: KnownTables,
    /// Columns of the table, once its head is printed.
    columns: Option<Vec<String>>,
}

impl<'a> Printer<'a> {
    fn new(options: &'a EchoOptions) -> Self {
        Self {
            options,
            tables: KnownTables::default(),
            columns: None,
        }
    }

    fn print(&mut self, received: &ReceivedMessage) -> Result<(), UserError> {
        let header = &received.message.header;
        let Some(table) = self.tables.of(header.schema) else {
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
        let line = MessageLine {
            topic: &received.topic,
            header,
            arrived_ns: received.message.arrived_ns,
            value: &value,
        };
        let fields = &self.options.field;
        if self.options.json {
            return print_text(&line.json(fields));
        }
        if self.options.csv {
            return self.print_row(&line);
        }
        let mut text = format!("{}  {} {}\n", received.topic, table.name(), header.seq);
        let mut add = |name: &str, value: Option<&Value>| {
            let cell = value.map(Value::cell).unwrap_or_default();
            text += format!("    {name}  {cell}").trim_end();
            text.push('\n');
        };
        match (&value, fields.is_empty()) {
            (Value::Fields(own), true) => own.iter().for_each(|(name, own)| add(name, Some(own))),
            _ => fields.iter().for_each(|path| add(path, value.at(path))),
        }
        print_text(&text)
    }

    /// Prints a row of the table, the first with its head.
    fn print_row(&mut self, line: &MessageLine<'_>) -> Result<(), UserError> {
        let columns = self.columns.get_or_insert_default();
        if columns.is_empty() {
            let fields = &self.options.field;
            *columns = if fields.is_empty() {
                line.value.columns()
            } else {
                fields.clone()
            };
            print_text(&head(columns))?;
        }
        print_text(&line.row(columns))
    }
}
