//! Serves messages to viewers that speak the Foxglove protocol, as JSON channels.

use std::collections::BTreeMap;
use std::net::IpAddr;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

use foxglove::websocket::{ChannelView, Client, ServerListener};
use foxglove::{
    Context, FoxgloveError, PartialMetadata, RawChannel, Schema, SinkId, WebSocketServerHandle,
};
use maulstick_rig::UserError;
use maulstick_streams::catalogue::KnownTables;
use maulstick_streams::{RateLimit, json_channel};
use maulstick_types::HEADER_BYTES;

use super::listener::{Listener, ReceivedMessage};

/// Messages that wait for a slow viewer; older ones are dropped.
const BACKLOG: usize = 1024;

/// A server of messages. It takes nothing from its viewers.
pub(super) struct FoxgloveServer {
    context: Arc<Context>,
    handle: WebSocketServerHandle,
    tables: KnownTables,
    limit: RateLimit,
    /// Channels by topic and hash of the field table; `None` for messages that this program does not know.
    channels: BTreeMap<(String, u32), Option<Arc<RawChannel>>>,
    /// The last message of each topic that is kept for late joiners.
    kept: BTreeMap<String, ReceivedMessage>,
    subscriptions: Receiver<Subscription>,
}

/// A viewer's wish for a topic.
struct Subscription {
    topic: String,
    viewer: SinkId,
}

/// Passes on subscriptions from the server's own threads.
struct SubscriptionSender(Sender<Subscription>);

impl ServerListener for SubscriptionSender {
    fn on_subscribe(&self, client: Client, channel: ChannelView<'_>) {
        if let Some(viewer) = client.sink_id() {
            let topic = channel.topic().to_owned();
            // Without a receiver the server ends.
            self.0.send(Subscription { topic, viewer }).ok();
        }
    }
}

impl FoxgloveServer {
    /// Begins to serve at an address and port, 0 for any; at most `hz` messages a second of each topic.
    ///
    /// # Errors
    /// A [`UserError`] where the port is taken, or the address is not this machine's.
    pub(super) fn start(
        name: &str,
        address: IpAddr,
        port: u16,
        hz: u32,
    ) -> Result<Self, UserError> {
        let context = Context::new();
        let (sender, subscriptions) = channel();
        let host = match address {
            IpAddr::V4(address) => address.to_string(),
            IpAddr::V6(address) => format!("[{address}]"),
        };
        let handle = context
            .websocket_server()
            .name(name)
            .bind(host, port)
            .message_backlog_size(BACKLOG)
            .listener(Arc::new(SubscriptionSender(sender)))
            .start_blocking()
            .map_err(|error| fault(address, port, &error))?;
        Ok(Self {
            context,
            handle,
            tables: KnownTables::default(),
            limit: RateLimit::new(hz),
            channels: BTreeMap::new(),
            kept: BTreeMap::new(),
            subscriptions,
        })
    }

    /// The port at which it serves.
    pub(super) fn port(&self) -> u16 {
        self.handle.port()
    }

    /// Sends a message to those who watch its topic, if that has not sent its share already.
    pub(super) fn send(&mut self, received: ReceivedMessage) {
        let channel = self.channel(&received);
        let is_watched = channel.is_some_and(|channel| channel.has_sinks());
        let arrived_ns = received.message.arrived_ns;
        if is_watched && self.limit.admits(&received.topic, arrived_ns) {
            self.send_to(&received, None);
        }
        if Listener::is_cached(&received.topic) {
            self.kept.insert(received.topic.clone(), received);
        }
    }

    /// Sends new watchers of a topic the message that is kept for late joiners.
    pub(super) fn greet(&mut self) {
        while let Ok(Subscription { topic, viewer }) = self.subscriptions.try_recv() {
            if let Some(received) = self.kept.get(&topic).cloned() {
                self.send_to(&received, Some(viewer));
            }
        }
    }

    fn send_to(&mut self, received: &ReceivedMessage, viewer: Option<SinkId>) {
        let Some(channel) = self.channel(received) else {
            return;
        };
        let header = &received.message.header;
        let arrived_ns = received.message.arrived_ns;
        let body = received.bytes.get(HEADER_BYTES..).unwrap_or_default();
        let table = self.tables.of(header.schema);
        if let Some(Ok(value)) = table.map(|table| table.decode(body)) {
            let message = json_channel::message(header, arrived_ns, &value).to_string();
            let time = PartialMetadata::with_log_time(arrived_ns);
            channel.log_with_meta_to_sink(message.as_bytes(), time, viewer);
        }
    }

    /// The channel of a message; `None` where this program does not know it.
    fn channel(&mut self, received: &ReceivedMessage) -> Option<Arc<RawChannel>> {
        let (topic, schema) = (&received.topic, received.message.header.schema);
        if let Some(channel) = self.channels.get(&(topic.clone(), schema)) {
            return channel.clone();
        }
        let channel = self.tables.of(schema).and_then(|table| {
            let encoding = json_channel::SCHEMA_ENCODING;
            let schema = Schema::new(table.name(), encoding, json_channel::schema(table));
            let builder = self.context.channel_builder(topic).schema(schema);
            let encoding = json_channel::MESSAGE_ENCODING;
            builder.message_encoding(encoding).build_raw().ok()
        });
        self.channels
            .insert((topic.clone(), schema), channel.clone());
        channel
    }
}

/// Why a server does not start.
fn fault(address: IpAddr, port: u16, error: &FoxgloveError) -> UserError {
    let at = format!("{address}, port {port}");
    let kind = match error {
        FoxgloveError::Bind(error) => Some(error.kind()),
        _ => None,
    };
    match kind {
        Some(std::io::ErrorKind::AddrInUse) => {
            UserError::failure("the port is taken by another program")
                .at(at)
                .help("choose another with --port, or --port 0 for any")
        }
        Some(std::io::ErrorKind::AddrNotAvailable) => UserError::usage(
            "this machine does not have this address",
        )
        .at(at)
        .help(
            "choose another with --address: 127.0.0.1 for this machine, 0.0.0.0 for all networks",
        ),
        _ => UserError::failure(format!("cannot serve: {error}")).at(at),
    }
}
