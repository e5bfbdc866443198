//! `maulstick device` as its users call it: beside the devices of this machine, whatever they are, those of a rig, which come
//! and go while it runs.

#[path = "../support/mod.rs"]
mod support;

use serde_json::Value;
use support::{Launcher, PATIENCE, Place, has, wait_for};

/// What it prints as JSON.
fn devices(place: &Place) -> Value {
    let said = place.done(&["device", "list", "--json"]).stdout;
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
        let text = String::from_utf8(place.done(&["device", "list"]).stdout).expect("UTF-8");
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
    let text = String::from_utf8(place.done(&["device", "list", "--name", "other"]).stdout)
        .expect("UTF-8");
    has(&text, &["does not run"]);
    assert!(!text.contains("phantom"), "{text}");
}

#[test]
fn the_rule_for_udev_is_printed_by_itself() {
    let place = Place::new();
    let rule = String::from_utf8(place.done(&["device", "list", "--udev"]).stdout).expect("UTF-8");
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

#[test]
fn devices_come_change_and_go_while_the_rig_runs() {
    let place = Place::new();
    let said = |args: &[&str]| String::from_utf8(place.done(args).stdout).expect("UTF-8");
    let kept = said(&["device", "add", "puck", "--driver", "simulated"]);
    has(
        &kept,
        &[
            "'puck' (simulated) is kept in",
            "devices.toml",
            "maulstick up",
        ],
    );
    let launcher = Launcher::up(&place, &[]);
    row(&place, "puck", |row| {
        row["driver"] == "simulated" && row["priority"] == 0
    });
    // Another one beside it, which nobody plugged in.
    let args = [
        "device",
        "add",
        "arm",
        "--driver",
        "polhem",
        "--address",
        "/dev/none",
    ];
    has(&said(&args), &["'arm' (polhem)", "device 'arm' starts"]);
    row(&place, "arm", |row| {
        row["trouble"]
            .as_str()
            .is_some_and(|told| told.contains("/dev/none"))
    });
    // With another law of force, and before all others.
    let used = said(&["device", "use", "puck", "--force", "rigid"]);
    has(
        &used,
        &["'puck' moves 'main' with priority 1; its force is rigid"],
    );
    row(&place, "puck", |row| row["priority"] == 1);
    // By another name, as it is, and with its force as off as it was.
    has(
        &said(&["device", "force", "off", "--device", "puck"]),
        &["force off"],
    );
    has(
        &said(&["device", "rename", "puck", "cup"]),
        &["'puck' is called 'cup' now"],
    );
    row(&place, "cup", |row| {
        row["priority"] == 1 && row["force"] == "rigid" && row["is_there"] == true
    });
    let listed = devices(&place)["rig"].to_string();
    assert!(!listed.contains("puck"), "{listed}");
    has(
        &said(&["device", "force", "strength", "100%", "--device", "cup"]),
        &["cup: force off"],
    );
    // Nothing of what is refused changes anything.
    has(
        &refused(&place, &["device", "rename", "cup", "arm"]),
        &["a device called 'arm' already"],
    );
    has(
        &refused(&place, &["device", "rename", "cup", "paint"]),
        &["something called 'paint'"],
    );
    row(&place, "cup", |row| row["is_own"] == true);
    has(&said(&["device", "rename", "cup", "puck"]), &["'puck' now"]);
    row(&place, "puck", |row| row["priority"] == 1);
    has(
        &said(&["device", "remove", "arm"]),
        &["kept no more", "has left the rig"],
    );
    has(&said(&["device", "remove", "puck"]), &["has left the rig"]);
    let gone = wait_for(PATIENCE, || {
        place.pid("maulstick-haptic").is_none().then_some(())
    });
    assert!(gone.is_some(), "{}", launcher.said());
    has(
        &said(&[
            "device",
            "add",
            "puck",
            "--driver",
            "simulated",
            "--priority",
            "-3",
        ]),
        &["device 'puck' starts"],
    );
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
