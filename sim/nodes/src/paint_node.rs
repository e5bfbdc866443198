//! The paint node: brush states and commands in; journal, credit, scene and frames out.

mod feeding;
mod time;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use maulstick_brush::BrushFile;
use maulstick_bus::typed::{Reader, Received, Receiver, Sender};
use maulstick_bus::{
    Arrival, Bus, BusError, Class, CreditReceiver, Queue, Request, Server, Subscription, Wake,
};
use maulstick_document::{Document, DocumentError};
use maulstick_paint::picture::{Export, picture_for};
use maulstick_paint::sequencer::Replied;
use maulstick_paint::{Effect, Painting, Sequencer};
use maulstick_rig::files::write_whole;
use maulstick_types::brush::{BrushDef, BrushState};
use maulstick_types::command::{CommandReply, CommandRequest, Outcome};
use maulstick_types::paint::{BrushCredit, JournalEntry, PaintConsumed, PaintStatus};
use maulstick_types::scene::{CANVAS, Scene};
use maulstick_types::topics::{Topics, check_name};
use maulstick_types::{Flags, Origin, encode, name_hash};

use crate::Keeper;
use crate::frames::Feed;
use crate::ticker::Ticker;
use feeding::FEED_PERIOD_NS;

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
    tokens: Subscription,
    reader: Reader,
    journal: Sender<JournalEntry>,
    consumed: Sender<PaintConsumed>,
    scene: Sender<Scene>,
    status: Sender<PaintStatus>,
    feed: Feed,
    fed_version: u64,
    fed_scene: u64,
    fed_look: u64,
    sent_scene: u64,
    fed_ns: u64,
    status_ns: u64,
    told: BTreeMap<Origin, u64>,
    tell_again: bool,
    refused: u64,
    /// Brushes without a file, and topics with misfits or a stranger on them, of which it was said.
    unknown: BTreeSet<String>,
    misfits: BTreeSet<String>,
    strangers: BTreeSet<String>,
    export: Export,
    keeper: Option<Keeper>,
    ticker: Ticker,
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
        let mut sequencer = Sequencer::new(painting);
        sequencer.decide("backend cpu");
        Self::going_on(bus, topics, wake, me, sequencer)
    }

    /// A node that goes on with a painting where its sequencer is.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn going_on(
        bus: Arc<dyn Bus>,
        topics: &Topics,
        wake: &Wake,
        me: Origin,
        sequencer: Sequencer,
    ) -> Result<Self, BusError> {
        let painting = sequencer.painting();
        let b = &*bus;
        let mut scene = Sender::new(b, &topics.scene(), Class::Cached, me)?;
        let now = b.now_ns();
        scene.send(now, now, painting.scene())?;
        let sent_scene = painting.scene().version;
        let fed_look = painting.look().generation();
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
            tokens: b.watch(&topics.node("*"), wake)?,
            reader: Reader::default(),
            journal: Sender::new(b, &topics.journal(), Class::Data, me)?,
            consumed: Sender::new(b, &topics.paint_consumed(), Class::Control, me)?,
            status: Sender::new(b, &topics.paint_status(), Class::Background, me)?,
            scene,
            feed: Feed::new(),
            fed_version: 1,
            fed_scene: sent_scene,
            fed_look,
            sent_scene,
            fed_ns: 0,
            status_ns: 0,
            told: BTreeMap::new(),
            tell_again: false,
            refused: 0,
            unknown: BTreeSet::new(),
            misfits: BTreeSet::new(),
            strangers: BTreeSet::new(),
            export: Export::default(),
            keeper: None,
            ticker: Ticker::default(),
            topics: topics.clone(),
            me,
            sequencer,
            bus,
        };
        node.feed_first();
        Ok(node)
    }

    /// Has snapshots leave the working space in this way.
    #[must_use]
    pub fn exporting(mut self, export: Export) -> Self {
        self.export = export;
        self
    }

    /// Keeps the painting in a document, where its tiles up to the version `since` are.
    #[must_use]
    pub fn keeping(mut self, document: Document, since: u64) -> Self {
        self.keeper = Some(Keeper::new(document, &mut self.sequencer, since));
        self
    }

    /// Why the painting cannot go on: a page of its document could not be read.
    #[must_use]
    pub fn fault(&self) -> Option<&str> {
        self.sequencer.painting().pager().fault()
    }

    /// Writes what is to be kept and closes the document.
    ///
    /// # Errors
    /// Why something could not be written.
    pub fn close(mut self) -> Result<(), DocumentError> {
        match self.keeper.take() {
            Some(keeper) => keeper.close(&mut self.sequencer),
            None => Ok(()),
        }
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

    /// Whether a brush's file has come: before, its states wait and commands to it are refused.
    #[must_use]
    pub fn knows_brush(&self, brush: &str) -> bool {
        self.sequencer.painting().knows_brush(brush)
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
            self.define(&def.key, &def.message);
        }
        while let Some(token) = self.tokens.try_recv() {
            self.note_player(&token);
        }
        self.serve_commands(now_ns);
        self.let_time_pass(now_ns);
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
        if let Some(keeper) = &mut self.keeper {
            keeper.turn(&mut self.sequencer, now_ns);
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

    /// Takes in a brush file; its brush is the one of the topic, whose name is short.
    fn define(&mut self, key: &str, def: &BrushDef) {
        let brush = self.topics.middle(key).unwrap_or_default();
        let refusal = match (check_name(brush), BrushFile::parse(&def.toml)) {
            (Ok(()), Ok(file)) if def.brush == brush => {
                return self.sequencer.define_brush(brush, file);
            }
            (Ok(()), Ok(_)) => "it names another brush".to_owned(),
            (Ok(()), Err(error)) => error.to_string(),
            (Err(error), _) => error,
        };
        self.refused += 1;
        tracing::warn!("{key}: the brush file is refused: {refusal}");
    }

    /// A take ends with its player, whatever it still had to play.
    fn note_player(&mut self, token: &Arrival) {
        let device = name_hash(self.topics.node_of(&token.key).unwrap_or_default());
        if token.present {
            self.sequencer.player_there(device);
        } else {
            self.sequencer.player_gone(device);
        }
    }

    fn serve_commands(&mut self, now_ns: u64) {
        while let Some(request) = self.commands.try_recv() {
            let read = self
                .reader
                .read::<CommandRequest>(&request.key, &request.bytes);
            let Some((_, asked)) = read else { continue };
            let number = asked.number;
            let replied = self.sequencer.command(asked);
            let outcome = self.complete(replied);
            self.answer(request, now_ns, CommandReply { number, outcome });
        }
    }

    /// Answers a command. Nothing that a client sends may end the node: what cannot be told in
    /// full is told in short.
    fn answer(&self, request: Request, now_ns: u64, reply: CommandReply) {
        let write = |reply: &CommandReply| {
            encode(&self.me, Flags::NONE, 0, now_ns, self.bus.now_ns(), reply)
        };
        let bytes = write(&reply).or_else(|error| {
            tracing::warn!("{}: {error}", request.key);
            write(&CommandReply {
                number: reply.number,
                outcome: Outcome::Refused {
                    what: "the answer to this command is too long".to_owned(),
                    help: "send shorter names".to_owned(),
                },
            })
        });
        match bytes.map(|bytes| request.answer(bytes)) {
            Ok(Ok(())) => {}
            Ok(Err(error)) => tracing::debug!("a client is gone: {error}"),
            Err(error) => tracing::error!("a command cannot be answered: {error}"),
        }
    }

    /// Consumes one state; false where none can be consumed now. A brush whose file has not come
    /// waits, and holds up no other.
    fn next_state(&mut self, now_ns: u64) -> Result<bool, BusError> {
        let (painting, topics) = (self.sequencer.painting(), &self.topics);
        let known = |next: &Received<BrushState>| {
            let brush = topics.middle(&next.key);
            brush.is_some_and(|brush| painting.knows_brush(brush))
        };
        let Some(received) = self.states.pop_where(known) else {
            return Ok(false);
        };
        let brush = self
            .topics
            .middle(&received.key)
            .unwrap_or_default()
            .to_owned();
        // Credit and places in the journal are by the hash of the brush's name.
        if received.header.source != name_hash(&brush) {
            self.refused += 1;
            if self.strangers.insert(received.key.clone()) {
                tracing::warn!("{}: a stranger's states are dropped", received.key);
            }
            return Ok(true);
        }
        let (replies, painted) = self
            .sequencer
            .state(&brush, &received.header, &received.message);
        for replied in replies {
            self.complete(replied);
        }
        if let Err(error) = painted {
            self.refused += 1;
            if self.misfits.insert(received.key.clone()) {
                tracing::warn!("{}: {error}: {}", received.key, error.help);
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
        let ledger = ledger.as_deref().map(Path::new);
        let written = write_snapshot(painting, Path::new(path), ledger, &self.export);
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
            .map(|(origin, next)| {
                let under = self.sequencer.painting().under_brush(origin.source);
                BrushCredit {
                    brush: origin.source,
                    epoch: origin.epoch,
                    next: *next,
                    wetness: self.sequencer.painting().fullness(origin.source),
                    film_m: under.film_m as f32,
                    viscosity_m2_s: under.viscosity_m2_s as f32,
                    contact_m: under.contact_m as f32,
                }
            })
            .collect();
        self.consumed
            .send(now_ns, now_ns, &PaintConsumed { brushes })
    }

    fn publish_scene(&mut self, now_ns: u64) -> Result<(), BusError> {
        let scene = self.sequencer.painting().scene();
        if scene.version != self.sent_scene {
            self.sent_scene = scene.version;
            // Nothing that a painter does may end the node: a scene that does not fit is not told.
            match self.scene.send(now_ns, now_ns, scene) {
                Err(error @ BusError::Message { .. }) => tracing::error!("{error}"),
                sent => sent?,
            }
        }
        Ok(())
    }

    /// Says once of each brush that it moves without a brush file.
    fn tell_unknown(&mut self, now_ns: u64) {
        for next in self.states.heads() {
            let brush = self.topics.middle(&next.key).unwrap_or_default();
            let waits = now_ns.saturating_sub(next.arrived_ns) > STATUS_PERIOD_NS;
            if waits
                && !self.sequencer.painting().knows_brush(brush)
                && self.unknown.insert(brush.to_owned())
            {
                tracing::warn!("{}: its brush file has not come, its states wait", next.key);
            }
        }
    }

    fn publish_status(&mut self, now_ns: u64) -> Result<(), BusError> {
        if now_ns < self.status_ns + STATUS_PERIOD_NS {
            return Ok(());
        }
        self.status_ns = now_ns;
        let (steps, footprint_cells) = self.sequencer.painting().work();
        let counts = self.states.counts();
        self.tell_unknown(now_ns);
        let oldest_ns = self.states.heads().map(|next| next.header.event_ns).min();
        let lag_ns = oldest_ns.map_or(0, |oldest_ns| now_ns.saturating_sub(oldest_ns));
        let baking = self.feed.lock().baking;
        let painting = self.sequencer.painting();
        let document = self.keeper.as_ref().map(Keeper::document);
        let (undo, redo) = painting.history_depth();
        let status = PaintStatus {
            journal: self.sequencer.journal_next(),
            steps,
            footprint_cells,
            lag_ns,
            memory_bytes: painting.bytes() as u64,
            committed: document.map_or(0, Document::committed),
            undo: undo as u32,
            redo: redo as u32,
            merged: painting.history().merged(),
            kept_bytes: painting.pager().counts().held(),
            fault: document
                .and_then(Document::fault)
                .map_or(String::new(), |(what, help)| format!("{what}: {help}")),
            lost: counts.lost,
            baking: baking.all,
            baked: baking.done,
            refused: self.refused
                + counts.refused
                + self.reader.refused()
                + self.sequencer.ignored(),
        };
        self.status.send(now_ns, now_ns, &status)
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
    export: &Export,
) -> Result<(), (String, std::io::Error)> {
    let name = |path: &Path| path.display().to_string();
    if let Some(ledger) = ledger {
        let report = painting.report();
        write_whole(ledger, |file| {
            Ok(serde_json::to_writer_pretty(file, &report)?)
        })
        .map_err(|error| (name(ledger), error))?;
    }
    let picture = picture_for(painting, CANVAS, export);
    write_whole(path, |file| picture.encode_png(file)).map_err(|error| (name(path), error))
}

impl std::fmt::Debug for PaintNode {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PaintNode")
            .field("sequencer", &self.sequencer)
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests;
