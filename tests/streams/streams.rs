//! Streams of a running rig: recorded, measured, printed, exported, against a sender that drops by plan.

#[path = "../support/mod.rs"]
mod support;

use std::path::Path;
use std::process::Command;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use maulstick_bus::{Bus, Qos, ZenohBus};
use maulstick_types::control::ControlSample;
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Flags, Origin, encode};
use nix::sys::signal::Signal;
use serde_json::Value;
use support::{Launcher, MAULSTICK, PATIENCE, Place, fault, has, join, printed, python, wait_for};

/// Of ten numbers the sender leaves out one.
const EACH: u64 = 10;

/// Sends samples of a free hand, numbered, without each tenth, until it is told to end; how many it sent.
fn send(bus: &ZenohBus, topics: &Topics, is_over: &AtomicBool) -> u64 {
    let origin = Origin {
        source: 9,
        epoch: 9,
    };
    let publisher = bus
        .publisher(&topics.control("puck"), Qos::RealTime)
        .expect("declared");
    let mut sent = 0;
    for number in 0.. {
        if is_over.load(Ordering::Relaxed) {
            break;
        }
        if number % EACH == EACH - 1 {
            continue;
        }
        let now_ns = bus.now_ns();
        let sample = ControlSample {
            push: [number as f64 * 1e-6, 0.0, 0.0],
            turn: [0.0; 3],
            switches: 0,
        };
        let bytes = encode(&origin, Flags::NONE, number, now_ns, now_ns, &sample).expect("encoded");
        publisher.put(bytes).expect("sent");
        sent += 1;
        wait_for(Duration::from_millis(2), || None::<()>);
    }
    sent
}

/// Tells the sender to end, also where a test fails.
struct End<'a>(&'a AtomicBool);

impl Drop for End<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// A rig with a sender, while something is done.
fn beside_a_sender(work: impl FnOnce(&Place)) -> u64 {
    let place = Place::new();
    let mut launcher = Launcher::up(&place, &[]);
    launcher.wait_says("is up");
    let (bus, topics) = join(&place);
    let is_over = AtomicBool::new(false);
    let sent = std::thread::scope(|scope| {
        let sender = scope.spawn(|| send(&bus, &topics, &is_over));
        let end = End(&is_over);
        work(&place);
        drop(end);
        sender.join().expect("sent")
    });
    bus.close();
    launcher.close(&place);
    sent
}

/// The stream of the sender in what a command prints in JSON.
fn stream(said: &Value) -> Value {
    let streams = said["streams"].as_array().expect("streams").clone();
    let of_sender = |stream: &Value| stream["topic"] == "control/puck/sample";
    streams.into_iter().find(of_sender).expect("the sender's")
}

/// Messages and losses of a stream: nine and one of each ten numbers, but for where it begins and ends.
fn check_losses(stream: &Value) -> (u64, u64) {
    let count = |name: &str| stream[name].as_u64().expect("a number");
    let (heard, lost) = (count("messages"), count("lost"));
    assert!(heard > 50, "{stream}");
    assert!(
        (lost * (EACH - 1)).abs_diff(heard) <= EACH,
        "{heard} heard, {lost} lost"
    );
    (heard, lost)
}

/// Without files for its sockets a command says so, and panics nowhere.
fn check_few_files(place: &Place) {
    for command in [
        &["topic", "hz", "--once"][..],
        &["recording", "record", "-o", "few.mcap"],
        &["snapshot", "-o", "few.png"],
    ] {
        let in_place = place.maulstick(&[]);
        let mut shell = Command::new("sh");
        let told = in_place.get_envs();
        shell
            .current_dir(place.path(""))
            .envs(told.filter_map(|(name, value)| Some((name, value?))))
            .args(["-c", "ulimit -n 32; exec \"$0\" \"$@\"", MAULSTICK])
            .args(command);
        let output = shell.output().expect("started");
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{command:?}: {said}");
        has(&said, &["error: ", "32 files", "ulimit -n"]);
        assert!(
            !said.contains("panicked") && !said.contains(".rs:"),
            "{said}"
        );
    }
}

/// Fields of the newest sample of the sender are those that it sent, in JSON and in columns.
fn check_echo(place: &Place) {
    let echo = ["topic", "echo", "control/*/sample", "--once"];
    let json = place.json(&[&echo[..], &["--json"]].concat());
    let number = json["seq"].as_f64().expect("a number");
    let push = json["value"]["push"][0].as_f64().expect("a push");
    assert!((push - number * 1e-6).abs() < 1e-12);
    let columns = ["--csv", "--field", "push.0", "--field", "switches"];
    let csv = place.text(&[&echo[..], &columns].concat());
    let rows: Vec<&str> = csv.lines().collect();
    assert_eq!(rows[0], "topic,arrived_ns,seq,event_ns,push.0,switches");
    assert!(rows[1].starts_with("control/puck/sample,") && rows[1].ends_with(",0"));
    let wrong = [&echo[..], &["--field", "pusch.0"]].concat();
    has(&fault(place, &wrong, 2), &["pusch.0", "push.0"]);
}

/// Lists of what is under way have the sender, the nodes and what was said before they came.
fn check_lists(place: &Place) {
    let once = ["--once", "--json", "--seconds"];
    let latency = place.json(&[&["topic", "latency"], &once[..], &["1.5"]].concat());
    let streams = latency["streams"].as_array().expect("streams");
    for topic in ["control/puck/sample", "paint/status"] {
        let is_timed =
            |stream: &Value| stream["topic"] == topic && stream["transit_ns"]["p50"].is_u64();
        assert!(streams.iter().any(is_timed), "{topic}: {latency}");
    }
    let nodes = place.json(&["node", "list", "--json"]);
    let nodes = nodes.as_array().expect("nodes").iter();
    let nodes: Vec<&str> = nodes.filter_map(|node| node["name"].as_str()).collect();
    assert!(
        ["brush-main", "paint"]
            .iter()
            .all(|name| nodes.contains(name)),
        "{nodes:?}"
    );
    let scene = place.json(&[&["topic", "list", "scene"], &once[..], &["0.5"]].concat());
    assert_eq!(scene["streams"][0]["topic"], "scene");
}

#[test]
fn what_a_sender_leaves_out_is_counted_exactly_and_its_contents_are_shown() {
    beside_a_sender(|place| {
        check_few_files(place);
        let rates = ["topic", "hz", "control/**", "--seconds", "1", "--json"];
        check_losses(&stream(&place.json(&rates)));
        check_echo(place);
        check_lists(place);
        has(
            &fault(place, &["topic", "hz", "a//b", "--once"], 2),
            &["malformed", "**"],
        );
        has(
            &fault(place, &["topic", "hz", "--seconds", "0"], 2),
            &[".1 to 3600"],
        );
    });
}

#[test]
fn a_graph_shows_who_sends_what_to_whom() {
    beside_a_sender(|place| {
        let said = place.json(&["topic", "graph", "--json"]);
        let processes = said["processes"].as_array().expect("processes");
        let names: Vec<&str> = processes
            .iter()
            .filter_map(|process| process["name"].as_str())
            .collect();
        assert_eq!(names, ["test", "brush-main", "paint", "launcher"]);
        assert_eq!(processes[0]["sends"][0]["topic"], "control/puck/sample");
        let rate = processes[0]["sends"][0]["rate_hz"].as_f64();
        assert!(rate.is_some_and(|rate| rate > 50.0), "{rate:?}");
        let arrows = said["arrows"].as_array().expect("arrows");
        let is_there = |from: &str, topic: &str, to: &str| {
            arrows
                .iter()
                .any(|arrow| arrow["from"] == from && arrow["topic"] == topic && arrow["to"] == to)
        };
        for [from, topic, to] in [
            ["brush-main", "brush/main/state", "paint"],
            ["paint", "paint/consumed", "brush-main"],
            ["paint", "scene", "brush-main"],
            ["paint", "paint/status", "launcher"],
        ] {
            assert!(is_there(from, topic, to), "{from} {topic} {to}: {said}");
        }
        assert!(!is_there("paint", "paint/consumed", "launcher"));
        has(
            &place.text(&["topic", "graph"]),
            &["flowchart LR", "[\"test\"]", "brush/main/state", "scene"],
        );
        place.done(&["topic", "graph", "-o", "rig.svg"]);
        assert!(place.bytes("rig.svg").starts_with(b"<svg"));
        place.done(&["topic", "graph", "-o", "rig.mmd"]);
        assert!(place.bytes("rig.mmd").starts_with(b"flowchart LR"));
        place.write("rig.svg", "my diary");
        fault(place, &["topic", "graph", "-o", "rig.svg"], 1);
    });
}

/// A recording has the sender's stream, all that is kept, and the rig's settings; the sender's messages in it.
fn check_recording(place: &Place, name: &str) -> u64 {
    let info = place.json(&["recording", "info", name, "--json"]);
    let (messages, _) = check_losses(&stream(&info));
    assert_eq!(info["damage"], Value::Null);
    assert_eq!(info["files"][0], "rig.toml");
    assert_eq!(info["notes"]["counts"]["dropped"], "0");
    let streams = info["streams"].as_array().expect("streams").iter();
    let topics: Vec<&str> = streams
        .filter_map(|stream| stream["topic"].as_str())
        .collect();
    for topic in ["scene", "brush/main/def", "paint/status"] {
        assert!(topics.contains(&topic), "{topic} is missing in {topics:?}");
    }
    messages
}

/// A table has a row for each of the sender's messages, without those that it left out.
fn check_table(table: &str, messages: u64) {
    assert_eq!(table.lines().count() as u64, messages + 1);
    let rows = table.lines().skip(1);
    let numbers: Vec<u64> = rows
        .filter_map(|row| row.split(',').nth(2)?.parse().ok())
        .collect();
    assert!(numbers.is_sorted() && numbers.iter().all(|number| number % EACH != EACH - 1));
}

#[test]
fn a_recording_holds_what_was_sent_and_is_exported() {
    let mut recorded = 0;
    let sent = beside_a_sender(|place| {
        place.done(&["recording", "record", "-o", "s.mcap", "--seconds", "1.5"]);
        recorded = check_recording(place, "s.mcap");
        let export = ["recording", "export", "s.mcap", "--topic", "control/**"];
        let export = [&export[..], &["-o", "s.csv"]].concat();
        place.done(&[&export[..], &["--field", "push.0"]].concat());
        let table = String::from_utf8(place.bytes("s.csv")).expect("text");
        check_table(&table, recorded);
        // Over itself it may be written again, over another file not.
        place.done(&[&export[..], &["--format", "json"]].concat());
        place.write("s.csv", "my diary");
        fault(place, &export, 1);
        let misspelt = ["recording", "export", "s.mcap", "-o", "x.csv"];
        let misspelt = [&misspelt[..], &["--topic", "contrl/puck/sample"]].concat();
        has(&fault(place, &misspelt, 2), &["control/puck/sample"]);
        has(
            &fault(place, &["recording", "info", "s.csv"], 2),
            &["an MCAP"],
        );
        let over = ["recording", "record", "-o", "s.csv", "--seconds", "1"];
        fault(place, &over, 2);
    });
    assert!(recorded <= sent);
}

#[test]
fn further_files_stand_over_none_and_each_has_what_is_sent_rarely() {
    beside_a_sender(|place| {
        let path = place.path("s.mcap");
        place.write("s-2.mcap", "my diary");
        let path = path.to_str().expect("text");
        place.done(&[
            "recording",
            "record",
            "-o",
            path,
            "--seconds",
            "2.2",
            "--split-seconds",
            "0.9",
        ]);
        let diary = std::fs::read_to_string(place.path("s-2.mcap")).expect("read");
        assert_eq!(diary, "my diary");
        for name in ["s.mcap", "s-3.mcap"] {
            let said = place.json(&["recording", "info", name, "--json"]);
            let streams = said["streams"].as_array().expect("streams");
            let mut topics = streams.iter().map(|stream| &stream["topic"]);
            assert!(topics.any(|topic| topic == "scene"), "{name}: {said}");
            let seconds = said["seconds"].as_f64().expect("a number");
            assert!(seconds > 0.0, "{name}: {seconds} s");
        }
    });
}

#[test]
fn a_killed_recorder_leaves_what_it_had_written_and_a_rig_that_ends_ends_it() {
    beside_a_sender(|place| {
        let path = place.path("s.mcap");
        let path = path.to_str().expect("text");
        let mut recorder = Launcher::start(place.maulstick(&["recording", "record", "-o", path]));
        let grown = wait_for(PATIENCE, || {
            let info = place.run(&["recording", "info", path, "--json"]).stdout;
            let said: Value = serde_json::from_slice(&info).ok()?;
            let streams = said["streams"].as_array()?;
            let mut messages = streams
                .iter()
                .filter_map(|stream| stream["messages"].as_u64());
            messages.any(|messages| messages > 200).then_some(())
        });
        assert!(grown.is_some(), "{}", recorder.said());
        recorder.signal(Signal::SIGKILL);
        recorder.wait(PATIENCE);
        let said = place.json(&["recording", "info", path, "--json"]);
        check_losses(&stream(&said));
        assert!(said["damage"].is_string(), "{said}");
    });
    let place = Place::new();
    let mut launcher = Launcher::up(&place, &[]);
    launcher.wait_says("is up");
    let path = place.path("s.mcap");
    let mut recorder = Launcher::start(place.maulstick(&[
        "recording",
        "record",
        "-o",
        path.to_str().expect("text"),
    ]));
    let begun = wait_for(PATIENCE, || {
        path.metadata()
            .is_ok_and(|file| file.len() > 0)
            .then_some(())
    });
    assert!(begun.is_some(), "{}", recorder.said());
    launcher.close(&place);
    assert!(recorder.wait(PATIENCE).success(), "{}", recorder.said());
    let whole = place.json(&["recording", "info", "s.mcap", "--json"]);
    assert_eq!(whole["damage"], Value::Null);
    has(
        &fault(&place, &["recording", "record", "-o", "x.mcap"], 1),
        &["is running"],
    );
}

#[test]
fn python_reads_and_writes_every_golden_message() {
    let place = Place::new();
    let golden = Path::new(env!("CARGO_MANIFEST_DIR")).join("../msgs/types/tests/golden.txt");
    let messages = std::fs::read_to_string(&golden)
        .expect("read")
        .lines()
        .count();
    let schema = place.done(&["schema", "--json"]).stdout;
    let golden = golden.to_str().expect("text");
    let read = printed(&mut python(&place, "golden.py", &[golden]), &schema);
    assert_eq!(read, messages.to_string());
    assert_eq!(
        printed(&mut python(&place, "fields.py", &[]), &schema),
        "ok"
    );
}

#[test]
fn python_sends_into_a_rig_hears_it_and_reads_a_recording() {
    let place = Place::new();
    let mut launcher = Launcher::up(&place, &[]);
    launcher.wait_says("is up");
    let path = place.path("s.mcap");
    let path = path.to_str().expect("text");
    let mut recorder = Launcher::start(place.maulstick(&[
        "recording",
        "record",
        "-o",
        path,
        "--topic",
        "control/**",
    ]));
    let begun = wait_for(PATIENCE, || {
        std::fs::metadata(path)
            .is_ok_and(|file| file.len() > 0)
            .then_some(())
    });
    assert!(begun.is_some(), "{}", recorder.said());
    let heard = printed(
        &mut python(&place, "echo.py", &[support::MAULSTICK, "200"]),
        b"",
    );
    assert_eq!(heard, "200");
    launcher.close(&place);
    recorder.wait(PATIENCE);
    let read = printed(
        &mut python(&place, "read_recording.py", &[path, "control/*/sample"]),
        b"",
    );
    let read: usize = read.parse().expect("a number");
    assert!((200..=400).contains(&read), "{read}");
}
