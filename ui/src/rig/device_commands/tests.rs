//! With a program in the place of `maulstick` that answers by what it is asked.

use std::os::unix::fs::PermissionsExt as _;
use std::time::{Duration, Instant};

use maulstick_ui_kit::notifications::Weight;

use super::*;
use crate::test_support::panel_bench::rig;

const PROGRAM: &str = r#"#!/bin/sh
case "$2" in
list) echo '{"hid": [], "events": [], "serial": [], "openhaptics": {"path": null},
 "inverse_service": {"listens": false}, "rig": [{"name": "arm", "driver": "polhem", "brush": "main",
 "is_in_rig": true, "is_own": true}]}';;
use) echo "first"; echo "$*";;
fit) trap 'echo "{\"said\": \"nothing is written\", \"asks\": null}"; exit 130' INT
    echo '{"said": "touch the lower left corner", "asks": "lower left"}'
 while :; do sleep 0.01; done;;
*) printf 'error: no such device\n  --> /x\n help: plug it in\n' >&2; exit 1;;
esac
"#;

struct Desk {
    commands: DeviceCommands,
    rig: RigState,
    told: Vec<(Weight, String)>,
    _folder: tempfile::TempDir,
}

impl Desk {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let program = folder.path().join("program");
        std::fs::write(&program, PROGRAM).expect("written");
        let all = std::fs::Permissions::from_mode(0o755);
        std::fs::set_permissions(&program, all).expect("set");
        Self {
            commands: DeviceCommands::new(program),
            rig: rig(),
            told: Vec::new(),
            _folder: folder,
        }
    }

    fn turn(&mut self, orders: Vec<DeviceOrder>, is_shown: bool) {
        let mut notifications = Notifications::default();
        let target = (&mut self.rig, &mut notifications);
        self.commands
            .turn(&Context::default(), orders, is_shown, target);
        let told = notifications.told().iter();
        self.told
            .extend(told.map(|toast| (toast.weight, toast.what.clone())));
    }

    fn until(&mut self, is_so: impl Fn(&Self) -> bool) {
        let give_up = Instant::now() + Duration::from_secs(30);
        while !is_so(self) {
            assert!(Instant::now() < give_up, "{:?}", self.told);
            self.turn(Vec::new(), false);
            std::thread::yield_now();
        }
    }
}

#[test]
fn commands_run_one_after_the_other_and_are_told() {
    let mut desk = Desk::new();
    let run = |words: &[&str]| DeviceOrder::Run(words.iter().map(|&word| word.into()).collect());
    desk.turn(vec![run(&["use", "arm"]), run(&["remove", "cup"])], false);
    desk.until(|desk| desk.told.len() == 2);
    let told = [
        (Weight::Note, "device use arm --name default".to_owned()),
        (Weight::Fault, "no such device".to_owned()),
    ];
    assert_eq!(desk.told, told);
    assert!(desk.rig.setup.is_changing, "the listing is of before");
    desk.until(|desk| !desk.rig.setup.is_changing);
    assert!(desk.rig.setup.listing.is_some());
}

#[test]
fn of_two_values_that_wait_the_newer_is_set() {
    let words = |text: &str| text.split(' ').map(str::to_owned).collect::<Vec<_>>();
    let curve = words("use pen --pressure-curve a");
    assert!(sets_the_same(&curve, &words("use pen --pressure-curve b")));
    assert!(!sets_the_same(&curve, &words("use arm --pressure-curve b")));
    assert!(!sets_the_same(&words("remove a"), &words("remove b")));
    let mut desk = Desk::new();
    let run = |text: &str| DeviceOrder::Run(words(text));
    let orders = ["use x 0 first", "use pen c a", "use pen c b"].map(run);
    desk.turn(orders.to_vec(), false);
    desk.until(|desk| desk.told.len() == 2);
    assert!(desk.told[1].1.contains("use pen c b"), "{:?}", desk.told);
}

#[test]
fn devices_are_listed_where_somebody_looks_and_something_has_changed() {
    let mut desk = Desk::new();
    desk.turn(Vec::new(), false);
    assert!(desk.commands.listing.is_none(), "nobody looks");
    desk.turn(Vec::new(), true);
    desk.until(|desk| desk.rig.setup.listing.is_some());
    assert!(
        desk.rig
            .setup
            .listing
            .as_ref()
            .expect("listed")
            .device("arm")
            .is_some()
    );
    desk.rig.live.nodes.push("arm".into());
    desk.turn(Vec::new(), true);
    assert!(desk.commands.listing.is_some(), "a device came");
    let dev = tempfile::tempdir().expect("a folder");
    desk.commands.nodes = NodeWatch::of(dev.path());
    desk.until(|desk| desk.commands.listing.is_none());
    desk.turn(Vec::new(), true);
    assert!(desk.commands.listing.is_none(), "nothing has changed");
    std::fs::write(dev.path().join("hidraw0"), "").expect("made");
    desk.turn(Vec::new(), true);
    assert!(desk.commands.listing.is_some(), "a node came");
}

#[test]
fn a_fit_says_what_to_touch_until_it_is_stopped() {
    let mut desk = Desk::new();
    desk.turn(vec![DeviceOrder::Fit("arm".into())], false);
    let said = |desk: &Desk| desk.rig.setup.fit.as_ref().map_or(0, |fit| fit.said.len());
    desk.until(|desk| said(desk) == 1);
    let asks = desk.rig.setup.fit.as_ref().and_then(|fit| fit.asks.clone());
    assert_eq!(asks.as_deref(), Some("lower left"));
    desk.turn(vec![DeviceOrder::StopFit], false);
    desk.until(|desk| desk.rig.setup.fit.is_none());
    assert_eq!(desk.told, [(Weight::Note, "nothing is written".to_owned())]);
}
