//! The mains of the rig's nodes. The launcher starts them; they can be started by hand too.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use clap::Parser;
use maulstick_bus::RigFolder;
use maulstick_bus::typed::random_epoch;
use maulstick_device::Take;
use maulstick_device::player::{self, PlayerSettings, Rate};
use maulstick_document::{Document, DocumentError};
use maulstick_gpu::{Choice, Device, GpuFilms};
use maulstick_haptic::daemon;
use maulstick_haptic::device::open::HapticSettings;
use maulstick_hid::daemon::HidSettings;
use maulstick_nodes::feel::ForceKind;
use maulstick_nodes::frames::FrameServer;
use maulstick_nodes::worker::Fallen;
use maulstick_nodes::{BrushNode, BrushSettings, PaintNode, Worker};
use maulstick_num::cores::with_help_beyond;
use maulstick_optics::backend::{CpuFilms, FilmBackend};
use maulstick_paint::{PaintRefusal, Painting, Sequencer};
use maulstick_rig::config::{
    DeviceSection, FOREIGN_PRIORITY, MOUSE_PRIORITY, PLAYER_PRIORITY, RigConfig,
};
use maulstick_rig::files::Kind;
use maulstick_rig::log::log_to_stderr;
use maulstick_rig::{Fault, Member, MemberArgs};
use maulstick_types::Mixture;
use nix::sys::prctl::set_pdeathsig;
use nix::sys::signal::Signal;

use crate::backend::choose_backend;
use crate::destination::{VIEW, export};
use crate::document::{go_on, wrong};
use crate::outputs::{UsedFile, check_outputs, named_by};
use crate::performance::{brush_file, library_from, painting_setup, refused};

/// Name of the mouse over the window as a device.
pub const MOUSE: &str = "mouse";
/// What is added to a device's name for what records it.
const RECORDER: &str = "-recorder";
/// A paint node that is to stop takes at most so many turns more: it is waited for.
const LAST_TURNS: u32 = 8;
/// Name of the player as a device.
pub const PLAYER: &str = "player";

/// Options of every node.
#[derive(clap::Args, Clone, Debug)]
struct NodeOptions {
    /// The rig's folder
    #[arg(long, value_name = "FOLDER", conflicts_with = "name")]
    folder: Option<PathBuf>,
    /// The rig's name, for a node that is started by hand
    #[arg(long, value_name = "RIG", default_value = "studio")]
    name: String,
    /// Name of the node in the rig
    #[arg(long, value_name = "NODE")]
    node: Option<String>,
    /// End with the launcher, which holds the standard input open
    #[arg(long, hide = true)]
    guarded: bool,
}

impl NodeOptions {
    /// Joins the rig; when the launcher dies this process gets `orphan`.
    fn join(&self, node: &str, orphan: Signal) -> Result<Member, Fault> {
        log_to_stderr("info");
        if self.guarded {
            let launcher = nix::unistd::getppid();
            set_pdeathsig(orphan).map_err(|error| Fault::failure(error.to_string()))?;
            if nix::unistd::getppid() != launcher {
                return Err(Fault::failure("the launcher is gone"));
            }
        }
        let folder = match &self.folder {
            Some(folder) => folder.clone(),
            None => RigFolder::join(&self.name)?.0.path().to_owned(),
        };
        let node = self.node.clone().unwrap_or_else(|| node.to_owned());
        Member::join(&MemberArgs {
            folder,
            node,
            guarded: self.guarded,
        })
    }
}

/// Follows a stylus with a brush
#[derive(Parser)]
#[command(name = "maulstick-brush", version)]
struct BrushOptions {
    #[command(flatten)]
    node: NodeOptions,
    /// The brush of rig.toml
    #[arg(long, value_name = "BRUSH")]
    brush: String,
}

/// Name of a brush's node.
#[must_use]
pub fn brush_node_name(brush: &str) -> String {
    format!("brush-{brush}")
}

fn brush_settings(config: &RigConfig, brush: &str) -> Result<BrushSettings, Fault> {
    let section = config.brush_named(brush).ok_or_else(|| {
        let what = format!("there is no brush '{brush}' in rig.toml");
        Fault::unknown(
            what,
            brush,
            config.brush.iter().map(|brush| brush.name.as_str()),
        )
    })?;
    let first = config.brush[0].name == brush;
    let mut devices = BTreeMap::from([(PLAYER.to_owned(), PLAYER_PRIORITY)]);
    if first {
        devices.insert(MOUSE.to_owned(), MOUSE_PRIORITY);
    }
    let (mut others, mut laws) = (Vec::new(), BTreeMap::new());
    for device in &config.device {
        if device.brush == brush {
            if let Some(law) = ForceKind::of(&device.force) {
                laws.insert(device.name.clone(), law);
            }
            devices.insert(device.name.clone(), device.priority);
        } else {
            others.push(device.name.clone());
        }
    }
    Ok(BrushSettings {
        name: brush.to_owned(),
        file: brush_file(section)?,
        depth_share: section.depth_share,
        devices,
        laws,
        others,
        foreign_priority: first.then_some(FOREIGN_PRIORITY),
        epoch: random_epoch(),
    })
}

/// Main of the brush node.
///
/// # Errors
/// A [`Fault`].
pub fn brush() -> Result<i32, Fault> {
    let options = BrushOptions::parse();
    let mut member = options
        .node
        .join(&brush_node_name(&options.brush), Signal::SIGKILL)?;
    let settings = brush_settings(&member.config, &options.brush)?;
    let mut node = BrushNode::new(
        Arc::clone(&member.bus),
        &member.topics,
        &member.wake,
        settings,
    )?;
    member.ready()?;
    member.run(|| Ok(node.turn()?))?;
    member.leave();
    Ok(0)
}

/// Paints what the brushes do
#[derive(Parser)]
#[command(name = "maulstick-paint", version)]
struct PaintOptions {
    #[command(flatten)]
    node: NodeOptions,
}

/// Main of the paint node.
///
/// # Errors
/// A [`Fault`].
pub fn paint() -> Result<i32, Fault> {
    let options = PaintOptions::parse();
    let mut member = options.node.join("paint", Signal::SIGKILL)?;
    let (document, mut sequencer, since) = painting(&member.config)?;
    choose_backend(&mut sequencer, &member.config.paint.backend)?;
    let origin = member.origin("paint");
    let bus = Arc::clone(&member.bus);
    let (topics, wake) = (&member.topics, &member.wake);
    let mut node = PaintNode::going_on(Arc::clone(&bus), topics, wake, origin, sequencer)?
        .exporting(export(&member.config.view, VIEW)?);
    let (topic, feed) = (member.topics.frame(), node.feed());
    let mut frames =
        FrameServer::new(bus, &topic, feed.clone(), &member.wake, origin)?.telling_brushes(topics);
    let (memory, _) = member.config.paint.bytes().map_err(Fault::usage)?;
    node = node.with_memory(usize::try_from(memory).unwrap_or(usize::MAX));
    if let Some(document) = document {
        frames = frames.with_shelf(document.shelf());
        node = node.keeping(document, since);
    }
    let stop = member.stop.clone();
    let backend = member.config.paint.backend.clone();
    let run = move || frames.with_films(film_backend(&backend)).run(&stop);
    let mut thread =
        Worker::start("frames", run).map_err(|error| Fault::failure(error.to_string()))?;
    let fallen = |error: Fallen| Fault::failure(error.to_string());
    let mut turn = |node: &mut PaintNode| {
        thread.check().map_err(fallen)?;
        let wait = node.turn()?;
        match (node.fault(), node.document_path()) {
            (Some(what), Some(path)) => Err(wrong(path, &DocumentError::Damaged(what.to_owned()))),
            _ => Ok(wait),
        }
    };
    // Its token says that commands to the rig's brushes and takes of them are done: it has to know
    // their files.
    let run = || {
        wait_for_brushes(&member, &mut node, &mut turn)
            .and_then(|()| member.ready())
            .and_then(|()| member.run(|| turn(&mut node)))
            .and_then(|()| paint_what_has_come(&mut node, &mut turn))
    };
    // The brush, the window and the frames have work for two cores.
    let result = with_help_beyond(2, run);
    member.stop.request();
    feed.ring();
    let ended = thread.join().map_err(fallen);
    let path = node.document_path().map(Path::to_owned);
    let closed = node.close().map_err(|error| match &path {
        Some(path) => wrong(path, &error),
        None => Fault::failure(error.to_string()),
    });
    member.leave();
    result.and(ended).and(closed).map(|()| 0)
}

/// Has the node take turns until it has painted what had come when it was to stop.
fn paint_what_has_come(
    node: &mut PaintNode,
    turn: &mut impl FnMut(&mut PaintNode) -> Result<Duration, Fault>,
) -> Result<(), Fault> {
    let mut left = LAST_TURNS;
    while left > 0 && turn(node)?.is_zero() {
        left -= 1;
    }
    Ok(())
}

/// The painting that the settings ask for: in its document, or in memory.
fn painting(config: &RigConfig) -> Result<(Option<Document>, Sequencer, u64), Fault> {
    if let Some(path) = &config.paint.document {
        let (document, sequencer, since) = go_on(config, path)?;
        return Ok((Some(document), sequencer, since));
    }
    let library = library_from(config.paint.paints.as_deref())?;
    let setup = painting_setup(config, &library)?;
    let mut sequencer = Sequencer::new(Painting::new(&setup, library).map_err(refused)?);
    sequencer.decide("backend cpu");
    Ok((None, sequencer, 0))
}

/// What computes the colours of frames, as rig.toml says: `auto` takes a real GPU, `gpu` any.
fn film_backend(name: &str) -> Box<dyn FilmBackend> {
    let choice = match name {
        "cpu" => return Box::new(CpuFilms::new()),
        "gpu" => Choice::Forced,
        _ => Choice::Auto,
    };
    match Device::open(choice).and_then(GpuFilms::new) {
        Ok(gpu) => {
            tracing::info!("colour is computed by {}", gpu.name());
            Box::new(gpu)
        }
        Err(error) => {
            if matches!(choice, Choice::Forced) {
                tracing::warn!("{error}; colour is computed by the processor");
            }
            Box::new(CpuFilms::new())
        }
    }
}

/// Has the node take turns until it knows every brush of rig.toml, or it is time to stop.
fn wait_for_brushes(
    member: &Member,
    node: &mut PaintNode,
    turn: &mut impl FnMut(&mut PaintNode) -> Result<Duration, Fault>,
) -> Result<(), Fault> {
    let brushes = &member.config.brush;
    while !brushes.iter().all(|brush| node.knows_brush(&brush.name)) && !member.stop.requested() {
        let wait = turn(node)?;
        member.wake.wait(wait);
    }
    Ok(())
}

/// Drives a force-feedback stylus
#[derive(Parser)]
#[command(name = "maulstick-haptic", version)]
struct HapticOptions {
    #[command(flatten)]
    node: NodeOptions,
    /// The device of rig.toml
    #[arg(long, value_name = "DEVICE")]
    device: String,
    /// A take that a simulated hand follows
    #[arg(long, value_name = "TAKE")]
    hand: Option<PathBuf>,
}

fn device_named(config: &RigConfig, name: &str) -> Result<DeviceSection, Fault> {
    let devices = config.device.iter();
    let device = devices.clone().find(|device| device.name == name);
    device.cloned().ok_or_else(|| {
        let what = format!("there is no device '{name}' in rig.toml");
        Fault::unknown(what, name, devices.map(|device| device.name.as_str()))
    })
}

/// Main of the haptic daemon.
///
/// # Errors
/// A [`Fault`].
pub fn haptic() -> Result<i32, Fault> {
    let options = HapticOptions::parse();
    // The servo takes its force back before it ends, so it is asked, not killed.
    let mut member = options.node.join(&options.device, Signal::SIGTERM)?;
    let device = device_named(&member.config, &options.device)?;
    daemon::run(
        &mut member,
        &HapticSettings {
            device,
            hand: options.hand,
        },
    )?;
    member.leave();
    Ok(0)
}

/// Reads a pen tablet or a 6-DOF mouse
#[derive(Parser)]
#[command(name = "maulstick-hid", version)]
struct HidOptions {
    #[command(flatten)]
    node: NodeOptions,
    /// The device of rig.toml
    #[arg(long, value_name = "DEVICE")]
    device: String,
    /// A recording to play in the device's place
    #[arg(long, value_name = "FILE")]
    replay: Option<PathBuf>,
    /// Where to write what the device says, as a recording
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
}

/// Main of the daemon of pens and 6-DOF mice.
///
/// # Errors
/// A [`Fault`].
pub fn hid() -> Result<i32, Fault> {
    let options = HidOptions::parse();
    // Beside the device's own daemon a recorder is a device by itself: two of them move no brush twice,
    // for one alone has it at a time.
    let beside = options.record.is_some() && options.node.node.is_none();
    let name = match beside {
        true => format!("{}{RECORDER}", options.device),
        false => options.device.clone(),
    };
    // What is recorded gets its name at the end, so it is asked, not killed.
    let mut member = options.node.join(&name, Signal::SIGTERM)?;
    let mut device = device_named(&member.config, &options.device)?;
    if beside {
        device.name = name;
    }
    let settings = HidSettings {
        device,
        canvas: member.config.canvas.clone(),
        replay: options.replay,
        record: options.record,
    };
    let played = settings.replay.as_ref();
    let inputs: Vec<_> = named_by(&member.config)
        .into_iter()
        .chain(UsedFile::given("the recording that is played", played))
        .collect();
    let output = UsedFile::written("the recording", settings.record.as_ref(), Kind::Recording);
    let outputs: Vec<_> = output.into_iter().collect();
    check_outputs(&outputs, &inputs)?;
    maulstick_hid::daemon::run(&mut member, &settings)?;
    member.leave();
    Ok(0)
}

/// Plays a take as a device
#[derive(Parser)]
#[command(name = "maulstick-player", version)]
struct PlayerOptions {
    #[command(flatten)]
    node: NodeOptions,
    /// The take
    #[arg(long, value_name = "TAKE")]
    take: PathBuf,
    /// Seconds of the take a second, or 'max'
    #[arg(long, default_value = "1")]
    rate: Rate,
    /// The brush that it moves
    #[arg(long, default_value = "main")]
    brush: String,
    /// What each stroke loads, in turn
    #[arg(long, value_name = "MIX")]
    load: Vec<String>,
    /// Take time, ns, up to which it plays as fast as it can
    #[arg(long, default_value_t = 0, hide = true)]
    resume_ns: u64,
    /// Stay after the end
    #[arg(long, hide = true)]
    stay: bool,
    /// Take back first what was painted of it before a crash
    #[arg(long, hide = true)]
    again: bool,
}

/// Main of the player.
///
/// # Errors
/// A [`Fault`].
pub fn player() -> Result<i32, Fault> {
    let options = PlayerOptions::parse();
    let loads = options
        .load
        .iter()
        .map(|text| {
            text.parse::<Mixture>()
                .map_err(|error| refused(PaintRefusal::paint(error.into())))
        })
        .collect::<Result<_, _>>()?;
    let settings = PlayerSettings {
        take: Take::read(&options.take)?,
        rate: options.rate,
        resume_ns: options.resume_ns,
        brush: options.brush,
        loads,
        stay: options.stay,
        again: options.again,
    };
    let mut member = options.node.join(PLAYER, Signal::SIGKILL)?;
    player::run(&mut member, &settings)?;
    member.leave();
    Ok(0)
}

/// Shows the painting and lends the mouse as a stylus
#[derive(Parser)]
#[command(name = "maulstick-ui", version)]
struct UiOptions {
    #[command(flatten)]
    node: NodeOptions,
}

/// Main of the window.
///
/// # Errors
/// A [`Fault`].
pub fn ui() -> Result<i32, Fault> {
    let options = UiOptions::parse();
    let member = options.node.join("ui", Signal::SIGKILL)?;
    let by_signal = member.stop.clone();
    let export = export(&member.config.view, VIEW)?;
    let library = library_from(member.config.paint.paints.as_deref())?;
    maulstick_ui::run(member, MOUSE, &export, library)?;
    // Ended by a signal it has not been closed by the painter.
    Ok(i32::from(by_signal.by_signal()))
}
