//! The paint node: brush states and commands in; journal, credit, scene and frames out.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use maulstick_brush::BrushFile;
use maulstick_bus::typed::{Reader, Receiver, Sender};
use maulstick_bus::{Bus, BusError, Class, CreditReceiver, Queue, Server, Wake};
use maulstick_paint::picture::picture;
use maulstick_paint::sequencer::Replied;
use maulstick_paint::{Effect, Painting, Sequencer};
use maulstick_rig::files::write_whole;
use maulstick_types::brush::{BrushDef, BrushState};
use maulstick_types::command::{CommandReply, CommandRequest, Outcome};
use maulstick_types::paint::{BrushCredit, FrameHolds, JournalEntry, PaintConsumed, PaintStatus};
use maulstick_types::scene::{CANVAS, Scene};
use maulstick_types::topics::Topics;
use maulstick_types::{Flags, Origin, encode};

use crate::frames::{Fed, FedSurface, Feed};

/// Least time between two hand-overs to the frames, ns.
const FEED_PERIOD_NS: u64 = 8_000_000;
/// Time between two statuses, ns.
const STATUS_PERIOD_NS: u64 = 100_000_000;
/// States consumed in one turn before commands and frames have theirs.
const STATES_A_TURN: usize = 16;

/// The paint node.
pub struct PaintNode {
    bus: Arc<dyn Bus>,
    topics: Topics,
    me: Origin,
    sequencer: Sequencer,
    states: CreditReceiver<BrushState>,
    defs: Receiver<BrushDef>,
    commands: Server,
    reader: Reader,
    journal: Sender<JournalEntry>,
    consumed: Sender<PaintConsumed>,
    scene: Sender<Scene>,
    status: Sender<PaintStatus>,
    feed: Feed,
    fed_version: u64,
    fed_scene: u64,
    fed_ns: u64,
    status_ns: u64,
    told: BTreeMap<Origin, u64>,
    tell_again: bool,
    refused: u64,
}

impl PaintNode {
    /// A node on `bus` with a painting; it rings `wake` when there is something to do.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn new(
        bus: Arc<dyn Bus>,
        topics: &Topics,
        wake: &Wake,
        me: Origin,
        painting: Painting,
    ) -> Result<Self, BusError> {
        let b = &*bus;
        let mut scene = Sender::new(b, &topics.scene(), Class::Cached, me)?;
        let now = b.now_ns();
        scene.send(now, now, painting.scene())?;
        let fed_scene = painting.scene().version;
        let mut sequencer = Sequencer::new(painting);
        sequencer.decide("backend cpu");
        let node = Self {
            states: CreditReceiver::new(b, topics, &topics.brush_state("*"), me, wake)?,
            defs: Receiver::new(
                b,
                &topics.brush_def("*"),
                Class::Cached,
                Queue::Ring(64),
                wake,
            )?,
            commands: b.serve(&topics.command("paint"), 256, wake)?,
            reader: Reader::default(),
            journal: Sender::new(b, &topics.journal(), Class::Data, me)?,
            consumed: Sender::new(b, &topics.paint_consumed(), Class::Control, me)?,
            status: Sender::new(b, &topics.paint_status(), Class::Background, me)?,
            scene,
            feed: Feed::new(),
            fed_version: 1,
            fed_scene,
            fed_ns: 0,
            status_ns: 0,
            told: BTreeMap::new(),
            tell_again: false,
            refused: 0,
            topics: topics.clone(),
            me,
            sequencer,
            bus,
        };
        node.feed_first();
        Ok(node)
    }

    /// Where the frames take their pictures from.
    #[must_use]
    pub fn feed(&self) -> Feed {
        self.feed.clone()
    }

    /// The painting, for tests and for who runs the node.
    pub fn painting_mut(&mut self) -> &mut Painting {
        self.sequencer.painting_mut()
    }

    /// How many of a brush's states are painted.
    #[must_use]
    pub fn consumed(&self, brush: Origin) -> u64 {
        self.sequencer.consumed(brush)
    }

    /// Does all there is to do and returns how long to wait at most.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn turn(&mut self) -> Result<Duration, BusError> {
        let bus = Arc::clone(&self.bus);
        let now_ns = bus.now_ns();
        while let Some(def) = self.defs.try_recv() {
            self.define(&def.message);
        }
        self.serve_commands(now_ns)?;
        self.states.poll(&*bus)?;
        let mut left = STATES_A_TURN;
        while left > 0 && self.next_state(now_ns)? {
            left -= 1;
        }
        self.tell_again |= !self.states.unheard().is_empty();
        self.tell(now_ns)?;
        for entry in self.sequencer.drain_journal() {
            self.journal.send(now_ns, now_ns, &entry)?;
        }
        self.publish_scene(now_ns)?;
        self.hand_over(now_ns);
        self.publish_status(now_ns)?;
        Ok(if left == 0 {
            Duration::ZERO
        } else {
            Duration::from_millis(10)
        })
    }

    fn define(&mut self, def: &BrushDef) {
        match BrushFile::parse(&def.toml) {
            Ok(file) => self.sequencer.painting_mut().define_brush(&def.brush, file),
            Err(error) => {
                self.refused += 1;
                tracing::warn!("the file of brush '{}' is refused: {error}", def.brush);
            }
        }
    }

    fn serve_commands(&mut self, now_ns: u64) -> Result<(), BusError> {
        while let Some(request) = self.commands.try_recv() {
            let read = self
                .reader
                .read::<CommandRequest>(&request.key, &request.bytes);
            let Some((_, asked)) = read else { continue };
            let number = asked.number;
            let replied = self.sequencer.command(asked);
            let outcome = self.complete(replied);
            let reply = CommandReply { number, outcome };
            let bytes = encode(&self.me, Flags::NONE, 0, now_ns, self.bus.now_ns(), &reply)
                .map_err(|source| BusError::Message {
                    topic: request.key.clone(),
                    source,
                })?;
            if let Err(error) = request.answer(bytes) {
                tracing::debug!("a client is gone: {error}");
            }
        }
        Ok(())
    }

    /// Consumes one state; false where none can be consumed now.
    fn next_state(&mut self, now_ns: u64) -> Result<bool, BusError> {
        let Some(next) = self.states.peek() else {
            return Ok(false);
        };
        let brush = self.topics.middle(&next.key).unwrap_or_default().to_owned();
        if !self.sequencer.painting().knows_brush(&brush) {
            return Ok(false);
        }
        let Some(received) = self.states.pop() else {
            return Ok(false);
        };
        match self
            .sequencer
            .state(&brush, &received.header, &received.message)
        {
            Ok(replies) => {
                for replied in replies {
                    self.complete(replied);
                }
            }
            Err(error) => {
                self.refused += 1;
                if self.refused == 1 {
                    tracing::warn!("{}: {error}: {}", received.key, error.help);
                }
            }
        }
        if now_ns >= self.fed_ns + FEED_PERIOD_NS {
            self.hand_over(now_ns);
        }
        Ok(true)
    }

    /// Does what a command still asks for.
    fn complete(&mut self, replied: Replied) -> Outcome {
        let Some(Effect::Snapshot { path, ledger }) = &replied.effect else {
            return replied.outcome;
        };
        let painting = self.sequencer.painting_mut();
        let written = write_snapshot(painting, Path::new(path), ledger.as_deref().map(Path::new));
        let outcome = match written {
            Ok(()) => replied.outcome,
            Err((path, error)) => Outcome::Refused {
                what: format!("cannot write {path}: {error}"),
                help: "check that the folder exists and can be written to".to_owned(),
            },
        };
        self.sequencer
            .remember(replied.client, replied.number, outcome.clone());
        outcome
    }

    /// Tells the brushes what is consumed.
    fn tell(&mut self, now_ns: u64) -> Result<(), BusError> {
        let holds = self.sequencer.consumed_all();
        let news = holds
            .iter()
            .any(|(origin, next)| self.told.get(origin) != Some(next));
        if !news && !self.tell_again {
            return Ok(());
        }
        self.tell_again = false;
        self.told = holds.iter().copied().collect();
        let brushes = holds
            .iter()
            .map(|(origin, next)| BrushCredit {
                brush: origin.source,
                epoch: origin.epoch,
                next: *next,
                wetness: 0.0,
                film_m: 0.0,
                viscosity_m2_s: 0.0,
            })
            .collect();
        self.consumed
            .send(now_ns, now_ns, &PaintConsumed { brushes })
    }

    fn publish_scene(&mut self, now_ns: u64) -> Result<(), BusError> {
        let scene = self.sequencer.painting().scene();
        if scene.version != self.fed_scene {
            self.fed_scene = scene.version;
            self.scene.send(now_ns, now_ns, scene)?;
            let studio = Arc::new(self.sequencer.painting().studio().clone());
            self.feed.lock().studio = Some(studio);
        }
        Ok(())
    }

    /// Surfaces and optics, before anything is painted.
    fn feed_first(&self) {
        let painting = self.sequencer.painting();
        let mut fed = self.feed.lock();
        fed.studio = Some(Arc::new(painting.studio().clone()));
        for surface in &painting.scene().surfaces {
            let Some(store) = painting.store(surface.id) else {
                continue;
            };
            let ground = painting.ground(surface.id).to_vec();
            let (cells, grid) = (store.cells(), store.grid());
            fed.surfaces.insert(
                surface.id,
                FedSurface {
                    cells,
                    grid,
                    ground,
                    tiles: BTreeMap::new(),
                },
            );
        }
    }

    /// Hands new versions over, if a view waits for them.
    fn hand_over(&mut self, now_ns: u64) {
        if now_ns < self.fed_ns + FEED_PERIOD_NS || !self.feed.lock().wanted {
            return;
        }
        self.fed_ns = now_ns;
        self.sequencer.painting_mut().commit();
        let painting = self.sequencer.painting();
        let news = painting.versions() > self.fed_version;
        let mut fed = self.feed.lock();
        if news {
            feed_versions(&mut fed, painting, self.fed_version);
            self.fed_version = painting.versions();
        }
        fed.version = self.fed_version;
        fed.journal = self.sequencer.journal_next();
        fed.holds = self
            .sequencer
            .consumed_all()
            .into_iter()
            .map(|(origin, next)| FrameHolds {
                brush: origin.source,
                epoch: origin.epoch,
                next,
            })
            .collect();
        if news {
            fed.wanted = false;
            drop(fed);
            self.feed.ring();
        }
    }

    fn publish_status(&mut self, now_ns: u64) -> Result<(), BusError> {
        if now_ns < self.status_ns + STATUS_PERIOD_NS {
            return Ok(());
        }
        self.status_ns = now_ns;
        let (steps, footprint_cells) = self.sequencer.painting().work();
        let counts = self.states.counts();
        let lag_ns = self
            .states
            .peek()
            .map_or(0, |next| now_ns.saturating_sub(next.header.event_ns));
        let status = PaintStatus {
            journal: self.sequencer.journal_next(),
            steps,
            footprint_cells,
            lag_ns,
            memory_bytes: self.sequencer.painting().bytes() as u64,
            lost: counts.lost,
            refused: self.refused
                + counts.refused
                + self.reader.refused()
                + self.sequencer.ignored(),
        };
        self.status.send(now_ns, now_ns, &status)
    }
}

/// Adds the versions above `since` to what was fed.
fn feed_versions(fed: &mut Fed, painting: &Painting, since: u64) {
    for (number, surface) in &mut fed.surfaces {
        let Some(store) = painting.store(*number) else {
            continue;
        };
        for (id, version) in store.iter().filter(|(_, version)| version.number > since) {
            surface
                .tiles
                .insert(id, (version.number, version.tile.clone()));
        }
    }
}

/// Writes the canvas and, if asked, the ledger; on failure says which file.
///
/// # Errors
/// The path and what the system says.
pub fn write_snapshot(
    painting: &mut Painting,
    path: &Path,
    ledger: Option<&Path>,
) -> Result<(), (String, std::io::Error)> {
    let name = |path: &Path| path.display().to_string();
    if let Some(ledger) = ledger {
        let report = painting.report();
        write_whole(ledger, |file| {
            Ok(serde_json::to_writer_pretty(file, &report)?)
        })
        .map_err(|error| (name(ledger), error))?;
    }
    let picture = picture(painting, CANVAS);
    write_whole(path, |file| picture.encode_png(file)).map_err(|error| (name(path), error))
}

impl std::fmt::Debug for PaintNode {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PaintNode")
            .field("sequencer", &self.sequencer)
            .finish_non_exhaustive()
    }
}
