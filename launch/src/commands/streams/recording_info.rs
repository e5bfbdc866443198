//! `maulstick recording info`: the topics of a recording.

use std::collections::BTreeMap;
use std::path::Path;

use maulstick_rig::UserError;
use maulstick_streams::recording::ForeignTopic;
use maulstick_streams::traffic::Arrived;
use maulstick_streams::{Recording, Traffic};
use maulstick_types::plain;
use serde_json::json;

use crate::commands::table::table;
use crate::commands::{print_json, print_text, say};

/// The whole of a recording.
const WHOLE: [u64; 2] = [0, u64::MAX];

/// Shows the contents of a recording.
///
/// # Errors
/// A [`UserError`] for a file that cannot be read.
pub(super) fn info(path: &Path, as_json: bool) -> Result<i32, UserError> {
    let mut recording = Recording::open(path)?;
    let facts = recording.notes().get("recording").cloned();
    let fact = |name: &str| facts.as_ref().and_then(|facts| facts.get(name));
    let begun_ns = fact("rig_ns").and_then(|ns| ns.parse::<u64>().ok());
    let traffic = traffic(&mut recording, begun_ns.unwrap_or(0))?;
    let foreign = recording.foreign()?;
    let [first, last] = recording.times_ns().unwrap_or_default();
    let seconds = last.saturating_sub(first) as f64 * 1e-9;
    let topics = recording.topics().clone();
    let known: BTreeMap<&str, &str> = topics
        .values()
        .map(|topic| {
            (
                topic.name.as_str(),
                topic.message.as_deref().unwrap_or("unknown"),
            )
        })
        .collect();
    let message = |topic: &str| known.get(topic).copied().unwrap_or("unknown");
    if as_json {
        let streams = streams(&traffic, message);
        print_json(&json!({
            "seconds": seconds,
            "notes": recording.notes(),
            "files": recording.attachments().keys().collect::<Vec<_>>(),
            "damage": recording.damage(),
            "streams": streams,
            "foreign": foreign.iter().map(foreign_entry).collect::<Vec<_>>(),
        }))?;
        return Ok(0);
    }
    match fact("rig").zip(fact("version")) {
        Some((rig, version)) => say!("{seconds:.1} s of {rig}, by maulstick {version}"),
        None => say!("{seconds:.1} s"),
    }
    if let Some(damage) = recording.damage() {
        say!("damaged: {damage}; what is shown can be read, and `maulstick take recover` mends it");
    }
    let rows: Vec<_> = rows(&traffic, message)
        .chain(foreign.iter().map(foreign_row))
        .collect();
    let head = [
        "topic", "message", "senders", "messages", "a second", "kB", "lost",
    ];
    print_text(&table(head, &rows))?;
    if rows.is_empty() {
        say!("it has no messages");
    } else if !foreign.is_empty() {
        say!(
            "topics of another program have their encoding in brackets: Maulstick lists them, and reads them not"
        );
    }
    Ok(0)
}

/// Traffic on each topic, since a time of the rig's clock, ns.
fn traffic(recording: &mut Recording, since_ns: u64) -> Result<Traffic, UserError> {
    let mut traffic = Traffic::since(since_ns);
    let topics = recording.topics().clone();
    recording.messages(WHOLE, &mut |message| {
        if let Some(topic) = topics.get(&message.channel) {
            let arrived = Arrived {
                header: message.header,
                bytes: message.bytes.len(),
                arrived_ns: message.arrived_ns,
            };
            traffic.add(&topic.name, &arrived);
        }
        true
    })?;
    Ok(traffic)
}

/// Streams of a recording as JSON; `message` names the messages of a topic.
fn streams<'a>(traffic: &Traffic, message: impl Fn(&str) -> &'a str) -> Vec<serde_json::Value> {
    let stream = traffic.streams().map(|(topic, origin, stream)| {
        json!({
            "topic": topic,
            "source": origin.source,
            "epoch": origin.epoch,
            "message": message(topic),
            "messages": stream.messages,
            "bytes": stream.bytes,
            "rate_hz": stream.rate_hz(),
            "lost": stream.lost,
        })
    });
    stream.collect()
}

/// Rows of the topics of a recording.
fn rows<'a>(
    traffic: &Traffic,
    message: impl Fn(&str) -> &'a str,
) -> impl Iterator<Item = [String; 7]> {
    totals(traffic).into_iter().map(move |(topic, total)| {
        [
            topic.to_owned(),
            message(topic).to_owned(),
            total.senders.to_string(),
            total.messages.to_string(),
            format!("{:.1}", total.rate_hz),
            format!("{:.1}", total.bytes as f64 * 1e-3),
            total.lost.to_string(),
        ]
    })
}

fn foreign_entry(topic: &ForeignTopic) -> serde_json::Value {
    json!({
        "topic": topic.name,
        "message": topic.schema,
        "encoding": topic.encoding,
        "messages": topic.messages,
        "bytes": topic.bytes,
        "rate_hz": topic.rate_hz,
    })
}

fn foreign_row(topic: &ForeignTopic) -> [String; 7] {
    let schema = topic.schema.as_deref().unwrap_or("unknown");
    [
        plain(&topic.name).into_owned(),
        plain(&format!("{schema} [{}]", topic.encoding)).into_owned(),
        "-".to_owned(),
        topic.messages.to_string(),
        format!("{:.1}", topic.rate_hz),
        format!("{:.1}", topic.bytes as f64 * 1e-3),
        "-".to_owned(),
    ]
}

/// A topic over all its senders: a restarted process counts as another sender.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct TopicTotal {
    senders: u64,
    messages: u64,
    /// While each sent, in the mean.
    rate_hz: f64,
    bytes: u64,
    lost: u64,
}

/// Each topic once.
fn totals(traffic: &Traffic) -> BTreeMap<&str, TopicTotal> {
    let mut totals: BTreeMap<&str, TopicTotal> = BTreeMap::new();
    for (topic, _, stream) in traffic.streams() {
        let total = totals.entry(topic).or_default();
        let messages = total.messages + stream.messages;
        let rates =
            total.rate_hz * total.messages as f64 + stream.rate_hz() * stream.messages as f64;
        *total = TopicTotal {
            senders: total.senders + 1,
            messages,
            rate_hz: rates / messages.max(1) as f64,
            bytes: total.bytes + stream.bytes,
            lost: total.lost + stream.lost,
        };
    }
    totals
}

#[cfg(test)]
mod tests {
    use maulstick_types::{Flags, Header};

    use super::*;

    #[test]
    fn a_topic_is_listed_once_however_many_sent_it() {
        let mut traffic = Traffic::default();
        let mut send = |topic: &str, epoch: u32, seq: u64| {
            let sent_ns = u64::from(epoch) * 1_000_000_000 + seq * 10_000_000;
            let header = Header {
                version: 1,
                schema: 1,
                source: 7,
                epoch,
                flags: Flags::default(),
                length: 0,
                seq,
                event_ns: 0,
                sent_ns,
            };
            let arrived = Arrived {
                header,
                bytes: 100,
                arrived_ns: sent_ns,
            };
            traffic.add(topic, &arrived);
        };
        for epoch in 1..=3 {
            (0..10)
                .filter(|seq| *seq != 4)
                .for_each(|seq| send("a", epoch, seq));
        }
        send("b", 1, 0);
        let totals = totals(&traffic);
        assert_eq!(totals.keys().copied().collect::<Vec<_>>(), ["a", "b"]);
        let a = totals["a"];
        assert_eq!((a.senders, a.messages, a.bytes, a.lost), (3, 27, 2700, 3));
        assert!((a.rate_hz - 100.0).abs() < 15.0, "{a:?}");
        assert_eq!(traffic.streams().count(), 4, "a fault would pass");
    }
}
