//! No bytes make the reader panic or hang, and a number is read as it was meant or not at all.

use maulstick_tables::{Fault, HeadingLine, Table, decode};
use proptest::prelude::*;

/// Reads all that a table has.
fn exhaust(text: &str) {
    for heading in [HeadingLine::First, HeadingLine::Words, HeadingLine::Row] {
        let Ok(table) = Table::parse(text, heading) else {
            continue;
        };
        drop(table.columns(["t", "x", "y"]));
        for row in table.rows() {
            assert!(row.len() > 0 && row.line() <= table.last_line());
            for column in 0..row.len() + 2 {
                let number = row.number(column);
                assert!(number.map_or(true, f64::is_finite));
            }
            drop(row.numbers::<2>());
        }
    }
}

/// A way of writing a table.
#[derive(Clone, Debug)]
struct Dialect {
    separator: &'static str,
    mark: char,
    is_quoted: bool,
    end: &'static str,
    has_mark: bool,
    is_headed: bool,
}

fn dialect() -> impl Strategy<Value = Dialect> {
    let separators = prop::sample::select(vec![";", "\t", ",", " ", " \t ", "; ", ", "]);
    let ends = prop::sample::select(vec!["\n", "\r\n", "\r", "\r\r\n"]);
    let others = (any::<bool>(), any::<bool>(), any::<bool>(), any::<bool>());
    (separators, ends, others).prop_map(|(separator, end, (comma, quoted, bom, headed))| Dialect {
        separator,
        mark: if comma { ',' } else { '.' },
        // A decimal comma between commas needs quotes.
        is_quoted: quoted || (comma && separator.starts_with(',')),
        end,
        has_mark: bom,
        is_headed: headed,
    })
}

fn written(rows: &[Vec<(f64, usize)>], dialect: &Dialect) -> String {
    let quote = if dialect.is_quoted { "\"" } else { "" };
    let mut text = String::from(if dialect.has_mark { "\u{feff}" } else { "" });
    if dialect.is_headed {
        let names: Vec<String> = (0..rows[0].len())
            .map(|i| format!("{quote}h{i}{quote}"))
            .collect();
        text += &(names.join(dialect.separator) + dialect.end);
    }
    for row in rows {
        let cells: Vec<String> = row
            .iter()
            .map(|(number, digits)| {
                let plain = format!("{number:.digits$}").replace('.', &dialect.mark.to_string());
                format!("{quote}{plain}{quote}")
            })
            .collect();
        text += &(cells.join(dialect.separator) + dialect.end);
    }
    text
}

proptest! {
    #[test]
    fn no_bytes_make_the_reader_panic(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        if let Ok(text) = decode(&bytes) {
            exhaust(&text);
        }
    }

    #[test]
    fn no_letters_of_tables_make_the_reader_panic(text in "[0-9.,;e\t \"\r\n#:x−+-]{0,80}") {
        exhaust(&text);
    }

    #[test]
    fn a_number_is_read_as_it_was_meant_or_refused(
        (rows, dialect) in (2..6_usize).prop_flat_map(|columns| {
            let cell = (-2000.0..2000.0_f64, 0..5_usize);
            let row = prop::collection::vec(cell, columns);
            (prop::collection::vec(row, 1..6), dialect())
        }),
    ) {
        let text = written(&rows, &dialect);
        let table = Table::parse(&text, HeadingLine::Words).expect(&text);
        prop_assert_eq!(table.rows().len(), rows.len(), "{:?}", text);
        for (got, wanted) in table.rows().zip(&rows) {
            prop_assert_eq!(got.len(), wanted.len(), "{:?}", text);
            prop_assert_eq!(got.block(), 0);
            for (column, (number, digits)) in wanted.iter().enumerate() {
                match got.number(column) {
                    Ok(read) => {
                        let meant: f64 = format!("{number:.digits$}").parse().expect("a number");
                        prop_assert_eq!(read, meant, "{:?}", text);
                    }
                    Err(error) => {
                        let two = matches!(error.fault, Fault::TwoReadings { .. });
                        prop_assert!(two && *digits == 3, "{} {:?}", error, text);
                    }
                }
            }
        }
    }
}
