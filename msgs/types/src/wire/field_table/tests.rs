//! Tables of the rig's own messages and hostile ones.

use std::sync::LazyLock;

use proptest::prelude::*;

use crate::stylus::{StylusPose, StylusSample};
use crate::{CATALOGUE, Flags, Message as _, Origin, encode};

use super::*;

/// A body of a sample: what a message holds behind its header.
fn body(sample: &StylusSample) -> Vec<u8> {
    let origin = Origin {
        source: 1,
        epoch: 1,
    };
    let bytes = encode(&origin, Flags::NONE, 0, 0, 0, sample).expect("encoded");
    bytes[48..].to_vec()
}

fn sample() -> StylusSample {
    StylusSample {
        pose: StylusPose::Contact {
            point_m: [0.25, -0.5, 0.0],
            tilt_rad: [0.1, 0.2],
            twist_rad: 3.0,
            pressure: 0.75,
        },
        switches: 5,
        in_range: true,
        ..StylusSample::away()
    }
}

#[test]
fn every_message_of_the_rig_has_a_readable_table() {
    for entry in CATALOGUE {
        let schema = (entry.schema)();
        let table = FieldTable::of(schema).expect(entry.name);
        assert_eq!((table.name(), table.hash()), (entry.name, schema.hash));
    }
}

#[test]
fn a_body_is_read_by_name() {
    let table = FieldTable::of(StylusSample::schema()).expect("a table");
    let mut bytes = body(&sample());
    let value = table.decode(&bytes).expect("read");
    let json = serde_json::to_value(&value).expect("JSON");
    assert_eq!(json["pose"]["Contact"]["point_m"][1], -0.5);
    assert_eq!(json["pose"]["Contact"]["pressure"], 0.75);
    assert_eq!(
        (&json["switches"], &json["in_range"]),
        (&5.into(), &true.into())
    );
    bytes.extend([1, 2, 3]);
    assert_eq!(
        table.decode(&bytes),
        Ok(value),
        "what a newer version appends"
    );
    for cut in 0..body(&sample()).len() {
        assert!(table.decode(&bytes[..cut]).is_err(), "{cut}");
    }
}

#[test]
fn a_path_may_lead_through_an_alternative_that_a_message_does_not_have() {
    let table = FieldTable::of(StylusSample::schema()).expect("a table");
    for path in [
        "pose.Contact.pressure",
        "pose.pressure",
        "pose.Ferrule.pose.position_m.2",
        "pose.Ferrule",
        "velocity_m_s",
    ] {
        assert!(table.has(path), "{path}");
    }
    for path in [
        "pose.preasure",
        "pose.Contact.pose",
        "velocity_m_s.3",
        "switches.0",
        "",
    ] {
        assert!(!table.has(path), "{path}");
    }
}

#[test]
fn what_is_wrong_is_told_with_its_field() {
    let table = FieldTable::of(StylusSample::schema()).expect("a table");
    let bytes = body(&sample());
    let told = |bytes: &[u8]| table.decode(bytes).expect_err("wrong").to_string();
    assert_eq!(told(&bytes[..2]), "the message ends within 'senses'");
    assert_eq!(told(&bytes[..20]), "the message ends within 'pose.point_m'");
    let mut other = bytes.clone();
    other[4] = 9;
    assert_eq!(told(&other), "'pose' is alternative 9 of 2");
    let mut flag = bytes;
    *flag.last_mut().expect("a byte") = 7;
    assert_eq!(told(&flag), "'in_range' is 7, and neither 0 nor 1");
}

#[test]
fn a_table_that_refers_to_itself_or_to_nothing_is_told() {
    let table = |types: &str| {
        let json = format!(r#"{{"name": "A", "hash": 1, "types": {types}}}"#);
        FieldTable::parse(json.as_bytes())
    };
    let own = table(r#"{"A": {"struct": [{"name": "a", "type": "A"}]}}"#).expect("a table");
    assert!(own.decode(&[]).is_err());
    let list =
        table(r#"{"A": {"struct": []}, "B": {"struct": [{"name": "a", "type": "Vec<A>"}]}}"#);
    assert!(list.is_ok());
    let endless =
        r#"{"A": {"struct": [{"name": "a", "type": "[B; 1000000000000]"}]}, "B": {"struct": []}}"#;
    assert!(table(endless).expect("a table").decode(&[0; 8]).is_err());
    let level = |name: &str, of: &str| {
        let fields =
            ["a", "b", "c", "d"].map(|own| format!(r#"{{"name": "{own}", "type": "{of}"}}"#));
        format!(r#""{name}": {{"struct": [{}]}}"#, fields.join(","))
    };
    let names: Vec<String> = (0..26u8)
        .map(|at| char::from(b'A' + at).to_string())
        .collect();
    let mut levels: Vec<String> = names
        .windows(2)
        .map(|pair| level(&pair[0], &pair[1]))
        .collect();
    levels.push(r#""Z": {"struct": []}"#.into());
    let branching = table(&format!("{{{}}}", levels.join(","))).expect("a table");
    assert!(branching.decode(&[]).is_err());
    let nothing = table(r#"{"A": {"struct": [{"name": "a", "type": "Vec<C>"}]}}"#);
    assert_eq!(nothing, Err(TableError::Type("C".into())));
    assert_eq!(table("{}"), Err(TableError::Type("A".into())));
    let deep = format!("{}u8{}", "Vec<".repeat(99), ">".repeat(99));
    let deep = table(&format!(
        r#"{{"A": {{"struct": [{{"name": "a", "type": "{deep}"}}]}}}}"#
    ));
    assert!(deep.is_err());
    assert!(FieldTable::parse(b"[1]").is_err());
}

static TABLES: LazyLock<Vec<FieldTable>> = LazyLock::new(|| {
    let tables = CATALOGUE
        .iter()
        .map(|entry| FieldTable::of((entry.schema)()));
    tables.collect::<Result<_, _>>().expect("tables")
});

proptest! {
    #[test]
    fn no_bytes_make_it_panic(
        place in 0..CATALOGUE.len(),
        bytes in prop::collection::vec(any::<u8>(), 0..400),
    ) {
        TABLES[place].decode(&bytes).ok();
    }
}
