//! What the documents say twice is the same, and tables of measurements have one form.

use std::collections::BTreeSet;
use std::path::Path;

const README: &str = include_str!("../README.md");
const PERFORMANCE: &str = include_str!("../docs/performance.md");

/// Columns of a table of measurements, which `maulstick bench --csv` appends to.
const COLUMNS: &str = "date,machine,adapter,command,what,value,unit,note";

/// The numbers of a text, as they are written.
fn numbers(text: &str) -> BTreeSet<&str> {
    let part = |c: char| c.is_ascii_digit() || c == '.' || c == ',';
    text.split(|c: char| !part(c))
        .map(|word| word.trim_end_matches(['.', ',']))
        .filter(|word| word.contains(|c: char| c.is_ascii_digit()))
        .collect()
}

/// The part of a text below a heading.
fn below<'a>(text: &'a str, heading: &str) -> &'a str {
    let (_, rest) = text.split_once(heading).expect("a heading");
    rest.split_once("\n## ").map_or(rest, |(part, _)| part)
}

/// Numbers of a README's section on speed that the page on performance lacks.
fn unmeasured(readme: &str) -> Vec<String> {
    let measured = numbers(PERFORMANCE);
    let stated = numbers(below(readme, "\n## How fast\n"));
    assert!(stated.len() >= 5, "too few numbers: {stated:?}");
    stated
        .difference(&measured)
        .map(|number| (*number).to_owned())
        .collect()
}

#[test]
fn readme_numbers_are_measured() {
    assert_eq!(unmeasured(README), Vec::<String>::new());
}

#[test]
fn a_readme_number_that_was_never_measured_is_found() {
    let steps = "23,554";
    assert!(README.contains(steps));
    assert_eq!(unmeasured(&README.replace(steps, "23,580")), ["23,580"]);
}

/// The cells of a line of comma-separated values, without their quotes.
fn cells(line: &str) -> Vec<String> {
    let (mut cells, mut cell, mut is_quoted) = (Vec::new(), String::new(), false);
    for c in line.chars() {
        match c {
            '"' => is_quoted = !is_quoted,
            ',' if !is_quoted => cells.push(std::mem::take(&mut cell)),
            _ => cell.push(c),
        }
    }
    cells.push(cell);
    cells
}

#[test]
fn each_measurement_has_all_columns_a_number_and_one_row() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/measurements");
    let mut tables = 0;
    for entry in std::fs::read_dir(&folder).expect("the tables") {
        let path = entry.expect("a table").path();
        let name = path
            .file_name()
            .and_then(|name| name.to_str())
            .expect("a name");
        let is_linked = PERFORMANCE.contains(&format!("(measurements/{name})"));
        assert!(is_linked, "docs/performance.md does not link {name}");
        let text = std::fs::read_to_string(&path).expect("text");
        let mut lines = text.lines();
        assert_eq!(lines.next(), Some(COLUMNS), "{name}");
        let mut rows = BTreeSet::new();
        for line in lines {
            let row: [String; 8] = cells(line).try_into().expect(line);
            let [date, machine, adapter, command, what, value, ..] = &row;
            assert_eq!(date.split('-').count(), 3, "{name}: {line}");
            assert!(
                value.parse::<f64>().is_ok_and(f64::is_finite),
                "{name}: {line}"
            );
            let key = [machine, adapter, command, what];
            assert!(key.iter().all(|cell| !cell.is_empty()), "{name}: {line}");
            let is_new = rows.insert(key.map(String::clone));
            assert!(is_new, "{name}: a second row of the same: {line}");
        }
        tables += 1;
    }
    assert!(tables >= 4, "{tables}");
    assert_eq!(cells("a,\"b, c\",").join("|"), "a|b, c|");
}
