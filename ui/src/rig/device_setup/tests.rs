//! With functions in the place of those of the set-up.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use maulstick_device::corner_calibration::Corner;
use maulstick_device_setup::change::DeviceChange;
use maulstick_device_setup::fit::Gesture;
use maulstick_device_setup::listing::RigDevice;
use maulstick_rig::config::DeviceSection;
use maulstick_ui_kit::notifications::Severity;

use super::*;
use crate::test_support::panel_bench::rig;

fn carry_out(change: &SetupChange, rig: &str) -> Result<Made, UserError> {
    match change {
        SetupChange::Use(change) => {
            let curve = change.pressure_curve.iter().flatten().flatten();
            let curve: Vec<f64> = curve.copied().collect();
            Ok(Made::Used(format!("{} {curve:?} {rig}", change.device)))
        }
        _ => Err(UserError::usage("no such device")),
    }
}

fn list(_: &str) -> DeviceListing {
    let arm = RigDevice {
        section: DeviceSection::new("arm", "polhem", "main"),
        is_in_rig: true,
        is_own: true,
        is_there: true,
        trouble: String::new(),
    };
    DeviceListing {
        rig: Some(vec![arm]),
        ..DeviceListing::default()
    }
}

/// Asks for a corner until it is stopped.
fn fit_forever(_: &FitSettings<'_>, stop: &Stop, report: Report<'_>) -> Result<FitEnd, UserError> {
    report(FitEvent::Touch {
        corner: Corner::LowerLeft,
        gesture: Gesture::Pen,
    })?;
    while !stop.requested() {
        std::thread::yield_now();
    }
    report(FitEvent::Unwritten)?;
    Ok(FitEnd::Stopped)
}

/// Fits whose device was put back.
static PUT_BACK: AtomicUsize = AtomicUsize::new(0);

/// As [`fit_forever`], of a device that takes a while to be put back.
fn fit_and_put_back(
    settings: &FitSettings<'_>,
    stop: &Stop,
    report: Report<'_>,
) -> Result<FitEnd, UserError> {
    let end = fit_forever(settings, stop, report);
    (0..100).for_each(|_| std::thread::yield_now());
    PUT_BACK.fetch_add(1, Ordering::SeqCst);
    end
}

struct Desk {
    runner: DeviceSetupRunner,
    rig: RigState,
    shown: Vec<(Severity, String)>,
}

impl Desk {
    fn new() -> Self {
        let functions = Functions {
            carry_out,
            list,
            fit: fit_forever,
        };
        Self {
            runner: DeviceSetupRunner::new(functions),
            rig: rig(),
            shown: Vec::new(),
        }
    }

    fn poll(&mut self, orders: Vec<DeviceOrder>, is_shown: bool) {
        let mut notifications = Notifications::default();
        let target = (&mut self.rig, &mut notifications);
        self.runner
            .poll(&Context::default(), orders, is_shown, target);
        let shown = notifications.shown().iter();
        self.shown
            .extend(shown.map(|toast| (toast.severity, toast.what.clone())));
    }

    fn until(&mut self, is_so: impl Fn(&Self) -> bool) {
        let give_up = Instant::now() + Duration::from_secs(30);
        while !is_so(self) {
            assert!(Instant::now() < give_up, "{:?}", self.shown);
            self.poll(Vec::new(), false);
            std::thread::yield_now();
        }
    }
}

fn uses(device: &str, curve: Option<f64>) -> DeviceOrder {
    DeviceOrder::Change(SetupChange::Use(DeviceChange {
        device: device.to_owned(),
        pressure_curve: curve.map(|given| vec![[0.5, given]]),
        ..DeviceChange::default()
    }))
}

#[test]
fn changes_run_one_after_the_other() {
    let mut desk = Desk::new();
    let remove = DeviceOrder::Change(SetupChange::Remove("cup".into()));
    desk.poll(vec![uses("arm", None), remove], false);
    desk.until(|desk| desk.shown.len() == 2);
    let severities = [0, 1].map(|at| desk.shown[at].0);
    assert_eq!(severities, [Severity::Note, Severity::Fault]);
    assert!(desk.rig.setup.is_changing, "the listing is of before");
    desk.until(|desk| !desk.rig.setup.is_changing);
    assert!(desk.rig.setup.listing.is_some());
}

#[test]
fn of_two_values_that_wait_the_newer_is_set() {
    let mut desk = Desk::new();
    let orders = vec![
        uses("arm", None),
        uses("pen", Some(0.3)),
        uses("cup", Some(0.3)),
        uses("pen", Some(0.4)),
    ];
    desk.poll(orders, false);
    desk.until(|desk| desk.shown.len() == 3);
    let rig = desk.rig.live.name.clone();
    let made = |text: &str| words::made(&Made::Used(format!("{text} {rig}")));
    let expected = ["arm []", "cup [0.5, 0.3]", "pen [0.5, 0.4]"].map(made);
    let shown: Vec<&String> = desk.shown.iter().map(|(_, what)| what).collect();
    assert_eq!(shown, expected.iter().collect::<Vec<_>>());
}

#[test]
fn devices_are_listed_where_somebody_looks_and_something_has_changed() {
    let mut desk = Desk::new();
    desk.poll(Vec::new(), false);
    assert!(desk.runner.listing.is_none(), "nobody looks");
    desk.poll(Vec::new(), true);
    desk.until(|desk| desk.rig.setup.listing.is_some());
    let listing = desk.rig.setup.listing.as_ref();
    assert!(listing.expect("listed").device("arm").is_some());
    desk.rig.live.nodes.push("arm".into());
    desk.poll(Vec::new(), true);
    assert!(desk.runner.listing.is_some(), "a device came");
    let dev = tempfile::tempdir().expect("a folder");
    desk.runner.nodes = NodeWatch::of(dev.path());
    desk.until(|desk| desk.runner.listing.is_none());
    desk.poll(Vec::new(), true);
    assert!(desk.runner.listing.is_none(), "nothing has changed");
    std::fs::write(dev.path().join("hidraw0"), "").expect("made");
    desk.poll(Vec::new(), true);
    assert!(desk.runner.listing.is_some(), "a node came");
}

#[test]
fn a_fit_says_what_to_touch_until_it_is_stopped() {
    let mut desk = Desk::new();
    desk.poll(vec![DeviceOrder::Fit("arm".into())], false);
    let asked = |desk: &Desk| desk.rig.setup.fit.as_ref()?.asked_corner();
    desk.until(|desk| asked(desk) == Some(Corner::LowerLeft));
    desk.poll(vec![DeviceOrder::StopFit], false);
    desk.until(|desk| desk.rig.setup.fit.is_none());
    let unwritten = fit_event(&FitEvent::Unwritten);
    assert_eq!(desk.shown, [(Severity::Note, unwritten)]);
}

#[test]
fn a_fit_puts_the_device_back_before_the_window_is_gone() {
    let mut desk = Desk::new();
    desk.runner.functions.fit = fit_and_put_back;
    desk.poll(vec![DeviceOrder::Fit("arm".into())], false);
    desk.until(|desk| {
        desk.rig
            .setup
            .fit
            .as_ref()
            .is_some_and(|fit| !fit.events.is_empty())
    });
    drop(desk.runner);
    assert_eq!(PUT_BACK.load(Ordering::SeqCst), 1);
}
