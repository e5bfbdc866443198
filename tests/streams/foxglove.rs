//! Streams in Foxglove: recordings with JSON channels, exports of them, and the bridge to a running rig.

#![allow(clippy::panic, reason = "helpers of tests say what they saw")]

#[path = "../support/mod.rs"]
mod support;

use std::collections::BTreeMap;
use std::net::{TcpListener, TcpStream};
use std::process::Command;

use nix::sys::signal::Signal;
use serde_json::{Value, json};
use support::{
    Launcher, PATIENCE, Place, fault, has, press_for_minutes, printed, python, wait_for,
};
use tungstenite::{ClientRequestBuilder, Error, HandshakeError, Message, WebSocket};

/// A rig that plays a take, 100 samples a second.
fn playing(place: &Place) -> Launcher {
    press_for_minutes(&place.path("t.mcap"));
    let take = place.path("t.mcap");
    let mut launcher = Launcher::up(place, &["--play", take.to_str().expect("text")]);
    launcher.wait_says("is up");
    launcher
}

/// The program that compares the JSON channels of a recording with an export.
fn comparison(place: &Place, recording: &str, lines: &str) -> Command {
    let words = [recording, lines].map(|name| place.path(name).display().to_string());
    python(place, "foxglove.py", &words.each_ref().map(String::as_str))
}

/// Messages of each topic in the JSON channels of a recording, which are those of an export.
fn compared(place: &Place, recording: &str, lines: &str) -> BTreeMap<String, usize> {
    let counts = printed(&mut comparison(place, recording, lines), b"");
    serde_json::from_str(&counts).expect("counts")
}

/// Records a rig with JSON channels as `s.mcap`, and without as `none.mcap`.
fn record(place: &Place) {
    let launcher = playing(place);
    let record = ["recording", "record", "-o"];
    place.done(&[&record[..], &["s.mcap", "--seconds", "2"]].concat());
    let none = ["none.mcap", "--seconds", "0.5", "--json-hz", "0"];
    place.done(&[&record[..], &none].concat());
    launcher.close(place);
}

fn export(place: &Place, recording: &str, form: &str, output: &str) {
    let form = ["--format", form, "-o", output];
    place.done(&[&["recording", "export", recording], &form[..]].concat());
}

/// Messages of each topic in an export.
fn counted(lines: &str) -> BTreeMap<String, usize> {
    let mut counts = BTreeMap::new();
    for line in lines.lines() {
        let line: Value = serde_json::from_str(line).expect("JSON");
        let topic = line["topic"].as_str().expect("a topic").to_owned();
        *counts.entry(topic).or_insert(0) += 1;
    }
    counts
}

/// The JSON channels of the recording have all topics, and of what is sent often only a part.
fn check_thinned(thinned: &BTreeMap<String, usize>, sent: &BTreeMap<String, usize>) {
    assert!(thinned.keys().eq(sent.keys()), "{thinned:?} of {sent:?}");
    for topic in [
        "scene",
        "brush/main/def",
        "paint/status",
        "stylus/player/take",
    ] {
        assert_eq!(thinned[topic], sent[topic], "{topic}");
    }
    let fast = "stylus/player/sample";
    assert!(thinned[fast] < sent[fast], "{thinned:?} of {sent:?}");
}

#[test]
fn a_recording_and_its_export_have_json_channels_of_what_was_sent() {
    let place = Place::new();
    record(&place);
    export(&place, "s.mcap", "json", "s.json");
    export(&place, "s.mcap", "foxglove", "f.mcap");
    export(&place, "none.mcap", "json", "none.json");
    let text = String::from_utf8(place.bytes("s.json")).expect("text");
    let sent = counted(&text);
    assert_eq!(compared(&place, "f.mcap", "s.json"), sent);
    check_thinned(&compared(&place, "s.mcap", "s.json"), &sent);
    assert!(compared(&place, "none.mcap", "none.json").is_empty());
    // A fault in one number is found.
    let wrong = text.replacen("\"in_range\":true", "\"in_range\":false", 1);
    assert_ne!(wrong, text);
    place.write("wrong.json", wrong);
    let output = comparison(&place, "f.mcap", "wrong.json").output();
    let output = output.expect("started");
    assert!(!output.status.success());
    has(
        &String::from_utf8_lossy(&output.stderr),
        &["stylus/player/sample", "is not what was recorded"],
    );
    let fields = ["recording", "export", "s.mcap", "--format", "foxglove"];
    let fields = [&fields[..], &["--field", "seq", "-o", "x.mcap"]].concat();
    has(&fault(&place, &fields, 2), &["--field"]);
}

/// A viewer of the bridge, which speaks the Foxglove protocol.
struct Viewer {
    socket: WebSocket<TcpStream>,
    /// Numbers of the channels, by topic.
    channels: BTreeMap<String, u64>,
}

impl Viewer {
    /// Connects with the token of the bridge in a place, once it listens.
    fn connect(place: &Place, port: u16) -> Self {
        let token = wait_for(PATIENCE, || {
            std::fs::read_to_string(place.path("maulstick/bridge-token")).ok()
        });
        let token = token.expect("a token");
        let query = format!("/?token={}", token.trim());
        let socket = Self::ask(port, &query, None).expect("admitted");
        Self {
            socket,
            channels: BTreeMap::new(),
        }
    }

    /// Asks for a connection, as a page of an origin or as a program; the status of a refusal.
    fn ask(port: u16, query: &str, origin: Option<&str>) -> Result<WebSocket<TcpStream>, u16> {
        let stream = wait_for(PATIENCE, || TcpStream::connect(("127.0.0.1", port)).ok());
        let stream = stream.expect("the bridge listens");
        stream.set_read_timeout(Some(PATIENCE)).expect("set");
        let address = format!("ws://127.0.0.1:{port}{query}");
        let address = address.parse().expect("an address");
        let mut request = ClientRequestBuilder::new(address).with_sub_protocol("foxglove.sdk.v1");
        if let Some(origin) = origin {
            request = request.with_header("Origin", origin);
        }
        match tungstenite::client(request, stream) {
            Ok((socket, _)) => Ok(socket),
            Err(HandshakeError::Failure(Error::Http(answer))) => Err(answer.status().as_u16()),
            Err(other) => panic!("{other}"),
        }
    }

    /// The next message of a subscription: its number, time of arrival (ns), and JSON. Notes new channels meanwhile.
    fn next(&mut self) -> Option<(u32, u64, Value)> {
        match self.socket.read().expect("a message") {
            Message::Text(text) => {
                let said: Value = serde_json::from_str(&text).expect("JSON");
                let channels = said["channels"].as_array().into_iter().flatten();
                for channel in channels {
                    assert_eq!(channel["encoding"], "json");
                    assert_eq!(channel["schemaEncoding"], "jsonschema");
                    let topic = channel["topic"].as_str().expect("a topic");
                    let number = channel["id"].as_u64().expect("a number");
                    self.channels.insert(topic.to_owned(), number);
                }
                None
            }
            Message::Binary(data) if data[0] == 1 => {
                let number = u32::from_le_bytes(*data[1..].first_chunk().expect("4 bytes"));
                let time_ns = u64::from_le_bytes(*data[5..].first_chunk().expect("8 bytes"));
                Some((
                    number,
                    time_ns,
                    serde_json::from_slice(&data[13..]).expect("JSON"),
                ))
            }
            _ => None,
        }
    }

    /// Subscribes to a topic once it is advertised.
    fn subscribe(&mut self, topic: &str, number: u32) {
        while !self.channels.contains_key(topic) {
            self.next();
        }
        let wish = json!({
            "op": "subscribe",
            "subscriptions": [{ "id": number, "channelId": self.channels[topic] }],
        });
        self.socket
            .send(Message::text(wish.to_string()))
            .expect("sent");
    }

    /// The next message of a subscription.
    fn hear(&mut self, number: u32) -> (u64, Value) {
        loop {
            if let Some((own, time_ns, value)) = self.next()
                && own == number
            {
                return (time_ns, value);
            }
        }
    }
}

#[test]
fn a_viewer_watches_a_rig_by_the_bridge() {
    let place = Place::new();
    let launcher = playing(&place);
    let free = TcpListener::bind(("127.0.0.1", 0)).expect("a port");
    let port = free.local_addr().expect("an address").port();
    drop(free);
    let number = port.to_string();
    let bridge = ["topic", "bridge", "--port", &number, "--hz", "20"];
    let mut first = Launcher::start(place.maulstick(&bridge));
    let mut viewer = Viewer::connect(&place, port);
    // Neither other programs of the machine nor pages that the user looks at.
    assert_eq!(Viewer::ask(port, "/", None).err(), Some(403));
    let wrong = "/?token=00000000000000000000000000000000";
    assert_eq!(Viewer::ask(port, wrong, None).err(), Some(403));
    let page = Some("https://evil.example");
    assert_eq!(Viewer::ask(port, "/", page).err(), Some(403));
    // The scene is sent rarely: a viewer has the one that is kept.
    viewer.subscribe("scene", 1);
    let (_, mut scene) = viewer.hear(1);
    let echo = place.json(&["topic", "echo", "scene", "--once", "--json"]);
    let fields = scene.as_object_mut().expect("fields");
    let header = fields.remove("header").expect("a header");
    assert!(
        header["seq"].is_u64() && header["delay_ms"].is_number(),
        "{header}"
    );
    assert_eq!(scene, echo["value"]);
    // What is sent often is thinned: a second's share at once, and the others one by one.
    viewer.subscribe("stylus/player/sample", 2);
    let times: Vec<u64> = (0..50).map(|_| viewer.hear(2).0).collect();
    let lasted_ns = times
        .last()
        .zip(times.first())
        .map(|(last, first)| last - first);
    assert!(
        lasted_ns.is_some_and(|lasted_ns| lasted_ns >= 29 * 50_000_000),
        "{times:?}"
    );
    has(&fault(&place, &bridge, 1), &["is taken", "--port"]);
    let elsewhere = ["topic", "bridge", "--port", "0", "--address", "192.0.2.1"];
    has(&fault(&place, &elsewhere, 2), &["192.0.2.1", "--address"]);
    first.signal(Signal::SIGINT);
    assert!(first.wait(PATIENCE).success(), "{}", first.said());
    let mut second = Launcher::start(place.maulstick(&bridge));
    drop(Viewer::connect(&place, port));
    launcher.close(&place);
    second.wait(PATIENCE);
    has(&fault(&place, &bridge, 1), &["is running"]);
}
