//! The programs of a rig, and what each has declared to send, receive and answer, by zenoh's administration space.

use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;

use serde::Deserialize;
use zenoh::Wait as _;
use zenoh::key_expr::keyexpr;

use crate::bus::BusError;
use crate::zenoh_bus::{ZenohBus, topic_error};

/// Longest wait for the answers: a process that stands still gives none.
const PATIENCE: Duration = Duration::from_secs(2);
/// The administration space of all sessions: what they are, and what they and their clients declare.
const ASKED: [&str; 4] = [
    "@/*/*",
    "@/*/*/publisher/**",
    "@/*/*/subscriber/**",
    "@/*/*/queryable/**",
];

/// A program of a rig. Its keys are whole, with the rig's prefix.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Participant {
    /// Number of its session, in hexadecimal.
    pub session: String,
    /// Name as it joined; `None` where it gives no account of itself, as programs of other makes may not.
    pub name: Option<String>,
    /// Its process, if it has a name.
    pub process: Option<u32>,
    /// Topics that it sends.
    pub sends: BTreeSet<String>,
    /// Topics that it receives; they may have stars.
    pub receives: BTreeSet<String>,
    /// Topics on which it answers queries.
    pub answers: BTreeSet<String>,
}

/// True if what is sent on `topic` comes to a program that receives `pattern`.
#[must_use]
pub fn is_received(pattern: &str, topic: &str) -> bool {
    match (keyexpr::new(pattern), keyexpr::new(topic)) {
        (Ok(pattern), Ok(topic)) => pattern.intersects(topic),
        _ => false,
    }
}

impl ZenohBus {
    /// The other programs of the rig, in the order of their sessions' numbers.
    ///
    /// # Errors
    /// [`BusError::Topic`] where the bus is closed.
    pub fn participants(&self) -> Result<Vec<Participant>, BusError> {
        let session = self.raw_session();
        let mut found = Found::default();
        for asked in ASKED {
            let replies = session.get(asked).timeout(PATIENCE).wait();
            let replies = replies.map_err(|error| topic_error(asked, error))?;
            for reply in replies {
                if let Ok(sample) = reply.result() {
                    found.add(sample.key_expr().as_str(), &sample.payload().to_bytes());
                }
            }
        }
        found.sessions.remove(&session.zid().to_string());
        Ok(found.sessions.into_values().collect())
    }
}

/// Identity of a session, as it states it.
#[derive(Deserialize)]
struct Account {
    metadata: Option<Metadata>,
}

#[derive(Deserialize)]
struct Metadata {
    name: Option<String>,
    pid: Option<u32>,
}

/// Sessions that declare a key: a session and its clients are its `clients`. What others declare they say themselves.
#[derive(Deserialize)]
struct Sources {
    clients: Vec<String>,
}

/// Participants by the numbers of their sessions.
#[derive(Debug, Default)]
struct Found {
    sessions: BTreeMap<String, Participant>,
}

impl Found {
    fn of(&mut self, session: &str) -> &mut Participant {
        let found = self.sessions.entry(session.to_owned()).or_default();
        session.clone_into(&mut found.session);
        found
    }

    /// Takes in a reply; one in another form, as of another version of zenoh, says nothing.
    fn add(&mut self, key: &str, json: &[u8]) {
        let parts: Vec<&str> = key.splitn(5, '/').collect();
        match parts.as_slice() {
            ["@", session, _] => {
                let account = serde_json::from_slice::<Account>(json).ok();
                if let Some(metadata) = account.and_then(|account| account.metadata) {
                    let found = self.of(session);
                    found.name = metadata.name;
                    found.process = metadata.pid;
                }
            }
            ["@", _, _, what, topic] => {
                let Ok(sources) = serde_json::from_slice::<Sources>(json) else {
                    return;
                };
                for session in sources.clients {
                    let found = self.of(&session);
                    let declared = match *what {
                        "publisher" => &mut found.sends,
                        "subscriber" => &mut found.receives,
                        "queryable" => &mut found.answers,
                        _ => continue,
                    };
                    declared.insert((*topic).to_owned());
                }
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Replies of zenoh 1.10: a hub with a client behind it, and a peer.
    const REPLIES: [(&str, &str); 8] = [
        (
            "@/550d/peer",
            r#"{"locators":[],"metadata":{"name":"hub","pid":7},"plugins":null,"sessions":[]}"#,
        ),
        (
            "@/6be6/peer",
            r#"{"locators":[],"metadata":{"name":"brush","pid":8}}"#,
        ),
        (
            "@/550d/peer/publisher/maulstick/studio/stylus/python/sample",
            r#"{"routers":[],"peers":[],"clients":["614d"]}"#,
        ),
        (
            "@/550d/peer/subscriber/maulstick/studio/scene",
            r#"{"routers":[],"peers":["6be6","550d"],"clients":["614d"]}"#,
        ),
        (
            "@/6be6/peer/subscriber/maulstick/studio/stylus/*/sample",
            r#"{"routers":[],"peers":["6be6"],"clients":["6be6"]}"#,
        ),
        (
            "@/550d/peer/subscriber/maulstick/studio/stylus/*/sample",
            r#"{"routers":[],"peers":["6be6"],"clients":[]}"#,
        ),
        (
            "@/6be6/peer/queryable/maulstick/studio/command/main",
            r#"{"routers":[],"peers":["6be6"],"clients":["6be6"]}"#,
        ),
        ("@/6be6/peer/subscriber/x", "no JSON"),
    ];

    #[test]
    fn each_program_has_what_it_declares_itself() {
        let mut found = Found::default();
        for (key, json) in REPLIES {
            found.add(key, json.as_bytes());
        }
        let set = |key: &str| BTreeSet::from([format!("maulstick/studio/{key}")]);
        let expected = [
            Participant {
                session: "550d".into(),
                name: Some("hub".into()),
                process: Some(7),
                ..Participant::default()
            },
            Participant {
                session: "614d".into(),
                sends: set("stylus/python/sample"),
                receives: set("scene"),
                ..Participant::default()
            },
            Participant {
                session: "6be6".into(),
                name: Some("brush".into()),
                process: Some(8),
                receives: set("stylus/*/sample"),
                answers: set("command/main"),
                ..Participant::default()
            },
        ];
        let found: Vec<_> = found.sessions.into_values().collect();
        assert_eq!(found, expected);
    }

    #[test]
    fn a_topic_comes_to_patterns_that_mean_it() {
        assert!(is_received("a/*/sample", "a/pen/sample"));
        assert!(is_received("a/**", "a/pen/sample"));
        assert!(!is_received("a/*/info", "a/pen/sample"));
        assert!(!is_received("a//b", "a//b"), "no key");
    }
}
