//! Journal records as a document saves them: accepted commands and states, to be accepted again.

use std::sync::Arc;

use maulstick_brush::BrushFile;
use maulstick_canvas::assets::Assets;
use maulstick_canvas::page::Pager;
use maulstick_canvas::tile::Version;
use maulstick_optics::PaintLibrary;
use maulstick_types::Edit;
use maulstick_types::brush::{BRUSHES_MOST, BrushState};
use maulstick_types::command::{Command, CommandRequest, Outcome, TakeCommand};
use maulstick_types::paint::{Decision, Entry};
use maulstick_types::values::BrushName;
use maulstick_types::{Header, Mixture, Origin};

use super::{NOT_PAINTED, Sequencer};
use crate::beginning::Beginning;
use crate::edits::Applied;
use crate::error::{BrushError, EditError};
use crate::painting::{Painting, Restored};
use crate::snapshot::{PaintingSnapshot, SequencerSnapshot};

/// The client that runs the sequencer.
const OWN: u64 = 0;

/// Something that was accepted.
#[derive(Clone, Debug, PartialEq)]
pub enum Accepted {
    /// A state of a brush.
    State {
        /// Header as received.
        header: Header,
        /// Itself.
        state: BrushState,
    },
    /// A command, a tick, a decision or a brush.
    Entry(Entry),
}

/// An accepted thing and its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// Counts all that was accepted, from 0.
    pub serial: u64,
    /// Index of its journal entry; a range of states shares one.
    pub index: u64,
    /// The thing.
    pub what: Accepted,
}

impl Record {
    /// Index of the next journal entry after it.
    #[must_use]
    pub fn next(&self) -> u64 {
        self.index + 1
    }
}

impl Sequencer {
    /// Keeps accepted messages from now on, for [`take_records`](Self::take_records).
    pub fn record(&mut self) {
        self.records.get_or_insert_default();
    }

    /// Keeps no accepted messages from now on.
    pub fn stop_recording(&mut self) {
        self.is_unrecorded |= self.records.take().is_some_and(|left| !left.is_empty());
    }

    /// True if something was accepted since the last call that is not among the [records](Self::take_records).
    pub fn take_unrecorded(&mut self) -> bool {
        std::mem::take(&mut self.is_unrecorded)
    }

    /// Number of accepted records.
    #[must_use]
    pub fn serial(&self) -> u64 {
        self.serial
    }

    /// Records accepted since the last call.
    pub fn take_records(&mut self) -> Vec<Record> {
        self.records
            .as_mut()
            .map(std::mem::take)
            .unwrap_or_default()
    }

    pub(super) fn note(&mut self, index: u64, what: impl FnOnce() -> Accepted) {
        let serial = self.serial;
        self.serial += 1;
        match &mut self.records {
            Some(records) => records.push(Record {
                serial,
                index,
                what: what(),
            }),
            None => self.is_unrecorded = true,
        }
    }

    /// Applies an edit of the sequencer's owner, at once.
    ///
    /// # Errors
    /// [`EditError`] where the painting refuses it.
    pub fn edit(&mut self, edit: impl Into<Edit>) -> Result<Applied, EditError> {
        let edit = edit.into();
        let applied = self.painting.apply(edit.clone())?;
        self.accept_own(edit.into());
        Ok(applied)
    }

    /// Begins a take of the sequencer's owner: its samples have this device and epoch.
    ///
    /// # Errors
    /// [`EditError`] where a load is wrong.
    pub fn begin_own_take(
        &mut self,
        brush: &str,
        [device, device_epoch]: [u32; 2],
        loads: Vec<Mixture>,
    ) -> Result<(), EditError> {
        let brush = BrushName::new(brush)?;
        self.begin_take(&brush, [device, device_epoch], &loads, false)?;
        let command = TakeCommand::Begin {
            brush,
            device,
            device_epoch,
            loads,
            again: false,
        };
        self.accept_own(command.into());
        Ok(())
    }

    fn accept_own(&mut self, command: Command) {
        let number = self.replies.newest(OWN).map_or(1, |newest| newest + 1);
        self.enter_command(OWN, number, command);
        self.remember(OWN, number, Outcome::done(""));
        self.drain_journal();
    }

    /// Resumes after the program ended: the next states of brushes begin new paths, and no take has a brush until its
    /// player is there again.
    pub fn resume(&mut self) {
        self.let_go();
        self.decide(Decision::Resumed);
    }

    fn let_go(&mut self) {
        self.painting.lift_brushes();
        let players = self.announced.values().map(|take| take.device);
        self.gone.extend(players);
    }

    /// True while a take is being played: its brush belongs to it.
    #[must_use]
    pub fn is_taking(&self) -> bool {
        let mut takes = self.announced.values();
        takes.any(|take| !take.ended && !self.gone.contains(&take.device))
    }

    /// Defines a brush, or replaces the file of a known one.
    ///
    /// # Errors
    /// [`BrushError::TooMany`] for a new one where there are [so many](BRUSHES_MOST).
    pub fn define_brush(&mut self, brush: &str, file: BrushFile) -> Result<(), EditError> {
        if !self.painting.knows_brush(brush) && self.painting.brushes().count() >= BRUSHES_MOST {
            return Err(BrushError::TooMany(brush.to_owned()).into());
        }
        let toml = file.to_toml().unwrap_or_default();
        if self.painting.define_brush(brush, file) {
            let entry = Entry::Brush {
                brush: brush.to_owned(),
                toml,
            };
            let index = self.enter(entry.clone());
            self.note(index, || Accepted::Entry(entry));
        }
        Ok(())
    }

    /// Accepts a saved record again. Its effect on the painting is repeated; its effect on the outside world is not.
    pub fn replay(&mut self, record: Record) {
        let (recording, is_unrecorded) = (self.records.take(), self.is_unrecorded);
        let next = record.next();
        self.next = record.index;
        match record.what {
            Accepted::State { header, state } => self.replay_state(&header, &state),
            Accepted::Entry(Entry::Command {
                client,
                number,
                command,
            }) => {
                let request = CommandRequest {
                    client,
                    number,
                    after: None,
                    command,
                };
                self.execute(&request);
            }
            Accepted::Entry(Entry::Decision { what }) => {
                if what == Decision::Resumed {
                    self.let_go();
                }
                self.decide(what);
            }
            Accepted::Entry(Entry::Tick { .. }) => self.painting.tick(),
            Accepted::Entry(cut @ Entry::Cut { .. }) => {
                if let Entry::Cut {
                    client,
                    number,
                    whole: true,
                    ..
                } = &cut
                {
                    let outcome = Outcome::Done {
                        journal: self.next,
                        detail: NOT_PAINTED,
                    };
                    self.remember(*client, *number, outcome);
                }
                self.drop_states(cut);
            }
            Accepted::Entry(Entry::States { .. }) => {}
            Accepted::Entry(Entry::Brush { brush, toml }) => {
                if let Ok(file) = BrushFile::parse(&toml) {
                    self.painting.define_brush(&brush, file);
                }
            }
        }
        self.journal.clear();
        self.next = next;
        self.serial = record.serial + 1;
        (self.records, self.is_unrecorded) = (recording, is_unrecorded);
    }

    /// Journals a change of the paint's backend, or a limit that it has met.
    pub(super) fn publish_backend_change(&mut self) {
        if let Some(limit) = self.painting.take_limit() {
            self.decide(limit);
        }
        if let Some(why) = self.painting.take_backend_change() {
            let name = self.painting.backend();
            self.decide(Decision::Fallback { name, why });
        }
    }

    fn replay_state(&mut self, header: &Header, state: &BrushState) {
        let brush = self.painting.brush_of(header.source).map(str::to_owned);
        if let Some(brush) = brush.filter(|_| state.fault().is_none()) {
            // A state that was refused then is refused now.
            self.paint(&brush, header, state).ok();
            self.consume(&brush, header);
        }
    }

    /// State of the sequencer besides its painting, for a document.
    #[must_use]
    pub fn kept(&self) -> SequencerSnapshot {
        let consumed = self.consumed.iter();
        SequencerSnapshot {
            next: self.next,
            serial: self.serial,
            takes: self.announced.clone(),
            gone: self.gone.iter().copied().collect(),
            cut: self.cut.clone(),
            consumed: consumed
                .map(|(origin, next)| (origin.source, origin.epoch, *next))
                .collect(),
            replies: self.replies.clone(),
            held: false,
        }
    }

    /// The sequencer of a painting as it was at the beginning of its record, to accept its records again; `assets` are
    /// the pictures and spectra of the painting, later ones among them.
    ///
    /// # Errors
    /// [`EditError`] if the stored parts do not fit together.
    pub fn begun(
        beginning: Arc<Beginning>,
        assets: Assets,
        library: PaintLibrary,
        pager: Arc<Pager>,
    ) -> Result<Self, EditError> {
        let number = beginning.painting.versions;
        let tiles = beginning.tiles.iter().map(|(place, tile)| {
            let tile = tile.clone();
            (*place, Version { number, tile })
        });
        let restored = Restored {
            tiles: tiles.collect(),
            loads: beginning.loads.clone(),
            steps: beginning.open.clone(),
            named: beginning.named.clone(),
            embedded: assets,
            kept: PaintingSnapshot {
                undone: Vec::new(),
                ..beginning.painting.clone()
            },
            beginning: Some(Arc::clone(&beginning)),
        };
        let painting = Painting::restore(restored, library, pager)?;
        Ok(Self::restored(painting, beginning.sequencer.clone()))
    }

    /// A sequencer restored from its snapshot.
    #[must_use]
    pub fn restored(mut painting: Painting, kept: SequencerSnapshot) -> Self {
        let consumed = kept
            .consumed
            .into_iter()
            .map(|(source, epoch, next)| (Origin { source, epoch }, next));
        let newest = kept.takes.values().map(|take| take.step).max();
        painting.part_history(newest.unwrap_or(0));
        Self {
            next: kept.next,
            serial: kept.serial,
            announced: kept.takes,
            gone: kept.gone.into_iter().collect(),
            cut: kept.cut,
            consumed: consumed.collect(),
            replies: kept.replies,
            ..Self::new(painting)
        }
    }
}
