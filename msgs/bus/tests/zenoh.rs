//! The bus between processes, here between sessions of one process over the rig's sockets.

use std::time::{Duration, Instant};

use zenoh::Wait as _;
use zenoh::qos::Priority;

use maulstick_bus::bus::Answer;
use maulstick_bus::{Bus, BusError, Class, Dial, Queue, RigClock, RigFolder, Wake, ZenohBus};

const PATIENCE: Duration = Duration::from_secs(30);

struct Rig {
    _base: tempfile::TempDir,
    folder: RigFolder,
    clock: RigClock,
    hub: ZenohBus,
}

fn rig() -> Rig {
    let base = tempfile::tempdir().expect("a folder");
    let folder = RigFolder::create_in(&base.path().join("rigs"), "test").expect("a rig");
    let clock = RigClock::start();
    let dial = Dial {
        name: "hub".into(),
        listen: Some(folder.locator("hub")),
        connect: vec![],
    };
    let hub = ZenohBus::open(&dial, clock).expect("a hub");
    Rig {
        _base: base,
        folder,
        clock,
        hub,
    }
}

impl Rig {
    fn node(&self, name: &str) -> ZenohBus {
        let dial = Dial {
            name: name.into(),
            listen: Some(self.folder.locator(name)),
            connect: vec![self.folder.locator("hub")],
        };
        ZenohBus::open(&dial, self.clock).expect(name)
    }

    fn client(&self) -> ZenohBus {
        let connect = vec![self.folder.locator("hub")];
        ZenohBus::open(
            &Dial {
                name: "client".into(),
                listen: None,
                connect,
            },
            self.clock,
        )
        .expect("a client")
    }
}

/// Repeats `turn` until it gives something.
fn until<T>(wake: &Wake, mut turn: impl FnMut() -> Option<T>) -> T {
    let give_up = Instant::now() + PATIENCE;
    loop {
        if let Some(found) = turn() {
            return found;
        }
        assert!(Instant::now() < give_up, "nothing came");
        wake.wait(Duration::from_millis(5));
    }
}

#[test]
fn nodes_that_know_only_the_hub_find_each_other() {
    let rig = rig();
    let (one, two, client) = (rig.node("one"), rig.node("two"), rig.client());
    let wake = Wake::new();
    let publisher = one.publisher("t/a", Class::RealTime).expect("declared");
    for (who, bus) in [
        ("a node", &two),
        ("a client", &client),
        ("the hub", &rig.hub),
    ] {
        let subscription = bus
            .subscribe("t/*", Class::RealTime, Queue::Ring(8), &wake)
            .expect("subscribed");
        let arrival = until(&wake, || {
            publisher.put(vec![1, 2, 3]).expect("sent");
            subscription.try_recv()
        });
        assert_eq!(
            (arrival.key.as_str(), arrival.bytes),
            ("t/a", vec![1, 2, 3]),
            "{who}"
        );
        assert!(arrival.arrived_ns.abs_diff(bus.now_ns()) < 1_000_000_000);
    }
}

#[test]
fn a_late_joiner_gets_the_last_cached_value() {
    let rig = rig();
    let one = rig.node("one");
    let wake = Wake::new();
    let publisher = one.publisher("t/scene", Class::Cached).expect("declared");
    publisher.put(vec![1]).expect("sent");
    publisher.put(vec![2]).expect("sent");
    let two = rig.node("two");
    let late = two
        .subscribe("t/*", Class::Cached, Queue::Ring(8), &wake)
        .expect("subscribed");
    assert_eq!(until(&wake, || late.try_recv()).bytes, vec![2]);
}

#[test]
fn queries_are_answered_or_end() {
    let rig = rig();
    let (one, two) = (rig.node("one"), rig.client());
    let wake = Wake::new();
    let server = one.serve("t/q", 4, &wake).expect("serving");
    let answer = until(&wake, || {
        let limit = Duration::from_millis(500);
        let pending = two
            .ask("t/q", Class::Control, vec![7], limit, &wake)
            .expect("asked");
        until(&wake, || {
            if let Some(request) = server.try_recv() {
                let doubled = [&request.bytes[..], &request.bytes[..]].concat();
                request.answer(doubled).expect("answered");
            }
            pending.try_recv()
        })
        .into_bytes()
    });
    assert_eq!(answer, vec![7, 7]);
    let limit = Duration::from_millis(50);
    let nobody = two
        .ask("t/nobody", Class::Control, vec![], limit, &wake)
        .expect("asked")
        .wait(&wake);
    assert!(
        matches!(nobody, Err(BusError::NoAnswer { .. })),
        "{nobody:?}"
    );
}

#[test]
fn a_question_travels_in_its_class() {
    let rig = rig();
    let (one, two) = (rig.node("one"), rig.client());
    let wake = Wake::new();
    let classes = [
        ("t/frame", Class::Data, Priority::Data),
        ("t/command", Class::Control, Priority::InteractiveHigh),
    ];
    for (key, class, priority) in classes {
        let (to, heard) = std::sync::mpsc::channel();
        let queryable = one
            .raw_session()
            .declare_queryable(key)
            .callback(move |query| {
                to.send(query.priority()).ok();
            })
            .wait()
            .expect("declared");
        let limit = Duration::from_millis(50);
        let came = until(&wake, || {
            let asked = two.ask(key, class, Vec::new(), limit, &wake);
            drop(asked.expect("asked").wait(&wake));
            heard.try_recv().ok()
        });
        assert_eq!(came, priority);
        drop(queryable);
    }
}

trait IntoBytes {
    fn into_bytes(self) -> Option<Vec<u8>>;
}

impl IntoBytes for Answer {
    fn into_bytes(self) -> Option<Vec<u8>> {
        match self {
            Answer::Bytes(bytes) => Some(bytes),
            Answer::Ended => None,
        }
    }
}

#[test]
fn tokens_come_and_go() {
    let rig = rig();
    let wake = Wake::new();
    let watch = rig.hub.watch("t/node/*", &wake).expect("watching");
    let one = rig.node("one");
    let token = one.token("t/node/one").expect("shown");
    let came = until(&wake, || watch.try_recv());
    assert_eq!((came.key.as_str(), came.present), ("t/node/one", true));
    drop(token);
    assert!(!until(&wake, || watch.try_recv()).present);
    let again = one.token("t/node/one").expect("shown");
    assert!(until(&wake, || watch.try_recv()).present);
    drop(again);
    one.close();
    assert!(!until(&wake, || watch.try_recv()).present);
}

#[test]
fn a_socket_that_is_taken_is_an_error() {
    let rig = rig();
    let dial = Dial {
        name: "x".into(),
        listen: Some(rig.folder.locator("hub")),
        connect: Vec::new(),
    };
    assert!(matches!(
        ZenohBus::open(&dial, rig.clock),
        Err(BusError::Open { .. })
    ));
}
