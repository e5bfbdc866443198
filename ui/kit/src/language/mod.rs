//! Languages of the window. The English sentences of the source are the keys; `languages` has a file for each other
//! language, of which the build makes the list.
//!
//! | macro, function | for |
//! | --- | --- |
//! | `tr!` | a sentence that is shown, with its places filled in |
//! | `tr_noop!` | a sentence in a table, for [`translated`] where it is shown |
//! | [`known`] | a word from another process or a file, such as the name of a brush |
//! | [`step`] | a step of the history |
//! | [`key_name`] | a key |
//!
//! The choice belongs to a thread: the window's, and those of its background tasks.

use std::cell::{Cell, RefCell};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::fmt::{Display, Write as _};
use std::sync::{LazyLock, OnceLock};

use maulstick_types::scene::Layer;
use serde::Deserialize;

/// The sentence in the language of the window. Names fill its places: `tr!("Saved to {file}", file)`, or `tr!("{count}
/// paints", count = paints.len())`. An English word with several translations has its meaning before a bar, which is
/// not shown: `tr!("theme|Light")`.
#[macro_export]
macro_rules! tr {
    ($english:literal) => {
        $crate::language::translated($english)
    };
    ($english:literal, $($name:ident $(= $value:expr)?),+ $(,)?) => {
        $crate::language::filled(
            $english,
            &[$((stringify!($name), &$crate::tr!(@value $name $(= $value)?) as &dyn std::fmt::Display)),+],
        )
    };
    (@value $name:ident) => { $name };
    (@value $name:ident = $value:expr) => { $value };
}

/// A sentence that is translated where it is shown, as Qt's `QT_TR_NOOP`.
#[macro_export]
macro_rules! tr_noop {
    ($english:literal) => {
        $english
    };
}

mod steps;

pub use steps::step;

include!(concat!(env!("OUT_DIR"), "/languages.rs"));

/// Code of the language of the source, ISO 639.
pub const ENGLISH: &str = "en";

/// A file of `languages`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Language {
    /// Its name in itself.
    pub name: String,
    /// Translations by the English sentence, in tables that only order them.
    texts: BTreeMap<String, HashMap<String, String>>,
    #[serde(skip)]
    by_english: HashMap<String, String>,
}

impl Language {
    /// Reads a file of a language.
    ///
    /// # Errors
    /// [`toml::de::Error`] with the place.
    pub fn read(text: &str) -> Result<Self, toml::de::Error> {
        let mut language: Self = toml::from_str(text)?;
        let parts = std::mem::take(&mut language.texts).into_values();
        language.by_english = parts.flatten().collect();
        Ok(language)
    }

    /// English sentences and their translations.
    pub fn texts(&self) -> impl Iterator<Item = (&str, &str)> {
        let texts = self.by_english.iter();
        texts.map(|(english, text)| (english.as_str(), text.as_str()))
    }

    /// Its translation of an English sentence.
    #[must_use]
    pub fn of(&self, english: &str) -> Option<&str> {
        self.by_english.get(english).map(String::as_str)
    }
}

/// The languages other than English, by their codes, ISO 639.
pub fn all() -> &'static BTreeMap<&'static str, Language> {
    static ALL: LazyLock<BTreeMap<&'static str, Language>> = LazyLock::new(|| {
        let read = |(code, text): &(&'static str, &str)| {
            let language = Language::read(text);
            let language =
                language.inspect_err(|error| tracing::error!("language {code}: {error}"));
            Some((*code, language.ok()?))
        };
        FILES.iter().filter_map(read).collect()
    });
    &ALL
}

thread_local! {
    /// The language of this thread; `None` for English.
    static CHOSEN: Cell<Option<&'static Language>> = const { Cell::new(None) };
    /// Sentences without a translation into it that were shown.
    static LACKING: RefCell<BTreeSet<String>> = const { RefCell::new(BTreeSet::new()) };
}

/// Code of the system's language; English unless [`follow_system`] was called.
static SYSTEM: OnceLock<&'static str> = OnceLock::new();

/// Uses the system's language for a painter who has chosen none.
pub fn follow_system() {
    let code = spoken(sys_locale::get_locales());
    if SYSTEM.set(code).is_err() {
        tracing::debug!("the system's language is known already");
    }
    choose(None);
}

/// Code of the first of these locales that the window speaks; else English.
fn spoken(locales: impl Iterator<Item = String>) -> &'static str {
    let mut codes = locales.filter_map(|locale| {
        let code = locale.split(['-', '_']).next().unwrap_or_default();
        match code.to_ascii_lowercase().as_str() {
            ENGLISH | "c" | "posix" => Some(ENGLISH),
            code => all().get_key_value(code).map(|(code, _)| *code),
        }
    });
    codes.next().unwrap_or(ENGLISH)
}

/// Speaks another language from now on, by its code; absent or unknown: that of the system.
pub fn choose(code: Option<&str>) {
    let is_known = |code: &&str| *code == ENGLISH || all().contains_key(code);
    let system = SYSTEM.get().copied().unwrap_or(ENGLISH);
    CHOSEN.set(match code.filter(is_known).unwrap_or(system) {
        ENGLISH => None,
        code => all().get(code),
    });
}

/// Gives a thread beside the window's its language: called there with [`chosen`] of the window.
pub fn adopt(language: Option<&'static Language>) {
    CHOSEN.set(language);
}

/// The language of this thread; `None` for English.
#[must_use]
pub fn chosen() -> Option<&'static Language> {
    CHOSEN.get()
}

/// The sentence in the language of the window; English where a translation is missing.
#[must_use]
pub fn translated(english: &str) -> &str {
    let plain = english.split_once('|').map_or(english, |(_, text)| text);
    let Some(language) = CHOSEN.get() else {
        return plain;
    };
    language.of(english).unwrap_or_else(|| {
        LACKING.with_borrow_mut(|lacking| lacking.insert(english.to_owned()));
        plain
    })
}

/// Sentences that were shown in English for lack of a translation, on this thread.
#[must_use]
pub fn lacking() -> BTreeSet<String> {
    LACKING.with_borrow(BTreeSet::clone)
}

/// A word of another process or of a file, translated if known.
#[must_use]
pub fn known(english: &str) -> &str {
    let language = CHOSEN.get();
    let text = language.and_then(|language| language.of(english));
    text.unwrap_or(english)
}

/// A part of a shortcut, such as `Ctrl` or `Delete`, as it stands on keyboards of the language.
#[must_use]
pub fn key_name(english: &str) -> &str {
    let language = CHOSEN.get();
    let text = language.and_then(|language| language.of(&format!("key|{english}")));
    text.unwrap_or(english)
}

/// Words with a capital at the beginning.
#[must_use]
pub fn capitalized(words: &str) -> String {
    let mut letters = words.chars();
    let first = letters.next().map(char::to_uppercase);
    first.into_iter().flatten().chain(letters).collect()
}

/// The sentence with its places, such as `{file}`, filled in.
#[must_use]
pub fn filled(english: &'static str, parts: &[(&str, &dyn Display)]) -> String {
    let mut rest = translated(english);
    let mut text = String::with_capacity(2 * rest.len());
    while let Some((before, place)) = rest.split_once('{') {
        text.push_str(before);
        let Some((name, after)) = place.split_once('}') else {
            text.push('{');
            rest = place;
            continue;
        };
        match parts.iter().find(|(known, _)| *known == name) {
            // Writing into a string cannot fail.
            Some((_, part)) => write!(text, "{part}").unwrap_or_default(),
            None => text.extend(["{", name, "}"]),
        }
        rest = after;
    }
    text.push_str(rest);
    text
}

/// A layer as a painter reads its name: one without a name of its own has a number.
#[must_use]
pub fn layer_name(layer: &Layer) -> String {
    if layer.is_unnamed() {
        tr!("layer {number}", number = layer.number)
    } else {
        layer.name.clone()
    }
}

#[cfg(test)]
mod tests;
