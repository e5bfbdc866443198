//! Another painting in a running rig: the request is checked, the paint node saves the painting and ends, and starts
//! with the other one. If that does not come up, the one before is opened again.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, mpsc};
use std::time::{Duration, Instant};

use maulstick_bus::Bus;
use maulstick_document::DocumentError;
use maulstick_rig::UserError;
use maulstick_rig::command_client::CommandClient;
use maulstick_rig::config::{RigConfig, is_path};
use maulstick_rig::files::{Kind, check_writable, write_whole};
use maulstick_rig::node_handle::CONFIG_FILE;
use maulstick_types::Mixture;
use maulstick_types::command::{FileCommand, NewCanvas, Outcome, SaveAs};
use maulstick_types::wire::topics::Topics;

use super::orders::{refusal, starts_again};
use super::sketch::{self, Leave};
use super::starts::start_time;
use super::{GRACE, Supervisor};
use crate::cells::check_memory;
use crate::document::{measure, read, round, wrong};
use crate::performance::{library_from, painting_setup, refused};
use crate::up::child::{Ended, State};
use crate::up::first_load;
use crate::up::plan::Role;

/// The paint node closes its document within this time.
const CLOSE_TIME: Duration = Duration::from_secs(60);
/// A painting is in another file within this time.
const SAVE_TIME: Duration = Duration::from_secs(3600);

/// The request.
#[derive(Clone, Debug)]
pub(super) enum Ask {
    /// A painting that there is, and whether what is in memory alone may go.
    Open(PathBuf, bool),
    /// A new one, in memory alone where it has no file, and whether what is in memory alone may go.
    New(Option<PathBuf>, NewCanvas, bool),
    /// The painting in another file.
    SaveAs(SaveAs),
}

/// A switch to another painting in progress.
#[derive(Debug)]
pub(super) struct Switch {
    asker: (u64, u64),
    stage: Stage,
}

#[derive(Debug)]
enum Stage {
    /// Another thread checks that it can be opened or created; the flag: the painting in memory may be discarded.
    Checking(mpsc::Receiver<Result<Plan, UserError>>, bool),
    /// The paint node keeps what was painted, and ends.
    Closing(Box<Plan>, Instant),
    /// It starts with the other painting; the settings were these.
    Opening(Box<Plan>, Box<RigConfig>, Instant),
    /// It starts with the painting that there was, for this reason.
    Returning(Outcome),
    /// The paint node puts the painting there; who asks it gives up once it has ended.
    Saving(
        PathBuf,
        Arc<AtomicBool>,
        mpsc::Receiver<Result<(), UserError>>,
    ),
}

/// A rig with another painting.
#[derive(Debug)]
struct Plan {
    config: RigConfig,
    /// Load of the brushes, if the painting is new.
    load: Option<Mixture>,
}

impl Plan {
    /// Name of the painting.
    fn name(&self) -> String {
        match &self.config.paint.document {
            Some(path) => path.display().to_string(),
            None => "a new painting, which is not kept".to_owned(),
        }
    }
}

impl Switch {
    /// Gives the paint node so much more time.
    pub(super) fn postpone(&mut self, by: Duration) {
        if let Stage::Closing(_, since) | Stage::Opening(_, _, since) = &mut self.stage {
            *since += by;
        }
    }

    /// Begins with it.
    ///
    /// # Errors
    /// A [`UserError`] where there is no thread to do it.
    pub(super) fn begin(
        supervisor: &Supervisor,
        asker: (u64, u64),
        ask: Ask,
    ) -> Result<Self, UserError> {
        let mut config = supervisor.config.clone();
        let wake = supervisor.wake.clone();
        let sketches = supervisor.sketches.clone();
        let stage = match ask {
            Ask::SaveAs(save_as) => {
                let path = PathBuf::from(save_as.path.as_str());
                tracing::info!("saving in {}", path.display());
                let (bus, topics) = (Arc::clone(&supervisor.bus), supervisor.topics.clone());
                let stop = supervisor.stop.clone();
                let gone = Arc::new(AtomicBool::new(false));
                let has_gone = Arc::clone(&gone);
                Stage::Saving(
                    path,
                    gone,
                    beside(move || {
                        let stops = || stop.requested() || has_gone.load(Ordering::SeqCst);
                        let saved = save(bus, &topics, save_as, &stops);
                        wake.ring();
                        saved
                    })?,
                )
            }
            Ask::Open(path, forget) => Stage::Checking(
                beside(move || {
                    let checked = opened(&mut config, path);
                    wake.ring();
                    checked.map(|()| Plan { config, load: None })
                })?,
                forget,
            ),
            Ask::New(path, canvas, forget) => Stage::Checking(
                beside(move || {
                    let path = path.or_else(|| sketches.as_ref().and_then(sketch::begin));
                    let checked = begun(&mut config, path, &canvas);
                    wake.ring();
                    let load = Some(checked?);
                    Ok(Plan { config, load })
                })?,
                forget,
            ),
        };
        Ok(Self { asker, stage })
    }
}

/// Does work on a thread of its own.
fn beside<T: Send + 'static>(
    work: impl FnOnce() -> T + Send + 'static,
) -> Result<mpsc::Receiver<T>, UserError> {
    let (to_rig, outcome) = mpsc::channel();
    std::thread::Builder::new()
        .name("switch".into())
        .spawn(move || to_rig.send(work()).ok())
        .map_err(|error| UserError::failure(error.to_string()))?;
    Ok(outcome)
}

fn save(
    bus: Arc<dyn Bus>,
    topics: &Topics,
    save_as: SaveAs,
    stops: &dyn Fn() -> bool,
) -> Result<(), UserError> {
    let command = FileCommand::SaveAs(save_as);
    CommandClient::new(bus, topics)
        .send(command, None, SAVE_TIME, stops)
        .map(drop)
}

/// Sees that a painting can go on, and what is painted on.
fn opened(config: &mut RigConfig, path: PathBuf) -> Result<(), UserError> {
    if !path.exists() {
        return Err(wrong(&path, &DocumentError::Missing));
    }
    let (document, opened) = read(&path)?;
    measure(&mut config.canvas, &opened.snapshot().scene);
    drop(opened);
    document.close().map_err(|error| wrong(&path, &error))?;
    config.paint.document = Some(path);
    Ok(())
}

/// Sees that a painting can be begun, and what its brushes carry then.
fn begun(
    config: &mut RigConfig,
    path: Option<PathBuf>,
    canvas: &NewCanvas,
) -> Result<Mixture, UserError> {
    if is_path(&canvas.ground) && !Path::new(canvas.ground.as_str()).is_absolute() {
        return Err(
            UserError::usage("the path of the ground does not begin at the root")
                .help("give the whole path, for each program has a folder of its own"),
        );
    }
    let section = &mut config.canvas;
    [section.width_mm, section.height_mm, section.cell_mm] =
        [canvas.width_m, canvas.height_m, canvas.cell_m].map(|m| round(m * 1e3));
    section.stain_um = round(canvas.stain_m * 1e6);
    section.tooth_seed = canvas.tooth_seed;
    section.ground = canvas.ground.to_string();
    section.tooth = canvas.tooth.to_string();
    match &path {
        Some(path) if path.exists() => return Err(wrong(path, &DocumentError::Taken)),
        Some(path) => {
            check_writable(path, Kind::Own).map_err(|error| UserError::writing(path, &error))?;
        }
        None => check_memory(&config.canvas)?,
    }
    config.paint.document = path;
    let library = library_from(config.paint.paints.as_deref())?;
    painting_setup(config, &library)?
        .check(&library)
        .map_err(refused)?;
    Ok(first_load(&library))
}

impl Supervisor {
    /// True if a node of this role starts with another painting.
    pub(super) fn is_opening(&self, role: Role) -> bool {
        let stage = self.switch.as_ref().map(|switch| &switch.stage);
        role == Role::Paint && matches!(stage, Some(Stage::Opening(..)))
    }

    fn paint(&self) -> Option<usize> {
        let mut nodes = self.nodes.iter();
        nodes.position(|node| node.spec.role == Role::Paint)
    }

    /// Goes on with the switch as far as that is possible now.
    ///
    /// # Errors
    /// A [`UserError`] where a process cannot be started.
    pub(super) fn go_on_switching(&mut self) -> Result<(), UserError> {
        let Some(Switch { asker, stage }) = self.switch.take() else {
            return Ok(());
        };
        let next = match stage {
            Stage::Checking(checked, forget) => match checked.try_recv() {
                Err(mpsc::TryRecvError::Empty) => Ok(Stage::Checking(checked, forget)),
                Err(mpsc::TryRecvError::Disconnected) => Err(fallen()),
                Ok(Err(fault)) => Err(refusal(fault)),
                // Much may have been painted meanwhile.
                Ok(Ok(plan)) => match self.may_leave(forget) {
                    Ok(()) if self.paint().is_some_and(|place| self.nodes[place].renew()) => {
                        Ok(Stage::Closing(Box::new(plan), Instant::now()))
                    }
                    Ok(()) => Err(starts_again()),
                    Err(fault) => Err(refusal(fault)),
                },
            },
            Stage::Closing(plan, since) => {
                if since.elapsed() > CLOSE_TIME
                    && let Some(place) = self.paint()
                {
                    self.nodes[place].strike();
                }
                Ok(Stage::Closing(plan, since))
            }
            Stage::Opening(plan, before, since) => self.go_on_opening(plan, before, since)?,
            Stage::Returning(why) => match self.paint_runs() {
                true => Err(why),
                false => Ok(Stage::Returning(why)),
            },
            Stage::Saving(to, gone, saved) => match saved.try_recv() {
                Ok(Ok(())) => {
                    self.is_saved_as(&to);
                    let name = to.display().to_string();
                    tracing::info!("painting in {name}");
                    Err(Outcome::done(name))
                }
                _ if gone.load(Ordering::SeqCst) => Err(ended_as_it_saved(&to)),
                Err(mpsc::TryRecvError::Empty) => Ok(Stage::Saving(to, gone, saved)),
                Err(mpsc::TryRecvError::Disconnected) => Err(fallen()),
                Ok(Err(fault)) => Err(refusal(UserError {
                    place: None,
                    ..fault
                })),
            },
        };
        match next {
            Ok(stage) => self.switch = Some(Switch { asker, stage }),
            Err(outcome) => self.orders.replies.keep(asker.0, asker.1, outcome),
        }
        Ok(())
    }

    pub(super) fn paint_runs(&self) -> bool {
        self.paint()
            .is_some_and(|place| self.nodes[place].state == State::Running)
    }

    /// A node of this role has ended: a paint node that comes after it may have another painting, and
    /// is not asked to put that where this one was to go.
    pub(super) fn give_saving_up(&self, role: Role) {
        let stage = self.switch.as_ref().map(|switch| &switch.stage);
        if let (Role::Paint, Some(Stage::Saving(_, gone, _))) = (role, stage) {
            gone.store(true, Ordering::SeqCst);
        }
    }

    /// Longest wait for the paint node to end with the rig.
    pub(super) fn closing_time(&self) -> Duration {
        match self.switch.as_ref().map(|switch| &switch.stage) {
            Some(Stage::Saving(..)) => CLOSE_TIME,
            _ => GRACE,
        }
    }

    fn go_on_opening(
        &mut self,
        plan: Box<Plan>,
        before: Box<RigConfig>,
        since: Instant,
    ) -> Result<Result<Stage, Outcome>, UserError> {
        if !self.paint_runs() {
            if since.elapsed() < start_time(Role::Paint, &plan.config) {
                return Ok(Ok(Stage::Opening(plan, before, since)));
            }
            if let Some(place) = self.paint() {
                self.nodes[place].kill();
                return self.go_back(place, &plan, *before).map(Ok);
            }
        }
        let name = plan.name();
        if let Some(former) = &before.paint.document {
            self.leave_sketch(former, Leave::Left);
        }
        if plan.load.is_some() {
            (self.first_load, self.unloaded) = (plan.load, true);
        }
        let sizes = |config: &RigConfig| [config.canvas.width_mm, config.canvas.height_mm];
        if sizes(&before) != sizes(&self.config) {
            // Devices are fitted to the canvas.
            let mut nodes = self.nodes.iter_mut();
            while let Some(node) = nodes.find(|node| node.spec.role == Role::Device) {
                node.renew();
            }
        }
        tracing::info!("painting in {name}");
        Ok(Err(Outcome::done(name)))
    }

    /// A node that was asked to end for it has ended, or the paint node while it started.
    ///
    /// # Errors
    /// A [`UserError`] where a process cannot be started.
    pub(super) fn has_left(&mut self, place: usize, ended: Ended) -> Result<(), UserError> {
        match self.nodes[place].spec.role {
            Role::Paint => {}
            Role::Device => return self.device_has_left(place),
            Role::Brush | Role::Window | Role::Player | Role::Recorder => {
                return self.start_node(place);
            }
        }
        match self.switch.take() {
            Some(Switch {
                asker,
                stage: Stage::Closing(plan, _),
            }) => {
                let stage = match ended {
                    Ended::Well => self.open(place, plan)?,
                    Ended::Refused(_) | Ended::Badly => {
                        self.start_paint(place)?;
                        let help = match self.config.paint.document.is_some() {
                            true => "it is open again with all that its file has",
                            false => "it was in memory alone, and another is begun",
                        };
                        Stage::Returning(Outcome::refused(
                            "the painting could not be closed as it should be",
                            format!("{help}; the messages of the rig say what was wrong"),
                        ))
                    }
                };
                self.switch = Some(Switch { asker, stage });
            }
            Some(Switch {
                asker,
                stage: Stage::Opening(plan, before, _),
            }) => {
                let stage = self.go_back(place, &plan, *before)?;
                self.switch = Some(Switch { asker, stage });
            }
            other => {
                self.switch = other;
                self.start_paint(place)?;
            }
        }
        Ok(())
    }

    /// Starts the paint node with the other painting.
    fn open(&mut self, place: usize, plan: Box<Plan>) -> Result<Stage, UserError> {
        let before = std::mem::replace(&mut self.config, plan.config.clone());
        self.orders.forget_status();
        let [path, former] = self.settings();
        std::fs::remove_file(&former).ok();
        if let Err(error) = std::fs::hard_link(&path, &former) {
            tracing::debug!("{}: {error}", former.display());
        }
        if let Err(fault) = self.write_config() {
            self.config = before;
            self.start_paint(place)?;
            return Ok(Stage::Returning(refusal(fault)));
        }
        self.start_node(place)?;
        Ok(Stage::Opening(plan, Box::new(before), Instant::now()))
    }

    /// Starts the paint node with the painting that there was.
    fn go_back(
        &mut self,
        place: usize,
        plan: &Plan,
        before: RigConfig,
    ) -> Result<Stage, UserError> {
        self.config = before;
        // Renaming needs no room on the disk.
        let [path, former] = self.settings();
        let written = std::fs::rename(&former, &path).or_else(|_| {
            let written = self.write_config();
            written.inspect_err(|fault| tracing::warn!("{}: {}", path.display(), fault.what))
        });
        let name = &self.nodes[place].spec.name;
        self.due.retain(|(due, _)| due != name);
        self.start_paint(place)?;
        let help = match written {
            Ok(()) => {
                "the painting before is open again; the messages of the rig say what was wrong"
            }
            Err(_) => {
                "the settings of the rig could not be written either: free some space, end it and \
                       start it again with the painting before"
            }
        };
        Ok(Stage::Returning(Outcome::refused(
            format!("{} could not be opened", plan.name()),
            help,
        )))
    }

    /// Starts the paint node; what was in memory alone is gone, and its brushes are loaded anew.
    fn start_paint(&mut self, place: usize) -> Result<(), UserError> {
        self.unloaded |= self.config.paint.document.is_none();
        self.start_node(place)
    }

    /// The settings that the nodes read, and those before.
    fn settings(&self) -> [PathBuf; 2] {
        let path = self.folder.path().join(CONFIG_FILE);
        let former = path.with_extension("before");
        [path, former]
    }

    /// Writes the settings where the nodes read them.
    pub(super) fn write_config(&self) -> Result<(), UserError> {
        let [path, _] = self.settings();
        let text = self.config.to_toml()?;
        write_whole(&path, Kind::Own, |file| {
            use std::io::Write as _;
            file.write_all(text.as_bytes())
        })
        .map_err(|error| UserError::writing(&path, &error))
    }
}

fn ended_as_it_saved(to: &Path) -> Outcome {
    Outcome::refused(
        format!(
            "the paint node ended before it said that the painting is in {}",
            to.display()
        ),
        "look whether that file has it, and open it there; the messages of the rig say what was wrong",
    )
}

fn fallen() -> Outcome {
    Outcome::refused(
        "internal error: the file worker panicked",
        "see the messages of the rig, and report the fault",
    )
}
