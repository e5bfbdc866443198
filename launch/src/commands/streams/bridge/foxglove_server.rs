//! Serves messages to viewers that speak the Foxglove protocol, as JSON channels.
//!
//! The protocol is the library's; connections are accepted here, because its own server admits everyone.

use std::collections::BTreeMap;
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use foxglove::ws_protocol::schema::Schema;
use foxglove::ws_protocol::server::{Advertise, Channel, ServerInfo};
use maulstick_bus::typed::random_u64;
use maulstick_recorder::listener::{Listener, ReceivedMessage};
use maulstick_rig::UserError;
use maulstick_streams::catalogue::KnownTables;
use maulstick_streams::{RateLimit, json_channel};
use maulstick_types::HEADER_BYTES;

use super::admission::{Admission, Refusal};
use super::viewer::{Viewer, Wish, greet, turn_away};

/// Most connections at a time.
const MOST: usize = 32;

/// Pause after a connection that the system could not accept.
const PAUSE: Duration = Duration::from_millis(100);

/// A server of messages, without input from its viewers.
pub(super) struct FoxgloveServer {
    port: u16,
    lobby: Arc<Lobby>,
    tables: KnownTables,
    limit: RateLimit,
    /// Channels by topic and hash of the field table; `None` for unknown messages.
    channels: BTreeMap<(String, u32), Option<u64>>,
    /// The last message of each topic that late joiners receive.
    kept: BTreeMap<String, ReceivedMessage>,
    wishes: Receiver<Wish>,
    refusals: Receiver<Refusal>,
}

/// State shared by the server and the threads of its viewers.
struct Lobby {
    /// First message to each viewer.
    info: ServerInfo,
    admission: Admission,
    people: Mutex<People>,
    wishes: Sender<Wish>,
    refusals: Sender<Refusal>,
}

/// The viewers, and the channels that they know of, by number.
#[derive(Default)]
struct People {
    viewers: Vec<Arc<Viewer>>,
    channels: Vec<Channel<'static>>,
    /// Connections, with those that are not yet admitted.
    connections: usize,
}

impl Lobby {
    fn lock(&self) -> MutexGuard<'_, People> {
        self.people.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Accepts connections for as long as this process runs.
    fn accept(self: &Arc<Self>, listener: &TcpListener) {
        loop {
            let Ok((stream, _)) = listener.accept() else {
                // For example with too many open files: one may be closed soon.
                std::thread::sleep(PAUSE);
                continue;
            };
            let mut people = self.lock();
            let is_full = people.connections == MOST;
            people.connections += usize::from(!is_full);
            drop(people);
            if is_full {
                turn_away(stream, &Refusal::Full);
                self.refusals.send(Refusal::Full).ok();
                continue;
            }
            let lobby = Arc::clone(self);
            let serve = move || {
                lobby.serve(stream);
                lobby.lock().connections -= 1;
            };
            let thread = std::thread::Builder::new().name("viewer".into());
            if thread.spawn(serve).is_err() {
                self.lock().connections -= 1;
            }
        }
    }

    fn serve(&self, stream: TcpStream) {
        let socket = match greet(stream, &self.admission) {
            Ok(socket) => socket,
            Err(why) => {
                // Without a receiver the server ends.
                why.map(|why| self.refusals.send(why).ok());
                return;
            }
        };
        let viewer = Arc::new(Viewer::default());
        let mut people = self.lock();
        viewer.say(&self.info);
        if !people.channels.is_empty() {
            viewer.say(&Advertise::new(people.channels.iter().cloned()));
        }
        people.viewers.push(Arc::clone(&viewer));
        drop(people);
        viewer.serve(socket, || self.lock().channels.len() as u64, &self.wishes);
        self.lock()
            .viewers
            .retain(|other| !Arc::ptr_eq(other, &viewer));
    }

    /// Creates a channel, and advertises it to all viewers; returns its number.
    fn advertise(&self, channel: impl FnOnce(u64) -> Option<Channel<'static>>) -> Option<u64> {
        let mut people = self.lock();
        let number = people.channels.len() as u64;
        let channel = channel(number)?;
        for viewer in &people.viewers {
            viewer.say(&Advertise::new([channel.clone()]));
        }
        people.channels.push(channel);
        Some(number)
    }
}

impl FoxgloveServer {
    /// Starts serving at an address, with port 0 at any; at most `hz` messages a second of each topic.
    ///
    /// # Errors A [`UserError`] where the port is taken, or the address is not this machine's.
    pub(super) fn start(
        name: &str,
        at: SocketAddr,
        hz: u32,
        admission: Admission,
    ) -> Result<Self, UserError> {
        let listener = TcpListener::bind(at).map_err(|error| fault(at, &error))?;
        let port = listener
            .local_addr()
            .map_err(|error| fault(at, &error))?
            .port();
        let (to_wishes, wishes) = channel();
        let (to_refusals, refusals) = channel();
        let lobby = Arc::new(Lobby {
            info: ServerInfo::new(name).with_session_id(random_u64().to_string()),
            admission,
            people: Mutex::default(),
            wishes: to_wishes,
            refusals: to_refusals,
        });
        let accepting = Arc::clone(&lobby);
        std::thread::Builder::new()
            .name("bridge".into())
            .spawn(move || accepting.accept(&listener))
            .map_err(|error| fault(at, &error))?;
        Ok(Self {
            port,
            lobby,
            tables: KnownTables::default(),
            limit: RateLimit::new(hz),
            channels: BTreeMap::new(),
            kept: BTreeMap::new(),
            wishes,
            refusals,
        })
    }

    /// The port at which it serves.
    pub(super) fn port(&self) -> u16 {
        self.port
    }

    /// Refusals since the last call.
    pub(super) fn refusals(&self) -> impl Iterator<Item = Refusal> {
        self.refusals.try_iter()
    }

    /// Sends a message to the watchers of its topic, within the topic's rate.
    pub(super) fn send(&mut self, received: ReceivedMessage) {
        if let Some(channel) = self.channel(&received) {
            let mut viewers = self.lobby.lock().viewers.clone();
            viewers.retain(|viewer| viewer.watches(channel));
            let arrived_ns = received.message.arrived_ns;
            if !viewers.is_empty() && self.limit.admits(&received.topic, arrived_ns) {
                self.send_to(&viewers, channel, &received);
            }
        }
        if Listener::is_cached(&received.topic) {
            self.kept.insert(received.topic.clone(), received);
        }
    }

    /// Sends new watchers of a topic its cached message.
    pub(super) fn greet(&mut self) {
        while let Ok(Wish { viewer, channel }) = self.wishes.try_recv() {
            let people = self.lobby.lock();
            let topic = people.channels.get(channel as usize);
            let kept = topic.and_then(|channel| self.kept.get(&*channel.topic));
            let kept = kept.cloned();
            drop(people);
            if let Some(received) = kept {
                self.send_to(&[viewer], channel, &received);
            }
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

    /// The channel of a message; `None` if it is unknown.
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

/// The reason why a server does not start.
fn fault(at: SocketAddr, error: &std::io::Error) -> UserError {
    let at = format!("{}, port {}", at.ip(), at.port());
    match error.kind() {
        std::io::ErrorKind::AddrInUse => UserError::failure("the port is taken by another program")
            .at(at)
            .help("choose another with --port, or --port 0 for any"),
        std::io::ErrorKind::AddrNotAvailable => UserError::usage(
            "this machine does not have this address",
        )
        .at(at)
        .help(
            "choose another with --address: 127.0.0.1 for this machine, 0.0.0.0 for all networks",
        ),
        _ => UserError::failure(format!("cannot serve: {error}")).at(at),
    }
}
