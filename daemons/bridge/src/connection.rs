//! Connection of a viewer: whether it is admitted, and until when it may take nothing.

use std::io::{Error as IoError, ErrorKind, Write as _};
use std::pin::Pin;
use std::task::{Context, Poll, ready};
use std::time::Duration;

use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::TcpStream;
use tokio::time::{Instant, Sleep, sleep, timeout};
use tokio_tungstenite::tungstenite::handshake::server::{
    ErrorResponse, Request, Response, write_response,
};
use tokio_tungstenite::tungstenite::http::HeaderValue;
use tokio_tungstenite::tungstenite::http::header::SEC_WEBSOCKET_PROTOCOL;
use tokio_tungstenite::tungstenite::protocol::WebSocketConfig;
use tokio_tungstenite::{WebSocketStream, accept_hdr_async_with_config};

use crate::admission::{Admission, PROTOCOL, Refusal};

/// Bytes of the largest message of a viewer.
const LARGEST: usize = 1 << 20;
/// Longest time until a viewer that connects is admitted: until then another user may have its place.
pub(crate) const GREETING: Duration = Duration::from_secs(2);
/// Longest time in which a viewer takes nothing; then it is dropped.
const STUCK: Duration = Duration::from_secs(2);

/// Connection to an admitted viewer.
pub(crate) type Connection = WebSocketStream<Bounded>;

/// Stream of bytes whose writes fail once nothing is taken for [`STUCK`].
pub(crate) struct Bounded {
    stream: TcpStream,
    stuck: Pin<Box<Sleep>>,
    /// Whether a write waits, until `stuck` at most.
    is_waiting: bool,
}

impl Bounded {
    fn new(stream: TcpStream) -> Self {
        Self {
            stream,
            stuck: Box::pin(sleep(STUCK)),
            is_waiting: false,
        }
    }
}

impl AsyncRead for Bounded {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &mut ReadBuf<'_>,
    ) -> Poll<Result<(), IoError>> {
        Pin::new(&mut self.stream).poll_read(context, bytes)
    }
}

impl AsyncWrite for Bounded {
    fn poll_write(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<Result<usize, IoError>> {
        if let Poll::Ready(written) = Pin::new(&mut self.stream).poll_write(context, bytes) {
            self.is_waiting = false;
            return Poll::Ready(written);
        }
        if !self.is_waiting {
            self.is_waiting = true;
            self.stuck.as_mut().reset(Instant::now() + STUCK);
        }
        ready!(self.stuck.as_mut().poll(context));
        Poll::Ready(Err(ErrorKind::TimedOut.into()))
    }

    fn poll_flush(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Result<(), IoError>> {
        Pin::new(&mut self.stream).poll_flush(context)
    }

    fn poll_shutdown(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Result<(), IoError>> {
        Pin::new(&mut self.stream).poll_shutdown(context)
    }
}

/// Answers one that connects in vain, whatever it asks; nobody waits until it takes the answer.
pub(crate) fn turn_away(stream: TcpStream, why: &Refusal) {
    let response = why.response();
    let mut answer = Vec::new();
    if write_response(&mut answer, &response).is_ok() {
        answer.extend_from_slice(response.body().as_deref().unwrap_or_default().as_bytes());
        let sent = stream.into_std();
        sent.and_then(|mut stream| stream.write_all(&answer)).ok();
    }
}

/// Greets one that connects, for so long: a viewer's connection, where it is admitted.
///
/// # Errors
/// Why it is not, or nothing where it says nothing that is understood.
pub(crate) async fn greet(
    stream: TcpStream,
    admission: &Admission,
    longest: Duration,
) -> Result<Connection, Option<Refusal>> {
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
    let greeting = accept_hdr_async_with_config(Bounded::new(stream), judge, Some(config));
    match timeout(longest, greeting).await {
        Ok(Ok(connection)) => Ok(connection),
        _ => Err(refusal),
    }
}

#[cfg(test)]
mod tests {
    use std::io::Read as _;

    use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
    use tokio::net::TcpListener;
    use tokio::time::interval;

    use super::*;

    /// Time of a greeting.
    const SHORT: Duration = Duration::from_millis(50);

    /// Both ends of a connection, the client's first.
    async fn connected() -> [TcpStream; 2] {
        let listener = TcpListener::bind(("127.0.0.1", 0)).await.expect("a port");
        let at = listener.local_addr().expect("an address");
        let client = TcpStream::connect(at).await.expect("connected");
        [client, listener.accept().await.expect("accepted").0]
    }

    fn nobody() -> Admission {
        Admission {
            token: Some("secret".into()),
            origins: Vec::new(),
        }
    }

    #[tokio::test]
    async fn one_who_trickles_bytes_is_not_greeted_for_longer_than_one_who_is_silent() {
        let [mut client, stream] = connected().await;
        let trickle = async {
            let mut tick = interval(Duration::from_millis(1));
            while client.write_all(b"G").await.is_ok() {
                tick.tick().await;
            }
        };
        let begun = Instant::now();
        let admission = nobody();
        let refused = tokio::select! {
            greeted = greet(stream, &admission, SHORT) => greeted.err(),
            () = trickle => None,
        };
        assert!(begun.elapsed() >= SHORT);
        assert_eq!(refused, Some(None));
        let [_silent, stream] = connected().await;
        let greeted = greet(stream, &admission, SHORT).await;
        assert_eq!(greeted.err(), Some(None));
    }

    #[tokio::test]
    async fn one_for_whom_there_is_no_place_has_an_answer() {
        let [client, stream] = connected().await;
        turn_away(stream, &Refusal::Full);
        let mut client = client.into_std().expect("a socket");
        client.set_nonblocking(false).expect("set");
        let mut answer = String::new();
        client.read_to_string(&mut answer).expect("an answer");
        let (head, why) = answer.split_once("\r\n\r\n").expect("a body");
        assert!(head.starts_with("HTTP/1.1 503 "), "{head}");
        assert_eq!(why, Refusal::Full.to_string());
    }

    #[tokio::test]
    async fn one_who_takes_nothing_is_dropped_and_one_who_takes_all_is_not() {
        let chunk = [0; 1 << 16];
        let [mut client, stream] = connected().await;
        let mut bounded = Bounded::new(stream);
        let taken = tokio::spawn(async move {
            let mut count = 0;
            let mut bytes = vec![0; 1 << 12];
            while let Ok(more @ 1..) = client.read(&mut bytes).await {
                count += more;
            }
            count
        });
        for _ in 0..256 {
            bounded.write_all(&chunk).await.expect("taken");
        }
        drop(bounded);
        assert_eq!(taken.await.expect("read"), 256 * chunk.len());
        let [_silent, stream] = connected().await;
        let mut bounded = Bounded::new(stream);
        let error = loop {
            if let Err(error) = bounded.write_all(&chunk).await {
                break error;
            }
        };
        assert_eq!(error.kind(), ErrorKind::TimedOut);
    }
}
