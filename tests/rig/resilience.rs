//! What a rig outlasts: a terminal that stands still, an upgrade, a machine that is short of something.

#[path = "../support/mod.rs"]
mod support;

use std::fs::File;
use std::io::{ErrorKind, Write as _};
use std::os::fd::AsFd as _;
use std::path::Path;
use std::process::{Child, Command, Stdio};

use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus as _, Qos, RigFolder};
use maulstick_types::paint::PaintStatus;
use nix::fcntl::{FcntlArg, OFlag, fcntl};
use nix::sys::signal::Signal;
use support::{Launcher, MAULSTICK, PATIENCE, Place, drain, hear, listen, signal, wait_for};

/// A pipe that is full, and has no room for a byte until it is read.
fn full_pipe() -> (File, File) {
    let (read, write) = nix::unistd::pipe().expect("a pipe");
    let write = File::from(write);
    let wait = |flags: OFlag| fcntl(write.as_fd(), FcntlArg::F_SETFL(flags)).expect("set");
    wait(OFlag::O_NONBLOCK);
    let mut written = 0;
    let full = loop {
        match (&write).write(&[b'.'; 512]) {
            Ok(more) => written += more,
            Err(error) => break error,
        }
    };
    assert_eq!(full.kind(), ErrorKind::WouldBlock);
    assert!(written > 0, "it had no room at all");
    wait(OFlag::empty());
    (read.into(), write)
}

/// The status of a paint node that runs, after those that waited.
fn paints(status: &mut Receiver<PaintStatus>) -> bool {
    drain(status);
    hear(status, |_| true).is_some()
}

/// Another process of a program than `before`.
fn anew(place: &Place, program: &str, before: u32) -> Option<u32> {
    wait_for(PATIENCE, || place.pid(program).filter(|pid| *pid != before))
}

#[test]
fn a_rig_whose_messages_nobody_reads_paints_on_mends_itself_and_ends() {
    let place = Place::new();
    let (unread, write) = full_pipe();
    let mut command = place.maulstick(&["up", "--headless"]);
    command.stdout(Stdio::null()).stderr(write);
    let mut rig = Ended(command.spawn().expect("started"));
    drop(command);
    let folder = place.path("maulstick/studio");
    let up = wait_for(PATIENCE, || RigFolder::join_at(&folder).ok());
    assert!(up.is_some(), "the launcher stands still");
    let (bus, topics) = support::join(&place);
    let mut status = listen::<PaintStatus>(&bus, &topics.paint_status(), Qos::Background);
    assert!(paints(&mut status), "the rig does not come up");
    let brush = place.pid("maulstick-brush").expect("a brush");
    // Each node has something to say of a message that is none.
    for topic in [
        topics.sample("evil"),
        topics.scene(),
        topics.brush_state("main"),
    ] {
        let publisher = bus.publisher(&topic, Qos::Data).expect("declared");
        publisher.put(vec![0; 7]).expect("sent");
    }
    assert!(paints(&mut status), "paint stands still");
    signal(brush, Signal::SIGKILL);
    let brush = anew(&place, "maulstick-brush", brush);
    assert!(brush.is_some(), "the launcher stands still");
    assert!(paints(&mut status), "paint stands still");
    place.done(&["load", "Bone Black"]);
    bus.close();
    signal(rig.0.id(), Signal::SIGTERM);
    let ended = wait_for(PATIENCE, || rig.0.try_wait().expect("waited"));
    assert_eq!(ended.and_then(|status| status.code()), Some(143));
    place.wait_empty(PATIENCE);
    drop(unread);
}

#[test]
fn a_recording_whose_words_nobody_reads_goes_on_and_ends() {
    let place = Place::new();
    let launcher = Launcher::up(&place, &[]);
    let (unread, write) = full_pipe();
    let mut command = place.maulstick(&["recording", "record", "-o", "s.mcap"]);
    command.stdout(write).stderr(Stdio::null());
    let mut recorder = Ended(command.spawn().expect("started"));
    drop(command);
    let bytes = || std::fs::metadata(place.path("s.mcap")).map_or(0, |file| file.len());
    let begun = wait_for(PATIENCE, || (bytes() > 0).then(bytes));
    let grown = wait_for(PATIENCE, || (Some(bytes()) > begun).then_some(()));
    assert!(grown.is_some(), "the recorder stands still at {begun:?}");
    signal(recorder.0.id(), Signal::SIGTERM);
    let ended = wait_for(PATIENCE, || recorder.0.try_wait().expect("waited"));
    assert!(ended.is_some_and(|status| status.success()), "{ended:?}");
    launcher.close(&place);
    place.done(&["recording", "info", "s.mcap"]);
    drop(unread);
}

/// A process that does not outlast its test.
struct Ended(Child);

impl Drop for Ended {
    fn drop(&mut self) {
        self.0.kill().ok();
        self.0.wait().ok();
    }
}

/// Lets a process have so many open files.
fn limit_files(pid: u32, most: &str) {
    let limited = Command::new("prlimit")
        .args(["--pid", &pid.to_string(), &format!("--nofile={most}:")])
        .status();
    assert!(limited.expect("prlimit of util-linux").success());
}

/// The limit of open files of this process.
fn usual_limit() -> String {
    let limit = nix::sys::resource::getrlimit(nix::sys::resource::Resource::RLIMIT_NOFILE);
    limit.expect("a limit").0.to_string()
}

/// A rig of a program in the place, once it is up.
fn rig_of(place: &Place, program: &Path) -> Launcher {
    let mut command = Command::new(program);
    command
        .args(["up", "--headless"])
        .current_dir(place.path(""))
        .env("XDG_RUNTIME_DIR", place.path(""))
        .env("XDG_CONFIG_HOME", place.path(""));
    let mut rig = Launcher::start(command);
    rig.wait_says("is up");
    rig
}

#[test]
fn a_rig_outlasts_its_upgrade_and_a_start_that_the_system_does_not_allow() {
    let place = Place::new();
    let program = place.path("program");
    std::fs::copy(MAULSTICK, &program).expect("copied");
    let mut rig = rig_of(&place, &program);
    let brush = place.pid("maulstick-brush").expect("a brush");
    // The upgrade: another file has the name.
    std::fs::remove_file(&program).expect("removed");
    std::fs::write(&program, "#!/bin/sh\nexit 1\n").expect("written");
    signal(brush, Signal::SIGKILL);
    let brush = anew(&place, "maulstick-brush", brush).expect("a brush again");
    // Without another file there is no pipe to another process.
    limit_files(rig.pid(), "4");
    signal(brush, Signal::SIGKILL);
    rig.wait_says("cannot be started");
    assert!(rig.is_running(), "{}", rig.said());
    limit_files(rig.pid(), &usual_limit());
    let again = anew(&place, "maulstick-brush", brush);
    assert!(again.is_some(), "{}", rig.said());
    let (bus, topics) = support::join(&place);
    let mut status = listen::<PaintStatus>(&bus, &topics.paint_status(), Qos::Background);
    assert!(paints(&mut status), "{}", rig.said());
    bus.close();
    rig.close(&place);
}

#[test]
fn a_frozen_brush_is_replaced() {
    let place = Place::new();
    let mut launcher = Launcher::up(&place, &[]);
    let brush = place.pid("maulstick-brush").expect("a brush");
    signal(brush, Signal::SIGSTOP);
    launcher.wait_says("is started again");
    let anew = wait_for(PATIENCE, || {
        place.pid("maulstick-brush").filter(|anew| *anew != brush)
    });
    assert!(anew.is_some(), "{}", launcher.said());
    launcher.signal(Signal::SIGTERM);
    launcher.wait(PATIENCE);
}
