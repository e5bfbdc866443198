//! The paint node: brush states and commands in; journal, credit, scene and frames out.

mod brush_reliefs;
mod commands;
mod frame_feed;
mod proposal;
mod repeat;
mod save_as;
mod status;
mod time;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use maulstick_appearance::picture::Export;
use maulstick_brush::BrushFile;
use maulstick_bus::sender_arbiter::Once;
use maulstick_bus::typed::{Reader, Received, Receiver, Sender};
use maulstick_bus::{
    Announcer, Arrival, Bus, BusError, CreditReceiver, Qos, Queue, Server, Subscription, Wake,
};
use maulstick_document::{Document, DocumentError, Relocation};
use maulstick_painting::{Painting, Sequencer};
use maulstick_types::brush::{BRUSHES_MOST, BrushDef, BrushState};
use maulstick_types::paint::{BrushCredit, Decision, JournalEntry, PaintConsumed, PaintStatus};
use maulstick_types::scene::Scene;
use maulstick_types::wire::topics::{Topics, check_name};
use maulstick_types::{Origin, name_hash};

use crate::exporter::{Asker, Exporter};
use crate::frames::Feed;
use crate::snapshots::Snapshots;
use crate::thumbnails::Thumbnails;
use brush_reliefs::BrushReliefs;
use frame_feed::FEED_PERIOD_NS;
use maulstick_session::Autosave;
use maulstick_session::ticker::Ticker;
use maulstick_types::command::reply_cache::ReplyCache;
use save_as::Saving;

/// Time between two statuses, ns.
const STATUS_PERIOD_NS: u64 = 100_000_000;
/// States consumed in one turn before commands and frames have theirs.
const STATES_A_TURN: usize = 16;
/// Time after which a turn consumes no more states, ns: of a large brush each takes long.
const TURN_NS: u64 = 20_000_000;

/// The paint node.
pub struct PaintNode {
    bus: Arc<dyn Bus>,
    topics: Topics,
    me: Origin,
    sequencer: Sequencer,
    states: CreditReceiver<BrushState>,
    defs: Receiver<BrushDef>,
    commands: Server,
    replies: ReplyCache,
    exporter: Exporter,
    snapshots: Snapshots,
    saving: Option<Saving>,
    /// A copy that is being written: who asked, and where it will be.
    copying: Option<(Asker, PathBuf, Relocation)>,
    /// Its document has not got the name yet that the painter gave it.
    unnamed: bool,
    thumbnails: Thumbnails,
    tokens: Subscription,
    reader: Reader,
    journal: Sender<JournalEntry>,
    consumed: Sender<PaintConsumed>,
    reliefs: BrushReliefs,
    scene: Announcer<Scene>,
    status: Sender<PaintStatus>,
    /// The status that was sent last, and its time, ns.
    told_status: Option<(PaintStatus, u64)>,
    feed: Feed,
    fed_version: u64,
    fed_scene: u64,
    fed_look: u64,
    sent_scene: u64,
    fed_ns: u64,
    fed_brushes_ns: u64,
    status_ns: u64,
    told: BTreeMap<Origin, u64>,
    tell_again: bool,
    /// Sources of the brushes whose files or states were heard since the node began.
    heard: BTreeSet<u32>,
    refused: u64,
    /// Brushes without a file, and topics with misfits or a stranger on them, of which it was said.
    unknown: Once,
    misfits: Once,
    strangers: Once,
    export: Export,
    autosave: Option<Autosave>,
    /// Most bytes of pages in memory, where the painting has a document.
    memory: usize,
    /// Commit counter at the newest commit seen, and its time, ns.
    committed: (u64, u64),
    ticker: Ticker,
    /// Files with which the next states of brushes are painted, by the brushes' sources: their FNV-1a.
    file_hashes: BTreeMap<u32, u32>,
    /// Other files of known brushes, until something is done with them.
    newer_brushes: BTreeMap<String, BrushFile>,
    /// The recorded session that is painted again.
    session: Option<repeat::Repetition>,
    /// Watches whether a lighter paint model is to be proposed, where it may be.
    proposal: Option<proposal::Proposal>,
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
        sequencer.decide(Decision::Backend { name: "cpu".into() });
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
        let mut scene = Announcer::new(b, &topics.scene(), me, wake)?;
        scene.send(b.now_ns(), painting.scene())?;
        let sent_scene = painting.scene().version;
        let fed_look = painting.look().generation();
        let node = Self {
            states: CreditReceiver::new(b, topics, &topics.brush_state("*"), me, wake)?,
            defs: Receiver::new(
                b,
                &topics.brush_def("*"),
                Qos::Cached,
                Queue::Ring(64),
                wake,
            )?,
            commands: b.serve(&topics.command("paint"), 256, wake)?,
            replies: ReplyCache::default(),
            exporter: Exporter::default(),
            snapshots: Snapshots::default(),
            saving: None,
            copying: None,
            unnamed: false,
            thumbnails: Thumbnails::new(b, &topics.thumbnail(), wake, me)?,
            tokens: b.watch(&topics.node("*"), wake)?,
            reader: Reader::default(),
            journal: Sender::new(b, &topics.journal(), Qos::Data, me)?,
            consumed: Sender::new(b, &topics.paint_consumed(), Qos::Control, me)?,
            reliefs: BrushReliefs::new(b, topics, wake)?,
            status: Sender::new(b, &topics.paint_status(), Qos::Background, me)?,
            scene,
            feed: Feed::new(),
            fed_version: 1,
            fed_scene: sent_scene,
            fed_look,
            sent_scene,
            fed_ns: 0,
            fed_brushes_ns: 0,
            status_ns: 0,
            told_status: None,
            told: BTreeMap::new(),
            tell_again: false,
            heard: BTreeSet::new(),
            refused: 0,
            unknown: Once::default(),
            misfits: Once::default(),
            strangers: Once::default(),
            export: Export::default(),
            autosave: None,
            memory: 1 << 30,
            committed: (0, 0),
            ticker: Ticker::default(),
            file_hashes: BTreeMap::new(),
            newer_brushes: BTreeMap::new(),
            session: sequencer
                .is_repeating()
                .then(|| repeat::Repetition::new(None, b.now_ns())),
            proposal: None,
            topics: topics.clone(),
            me,
            sequencer,
            bus,
        };
        node.feed_first();
        Ok(node)
    }

    /// Sets the conversion of snapshots from the working space.
    #[must_use]
    pub fn exporting(mut self, export: Export) -> Self {
        self.export = export;
        self
    }

    /// Keeps the painting in a document, where its tiles up to the version `since` are.
    #[must_use]
    pub fn keeping(mut self, document: Document, since: u64) -> Self {
        self.autosave = Some(Autosave::new(document, &mut self.sequencer, since));
        self
    }

    /// Keeps at most so many bytes of pages in memory once the painting gets a document.
    #[must_use]
    pub fn with_memory(mut self, bytes: usize) -> Self {
        self.memory = bytes;
        self
    }

    /// The painting's file, if it has one.
    #[must_use]
    pub fn document_path(&self) -> Option<&Path> {
        self.autosave
            .as_ref()
            .map(|autosave| autosave.document().path())
    }

    /// The error that stops the painting: a page of its document could not be read.
    #[must_use]
    pub fn fault(&self) -> Option<&str> {
        self.sequencer.painting().pager().fault()
    }

    /// Writes everything pending and closes the document, under its new name if a move is in progress.
    ///
    /// # Errors
    /// The reason why something could not be written, or not under that name.
    pub fn close(mut self) -> Result<(), DocumentError> {
        // Snapshots may show pages that only the document has.
        drop(std::mem::take(&mut self.snapshots));
        let arrived = self.arrive();
        let closed = match self.autosave.take() {
            Some(autosave) => autosave.close(&mut self.sequencer),
            None => Ok(()),
        };
        arrived.and(closed)
    }

    /// Feed of the frames.
    #[must_use]
    pub fn feed(&self) -> Feed {
        self.feed.clone()
    }

    /// The painting, for tests and for who runs the node.
    pub fn painting_mut(&mut self) -> &mut Painting {
        self.sequencer.painting_mut()
    }

    /// True once a brush's file has arrived: before, its states wait and commands to it are refused.
    #[must_use]
    pub fn knows_brush(&self, brush: &str) -> bool {
        self.sequencer.painting().knows_brush(brush)
    }

    /// Number of a brush's states that are painted.
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
        self.states.poll(&*bus)?;
        self.serve_commands(now_ns);
        self.check_repeating(now_ns);
        self.let_time_pass(now_ns);
        let until_ns = bus.now_ns() + TURN_NS;
        let mut is_more = self.next_state(now_ns)?;
        for _ in 1..STATES_A_TURN {
            if !is_more || bus.now_ns() >= until_ns {
                break;
            }
            is_more = self.next_state(now_ns)?;
        }
        self.propose_model();
        self.tell_again |= !self.states.unheard().is_empty();
        self.tell(now_ns)?;
        self.reliefs.tell(self.sequencer.painting(), now_ns)?;
        for entry in self.sequencer.drain_journal() {
            self.journal.send(now_ns, now_ns, &entry)?;
        }
        if let Some(autosave) = &mut self.autosave {
            autosave.turn(&mut self.sequencer, now_ns);
        }
        self.go_on_beside(now_ns);
        self.thumbnails.turn(&*bus, self.sequencer.painting_mut());
        self.publish_scene(now_ns)?;
        self.hand_over(now_ns);
        self.hand_over_brushes(now_ns);
        self.publish_status(now_ns)?;
        Ok(if is_more {
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
                // A session that is painted again has the brushes of then.
                let taken = match self.knows_brush(brush) {
                    true => {
                        self.newer_brushes.insert(brush.to_owned(), file);
                        Ok(())
                    }
                    false => self.sequencer.define_brush(brush, file),
                };
                match taken {
                    Ok(()) => {
                        self.heard.insert(name_hash(brush));
                        self.file_hashes
                            .insert(name_hash(brush), name_hash(&def.toml));
                        self.tell_again = true;
                        return;
                    }
                    Err(error) => format!("{error}: {}", error.advice()),
                }
            }
            (Ok(()), Ok(_)) => "it names another brush".to_owned(),
            (Ok(()), Err(error)) => error.to_string(),
            (Err(error), _) => error.to_string(),
        };
        self.refused += 1;
        tracing::warn!("{key}: the brush file is refused: {refusal}");
    }

    /// Takes other files of known brushes in hand, before something is done with them.
    fn take_up_brushes(&mut self) {
        if self.session.is_none() {
            for (brush, file) in std::mem::take(&mut self.newer_brushes) {
                // It is known, so there is room for it.
                if let Err(error) = self.sequencer.define_brush(&brush, file) {
                    tracing::error!("{brush}: {error}");
                }
            }
        }
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
            if self.strangers.say(&received.key) {
                tracing::warn!("{}: a stranger's states are dropped", received.key);
            }
            return Ok(true);
        }
        self.heard.insert(received.header.source);
        self.take_up_brushes();
        let newest = received.message.solves.last();
        self.reliefs.note(&*self.bus, self.me, &brush, newest)?;
        let (replies, painted) = self
            .sequencer
            .state(&brush, &received.header, &received.message);
        for replied in replies {
            self.complete(replied);
        }
        if let Err(error) = painted {
            self.refused += 1;
            if self.misfits.say(&received.key) {
                tracing::warn!("{}: {error}: {}", received.key, error.advice());
            }
        }
        if now_ns >= self.fed_ns + FEED_PERIOD_NS {
            self.hand_over(now_ns);
        }
        Ok(true)
    }

    /// Tells the brushes that were heard what is consumed of their states: a painting may know many more.
    fn tell(&mut self, now_ns: u64) -> Result<(), BusError> {
        let mut holds = self.sequencer.consumed_all();
        holds.retain(|(origin, _)| self.heard.contains(&origin.source));
        let news = holds
            .iter()
            .any(|(origin, next)| self.told.get(origin) != Some(next));
        if !news && !self.tell_again {
            return Ok(());
        }
        self.tell_again = false;
        self.told = holds.iter().copied().collect();
        // A brush may wait to be told that its file is here before its first state.
        let is_new = |source: &u32| holds.iter().all(|(origin, _)| origin.source != *source);
        let new = self.file_hashes.keys().filter(|source| is_new(source));
        let new = new.map(|source| {
            let (source, epoch) = (*source, 0);
            (Origin { source, epoch }, 0)
        });
        let credits: Vec<BrushCredit> = holds
            .iter()
            .copied()
            .chain(new)
            .map(|(origin, next)| {
                let under = self.sequencer.painting().under_brush(origin.source);
                BrushCredit {
                    brush: origin.source,
                    epoch: origin.epoch,
                    next,
                    wetness: self.sequencer.painting().fullness(origin.source),
                    film_m: under.film_m as f32,
                    viscosity_m2_s: under.viscosity_m2_s as f32,
                    contact_m: under.contact_m as f32,
                    file: self.file_hashes.get(&origin.source).copied().unwrap_or(0),
                }
            })
            .collect();
        // Paintings of before may have more brushes than one has now.
        for brushes in credits.chunks(BRUSHES_MOST) {
            let brushes = brushes.to_vec();
            self.consumed
                .send(now_ns, now_ns, &PaintConsumed { brushes })?;
        }
        Ok(())
    }

    fn publish_scene(&mut self, now_ns: u64) -> Result<(), BusError> {
        let scene = self.sequencer.painting().scene();
        if scene.version != self.sent_scene {
            self.sent_scene = scene.version;
            self.scene.send(now_ns, scene)?;
        }
        self.scene.turn(now_ns)
    }
}

impl std::fmt::Debug for PaintNode {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PaintNode")
            .field("sequencer", &self.sequencer)
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod beside_tests;
#[cfg(test)]
mod files_tests;
#[cfg(test)]
mod tests;
