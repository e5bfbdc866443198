//! Recorder and player with a program in the place of `maulstick`, and their controls without one.

use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;
use std::time::{Duration, Instant};

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use maulstick_ui_kit::notifications::Severity;

use super::*;
use crate::sessions::player::{Position, ReplayProgress};
use crate::sessions::recorder::{RecordingProgress, place};
use crate::sessions::transport_bar::TransportBar;
use crate::test_support::{context_bench, overlay_bench, panel_bench};
use overlay_bench::{Bench, ctrl, press, until, window};

/// A program that records until it is interrupted, and notes the orders that it gets while it plays.
const PROGRAM: &str = r#"#!/bin/sh
for file; do :; done
case "$2 $file" in
*full*) printf 'error: no room\n  --> /x\n help: free some space\n' >&2; exit 1;;
*bare*) echo '{"recording": "/x"}'; echo '{"lacks_painting": "it is in no file"}'
 echo '{"recording": "/x-2", "broke_off": true}';;
record*) trap 'exit 0' INT; : > "$file"
 while :; do sleep 0.01; done;;
replay*) echo "$*" > "$file.args"
 echo '{"painting": "/p/sea-replay.maul"}'
 echo '{"position_s": 1.5, "length_s": 60.0, "rate": "1", "paused": false}'
 while read -r line; do
    echo "$line" >> "$file.orders"
    case "$line" in
    pause) echo '{"position_s": 2.0, "length_s": 60.0, "rate": "1", "paused": true}';;
    end) exit 0;;
    esac
 done;;
esac
"#;

/// A recording in progress.
pub(crate) fn recording() -> RecordingProgress {
    RecordingProgress {
        file: "/p/Sea 2026-11-26 14.03.mcap".into(),
        begun_ns: 0,
    }
}

/// A session that is painted again.
pub(crate) fn replay(paused: bool) -> ReplayProgress {
    ReplayProgress {
        position: Some(Position {
            position_s: 42.0,
            length_s: 190.0,
            rate: "1".to_owned(),
            paused,
        }),
        painting: Some("/p/sea-replay.maul".into()),
        ..ReplayProgress::new(Path::new("/p/sea.mcap"))
    }
}

struct Desk {
    processes: SessionProcesses,
    rig: RigState,
    told: Vec<(Severity, String)>,
    folder: tempfile::TempDir,
}

impl Desk {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let program = folder.path().join("program");
        std::fs::write(&program, PROGRAM).expect("written");
        let all = std::fs::Permissions::from_mode(0o755);
        std::fs::set_permissions(&program, all).expect("set");
        Self {
            processes: SessionProcesses::new(program),
            rig: panel_bench::rig(),
            told: Vec::new(),
            folder,
        }
    }

    fn painting(&mut self, name: &str) {
        let path = self.folder.path().join(name).display().to_string();
        self.rig.live.paint.as_mut().expect("a node").status.path = path;
    }

    fn turn(&mut self, orders: Vec<SessionOrder>) {
        let mut notifications = Notifications::default();
        let told = (&mut self.rig, &mut notifications);
        self.processes.poll(&Context::default(), orders, told);
        let told = notifications.shown().iter();
        self.told
            .extend(told.map(|toast| (toast.severity, toast.what.clone())));
    }

    fn until(&mut self, is_so: impl Fn(&Self) -> bool) {
        let give_up = Instant::now() + Duration::from_secs(30);
        while !is_so(self) {
            assert!(Instant::now() < give_up, "{:?}", self.told);
            self.turn(Vec::new());
            std::thread::yield_now();
        }
    }
}

#[test]
fn a_recording_stands_beside_the_painting_until_it_is_ended_and_its_file_is_told() {
    let mut desk = Desk::new();
    desk.painting("Sea.maul");
    desk.rig.live.now_ns = 7;
    desk.turn(vec![SessionOrder::Record, SessionOrder::Record]);
    let recording = desk.rig.recording.clone().expect("it records");
    assert_eq!(recording.begun_ns, 7);
    let name = recording.file.file_name().expect("a name");
    let name = name.to_string_lossy();
    assert!(
        name.starts_with("Sea 20") && name.ends_with(".mcap"),
        "{name}"
    );
    assert_eq!(recording.file.parent(), Some(desk.folder.path()));
    desk.until(|_| recording.file.exists());
    desk.turn(vec![SessionOrder::StopRecording]);
    desk.until(|desk| desk.rig.recording.is_none());
    let [(Severity::Note, told)] = &desk.told[..] else {
        panic!("{:?}", desk.told);
    };
    assert!(told.contains(&*name), "{told}");
}

#[test]
fn what_a_recording_lacks_and_why_one_fails_is_told() {
    let mut desk = Desk::new();
    desk.painting("bare.maul");
    desk.turn(vec![SessionOrder::Record]);
    desk.until(|desk| desk.rig.recording.is_none());
    let (weight, told) = desk.told.first().expect("told");
    assert!(
        *weight == Severity::Fault && told.contains("it is in no file"),
        "{told}"
    );
    let goes_on = |(_, told): &(Severity, String)| told.contains("x-2");
    assert!(desk.told.iter().any(goes_on), "{:?}", desk.told);
    let mut desk = Desk::new();
    desk.processes = SessionProcesses::new("/none/maulstick".into());
    desk.turn(vec![SessionOrder::Record]);
    let (_, told) = desk.told.first().expect("told");
    assert!(told.contains("cannot be started"), "{told}");
    assert_eq!(desk.rig.recording, None);
    let mut desk = Desk::new();
    desk.painting("full.maul");
    desk.turn(vec![SessionOrder::Record]);
    desk.until(|desk| desk.rig.recording.is_none());
    assert_eq!(desk.told, [(Severity::Fault, "no room".to_owned())]);
}

#[test]
fn no_recording_takes_the_place_of_another_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let painting = folder.path().join("Sea.maul");
    let first = place(&painting, "now");
    assert_eq!(first, folder.path().join("Sea now.mcap"));
    std::fs::write(&first, "").expect("written");
    assert_eq!(
        place(&painting, "now"),
        folder.path().join("Sea now 2.mcap")
    );
    let elsewhere = place(Path::new(""), "now");
    assert!(elsewhere.is_absolute(), "{elsewhere:?}");
}

#[test]
fn a_motion_is_played_at_its_place_under_a_name_of_its_own() {
    let mut desk = Desk::new();
    let take = desk.folder.path().join("sweep.mcap");
    let arguments = desk.folder.path().join("sweep.mcap.args");
    desk.turn(vec![SessionOrder::PutDown {
        take,
        at_mm: [-12.5, 30.0],
        scale: 2.0,
        turn_deg: -15.0,
    }]);
    desk.until(|desk| {
        desk.rig
            .replay
            .as_ref()
            .is_some_and(|replay| replay.position.is_some())
    });
    let told = std::fs::read_to_string(arguments).expect("noted");
    for part in [
        "--as motion",
        "--at -12.5",
        "30.0000",
        "--scale 2.0",
        "--turn -15.0",
    ] {
        assert!(told.contains(part), "{told}");
    }
    desk.turn(vec![SessionOrder::Transport(TransportOrder::End)]);
    desk.until(|desk| desk.rig.replay.is_none());
}

#[test]
fn orders_are_lines_to_the_player_whose_lines_say_where_it_is() {
    let mut desk = Desk::new();
    let recording = desk.folder.path().join("s.mcap");
    let forget = true;
    desk.turn(vec![SessionOrder::Play {
        recording: recording.clone(),
        forget,
    }]);
    let position = |desk: &Desk| {
        let replay = desk.rig.replay.as_ref();
        replay.and_then(|replay| replay.position.clone())
    };
    desk.until(|desk| position(desk).is_some());
    let orders = [
        TransportOrder::Seek(12.5),
        TransportOrder::Skip(-5.0),
        TransportOrder::Step,
        TransportOrder::Rate("max".to_owned()),
    ];
    desk.turn(orders.map(SessionOrder::Transport).to_vec());
    let at = position(&desk).expect("a position");
    assert_eq!((at.position_s, at.length_s), (12.5, 60.0));
    desk.turn(vec![SessionOrder::Transport(TransportOrder::Pause)]);
    desk.until(|desk| position(desk).is_some_and(|at| at.paused && at.position_s == 2.0));
    desk.turn(vec![SessionOrder::Transport(TransportOrder::End)]);
    desk.until(|desk| desk.rig.replay.is_none());
    let told = "The recording is painted in /p/sea-replay.maul.";
    assert_eq!(desk.told, [(Severity::Note, told.to_owned())]);
    let read = |ending: &str| {
        let path = recording.with_extension(ending);
        std::fs::read_to_string(path).expect("noted")
    };
    let orders = read("mcap.orders");
    assert_eq!(orders, "seek 12.500\nskip -5\nstep\nrate max\npause\nend\n");
    let args = format!(
        "recording replay --name default --json --forget {}\n",
        recording.display()
    );
    assert_eq!(read("mcap.args"), args);
}

#[test]
fn a_recording_that_cannot_be_played_is_told_and_the_bar_goes() {
    let mut desk = Desk::new();
    let recording = desk.folder.path().join("full.mcap");
    let forget = false;
    desk.turn(vec![SessionOrder::Play { recording, forget }]);
    desk.until(|desk| !desk.told.is_empty() && desk.rig.replay.is_none());
    assert_eq!(desk.told, [(Severity::Fault, "no room".to_owned())]);
}

fn orders(harness: &mut Harness<'static, Bench>) -> Vec<SessionOrder> {
    harness.run_steps(2);
    harness.state_mut().requests.take_session_orders()
}

fn transport(order: TransportOrder) -> [SessionOrder; 1] {
    [SessionOrder::Transport(order)]
}

#[test]
fn a_key_records_and_the_same_key_the_menu_and_the_dot_end_that() {
    let mut harness = window(None);
    ctrl(&mut harness, Key::R, Modifiers::SHIFT);
    assert_eq!(orders(&mut harness), [SessionOrder::Record]);
    assert!(harness.query_by_label("Stop recording").is_none());
    harness.state_mut().rig.recording = Some(recording());
    ctrl(&mut harness, Key::R, Modifiers::SHIFT);
    assert_eq!(orders(&mut harness), [SessionOrder::StopRecording]);
    harness.get_by_label("Stop recording").click();
    assert_eq!(orders(&mut harness), [SessionOrder::StopRecording]);
}

#[test]
fn a_recording_is_chosen_and_played_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let recording = folder.path().join("sea.mcap");
    std::fs::write(&recording, "").expect("written");
    let mut harness = window(Some(folder.path()));
    ctrl(&mut harness, Key::P, Modifiers::NONE);
    until(&mut harness, |harness| {
        harness.query_by_label("sea.mcap").is_some()
    });
    press(&mut harness, Key::ArrowDown);
    press(&mut harness, Key::Enter);
    let forget = false;
    let play = SessionOrder::Play { recording, forget };
    assert_eq!(orders(&mut harness), [play]);
    assert!(harness.query_by_label("sea.mcap").is_none());
    harness.state_mut().rig.replay = Some(replay(false));
    ctrl(&mut harness, Key::P, Modifiers::NONE);
    assert!(harness.state().told().contains("is being played"));
}

#[test]
fn each_control_of_the_bar_gives_its_order() {
    let mut harness = window(None);
    assert!(harness.query_by_label("Pause").is_none());
    harness.state_mut().rig.replay = Some(replay(false));
    harness.run_steps(2);
    for (label, order) in [
        ("Back 5 s", TransportOrder::Skip(-5.0)),
        ("Pause", TransportOrder::Pause),
        ("On by one event", TransportOrder::Step),
        ("Forth 5 s", TransportOrder::Skip(5.0)),
        ("End the replay", TransportOrder::End),
    ] {
        harness.get_by_label(label).click();
        assert_eq!(orders(&mut harness), transport(order), "{label}");
    }
    harness.get_by_label("0:42 of 3:10");
    harness.get_by_label("Rate of the replay").click();
    harness.run_steps(3);
    harness.get_by_label("× 4").click();
    let rate = TransportOrder::Rate("4".to_owned());
    assert_eq!(orders(&mut harness), transport(rate));
    harness.state_mut().rig.replay = Some(replay(true));
    harness.run_steps(2);
    harness.get_by_label("Play on").click();
    assert_eq!(orders(&mut harness), transport(TransportOrder::Pause));
}

#[test]
fn the_slider_seeks_where_it_is_let_go() {
    let mut harness = window(None);
    harness.state_mut().rig.replay = Some(replay(false));
    harness.run_steps(2);
    let slider = harness
        .get_by_role_and_label(Role::Slider, "Place in the recording")
        .rect();
    let at = |share: f32| slider.left_center() + vec2(share * slider.width(), 0.0);
    harness.hover_at(at(0.22));
    harness.drag_at(at(0.22));
    harness.run_steps(2);
    harness.hover_at(at(0.5));
    assert_eq!(orders(&mut harness), [], "it is still dragged");
    harness.drop_at(at(0.5));
    let [SessionOrder::Transport(TransportOrder::Seek(seconds))] = orders(&mut harness)[..] else {
        panic!("no seek");
    };
    assert!((85.0..105.0).contains(&seconds), "{seconds}");
    harness
        .get_by_role_and_label(Role::Slider, "Place in the recording")
        .focus();
    press(&mut harness, Key::ArrowRight);
    let by_key = orders(&mut harness);
    let [SessionOrder::Transport(TransportOrder::Seek(seconds))] = by_key[..] else {
        panic!("{by_key:?}");
    };
    assert!(seconds > 42.0, "{seconds}");
}

#[test]
fn keys_are_the_bars_while_a_session_is_painted_again_and_else_where_they_are_free() {
    let mut harness = window(None);
    let both = [
        (Key::ArrowLeft, TransportOrder::Skip(-5.0)),
        (Key::ArrowRight, TransportOrder::Skip(5.0)),
    ];
    let of_session = [
        (Key::Space, TransportOrder::Pause),
        (Key::Period, TransportOrder::Step),
    ];
    harness.state_mut().rig.replay = Some(replay(false));
    for (key, order) in both.clone().into_iter().chain(of_session) {
        press(&mut harness, key);
        assert_eq!(orders(&mut harness), transport(order), "{key:?}");
    }
    let streams = ReplayProgress {
        painting: None,
        ..replay(false)
    };
    harness.state_mut().rig.replay = Some(streams);
    for (key, order) in both {
        press(&mut harness, key);
        assert_eq!(orders(&mut harness), transport(order), "{key:?}");
    }
    press(&mut harness, Key::Period);
    assert_eq!(orders(&mut harness), []);
    assert!(harness.state().told().contains("Brush turned"));
    harness.state_mut().rig.replay = None;
    press(&mut harness, Key::ArrowLeft);
    assert_eq!(orders(&mut harness), []);
}

#[test]
fn times_are_shown_as_clocks_show_them() {
    for (seconds, words) in [
        (-1.0, "0:00"),
        (9.9, "0:09"),
        (190.0, "3:10"),
        (3725.0, "1:02:05"),
    ] {
        assert_eq!(clock(seconds), words);
    }
}

#[test]
fn the_bar_looks_as_in_its_picture() {
    let state = || {
        let mut bench = context_bench::Bench::new();
        bench.rig.replay = Some(replay(false));
        bench.preferences.window.panels = false;
        (TransportBar::default(), bench)
    };
    overlay_bench::picture(
        "transport",
        [720.0, 110.0],
        state,
        |ui, (bar, bench)| bar.show(ui.ctx(), &mut bench.work()),
        |_| {},
        |(_, bench)| {
            let mut later = replay(true);
            let position = later.position.as_mut().expect("a position");
            position.position_s = 130.0;
            bench.rig.replay = Some(later);
        },
    );
}
