//! Rules about words: they are for people, and nothing in the program depends on them.

use super::Breaches;
use crate::facts::Sought;
use crate::tree::{Tree, below};

/// Where the words themselves are tested: the window's languages.
const CATALOGUE: [&str; 2] = ["ui/kit/src/language", "ui/src/language_tests"];

/// A file whose pieces of prose are keys that it writes itself.
const KEYS: &str = "sim/document/src/record/beginning.rs";

/// Words of a text, which have two letters or more.
fn words(text: &str) -> impl Iterator<Item = &str> {
    let words = text.split(|c: char| !c.is_alphabetic());
    words.filter(|word| word.chars().count() > 1)
}

/// Whether a text is prose, or a piece of it, and no name.
fn is_prose(text: &str) -> bool {
    let is_plain = |word: &str| word.len() > 2 && word.starts_with(char::is_lowercase);
    text.contains(' ') && words(text).any(is_plain)
}

/// Whether a text is wording: two words or more, not all of which are names, as those of paints.
fn is_wording(text: &str) -> bool {
    let is_plain = |word: &str| !word.starts_with(char::is_uppercase);
    text.contains(' ') && words(text).count() > 1 && words(text).any(is_plain)
}

/// Whether a comparison finds a text in a message, or the text is hardly more than a message of several words.
fn is_from(message: &str, sought: &Sought) -> bool {
    let is_part = words(message).count() > 1 && sought.text.contains(message);
    (sought.finds)(message, &sought.text) || is_part && 3 * message.len() > 2 * sought.text.len()
}

/// Pieces of prose that one file looks for in a text and another file writes.
pub(super) fn parsed(tree: &Tree, found: &mut Breaches) {
    let mut written = Vec::new();
    for (file, facts) in tree.product() {
        let texts = facts.texts.iter().filter(|(text, _)| is_prose(text));
        written.extend(texts.map(|(text, line)| (file, text, line)));
    }
    for (file, facts) in tree.product().filter(|(file, _)| *file != KEYS) {
        for sought in facts.sought.iter().filter(|sought| is_prose(&sought.text)) {
            let mut others = written.iter().filter(|(other, ..)| *other != file);
            if let Some((other, text, line)) = others.find(|(_, text, _)| is_from(text, sought)) {
                let Sought { text: part, .. } = sought;
                let what = format!("looks for {part:?} in {text:?} of {other}:{line}: send data");
                found.one(file, sought.line, &what);
            }
        }
    }
}

/// Assertions on the wording of a message.
pub(super) fn asserted(tree: &Tree, found: &mut Breaches) {
    for (file, facts) in &tree.facts {
        for (text, line) in &facts.asserted {
            if is_wording(text) && !CATALOGUE.iter().any(|folder| below(file, folder)) {
                let what = format!("asserts the words {text:?}: compare data");
                found.one(file, *line, &what);
            }
        }
    }
}

/// Errors that are texts, in libraries.
pub(super) fn errors(tree: &Tree, found: &mut Breaches) {
    for (file, facts) in tree.product() {
        if !file.ends_with("/main.rs") && !file.contains("/src/bin/") {
            for line in &facts.text_errors {
                found.one(file, *line, "`Result<_, String>`: make an enum");
            }
        }
    }
}
