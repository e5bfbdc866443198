//! `maulstick render`: a take, or a script, painted in one process.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use clap::Args;
use indicatif::ProgressBar;
use maulstick_device::{Take, TakeSample};
use maulstick_nodes::snapshots::write_snapshot;
use maulstick_nodes::{Keeper, Offline};
use maulstick_paint::embedded::IMAGE;
use maulstick_paint::light::changes_colour;
use maulstick_paint::store::TileStore;
use maulstick_paint::{Painting, Sequencer};
use maulstick_rig::files::Kind;
use maulstick_rig::{Fault, RigConfig};
use maulstick_types::Mixture;
use maulstick_types::command::Command;
use maulstick_types::scene::{BrushHandling, CANVAS};

use crate::backend::choose_backend;
use crate::cells::picture_settings;
use crate::commands::progress_bar;
use crate::destination::export;
use crate::document::{Presence, go_on, presence, wrong};
use crate::duration::time_ns;
use crate::ground::GroundFile;
use crate::kit::use_kit;
use crate::outputs::{UsedFile, check_apart, check_outputs, named_by};
use crate::performance::{PaintingOptions, brush_file, library_from, painting_setup, refused};
use crate::script::{Act, Script, in_steps};
use crate::tooth::ToothPicture;

/// Time before a take, ns: strokes of two takes are never one.
const PAUSE_NS: u64 = 1_000_000_000;

/// Options of `maulstick render`.
#[derive(Args, Clone, Debug)]
pub struct RenderOptions {
    /// The take
    #[arg(required_unless_present = "script", conflicts_with = "script")]
    take: Option<PathBuf>,
    /// A script in the place of a take: brushes, loads, takes, drying, light, step by step
    #[arg(long, value_name = "FILE")]
    script: Option<PathBuf>,
    /// The picture, a PNG
    #[arg(short, long, value_name = "PNG")]
    output: PathBuf,
    /// Settings of the rig
    #[arg(long, value_name = "FILE")]
    rig: Option<PathBuf>,
    /// Where the picture goes: srgb, display-p3, or the ICC file of a display or printer; that of
    /// rig.toml if absent
    #[arg(long, value_name = "PROFILE")]
    profile: Option<String>,
    /// How colours come into its gamut: soft, clamp; that of rig.toml if absent
    #[arg(long, value_name = "MAPPING")]
    gamut: Option<String>,
    /// Paints in this painting, and keeps it there; it is begun where there is none
    #[arg(long, value_name = "FILE")]
    document: Option<PathBuf>,
    #[command(flatten)]
    painting: PaintingOptions,
}

impl RenderOptions {
    /// The files that are read, but for those that the script names.
    fn inputs(&self, config: &RigConfig) -> Vec<UsedFile> {
        let document = self.document.iter();
        named_by(config)
            .into_iter()
            .chain(UsedFile::given("the take", self.take.as_ref()))
            .chain(UsedFile::given("the script", self.script.as_ref()))
            .chain(UsedFile::given("the settings", self.rig.as_ref()))
            .chain(document.map(|path| UsedFile::painting(path)))
            .collect()
    }

    /// The files that are written, but for the painting.
    fn outputs(&self) -> Vec<UsedFile> {
        std::iter::once(UsedFile::new("the picture", &self.output).of(Kind::Png))
            .chain(UsedFile::written(
                "the ledger",
                self.painting.ledger.as_ref(),
                Kind::Ledger,
            ))
            .collect()
    }

    /// Refuses options that would do nothing.
    fn check_idle(&self) -> Result<(), Fault> {
        let painting = &self.painting;
        if let (Some(_), Some(load)) = (&self.script, painting.kit.load.first()) {
            return Err(Fault::usage("--load does nothing beside --script")
                .help(format!("load in the script: {{ load = {load:?} }}")));
        }
        for (option, given) in [
            ("--memory", &painting.memory),
            ("--history", &painting.history),
        ] {
            if given.is_some() && self.document.is_none() {
                return Err(
                    Fault::usage(format!("{option} does nothing without --document"))
                        .help("it is for a painting in a file: --document FILE.maul"),
                );
            }
        }
        Ok(())
    }
}

/// Reads a take; who gives a script in its place is told how.
fn read_take(path: &Path) -> Result<Take, Fault> {
    Take::read(path).map_err(|fault| match path.extension() {
        Some(extension) if extension == "toml" && path.exists() => fault.help(format!(
            "a script is painted with `--script {}`",
            path.display()
        )),
        _ => fault,
    })
}

/// Paints the take.
///
/// # Errors
/// A [`Fault`] for bad input, or where the picture cannot be written.
pub fn run(options: &RenderOptions) -> Result<i32, Fault> {
    let mut config = match &options.rig {
        Some(path) => RigConfig::read(path)?,
        None => picture_settings(),
    };
    options.check_idle()?;
    let take = match &options.take {
        Some(path) => Some((path, read_take(path)?)),
        None => None,
    };
    let folder = tempfile::tempdir().map_err(|error| Fault::failure(error.to_string()))?;
    let embedded = match &take {
        Some((path, take)) => use_kit(take, path, folder.path(), &mut config)?,
        None => Vec::new(),
    };
    let section = options.painting.apply(&mut config)?;
    for (setting, option) in [
        (&mut config.view.profile, &options.profile),
        (&mut config.view.gamut, &options.gamut),
    ] {
        if let Some(value) = option {
            setting.clone_from(value);
        }
    }
    let export = export(&config.view, "--profile, --gamut")?;
    let (outputs, inputs) = (options.outputs(), options.inputs(&config));
    check_apart(&outputs, &inputs)?;
    let begun = match &options.document {
        Some(path) if presence(path, &options.painting)? == Presence::There => {
            Some(go_on(&config, path)?)
        }
        _ => None,
    };
    let library = match &begun {
        // It has paints of its own.
        Some((_, sequencer, _)) => sequencer.painting().library().clone(),
        None => library_from(config.paint.paints.as_deref())?,
    };
    let loads = options.painting.kit.mixtures(&embedded, &library)?;
    let unloaded = loads.is_empty() && options.script.is_none();
    let script = match (&options.script, take) {
        (Some(path), _) => Script::read(path, &library)?,
        (None, Some((path, take))) => Script {
            steps: vec![(path.display().to_string(), Act::Take(take, loads.clone()))],
            files: Vec::new(),
        },
        (None, None) => Script::default(),
    };
    let mut written = outputs.clone();
    written.extend(options.document.iter().map(|path| UsedFile::painting(path)));
    check_apart(&written, &script.files)?;
    check_outputs(&outputs, &inputs)?;
    let (mut keeper, mut sequencer) = match &options.document {
        Some(path) => {
            let (document, mut sequencer, since) = match begun {
                Some(begun) => begun,
                None => go_on(&config, path)?,
            };
            let keeper = Keeper::new(document, &mut sequencer, since);
            (Some(keeper), sequencer)
        }
        None => {
            let setup = painting_setup(&config, &library)?;
            let painting = Painting::new(&setup, library).map_err(refused)?;
            (None, Sequencer::new(painting))
        }
    };
    choose_backend(&mut sequencer, &config.paint.backend)?;
    let file = brush_file(&section)?;
    let (name, share) = (&section.name, section.depth_share);
    let offline = Offline::going_on(sequencer, name, file, share, loads).map_err(refused)?;
    let mut easel = Easel {
        offline,
        keeper: &mut keeper,
        begun: Instant::now(),
        bar: progress_bar(script.length_ns()).with_message("painting"),
        painted_ns: 0,
        done: 0,
    };
    easel.bar.inc_length(script.steps.len() as u64);
    let painted = script.steps.into_iter().try_for_each(|(place, act)| {
        let done = easel.act(act).map_err(|fault| fault.at(place));
        easel.done += 1;
        easel.show(easel.painted_ns);
        done.map_err(|fault| match options.script {
            Some(_) => in_steps(fault),
            None => fault,
        })
    });
    easel.bar.finish_and_clear();
    let mut offline = easel.offline;
    let mut close = |offline: &mut Offline| match (keeper.take(), &options.document) {
        (Some(keeper), Some(path)) => keeper
            .close(offline.sequencer_mut())
            .map_err(|error| wrong(path, &error)),
        _ => Ok(()),
    };
    if let Err(fault) = painted {
        // What was painted before it is kept.
        close(&mut offline)?;
        return Err(fault);
    }
    let ledger = options.painting.ledger.as_deref();
    write_snapshot(offline.painting_mut(), &options.output, ledger, &export)
        .map_err(|(path, error)| Fault::writing(&path, &error))?;
    close(&mut offline)?;
    if unloaded {
        eprintln!("the brush carried no paint: `--load \"Ultramarine Blue\"` gives it some");
    }
    Ok(0)
}

/// A painting at which a script is followed.
struct Easel<'a> {
    offline: Offline,
    keeper: &'a mut Option<Keeper>,
    begun: Instant,
    bar: ProgressBar,
    /// Time of the takes and waits so far, ns.
    painted_ns: u64,
    /// Steps done.
    done: u64,
}

impl Easel<'_> {
    /// Shows how far it is: each millisecond of takes and waits counts, and each step.
    fn show(&self, painted_ns: u64) {
        self.bar.set_position(painted_ns / 1_000_000 + self.done);
    }

    fn act(&mut self, act: Act) -> Result<(), Fault> {
        let brush = self.offline.brush().to_owned();
        let done = match act {
            Act::Brush(name, file, share) => self.offline.take_up(&name, *file, share),
            Act::Load(mixture, None) => self.offline.command(Command::Load { brush, mixture }),
            Act::Load(left, Some(right)) => {
                let command = Command::LoadBeside { brush, left, right };
                self.offline.command(command)
            }
            Act::Handle(mode, flow, most_m) => {
                let handling = BrushHandling {
                    brush,
                    mode,
                    flow,
                    most_m,
                };
                self.offline.command(Command::Handle { handling })
            }
            Act::FillWith(thickness_m) => self.offline.command(Command::FillWith {
                surface: CANVAS,
                brush,
                thickness_m,
            }),
            Act::Clean => self.offline.command(Command::Clean { brush }),
            Act::Take(take, loads) => return self.follow(&take, loads),
            Act::Ground(file) => return self.prime(file),
            Act::Tooth(picture) => return self.weave(&picture),
            Act::Wait(ticks) => {
                self.wait(ticks);
                Ok(())
            }
            Act::Light(change) => {
                let before = self.offline.painting_mut().scene().light.clone();
                let light = change.on(&before)?;
                let expose = change.exposure.is_none() && changes_colour(&light, &before);
                self.offline.command(Command::Relight { light, expose })
            }
            Act::Undo(times) => return self.take_back(times),
            Act::Command(command) => self.offline.command(command),
        };
        done.map_err(refused)?;
        self.keep();
        Ok(())
    }

    fn prime(&mut self, file: GroundFile) -> Result<(), Fault> {
        let surface = CANVAS;
        let painting = self.offline.painting_mut();
        let cells = painting.store(CANVAS).map_or([1, 1], TileStore::cells);
        let command = match file.picture(cells)? {
            Some(bytes) => {
                let ground = format!("{IMAGE}{}", self.embed(bytes)?);
                Command::Ground { surface, ground }
            }
            None => match file {
                GroundFile::Spectrum(spectrum) => Command::GroundSpectrum { surface, spectrum },
                GroundFile::Named(ground) | GroundFile::Picture(_, ground) => {
                    Command::Ground { surface, ground }
                }
            },
        };
        self.offline.command(command).map_err(refused)?;
        self.keep();
        Ok(())
    }

    fn weave(&mut self, picture: &ToothPicture) -> Result<(), Fault> {
        let canvas = &self.offline.painting_mut().scene().surfaces[0];
        let (cells, cell_m) = (canvas.cells, canvas.cell_m);
        let hash = self.embed(picture.png(cells, cell_m)?)?;
        let command = Command::Tooth {
            surface: CANVAS,
            tooth: picture.name(hash, cells, cell_m),
            seed: 1,
        };
        self.offline.command(command).map_err(refused)?;
        self.keep();
        Ok(())
    }

    /// Takes a picture into the painting, and returns its hash.
    fn embed(&mut self, bytes: Arc<[u8]>) -> Result<String, Fault> {
        let painting = self.offline.painting_mut();
        let hash = painting.embed(bytes).map_err(refused)?;
        if let Some(keeper) = self.keeper {
            // The document has the picture before the journal names it.
            keeper.settle(self.offline.sequencer_mut());
        }
        Ok(hash)
    }

    fn take_back(&mut self, times: u32) -> Result<(), Fault> {
        let painting = self.offline.painting_mut();
        painting.commit();
        let (there, _) = painting.history_depth();
        if there < times as usize {
            let (what, help) = match there {
                0 => (
                    "there is nothing yet to take back".to_owned(),
                    "a load, a stroke, a film, a drying, another ground or tooth can be taken back"
                        .to_owned(),
                ),
                _ => (
                    format!("{times} steps cannot be taken back: {there} can be"),
                    format!("{{ undo = {there} }} takes all of them back"),
                ),
            };
            return Err(Fault::usage(what).help(help));
        }
        for _ in 0..times {
            let undo = Command::Undo { brush: None };
            self.offline.command(undo).map_err(refused)?;
        }
        self.keep();
        Ok(())
    }

    fn wait(&mut self, ticks: u32) {
        let Self {
            offline,
            keeper,
            begun,
            painted_ns,
            ..
        } = self;
        offline.wait(ticks, |sequencer| {
            turn(keeper, *begun, sequencer);
        });
        *painted_ns += time_ns(ticks);
    }

    fn follow(&mut self, take: &Take, loads: Vec<Mixture>) -> Result<(), Fault> {
        self.offline.begin_take(loads).map_err(refused)?;
        // The start does not matter to the painting; a live one has the clock's time here.
        let (start_ns, first_ns) = (PAUSE_NS + self.painted_ns, take.samples[0].time_ns);
        let since_ns = |sample: &TakeSample| sample.time_ns - first_ns;
        let samples = take.samples.iter();
        let samples: Vec<_> = samples
            .map(|sample| (start_ns + since_ns(sample), &sample.sample))
            .collect();
        let Self {
            offline,
            keeper,
            begun,
            bar,
            painted_ns,
            done,
        } = self;
        let followed = offline.follow(&samples, |sequencer, number| {
            if number % 16 == 0 {
                let painted_ns = *painted_ns + since_ns(&take.samples[number]);
                bar.set_position(painted_ns / 1_000_000 + *done);
            }
            turn(keeper, *begun, sequencer);
        });
        followed.map_err(refused)?;
        self.painted_ns += take.length_ns() + PAUSE_NS;
        Ok(())
    }

    fn keep(&mut self) {
        turn(self.keeper, self.begun, self.offline.sequencer_mut());
    }
}

/// Hands what is new to the document, if there is one.
fn turn(keeper: &mut Option<Keeper>, begun: Instant, sequencer: &mut Sequencer) {
    if let Some(keeper) = keeper {
        keeper.turn(sequencer, begun.elapsed().as_nanos() as u64);
    }
}
