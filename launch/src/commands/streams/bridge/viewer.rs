//! One viewer of the bridge: its connection, on a separate thread, and its queue.

use std::collections::{BTreeMap, VecDeque};
use std::io::{ErrorKind, Read, Write};
use std::net::TcpStream;
use std::sync::mpsc::Sender;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use foxglove::ws_protocol::client::ClientMessage;
use foxglove::ws_protocol::server::MessageData;
use foxglove::ws_protocol::{BinaryMessage as _, JsonMessage};
use tungstenite::handshake::server::{ErrorResponse, Request, Response, write_response};
use tungstenite::http::HeaderValue;
use tungstenite::http::header::SEC_WEBSOCKET_PROTOCOL;
use tungstenite::protocol::{Role, WebSocketConfig};
use tungstenite::{Error, Message, WebSocket, accept_hdr_with_config};

use super::admission::{Admission, PROTOCOL, Refusal};

/// Messages that wait for a slow viewer; older ones are dropped.
const BACKLOG: usize = 1024;
/// Bytes of the largest message of a viewer.
const LARGEST: usize = 1 << 20;
/// Longest time until a viewer that connects is admitted: until then another user may have its place.
const GREETING: Duration = Duration::from_secs(2);
/// Longest wait for a viewer's message while others may have to be sent.
const TURN: Duration = Duration::from_millis(10);
/// Time after which a viewer that receives nothing is dropped.
const STUCK: Duration = Duration::from_secs(2);

/// Queue and subscriptions of a viewer.
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
    /// Viewer of the request.
    pub viewer: Arc<Viewer>,
    /// The channel.
    pub channel: u64,
}

impl Viewer {
    fn lock(&self) -> MutexGuard<'_, Waiting> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Queues a message about the server.
    pub(super) fn say(&self, words: &impl JsonMessage) {
        let words = JsonMessage::to_string(words);
        self.lock().words.push_back(Message::text(words));
    }

    /// True if it watches a channel.
    pub(super) fn watches(&self, channel: u64) -> bool {
        self.lock().subscriptions.contains_key(&channel)
    }

    /// Queues a message of a channel, if it is subscribed.
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

    /// Carries out its request; there are `channels` channels.
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
            // The bridge ignores all other messages of its viewers.
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

/// Connection of one that is not yet admitted: all that is read and written ends by one time.
struct Greeting<'a> {
    stream: &'a TcpStream,
    until: Instant,
}

impl Greeting<'_> {
    /// The time that is left; none is an error, for a socket takes 0 for no limit.
    fn left(&self) -> std::io::Result<Option<Duration>> {
        match self.until.saturating_duration_since(Instant::now()) {
            Duration::ZERO => Err(ErrorKind::TimedOut.into()),
            left => Ok(Some(left)),
        }
    }
}

impl Read for Greeting<'_> {
    fn read(&mut self, bytes: &mut [u8]) -> std::io::Result<usize> {
        self.stream.set_read_timeout(self.left()?)?;
        self.stream.read(bytes)
    }
}

impl Write for Greeting<'_> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.stream.set_write_timeout(self.left()?)?;
        self.stream.write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.stream.flush()
    }
}

/// Answers a refused connection, whatever its request, without waiting until the answer is received.
pub(super) fn turn_away(mut stream: TcpStream, why: &Refusal) {
    let response = why.response();
    let mut answer = Vec::new();
    if write_response(&mut answer, &response).is_ok() {
        answer.extend_from_slice(response.body().as_deref().unwrap_or_default().as_bytes());
        let sent = stream.set_nonblocking(true);
        sent.and_then(|()| stream.write_all(&answer)).ok();
    }
}

/// Accepts a connection: returns that of an admitted viewer.
///
/// # Errors The refusal, or `None` for an unreadable request.
pub(super) fn greet(
    stream: TcpStream,
    admission: &Admission,
) -> Result<WebSocket<TcpStream>, Option<Refusal>> {
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
    let greeting = Greeting {
        stream: &stream,
        until: Instant::now() + GREETING,
    };
    let is_admitted = accept_hdr_with_config(greeting, judge, Some(config)).is_ok();
    if !is_admitted {
        return Err(refusal);
    }
    stream
        .set_read_timeout(Some(TURN))
        .and_then(|()| stream.set_write_timeout(Some(STUCK)))
        .map_err(|_| None)?;
    // Data sent with the request would have been refused, so none are lost.
    Ok(WebSocket::from_raw_socket(
        stream,
        Role::Server,
        Some(config),
    ))
}

#[cfg(test)]
mod tests {
    use std::net::TcpListener;

    use super::*;

    /// Time of a greeting.
    const SHORT: Duration = Duration::from_millis(50);

    /// Both ends of a connection.
    fn connected() -> [TcpStream; 2] {
        let listener = TcpListener::bind(("127.0.0.1", 0)).expect("a port");
        let at = listener.local_addr().expect("an address");
        let client = TcpStream::connect(at).expect("connected");
        [client, listener.accept().expect("accepted").0]
    }

    #[test]
    fn one_who_trickles_bytes_is_not_greeted_for_longer_than_one_who_is_silent() {
        let [mut client, stream] = connected();
        let mut greeting = Greeting {
            stream: &stream,
            until: Instant::now() + SHORT,
        };
        let ended = loop {
            assert!(Instant::now() < greeting.until + Duration::from_secs(60));
            client.write_all(b"G").expect("sent");
            if let Err(error) = greeting.read(&mut [0]) {
                break error;
            }
        };
        assert!(is_pause(&ended) && Instant::now() >= greeting.until);
        assert!(greeting.write(b"late").is_err());
        let [_silent, stream] = connected();
        let mut greeting = Greeting {
            stream: &stream,
            until: Instant::now() + SHORT,
        };
        assert!(is_pause(&greeting.read(&mut [0]).expect_err("silence")));
    }

    #[test]
    fn one_for_whom_there_is_no_place_has_an_answer() {
        let [mut client, stream] = connected();
        turn_away(stream, &Refusal::Full);
        let mut answer = String::new();
        client.read_to_string(&mut answer).expect("an answer");
        let (head, why) = answer.split_once("\r\n\r\n").expect("a body");
        assert!(head.starts_with("HTTP/1.1 503 "), "{head}");
        assert_eq!(why, Refusal::Full.to_string());
    }
}
