//! Colours in the terminal: blocks where it can show them, words everywhere.

use std::io::IsTerminal as _;

use maulstick_optics::{Seen, Spectrum};

/// Colour support of the standard output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Terminal {
    /// 24 bits of colour.
    Colours,
    /// Plain text: a file, a pipe.
    Plain,
}

impl Terminal {
    /// Colour support of the standard output of this process.
    #[must_use]
    pub fn of_stdout() -> Self {
        if std::io::stdout().is_terminal() {
            Self::Colours
        } else {
            Self::Plain
        }
    }

    /// A block of `cells` characters followed by a space; empty in plain text.
    #[must_use]
    pub fn block(self, [r, g, b]: [u8; 3], cells: usize) -> String {
        match self {
            Self::Plain => String::new(),
            Self::Colours => format!("\x1b[48;2;{r};{g};{b}m{:cells$}\x1b[0m ", ""),
        }
    }
}

/// `#rrggbb`.
#[must_use]
pub fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Hex, Lab, and whether a display shows it.
#[must_use]
pub fn in_words(seen: &Seen) -> String {
    let [l, a, b] = seen.lab;
    let gamut = if seen.in_gamut() {
        "in gamut"
    } else {
        "out of the sRGB gamut"
    };
    format!(
        "{}  L* {l:.1}  a* {a:.1}  b* {b:.1}  {gamut}",
        hex(seen.bytes())
    )
}

/// A reflectance from 380 to 780 nm, a letter every 8 nm; the full height is `top`.
#[must_use]
pub fn sparkline(reflectance: &Spectrum, top: f64) -> String {
    const LEVELS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];
    let level = |r: &f64| LEVELS[((r / top * 8.0) as usize).min(7)];
    reflectance.0.iter().step_by(2).map(level).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plain_text_has_no_escapes() {
        assert_eq!(Terminal::Plain.block([1, 2, 3], 4), "");
        assert_eq!(
            Terminal::Colours.block([1, 2, 3], 2),
            "\x1b[48;2;1;2;3m  \x1b[0m "
        );
        assert_eq!(hex([138, 90, 60]), "#8a5a3c");
    }

    #[test]
    fn a_sparkline_rises_with_the_reflectance() {
        let ramp = sparkline(&Spectrum::from_fn(|nm| (nm - 380.0) / 400.0), 1.0);
        assert_eq!((ramp.chars().count(), ramp.chars().last()), (51, Some('█')));
        assert!(ramp.starts_with('▁') && ramp.contains("▄"));
        assert!(
            sparkline(&Spectrum::flat(0.0), 1.0)
                .chars()
                .all(|c| c == '▁')
        );
    }
}
