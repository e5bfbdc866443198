//! Messages of the rig as JSON channels, for those who watch them.

use std::collections::BTreeMap;
use std::sync::Arc;

use foxglove::ws_protocol::schema::Schema;
use foxglove::ws_protocol::server::Channel;
use maulstick_recorder::listener::{Listener, ReceivedMessage};
use maulstick_streams::catalogue::KnownTables;
use maulstick_streams::{RateLimit, json_channel};
use maulstick_types::HEADER_BYTES;

use crate::lobby::Lobby;
use crate::viewer::{Viewer, Wish};

/// What viewers are sent.
pub(crate) struct Feed {
    pub(crate) lobby: Arc<Lobby>,
    tables: KnownTables,
    limit: RateLimit,
    /// Channels by topic and hash of the field table; `None` for messages that this program does not know.
    channels: BTreeMap<(String, u32), Option<u64>>,
    /// The last message of each topic that is kept for late joiners.
    kept: BTreeMap<String, ReceivedMessage>,
}

impl Feed {
    /// A feed of at most `hz` messages a second of each topic.
    pub(crate) fn new(lobby: Arc<Lobby>, hz: u32) -> Self {
        Self {
            lobby,
            tables: KnownTables::default(),
            limit: RateLimit::new(hz),
            channels: BTreeMap::new(),
            kept: BTreeMap::new(),
        }
    }

    /// Sends a message to those who watch its topic, if that has not sent its share already.
    pub(crate) fn send(&mut self, received: ReceivedMessage) {
        if let Some(channel) = self.channel(&received) {
            let viewers = self.lobby.watchers(channel);
            let arrived_ns = received.message.arrived_ns;
            if !viewers.is_empty() && self.limit.admits(&received.topic, arrived_ns) {
                self.send_to(&viewers, channel, &received);
            }
        }
        if Listener::is_cached(&received.topic) {
            self.kept.insert(received.topic.clone(), received);
        }
    }

    /// Sends a new watcher of a topic the message that is kept for late joiners.
    pub(crate) fn fulfil(&mut self, Wish { viewer, channel }: Wish) {
        let topic = self.lobby.topic(channel);
        let kept = topic.and_then(|topic| self.kept.get(&topic).cloned());
        if let Some(received) = kept {
            self.send_to(&[viewer], channel, &received);
        }
    }

    fn send_to(&mut self, viewers: &[Arc<Viewer>], channel: u64, received: &ReceivedMessage) {
        let header = &received.message.header;
        let arrived_ns = received.message.arrived_ns;
        let body = received.bytes.get(HEADER_BYTES..).unwrap_or_default();
        let table = self.tables.of(header.schema);
        if let Some(Ok(value)) = table.map(|table| table.decode(body)) {
            let json = json_channel::message(header, arrived_ns, &value).to_string();
            for viewer in viewers {
                viewer.send(channel, arrived_ns, json.as_bytes());
            }
        }
    }

    /// The channel of a message; `None` where this program does not know it.
    fn channel(&mut self, received: &ReceivedMessage) -> Option<u64> {
        let (topic, schema) = (&received.topic, received.message.header.schema);
        if let Some(channel) = self.channels.get(&(topic.clone(), schema)) {
            return *channel;
        }
        let table = self.tables.of(schema);
        let channel = table.and_then(|table| {
            self.lobby.advertise(|number| {
                let (encoding, fields) =
                    (json_channel::SCHEMA_ENCODING, json_channel::schema(table));
                let schema = Schema::new(table.name().to_owned(), encoding, fields);
                let channel =
                    Channel::builder(number, topic.clone(), json_channel::MESSAGE_ENCODING);
                channel.with_schema(schema).build().ok()
            })
        });
        self.channels.insert((topic.clone(), schema), channel);
        channel
    }
}
