//! One viewer of the bridge: its connection, on a thread of its own, and what waits to be sent to it.

use std::collections::{BTreeMap, VecDeque};
use std::net::TcpStream;
use std::sync::mpsc::Sender;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use foxglove::ws_protocol::client::ClientMessage;
use foxglove::ws_protocol::server::MessageData;
use foxglove::ws_protocol::{BinaryMessage as _, JsonMessage};
use tungstenite::handshake::server::{ErrorResponse, Request, Response};
use tungstenite::http::HeaderValue;
use tungstenite::http::header::SEC_WEBSOCKET_PROTOCOL;
use tungstenite::protocol::WebSocketConfig;
use tungstenite::{Error, Message, WebSocket, accept_hdr_with_config};

use super::admission::{Admission, PROTOCOL, Refusal};

/// Messages that wait for a slow viewer; older ones are dropped.
const BACKLOG: usize = 1024;
/// Bytes of the largest message of a viewer.
const LARGEST: usize = 1 << 20;
/// Longest wait for the next bytes of a viewer that connects.
const GREETING: Duration = Duration::from_secs(2);
/// Longest wait for a viewer's message while others may have to be sent.
const TURN: Duration = Duration::from_millis(10);
/// A viewer that takes nothing for so long is dropped.
const STUCK: Duration = Duration::from_secs(2);

/// What waits for a viewer, and what it watches.
#[derive(Debug, Default)]
pub(super) struct Viewer(Mutex<Waiting>);

#[derive(Debug, Default)]
struct Waiting {
    /// All of these are sent.
    words: VecDeque<Message>,
    data: VecDeque<Message>,
    /// Its subscriptions, by channel.
    subscriptions: BTreeMap<u64, u32>,
}

/// A viewer's wish for a channel.
pub(super) struct Wish {
    /// Who wishes it.
    pub viewer: Arc<Viewer>,
    /// The channel.
    pub channel: u64,
}

impl Viewer {
    fn lock(&self) -> MutexGuard<'_, Waiting> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Has something said about the server.
    pub(super) fn say(&self, words: &impl JsonMessage) {
        let words = JsonMessage::to_string(words);
        self.lock().words.push_back(Message::text(words));
    }

    /// True if it watches a channel.
    pub(super) fn watches(&self, channel: u64) -> bool {
        self.lock().subscriptions.contains_key(&channel)
    }

    /// Has a message of a channel sent, if it watches that.
    pub(super) fn send(&self, channel: u64, time_ns: u64, json: &[u8]) {
        let mut waiting = self.lock();
        let Some(subscription) = waiting.subscriptions.get(&channel) else {
            return;
        };
        let data = MessageData::new(*subscription, time_ns, json).to_bytes();
        waiting.data.push_back(Message::binary(data));
        while waiting.data.len() > BACKLOG {
            waiting.data.pop_front();
        }
    }

    /// Carries out what it asks for; of channels there are `channels`.
    fn obey(self: &Arc<Self>, message: &Message, channels: u64, wishes: &Sender<Wish>) {
        let parsed = match message {
            Message::Text(text) => ClientMessage::parse_json(text),
            _ => return,
        };
        match parsed {
            Ok(ClientMessage::Subscribe(asked)) => {
                for own in asked
                    .subscriptions
                    .iter()
                    .filter(|own| own.channel_id < channels)
                {
                    self.lock().subscriptions.insert(own.channel_id, own.id);
                    let (viewer, channel) = (Arc::clone(self), own.channel_id);
                    // Without a receiver the server ends.
                    wishes.send(Wish { viewer, channel }).ok();
                }
            }
            Ok(ClientMessage::Unsubscribe(asked)) => {
                let is_kept = |_: &u64, own: &mut u32| !asked.subscription_ids.contains(own);
                self.lock().subscriptions.retain(is_kept);
            }
            // The bridge takes nothing else from its viewers.
            Ok(_) | Err(_) => {}
        }
    }

    /// Serves its connection to the end of it; `channels` says how many channels there are.
    pub(super) fn serve(
        self: &Arc<Self>,
        mut socket: WebSocket<TcpStream>,
        channels: impl Fn() -> u64,
        wishes: &Sender<Wish>,
    ) {
        loop {
            match socket.read() {
                Ok(message) => self.obey(&message, channels(), wishes),
                Err(Error::Io(error)) if is_pause(&error) => {}
                Err(_) => return,
            }
            let mut waiting = self.lock();
            let words = std::mem::take(&mut waiting.words);
            let data = std::mem::take(&mut waiting.data);
            drop(waiting);
            for message in words.into_iter().chain(data) {
                if socket.write(message).is_err() {
                    return;
                }
            }
            if socket.flush().is_err() {
                return;
            }
        }
    }
}

fn is_pause(error: &std::io::Error) -> bool {
    use std::io::ErrorKind::{Interrupted, TimedOut, WouldBlock};
    matches!(error.kind(), WouldBlock | TimedOut | Interrupted)
}

/// Greets one that connects: a viewer's connection, where it is admitted.
///
/// # Errors
/// Why it is not, or nothing where it says nothing that is understood.
pub(super) fn greet(
    stream: TcpStream,
    admission: &Admission,
) -> Result<WebSocket<TcpStream>, Option<Refusal>> {
    let set = |stream: &TcpStream, patience: Duration| {
        stream
            .set_read_timeout(Some(patience))
            .and_then(|()| stream.set_write_timeout(Some(STUCK)))
            .map_err(|_| None::<Refusal>)
    };
    set(&stream, GREETING)?;
    let mut refusal = None;
    #[allow(
        clippy::result_large_err,
        reason = "the library's own type of a refusal"
    )]
    let judge = |request: &Request, mut response: Response| -> Result<Response, ErrorResponse> {
        match admission.judge(request) {
            Ok(()) => {
                let protocol = HeaderValue::from_static(PROTOCOL);
                response
                    .headers_mut()
                    .insert(SEC_WEBSOCKET_PROTOCOL, protocol);
                Ok(response)
            }
            Err(why) => {
                let response = why.response();
                refusal = Some(why);
                Err(response)
            }
        }
    };
    let config = WebSocketConfig::default()
        .max_message_size(Some(LARGEST))
        .max_frame_size(Some(LARGEST));
    let accepted = accept_hdr_with_config(stream, judge, Some(config)).ok();
    let socket = accepted.ok_or(refusal)?;
    set(socket.get_ref(), TURN)?;
    Ok(socket)
}
