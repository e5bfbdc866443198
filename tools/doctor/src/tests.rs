//! Seeded faults: a machine in order, with one fault at a time.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use maulstick_bus::BusError;
use maulstick_gpu::{AdapterReport, GpuError};
use maulstick_rig::UserError;
use serde_json::json;

use maulstick_device_setup::attached::{Attached, Permission};

use super::facts::{Clock, Disk, Display, Facts, Governor, Graphics, RealTime, clock, governors};
use super::in_words;
use super::judge::{Finding, State, judge};

const GB: u64 = 1 << 30;

fn adapter(name: &str, is_emulated: bool) -> AdapterReport {
    AdapterReport {
        name: name.into(),
        backend: "Vulkan".into(),
        driver: "radv Mesa 25.0".into(),
        is_emulated,
    }
}

fn pen(permission: Permission) -> Attached {
    Attached {
        name: "A pen".into(),
        id: "056a:0374".into(),
        path: "/dev/hidraw3".into(),
        driver: Some("pen"),
        permission,
        missing: None,
    }
}

fn governor(driver: &str, name: &str) -> Governor {
    Governor {
        driver: driver.into(),
        name: name.into(),
    }
}

/// A machine on which all is right.
fn right() -> Facts {
    Facts {
        graphics: Graphics {
            adapters: vec![adapter("RX 7600", false), adapter("llvmpipe", true)],
            paint: Ok("RX 7600".into()),
            denied: Vec::new(),
        },
        real_time: RealTime {
            refusal: None,
            limit: 99,
        },
        lockable: None,
        devices: vec![pen(Permission::Granted)],
        clock: Some(Clock {
            current: "tsc".into(),
            available: "tsc hpet acpi_pm".into(),
        }),
        governors: BTreeSet::from([governor("intel_pstate", "powersave")]),
        disks: vec![Disk {
            folder: "/home/a".into(),
            free: 100 * GB,
        }],
        shared: Some(4 * GB),
        sockets: Ok(PathBuf::from("/run/user/1000/maulstick")),
        display: Display {
            server: Some("Wayland"),
            tells_of_pens: Ok(true),
        },
    }
}

/// The one finding of a seeded fault, with these words.
fn check(seed: impl FnOnce(&mut Facts), name: &str, state: State, words: &[&str]) {
    let mut facts = right();
    seed(&mut facts);
    let findings = judge(&facts);
    let wrong: Vec<&Finding> = findings
        .iter()
        .filter(|finding| finding.state != State::Ok)
        .collect();
    let [finding] = wrong.as_slice() else {
        panic!("{name}: {wrong:?}");
    };
    assert_eq!((finding.check, finding.state), (name, state), "{finding:?}");
    let mend = finding.mend.as_deref().expect("what to do");
    let said = format!("{} {mend}", finding.what);
    for word in words {
        assert!(said.contains(word), "'{word}' is missing in: {said}");
    }
}

#[test]
fn a_machine_that_is_right_has_nothing_to_mend() {
    let findings = judge(&right());
    assert_eq!(findings.len(), 10, "{findings:?}");
    for finding in findings {
        assert_eq!(
            (finding.state, &finding.mend),
            (State::Ok, &None),
            "{finding:?}"
        );
    }
}

#[test]
fn graphics() {
    let (warning, wrong) = (State::Warning, State::Wrong);
    check(
        |facts| facts.graphics.adapters.clear(),
        "graphics",
        wrong,
        &["cannot open", "mesa-vulkan-drivers"],
    );
    check(
        |facts| drop(facts.graphics.adapters.remove(0)),
        "graphics",
        warning,
        &["llvmpipe", "software", "install the driver"],
    );
    check(
        |facts| {
            facts.graphics.adapters.remove(0);
            facts.graphics.denied = vec!["/dev/dri/renderD128".into()];
        },
        "graphics",
        warning,
        &["renderD128", "usermod -aG render"],
    );
    check(
        |facts| facts.graphics.paint = Err(GpuError::None("too old".into())),
        "graphics",
        warning,
        &["RX 7600", "processor computes the paint", "too old"],
    );
}

#[test]
fn display_and_sockets() {
    check(
        |facts| facts.display.server = None,
        "display",
        State::Warning,
        &["DISPLAY", "--headless"],
    );
    check(
        |facts| facts.display.tells_of_pens = Ok(false),
        "display",
        State::Warning,
        &["mouse", "device add"],
    );
    check(
        |facts| {
            let error = UserError::failure("no X server answers").help("start it elsewhere");
            facts.display.tells_of_pens = Err(error);
        },
        "display",
        State::Wrong,
        &["no X server", "cannot open", "elsewhere"],
    );
    check(
        |facts| {
            facts.sockets = Err(BusError::Folder {
                reason: "/tmp/x is not a folder of yours alone".into(),
                help: "set XDG_RUNTIME_DIR".into(),
            });
        },
        "sockets",
        State::Wrong,
        &["/tmp/x", "XDG_RUNTIME_DIR"],
    );
}

#[test]
fn room() {
    for (free, state) in [(GB, State::Warning), (GB / 20, State::Wrong)] {
        let words = ["/home/a", "du -xh"];
        check(|facts| facts.disks[0].free = free, "disk", state, &words);
    }
    for shared in [None, Some(GB / 1024)] {
        check(
            |facts| facts.shared = shared,
            "shared memory",
            State::Warning,
            &["/dev/shm", "sudo mount"],
        );
    }
}

#[test]
fn rights() {
    let warning = State::Warning;
    check(
        |facts| facts.devices.push(pen(Permission::Denied)),
        "device",
        warning,
        &["/dev/hidraw3", "maulstick device allow"],
    );
    check(
        |facts| {
            facts.devices.push(Attached {
                driver: Some("openhaptics"),
                ..pen(Permission::Denied)
            });
        },
        "device",
        warning,
        &["dialout"],
    );
    check(
        |facts| facts.devices.push(pen(Permission::Absent)),
        "device",
        warning,
        &["no node"],
    );
    let refuse = |limit: u64| {
        move |facts: &mut Facts| {
            facts.real_time = RealTime {
                refusal: Some("EPERM".into()),
                limit,
            };
        }
    };
    check(refuse(0), "real time", warning, &["EPERM", "rtprio 99"]);
    check(refuse(99), "real time", warning, &["SYS_NICE"]);
    check(
        |facts| facts.lockable = Some(GB / 128),
        "locked memory",
        warning,
        &["8 MB", "swapped", "memlock unlimited"],
    );
    check(
        |facts| facts.lockable = Some(GB / 16_384),
        "locked memory",
        warning,
        &["pictures take longer"],
    );
}

#[test]
fn clocks_and_processors() {
    let warning = State::Warning;
    let slow = |current: &str, available: &str| {
        let clock = Clock {
            current: current.into(),
            available: available.into(),
        };
        move |facts: &mut Facts| facts.clock = Some(clock)
    };
    let mend = ["hpet", "echo tsc | sudo tee /sys"];
    check(slow("hpet", "tsc hpet"), "clock", warning, &mend);
    check(slow("acpi_pm", "acpi_pm"), "clock", warning, &["dmesg"]);
    check(
        |facts| {
            let slow = governor("acpi-cpufreq", "powersave");
            facts.governors.insert(slow);
        },
        "processor",
        warning,
        &["lowest speed", "echo performance"],
    );
    // A machine that reports neither is in order.
    let mut facts = right();
    facts.clock = None;
    facts.governors.clear();
    assert!(
        judge(&facts)
            .iter()
            .all(|finding| finding.state == State::Ok)
    );
}

#[test]
fn what_the_kernel_tells_is_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        std::fs::write(path, text).expect("written");
    };
    assert!(clock(folder.path()).is_none());
    write("current_clocksource", "hpet\n");
    write("available_clocksource", "tsc hpet \n");
    let found = clock(folder.path()).expect("a clock");
    assert_eq!(
        (found.current.as_str(), found.available.as_str()),
        ("hpet", "tsc hpet")
    );
    for cpu in ["cpu0", "cpu1"] {
        write(&format!("{cpu}/cpufreq/scaling_governor"), "schedutil\n");
        write(&format!("{cpu}/cpufreq/scaling_driver"), "acpi-cpufreq\n");
    }
    let expected = BTreeSet::from([governor("acpi-cpufreq", "schedutil")]);
    assert_eq!(governors(folder.path()), expected);
    assert!(governors(Path::new("/none")).is_empty());
}

#[test]
fn a_line_says_what_is_found_and_the_next_what_mends_it() {
    let mut facts = right();
    facts.devices = vec![pen(Permission::Denied)];
    let findings: Vec<Finding> = judge(&facts)
        .into_iter()
        .filter(|finding| finding.check == "device")
        .collect();
    assert_eq!(
        in_words(&findings),
        "\
warning  device         A pen at /dev/hidraw3 is not open to you
                        mend: maulstick device allow
"
    );
    assert_eq!(json!(findings)[0]["state"], "warning");
}
