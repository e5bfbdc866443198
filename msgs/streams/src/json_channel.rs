//! Messages as JSON channels, which viewers such as Foxglove read: the fields of a message beside its header.

use maulstick_types::Header;
use serde_json::{Value as Json, json};

use crate::FieldTable;
use crate::Value;

/// Encoding of the messages.
pub const MESSAGE_ENCODING: &str = "json";
/// Encoding of the schemas.
pub const SCHEMA_ENCODING: &str = "jsonschema";
/// The field of the header; no message has another of this name.
const HEADER: &str = "header";

/// JSON Schema of the messages of a table.
#[must_use]
pub fn schema(table: &FieldTable) -> Vec<u8> {
    let mut schema = table.json_schema();
    let integer = json!({ "type": "integer" });
    let number = json!({ "type": "number" });
    schema["title"] = table.name().into();
    schema["properties"][HEADER] = json!({
        "type": "object",
        "properties": {
            "stamp": {
                "type": "object",
                "title": "time",
                "properties": { "sec": integer, "nsec": integer },
            },
            "seq": integer,
            "delay_ms": number,
            "age_ms": number,
        },
    });
    schema.to_string().into_bytes()
}

/// A message: its fields without those that are absent, and `header` with the time of its event (`stamp`), its number
/// (`seq`), and how long before its arrival it was sent (`delay_ms`) and its event happened (`age_ms`).
#[must_use]
pub fn message(header: &Header, arrived_ns: u64, value: &Value) -> Json {
    let mut json = json!(value);
    drop_absent(&mut json);
    // The table of a foreign file may be one of a plain value.
    if !json.is_object() {
        json = json!({ "value": json });
    }
    let Header { seq, event_ns, .. } = header;
    let since_ms = |then_ns: u64| arrived_ns.wrapping_sub(then_ns).cast_signed() as f64 * 1e-6;
    json[HEADER] = json!({
        "stamp": { "sec": event_ns / 1_000_000_000, "nsec": event_ns % 1_000_000_000 },
        "seq": seq,
        "delay_ms": since_ms(header.sent_ns),
        "age_ms": since_ms(*event_ns),
    });
    json
}

/// Leaves out the fields that are null: a schema has one type for each.
fn drop_absent(json: &mut Json) {
    match json {
        Json::Object(fields) => {
            fields.retain(|_, value| !value.is_null());
            fields.values_mut().for_each(drop_absent);
        }
        Json::Array(list) => list.iter_mut().for_each(drop_absent),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use maulstick_types::{CATALOGUE, HEADER_BYTES};

    use super::*;
    use crate::catalogue::KnownTables;

    /// True if a value is what a schema says; what the schema does not name is free.
    fn fits(schema: &Json, json: &Json) -> bool {
        let needed = schema["required"].as_array().into_iter().flatten();
        match schema["type"].as_str() {
            Some("object") => {
                let named = schema["properties"].as_object().into_iter().flatten();
                json.is_object()
                    && needed
                        .filter_map(Json::as_str)
                        .all(|name| !json[name].is_null())
                    && named
                        .into_iter()
                        .all(|(name, of)| json[name].is_null() || fits(of, &json[name]))
            }
            Some("array") => {
                let mut list = json.as_array().into_iter().flatten();
                json.is_array() && list.all(|own| fits(&schema["items"], own))
            }
            Some("integer") => json.is_u64() || json.is_i64(),
            Some("number") => json.is_number(),
            Some("boolean") => json.is_boolean(),
            Some("string") => {
                let text = json.is_string();
                text && schema["enum"]
                    .as_array()
                    .is_none_or(|names| names.contains(json))
            }
            _ => false,
        }
    }

    /// True if Foxglove reads a schema: it knows no references, no nulls and no lists of lists.
    fn is_readable(schema: &Json) -> bool {
        match schema["type"].as_str() {
            Some("object") => schema["properties"]
                .as_object()
                .is_some_and(|named| named.values().all(is_readable)),
            Some("array") => schema["items"]["type"] != "array" && is_readable(&schema["items"]),
            Some(scalar) => ["boolean", "integer", "number", "string"].contains(&scalar),
            None => false,
        }
    }

    fn parsed(table: &FieldTable) -> Json {
        serde_json::from_slice(&schema(table)).expect("JSON")
    }

    #[test]
    fn every_message_has_a_readable_schema_beside_a_header() {
        for entry in CATALOGUE {
            let table = FieldTable::of((entry.schema)()).expect(entry.name);
            assert!(!table.has(HEADER), "{}", entry.name);
            let schema = parsed(&table);
            assert!(is_readable(&schema), "{}: {schema}", entry.name);
        }
    }

    /// Schema and JSON of each golden message: its name, and its bytes, sent 4 ms after its event and 1 ms on the way.
    fn golden() -> impl Iterator<Item = (&'static str, Json, Json)> {
        let lines = include_str!("../../types/tests/golden.txt").lines();
        lines.map(|line| {
            let words: Vec<&str> = line.split(' ').collect();
            let digits = words[2].as_bytes().chunks(2);
            let digits = digits.map(|pair| std::str::from_utf8(pair).expect("ASCII"));
            let bytes = digits.map(|pair| u8::from_str_radix(pair, 16).expect("hex"));
            let bytes: Vec<u8> = bytes.collect();
            let header = Header {
                event_ns: 2_000_000_007,
                sent_ns: 2_004_000_007,
                ..Header::from_bytes(&bytes).expect("a header")
            };
            let mut tables = KnownTables::default();
            let table = tables.of(header.schema).expect(words[0]);
            let value = table.decode(&bytes[HEADER_BYTES..]).expect("decoded");
            let json = message(&header, header.sent_ns + 1_000_000, &value);
            (words[0], parsed(table), json)
        })
    }

    #[test]
    fn every_message_is_what_its_schema_says() {
        for (name, schema, mut json) in golden() {
            assert!(fits(&schema, &json), "{name}: {json}");
            let header = &json["header"];
            assert_eq!(header["stamp"], json!({ "sec": 2, "nsec": 7 }));
            assert_eq!(
                (&header["delay_ms"], &header["age_ms"]),
                (&1.0.into(), &5.0.into())
            );
            json["header"]["seq"] = "5".into();
            assert!(!fits(&schema, &json), "{name}");
        }
    }

    #[test]
    fn an_alternative_is_an_object_and_what_is_absent_is_left_out() {
        let of = |name: &'static str| golden().filter(move |(own, ..)| own.starts_with(name));
        let (_, schema, sample) = of("StylusSample/").next().expect("a pen's");
        assert_eq!(sample["pose"]["Contact"]["tilt_rad"], json!([0.1, -0.1]));
        assert!(schema["properties"]["pose"]["properties"]["Ferrule"].is_object());
        let laws: Vec<Json> = of("ContactModel/")
            .map(|(.., model)| model["law"].clone())
            .collect();
        assert!(laws.iter().all(Json::is_object), "{laws:?}");
        let mut status = json!(Value::Fields(vec![("end".into(), Value::Absent)]));
        drop_absent(&mut status);
        assert_eq!(status, json!({}));
    }

    #[test]
    fn a_table_without_end_has_a_schema() {
        let fields = ["a", "b", "c"].map(|name| format!(r#"{{"name": "{name}", "type": "A"}}"#));
        let json = format!(
            r#"{{"name": "A", "hash": 1, "types": {{"A": {{"struct": [{}]}}}}}}"#,
            fields.join(",")
        );
        let table = FieldTable::parse(json.as_bytes()).expect("a table");
        assert!(is_readable(&parsed(&table)));
    }
}
