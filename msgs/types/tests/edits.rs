//! All edits of the one list on the wire: what is sent comes back, and what is out of range does not decode.

use maulstick_types::command::CommandRequest;
use maulstick_types::edits::{Edit, examples};
use maulstick_types::wire::schema::{Shape, TypeTable};
use maulstick_types::{Flags, Message as _, Origin, decode, encode};

const ORIGIN: Origin = Origin {
    source: 1,
    epoch: 2,
};

fn request(edit: Edit) -> CommandRequest {
    CommandRequest {
        client: 1,
        number: 2,
        after: None,
        command: edit.into(),
    }
}

fn bytes(edit: Edit) -> Vec<u8> {
    encode(&ORIGIN, Flags::NONE, 3, 4, 5, &request(edit)).expect("within its limit")
}

#[test]
fn each_edit_comes_back_from_its_bytes() {
    for edit in examples().expect("in range") {
        let (_, back) = decode::<CommandRequest>(&bytes(edit.clone())).expect("its own bytes");
        assert_eq!(back, request(edit));
    }
}

/// Floating-point fields of a type, of those that the field table knows.
fn floats(table: &TypeTable, name: &str) -> usize {
    let inner = |name: &str, of: &str| Some(name.strip_prefix(of)?.strip_suffix('>')?.to_owned());
    if name == "f32" || name == "f64" {
        return 1;
    }
    if let Some(name) = inner(name, "Option<").or_else(|| inner(name, "Vec<")) {
        return floats(table, &name);
    }
    if name.starts_with('[') {
        return usize::from(name.contains("f64") || name.contains("f32"));
    }
    match table.get(name) {
        Some(Shape::Struct(fields)) => fields.iter().map(|field| floats(table, &field.ty)).sum(),
        Some(Shape::Enum(variants)) => {
            let fields = variants.iter().flat_map(|variant| &variant.fields);
            fields.map(|field| floats(table, &field.ty)).sum()
        }
        None => 0,
    }
}

/// Each edit with a number is tried with NaN in the place of each of its eight, or four, bytes: if it decodes, that
/// was no number with a range, and nothing that decodes holds a NaN.
#[test]
fn no_edit_decodes_with_a_number_that_is_none() {
    let table = &CommandRequest::schema().types;
    for edit in examples().expect("in range") {
        let whole = bytes(edit.clone());
        let name = format!("{edit:?}");
        let name = name.split('(').next().unwrap_or_default();
        let mut rejected = 0;
        for nan in [
            f64::NAN.to_le_bytes().to_vec(),
            f32::NAN.to_le_bytes().to_vec(),
        ] {
            for at in 48 + 8 + 8 + 1 + 8..whole.len().saturating_sub(nan.len() - 1) {
                let mut bytes = whole.clone();
                bytes[at..at + nan.len()].copy_from_slice(&nan);
                match decode::<CommandRequest>(&bytes) {
                    Ok((_, back)) => assert!(!format!("{back:?}").contains("NaN"), "{back:?}"),
                    Err(_) => rejected += 1,
                }
            }
        }
        assert!(
            rejected > 0 || floats(table, name) == 0,
            "{name} is never rejected"
        );
    }
}

#[test]
fn a_request_out_of_range_still_has_its_number() {
    let edit = maulstick_types::edits::Dry::whole(0);
    let mut bytes = bytes(edit.into());
    assert_eq!(CommandRequest::number_in(&bytes), Some(2));
    // Client, number, no place, two tags, and the share.
    let at = 48 + 8 + 8 + 1 + 4 + 4;
    bytes[at..at + 4].copy_from_slice(&2.0f32.to_le_bytes());
    let error = decode::<CommandRequest>(&bytes)
        .expect_err("out of range")
        .to_string();
    assert!(error.contains("a share of 2 is out of range"), "{error}");
    assert_eq!(CommandRequest::number_in(&bytes), Some(2));
}
