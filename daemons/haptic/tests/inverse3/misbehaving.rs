//! Services that are absent, others', or go wrong in mid-run.

use glam::DVec3;
use maulstick_haptic::device::driver::{DeviceError, Driver};
use maulstick_haptic::drivers::inverse3::connect_error::Refusal;
use maulstick_haptic::drivers::inverse3::message::Hindrance;
use serde_json::json;
use tungstenite::Message;

use super::service::{Act, Service, inventory, state, update};
use super::{opened, reading, refusal, run_ticks, wait_for};

/// Error by which a device is lost in the end.
fn error_of(driver: &mut dyn Driver) -> DeviceError {
    wait_for(|| driver.read(1e-3).err()).expect("it is lost")
}

#[test]
fn refuses_what_is_no_ready_device() {
    let closed = std::net::TcpListener::bind("127.0.0.1:0").expect("a port");
    let port = closed.local_addr().expect("an address");
    drop(closed);
    let absent = refusal(&format!("ws://{port}"));
    assert!(matches!(absent, Refusal::NoService(_)), "{absent:?}");

    let first = |act| {
        let service = Service::start(act, |_| Act::Rest);
        refusal(&service.url)
    };
    let none = first(Act::Say(json!({ "inverse3": [] })));
    assert_eq!(none, Refusal::Absent);
    for act in [
        Act::Send(Message::text("hello")),
        Act::Send(Message::binary(vec![0xff; 9])),
        Act::Send(Message::text("x".repeat(2 << 20))),
        Act::Say(json!({ "inverse3": 3 })),
        Act::Rest,
        Act::Close,
        Act::Vanish,
    ] {
        let foreign = first(act);
        assert!(matches!(foreign, Refusal::Foreign(_)), "{foreign:?}");
    }
    let id = || "049D".to_owned();
    let hindered = |hindrance| Refusal::Hindered(id(), hindrance);
    let axes = json!({ "permutation": "XYX" });
    for (part, key, value, refusal) in [
        (
            "status",
            "calibrated",
            json!(false),
            hindered(Hindrance::NotCalibrated),
        ),
        (
            "status",
            "power_supply",
            json!(false),
            hindered(Hindrance::NoPower),
        ),
        ("status", "in_use", json!(true), Refusal::InUse(id())),
        ("config", "basis", axes, hindered(Hindrance::UnknownAxes)),
    ] {
        let mut message = inventory();
        message["inverse3"][0][part][key] = value;
        assert_eq!(first(Act::Say(message)), refusal);
    }
}

#[test]
fn a_listener_that_is_no_websocket_is_told_as_that() {
    let listener = std::net::TcpListener::bind("127.0.0.1:0").expect("a port");
    let url = format!("ws://{}", listener.local_addr().expect("an address"));
    let thread = std::thread::spawn(move || {
        let (mut stream, _) = listener.accept().expect("a client");
        std::io::Write::write_all(&mut stream, b"SSH-2.0-OpenSSH_9\r\n\r\n").ok();
    });
    let foreign = refusal(&url);
    assert!(matches!(foreign, Refusal::Foreign(_)), "{foreign:?}");
    thread.join().expect("it ends");
}

/// Conduct of a service, and the words about it.
type Case = (fn() -> Act, &'static str);

/// A service that is as it should be for 50 messages, and then acts so.
fn turning(act: fn() -> Act) -> Service {
    Service::start(Act::Say(inventory()), move |count| match count {
        0..50 => Act::Say(update("049D", state())),
        _ => act(),
    })
}

#[test]
fn a_service_or_device_that_goes_is_told_as_how_it_went() {
    let closed = "the Inverse service has closed the connection";
    let foreign = "the Inverse service sends what cannot be read";
    let cases: [Case; 10] = [
        (|| Act::Close, closed),
        (|| Act::Vanish, closed),
        (|| Act::Rest, "the Inverse service does not answer any more"),
        (|| Act::Send(Message::text("{\"inverse3\": [")), foreign),
        (|| Act::Send(Message::binary(vec![0; 1000])), foreign),
        (|| Act::Send(Message::binary(vec![b' '; 2 << 20])), foreign),
        (
            || Act::Say(json!({ "inverse3": [] })),
            "the Inverse3 is unplugged",
        ),
        (
            || {
                let mut far = state();
                far["cursor_position"]["x"] = json!(50.0);
                Act::Say(update("049D", far))
            },
            "the Inverse3 tells places where its cursor cannot be",
        ),
        (
            || {
                Act::Say(
                    json!({ "inverse3": [{ "device_id": "049D", "state": state(),
                "status": { "calibrated": false } }] }),
                )
            },
            "the Inverse3 is not calibrated",
        ),
        (
            || {
                Act::Send(Message::text(
                    r#"{"inverse3":[{"device_id":"049D","state":{"cursor_position":{"x":1e999,"y":0,"z":0}}}]}"#,
                ))
            },
            foreign,
        ),
    ];
    for (act, what) in cases {
        let service = turning(act);
        let mut driver = opened(&service.url);
        let error = error_of(&mut *driver);
        assert_eq!(error.what, what);
        assert!(!error.help.is_empty());
    }
    // One that goes on as it should is not lost.
    let service = turning(|| Act::Say(update("049D", state())));
    let mut driver = opened(&service.url);
    let long = || (service.heard().messages.len() > 500).then_some(());
    assert_eq!(run_ticks(&mut *driver, DVec3::ZERO, long), Some(()));
}

#[test]
fn what_cannot_be_read_between_states_is_passed_over() {
    let service = Service::start(Act::Say(inventory()), |count| match count % 6 {
        1 => Act::Send(Message::text("nonsense")),
        2 => Act::Send(Message::binary(vec![0xfe, 0xff])),
        3 => Act::Say(json!({ "inverse3": [{ "device_id": "049D", "state": {
            "cursor_position": { "x": 50.0, "y": 0, "z": 0 } } }] })),
        4 => Act::Say(update("0AAA", state())),
        _ => Act::Say(update("049D", state())),
    });
    let mut driver = opened(&service.url);
    for _ in 0..100 {
        let read = reading(&mut *driver).expect("there").expect("new");
        assert_eq!(read.handle.position, DVec3::new(0.01, 0.15, 0.12));
    }
}

#[test]
fn states_in_binary_messages_are_read() {
    let service = Service::start(Act::Say(inventory()), |_| {
        Act::Send(Message::binary(
            update("049D", state()).to_string().into_bytes(),
        ))
    });
    let mut driver = opened(&service.url);
    for _ in 0..20 {
        assert!(reading(&mut *driver).expect("there").is_some());
    }
}
