//! A service that speaks as Haply's Inverse service does, or misbehaves as it is told to.

use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tungstenite::{Message, WebSocket};

/// Reaction of the service to a message.
pub(crate) enum Act {
    /// Answers by a state.
    Say(Value),
    /// Answers by a state, twice.
    Twice(Value),
    /// Answers by something else.
    Send(Message),
    /// Says nothing.
    Rest,
    /// Closes the connection as is proper.
    Close,
    /// Goes away.
    Vanish,
}

/// Messages that the service was sent.
#[derive(Default)]
pub(crate) struct Heard {
    /// Messages, oldest first.
    pub(crate) messages: Vec<Value>,
    /// True once the client has closed its side.
    pub(crate) closed: bool,
    /// When the last message came.
    pub(crate) last: Option<Instant>,
}

impl Heard {
    /// The commands of the newest message to a device.
    pub(crate) fn newest(&self, device: &str) -> Option<&Value> {
        let message = self.messages.last()?;
        let asked = &message["inverse3"][0];
        (asked["device_id"] == device).then(|| &asked["commands"])
    }
}

/// A running service.
pub(crate) struct Service {
    pub(crate) url: String,
    heard: Arc<Mutex<Heard>>,
    address: SocketAddr,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Service {
    /// A service that sends `first` to whoever connects, and then acts on the n-th message as `act` says.
    pub(crate) fn start(first: Act, mut act: impl FnMut(usize) -> Act + Send + 'static) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
        let address = listener.local_addr().expect("an address");
        let url = format!("ws://{address}");
        let heard = Arc::new(Mutex::new(Heard::default()));
        let stop = Arc::new(AtomicBool::new(false));
        let (hearing, stopped) = (Arc::clone(&heard), Arc::clone(&stop));
        let thread = std::thread::spawn(move || {
            while let Ok((stream, _)) = listener.accept() {
                if stopped.load(Ordering::Relaxed) {
                    return;
                }
                serve(stream, &first, &mut act, &hearing, &stopped);
            }
        });
        Self {
            url,
            address,
            heard,
            stop,
            thread: Some(thread),
        }
    }

    pub(crate) fn heard(&self) -> MutexGuard<'_, Heard> {
        self.heard.lock().expect("heard")
    }
}

impl Drop for Service {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        // It waits for whoever connects.
        TcpStream::connect(self.address).ok();
        if let Some(thread) = self.thread.take() {
            thread.join().ok();
        }
    }
}

fn serve(
    stream: TcpStream,
    first: &Act,
    act: &mut dyn FnMut(usize) -> Act,
    heard: &Mutex<Heard>,
    stop: &AtomicBool,
) {
    stream.set_nonblocking(false).expect("waiting");
    stream.set_nodelay(true).expect("no delay");
    let Ok(mut socket) = tungstenite::accept(stream) else {
        return;
    };
    let short = Some(Duration::from_millis(5));
    socket.get_ref().set_read_timeout(short).expect("a timeout");
    if perform(&mut socket, first).is_break() {
        return;
    }
    let mut count = 0;
    while !stop.load(Ordering::Relaxed) {
        match socket.read() {
            Ok(Message::Text(text)) => {
                let message: Value = serde_json::from_str(&text).expect("JSON");
                let is_command = text.contains("set_cursor_force");
                let mut heard = heard.lock().expect("heard");
                heard.messages.push(message);
                heard.last = Some(Instant::now());
                drop(heard);
                let mut act = act(count);
                // A session that does not command its device is told of no grip.
                if let (Act::Say(value), false) = (&mut act, is_command) {
                    value["verse_grip"] = json!([]);
                    value["wireless_verse_grip"] = json!([]);
                }
                if perform(&mut socket, &act).is_break() {
                    return;
                }
                count += 1;
            }
            Ok(Message::Close(_)) => heard.lock().expect("heard").closed = true,
            Ok(_) => {}
            Err(tungstenite::Error::Io(error))
                if matches!(
                    error.kind(),
                    std::io::ErrorKind::WouldBlock | std::io::ErrorKind::TimedOut
                ) => {}
            Err(_) => return,
        }
    }
}

fn perform(socket: &mut WebSocket<TcpStream>, act: &Act) -> std::ops::ControlFlow<()> {
    use std::ops::ControlFlow::{Break, Continue};
    let sent = match act {
        Act::Say(value) => socket.send(Message::text(value.to_string())),
        Act::Twice(value) => {
            let text = value.to_string();
            let first = socket.send(Message::text(text.clone()));
            first.and_then(|()| socket.send(Message::text(text)))
        }
        Act::Send(message) => socket.send(message.clone()),
        Act::Rest => Ok(()),
        Act::Close => {
            socket.close(None).ok();
            socket.flush()
        }
        Act::Vanish => return Break(()),
    };
    match sent {
        Ok(()) => Continue(()),
        Err(_) => Break(()),
    }
}

/// First message of a service of 3.5: docs.haply.co, service/realtime/websocket-protocol.
pub(crate) fn inventory() -> Value {
    json!({
        "session_id": 7,
        "inverse3": [{
            "device_id": "049D",
            "config": {
                "type": "inverse3",
                "port": "COM12",
                "device_info": { "major_version": 7, "minor_version": 4, "id": "049D", "device_type": 4 },
                "gravity_compensation": { "enabled": true, "scaling_factor": 1.0 },
                "handedness": "right",
                "streaming_mode": "USB",
                "basis": { "permutation": "XYZ" },
                "filters": { "force_gate": { "gain": 0.3 }, "damping": { "scalar": 0.0 } }
            },
            "state": state(),
            "status": status()
        }],
        "verse_grip": [],
        "wireless_verse_grip": [{
            "device_id": "61548",
            "state": {
                "battery_level": 0.9,
                "buttons": { "a": true, "b": false, "c": true },
                "hall": 1,
                "orientation": { "w": 1.0, "x": 0.0, "y": 0.0, "z": 0.0 }
            }
        }]
    })
}

pub(crate) fn state() -> Value {
    json!({
        "cursor_position": { "x": 0.01, "y": -0.12, "z": 0.15 },
        "cursor_velocity": { "x": 0.1, "y": 0.2, "z": 0.3 },
        "angular_position": { "a0": 0.0, "a1": 0.0, "a2": 0.0 },
        "body_orientation": { "w": 1.0, "x": 0.0, "y": 0.0, "z": 0.0 },
        "current_cursor_force": { "x": 0.0, "y": 0.0, "z": 0.0 },
        "control_domain": "cartesian",
        "control_mode": "idle"
    })
}

pub(crate) fn status() -> Value {
    json!({
        "calibrated": true, "in_use": false, "power_supply": true, "ready": true, "started": true
    })
}

/// A state of a device, after the first message.
pub(crate) fn update(device: &str, state: Value) -> Value {
    json!({
        "inverse3": [{ "device_id": device, "state": state, "status": status() }],
        "wireless_verse_grip": inventory()["wireless_verse_grip"]
    })
}

/// First message of a service before 3.5.
pub(crate) fn old_inventory() -> Value {
    json!({
        "inverse3": [{
            "device_id": "04BA",
            "config": {
                "type": "inverse3",
                "device_info": { "minor_version": 1, "major_version": 7, "id": "04BA", "model": 4 },
                "port": "COM13",
                "gravity_compensation": { "enabled": true, "scaling_factor": 1 },
                "handedness": "right",
                "torque_scaling": { "enabled": true }
            },
            "state": {
                "cursor_position": { "x": 0.07842738, "y": -0.14836666, "z": 0.14297646 },
                "cursor_velocity": { "x": -0.011969013, "y": 0.0012009288, "z": -0.043197 },
                "mode": "idle"
            },
            "status": status()
        }],
        "verse_grip": [{
            "device_id": "61548",
            "config": { "port": "COM3", "type": "verse_grip" },
            "state": {
                "button": true,
                "hall": 0,
                "orientation": {
                    "x": -0.5019531, "y": 0.8632202, "z": -0.048095703, "w": -0.022338867
                }
            }
        }]
    })
}
