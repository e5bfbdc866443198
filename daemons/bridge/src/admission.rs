//! Admission of viewers of a rig: a browser lets every page open a connection to this machine, and every user of the
//! machine reaches its ports.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use thiserror::Error;
use tokio_tungstenite::tungstenite::handshake::server::{ErrorResponse, Request};
use tokio_tungstenite::tungstenite::http::header::{ORIGIN, SEC_WEBSOCKET_PROTOCOL};
use tokio_tungstenite::tungstenite::http::{Response, StatusCode};

/// The protocol of the viewers.
pub(crate) const PROTOCOL: &str = "foxglove.sdk.v1";
/// Origins of Foxglove's own pages: in a browser, and in its program for desktops.
pub const FOXGLOVE: [&str; 2] = ["https://app.foxglove.dev", "file://"];
/// Most characters of an origin that is said.
const LONGEST: usize = 100;
/// Time in which the same refusal is said once.
const QUIET: Duration = Duration::from_secs(10);
/// Greatest number of distinguished refusals.
const KINDS: usize = 64;

/// Requirements for a viewer.
#[derive(Clone, Debug)]
pub struct Admission {
    /// The secret that its address has; none is asked for without one.
    pub token: Option<String>,
    /// Origins of pages that may watch; a program that is no browser has none.
    pub origins: Vec<String>,
}

/// Why a viewer may not watch.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Error)]
pub(crate) enum Refusal {
    /// A page of another origin.
    #[error("a page of {0} may not watch; --origin {0} lets it")]
    Origin(String),
    /// No token, or another one.
    #[error("a program without the token of the address may not watch")]
    Token,
    /// It does not speak the protocol.
    #[error("a program that does not speak {PROTOCOL} cannot watch")]
    Protocol,
    /// There are too many.
    #[error("there are too many viewers")]
    Full,
}

/// Text that is no origin.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("'{0}' is no origin, such as http://localhost:8080")]
pub struct NoOrigin(String);

/// Parses an origin in the form that browsers send: a scheme and a host, with its port.
///
/// # Errors
/// [`NoOrigin`] for another text.
pub fn origin(text: &str) -> Result<String, NoOrigin> {
    let is_sound = text.split_once("://").is_some_and(|(scheme, host)| {
        !scheme.is_empty() && !host.contains('/') && !text.contains(char::is_whitespace)
    });
    if is_sound {
        Ok(text.to_ascii_lowercase())
    } else {
        Err(NoOrigin(text.to_owned()))
    }
}

impl Admission {
    /// Checks the request of a viewer.
    ///
    /// # Errors
    /// The [`Refusal`].
    pub(crate) fn judge(&self, request: &Request) -> Result<(), Refusal> {
        let headers = request.headers();
        // No browser sends more than one.
        for origin in headers.get_all(ORIGIN) {
            let origin = String::from_utf8_lossy(origin.as_bytes()).to_ascii_lowercase();
            if !self.origins.contains(&origin) {
                return Err(Refusal::Origin(origin.chars().take(LONGEST).collect()));
            }
        }
        if let Some(token) = &self.token {
            let query = request.uri().query().unwrap_or_default();
            let mut given = query
                .split('&')
                .filter_map(|part| part.strip_prefix("token="));
            if !given.next().is_some_and(|given| is_same(given, token)) {
                return Err(Refusal::Token);
            }
        }
        let mut offered = headers
            .get_all(SEC_WEBSOCKET_PROTOCOL)
            .iter()
            .flat_map(|header| header.to_str().unwrap_or_default().split(','));
        if offered.any(|offered| offered.trim() == PROTOCOL) {
            Ok(())
        } else {
            Err(Refusal::Protocol)
        }
    }
}

/// Compares secrets in a time that is independent of the place of their difference.
fn is_same(one: &str, other: &str) -> bool {
    let pairs = one.bytes().zip(other.bytes());
    one.len() == other.len() && pairs.fold(0, |differ, (a, b)| differ | (a ^ b)) == 0
}

impl Refusal {
    /// The answer of HTTP.
    pub(crate) fn response(&self) -> ErrorResponse {
        let mut response = Response::new(Some(self.to_string()));
        *response.status_mut() = match self {
            Self::Origin(_) | Self::Token => StatusCode::FORBIDDEN,
            Self::Protocol => StatusCode::BAD_REQUEST,
            Self::Full => StatusCode::SERVICE_UNAVAILABLE,
        };
        response
    }
}

/// Refusals for the log: each kind once in an interval, with its count since.
#[derive(Debug, Default)]
pub(crate) struct Refusals(BTreeMap<Refusal, (Instant, u64)>);

impl Refusals {
    /// The line of a refusal, if it is to be said now.
    pub(crate) fn line(&mut self, refusal: &Refusal, now: Instant) -> Option<String> {
        if let Some((said, more)) = self.0.get_mut(refusal) {
            if now < *said + QUIET {
                *more += 1;
                return None;
            }
            let count = std::mem::take(more) + 1;
            *said = now;
            return Some(format!("refused, {count} times: {refusal}"));
        }
        if self.0.len() == KINDS {
            let oldest = self.0.iter().min_by_key(|(_, (said, _))| *said);
            let oldest = oldest.map(|(refusal, _)| refusal.clone());
            oldest.map(|refusal| self.0.remove(&refusal));
        }
        self.0.insert(refusal.clone(), (now, 0));
        Some(format!("refused: {refusal}"))
    }
}

#[cfg(test)]
mod tests {
    use tokio_tungstenite::tungstenite::http::Request as HttpRequest;

    use super::*;

    const TOKEN: &str = "0123456789abcdef0123456789abcdef";

    fn judged(token: Option<&str>, path: &str, headers: &[(&str, &str)]) -> Result<(), Refusal> {
        let admission = Admission {
            token: token.map(str::to_owned),
            origins: FOXGLOVE.iter().map(|origin| (*origin).to_owned()).collect(),
        };
        let mut request = HttpRequest::builder().uri(path);
        for (name, value) in headers {
            request = request.header(*name, *value);
        }
        admission.judge(&request.body(()).expect("a request"))
    }

    #[test]
    fn foxglove_and_programs_with_the_token_watch_and_nobody_else() {
        let speaks = (
            "Sec-WebSocket-Protocol",
            "foxglove.sdk.v1.1, foxglove.sdk.v1",
        );
        let path = format!("/?a=b&token={TOKEN}");
        let at = |path: &str, headers: &[(&str, &str)]| judged(Some(TOKEN), path, headers);
        assert_eq!(at(&path, &[speaks]), Ok(()));
        for origin in [
            "https://app.foxglove.dev",
            "HTTPS://App.Foxglove.dev",
            "file://",
        ] {
            assert_eq!(at(&path, &[speaks, ("Origin", origin)]), Ok(()), "{origin}");
        }
        for origin in [
            "null",
            "http://app.foxglove.dev",
            "https://app.foxglove.dev.evil.example",
            "http://localhost:8080",
        ] {
            let refused = at(&path, &[speaks, ("Origin", origin)]);
            assert_eq!(refused, Err(Refusal::Origin(origin.into())));
        }
        let two = [speaks, ("Origin", FOXGLOVE[0]), ("Origin", "null")];
        assert!(at(&path, &two).is_err());
        for path in [
            "/",
            "/?token=",
            "/?token=0123",
            "/?Token=x",
            &path[..path.len() - 1],
        ] {
            assert_eq!(at(path, &[speaks]), Err(Refusal::Token), "{path}");
        }
        assert_eq!(judged(None, "/", &[speaks]), Ok(()));
        let page = [speaks, ("Origin", "https://evil.example")];
        assert!(judged(None, "/", &page).is_err(), "a page without a token");
        assert_eq!(at(&path, &[]), Err(Refusal::Protocol));
        let other = ("Sec-WebSocket-Protocol", "foxglove.sdk.v10");
        assert_eq!(at(&path, &[other]), Err(Refusal::Protocol));
    }

    #[test]
    fn origins_are_read_or_rejected() {
        assert_eq!(
            origin("HTTP://Localhost:8080"),
            Ok("http://localhost:8080".into())
        );
        for wrong in [
            "",
            "localhost",
            "http://a/b",
            "http://a/",
            "://a",
            "http://a b",
        ] {
            assert!(origin(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn the_same_refusal_is_said_once_in_a_while_with_its_count() {
        let (mut refusals, start) = (Refusals::default(), Instant::now());
        let mut line =
            |s: u64, refusal: &Refusal| refusals.line(refusal, start + Duration::from_secs(s));
        assert!(line(0, &Refusal::Token).is_some_and(|line| !line.contains("times")));
        assert_eq!(
            [line(1, &Refusal::Token), line(9, &Refusal::Token)],
            [None, None]
        );
        assert!(line(2, &Refusal::Full).is_some());
        assert!(line(10, &Refusal::Token).is_some_and(|line| line.contains("3 times")));
        for number in 0..1000 {
            line(11, &Refusal::Origin(number.to_string()));
        }
        assert!(refusals.0.len() <= KINDS);
    }
}
