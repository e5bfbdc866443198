//! The layouts for Foxglove in `docs/foxglove` name topics of the rig, and fields that their messages have.

use std::path::Path;

use maulstick_streams::topic_pattern::matches;
use maulstick_streams::{FieldTable, json_channel};
use maulstick_types::CATALOGUE;
use serde_json::Value as Json;

/// Keys of a layout whose text is a topic, with the path of a field behind it or without.
const PATH_KEYS: [&str; 2] = ["value", "topicPath"];

/// Adds the paths of a layout.
fn add_paths(layout: &Json, paths: &mut Vec<String>) {
    match layout {
        Json::Object(fields) => {
            for (key, value) in fields {
                match value.as_str() {
                    Some(path) if PATH_KEYS.contains(&key.as_str()) => paths.push(path.to_owned()),
                    _ => add_paths(value, paths),
                }
            }
        }
        Json::Array(list) => list.iter().for_each(|own| add_paths(own, paths)),
        _ => {}
    }
}

/// The schema of the messages of a topic.
fn schema_of(topic: &str) -> Option<Json> {
    let is_meant = |pattern: &&str| {
        let parts = pattern
            .split('/')
            .map(|part| if part.starts_with('<') { "*" } else { part });
        matches(&parts.collect::<Vec<_>>().join("/"), topic)
    };
    let entry = CATALOGUE
        .iter()
        .find(|entry| entry.topics.iter().any(is_meant))?;
    let table = FieldTable::of((entry.schema)()).ok()?;
    serde_json::from_slice(&json_channel::schema(&table)).ok()
}

/// True if messages of the topic may have a value at a path such as `stylus/pen/sample.force_n[0]`.
fn exists(path: &str) -> bool {
    let mut parts = path.split('.');
    let schema = parts.next().and_then(schema_of);
    let found = parts.try_fold(schema, |schema, part| {
        let (name, place) = match part.strip_suffix(']').and_then(|own| own.split_once('[')) {
            Some((name, place)) => (name, Some(place.parse::<usize>().ok()?)),
            None => (part, None),
        };
        let own = schema?.get("properties")?.get(name)?.clone();
        Some(match place {
            Some(_) => own.get("items").cloned(),
            None => Some(own),
        })
    });
    found.flatten().is_some()
}

#[test]
fn every_path_of_a_layout_exists() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/foxglove");
    for name in ["haptics", "latency", "session"] {
        let text = std::fs::read_to_string(folder.join(format!("{name}.json"))).expect(name);
        let layout: Json = serde_json::from_str(&text).expect(name);
        let mut paths = Vec::new();
        add_paths(&layout["configById"], &mut paths);
        assert!(paths.len() > 5, "{name}: {paths:?}");
        for path in paths {
            assert!(exists(&path), "{name}.json: {path}");
        }
    }
}

#[test]
fn a_path_that_no_message_has_is_found() {
    assert!(exists("stylus/pen/sample.force_n[0]") && exists("paint/journal"));
    for wrong in [
        "stylus/pen/sampel",
        "stylus/pen/sample.force",
        "stylus/pen/sample.in_range[0]",
        "stylus/pen/sample.pose.Contact.presure",
        "paint/status.header.delay",
    ] {
        assert!(!exists(wrong), "{wrong}");
    }
}
