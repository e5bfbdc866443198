//! `maulstick device` as its users call it: beside the devices of this machine, whatever they are, those of a rig, which come
//! and go while it runs.

#[path = "../support/mod.rs"]
mod support;

use serde_json::Value;
use support::{Launcher, PATIENCE, Place, has, wait_for};

/// The list of devices.
fn devices(place: &Place) -> Value {
    place.json(&["device", "list", "--json"])
}

#[test]
fn the_devices_of_a_rig_are_listed_while_it_runs() {
    let place = Place::new();
    assert_eq!(devices(&place)["rig"], Value::Null);
    place.write_settings(&[]);
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
        let text = place.text(&["device", "list"]);
        text.contains("simulated").then_some(text)
    });
    let text = text.unwrap_or_else(|| panic!("no phantom: {}", launcher.said()));
    has(&text, &["in the rig", "phantom", "in use"]);
    has(
        &refused(&place, &["device", "rename", "phantom", "arm"]),
        &[
            "'phantom' is a device of the rig's own settings",
            "rig.toml",
        ],
    );
    // Another rig has none of it.
    let text = place.text(&["device", "list", "--name", "other"]);
    has(&text, &["does not run"]);
    assert!(!text.contains("phantom"), "{text}");
}

#[test]
fn the_rule_for_udev_is_printed_by_itself() {
    let place = Place::new();
    let rule = place.text(&["device", "list", "--udev"]);
    has(
        &rule,
        &["\"*:056A:*\"", "\"*:256F:*\"", "16c0", "TAG+=\"uaccess\""],
    );
    for line in rule.lines().filter(|line| !line.is_empty()) {
        let is_rule = line.starts_with("SUBSYSTEM==") || line.starts_with('#');
        assert!(is_rule, "udev would stumble over: {line}");
    }
    let output = place.run(&["device", "list", "--udev", "--json"]);
    assert_eq!(output.status.code(), Some(2));
}

/// The row of a device of the rig, once it describes itself so.
fn row(place: &Place, name: &str, is_so: impl Fn(&Value) -> bool) -> Value {
    let found = wait_for(PATIENCE, || {
        let rig = devices(place)["rig"].clone();
        let row = rig.as_array()?.iter().find(|row| row["name"] == name)?;
        is_so(row).then(|| row.clone())
    });
    assert!(found.is_some(), "no such {name}: {}", devices(place)["rig"]);
    found.unwrap_or_default()
}

fn refused(place: &Place, args: &[&str]) -> String {
    let output = place.run(args);
    assert_ne!(output.status.code(), Some(0), "{args:?}");
    String::from_utf8(output.stderr).expect("UTF-8")
}

/// Adds a device that nobody plugged in.
fn add_absent_arm(place: &Place) {
    let add = ["device", "add", "arm", "--driver", "polhem"];
    let add = [&add[..], &["--address", "/dev/none"]].concat();
    place.done(&add);
    row(place, "arm", |row| {
        let trouble = row["trouble"].as_str();
        let is_told = trouble.is_some_and(|told| told.contains("/dev/none"));
        is_told && row["driver"] == "polhem"
    });
}

/// Gives the puck another law of force, and the brush before all others.
fn use_puck(place: &Place) {
    place.done(&["device", "use", "puck", "--force", "rigid"]);
    row(place, "puck", |row| {
        row["brush"] == "main" && row["priority"] == 1 && row["force"] == "rigid"
    });
}

/// Calls the puck by another name: it is as it was, and its force is as off as it was.
fn call_it_cup(place: &Place) {
    let off = ["device", "force", "off", "--device", "puck"];
    has(&place.text(&off), &["force off"]);
    place.done(&["device", "rename", "puck", "cup"]);
    row(place, "cup", |row| {
        row["priority"] == 1 && row["force"] == "rigid" && row["is_there"] == true
    });
    let listed = devices(place)["rig"].to_string();
    assert!(!listed.contains("puck"), "{listed}");
    let strength = ["device", "force", "strength", "100%", "--device", "cup"];
    has(&place.text(&strength), &["cup: force off"]);
}

/// Names that others have are refused, and nothing changes.
fn refuse_taken_names(place: &Place) {
    for (name, words) in [
        ("arm", "a device called 'arm' already"),
        ("paint", "something called 'paint'"),
    ] {
        has(
            &refused(place, &["device", "rename", "cup", name]),
            &[words],
        );
    }
    row(place, "cup", |row| row["is_own"] == true);
}

#[test]
fn devices_come_change_and_go_while_the_rig_runs() {
    let place = Place::new();
    // While no rig runs it is kept for the next one.
    place.done(&["device", "add", "puck", "--driver", "simulated"]);
    let launcher = Launcher::up(&place, &[]);
    row(&place, "puck", |row| {
        row["driver"] == "simulated" && row["priority"] == 0
    });
    add_absent_arm(&place);
    use_puck(&place);
    call_it_cup(&place);
    refuse_taken_names(&place);
    place.done(&["device", "rename", "cup", "puck"]);
    row(&place, "puck", |row| row["priority"] == 1);

    place.done(&["device", "remove", "arm"]);
    let listed = devices(&place)["rig"].to_string();
    assert!(!listed.contains("\"arm\""), "{listed}");
    place.done(&["device", "remove", "puck"]);
    let gone = wait_for(PATIENCE, || {
        place.pid("maulstick-haptic").is_none().then_some(())
    });
    assert!(gone.is_some(), "{}", launcher.said());
    let add = ["device", "add", "puck", "--driver", "simulated"];
    let last = [&add[..], &["--priority", "-3"]].concat();
    place.done(&last);
    row(&place, "puck", |row| row["priority"] == -3);
}

#[test]
fn what_does_not_fit_changes_nothing() {
    let place = Place::new();
    place.done(&["device", "add", "puck", "--driver", "simulated"]);
    for (args, what) in [
        (
            vec!["device", "add", "puck", "--driver", "pen"],
            vec!["a device called 'puck' already"],
        ),
        (
            vec!["device", "add", "x", "--driver", "simulted"],
            vec!["'simulted'", "did you mean 'simulated'"],
        ),
        (
            vec!["device", "add", "pen", "--driver", "pen"],
            vec!["something called 'pen'"],
        ),
        (
            vec!["device", "use", "puk"],
            vec!["no device called 'puk'", "'puck'"],
        ),
        (
            vec!["device", "use", "puck", "--force", "soft"],
            vec!["soft", "rigid"],
        ),
        (
            vec!["device", "remove", "puk"],
            vec!["no device called 'puk'", "'puck'"],
        ),
        (
            vec!["device", "rename", "puk", "cup"],
            vec!["no device called 'puk'", "'puck'"],
        ),
        (
            vec!["device", "rename", "puck", "my cup"],
            vec!["'my cup' is not 1 to 32 letters"],
        ),
    ] {
        has(&refused(&place, &args), &what);
    }
    place.done(&["device", "remove", "puck"]);
}
