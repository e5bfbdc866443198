//! A connection to Haply's Inverse service: a WebSocket over TCP that never waits for long.

use std::net::{TcpStream, ToSocketAddrs};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use tungstenite::client::client_with_config;
use tungstenite::protocol::WebSocketConfig;
use tungstenite::{Bytes, Error, HandshakeError, Message, WebSocket};

use super::address::Address;
use super::connect_error::{ConnectError, Refusal};

/// Time without a message after which the service is gone.
pub const SILENCE: Duration = Duration::from_secs(1);
/// Waits so long at a time for a message, then looks whether it is time to end.
const WAIT: Duration = Duration::from_millis(10);
/// Waits so long for each of a host's addresses.
const REACH: Duration = Duration::from_millis(500);
/// Largest message, bytes: of a service with a hundred devices.
const LARGEST: usize = 1 << 20;
/// Buffer for what comes and what goes, bytes.
const BUFFER: usize = 16 << 10;
/// Waits so often for the service to close its side.
const FAREWELLS: usize = 10;

/// The reason why the connection ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The stop flag was set.
    Stopped,
    /// The connection is closed or broken.
    Closed,
    /// No message came in time.
    Silent,
    /// The data are no WebSocket's, or larger than any message of the service.
    Foreign,
}

/// An open connection.
#[derive(Debug)]
pub struct Connection {
    socket: WebSocket<TcpStream>,
}

impl Connection {
    /// Connects to the service of an address.
    ///
    /// # Errors
    /// [`ConnectError`] if there is no service.
    pub fn open(address: &Address) -> Result<Self, ConnectError> {
        let stream = reach(address)?;
        let config = WebSocketConfig::default()
            .read_buffer_size(BUFFER)
            .write_buffer_size(0)
            .max_message_size(Some(LARGEST))
            .max_frame_size(Some(LARGEST));
        let (socket, _) =
            client_with_config(&address.url, stream, Some(config)).map_err(|error| {
                let why = match error {
                    HandshakeError::Failure(error) if bear(&error).is_err() => error.to_string(),
                    HandshakeError::Failure(_) | HandshakeError::Interrupted(_) => {
                        "it says nothing".into()
                    }
                };
                ConnectError::new(&address.url, Refusal::Foreign(why))
            })?;
        let connection = Self { socket };
        connection
            .socket
            .get_ref()
            .set_read_timeout(Some(WAIT))
            .map_err(|error| absent(address, error.to_string()))?;
        Ok(connection)
    }

    /// The next message, unless `stop` is set before it comes, or it takes longer than `patience`.
    ///
    /// # Errors
    /// The reason why none came.
    pub fn receive(&mut self, stop: &AtomicBool, patience: Duration) -> Result<Bytes, End> {
        let since = Instant::now();
        loop {
            match self.socket.read() {
                Ok(Message::Text(text)) => return Ok(text.into()),
                Ok(Message::Binary(bytes)) => return Ok(bytes),
                Ok(Message::Close(_)) => return Err(End::Closed),
                Ok(Message::Ping(_) | Message::Pong(_) | Message::Frame(_)) => {}
                Err(error) => bear(&error)?,
            }
            if stop.load(Ordering::Relaxed) {
                return Err(End::Stopped);
            }
            if since.elapsed() >= patience {
                return Err(End::Silent);
            }
        }
    }

    /// A message that has already come, if one has.
    ///
    /// # Errors
    /// Reason why there will be none.
    pub fn waiting(&mut self) -> Result<Option<Bytes>, End> {
        let broken = |_| End::Closed;
        let stream = self.socket.get_ref();
        stream.set_nonblocking(true).map_err(broken)?;
        let read = self.socket.read();
        let stream = self.socket.get_ref();
        stream.set_nonblocking(false).map_err(broken)?;
        match read {
            Ok(Message::Text(text)) => Ok(Some(text.into())),
            Ok(Message::Binary(bytes)) => Ok(Some(bytes)),
            Ok(Message::Close(_)) => Err(End::Closed),
            Ok(Message::Ping(_) | Message::Pong(_) | Message::Frame(_)) => Ok(None),
            Err(error) => bear(&error).map(|()| None),
        }
    }

    /// Sends a message.
    ///
    /// # Errors
    /// If it cannot be sent.
    pub fn send(&mut self, text: String) -> Result<(), End> {
        self.socket
            .send(Message::text(text))
            .map_err(|error| bear(&error).err().unwrap_or(End::Silent))
    }

    /// Closes it as is proper, but does not wait long for the service to agree.
    pub fn close(mut self) {
        if self.socket.close(None).is_err() {
            return;
        }
        for _ in 0..FAREWELLS {
            match self.socket.read() {
                Ok(_) => {}
                Err(error) if bear(&error).is_ok() => {}
                Err(_) => return,
            }
        }
    }
}

/// Tolerates an error that only means that nothing has arrived yet.
fn bear(error: &Error) -> Result<(), End> {
    use std::io::ErrorKind::{Interrupted, TimedOut, WouldBlock};
    match error {
        Error::Io(error) if matches!(error.kind(), WouldBlock | TimedOut | Interrupted) => Ok(()),
        Error::ConnectionClosed | Error::AlreadyClosed | Error::Io(_) => Err(End::Closed),
        // A peer that goes away without a word.
        Error::Protocol(tungstenite::error::ProtocolError::ResetWithoutClosingHandshake) => {
            Err(End::Closed)
        }
        _ => Err(End::Foreign),
    }
}

fn reach(address: &Address) -> Result<TcpStream, ConnectError> {
    let hosts = address
        .host
        .to_socket_addrs()
        .map_err(|error| absent(address, error.to_string()))?;
    let mut why = "the host has no address".to_owned();
    for host in hosts {
        let reached = TcpStream::connect_timeout(&host, REACH).and_then(|stream| {
            stream.set_nodelay(true)?;
            stream.set_read_timeout(Some(SILENCE))?;
            stream.set_write_timeout(Some(SILENCE))?;
            Ok(stream)
        });
        match reached {
            Ok(stream) => return Ok(stream),
            Err(error) => why = error.to_string(),
        }
    }
    Err(absent(address, why))
}

fn absent(address: &Address, why: String) -> ConnectError {
    ConnectError::new(&address.url, Refusal::NoService(why))
}
