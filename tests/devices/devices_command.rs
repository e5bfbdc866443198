//! `maulstick devices` as its users call it: beside the devices of this machine, whatever they are,
//! those of a rig.

#[path = "../support/mod.rs"]
mod support;

use serde_json::Value;
use support::{Launcher, PATIENCE, Place, has, wait_for};

/// What it prints as JSON.
fn devices(place: &Place) -> Value {
    let said = place.done(&["devices", "--json"]).stdout;
    serde_json::from_slice(&said).expect("JSON")
}

#[test]
fn the_devices_of_a_rig_are_listed_while_it_runs() {
    let place = Place::new();
    assert_eq!(devices(&place)["rig"], Value::Null);
    let config = place.done(&["up", "--print-config"]).stdout;
    std::fs::write(place.path("rig.toml"), config).expect("written");
    let launcher = Launcher::up(&place, &["--rig", "rig.toml"]);
    let rows = wait_for(PATIENCE, || {
        let rig = devices(&place)["rig"].clone();
        let row = rig
            .as_array()?
            .iter()
            .find(|row| row["name"] == "phantom" && row["driver"].is_string())?;
        Some(row.clone())
    });
    let row = rows.unwrap_or_else(|| panic!("no phantom: {}", launcher.said()));
    assert_eq!(
        (&row["driver"], &row["brush"]),
        (&"simulated".into(), &"main".into())
    );
    assert_eq!(
        (&row["priority"], &row["trouble"]),
        (&10.into(), &"".into())
    );
    let text = wait_for(PATIENCE, || {
        let text = String::from_utf8(place.done(&["devices"]).stdout).expect("UTF-8");
        text.contains("simulated").then_some(text)
    });
    let text = text.unwrap_or_else(|| panic!("no phantom: {}", launcher.said()));
    has(&text, &["in the rig", "phantom", "in use"]);
    // Another rig has none of it.
    let text =
        String::from_utf8(place.done(&["devices", "--name", "other"]).stdout).expect("UTF-8");
    has(&text, &["does not run"]);
    assert!(!text.contains("phantom"), "{text}");
}

#[test]
fn the_rule_for_udev_is_printed_by_itself() {
    let place = Place::new();
    let rule = String::from_utf8(place.done(&["devices", "--udev"]).stdout).expect("UTF-8");
    has(
        &rule,
        &["\"*:056A:*\"", "\"*:256F:*\"", "16c0", "TAG+=\"uaccess\""],
    );
    for line in rule.lines().filter(|line| !line.is_empty()) {
        let is_rule = line.starts_with("SUBSYSTEM==") || line.starts_with('#');
        assert!(is_rule, "udev would stumble over: {line}");
    }
    let output = place.run(&["devices", "--udev", "--json"]);
    assert_eq!(output.status.code(), Some(2));
}
