//! The C reader against this program's own, over the golden bytes of every message.

use std::path::{Path, PathBuf};
use std::process::Command;

use maulstick_streams::catalogue::message_of;
use maulstick_streams::{FieldTable, Value};
use maulstick_types::{CATALOGUE, HEADER_BYTES, Header};

use super::header;

fn in_tree(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

/// Output of `tests/c/golden.c` for the golden bytes, with this header.
fn printed(header: &str) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("maulstick.h"), header).expect("written");
    let program = folder.path().join("golden");
    let compiled = Command::new("cc")
        .args(["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror"])
        .args(["-g", "-fsanitize=address,undefined", "-I"])
        .arg(folder.path())
        .arg(in_tree("tests/c/golden.c"))
        .arg("-o")
        .arg(&program)
        .output()
        .expect("a C compiler");
    assert!(
        compiled.status.success(),
        "{}",
        String::from_utf8_lossy(&compiled.stderr)
    );
    let golden = in_tree("msgs/types/tests/golden.txt");
    let ran = Command::new(program).arg(golden).output().expect("started");
    assert!(
        ran.status.success(),
        "{}",
        String::from_utf8_lossy(&ran.stderr)
    );
    String::from_utf8(ran.stdout).expect("text")
}

/// A value as `tests/c/golden.c` prints it, with its path.
fn add_lines(path: &str, value: &Value, lines: &mut Vec<String>) {
    let below = |name: &str| match path {
        "" => name.to_owned(),
        path => format!("{path}.{name}"),
    };
    let mut add = |what: String| lines.push(format!("{path}\t{what}"));
    match value {
        Value::Fields(fields) => {
            for (name, value) in fields {
                add_lines(&below(name), value, lines);
            }
        }
        Value::Variant(own, fields) => {
            add(own.to_string());
            for (name, value) in fields {
                add_lines(&format!("{}.{name}", below(own)), value, lines);
            }
        }
        Value::List(list) => {
            add(list.len().to_string());
            for (place, value) in list.iter().enumerate() {
                add_lines(&below(&place.to_string()), value, lines);
            }
        }
        Value::Unsigned(value) => add(value.to_string()),
        Value::Signed(value) => add(value.to_string()),
        Value::Flag(value) => add(u8::from(*value).to_string()),
        Value::Single(value) => add(f64::from(*value).to_string()),
        Value::Real(value) => add(value.to_string()),
        Value::Text(text) => add(text.clone()),
        Value::Bytes(bytes) => add(bytes.iter().map(|byte| format!("{byte:02x}")).collect()),
        Value::Absent => add("absent".into()),
    }
}

/// The golden messages as this program reads them.
fn expected() -> Vec<String> {
    let golden = std::fs::read_to_string(in_tree("msgs/types/tests/golden.txt")).expect("read");
    let mut lines = Vec::new();
    for line in golden.lines() {
        let words: Vec<&str> = line.split(' ').collect();
        lines.push(words[0].to_owned());
        let byte = |at: usize| u8::from_str_radix(&words[2][at..at + 2], 16).expect("a byte");
        let bytes: Vec<u8> = (0..words[2].len()).step_by(2).map(byte).collect();
        let header = Header::from_bytes(&bytes).expect("a header");
        let entry = message_of(header.schema).expect("a message");
        let table = FieldTable::of((entry.schema)()).expect("a table");
        let value = table.decode(&bytes[HEADER_BYTES..]).expect("decoded");
        add_lines("", &value, &mut lines);
    }
    lines
}

/// True for the same text, or the same number in other words.
fn agree(c: &str, rust: &str) -> bool {
    let number = |line: &str| {
        let (path, cell) = line.split_once('\t')?;
        Some((path.to_owned(), cell.parse::<f64>().ok()?.to_bits()))
    };
    c == rust || (number(c).is_some() && number(c) == number(rust))
}

#[test]
fn c_reads_every_golden_message() {
    let all: Vec<_> = CATALOGUE.iter().collect();
    let text = header(&all);
    let expected = expected();
    let differing = |printed: &str| {
        let lines: Vec<&str> = printed.lines().collect();
        assert_eq!(lines.len(), expected.len());
        let pairs = lines.into_iter().zip(&expected);
        let pairs = pairs.filter(|(c, rust)| !agree(c, rust));
        pairs.map(|(c, _)| c.to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(differing(&printed(&text)), [""; 0]);
    // A reader that takes the bytes of floats for whole numbers is found out.
    let wrong = text.replace("{MAULSTICK_F32, ", "{MAULSTICK_U32, ");
    assert!(!differing(&printed(&wrong)).is_empty());
}

#[test]
fn the_header_of_one_message_has_its_types_alone() {
    let sample = CATALOGUE.iter().find(|entry| entry.name == "StylusSample");
    let text = header(&[sample.expect("in the catalogue")]);
    assert!(text.contains("{\"StylusSample\", "), "{text}");
    assert!(text.contains("StylusPose.Contact"), "{text}");
    assert!(!text.contains("BrushState"), "{text}");
}
