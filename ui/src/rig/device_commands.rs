//! `maulstick device …`, run by the window as a user at a terminal would, one after the other.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::task::Poll;
use std::time::SystemTime;

use eframe::egui::Context;
use maulstick_device::node_watch::NodeWatch;
use maulstick_rig::program::{command, own_program};
use maulstick_ui_kit::background_task::BackgroundTask;
use maulstick_ui_kit::notifications::Notifications;
use serde::Deserialize;

use crate::rig::child_process::{ChildProcess, Ended, Refused, complaint};
use crate::rig::device_listing::DeviceListing;
use crate::rig::state::RigState;

/// Folders that change where a device is plugged in or out.
const NODES: [&str; 2] = ["/dev", "/dev/input"];
/// Time between two looks while a device lacks a permission, s, where the system does not tell that it has one.
const LOOK_S: f64 = 3.0;

/// A request to this runner.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum DeviceOrder {
    /// A command, without `maulstick device`.
    Run(Vec<String>),
    /// Fits a device to the canvas, by the hand's touches.
    Fit(String),
    /// Ends the fit in progress: nothing is written.
    StopFit,
}

/// A fit in progress.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FitProgress {
    /// The device.
    pub device: String,
    /// What was said so far, line by line.
    pub said: Vec<String>,
    /// The corner that is to be touched now.
    pub asks: Option<String>,
}

/// A line of `maulstick device fit --json`.
#[derive(Debug, Deserialize)]
struct FitLine {
    said: String,
    asks: Option<String>,
}

impl FitProgress {
    /// Adds a line; one that is no [`FitLine`] says nothing.
    fn read(&mut self, line: &str) {
        if let Ok(FitLine { said, asks }) = serde_json::from_str(line) {
            self.said.push(said);
            self.asks = asks.or(self.asks.take());
        }
    }
}

/// What the newest listing shows.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Seen {
    nodes: Vec<String>,
    plugged: [Option<SystemTime>; 2],
    /// Counts nodes that have come or changed.
    news: u64,
    done: u64,
    /// Counts while a permission is waited for.
    looks: u64,
}

/// Runs the commands, and lists the devices whenever something has changed.
#[derive(Debug)]
pub(crate) struct DeviceCommands {
    program: PathBuf,
    waiting: VecDeque<Vec<String>>,
    running: Option<BackgroundTask<Result<String, Refused>>>,
    listing: Option<BackgroundTask<Result<DeviceListing, Refused>>>,
    seen: Option<Seen>,
    nodes: Option<NodeWatch>,
    news: u64,
    /// Commands that have ended, and those that had when the newest listing began.
    done: u64,
    listed: u64,
    fit: Option<ChildProcess>,
}

impl DeviceCommands {
    /// Runs `program`.
    pub(crate) fn new(program: PathBuf) -> Self {
        Self {
            program,
            waiting: VecDeque::new(),
            running: None,
            listing: None,
            seen: None,
            nodes: NodeWatch::of(Path::new(NODES[0])),
            news: 0,
            done: 0,
            listed: 0,
            fit: None,
        }
    }

    /// The program of this process.
    pub(crate) fn own() -> Self {
        Self::new(own_program())
    }

    /// Takes orders, and what has ended. `is_shown` says whether anybody looks at the listing.
    pub(crate) fn turn(
        &mut self,
        context: &Context,
        orders: Vec<DeviceOrder>,
        is_shown: bool,
        (rig, notifications): (&mut RigState, &mut Notifications),
    ) {
        for order in orders {
            match order {
                DeviceOrder::Run(words) => {
                    // What waits and sets the same is not done first.
                    self.waiting.retain(|waits| !sets_the_same(waits, &words));
                    self.waiting.push_back(words);
                }
                DeviceOrder::Fit(device) => self.begin_fit(context, device, rig, notifications),
                DeviceOrder::StopFit => self.fit.iter().for_each(ChildProcess::interrupt),
            }
        }
        if let Some(Poll::Ready(ended)) = self.running.as_ref().map(BackgroundTask::poll) {
            (self.running, self.done) = (None, self.done + 1);
            match ended {
                Some(Ok(said)) => notifications.note(said),
                Some(Err(Refused { what, help })) => notifications.fault(what, help),
                None => {}
            }
        }
        if self.running.is_none()
            && let Some(words) = self.waiting.pop_front()
        {
            let command = self.command(&words, &rig.live.name);
            let run = move || run(command).map(|output| last_line(&output.stdout));
            self.running = Some(BackgroundTask::start(context, "device", run));
        }
        self.follow_fit(rig, notifications);
        if let Some(Poll::Ready(listed)) = self.listing.as_ref().map(BackgroundTask::poll) {
            (self.listing, self.listed) = (None, self.seen.as_ref().map_or(0, |seen| seen.done));
            match listed {
                Some(Ok(listing)) => rig.setup.listing = Some(listing),
                Some(Err(Refused { what, help })) => notifications.fault(what, help),
                None => {}
            }
        }
        let is_behind = self.listed < self.done;
        if (is_shown || is_behind) && self.listing.is_none() {
            self.list(context, rig);
        }
        rig.setup.is_changing = self.running.is_some() || !self.waiting.is_empty() || is_behind;
    }

    /// Lists the devices where something has changed.
    fn list(&mut self, context: &Context, rig: &RigState) {
        let mut nodes = rig.live.nodes.clone();
        nodes.sort_unstable();
        if self.nodes.as_ref().is_some_and(NodeWatch::has_news) {
            self.news += 1;
        }
        // A permission changes no folder.
        let waits = rig
            .setup
            .listing
            .as_ref()
            .is_some_and(DeviceListing::lacks_permission);
        let seen = Seen {
            nodes,
            plugged: NODES.map(changed),
            news: self.news,
            done: self.done,
            looks: match waits {
                true => context.input(|input| input.time / LOOK_S) as u64,
                false => 0,
            },
        };
        if self.seen.as_ref() == Some(&seen) {
            return;
        }
        self.seen = Some(seen);
        let command = self.command(&["list".to_owned(), "--json".to_owned()], &rig.live.name);
        let list = move || {
            let output = run(command)?;
            DeviceListing::parse(&output.stdout).map_err(|what| Refused {
                what,
                help: String::new(),
            })
        };
        self.listing = Some(BackgroundTask::start(context, "devices", list));
    }

    fn command(&self, words: &[String], rig: &str) -> Command {
        let mut command = command(&self.program);
        command.arg("device").args(words);
        if words.first().is_none_or(|word| word != "allow") {
            command.args(["--name", rig]);
        }
        command.stdin(Stdio::null());
        command
    }

    fn begin_fit(
        &mut self,
        context: &Context,
        device: String,
        rig: &mut RigState,
        notifications: &mut Notifications,
    ) {
        let words = ["fit".to_owned(), device.clone(), "--json".to_owned()];
        match ChildProcess::start(context, self.command(&words, &rig.live.name)) {
            Ok(child) => self.fit = Some(child),
            Err(error) => return notifications.fault(error.to_string(), ""),
        }
        rig.setup.fit = Some(FitProgress {
            device,
            ..FitProgress::default()
        });
    }

    fn follow_fit(&mut self, rig: &mut RigState, notifications: &mut Notifications) {
        let (Some(fit), Some(progress)) = (&mut self.fit, &mut rig.setup.fit) else {
            return;
        };
        fit.lines().for_each(|line| progress.read(&line));
        let Some(Ended { lines, result }) = fit.ended() else {
            return;
        };
        lines.iter().for_each(|line| progress.read(line));
        let said = progress.said.pop().unwrap_or_default();
        match result {
            Err(Refused { what, help }) if !what.is_empty() => notifications.fault(what, help),
            _ if said.is_empty() => {}
            _ => notifications.note(said),
        }
        self.done += 1;
        (self.fit, rig.setup.fit) = (None, None);
    }
}

/// True if two commands differ in the value that they end in alone.
fn sets_the_same(one: &[String], other: &[String]) -> bool {
    let (Some((_, one)), Some((_, other))) = (one.split_last(), other.split_last()) else {
        return false;
    };
    one == other && one.len() > 2
}

/// Time at which a folder's entries last changed.
fn changed(folder: &str) -> Option<SystemTime> {
    Path::new(folder).metadata().ok()?.modified().ok()
}

/// What a command prints where it succeeds.
fn run(mut command: Command) -> Result<Output, Refused> {
    let output = command.output().map_err(|error| Refused {
        what: error.to_string(),
        help: String::new(),
    })?;
    match output.status.success() {
        true => Ok(output),
        false => Err(complaint(&String::from_utf8_lossy(&output.stderr))),
    }
}

fn last_line(said: &[u8]) -> String {
    let said = String::from_utf8_lossy(said);
    said.trim().lines().last().unwrap_or_default().to_owned()
}

#[cfg(test)]
mod tests;
