//! Pictures go to a window through memory that it shares with the paint node, and no process leaves any
//! behind, however it ends.

#![allow(clippy::panic, reason = "tests")]

#[path = "../support/mod.rs"]
mod support;

use std::collections::BTreeMap;
use std::path::Path;

use nix::sys::signal::Signal;
use support::display::Display;
use support::{Launcher, PATIENCE, Place, signal, wait_for};

/// A pool has at least this many bytes.
const POOL_BYTES: u64 = 4 << 20;

/// Shared segments of a process and their bytes.
fn segments(pid: u32) -> BTreeMap<String, u64> {
    let maps = std::fs::read_to_string(format!("/proc/{pid}/maps")).unwrap_or_default();
    let segment = |line: &str| {
        let path = line.split_whitespace().nth(5)?;
        let (from, to) = line.split_whitespace().next()?.split_once('-')?;
        let at = |text: &str| u64::from_str_radix(text, 16).ok();
        let is_ours = path.starts_with("/dev/shm/") && path.ends_with(".zenoh");
        is_ours.then(|| Some((path.to_owned(), at(to)? - at(from)?)))?
    };
    maps.lines().filter_map(segment).collect()
}

/// Waits until the window reads a pool of this paint node.
fn pool(place: &Place, launcher: &Launcher, paint: u32) -> String {
    let shared = || {
        let (ours, theirs) = (segments(paint), segments(place.pid("maulstick-ui")?));
        let pool = ours
            .iter()
            .find(|(name, bytes)| **bytes >= POOL_BYTES && theirs.contains_key(*name));
        pool.map(|(name, _)| name.clone())
    };
    wait_for(PATIENCE, shared).unwrap_or_else(|| panic!("nothing is shared: {}", launcher.said()))
}

#[test]
fn a_window_shares_memory_with_the_paint_node_and_a_killed_rig_leaves_none_behind() {
    let (place, display) = (Place::new(), Display::start());
    let mut command = place.maulstick(&["up"]);
    command.env("DISPLAY", &display.name);
    command.env_remove("WAYLAND_DISPLAY");
    let mut launcher = Launcher::start(command);
    launcher.wait_says("is up");
    let paint = || wait_for(PATIENCE, || place.pid("maulstick-paint")).expect("a paint node");
    let first = paint();
    let old = pool(&place, &launcher, first);
    signal(first, Signal::SIGKILL);
    let second = wait_for(PATIENCE, || {
        place.pid("maulstick-paint").filter(|pid| *pid != first)
    });
    let second = second.unwrap_or_else(|| panic!("no paint node: {}", launcher.said()));
    let new = pool(&place, &launcher, second);
    assert_ne!(new, old, "another process has another pool");
    let ui = place.pid("maulstick-ui").expect("a window");
    let mut left = segments(second);
    left.extend(segments(ui));
    // Killed, it can tidy nothing up.
    signal(launcher.pid(), Signal::SIGKILL);
    place.wait_empty(PATIENCE);
    let there = |left: &BTreeMap<String, u64>| -> Vec<String> {
        left.keys()
            .filter(|name| Path::new(name).exists())
            .cloned()
            .collect()
    };
    assert!(
        !there(&left).is_empty(),
        "a fault would pass: nothing is left"
    );
    let _again = Launcher::up(&place, &[]);
    assert_eq!(there(&left), Vec::<String>::new());
}

#[test]
fn a_rig_that_is_stopped_frees_the_memory_of_a_paint_node_that_was_killed() {
    let (place, display) = (Place::new(), Display::start());
    let mut command = place.maulstick(&["up"]);
    command.env("DISPLAY", &display.name);
    command.env_remove("WAYLAND_DISPLAY");
    let mut launcher = Launcher::start(command);
    launcher.wait_says("is up");
    let paint = wait_for(PATIENCE, || place.pid("maulstick-paint")).expect("a paint node");
    let pool = pool(&place, &launcher, paint);
    let mut left = segments(paint);
    let ui = place.pid("maulstick-ui").expect("a window");
    left.extend(segments(ui));
    assert!(left.contains_key(&pool));
    // Neither can tidy anything up, and the rig is stopped before another does.
    signal(ui, Signal::SIGKILL);
    signal(paint, Signal::SIGKILL);
    launcher.close(&place);
    let there: Vec<&String> = left
        .keys()
        .filter(|name| Path::new(name).exists())
        .collect();
    assert!(there.is_empty(), "{there:?}");
}
