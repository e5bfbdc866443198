//! The keys of a script and their values, each with its line: a wrong value is reported with the key, the expected form
//! and the value given.

use std::path::Path;

use maulstick_rig::UserError;
use maulstick_rig::config::is_path;
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue, ValueDeserializer};

/// Example of a script.
const EXAMPLE: &str = "a script is `step = [ { load = \"Bone Black\" }, … ]`";

/// The key of a new canvas's size.
const CANVAS_MM: &str = "canvas_mm";

/// Longer messages of a reader are cut, characters.
const MESSAGE: usize = 160;

/// Longer texts are cut where they are quoted.
const SHORT: usize = 40;

/// Source of a script.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source<'a> {
    /// Ends of its lines, bytes.
    pub(super) line_ends: &'a [usize],
    /// Its file, as named by the user.
    pub(super) name: &'a str,
    /// From where its paths count.
    pub(super) folder: &'a Path,
}

impl<'a> Source<'a> {
    /// File and line of a byte.
    pub(super) fn place(&self, byte: usize) -> String {
        let before = self.line_ends.partition_point(|end| *end < byte);
        format!("{}:{}", self.name, before + 1)
    }

    /// The error of a script that is not TOML.
    pub(super) fn no_toml(&self, error: &toml::de::Error) -> UserError {
        let message = error.message().lines().next().unwrap_or_default();
        UserError::usage(format!("this is no TOML: {message}"))
            .at(self.place(error.span().map_or(0, |span| span.start)))
            .help(EXAMPLE)
    }

    /// Size of a new canvas, mm, if a script says it.
    pub(super) fn canvas_mm(&self, file: &'a DeTable<'a>) -> Result<Option<[f64; 2]>, UserError> {
        let entries = Entries {
            source: *self,
            table: file,
            example: "canvas_mm = [200, 160]",
        };
        let size = entries.numbers(CANVAS_MM)?.map(|numbers| {
            let size = <[f64; 2]>::try_from(numbers).ok();
            size.filter(|size| size.iter().all(|side| (1.0..=10_000.0).contains(side)))
                .ok_or_else(|| {
                    let what = format!("'{CANVAS_MM}' takes width and height, 1 to 10000 mm");
                    entries.fault(CANVAS_MM, what).help(entries.for_example())
                })
        });
        size.transpose()
    }

    /// Entries of a script's key `step`: tables, each with its first byte.
    pub(super) fn listed(
        &self,
        file: &'a DeTable<'a>,
    ) -> Result<Vec<(usize, &'a DeTable<'a>)>, UserError> {
        let fault =
            |what: String, byte: usize| UserError::usage(what).at(self.place(byte)).help(EXAMPLE);
        let known = |key: &str| [CANVAS_MM, "step"].contains(&key);
        if let Some((key, _)) = file.iter().find(|(key, _)| !known(key.get_ref())) {
            let what = format!(
                "a script has no key '{}', only 'step' and '{CANVAS_MM}'",
                key.get_ref()
            );
            return Err(fault(what, key.span().start));
        }
        let Some((_, step)) = file.iter().find(|(key, _)| key.get_ref() == "step") else {
            return Err(UserError::usage("there are no steps")
                .at(self.name)
                .help(EXAMPLE));
        };
        let no_list = |value: &Spanned<DeValue<'_>>, due: &str| {
            let what = format!("'step' is {due}, not {}", described(value.get_ref()));
            fault(what, value.span().start)
        };
        let DeValue::Array(steps) = step.get_ref() else {
            return Err(no_list(step, "a list of steps"));
        };
        if steps.is_empty() {
            return Err(fault("there are no steps".to_owned(), step.span().start));
        }
        let tables = steps.iter().map(|value| match value.get_ref() {
            DeValue::Table(table) => Ok((value.span().start, table)),
            _ => Err(no_list(value, "a list of steps in braces")),
        });
        tables.collect()
    }
}

/// Keys and what they hold.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entries<'a> {
    pub(super) source: Source<'a>,
    pub(super) table: &'a DeTable<'a>,
    /// Example of their form, for help.
    pub(super) example: &'static str,
}

/// Description of a value.
fn described(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(text) if text.chars().count() > SHORT => {
            format!(
                "the text {:?}…",
                text.chars().take(SHORT).collect::<String>()
            )
        }
        DeValue::String(text) => format!("the text {text:?}"),
        DeValue::Integer(number) => format!("the number {number}"),
        DeValue::Float(number) => format!("the number {number}"),
        DeValue::Boolean(switch) => switch.to_string(),
        DeValue::Datetime(date) => format!("the date {date}"),
        DeValue::Array(_) => "a list".to_owned(),
        DeValue::Table(_) => "a table".to_owned(),
    }
}

/// The first line of a message, cut where it quotes a long text.
fn short(message: &str) -> String {
    let line = message.lines().next().unwrap_or_default();
    let cut: String = line.chars().take(MESSAGE).collect();
    if cut.len() < line.len() {
        format!("{cut}…")
    } else {
        cut
    }
}

fn number_of(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Integer(number) => i64::from_str_radix(number.as_str(), number.radix())
            .ok()
            .map(|number| number as f64),
        DeValue::Float(number) => number.as_str().parse().ok(),
        _ => None,
    }
}

fn text_of<'a>(value: &'a DeValue<'_>) -> Option<&'a str> {
    match value {
        DeValue::String(text) => Some(text),
        _ => None,
    }
}

impl<'a> Entries<'a> {
    /// The keys that are given, as they stand in the file.
    pub(super) fn keys(&self) -> Vec<&'a str> {
        let mut keys: Vec<_> = self.table.keys().collect();
        keys.sort_by_key(|key| key.span().start);
        keys.into_iter().map(|key| key.get_ref().as_ref()).collect()
    }

    /// True if a key is given.
    pub(super) fn is_given(&self, key: &str) -> bool {
        self.find(key).is_some()
    }

    /// Reads all keys into one value. An error has the line of its key.
    pub(super) fn read<T>(
        &self,
        read: impl FnOnce(ValueDeserializer<'a>) -> Result<T, toml::de::Error>,
    ) -> Result<T, UserError> {
        let table = Spanned::new(0..0, DeValue::Table(self.table.clone()));
        read(ValueDeserializer::from(table)).map_err(|error| {
            let start = error.span().map(|span| span.start);
            let holds =
                |value: &Spanned<DeValue<'_>>| start.is_some_and(|at| value.span().contains(&at));
            let found = self.table.iter().find(|(_, value)| holds(value));
            let message = short(error.message());
            let fault = match found {
                Some((key, _)) => {
                    self.fault(key.get_ref(), format!("'{}': {message}", key.get_ref()))
                }
                None => UserError::usage(message),
            };
            fault.help(self.for_example())
        })
    }

    /// File and line of a key.
    pub(super) fn place(&self, key: &str) -> String {
        let found = self.table.keys().find(|found| found.get_ref() == key);
        self.source.place(found.map_or(0, |key| key.span().start))
    }

    /// Something wrong at a key.
    pub(super) fn fault(&self, key: &str, what: impl Into<String>) -> UserError {
        UserError::usage(what).at(self.place(key))
    }

    /// The example as help.
    pub(super) fn for_example(&self) -> String {
        format!("for example {}", self.example)
    }

    fn find(&self, key: &str) -> Option<&'a DeValue<'a>> {
        let found = self.table.iter().find(|(found, _)| found.get_ref() == key);
        found.map(|(_, value)| value.get_ref())
    }

    fn due<T>(
        &self,
        key: &str,
        due: &str,
        read: impl Fn(&'a DeValue<'a>) -> Option<T>,
    ) -> Result<Option<T>, UserError> {
        let Some(value) = self.find(key) else {
            return Ok(None);
        };
        read(value).map(Some).ok_or_else(|| {
            let what = format!("'{key}' takes {due}, not {}", described(value));
            self.fault(key, what).help(self.for_example())
        })
    }

    pub(super) fn text(&self, key: &str) -> Result<Option<&'a str>, UserError> {
        self.due(key, "a text", text_of)
    }

    pub(super) fn number(&self, key: &str) -> Result<Option<f64>, UserError> {
        self.due(key, "a number", number_of)
    }

    pub(super) fn switch(&self, key: &str) -> Result<Option<bool>, UserError> {
        self.due(key, "true or false", |value| match value {
            DeValue::Boolean(switch) => Some(*switch),
            _ => None,
        })
    }

    pub(super) fn texts(&self, key: &str) -> Result<Option<Vec<&'a str>>, UserError> {
        self.due(key, "a list of texts", |value| {
            list_of(value)?
                .iter()
                .map(|value| text_of(value.get_ref()))
                .collect()
        })
    }

    pub(super) fn numbers(&self, key: &str) -> Result<Option<Vec<f64>>, UserError> {
        self.due(key, "a list of numbers", |value| numbers_of(value))
    }

    /// Lists of numbers.
    pub(super) fn rows(&self, key: &str) -> Result<Option<Vec<Vec<f64>>>, UserError> {
        self.due(key, "a list of lists of numbers", |value| {
            let rows = list_of(value)?.iter();
            rows.map(|row| numbers_of(row.get_ref())).collect()
        })
    }

    pub(super) fn table(&self, key: &str) -> Result<Option<Self>, UserError> {
        self.due(key, "a table in braces", |value| match value {
            DeValue::Table(table) => Some(Self { table, ..*self }),
            _ => None,
        })
    }

    /// A name, or the path of a file beside the script.
    pub(super) fn beside(&self, name: &str) -> String {
        if is_path(name) {
            self.source.folder.join(name).display().to_string()
        } else {
            name.to_owned()
        }
    }

    /// Result for the value of a key, perhaps a file: an error is reported with both places.
    pub(super) fn named<T>(
        &self,
        key: &str,
        file: Option<&str>,
        read: Result<T, UserError>,
    ) -> Result<T, UserError> {
        read.map_err(|mut fault| {
            if file.is_some_and(|file| !Path::new(file).exists()) {
                fault = fault.help("check the path: it counts from the script's folder");
            }
            let place = self.place(key);
            match fault.place.take() {
                Some(file) => fault.at(format!("{file}, named at {place}")),
                None => fault.at(place),
            }
        })
    }
}

/// A name that is that of a file.
pub(super) fn file(name: &str) -> Option<&str> {
    is_path(name).then_some(name)
}

fn numbers_of(value: &DeValue<'_>) -> Option<Vec<f64>> {
    let DeValue::Array(list) = value else {
        return None;
    };
    list.iter()
        .map(|value| number_of(value.get_ref()))
        .collect()
}

fn list_of<'a>(value: &'a DeValue<'a>) -> Option<&'a DeArray<'a>> {
    match value {
        DeValue::Array(list) => Some(list),
        _ => None,
    }
}
