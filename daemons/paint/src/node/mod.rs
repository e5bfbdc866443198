//! The paint node: brush states and commands in; journal, credit, scene and frames out.

mod brush_files;
mod commands;
mod drying_clock;
mod files;
mod frame_feed;
mod inputs;
mod outputs;
mod proposal;
mod session;
mod status;

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use maulstick_appearance::picture::Export;
use maulstick_bus::typed::CommandServer;
use maulstick_bus::{Bus, BusError, Wake};
use maulstick_document::{Document, DocumentError};
use maulstick_painting::{Painting, Sequencer};
use maulstick_types::Origin;
use maulstick_types::node::NodeWork;
use maulstick_types::paint::Decision;
use maulstick_types::wire::topics::Topics;

use brush_files::BrushFiles;
use drying_clock::DryingClock;
use files::Files;
use frame_feed::FrameFeed;
use inputs::{Inputs, NextState};
use outputs::Outputs;
use proposal::Proposal;
use session::RepeatedSession;

use crate::frames::Feed;
use crate::thumbnails::Thumbnails;

/// States consumed in one turn before commands and frames have theirs.
const STATES_A_TURN: usize = 16;
/// Time after which a turn consumes no more states, ns: of a large brush each takes long.
const TURN_NS: u64 = 20_000_000;

/// The paint node.
pub struct PaintNode {
    bus: Arc<dyn Bus>,
    sequencer: Sequencer,
    inputs: Inputs,
    brush_files: BrushFiles,
    commands: CommandServer,
    /// The recorded session that is painted again, if one is.
    session: RepeatedSession,
    clock: DryingClock,
    /// Proposal of a lighter paint model, where it may still be made.
    proposal: Option<Proposal>,
    files: Files,
    thumbnails: Thumbnails,
    feed: FrameFeed,
    outputs: Outputs,
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
        Self::resume(bus, topics, wake, me, sequencer)
    }

    /// A node that resumes a painting where its sequencer is.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn resume(
        bus: Arc<dyn Bus>,
        topics: &Topics,
        wake: &Wake,
        me: Origin,
        sequencer: Sequencer,
    ) -> Result<Self, BusError> {
        let b = &*bus;
        Ok(Self {
            inputs: Inputs::new(b, topics, me, wake)?,
            brush_files: BrushFiles::new(b, topics, wake)?,
            commands: CommandServer::new(b, &topics.command("paint"), 256, me, wake)?,
            session: RepeatedSession::new(sequencer.is_repeating(), b.now_ns()),
            clock: DryingClock::default(),
            proposal: None,
            files: Files::default(),
            thumbnails: Thumbnails::new(b, &topics.thumbnail(), wake, me)?,
            feed: FrameFeed::new(sequencer.painting()),
            outputs: Outputs::new(&bus, topics, wake, me, sequencer.painting().scene())?,
            sequencer,
            bus,
        })
    }

    /// Sets the conversion of snapshots from the working space.
    #[must_use]
    pub fn exporting(mut self, export: Export) -> Self {
        self.files.set_export(export);
        self
    }

    /// Keeps the painting in a document, where its tiles up to the version `since` are.
    #[must_use]
    pub fn keeping(mut self, document: Document, since: u64) -> Self {
        let home = self.files.home_mut();
        home.keep(document, since, &mut self.sequencer);
        self
    }

    /// Keeps at most so many bytes of pages in memory once the painting gets a document.
    #[must_use]
    pub fn with_memory(mut self, bytes: usize) -> Self {
        self.files.home_mut().limit_memory(bytes);
        self
    }

    /// Proposes a lighter model for the canvas once painting falls behind: in the journal, which the window shows, and in
    /// the log.
    #[must_use]
    pub fn proposing_models(mut self) -> Self {
        self.proposal = Some(Proposal::default());
        self
    }

    /// The painting's file, if it has one.
    #[must_use]
    pub fn document_path(&self) -> Option<&Path> {
        self.files.home().document().map(Document::path)
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
        self.files.close(&mut self.sequencer)
    }

    /// Feed of the frames.
    #[must_use]
    pub fn feed(&self) -> Feed {
        self.feed.shared()
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

    /// Work since the start, and what waits.
    #[must_use]
    pub fn work(&self) -> NodeWork {
        let counts = self.inputs.counts();
        let (waiting, held) = self.inputs.waiting(self.sequencer.painting());
        NodeWork {
            consumed: counts.received,
            produced: self.outputs.entries(),
            waiting,
            held,
            refused: self.refused(),
            lost: counts.lost,
            too_fast: 0,
        }
    }

    /// Messages that it did not obey.
    fn refused(&self) -> u64 {
        self.inputs.refused()
            + self.brush_files.refused()
            + self.commands.refused()
            + self.sequencer.ignored()
    }

    /// Does all there is to do and returns how long to wait at most.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn poll(&mut self) -> Result<Duration, BusError> {
        let now_ns = self.bus.now_ns();
        let credit = self.outputs.credit_mut();
        self.brush_files.drain(&mut self.sequencer, credit);
        while let Some(presence) = self.inputs.next_presence() {
            // A take ends with its player, whatever it still had to play.
            if presence.is_there {
                self.sequencer.player_there(presence.node);
            } else {
                self.sequencer.player_gone(presence.node);
            }
        }
        self.inputs.poll(&*self.bus)?;
        self.serve_commands(now_ns);
        self.session.check(&mut self.sequencer, now_ns);
        self.clock.advance(&mut self.sequencer, now_ns);
        let is_more = self.consume_states(now_ns)?;
        self.propose_model();
        if self.inputs.take_unheard() {
            self.outputs.credit_mut().send_again();
        }
        self.outputs.publish_progress(&mut self.sequencer, now_ns)?;
        self.files.home_mut().save(&mut self.sequencer, now_ns);
        self.poll_background(now_ns);
        let painting = self.sequencer.painting_mut();
        self.thumbnails.poll(&*self.bus, painting);
        self.outputs.publish_scene(painting.scene(), now_ns)?;
        self.feed.update(&mut self.sequencer, now_ns);
        self.feed.update_loads(self.sequencer.painting(), now_ns);
        self.publish_status(now_ns)?;
        Ok(if is_more {
            Duration::ZERO
        } else {
            Duration::from_millis(10)
        })
    }

    /// Consumes the states of a turn; true where there may be more.
    fn consume_states(&mut self, now_ns: u64) -> Result<bool, BusError> {
        let until_ns = self.bus.now_ns() + TURN_NS;
        for number in 0..STATES_A_TURN {
            if number > 0 && self.bus.now_ns() >= until_ns {
                break;
            }
            if !self.consume_state(now_ns)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Consumes one state; false where none can be consumed now.
    fn consume_state(&mut self, now_ns: u64) -> Result<bool, BusError> {
        let (brush, received) = match self.inputs.next_state(self.sequencer.painting()) {
            NextState::None => return Ok(false),
            NextState::Foreign => return Ok(true),
            NextState::Of { brush, received } => (brush, received),
        };
        self.outputs.credit_mut().note(received.header.source);
        self.adopt_brushes();
        let newest = received.message.solves.last();
        self.outputs.note_solve(&brush, newest)?;
        let (replies, painted) = self
            .sequencer
            .state(&brush, &received.header, &received.message);
        for replied in replies {
            self.complete(replied);
        }
        if let Err(error) = painted {
            self.inputs.reject(&received.key, &error);
        }
        self.feed.update_while_painting(&mut self.sequencer, now_ns);
        Ok(true)
    }

    /// Adopts other files of known brushes before something is done with them. A session that is painted again has the
    /// brushes of then.
    fn adopt_brushes(&mut self) {
        if !self.session.is_running() {
            self.brush_files.adopt(&mut self.sequencer);
        }
    }

    /// Makes the proposal of a lighter model once it is due.
    fn propose_model(&mut self) {
        if !self.session.is_running()
            && let Some(proposal) = &mut self.proposal
            && proposal.poll(&mut self.sequencer)
        {
            self.proposal = None;
        }
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
