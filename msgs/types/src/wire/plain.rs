//! Text of others as it may stand in a line: a name that came over the bus or out of a file is no place for
//! line ends, colours of a terminal, or letters that run the other way.

use std::borrow::Cow;
use std::fmt::Write as _;

/// True if a character controls the line instead of being shown in it.
fn acts(c: char) -> bool {
    // Line and paragraph separators, marks and embeddings of direction (Unicode, UAX 9).
    let moves =
        matches!(c, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    c.is_control() || moves
}

/// The text with each control character written as in Rust: `\n`, `\u{1b}`.
#[must_use]
pub fn plain(text: &str) -> Cow<'_, str> {
    if !text.contains(acts) {
        return Cow::Borrowed(text);
    }
    let mut line = String::with_capacity(text.len() + 8);
    for c in text.chars() {
        if acts(c) {
            write!(line, "{}", c.escape_default()).unwrap_or_default()
        } else {
            line.push(c)
        }
    }
    Cow::Owned(line)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_stays_in_its_line_and_other_letters_stay_as_they_are() {
        for text in ["", "Ultramarine Blue", "ΔE₀₀ 3 — «Größe» 群青 🎨", "a\\nb"] {
            assert!(matches!(plain(text), Cow::Borrowed(same) if same == text));
        }
        assert_eq!(plain("a\n WARN all is well"), "a\\n WARN all is well");
        assert_eq!(plain("\u{1b}[2Ja\r\u{9b}31m"), "\\u{1b}[2Ja\\r\\u{9b}31m");
        assert_eq!(plain("a\u{202e}b\u{2028}"), "a\\u{202e}b\\u{2028}");
    }
}
