//! Verdicts about a machine.

use maulstick_haptic::servo::servo_thread::PRIORITY;
use serde::Serialize;

use maulstick_device_setup::attached::{Attached, Permission};

use super::facts::{CLOCK, Clock, Disk, Display, Facts, Graphics, RealTime};

const MB: u64 = 1 << 20;
/// Lockable memory needed for pictures to reach the window without the socket, bytes; and free memory needed.
const SHARED: u64 = 8 * MB;
/// Free disk space below which painting ends soon, and below which saving fails, bytes.
const LITTLE: u64 = 2048 * MB;
const NONE: u64 = 100 * MB;
/// File of users' limits.
const LIMITS: &str = "/etc/security/limits.d/maulstick.conf";

/// Verdict of a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum State {
    /// It is.
    Ok,
    /// A part of the rig works less well.
    Warning,
    /// The rig does not work.
    Wrong,
}

/// Result of a check.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Finding {
    /// Subject of the check.
    pub check: &'static str,
    /// Its outcome.
    pub state: State,
    /// The observation and its meaning.
    pub what: String,
    /// Remedy: a command, or instructions.
    pub mend: Option<String>,
}

impl Finding {
    fn ok(check: &'static str, what: impl Into<String>) -> Self {
        Self {
            check,
            state: State::Ok,
            what: what.into(),
            mend: None,
        }
    }

    fn warning(check: &'static str, what: impl Into<String>, mend: impl Into<String>) -> Self {
        Self {
            state: State::Warning,
            mend: Some(mend.into()),
            ..Self::ok(check, what)
        }
    }

    fn wrong(self) -> Self {
        Self {
            state: State::Wrong,
            ..self
        }
    }
}

/// All findings of a machine.
pub(super) fn judge(facts: &Facts) -> Vec<Finding> {
    let mut findings = vec![
        graphics(&facts.graphics),
        display(&facts.display),
        sockets(facts),
    ];
    findings.extend(facts.disks.iter().map(disk));
    findings.push(shared_memory(facts.shared));
    findings.extend(devices(&facts.devices));
    findings.push(real_time(&facts.real_time));
    findings.push(locked_memory(facts.lockable));
    findings.extend(facts.clock.as_ref().map(clock));
    findings.extend(processor(facts));
    findings
}

fn graphics(graphics: &Graphics) -> Finding {
    const CHECK: &str = "graphics";
    let driver = "install the driver of your graphics card; of AMD and Intel: sudo apt install mesa-vulkan-drivers";
    let Some(adapter) = graphics.adapters.first() else {
        return Finding::warning(
            CHECK,
            "no Vulkan or OpenGL driver: the window cannot open",
            "sudo apt install mesa-vulkan-drivers",
        )
        .wrong();
    };
    let name = format!("{} ({}, {})", adapter.name, adapter.backend, adapter.driver);
    if adapter.is_emulated {
        let what = format!("{name} is software: the processor draws the window, slowly");
        let node = graphics.denied.first();
        return match node {
            Some(node) => Finding::warning(
                CHECK,
                format!("{what}; {} is not open to you", node.display()),
                "sudo usermod -aG render $USER, then log in again",
            ),
            None => Finding::warning(CHECK, what, driver),
        };
    }
    match &graphics.paint {
        Ok(paint) => Finding::ok(
            CHECK,
            if *paint == adapter.name {
                format!("{name} draws the window and computes the paint")
            } else {
                format!("{name} draws the window, {paint} computes the paint")
            },
        ),
        Err(error) => Finding::warning(
            CHECK,
            format!("{name} draws the window, the processor computes the paint: {error}"),
            driver,
        ),
    }
}

fn display(display: &Display) -> Finding {
    const CHECK: &str = "display";
    match (display.server, &display.tells_of_pens) {
        (None, _) => Finding::warning(
            CHECK,
            "neither WAYLAND_DISPLAY nor DISPLAY is set: the window cannot open",
            "start it from a terminal of a graphical session, or without a window: maulstick up --headless",
        ),
        (Some(server), Ok(true)) => Finding::ok(CHECK, format!("{server} reports pens")),
        (Some(server), Ok(false)) => Finding::warning(
            CHECK,
            format!("{server} does not report pens: a pen paints like a mouse"),
            "give its tablet to the rig: maulstick device add",
        ),
        (Some(_), Err(error)) => Finding::warning(
            CHECK,
            format!("{}: the window cannot open", error.what),
            error.help.clone().unwrap_or_default(),
        )
        .wrong(),
    }
}

fn sockets(facts: &Facts) -> Finding {
    const CHECK: &str = "sockets";
    match &facts.sockets {
        Ok(folder) => Finding::ok(CHECK, format!("rigs meet in {}", folder.display())),
        Err(error) => {
            let error = maulstick_rig::UserError::from(error.clone());
            Finding::warning(CHECK, error.what, error.help.unwrap_or_default()).wrong()
        }
    }
}

fn disk(disk: &Disk) -> Finding {
    const CHECK: &str = "disk";
    let folder = disk.folder.display();
    let what = format!("{} MB free in {folder}", disk.free / MB);
    let mend = format!("free some space; what fills it: du -xh -d1 {folder} | sort -h");
    match disk.free {
        ..NONE => Finding::warning(CHECK, format!("{what}: saving will fail"), mend).wrong(),
        NONE..LITTLE => Finding::warning(
            CHECK,
            format!("{what}: little for recordings and large paintings"),
            mend,
        ),
        _ => Finding::ok(CHECK, what),
    }
}

fn shared_memory(free: Option<u64>) -> Finding {
    const CHECK: &str = "shared memory";
    let slow = "pictures take longer to the window, through its socket";
    match free {
        None => Finding::warning(
            CHECK,
            format!("there is no /dev/shm: {slow}"),
            "sudo mount -t tmpfs tmpfs /dev/shm",
        ),
        Some(free) if free < SHARED => Finding::warning(
            CHECK,
            format!("{} MB free in /dev/shm: {slow}", free / MB),
            "sudo mount -o remount,size=256m /dev/shm; in a container: --shm-size=256m",
        ),
        Some(free) => Finding::ok(CHECK, format!("{} MB free in /dev/shm", free / MB)),
    }
}

fn devices(devices: &[Attached]) -> Vec<Finding> {
    const CHECK: &str = "device";
    if devices.is_empty() {
        let what = "nothing attached that a driver fits: pens over the window and the mouse paint";
        return vec![Finding::ok(CHECK, what)];
    }
    let finding = |device: &Attached| {
        let name = format!("{} at {}", device.name, device.path.display());
        match (device.permission, device.driver) {
            (Permission::Granted, _) => Finding::ok(CHECK, format!("{name} is open to you")),
            (Permission::Denied, Some("openhaptics")) => Finding::warning(
                CHECK,
                format!("{name} is not open to you"),
                "sudo usermod -aG dialout $USER, then log in again",
            ),
            (Permission::Denied, _) => Finding::warning(
                CHECK,
                format!("{name} is not open to you"),
                "maulstick device allow",
            ),
            (Permission::Absent, _) => Finding::warning(
                CHECK,
                format!("{name} has no node"),
                "let this container have /dev of the machine: docker run -v /dev:/dev",
            ),
        }
    };
    devices.iter().map(finding).collect()
}

fn real_time(rights: &RealTime) -> Finding {
    const CHECK: &str = "real time";
    let Some(refusal) = &rights.refusal else {
        return Finding::ok(
            CHECK,
            "the servo of force feedback may go first (SCHED_FIFO)",
        );
    };
    let what = format!("the servo of force feedback may not go first, and stutters ({refusal})");
    if rights.limit >= u64::from(PRIORITY) {
        Finding::warning(
            CHECK,
            format!("{what}, though the limit of rtprio is {}", rights.limit),
            "let this container set priorities: docker run --cap-add SYS_NICE",
        )
    } else {
        Finding::warning(
            CHECK,
            what,
            format!("echo \"$USER - rtprio 99\" | sudo tee -a {LIMITS}, then log in again"),
        )
    }
}

fn locked_memory(lockable: Option<u64>) -> Finding {
    const CHECK: &str = "locked memory";
    let Some(bytes) = lockable else {
        return Finding::ok(CHECK, "any memory may be locked");
    };
    let mut what = format!(
        "{} MB may be locked: memory of the servo of force feedback may be swapped out",
        bytes / MB
    );
    if bytes < SHARED {
        what += ", and pictures take longer to the window";
    }
    Finding::warning(
        CHECK,
        what,
        format!("echo \"$USER - memlock unlimited\" | sudo tee -a {LIMITS}, then log in again"),
    )
}

fn clock(clock: &Clock) -> Finding {
    const CHECK: &str = "clock";
    let Clock { current, available } = clock;
    if !["hpet", "acpi_pm", "jiffies", "refined-jiffies"].contains(&current.as_str()) {
        return Finding::ok(CHECK, format!("time is read from {current}"));
    }
    let what = format!(
        "time is read from {current}, which is slow: all streams and the servo wait for it"
    );
    let has_tsc = available.split_whitespace().any(|name| name == "tsc");
    let mend = if has_tsc {
        format!("echo tsc | sudo tee {CLOCK}/current_clocksource")
    } else {
        "see why the kernel gave up the processor's own clock: sudo dmesg | grep -i tsc".into()
    };
    Finding::warning(CHECK, what, mend)
}

fn processor(facts: &Facts) -> Option<Finding> {
    const CHECK: &str = "processor";
    // These two drivers take powersave as a bound, within which the processor itself chooses.
    let is_slow = |driver: &str, name: &str| {
        name == "powersave" && !["intel_pstate", "amd-pstate-epp"].contains(&driver)
    };
    let all = &facts.governors;
    if let Some(slow) = all.iter().find(|own| is_slow(&own.driver, &own.name)) {
        return Some(Finding::warning(
            CHECK,
            format!("the governor {} keeps it at its lowest speed", slow.name),
            "echo performance | sudo tee /sys/devices/system/cpu/cpu*/cpufreq/scaling_governor",
        ));
    }
    let names: Vec<&str> = all.iter().map(|own| own.name.as_str()).collect();
    (!names.is_empty()).then(|| Finding::ok(CHECK, format!("governor {}", names.join(", "))))
}
