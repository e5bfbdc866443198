//! Memory of the window with a painted canvas of 4096² cells, above that of a window with hardly any
//! canvas, as fine as it may be shown.

use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::time::{Duration, Instant};

use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus, Dial, Qos, Queue, RigClock, Wake, ZenohBus};
use maulstick_painting::edits::{Fill, FillPaint, Place};
use maulstick_rig::UserError;
use maulstick_rig::command_client::CommandClient;
use maulstick_types::Edit;
use maulstick_types::scene::{CANVAS, Scene, Surface};
use maulstick_types::values::FilmThickness;
use maulstick_types::wire::topics::Topics;

use crate::report::Report;
use crate::running::{Running, display, fault, joined, maulstick};

/// Sides of the two canvases, mm: of 64 and of 4096 cells.
const SIDES_MM: [u32; 2] = [16, 1024];
/// Pixels of the screen.
const SCREEN: [u32; 2] = [1280, 1024];
/// Zooms that are shown one after the other: the whole canvas, then ever finer levels of it.
const ZOOMS: [f64; 4] = [1.0, 2.0, 4.0, 8.0];
/// Change of memory below which it counts as settled, bytes, and its duration.
const STEADY_BYTES: u64 = 1 << 20;
const STEADY: Duration = Duration::from_secs(3);
const PATIENCE: Duration = Duration::from_secs(120);

/// The window's process of the rig in a folder.
fn window_of(folder: &Path) -> Option<u32> {
    let mark = folder.display().to_string();
    std::fs::read_dir("/proc")
        .ok()?
        .flatten()
        .find_map(|entry| {
            let pid = entry.file_name().to_string_lossy().parse().ok()?;
            let line = std::fs::read(entry.path().join("cmdline")).ok()?;
            let line = String::from_utf8_lossy(&line).replace('\0', " ");
            let program = line.split(' ').next()?;
            (program.ends_with("maulstick-ui") && line.contains(&mark)).then_some(pid)
        })
}

/// Resident memory, bytes.
fn resident(pid: u32) -> Result<u64, UserError> {
    let status = std::fs::read_to_string(format!("/proc/{pid}/status")).map_err(fault)?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    let kib = line.and_then(|line| line.trim().trim_end_matches(" kB").parse::<u64>().ok());
    Ok(kib.ok_or_else(|| fault("no VmRSS"))? * 1024)
}

/// Memory is looked at so often.
const LOOK: Duration = Duration::from_millis(100);

/// Resident memory once it has settled, which nothing announces.
fn settled(pid: u32) -> Result<u64, UserError> {
    let give_up = Instant::now() + PATIENCE;
    let (mut last, mut since) = (resident(pid)?, Instant::now());
    while since.elapsed() < STEADY {
        if Instant::now() > give_up {
            return Err(fault("the window's memory does not settle"));
        }
        std::thread::sleep(LOOK);
        let now = resident(pid)?;
        if now.abs_diff(last) > STEADY_BYTES {
            (last, since) = (now, Instant::now());
        }
    }
    resident(pid)
}

/// The canvas of a rig whose window has come.
fn canvas_of(bus: &ZenohBus, topics: &Topics) -> Result<Surface, UserError> {
    let wake = Wake::new();
    let token = bus.watch(&topics.node("ui"), &wake)?;
    let mut scenes =
        Receiver::<Scene>::new(bus, &topics.scene(), Qos::Cached, Queue::Ring(16), &wake)?;
    let mut canvas: Option<Surface> = None;
    let give_up = Instant::now() + PATIENCE;
    let mut is_there = false;
    while (!is_there || canvas.is_none()) && Instant::now() < give_up {
        wake.wait(Duration::from_millis(50));
        is_there |= token.try_recv().is_some();
        if let Some(scene) = scenes.newest() {
            let mut surfaces = scene.message.surfaces.into_iter();
            canvas = surfaces.find(|surface| surface.id == CANVAS);
        }
    }
    canvas.ok_or_else(|| fault("no canvas"))
}

/// Memory of a window at each zoom.
fn measured(side_mm: u32, zooms: &[f64], display: &str) -> Result<Vec<u64>, UserError> {
    let place = tempfile::tempdir().map_err(fault)?;
    let rig = place.path().join("rig.toml");
    let settings = format!("[canvas]\nwidth_mm = {side_mm}\nheight_mm = {side_mm}\n");
    std::fs::write(&rig, settings).map_err(fault)?;
    let log = std::fs::File::create(place.path().join("log")).map_err(fault)?;
    let mut up = Command::new(maulstick()?);
    up.args(["up", "--name", "window", "--rig"])
        .arg(&rig)
        .current_dir(place.path())
        .env("XDG_RUNTIME_DIR", place.path())
        .env("XDG_STATE_HOME", place.path().join("state"))
        .env("DISPLAY", display)
        .env_remove("WAYLAND_DISPLAY")
        .stdout(Stdio::null())
        .stderr(log);
    let _up = Running::begin(&mut up)?;
    let give_up = Instant::now() + Duration::from_secs(30);
    let (folder, info) = joined(&place.path().join("maulstick/window"), give_up)?;
    let dial = Dial {
        name: "bench".into(),
        listen: None,
        connect: vec![info.endpoint.clone()],
    };
    let clock = RigClock::with_offset(info.clock_offset_ns);
    let bus = Arc::new(ZenohBus::open(&dial, clock)?);
    let topics = Topics::new("window");
    let canvas = canvas_of(&bus, &topics)?;
    let mut commands = CommandClient::of(Arc::clone(&bus) as Arc<dyn Bus>, &topics, "paint");
    let mut send = |edit: Edit| commands.send(edit, None, PATIENCE, &|| false);
    let mixture = "Ultramarine Blue=0.5,Titanium White=0.5"
        .parse()
        .map_err(fault)?;
    let fill = Fill {
        paint: FillPaint::Mixture { mixture },
        thickness: FilmThickness::new(5e-5)?,
        surface: CANVAS,
    };
    send(fill.into())?;
    let pid = window_of(folder.path()).ok_or_else(|| fault("no window"))?;
    let mut all = Vec::new();
    for zoom in zooms {
        let mut pose = canvas.pose.clone();
        let half = 0.5 * zoom * canvas.cell_m;
        for (at, cells) in pose.position_m.iter_mut().zip(canvas.cells) {
            *at = -half * f64::from(cells);
        }
        send(Place::new(CANVAS, pose, *zoom)?.into())?;
        all.push(settled(pid)?);
    }
    bus.close();
    Ok(all)
}

/// Measures and reports.
pub(crate) fn run(report: &mut Report) -> Result<(), UserError> {
    let (_server, name) = display(SCREEN)?;
    let [small, large] = SIDES_MM;
    let empty = measured(small, &ZOOMS[..1], &name)?[0];
    let all = measured(large, &ZOOMS, &name)?;
    let mib = |bytes: u64| bytes as f64 / f64::from(1 << 20);
    report.row("view.empty", mib(empty), "MiB");
    for (zoom, bytes) in ZOOMS.iter().zip(&all) {
        let name = format!("view.memory.zoom{zoom}");
        report.row(&name, mib(bytes.saturating_sub(empty)), "MiB");
    }
    Ok(())
}
