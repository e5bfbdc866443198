//! What others do to a rig: a device in another language, and messages that are none.

mod support;

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus, Class, Queue, Wake};
use maulstick_types::command::{Command as Order, CommandRequest};
use maulstick_types::paint::PaintStatus;
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample};
use maulstick_types::{Flags, Origin, encode};
use support::{Launcher, PATIENCE, Place, join, on_canvas, wait_for};

/// A pen that presses at `x`.
fn pressing(x: f64) -> StylusSample {
    StylusSample {
        pose: StylusPose::Contact {
            point_m: [x, 0.0, 0.0],
            tilt_rad: DEFAULT_TILT_RAD,
            twist_rad: 0.0,
            pressure: 0.5,
        },
        in_range: true,
        ..StylusSample::away()
    }
}

#[test]
fn a_sample_beyond_the_world_holds_nothing_up() {
    let place = Place::new();
    let mut launcher = Launcher::start(place.maulstick(&["up", "--headless"]));
    launcher.wait_says("is up");
    place.done(&["load", "Bone Black"]);
    let (bus, topics) = join(&place);
    let origin = Origin {
        source: 9,
        epoch: 9,
    };
    let topic = topics.sample("evil");
    let publisher = bus.publisher(&topic, Class::RealTime).expect("declared");
    let mut number = 0;
    let mut send = |sample: StylusSample| {
        let now_ns = bus.now_ns();
        let bytes = encode(&origin, Flags::NONE, number, now_ns, now_ns, &sample).expect("encoded");
        number += 1;
        publisher.put(bytes).expect("sent");
    };
    // In contact, and within .1 s at the end of the world: followed cell by cell it would never end.
    let mut painted = 0.0;
    let patience = std::time::Instant::now() + PATIENCE;
    while painted <= 0.0 && std::time::Instant::now() < patience {
        for step in 0..20 {
            send(pressing(1e-3 * f64::from(step)));
            send(pressing(1e30));
            wait_for(Duration::from_millis(4), || None::<()>);
        }
        painted = on_canvas(&place);
    }
    assert!(painted > 0.0, "nothing is painted: {}", launcher.said());
    bus.close();
}

#[test]
fn a_device_in_python_paints() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let python = root.join("target/test-venv/bin/python");
    assert!(
        python.exists(),
        "run ./test: it installs eclipse-zenoh for Python"
    );
    let place = Place::new();
    let launcher = Launcher::up(&place, &[]);
    let endpoint = place.done(&["endpoint", "--json"]);
    let mut stylus = Command::new(python)
        .arg(root.join("tests/python/stylus.py"))
        .stdin(Stdio::piped())
        .spawn()
        .expect("started");
    let mut stdin = stylus.stdin.take().expect("piped");
    std::io::Write::write_all(&mut stdin, &endpoint.stdout).expect("written");
    drop(stdin);
    assert!(stylus.wait().expect("ended").success());
    let painted = wait_for(PATIENCE, || (on_canvas(&place) > 0.0).then_some(()));
    assert!(painted.is_some(), "{}", launcher.said());
}

#[test]
fn hostile_messages_are_counted_and_dropped() {
    let place = Place::new();
    let launcher = Launcher::up(&place, &[]);
    let before = place.processes();
    let (bus, topics) = join(&place);
    let wake = Wake::new();
    let (topic, class) = (topics.paint_status(), Class::Background);
    let mut status = Receiver::<PaintStatus>::new(&bus, &topic, class, Queue::Latest, &wake)
        .expect("subscribed");
    let origin = Origin {
        source: 9,
        epoch: 9,
    };
    let mark = CommandRequest {
        client: 1,
        number: 1,
        after: None,
        command: Order::Mark,
    };
    let good = encode(&origin, Flags::NONE, 0, 1, 1, &mark).expect("encoded");
    let mut hostile = vec![Vec::new(), vec![0; 7], vec![0xff; 5000]];
    // An unknown schema, a wrong length, a hostile length inside the body, a cut, a surplus.
    for (at, byte) in [(4, 0x55), (20, 0x01), (48 + 16 + 1, 0xff)] {
        let mut bytes = good.clone();
        bytes[at] ^= byte;
        hostile.push(bytes);
    }
    hostile.push(good[..good.len() - 1].to_vec());
    hostile.push([&good[..], &[0]].concat());
    let targets = [
        topics.sample("evil"),
        topics.brush_state("main"),
        topics.contact_model("phantom"),
        topics.scene(),
        topics.paint_consumed(),
        topics.brush_consumed("main"),
        topics.brush_def("x"),
    ];
    let told = wait_for(PATIENCE, || {
        for target in &targets {
            let publisher = bus.publisher(target, Class::Data).expect("declared");
            hostile
                .iter()
                .for_each(|bytes| publisher.put(bytes.clone()).expect("sent"));
        }
        for topic in [
            topics.command("paint"),
            topics.frame(),
            topics.gap("brush/main/state"),
        ] {
            for bytes in &hostile {
                let limit = Duration::from_millis(50);
                drop(
                    bus.ask(&topic, Class::Control, bytes.clone(), limit, &wake)
                        .expect("asked"),
                );
            }
        }
        status.newest().filter(|status| status.message.refused > 10)
    });
    assert!(told.is_some(), "nothing was counted: {}", launcher.said());
    assert_eq!(
        place.processes(),
        before,
        "a node fell: {}",
        launcher.said()
    );
    place.done(&["load", "Bone Black"]);
    assert_eq!(on_canvas(&place), 0.0);
    let said = launcher.said();
    assert!(said.contains("schema") && said.contains("is not"), "{said}");
    assert!(
        said.matches("is not").count() < 20,
        "it says it once: {said}"
    );
    bus.close();
}
