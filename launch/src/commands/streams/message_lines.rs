//! Messages as rows of a table of comma-separated values, and as lines of JSON.

use std::collections::BTreeMap;

use maulstick_rig::UserError;
use maulstick_streams::Value;
use maulstick_streams::recording::{RecordedMessage, Topic};
use maulstick_types::Header;
use serde_json::{Value as Json, json};

/// A decoded message.
pub(super) struct MessageLine<'a> {
    /// Its topic.
    pub topic: &'a str,
    /// Its header.
    pub header: &'a Header,
    /// When it arrived, rig clock, ns.
    pub arrived_ns: u64,
    /// Its fields.
    pub value: &'a Value,
}

impl MessageLine<'_> {
    /// As a line of JSON: all of its fields, or the requested ones, null where absent.
    #[must_use]
    pub(super) fn json(&self, fields: &[String]) -> String {
        let value: Json = match fields {
            [] => json!(self.value),
            fields => {
                let fields = fields.iter().map(|path| (path, self.value.at(path)));
                json!(fields.collect::<BTreeMap<_, _>>())
            }
        };
        let line = json!({
            "topic": self.topic,
            "seq": self.header.seq,
            "event_ns": self.header.event_ns,
            "sent_ns": self.header.sent_ns,
            "arrived_ns": self.arrived_ns,
            "value": value,
        });
        format!("{line}\n")
    }

    /// As a row of a table whose first columns are [`HEAD`]; empty where a field is absent.
    #[must_use]
    pub(super) fn row(&self, columns: &[String]) -> String {
        let Header { seq, event_ns, .. } = self.header;
        let mut row = format!("{},{},{seq},{event_ns}", self.topic, self.arrived_ns);
        for path in columns {
            row.push(',');
            row += &quoted(&self.value.at(path).map(Value::cell).unwrap_or_default());
        }
        row + "\n"
    }
}

/// The first columns of a table.
const HEAD: &str = "topic,arrived_ns,seq,event_ns";

/// The head of a table.
#[must_use]
pub(super) fn head(columns: &[String]) -> String {
    let columns = columns.iter().map(|column| format!(",{column}"));
    format!("{HEAD}{}\n", columns.collect::<String>())
}

/// A cell of comma-separated values (RFC 4180).
fn quoted(cell: &str) -> String {
    if cell.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", cell.replace('"', "\"\""))
    } else {
        cell.to_owned()
    }
}

/// What a message holds.
///
/// # Errors
/// A [`UserError`] where it cannot be decoded.
pub(super) fn decoded(topic: &Topic, message: &RecordedMessage) -> Result<Value, UserError> {
    topic.decode(&message.bytes).map_err(|error| {
        let seq = message.header.seq;
        UserError::failure(format!("{}, message {seq}: {error}", topic.name))
            .help("a newer version of Maulstick may know it")
    })
}

#[cfg(test)]
mod tests {
    use maulstick_types::Flags;

    use super::*;

    #[test]
    fn a_row_quotes_what_a_table_would_part_and_leaves_out_what_is_not_there() {
        let header = Header {
            version: 1,
            schema: 2,
            source: 3,
            epoch: 4,
            flags: Flags::NONE,
            length: 0,
            seq: 5,
            event_ns: 6,
            sent_ns: 7,
        };
        let value = Value::Fields(vec![
            ("name".into(), Value::Text("a \"b\", c".into())),
            ("n".into(), Value::Unsigned(9)),
        ]);
        let line = MessageLine {
            topic: "scene",
            header: &header,
            arrived_ns: 8,
            value: &value,
        };
        let columns = ["name", "none", "n"].map(str::to_owned);
        assert_eq!(
            head(&columns),
            "topic,arrived_ns,seq,event_ns,name,none,n\n"
        );
        assert_eq!(line.row(&columns), "scene,8,5,6,\"a \"\"b\"\", c\",,9\n");
        let json: Json = serde_json::from_str(&line.json(&columns)).expect("JSON");
        assert_eq!(
            (&json["value"]["none"], &json["value"]["n"]),
            (&Json::Null, &9.into())
        );
        let all: Json = serde_json::from_str(&line.json(&[])).expect("JSON");
        assert_eq!(
            (&all["value"]["name"], &all["seq"]),
            (&"a \"b\", c".into(), &5.into())
        );
    }
}
