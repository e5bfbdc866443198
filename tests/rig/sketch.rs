//! A newcomer paints without a file: what was painted outlives the window, whatever ends it, and is offered again; and what
//! moves the desk waits while the brush is held.

#![allow(clippy::panic, reason = "helpers of tests say what they saw")]

#[path = "../support/mod.rs"]
mod support;

use std::path::{Path, PathBuf};
use std::time::Duration;

use maulstick_bus::typed::Receiver;
use maulstick_bus::{Qos, ZenohBus};
use maulstick_types::paint::PaintStatus;
use maulstick_types::stylus::{StylusPose, StylusSample};
use maulstick_types::wire::topics::Topics;
use maulstick_ui::settings::preferences::Preferences;
use nix::sys::signal::Signal;
use support::display::{Display, TAB, over};
use support::{Launcher, PATIENCE, Place, listen, wait_for};

/// A rig with its window, for which no file was given.
struct Studio {
    display: Display,
    window: u32,
    launcher: Launcher,
    bus: ZenohBus,
    topics: Topics,
    mouse: Receiver<StylusSample>,
}

fn sit_down(place: &Place) -> Studio {
    let display = Display::start();
    let mut command = place.maulstick(&["up"]);
    command.env("DISPLAY", &display.name);
    let mut launcher = Launcher::start(command);
    launcher.wait_says("is up");
    let (bus, topics) = support::join(place);
    Studio {
        window: display.window("Maulstick"),
        mouse: listen(&bus, &topics.sample("mouse"), Qos::RealTime),
        display,
        launcher,
        bus,
        topics,
    }
}

/// A straight way of the hand, mm.
fn line(from: [f64; 2], to: [f64; 2]) -> Vec<[i16; 2]> {
    let at = |i: u32| {
        let share = f64::from(i) / 30.0;
        over(
            from[0] + share * (to[0] - from[0]),
            from[1] + share * (to[1] - from[1]),
        )
    };
    (0..=30).map(at).collect()
}

impl Studio {
    /// Pixels of the window, a grid of them.
    fn pixels(&self) -> Vec<[u8; 3]> {
        let [width, height] = Preferences::default()
            .window
            .size
            .map(|side| side as i16 / 32);
        (1..32)
            .flat_map(|row| (1..32).map(move |column| (column * width, row * height)))
            .map(|(x, y)| self.display.pixel(self.window, x, y))
            .collect()
    }

    /// The status, once it is as wanted.
    fn status(&self, what: &str, wanted: impl Fn(&PaintStatus) -> bool) -> PaintStatus {
        let mut statuses =
            listen::<PaintStatus>(&self.bus, &self.topics.paint_status(), Qos::Background);
        let heard = wait_for(PATIENCE, || {
            let newest = statuses.newest().map(|heard| heard.message);
            newest.filter(&wanted)
        });
        heard.unwrap_or_else(|| panic!("{what}: {}", self.launcher.said()))
    }

    fn is_light(&self, x_mm: f64, y_mm: f64) -> bool {
        let [x, y] = over(x_mm, y_mm);
        let pixel = self.display.pixel(self.window, x, y);
        pixel.iter().all(|channel| *channel > 180)
    }
}

fn sketches(place: &Place) -> Vec<PathBuf> {
    let folder = std::fs::read_dir(place.path("maulstick/sketches"));
    let entries = folder.into_iter().flatten().flatten();
    let paths = entries.map(|entry| entry.path());
    paths
        .filter(|path| path.extension().is_some_and(|ending| ending == "maul"))
        .collect()
}

impl Studio {
    /// Paints a stroke of the hand: the file that has it.
    fn stroke(&mut self) -> PathBuf {
        let shown = wait_for(PATIENCE, || self.is_light(0.0, 0.0).then_some(()));
        assert!(shown.is_some(), "the canvas is not shown");
        let way = line([-60.0, 40.0], [60.0, 40.0]);
        self.display.drag(&way, &mut self.mouse);
        let status = self.status("a stroke in its file", |status| {
            !status.blank && status.all_committed && status.lag_ns == 0
        });
        PathBuf::from(status.path)
    }
}

/// A painting is whole, and not blank.
fn check(place: &Place, painting: &Path) {
    let checked = ["painting", "info", "--json", "--check"];
    let file = painting.to_str().expect("text");
    let said = place.done(&[&checked[..], &[file]].concat()).stdout;
    let said: serde_json::Value = serde_json::from_slice(&said).expect("JSON");
    assert_eq!(said["record"]["strokes"], 1, "{said}");
}

#[test]
fn a_sketch_outlives_a_closed_terminal_and_a_window_is_not_closed_on_one_unasked() {
    let place = Place::new();
    let mut studio = sit_down(&place);
    let sketch = studio.stroke();
    assert_eq!(sketches(&place), std::slice::from_ref(&sketch));

    // A window manager asks it to close, and a dialog dims the desk.
    studio.display.close(studio.window);
    let dimmed = wait_for(PATIENCE, || (!studio.is_light(0.0, -100.0)).then_some(()));
    assert!(dimmed.is_some(), "it does not ask");
    assert!(studio.launcher.is_running());
    studio.bus.close();
    studio.launcher.signal(Signal::SIGHUP);
    studio.launcher.wait(PATIENCE);
    place.wait_empty(PATIENCE);
    check(&place, &sketch);

    // Nothing is painted on the next one: it is closed at once, and goes.
    let mut studio = sit_down(&place);
    let blank = studio.status("another sketch", |status| !status.path.is_empty());
    assert_ne!(PathBuf::from(&blank.path), sketch);
    studio.bus.close();
    studio.display.close(studio.window);
    let ended = studio.launcher.wait(PATIENCE);
    assert_eq!(ended.code(), Some(0), "{}", studio.launcher.said());
    assert_eq!(sketches(&place), [sketch]);
}

#[test]
fn a_sketch_outlives_a_lost_display() {
    let place = Place::new();
    let mut studio = sit_down(&place);
    let sketch = studio.stroke();
    studio.bus.close();
    drop(studio.display);
    studio.launcher.wait(PATIENCE);
    place.wait_empty(PATIENCE);
    assert_eq!(sketches(&place), std::slice::from_ref(&sketch));
    check(&place, &sketch);
}

#[test]
fn a_panel_that_opens_under_a_held_brush_drags_it_nowhere() {
    let place = Place::new();
    let mut studio = sit_down(&place);
    let shown = wait_for(PATIENCE, || studio.is_light(0.0, 0.0).then_some(()));
    assert!(shown.is_some(), "the canvas is not shown");
    let way = line([-40.0, 0.0], [0.0, 0.0]);
    studio.display.press(1, &way);
    let place_of = |sample: StylusSample| match sample.pose {
        StylusPose::Contact {
            point_m, pressure, ..
        } if pressure > 0.0 => Some(point_m),
        _ => None,
    };
    let at = |studio: &mut Studio| {
        let heard = wait_for(PATIENCE, || studio.mouse.newest());
        heard.and_then(|heard| place_of(heard.message))
    };
    let held = wait_for(PATIENCE, || at(&mut studio).filter(|at| at[0].abs() < 1e-3));
    let held = held.expect("the brush is down");
    let before = studio.pixels();
    studio.display.keys(&[TAB]);
    // It stands still: for a while it stays where it is, whatever the window shows.
    let end = std::time::Instant::now() + Duration::from_millis(1500);
    while std::time::Instant::now() < end {
        let now = at(&mut studio).expect("the brush is still down");
        let way_m = (0..2).map(|i| (now[i] - held[i]).abs()).fold(0.0, f64::max);
        assert!(way_m < 1e-4, "it was dragged {way_m} m");
    }
    studio.display.release(1, &[]);
    // What waited comes now: the panels and another view are more than the stroke.
    let opened = wait_for(PATIENCE, || {
        let now = studio.pixels();
        let others = now.iter().zip(&before).filter(|(now, then)| now != then);
        (10 * others.count() > before.len()).then_some(())
    });
    assert!(opened.is_some(), "the panels never open");
    studio.bus.close();
    studio.launcher.signal(Signal::SIGTERM);
    studio.launcher.wait(PATIENCE);
}
