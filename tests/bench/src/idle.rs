//! Load of an idle rig on a core: its window with the pointer at rest over the canvas, and the other processes.

use std::path::Path;
use std::process::Command;
use std::thread;
use std::time::{Duration, Instant};

use maulstick_rig::UserError;
use nix::time::{ClockId, clock_gettime};
use nix::unistd::Pid;

use crate::report::Report;
use crate::running::{Running, display, fault, joined, maulstick};

/// Width and height of the window, pixels.
const SIZE: [u32; 2] = [1280, 800];
/// Time after the start until all is drawn and settled: nothing signals that a window has finished drawing, and a
/// shorter time would show in the figures.
const SETTLES: Duration = Duration::from_secs(8);
/// Time over which is measured: two of the looks that a window at rest takes.
const MEASURED: Duration = Duration::from_secs(120);
/// Targets, shares of a core: of the window, and of all processes beside it.
const WINDOW_SHARE: f64 = 0.01;
const OTHERS_SHARE: f64 = 0.03;
/// Program of the window, as the system shows it, which keeps fifteen letters of a name.
const WINDOW: &str = "maulstick-ui";

/// Measures and reports.
pub(crate) fn run(report: &mut Report) -> Result<(), UserError> {
    let place = tempfile::tempdir().map_err(fault)?;
    let (_server, screen) = display(SIZE)?;
    let mut command = Command::new(maulstick()?);
    command
        .args(["up", "--name", "idle"])
        .current_dir(place.path())
        .env("DISPLAY", screen)
        .env("XDG_RUNTIME_DIR", place.path())
        .env("XDG_CONFIG_HOME", place.path().join("config"))
        .env("XDG_STATE_HOME", place.path().join("state"));
    let mut rig = Running::start(&mut command)?;
    let folder = place.path().join("maulstick/idle");
    joined(&folder, Instant::now() + Duration::from_secs(30))?;
    thread::sleep(SETTLES);
    let processes = children(rig.id())?;
    let before = times(&processes);
    thread::sleep(MEASURED);
    let after = times(&processes);
    if rig.has_ended()? {
        return Err(fault("the rig has ended"));
    }
    let share =
        |at: usize| after[at].saturating_sub(before[at]).as_secs_f64() / MEASURED.as_secs_f64();
    let mut others = 0.0;
    let mut window = None;
    for (at, (name, _)) in processes.iter().enumerate() {
        if name == WINDOW {
            window = Some(share(at))
        } else {
            report.row(&format!("idle.{name}"), share(at), "cores");
            others += share(at);
        }
    }
    let window = window.ok_or_else(|| fault("the rig has no window"))?;
    report.beside("idle.window", window, "cores", ("target", WINDOW_SHARE));
    report.beside("idle.others", others, "cores", ("target", OTHERS_SHARE));
    Ok(())
}

/// A process with its children, by the names of their programs.
fn children(parent: u32) -> Result<Vec<(String, Pid)>, UserError> {
    let entries = std::fs::read_dir(Path::new("/proc")).map_err(fault)?;
    let stats = entries.filter_map(|entry| {
        // A process that ends meanwhile is left out.
        std::fs::read_to_string(entry.ok()?.path().join("stat")).ok()
    });
    let own = stats.filter_map(|stat| {
        // pid (name) state parent …
        let (head, rest) = stat.rsplit_once(") ")?;
        let (pid, name) = head.split_once(" (")?;
        let of: u32 = rest.split(' ').nth(1)?.parse().ok()?;
        let pid: i32 = pid.parse().ok()?;
        let is_own = of == parent || u32::try_from(pid) == Ok(parent);
        is_own.then(|| (name.to_owned(), Pid::from_raw(pid)))
    });
    Ok(own.collect())
}

/// Processor time of each; zero for one that has ended.
fn times(processes: &[(String, Pid)]) -> Vec<Duration> {
    let time = |pid: Pid| {
        let clock = ClockId::pid_cpu_clock_id(pid).ok()?;
        clock_gettime(clock).ok().map(Duration::from)
    };
    let times = processes.iter().map(|(_, pid)| time(*pid));
    times.map(Option::unwrap_or_default).collect()
}
