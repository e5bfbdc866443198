//! The page of a device's messages has each of their fields.

use std::collections::BTreeSet;

use maulstick_types::CATALOGUE;
use maulstick_types::stylus::axes;
use maulstick_types::wire::schema::Shape;

/// The page.
const PAGE: &str = include_str!("../../../docs/messages.md");
/// Messages that it describes, each with the types inside them whose fields have rows of their own.
const MESSAGES: [(&str, &[&str]); 4] = [
    ("StylusSample", &["StylusPose", "Pose"]),
    ("StylusInfo", &[]),
    ("ContactModel", &[]),
    ("StylusStatus", &[]),
];

/// Names of the fields of a type.
fn fields(shape: &Shape) -> Vec<&str> {
    match shape {
        Shape::Struct(fields) => fields.iter().map(|own| own.name.as_str()).collect(),
        Shape::Enum(variants) => variants
            .iter()
            .flat_map(|own| &own.fields)
            .map(|own| own.name.as_str())
            .collect(),
    }
}

#[test]
fn each_field_of_a_devices_messages_has_a_row_in_its_section() {
    for (name, inner) in MESSAGES {
        let section = PAGE.split("\n## ").find(|text| text.starts_with(name));
        let section = section.expect(name);
        let rows = section.lines().filter(|line| line.starts_with("| `"));
        let listed: BTreeSet<&str> = rows
            .flat_map(|row| {
                row.split('|')
                    .nth(1)
                    .unwrap_or("")
                    .split('`')
                    .skip(1)
                    .step_by(2)
            })
            .collect();
        let entry = CATALOGUE.iter().find(|entry| entry.name == name);
        let types = &(entry.expect(name).schema)().types;
        for kind in std::iter::once(&name).chain(inner) {
            for field in fields(types.get(kind).expect(kind)) {
                let is_there = listed.contains(field);
                assert!(
                    is_there,
                    "{name}: {kind}.{field} is not in docs/messages.md"
                );
            }
        }
    }
}

#[test]
fn the_bits_of_the_page_are_those_of_the_messages() {
    for (value, word) in [
        (axes::POSITION, "POSITION"),
        (axes::ORIENTATION, "ORIENTATION"),
        (axes::PRESSURE, "PRESSURE"),
        (axes::TILT, "TILT"),
        (axes::TWIST, "TWIST"),
        (axes::SWITCHES, "SWITCHES"),
        (axes::PROXIMITY, "PROXIMITY"),
        (axes::FORCE, "FORCE"),
        (axes::VELOCITY, "VELOCITY"),
        (axes::TORQUE, "TORQUE"),
    ] {
        let row = format!("| {} | {value} |", value.trailing_zeros());
        let found = PAGE
            .lines()
            .find(|line| line.ends_with(&format!("| `{word}` |")));
        assert!(found.is_some_and(|line| line.starts_with(&row)), "{word}");
    }
}
