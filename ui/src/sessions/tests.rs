//! Recorder and player where no rig runs, what they report, and their controls.

use std::path::Path;
use std::time::{Duration, Instant};

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use maulstick_device::player::Rate;
use maulstick_recorder::{
    Continuation, CopyTrouble, FileSummary, Position, RecorderEvent, ReplayReport,
};
use maulstick_ui_kit::notifications::Severity;

use overlay_bench::{Bench, ctrl, press, until, window};

use super::*;
use crate::sessions::progress::RecordingProgress;
use crate::sessions::progress::ReplayProgress;
use crate::sessions::recorder::{notify, place};
use crate::sessions::transport_bar::TransportBar;
use crate::test_support::{context_bench, overlay_bench, panel_bench};

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
            rate: Rate::Times(1.0),
            paused,
        }),
        painting: Some("/p/sea-replay.maul".into()),
        ..ReplayProgress::new(Path::new("/p/sea.mcap"))
    }
}

struct Desk {
    sessions: Sessions,
    rig: RigState,
    shown: Vec<(Severity, String)>,
    folder: tempfile::TempDir,
}

impl Desk {
    /// The window of a rig that does not run, with a painting of this name.
    fn new(painting: &str) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let mut rig = panel_bench::rig();
        rig.live.name = format!("none-{}", std::process::id());
        let path = folder.path().join(painting).display().to_string();
        rig.live.paint.as_mut().expect("a node").status.path = path;
        Self {
            sessions: Sessions::default(),
            rig,
            shown: Vec::new(),
            folder,
        }
    }

    fn poll(&mut self, orders: Vec<SessionOrder>) {
        let mut notifications = Notifications::default();
        let target = (&mut self.rig, &mut notifications);
        self.sessions.poll(&Context::default(), orders, target);
        self.shown.extend(shown(&notifications));
    }

    fn until(&mut self, is_so: impl Fn(&Self) -> bool) {
        let give_up = Instant::now() + Duration::from_secs(30);
        while !is_so(self) {
            assert!(Instant::now() < give_up, "{:?}", self.shown);
            self.poll(Vec::new());
            std::thread::yield_now();
        }
    }
}

#[test]
fn a_recording_that_ended_early_is_reported_once() {
    let mut desk = Desk::new("Sea.maul");
    let file = desk.folder.path().join("Sea.mcap");
    let whole = std::fs::File::create(&file).expect("created");
    let mut writer = maulstick_streams::RecordingWriter::begin(whole).expect("begun");
    let noted = writer.note("recording", std::collections::BTreeMap::default());
    noted.and_then(|()| writer.finish()).expect("written");
    let bytes = std::fs::read(&file).expect("there");
    std::fs::write(&file, &bytes[..bytes.len() - 20]).expect("cut");
    desk.until(|desk| !desk.shown.is_empty());
    assert_eq!(desk.shown.len(), 1);
    assert_eq!(desk.shown[0].0, Severity::Fault);
    desk.sessions = Sessions::default();
    let found = maulstick_recorder::complete_in(desk.folder.path());
    assert_eq!(found, Ok(vec![]), "it is whole");
}

fn shown(notifications: &Notifications) -> Vec<(Severity, String)> {
    let shown = notifications.shown().iter();
    shown
        .map(|toast| (toast.severity, toast.what.clone()))
        .collect()
}

#[test]
fn a_recording_stands_beside_the_painting_and_its_failure_is_shown() {
    let mut desk = Desk::new("Sea.maul");
    desk.rig.live.now_ns = 7;
    desk.poll(vec![SessionOrder::Record]);
    let recording = desk.rig.recording.clone().expect("it records");
    assert_eq!(recording.begun_ns, 7);
    let name = recording.file.file_name().expect("a name");
    let name = name.to_string_lossy();
    assert!(
        name.starts_with("Sea 20") && name.ends_with(".mcap"),
        "{name}"
    );
    assert_eq!(recording.file.parent(), Some(desk.folder.path()));
    desk.until(|desk| desk.rig.recording.is_none());
    assert_eq!(desk.shown.len(), 1);
    assert_eq!(desk.shown[0].0, Severity::Fault);
}

fn summary(file: &str, lacks_painting: bool) -> FileSummary {
    FileSummary {
        file: file.into(),
        messages: 9,
        seconds: 1.0,
        bytes: 900,
        lost: 0,
        dropped: 0,
        lacks_painting,
    }
}

#[test]
fn a_replay_beside_another_is_refused_in_words() {
    let mut desk = Desk::new("Sea.maul");
    let play = |name: &str| SessionOrder::Play {
        recording: desk.folder.path().join(name),
        forget: false,
    };
    let orders = vec![play("first.mcap"), play("second.mcap")];
    desk.poll(orders);
    let is_refusal = |(severity, what): &(Severity, String)| {
        *severity == Severity::Fault && what.contains("second.mcap")
    };
    assert!(desk.shown.iter().any(is_refusal), "{:?}", desk.shown);
    let replay = desk.rig.replay.as_ref().expect("the first one plays");
    assert!(replay.recording.ends_with("first.mcap"));
}

#[test]
fn what_a_recording_lacks_and_where_it_goes_on_is_shown() {
    let mut notifications = Notifications::default();
    for event in [
        RecorderEvent::Begun { file: "/x".into() },
        RecorderEvent::PaintingUnavailable(CopyTrouble::InMemory),
        RecorderEvent::Continued {
            file: "/x-1".into(),
            cause: Continuation::Full,
        },
        RecorderEvent::Continued {
            file: "/x-2".into(),
            cause: Continuation::JournalBroke,
        },
        RecorderEvent::FileEnded(summary("/x-2", false)),
        RecorderEvent::FileEnded(summary("/x-3", true)),
    ] {
        notify(&event, &mut notifications);
    }
    let shown = shown(&notifications);
    let severities: Vec<Severity> = shown.iter().map(|(severity, _)| *severity).collect();
    assert_eq!(
        severities,
        [Severity::Fault, Severity::Note, Severity::Fault]
    );
    assert!(shown[1].1.contains("/x-2"), "{shown:?}");
    assert!(shown[2].1.contains("/x-3"), "{shown:?}");
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
    let settings = put_down("/takes/sweep.mcap".into(), [-12.5, 30.0], 2.0, -15.0);
    assert_eq!(settings.device.as_deref(), Some(MOTION));
    let place = settings.place.expect("a place");
    assert_eq!(place.at_mm, Some([-12.5, 30.0]));
    assert_eq!((place.scale, place.turn_deg), (Some(2.0), Some(-15.0)));
}

#[test]
fn reports_say_where_a_replay_is_and_which_painting_it_has() {
    let mut progress = ReplayProgress::new(Path::new("/s.mcap"));
    let painting = || "/p/sea-replay.maul".into();
    progress.update(ReplayReport::Opening {
        painting: painting(),
    });
    assert!(progress.opens && progress.position.is_none());
    progress.update(ReplayReport::Painting {
        painting: painting(),
    });
    let position = replay(false).position.expect("a position");
    progress.update(ReplayReport::Position(position));
    assert_eq!(
        progress,
        ReplayProgress {
            position: Some(position),
            painting: Some(painting()),
            ..ReplayProgress::new(Path::new("/s.mcap"))
        }
    );
}

#[test]
fn a_recording_that_cannot_be_played_is_shown_and_the_bar_goes() {
    let mut desk = Desk::new("Sea.maul");
    let recording = desk.folder.path().join("none.mcap");
    let forget = false;
    desk.poll(vec![SessionOrder::Play { recording, forget }]);
    assert!(desk.rig.replay.is_some());
    desk.until(|desk| desk.rig.replay.is_none());
    assert_eq!(desk.shown.len(), 1);
    assert_eq!(desk.shown[0].0, Severity::Fault);
}

fn orders(harness: &mut Harness<'static, Bench>) -> Vec<SessionOrder> {
    harness.run_steps(2);
    harness.state_mut().requests.take_session_orders()
}

fn transport(order: Order) -> [SessionOrder; 1] {
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
    let told = shown(&harness.state().notifications);
    assert!(matches!(&told[..], [(Severity::Fault, _)]), "{told:?}");
}

#[test]
fn each_control_of_the_bar_gives_its_order() {
    let mut harness = window(None);
    assert!(harness.query_by_label("Pause").is_none());
    harness.state_mut().rig.replay = Some(replay(false));
    harness.run_steps(2);
    for (label, order) in [
        ("Back 5 s", Order::Skip(-5.0)),
        ("Pause", Order::Pause),
        ("On by one event", Order::Step),
        ("Forth 5 s", Order::Skip(5.0)),
        ("End the replay", Order::End),
    ] {
        harness.get_by_label(label).click();
        assert_eq!(orders(&mut harness), transport(order), "{label}");
    }
    harness.get_by_label("0:42 of 3:10");
    harness.get_by_label("Rate of the replay").click();
    harness.run_steps(3);
    harness.get_by_label("× 4").click();
    let rate = Order::Rate(Rate::Times(4.0));
    assert_eq!(orders(&mut harness), transport(rate));
    harness.state_mut().rig.replay = Some(replay(true));
    harness.run_steps(2);
    harness.get_by_label("Play on").click();
    assert_eq!(orders(&mut harness), transport(Order::Pause));
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
    let [SessionOrder::Transport(Order::Seek(seconds))] = orders(&mut harness)[..] else {
        panic!("no seek");
    };
    assert!((85.0..105.0).contains(&seconds), "{seconds}");
    harness
        .get_by_role_and_label(Role::Slider, "Place in the recording")
        .focus();
    press(&mut harness, Key::ArrowRight);
    let by_key = orders(&mut harness);
    let [SessionOrder::Transport(Order::Seek(seconds))] = by_key[..] else {
        panic!("{by_key:?}");
    };
    assert!(seconds > 42.0, "{seconds}");
}

#[test]
fn keys_are_the_bars_while_a_session_is_painted_again_and_else_where_they_are_free() {
    let mut harness = window(None);
    let both = [
        (Key::ArrowLeft, Order::Skip(-5.0)),
        (Key::ArrowRight, Order::Skip(5.0)),
    ];
    let of_session = [(Key::Space, Order::Pause), (Key::Period, Order::Step)];
    harness.state_mut().rig.replay = Some(replay(false));
    for (key, order) in both.into_iter().chain(of_session) {
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
    assert!(harness.state().told().contains("15°"));
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
