//! The bus between processes, here between sessions of one process over the rig's sockets.

use std::time::{Duration, Instant};

use zenoh::Wait as _;
use zenoh::qos::Priority;

use maulstick_bus::bus::Answer;
use maulstick_bus::sockets::{SocketKeeper, SocketNews};
use maulstick_bus::{
    Bus, BusError, Dial, Payload, Qos, Queue, RigClock, RigFolder, Server, Wake, ZenohBus,
};

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
    let publisher = one.publisher("t/a", Qos::RealTime).expect("declared");
    for (who, bus) in [
        ("a node", &two),
        ("a client", &client),
        ("the hub", &rig.hub),
    ] {
        let subscription = bus
            .subscribe("t/*", Qos::RealTime, Queue::Ring(8), &wake)
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

/// As where a temporary folder is cleaned, and then a node dies and is started again.
#[test]
fn who_starts_after_all_sockets_were_removed_finds_the_others() {
    let rig = rig();
    let mut keeper = SocketKeeper::new(rig.folder.path());
    let nodes = ["brush", "paint"];
    let brush = rig.node("brush");
    keeper.look().expect("looked");
    for name in ["hub", "brush"] {
        let socket = rig.folder.path().join(format!("{name}.sock"));
        std::fs::remove_file(socket).expect("removed");
    }
    let news = keeper.look().expect("looked");
    assert_eq!(news.restored, ["brush", "hub"]);
    let paint = rig.node("paint");
    let wake = Wake::new();
    for (from, to) in [(&brush, &paint), (&paint, &brush)] {
        let publisher = from.publisher("t/a", Qos::RealTime).expect("declared");
        let queue = Queue::Ring(8);
        let heard = to.subscribe("t/a", Qos::RealTime, queue, &wake);
        let heard = heard.expect("subscribed");
        until(&wake, || {
            publisher.put(vec![1]).expect("sent");
            heard.try_recv()
        });
    }
    // Those that leave take their sockets along.
    brush.close();
    paint.close();
    assert_eq!(keeper.look().expect("looked"), SocketNews::default());
    for name in nodes {
        let socket = rig.folder.path().join(format!("{name}.sock"));
        assert!(!socket.exists(), "{name}");
    }
}

#[test]
fn a_late_joiner_gets_the_last_cached_value() {
    let rig = rig();
    let one = rig.node("one");
    let wake = Wake::new();
    let publisher = one.publisher("t/scene", Qos::Cached).expect("declared");
    publisher.put(vec![1]).expect("sent");
    publisher.put(vec![2]).expect("sent");
    let two = rig.node("two");
    let late = two
        .subscribe("t/*", Qos::Cached, Queue::Ring(8), &wake)
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
            .ask("t/q", Qos::Control, vec![7], limit, &wake)
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
        .ask("t/nobody", Qos::Control, vec![], limit, &wake)
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
        ("t/frame", Qos::Data, Priority::Data),
        ("t/command", Qos::Control, Priority::InteractiveHigh),
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
            Answer::Bytes(bytes) => Some(bytes.to_vec()),
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

/// A node that shares memory.
fn sharing(rig: &Rig, name: &str) -> ZenohBus {
    let dial = Dial {
        name: name.into(),
        listen: Some(rig.folder.locator(name)),
        connect: vec![rig.folder.locator("hub")],
    };
    ZenohBus::open_sharing(&dial, rig.clock).expect(name)
}

/// Asks for `length` bytes of a value, until somebody answers.
fn asked(from: &ZenohBus, server: &Server, wake: &Wake, length: usize, value: u8) -> Payload {
    let (class, limit) = (Qos::Data, Duration::from_secs(5));
    let mut pending = None;
    let answer = until(wake, || {
        let question = pending.get_or_insert_with(|| {
            from.ask("t/large", class, vec![1], limit, wake)
                .expect("asked")
        });
        if let Some(request) = server.try_recv() {
            request
                .answer_shared(length, &mut |into| into.fill(value))
                .expect("answered");
        }
        match question.try_recv()? {
            Answer::Bytes(answer) => Some(answer),
            Answer::Ended => {
                pending = None;
                None
            }
        }
    });
    assert_eq!(answer.len(), length);
    assert!(answer.iter().all(|byte| *byte == value));
    answer
}

#[test]
fn large_answers_lie_in_shared_memory_where_both_can_have_it() {
    const LARGE: usize = 3 << 20;
    let rig = rig();
    let (one, two, apart) = (
        sharing(&rig, "one"),
        sharing(&rig, "two"),
        rig.node("apart"),
    );
    let wake = Wake::new();
    let server = one.serve("t/large", 16, &wake).expect("served");
    assert!(asked(&two, &server, &wake, LARGE, 1).is_shared());
    assert!(
        !asked(&two, &server, &wake, 1000, 2).is_shared(),
        "too small"
    );
    assert!(
        !asked(&apart, &server, &wake, LARGE, 3).is_shared(),
        "it shares nothing"
    );
    // What is read keeps its place; when there is none left, answers come through the socket.
    let kept: Vec<Payload> = (0..9)
        .map(|value| asked(&two, &server, &wake, LARGE, value))
        .collect();
    let shared = kept.iter().filter(|answer| answer.is_shared()).count();
    assert!((1..9).contains(&shared), "{shared} of 9");
    // A reader that never lets go, as one that was killed, does not have the pool for ever.
    until(&wake, || {
        let answer = asked(&two, &server, &wake, LARGE, 77);
        answer.is_shared().then_some(())
    });
    for (value, answer) in (0..).zip(&kept) {
        assert!(answer.iter().all(|byte| *byte == value), "overwritten");
    }
    drop(kept);
    assert!(asked(&two, &server, &wake, LARGE, 4).is_shared());
}

/// A foreign peer that listens at `listen`, dials nobody but the hub, and is told of to all by gossip.
fn foreign(rig: &Rig, id: &str, listen: &str) -> zenoh::Session {
    let mut config = zenoh::Config::default();
    let hub = rig.folder.locator("hub");
    for (key, value) in [
        ("mode", "\"peer\"".to_owned()),
        // Of two peers that of the greater id dials.
        ("id", format!("\"{id}\"")),
        ("listen/endpoints", format!("[\"{listen}\"]")),
        ("connect/endpoints", format!("[\"{hub}\"]")),
        ("scouting/multicast/enabled", "false".to_owned()),
        ("scouting/gossip/autoconnect", "[]".to_owned()),
    ] {
        config.insert_json5(key, &value).expect(key);
    }
    zenoh::open(config).wait().expect("a foreign peer")
}

#[test]
fn only_unix_sockets_are_dialled_whatever_gossip_tells() {
    let rig = rig();
    let one = rig.node("one");
    let by_tcp = foreign(&rig, "1", "tcp/127.0.0.1:0");
    let by_socket = foreign(&rig, "2", &rig.folder.locator("foreign"));
    let wake = Wake::new();
    // Gossip tells of the one that came first no later than of the other.
    until(&wake, || {
        let mut peers = one.raw_session().info().peers_zid().wait();
        peers.find(|zid| *zid == by_socket.zid())
    });
    for bus in [&one, &rig.hub] {
        for link in bus.raw_session().info().links().wait() {
            let locator = link.dst().to_string();
            assert!(locator.starts_with("unixsock-stream/"), "{locator}");
        }
    }
    let mut peers = one.raw_session().info().peers_zid().wait();
    assert_eq!(peers.find(|zid| *zid == by_tcp.zid()), None);
}

#[test]
fn a_locator_that_is_asked_for_is_dialled_over_tcp_too() {
    let rig = rig();
    let mut dial = Dial {
        name: "remote".into(),
        listen: Some("tcp/127.0.0.1:47811".into()),
        connect: vec![rig.folder.locator("hub")],
    };
    let remote = ZenohBus::open(&dial, rig.clock).expect("a node that listens at TCP");
    dial = Dial {
        name: "client".into(),
        listen: None,
        connect: dial.listen.into_iter().collect(),
    };
    let client = ZenohBus::open(&dial, rig.clock).expect("a client over TCP");
    let wake = Wake::new();
    let heard = remote.subscribe("t/a", Qos::RealTime, Queue::Ring(8), &wake);
    let heard = heard.expect("subscribed");
    let publisher = client.publisher("t/a", Qos::RealTime).expect("declared");
    until(&wake, || {
        publisher.put(vec![1]).expect("sent");
        heard.try_recv()
    });
}
