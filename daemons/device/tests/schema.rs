//! A take decoded by what its own file says, without anything of this program's.

use std::collections::BTreeMap;

use maulstick_device::{Take, TakeSample};
use maulstick_types::stylus::{StylusPose, StylusSample};
use maulstick_types::wire::schema::ENCODING;
use serde_json::{Map, Value, json};

/// Bytes that are read one after the other.
struct Bytes<'a>(&'a [u8]);

impl Bytes<'_> {
    fn take<const N: usize>(&mut self) -> [u8; N] {
        let (head, rest) = self.0.split_first_chunk().expect("enough bytes");
        self.0 = rest;
        *head
    }

    /// A value of a type that the schema names.
    fn value(&mut self, ty: &str, types: &Value) -> Value {
        if let Some((inner, count)) = ty.strip_prefix('[').and_then(|ty| ty.rsplit_once("; ")) {
            let count: usize = count.trim_end_matches(']').parse().expect("a count");
            return (0..count).map(|_| self.value(inner, types)).collect();
        }
        match ty {
            "u8" => json!(self.take::<1>()[0]),
            "bool" => json!(self.take::<1>()[0] == 1),
            "u16" => json!(u16::from_le_bytes(self.take())),
            "u32" => json!(u32::from_le_bytes(self.take())),
            "u64" => json!(u64::from_le_bytes(self.take())),
            "f64" => json!(f64::from_le_bytes(self.take())),
            named => {
                let shape = types[named]
                    .as_object()
                    .expect("the schema says what it is");
                if let Some(fields) = shape.get("struct") {
                    return self.fields(fields, types);
                }
                let tag = u32::from_le_bytes(self.take()) as usize;
                let variant = &shape["enum"][tag];
                let name = variant["name"].as_str().expect("a name");
                json!({ name: self.fields(&variant["fields"], types) })
            }
        }
    }

    fn fields(&mut self, fields: &Value, types: &Value) -> Value {
        let mut object = Map::new();
        for field in fields.as_array().expect("fields") {
            let text = |key: &str| field[key].as_str().expect("a text");
            object.insert(text("name").into(), self.value(text("type"), types));
        }
        object.into()
    }
}

#[test]
fn the_file_alone_tells_how_its_samples_are_decoded() {
    let sample = |i: u64| TakeSample {
        time_ns: i * 8_000_000,
        sample: StylusSample {
            pose: StylusPose::Contact {
                point_m: [0.01 * i as f64, -0.25, 0.0],
                tilt_rad: [0.1, -0.2],
                twist_rad: 0.0,
                pressure: 0.5,
            },
            in_range: true,
            ..StylusSample::away()
        },
    };
    let take = Take {
        device: "pen".into(),
        samples: (0..7).map(sample).collect(),
        setup: None,
    };
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.mcap");
    take.write(&path).expect("written");
    let file = std::fs::read(&path).expect("read");
    let mut schemas: BTreeMap<u16, Value> = BTreeMap::new();
    let mut number = 0;
    for message in mcap::MessageStream::new(&file).expect("an MCAP file") {
        let message = message.expect("whole");
        let schema = message.channel.schema.as_ref().expect("a schema");
        let schema = schemas
            .entry(schema.id)
            .or_insert_with(|| serde_json::from_slice(&schema.data).expect("JSON"));
        assert_eq!(schema["encoding"], ENCODING);
        let mut bytes = Bytes(&message.data);
        let header = bytes.fields(&schema["header"], &schema["types"]);
        assert_eq!(header["schema"], schema["hash"]);
        assert_eq!(header["length"], bytes.0.len());
        assert_eq!(
            (&header["seq"], &header["event_ns"]),
            (&json!(number), &json!(message.log_time))
        );
        let body = bytes.value(schema["name"].as_str().expect("a name"), &schema["types"]);
        assert!(
            bytes.0.is_empty(),
            "{} bytes are not told of",
            bytes.0.len()
        );
        assert_eq!(
            body["pose"]["Contact"]["point_m"],
            json!([0.01 * number as f64, -0.25, 0.0])
        );
        assert_eq!(body["pose"]["Contact"]["pressure"], 0.5);
        assert_eq!(body["in_range"], true);
        number += 1;
    }
    assert_eq!(number, 7);
}
