//! Numbers with a decimal point or comma.

use crate::error::Fault;

/// Decimal marks that some cell of a table shows beyond doubt.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Marks {
    point: bool,
    comma: bool,
}

/// Marks in a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    /// Without a mark.
    Whole,
    /// With one mark, which `is_grouped` may be that of thousands.
    Marked { mark: char, is_grouped: bool },
}

impl Marks {
    /// Learns from a cell.
    pub(crate) fn see(&mut self, cell: &str) {
        let Some(Form::Marked {
            mark,
            is_grouped: false,
        }) = form(cell)
        else {
            return;
        };
        match mark {
            '.' => self.point = true,
            _ => self.comma = true,
        }
    }

    /// The number in a cell.
    ///
    /// # Errors
    /// A [`Fault`] where it is none, or two.
    pub(crate) fn read(self, cell: &str) -> Result<f64, Fault> {
        let owned = || cell.to_owned();
        if cell.is_empty() {
            return Err(Fault::Missing);
        }
        let Some(form) = form(cell) else {
            return Err(match cell.parse::<f64>() {
                Ok(number) if !number.is_finite() => Fault::NotFinite { cell: owned() },
                _ => Fault::NotANumber { cell: owned() },
            });
        };
        if let Form::Marked {
            mark,
            is_grouped: true,
        } = form
        {
            // A point is that of decimals where nothing speaks against it, for programs write it; a comma is not.
            let is_decimal = match mark {
                '.' => self.point || !self.comma,
                _ => self.comma && !self.point,
            };
            if !is_decimal {
                return Err(Fault::TwoReadings { cell: owned() });
            }
        }
        let plain = cell.replace(',', ".").replace('−', "-");
        let number = plain.parse::<f64>().ok();
        match number {
            Some(number) if number.is_finite() => Ok(number),
            Some(_) => Err(Fault::NotFinite { cell: owned() }),
            None => Err(Fault::NotANumber { cell: owned() }),
        }
    }
}

/// True if a cell is a number under either decimal mark.
pub(crate) fn is_number(cell: &str) -> bool {
    form(cell).is_some()
}

/// The form of a cell; `None` if it is no number.
fn form(cell: &str) -> Option<Form> {
    let unsigned = cell.strip_prefix(['+', '-', '−']).unwrap_or(cell);
    let (mantissa, exponent) = match unsigned.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, Some(exponent)),
        None => (unsigned, None),
    };
    let digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
    if let Some(exponent) = exponent {
        let power = exponent.strip_prefix(['+', '-', '−']).unwrap_or(exponent);
        if power.is_empty() || !digits(power) {
            return None;
        }
    }
    let Some(at) = mantissa.find(['.', ',']) else {
        return (!mantissa.is_empty() && digits(mantissa)).then_some(Form::Whole);
    };
    let (whole, mark, behind) = (&mantissa[..at], &mantissa[at..=at], &mantissa[at + 1..]);
    let mark = if mark == "." { '.' } else { ',' };
    // A comma has digits on both sides, or it would rather be a separator.
    let is_whole = match mark {
        '.' => !whole.is_empty() || !behind.is_empty(),
        _ => !whole.is_empty() && !behind.is_empty(),
    };
    (is_whole && digits(whole) && digits(behind)).then(|| Form::Marked {
        mark,
        is_grouped: exponent.is_none()
            && behind.len() == 3
            && (1..=3).contains(&whole.len())
            && !whole.starts_with('0'),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(cell: &str, others: &[&str]) -> Result<f64, Fault> {
        let mut marks = Marks::default();
        for other in others {
            marks.see(other);
        }
        marks.see(cell);
        marks.read(cell)
    }

    #[test]
    fn a_mark_is_read_alone_or_by_the_others_or_not_at_all() {
        for (cell, others, number) in [
            ("12", &[][..], 12.0),
            ("-1,5", &[], -1.5),
            ("−0.0002", &[], -0.0002),
            (".5", &[], 0.5),
            ("5.", &[], 5.0),
            ("0,008", &[], 0.008),
            ("1,5e-3", &[], 0.0015),
            ("1.234", &[], 1.234),
            ("1.234", &["0.5"], 1.234),
            ("1,234", &["0,5"], 1.234),
            ("1234,5", &["0.5"], 1234.5),
            ("1.234", &["0,5", "0.5"], 1.234),
        ] {
            assert_eq!(read(cell, others), Ok(number), "{cell} {others:?}");
        }
        for (cell, others) in [
            ("1,234", &[][..]),
            ("1,234", &["0.5"]),
            ("1.234", &["0,5"]),
            ("1,234", &["0,5", "0.5"]),
        ] {
            let two = matches!(read(cell, others), Err(Fault::TwoReadings { .. }));
            assert!(two, "{cell} {others:?}");
        }
    }

    #[test]
    fn what_is_no_number_is_none() {
        for cell in [
            "one",
            "1,234,5",
            "1,234.5",
            "1.234.567",
            ",5",
            "5,",
            ".",
            "-",
            "e5",
            "1e",
            "0x10",
            "1 234",
            "--1",
            "1_000",
        ] {
            assert!(
                matches!(read(cell, &[]), Err(Fault::NotANumber { .. })),
                "{cell}"
            );
        }
        for cell in ["nan", "inf", "-Infinity", "1e999"] {
            assert!(
                matches!(read(cell, &[]), Err(Fault::NotFinite { .. })),
                "{cell}"
            );
        }
        assert_eq!(read("", &[]), Err(Fault::Missing));
    }
}
