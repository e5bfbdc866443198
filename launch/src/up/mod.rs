//! `maulstick up`: starts a rig and keeps it running.
//!
//! | module | holds |
//! | --- | --- |
//! | [`bar_terminal`] | the terminal of the bar while a take is played |
//! | [`plan`] | processes of a rig |
//! | [`processes`] | the processes: started, awaited, signalled |
//! | [`supervisor`] | all of them: tokens, restarts, the table, the end |
//! | [`conductor`] | playback of a take from its start to its picture |

mod bar_terminal;
pub mod conductor;
pub mod plan;
mod processes;
pub mod supervisor;

use std::path::{Path, PathBuf};

use clap::Args;
use maulstick_bus::RigFolder;
use maulstick_device::player::Rate;
use maulstick_device::{Take, use_kit};
use maulstick_document::scene;
use maulstick_optics::PaintLibrary;
use maulstick_rig::config::{DEFAULT, DeviceSection, RigConfig, is_path};
use maulstick_rig::files::Kind;
use maulstick_rig::log::log_to_stderr;
use maulstick_rig::{UserError, user_devices};
use maulstick_types::Mixture;

use maulstick_painting_setup::cells::{check_memory, check_speed, picture_settings};
use maulstick_painting_setup::destination::{VIEW, export};
use maulstick_painting_setup::document::{Presence, measure, presence, wrong};
use maulstick_painting_setup::outputs::{Relayed, UsedFile, check_outputs, named_by};
use maulstick_painting_setup::{PaintingOptions, library_from, painting_setup, refused};

use crate::runtime::{EndSignals, block_on};
use crate::up::conductor::Performance;
use crate::up::plan::{Hands, NodeSpec, Window};
use crate::up::supervisor::{Start, Supervisor, sketch};

/// Folder of the files embedded in the played take, in the rig's folder.
const KIT: &str = "kit";
/// Load of the brush at the start, unless another is requested.
const FIRST_LOAD: &str = "Ultramarine Blue";

/// Load of the brush at the start: if the painter's own paints lack it, the first of them.
fn first_load(library: &PaintLibrary) -> Mixture {
    let first = library
        .paints()
        .first()
        .map_or(FIRST_LOAD, |paint| paint.name.as_str());
    Mixture::pure(
        library
            .find(FIRST_LOAD)
            .map_or(first, |paint| paint.name.as_str()),
    )
}

/// Options of `maulstick up`.
#[derive(Args, Clone, Debug)]
pub struct UpOptions {
    /// Painting to open or begin [default: a sketch, kept for the next start; in memory only without a window]
    #[arg(value_name = "FILE")]
    file: Option<PathBuf>,
    /// Settings of the rig [default: the built-in settings]
    #[arg(long, value_name = "FILE")]
    rig: Option<PathBuf>,
    /// Name of the rig [default: that in its settings]
    #[arg(long, value_name = "RIG")]
    name: Option<String>,
    /// Open no window
    #[arg(long)]
    headless: bool,
    /// Play a take instead of the devices
    #[arg(long, value_name = "TAKE")]
    play: Option<PathBuf>,
    /// Playback speed (1 = real time), or 'max'
    #[arg(long, value_name = "R|max", default_value = "1", requires = "play")]
    rate: Rate,
    /// Write the picture at the end of the take, and stop
    #[arg(long, value_name = "PNG", requires = "play")]
    snapshot: Option<PathBuf>,
    #[command(flatten)]
    painting: PaintingOptions,
    /// Begin a canvas of so small or so many cells that painting on it is slow
    #[arg(long)]
    slow: bool,
    /// Let a device load this vendor's library, outside of the folders of the system; may be given several times
    #[arg(long, value_name = "PATH")]
    allow_library: Vec<PathBuf>,
    /// Print the default settings, with comments, and exit
    #[arg(long)]
    print_config: bool,
}

impl UpOptions {
    /// Checks that a ledger has a picture, and a picture a take.
    fn check_ledger(&self) -> Result<(), UserError> {
        if self.painting.ledger.is_none() || self.snapshot.is_some() {
            return Ok(());
        }
        Err(if self.play.is_none() {
            UserError::usage("--ledger needs --play TAKE")
                .help("`maulstick snapshot --ledger FILE` asks a running rig")
        } else {
            UserError::usage("--ledger needs --snapshot PNG")
                .help("the ledger is written with the picture at the end of the take")
        })
    }

    /// The settings, without the setup of a take.
    fn config(&self) -> Result<RigConfig, UserError> {
        let mut config = match &self.rig {
            Some(path) => RigConfig::read(path)?,
            None if self.play.is_some() => picture_settings(),
            None => with_own_devices(unattended(RigConfig::default())),
        };
        if let Some(name) = &self.name {
            config.rig.name.clone_from(name);
        }
        for library in &self.allow_library {
            config.allowed_libraries.push(absolute(library)?);
        }
        if let Some(file) = &self.file {
            config.paint.document = Some(absolute(file)?);
        }
        Ok(config)
    }

    /// Checks the painting to open or create: its file, and the memory of this machine.
    fn check_painting(
        &self,
        config: &mut RigConfig,
        is_played: bool,
    ) -> Result<Option<Presence>, UserError> {
        let presence = match &config.paint.document {
            Some(path) => Some(presence(path, &self.painting)?),
            None => None,
        };
        if let Some(path) = &config.paint.document
            && let Some(scene) = scene(path).map_err(|error| wrong(path, &error))?
        {
            measure(&mut config.canvas, &scene);
        }
        if !is_played && presence != Some(Presence::There) {
            check_speed(&config.canvas, self.slow.into())?;
        }
        if presence.is_none() {
            check_memory(&config.canvas)?;
        }
        Ok(presence)
    }

    /// The take that is played, and its output.
    fn performance(
        &self,
        (path, take): (&Path, &Take),
        config: &RigConfig,
        brush: String,
        loads: &[Mixture],
    ) -> Result<Performance, UserError> {
        self.check_files(path, config)?;
        let relayed = |path: Option<&PathBuf>, kind: Kind| {
            path.map(|path| Relayed::new(path, kind)).transpose()
        };
        Ok(Performance {
            take: absolute(path)?,
            rate: self.rate,
            brush,
            loads: loads.iter().map(ToString::to_string).collect(),
            snapshot: relayed(self.snapshot.as_ref(), Kind::Png)?,
            ledger: relayed(self.painting.ledger.as_ref(), Kind::Ledger)?,
            length_ns: take.length_ns(),
        })
    }

    fn nodes(&self, config: &RigConfig, is_played: bool) -> Vec<NodeSpec> {
        let window = if self.headless {
            Window::Headless
        } else {
            Window::Shown
        };
        let hands = if is_played {
            Hands::Take
        } else {
            Hands::Devices
        };
        plan::nodes(config, window, hands)
    }

    /// Checks that the file written at the end of the take is none that the rig uses.
    fn check_files(&self, take: &Path, config: &RigConfig) -> Result<(), UserError> {
        let outputs: Vec<_> = UsedFile::written("the picture", self.snapshot.as_ref(), Kind::Png)
            .into_iter()
            .chain(UsedFile::written(
                "the ledger",
                self.painting.ledger.as_ref(),
                Kind::Ledger,
            ))
            .collect();
        let document = config.paint.document.iter();
        let inputs: Vec<_> = named_by(config)
            .into_iter()
            .chain([UsedFile::new("the take", take)])
            .chain(UsedFile::given("the settings", self.rig.as_ref()))
            .chain(document.map(|path| UsedFile::painting(path)))
            .collect();
        Ok(check_outputs(&outputs, &inputs)?)
    }
}

/// Runs the rig until it is told to stop.
///
/// # Errors
/// A [`UserError`] for bad settings or input, an occupied name, or nodes that keep failing.
pub fn run(options: &UpOptions) -> Result<i32, UserError> {
    if options.print_config {
        crate::commands::print_text(DEFAULT)?;
        return Ok(0);
    }
    options.check_ledger()?;
    log_to_stderr("info");
    let mut config = options.config()?;
    let folder = RigFolder::create(&config.rig.name)?;
    let take = match &options.play {
        None => None,
        Some(path) => Some((path, Take::read(path)?)),
    };
    let embedded = match &take {
        None => Vec::new(),
        Some((path, take)) => use_kit(take, path, &folder.path().join(KIT), &mut config)?,
    };
    let section = options.painting.apply(&mut config)?;
    let sketches = if options.headless || take.is_some() {
        None
    } else {
        sketch::of_user()
    };
    if config.paint.document.is_none() {
        config.paint.document = sketches.as_ref().and_then(sketch::begin);
    }
    let presence = options.check_painting(&mut config, take.is_some())?;
    let library = library_from(config.paint.paints.as_deref())?;
    let loads = options.painting.kit.mixtures(&embedded, &library)?;
    painting_setup(&config, &library)?
        .check(&library)
        .map_err(refused)?;
    let performance = match &take {
        None => None,
        Some((path, take)) => {
            Some(options.performance((path, take), &config, section.name, &loads)?)
        }
    };
    make_absolute(&mut config)?;
    export(&config.view, VIEW)?;
    let nodes = options.nodes(&config, performance.is_some());
    let start = Start {
        nodes,
        performance,
        // In a continued painting the brushes keep their loads.
        first_load: match (loads.into_iter().next(), presence) {
            (None, Some(Presence::There)) => None,
            (Some(load), _) => Some(load),
            (None, _) => Some(first_load(&library)),
        },
        config,
        sketches,
    };
    block_on(async {
        let signals = EndSignals::watch()?;
        Supervisor::start(folder, start)?.run(signals).await
    })
}

/// Makes the paths of settings absolute; fails where a take cannot be read.
fn make_absolute(config: &mut RigConfig) -> Result<(), UserError> {
    for device in &mut config.device {
        if let Some(hand) = &mut device.hand {
            Take::read(hand)?;
            *hand = absolute(hand)?;
        }
        if let Some(replay) = &mut device.replay {
            *replay = absolute(replay)?;
        }
    }
    if let Some(paints) = &mut config.paint.paints {
        *paints = absolute(paints)?;
    }
    if let Some(record) = &mut config.record {
        record.folder = absolute(&record.folder)?;
        std::fs::create_dir_all(&record.folder)
            .map_err(|error| UserError::writing(&record.folder, &error))?;
    }
    let kinds = config.brush.iter_mut().map(|brush| &mut brush.kind);
    let light = &mut config.light;
    let named = [
        &mut light.illuminant,
        &mut light.environment,
        &mut config.canvas.ground,
    ];
    for text in kinds.chain(named) {
        if is_path(text) {
            *text = absolute(Path::new(text.as_str()))?.display().to_string();
        }
    }
    if let Some(path) = config.view.file() {
        config.view.profile = absolute(path)?.display().to_string();
    }
    Ok(())
}

/// Settings without the simulated devices that no hand moves: a painter without devices has the mouse.
fn unattended(mut config: RigConfig) -> RigConfig {
    let moves = |device: &DeviceSection| device.driver != "simulated" || device.hand.is_some();
    config.device.retain(moves);
    config
}

/// The same rig with the devices of this user. A faulty one is reported, and the rig starts without it.
fn with_own_devices(mut config: RigConfig) -> RigConfig {
    let own = user_devices::path().and_then(|path| user_devices::read(&path));
    for device in own.unwrap_or_else(|fault| {
        let place = fault.place.unwrap_or_default();
        tracing::error!(
            "the rig starts without your devices: {place}: {}",
            fault.what
        );
        Vec::new()
    }) {
        let name = device.name.clone();
        match config.with_device(device) {
            Ok(with) => config = with,
            Err(fault) => tracing::error!("the rig starts without '{name}': {}", fault.what),
        }
    }
    config
}

/// An absolute path: nodes may be started by hand from another folder, and the paint node writes to the name it is
/// given.
fn absolute(path: &std::path::Path) -> Result<PathBuf, UserError> {
    std::path::absolute(path).map_err(|error| UserError::reading(path, &error))
}
