//! Long runs, behind `./test --long`: the recording of a person's strokes, ten times at each rate.

#[path = "../support/mod.rs"]
mod support;

use std::path::Path;

use maulstick_device::table::{TableLayout, import};
use support::{COARSE, Launcher, Place, assert_same};

const LOADS: [&str; 8] = [
    "--load",
    "Ultramarine Blue",
    "--load",
    "Pyrrole Red=0.6,Titanium White=0.4",
    "--load",
    "Yellow Ochre",
    "--load",
    "Phthalo Green Blue Shade=0.3,Titanium White=0.7",
];

/// The recording as `take.mcap`; false, with words, where it is not at hand.
fn recording(place: &Place) -> bool {
    let table = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/painting30sec.dat");
    if !table.exists() {
        eprintln!("skipped: {} is not there", table.display());
        return false;
    }
    let take = import(&table, TableLayout::default(), "table")
        .expect("a take")
        .take;
    take.write(&place.path("take.mcap")).expect("written");
    true
}

#[test]
#[ignore = "takes ten minutes"]
fn the_recording_ten_times_at_every_rate_is_the_rendered_picture() {
    let place = Place::new();
    if !recording(&place) {
        return;
    }
    let mut render = vec!["render", "take.mcap", "-o", "offline.png"];
    render.extend(LOADS);
    render.extend(COARSE);
    place.done(&render);
    for (rate, runs) in [("max", 10), ("4", 10), ("1", 10), ("0.5", 10)] {
        for run in 0..runs {
            let mut args = vec![
                "up",
                "--headless",
                "--play",
                "take.mcap",
                "--snapshot",
                "live.png",
            ];
            args.extend(["--ledger", "live.json", "--rate", rate]);
            args.extend(LOADS);
            args.extend(COARSE);
            let mut launcher = Launcher::start(place.maulstick(&args));
            let status = launcher.wait(support::PATIENCE);
            assert_eq!(
                status.code(),
                Some(0),
                "rate {rate}, run {run}: {}",
                launcher.said()
            );
            let what = format!("rate {rate}, run {run}");
            assert_same(&place.bytes("live.png"), &place.bytes("offline.png"), &what);
            let ledger: serde_json::Value =
                serde_json::from_slice(&place.bytes("live.json")).expect("JSON");
            assert_eq!(ledger["quanta_missing"], 0, "{what}");
        }
    }
}
