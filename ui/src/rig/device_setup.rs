//! Set-up of devices on a thread beside the window, one change after the other; and a listing whenever something has
//! changed.

mod words;

use std::collections::VecDeque;
use std::path::Path;
use std::sync::mpsc::{Receiver, channel};
use std::task::Poll;
use std::time::{Duration, Instant, SystemTime};

use eframe::egui::Context;
use maulstick_device::node_watch::NodeWatch;
use maulstick_device_setup::add::{Added, add};
use maulstick_device_setup::allow::allow;
use maulstick_device_setup::change::change as change_device;
use maulstick_device_setup::fit::{FitEnd, FitEvent, FitSettings, Report, fit};
use maulstick_device_setup::listing::DeviceListing;
use maulstick_device_setup::remove::remove;
use maulstick_device_setup::rename::rename;
use maulstick_rig::{Stop, UserError};
use maulstick_ui_kit::background_task::BackgroundTask;
use maulstick_ui_kit::notifications::Notifications;

use crate::rig::device_order::{DeviceOrder, FitProgress, SetupChange};
use crate::rig::state::RigState;

pub(crate) use words::fit_event;

/// Folders that change where a device is plugged in or out.
const NODES: [&str; 2] = ["/dev", "/dev/input"];
/// Longest wait for a fit or a change when the window ends.
const LONGEST_END: Duration = Duration::from_millis(800);
/// Time between two looks while a device lacks a permission, s, where the system does not tell that it has one.
const LOOK_S: f64 = 3.0;

/// A change that was made.
#[derive(Clone, Debug, PartialEq)]
enum Made {
    Allowed,
    Added(Added),
    Used(String),
    Renamed { device: String, name: String },
    Removed(String),
}

fn carry_out(change: &SetupChange, rig: &str) -> Result<Made, UserError> {
    let made = match change {
        SetupChange::Allow => allow().map(|()| Made::Allowed),
        SetupChange::Add(new) => add(new, rig).map(Made::Added),
        SetupChange::Use(wanted) => {
            change_device(wanted, rig).map(|changed| Made::Used(changed.device.name))
        }
        SetupChange::Rename { device, name } => rename(device, name, rig).map(|()| Made::Renamed {
            device: device.clone(),
            name: name.clone(),
        }),
        SetupChange::Remove(device) => remove(device, rig).map(|_| Made::Removed(device.clone())),
    };
    Ok(made?)
}

/// Contents of the newest listing.
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

/// Functions of the set-up, in whose place tests have others.
#[derive(Clone, Copy, Debug)]
struct Functions {
    carry_out: fn(&SetupChange, &str) -> Result<Made, UserError>,
    list: fn(&str) -> DeviceListing,
    fit: fn(&FitSettings<'_>, &Stop, Report<'_>) -> Result<FitEnd, UserError>,
}

/// A fit on its thread.
#[derive(Debug)]
struct Fit {
    stop: Stop,
    events: Receiver<FitEvent>,
    task: BackgroundTask<Result<FitEnd, UserError>>,
}

impl Drop for DeviceSetupRunner {
    fn drop(&mut self) {
        self.end();
    }
}

/// Runner of changes and listings.
#[derive(Debug)]
pub(crate) struct DeviceSetupRunner {
    functions: Functions,
    waiting: VecDeque<SetupChange>,
    running: Option<BackgroundTask<Result<Made, UserError>>>,
    listing: Option<BackgroundTask<DeviceListing>>,
    seen: Option<Seen>,
    nodes: Option<NodeWatch>,
    news: u64,
    /// Changes that have ended, and those that had when the newest listing began.
    done: u64,
    listed: u64,
    fit: Option<Fit>,
}

impl Default for DeviceSetupRunner {
    fn default() -> Self {
        Self::new(Functions {
            carry_out,
            list: DeviceListing::read,
            fit: |settings, stop, report| Ok(fit(settings, stop, report)?),
        })
    }
}

impl DeviceSetupRunner {
    fn new(functions: Functions) -> Self {
        Self {
            functions,
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

    /// Takes orders, and what has ended. `is_shown` says whether anybody looks at the listing.
    pub(crate) fn poll(
        &mut self,
        context: &Context,
        orders: Vec<DeviceOrder>,
        is_shown: bool,
        (rig, notifications): (&mut RigState, &mut Notifications),
    ) {
        for order in orders {
            match order {
                DeviceOrder::Change(change) => {
                    self.waiting.retain(|waits| !waits.is_replaced_by(&change));
                    self.waiting.push_back(change);
                }
                DeviceOrder::Fit(device) => self.begin_fit(context, device, rig),
                DeviceOrder::StopFit => self.fit.iter().for_each(|fit| fit.stop.request()),
            }
        }
        self.poll_changes(context, &rig.live.name, notifications);
        self.poll_fit(rig, notifications);
        if let Some(Poll::Ready(listed)) = self.listing.as_ref().map(BackgroundTask::poll) {
            (self.listing, self.listed) = (None, self.seen.as_ref().map_or(0, |seen| seen.done));
            rig.setup.listing = listed.or(rig.setup.listing.take());
        }
        let is_behind = self.listed < self.done;
        if (is_shown || is_behind) && self.listing.is_none() {
            self.list(context, rig);
        }
        rig.setup.is_changing = self.running.is_some() || !self.waiting.is_empty() || is_behind;
    }

    /// Stops a fit, so that the device is put back, and waits for the change that is being made: not longer than
    /// [`LONGEST_END`]. Those that wait are not begun.
    pub(crate) fn end(&mut self) {
        self.waiting.clear();
        let until = Instant::now() + LONGEST_END;
        let is_fit_over = self.fit.take().is_none_or(|fit| {
            fit.stop.request();
            fit.task.wait(until)
        });
        let is_changed = self.running.take().is_none_or(|task| task.wait(until));
        if !is_fit_over || !is_changed {
            tracing::warn!("the set-up of a device is not done as the window ends");
        }
    }

    /// Tells of the change that has ended, and begins the next.
    fn poll_changes(&mut self, context: &Context, rig: &str, notifications: &mut Notifications) {
        if let Some(Poll::Ready(ended)) = self.running.as_ref().map(BackgroundTask::poll) {
            (self.running, self.done) = (None, self.done + 1);
            match ended {
                Some(Ok(made)) => notifications.note(words::made(&made)),
                Some(Err(fault)) => notifications.of(&fault),
                None => {}
            }
        }
        if self.running.is_none()
            && let Some(change) = self.waiting.pop_front()
        {
            let (carry_out, rig) = (self.functions.carry_out, rig.to_owned());
            let run = move || carry_out(&change, &rig);
            self.running = Some(BackgroundTask::start(context, "device", run));
        }
    }

    /// Lists the devices where something has changed.
    fn list(&mut self, context: &Context, rig: &RigState) {
        let mut nodes = rig.live.nodes.clone();
        nodes.sort_unstable();
        if self.nodes.as_ref().is_some_and(NodeWatch::has_news) {
            self.news += 1;
        }
        // A permission changes no folder.
        let listing = rig.setup.listing.as_ref();
        let waits = listing.is_some_and(DeviceListing::lacks_permission);
        let looks = context.input(|input| input.time / LOOK_S) as u64;
        let seen = Seen {
            nodes,
            plugged: NODES.map(changed),
            news: self.news,
            done: self.done,
            looks: if waits { looks } else { 0 },
        };
        if self.seen.as_ref() == Some(&seen) {
            return;
        }
        self.seen = Some(seen);
        let (list, rig) = (self.functions.list, rig.live.name.clone());
        self.listing = Some(BackgroundTask::start(context, "devices", move || {
            list(&rig)
        }));
    }

    fn begin_fit(&mut self, context: &Context, device: String, rig: &mut RigState) {
        self.fit.iter().for_each(|fit| fit.stop.request());
        let (to_window, events) = channel();
        let (stop, fit) = (Stop::default(), self.functions.fit);
        let (name, ends) = (rig.live.name.clone(), stop.clone());
        let (meant, look) = (device.clone(), context.clone());
        let run = move || {
            let settings = FitSettings {
                device: &meant,
                file: None,
                rig: &name,
            };
            fit(&settings, &ends, &mut |event| {
                // The window may be gone; the fit is stopped then.
                to_window.send(event).ok();
                look.request_repaint();
                Ok(())
            })
        };
        self.fit = Some(Fit {
            stop,
            events,
            task: BackgroundTask::start(context, "fit", run),
        });
        rig.setup.fit = Some(FitProgress {
            device,
            events: Vec::new(),
        });
    }

    fn poll_fit(&mut self, rig: &mut RigState, notifications: &mut Notifications) {
        let (Some(fit), Some(progress)) = (&self.fit, &mut rig.setup.fit) else {
            return;
        };
        let ended = fit.task.poll();
        progress.events.extend(fit.events.try_iter());
        let Poll::Ready(ended) = ended else {
            return;
        };
        match (ended, progress.events.last()) {
            (Some(Err(fault)), _) => notifications.of(&fault),
            (_, Some(last)) => notifications.note(fit_event(last)),
            (_, None) => {}
        }
        self.done += 1;
        (self.fit, rig.setup.fit) = (None, None);
    }
}

/// Time at which a folder's entries last changed.
fn changed(folder: &str) -> Option<SystemTime> {
    Path::new(folder).metadata().ok()?.modified().ok()
}

#[cfg(test)]
mod tests;
