//! Tables that are read, and tables that are refused.

use maulstick_tables::{Fault, HeadingLine, Separator, Table, decode, shown};

fn parsed(text: &str) -> Table {
    Table::parse(text, HeadingLine::Words).expect("a table")
}

fn numbers(table: &Table) -> Vec<Vec<f64>> {
    let row = |row: maulstick_tables::Row<'_>| {
        (0..row.len())
            .map(|column| row.number(column).expect("a number"))
            .collect()
    };
    table.rows().map(row).collect()
}

#[test]
fn a_spreadsheet_of_any_country_is_read() {
    let wanted = [vec![0.0, 200.0, 0.5], vec![0.008, 203.25, 1.0]];
    for (text, separator) in [
        ("t,x,p\n0.000,200,0.5\n0.008,203.25,1\n", Separator::Comma),
        (
            "t;x;p\r\n0,000;200;0,5\r\n0,008;203,25;1\r\n",
            Separator::Semicolon,
        ),
        ("t\tx\tp\r0.000\t200\t0.5\r0.008\t203.25\t1", Separator::Tab),
        (
            "t\tx\tp\n0,000\t200\t0,5\n0,008\t203,25\t1\n",
            Separator::Tab,
        ),
        (
            "t x p\n0.000  200 0.5 \n 0.008 203.25\t 1\n",
            Separator::Blanks,
        ),
        ("t x p\n0,000 200 0,5\n0,008 203,25 1\n", Separator::Blanks),
        (
            "\u{feff}\"t\",\"x\",\"p\"\n\"0,000\",\"200\",\"0,5\"\n\"0,008\",\"203,25\",\"1\"\n",
            Separator::Comma,
        ),
        (
            "T, X , \"p\"\n0.000, 200, 0.5,,\n0.008 ,203.25, \"1\",\n",
            Separator::Comma,
        ),
    ] {
        let table = parsed(text);
        assert_eq!(table.separator(), separator, "{text:?}");
        assert_eq!(numbers(&table), wanted, "{text:?}");
        let found = table.columns(["t", "p", "x"]).expect("all known");
        assert_eq!(found, [Some(0), Some(2), Some(1)], "{text:?}");
    }
}

#[test]
fn quotes_hold_separators_and_quotes_behind_blanks_too() {
    let text = "sample, White, 380\n \"a, b\", 1, 0.5\nx, \"d, \"\"e\"\"\", 1\n";
    let table = Table::parse(text, HeadingLine::First).expect("a table");
    let rows: Vec<Vec<&str>> = table.rows().map(|row| row.cells().collect()).collect();
    assert_eq!(rows, [["a, b", "1", "0.5"], ["x", "d, \"e\"", "1"]]);
}

#[test]
fn an_empty_cell_before_a_tab_is_a_cell() {
    let text = "sample\tWhite\t380\n\t1\t0.5\n";
    let table = Table::parse(text, HeadingLine::First).expect("a table");
    let row = table.rows().next().expect("a row");
    assert_eq!(row.cells().collect::<Vec<_>>(), ["", "1", "0.5"]);
}

#[test]
fn words_with_blanks_and_numbers_are_no_columns() {
    let text = "sample\tshare\nrow 1 2 3\t0.5\nrow 4 5 6\t0.25\n";
    let table = Table::parse(text, HeadingLine::First).expect("a table");
    assert_eq!(table.separator(), Separator::Tab);
    assert_eq!(table.rows().next().expect("a row").cell(0), "row 1 2 3");
}

#[test]
fn headings_alone_are_parted() {
    let table = Table::parse("t,x,y z\n", HeadingLine::First).expect("a table");
    assert_eq!(table.headings(), ["t", "x", "y z"]);
}

#[test]
fn notes_and_blank_lines_are_told() {
    let text = "# Surface: 0.03, 0.65\nx y\n\n0 0\n1 1\n\n\n2 2\n,\n3 3\n4 4\n\"# source: me\";;\n";
    let table = parsed(text);
    let blocks: Vec<usize> = table.rows().map(|row| row.block()).collect();
    assert_eq!(blocks, [0, 0, 1, 2, 2]);
    let notes: Vec<(usize, &str, &str)> = table
        .notes()
        .iter()
        .map(|note| (note.line, &*note.key, &*note.value))
        .collect();
    assert_eq!(notes, [(1, "surface", "0.03, 0.65"), (12, "source", "me")]);
    assert_eq!((table.first_line(), table.last_line()), (2, 12));
    // Line ends that were written twice part nothing, but more of them do.
    let twice = parsed("0 0\r\r\n1 1\r\r\n\r\r\n2 2\r\r\n3 3\r\r\n");
    let blocks: Vec<usize> = twice.rows().map(|row| row.block()).collect();
    assert_eq!(blocks, [0, 0, 1, 1]);
}

#[test]
fn what_is_wrong_has_its_line_and_column() {
    let fault = |text: &str, heading| Table::parse(text, heading).expect_err("refused");
    let wide = fault("a,b\n\n1,2,3", HeadingLine::First);
    assert_eq!(wide.line, 3);
    assert!(matches!(
        wide.fault,
        Fault::Wide {
            cells: 3,
            columns: 2
        }
    ));
    let open = fault("a,b\n1,\"2\n3,4\n", HeadingLine::First);
    assert_eq!((open.line, open.fault), (2, Fault::OpenQuote));
    let long = fault(
        &format!("1,2\n3,{}\n", "x".repeat(100_000)),
        HeadingLine::Row,
    );
    assert_eq!((long.line, long.column), (2, Some(2)));
    assert!(matches!(
        long.fault,
        Fault::LongCell {
            characters: 100_000
        }
    ));
    let table = parsed("x,y\n1,one\n");
    let word = table
        .rows()
        .next()
        .expect("a row")
        .number(1)
        .expect_err("a word");
    assert_eq!((word.line, word.column, &*word.heading), (2, Some(2), "y"));
    let columns = |text: &str| parsed(text).columns(["x", "y"]).expect_err("refused").fault;
    assert!(matches!(columns("x,z\n1,2\n"), Fault::UnknownColumn { name } if name == "z"));
    assert!(matches!(columns("x,X\n1,2\n"), Fault::TwiceNamed { name } if name == "X"));
    assert!(matches!(
        columns("1,2,3\n"),
        Fault::Wide {
            cells: 3,
            columns: 2
        }
    ));
    assert!(shown(&"x".repeat(100_000)).len() < 200);
}

#[test]
fn a_mark_of_thousands_is_refused() {
    let row = |text: &str| {
        let table = parsed(text);
        let row = table.rows().next().expect("a row");
        row.number(1).map_err(|error| error.fault)
    };
    for text in [
        "380;1,234\n",
        "380\t1,234\n400\t0.5\n",
        "380;1.234\n400;0,5\n",
    ] {
        assert!(
            matches!(row(text), Err(Fault::TwoReadings { .. })),
            "{text}"
        );
    }
    assert_eq!(row("380;1,234\n400;0,5\n"), Ok(1.234));
    assert_eq!(row("380;1.234\n"), Ok(1.234));
}

#[test]
fn text_of_spreadsheets_is_decoded() {
    let text = "x,y\n1,2−\n";
    let units = || text.encode_utf16();
    let little: Vec<u8> = [0xFEFF]
        .into_iter()
        .chain(units())
        .flat_map(u16::to_le_bytes)
        .collect();
    let big: Vec<u8> = [0xFEFF]
        .into_iter()
        .chain(units())
        .flat_map(u16::to_be_bytes)
        .collect();
    let marked = [b"\xEF\xBB\xBF", text.as_bytes()].concat();
    for bytes in [&little, &big, &marked, &text.as_bytes().to_vec()] {
        assert_eq!(decode(bytes).expect("text"), text);
    }
    for bytes in [
        &b"x,y\rGr\xFC\xDFe,1\n"[..],
        &little[..little.len() - 1],
        b"a\r\nb\n\xFF",
    ] {
        let error = decode(bytes).expect_err("no text");
        assert_eq!(error.fault, Fault::NotText);
        assert!(error.line >= 2, "{}", error.line);
    }
}
