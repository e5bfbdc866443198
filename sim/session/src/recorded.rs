//! A recorded session as the records that its paint node accepted: the entries of the journal, each with the brush states
//! that it names. Accepted again they give the same painting, byte for byte.

use std::collections::BTreeMap;

use maulstick_painting::Sequencer;
use maulstick_painting::sequencer::{Accepted, Record};
use maulstick_types::brush::BrushState;
use maulstick_types::paint::{Entry, JournalEntry};
use maulstick_types::{Header, name_hash};
use thiserror::Error;

/// A brush state by the source and the epoch of its brush, and its number.
type StateKey = (u32, u32, u64);

/// Reason why a session cannot be painted again.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum SessionFault {
    /// Entries of the journal are missing.
    #[error("entries {from} to {to} of the painting's journal are missing")]
    Entries {
        /// First missing entry.
        from: u64,
        /// Last missing entry.
        to: u64,
    },
    /// A brush state is missing.
    #[error("state {number} of the brush '{brush}' is missing")]
    State {
        /// Name of the brush.
        brush: String,
        /// Its number.
        number: u64,
    },
    /// The journal jumped to an earlier place, or was another painting's.
    #[error(
        "the rig went on in another painting, or at an earlier place of it (journal {found} after {known})"
    )]
    Another {
        /// Index of the newest entry before.
        known: u64,
        /// Index of the entry that followed.
        found: u64,
    },
    /// The session begins behind a place of the journal.
    #[error("it begins after place {place} of the painting's journal, at {first}")]
    Before {
        /// The place.
        place: u64,
        /// Index of its first entry.
        first: u64,
    },
    /// The session does not reach a place of the journal.
    #[error("it ends before place {place} of the painting's journal, at {last}")]
    Behind {
        /// The place.
        place: u64,
        /// Index of its last entry.
        last: u64,
    },
}

/// Entries and states of a session, put together in the order of the journal.
#[derive(Debug)]
pub struct RecordedSession {
    /// Index of the first entry.
    first: u64,
    /// Index of the next entry.
    next: u64,
    /// Index of the last entry that is of interest.
    last: u64,
    /// Number of the next record.
    serial: u64,
    /// Epoch of the paint node.
    epoch: Option<u32>,
    /// Entries that wait for their turn or for states.
    entries: BTreeMap<u64, Entry>,
    states: BTreeMap<StateKey, (Header, BrushState)>,
}

impl RecordedSession {
    /// A session that continues from a sequencer's place.
    #[must_use]
    pub fn after(sequencer: &Sequencer) -> Self {
        Self {
            first: sequencer.journal_next(),
            next: sequencer.journal_next(),
            last: u64::MAX,
            serial: sequencer.serial(),
            epoch: None,
            entries: BTreeMap::new(),
            states: BTreeMap::new(),
        }
    }

    /// The session up to and including a place of the journal; later records are skipped.
    #[must_use]
    pub fn until(self, place: u64) -> Self {
        Self {
            last: place,
            ..self
        }
    }

    /// Index of the next entry of the journal.
    #[must_use]
    pub fn next_index(&self) -> u64 {
        self.next
    }

    /// Adds a brush state.
    pub fn state(&mut self, header: Header, state: BrushState) {
        let key = (header.source, header.epoch, header.seq);
        self.states.insert(key, (header, state));
    }

    /// Adds an entry of the journal; one from before the session is skipped.
    ///
    /// # Errors
    /// [`SessionFault::Another`], or [`SessionFault::Entries`] where some are missing before it.
    pub fn entry(&mut self, header: &Header, entry: JournalEntry) -> Result<(), SessionFault> {
        if self.is_past() {
            return Ok(());
        }
        let known = self.epoch.replace(header.epoch);
        let newest = self.entries.last_key_value().map(|(index, _)| *index);
        let newest = newest.or(self.next.checked_sub(1));
        if known.is_some_and(|known| known != header.epoch)
            && let Some(known) = newest.filter(|newest| entry.index <= *newest)
        {
            return Err(SessionFault::Another {
                known,
                found: entry.index,
            });
        }
        let expected = newest.map_or(0, |newest| newest + 1).max(self.next);
        if entry.index > expected {
            return Err(SessionFault::Entries {
                from: expected,
                to: entry.index - 1,
            });
        }
        if entry.index >= self.next {
            self.entries.insert(entry.index, entry.entry);
        }
        Ok(())
    }

    /// The next complete record.
    ///
    /// # Errors
    /// [`SessionFault::State`] where a later state of the same brush has arrived, and that of the record has
    /// not.
    pub fn next_record(&mut self) -> Result<Option<Record>, SessionFault> {
        let index = self.next;
        if self.is_past() {
            return Ok(None);
        }
        let first = self.entries.first_entry();
        let Some(mut entry) = first.filter(|own| *own.key() == index) else {
            return Ok(None);
        };
        let what = match entry.get_mut() {
            Entry::States {
                brush,
                epoch,
                from,
                to,
            } => {
                let key = (name_hash(brush), *epoch, *from);
                let Some((header, state)) = self.states.remove(&key) else {
                    let mut later = self.states.range(key..(key.0, key.1, u64::MAX));
                    return match later.next() {
                        None => Ok(None),
                        Some(_) => Err(SessionFault::State {
                            brush: brush.clone(),
                            number: key.2,
                        }),
                    };
                };
                // Earlier ones were not accepted, and are dropped.
                let first = (key.0, key.1, 0);
                let passed: Vec<StateKey> =
                    self.states.range(first..key).map(|(key, _)| *key).collect();
                passed.iter().for_each(|key| drop(self.states.remove(key)));
                if from == to {
                    entry.remove();
                    self.next += 1;
                } else {
                    *from += 1;
                }
                Accepted::State { header, state }
            }
            _ => {
                self.next += 1;
                Accepted::Entry(entry.remove())
            }
        };
        let serial = self.serial;
        self.serial += 1;
        Ok(Some(Record {
            serial,
            index,
            what,
        }))
    }

    /// True once all up to the last place of interest has come.
    fn is_past(&self) -> bool {
        self.next > self.last
    }

    /// Checks that nothing is left over, and that the requested place was reached.
    ///
    /// # Errors
    /// [`SessionFault`] with the missing part.
    pub fn end(&self) -> Result<(), SessionFault> {
        let (place, first) = (self.last, self.first);
        if place.checked_add(1).is_some_and(|next| next < first) {
            return Err(SessionFault::Before { place, first });
        }
        if place < u64::MAX && self.next <= place && self.entries.is_empty() {
            let last = self.next.saturating_sub(1);
            return Err(SessionFault::Behind { place, last });
        }
        if self.is_past() {
            return Ok(());
        }
        match self.entries.first_key_value() {
            None => Ok(()),
            Some((index, Entry::States { brush, from, .. })) if *index == self.next => {
                Err(SessionFault::State {
                    brush: brush.clone(),
                    number: *from,
                })
            }
            Some((index, _)) => Err(SessionFault::Entries {
                from: self.next,
                to: index.saturating_sub(1),
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use maulstick_brush::BrushFile;
    use maulstick_optics::PaintLibrary;
    use maulstick_painting::{Painting, PaintingSetup};
    use maulstick_types::stylus::{StylusPose, StylusSample, axes};

    use super::*;
    use crate::Offline;

    const BRUSH: &str = "main";

    fn offline() -> Offline {
        let setup = PaintingSetup::default();
        let library = PaintLibrary::measured().expect("built in");
        let painting = Painting::new(&setup, library).expect("valid");
        let file = BrushFile::library("flat").expect("built in");
        let loads = vec!["Cobalt Blue=0.7,Titanium White=0.3".parse().expect("one")];
        Offline::new(painting, BRUSH, file, 0.5, loads).expect("valid")
    }

    /// Records of a stroke, and the painting that they gave.
    fn painted() -> (Vec<Record>, Painting) {
        let mut offline = offline();
        offline.sequencer_mut().record();
        for step in 0..=20u32 {
            let sample = StylusSample {
                senses: axes::POSITION | axes::PRESSURE,
                in_range: true,
                pose: StylusPose::Contact {
                    point_m: [1e-3 * f64::from(step) - 0.01, 0.0, 0.0],
                    tilt_rad: [0.4, 0.0],
                    twist_rad: 0.0,
                    pressure: if step == 20 { 0.0 } else { 0.5 },
                },
                ..StylusSample::away()
            };
            let sampled = offline.sample(u64::from(step) * 10_000_000, &sample);
            sampled.expect("it fits");
        }
        let records = offline.sequencer_mut().take_records();
        (records, offline.into_painting())
    }

    fn message(index: u64) -> Header {
        Header {
            version: 1,
            schema: 0,
            source: 1,
            epoch: 1,
            flags: maulstick_types::Flags::NONE,
            length: 0,
            seq: index,
            event_ns: 0,
            sent_ns: 0,
        }
    }

    /// Paints a session again whose messages arrive in disorder, without the states of `lost`.
    fn again(records: &[Record], lost: Option<usize>) -> (Painting, Result<(), SessionFault>) {
        let mut offline = offline();
        let sequencer = offline.sequencer_mut();
        let mut session = RecordedSession::after(sequencer);
        let mut fault = None;
        let mut accept = |session: &mut RecordedSession| {
            loop {
                match session.next_record() {
                    Ok(Some(record)) => sequencer.replay(record),
                    Ok(None) => return,
                    Err(found) => {
                        fault.get_or_insert(found);
                        return;
                    }
                }
            }
        };
        for (number, record) in records.iter().enumerate() {
            let Accepted::State { header, state } = &record.what else {
                continue;
            };
            let entry = JournalEntry {
                index: record.index,
                entry: Entry::States {
                    brush: BRUSH.into(),
                    epoch: header.epoch,
                    from: header.seq,
                    to: header.seq,
                },
            };
            session.entry(&message(record.index), entry).expect("known");
            accept(&mut session);
            if lost != Some(number) {
                session.state(*header, state.clone());
            }
            accept(&mut session);
        }
        let end = fault.map_or_else(|| session.end(), Err);
        (offline.into_painting(), end)
    }

    #[test]
    fn a_session_is_painted_again_and_a_lost_state_is_missed() {
        let (records, mut painting) = painted();
        let report =
            |painting: &mut Painting| serde_json::to_string(&painting.report()).expect("JSON");
        let (mut same, end) = again(&records, None);
        assert_eq!(end, Ok(()));
        assert_eq!(report(&mut same), report(&mut painting));
        let (mut other, end) = again(&records, Some(5));
        assert!(matches!(end, Err(SessionFault::State { brush, .. }) if brush == "main"));
        assert_ne!(report(&mut other), report(&mut painting));
    }

    #[test]
    fn a_session_ends_at_a_place_of_the_journal_whatever_comes_behind_it() {
        let mut offline = offline();
        let session = RecordedSession::after(offline.sequencer_mut());
        let first = session.next_index();
        let tick = |index: u64| JournalEntry {
            index,
            entry: Entry::Tick { count: index },
        };
        let header = message(0);
        let mut session = session.until(first + 1);
        for index in [first, first + 1, first + 2] {
            session.entry(&header, tick(index)).expect("the next");
        }
        let mut come = || session.next_record().expect("whole").map(|own| own.index);
        assert_eq!(
            [come(), come(), come()],
            [Some(first), Some(first + 1), None]
        );
        // Another painting and a gap behind the place are of no interest.
        let restarted = Header { epoch: 2, ..header };
        assert_eq!(session.entry(&restarted, tick(first)), Ok(()));
        assert_eq!(session.entry(&header, tick(first + 9)), Ok(()));
        assert_eq!(session.end(), Ok(()));
        let end = |sequencer: &Sequencer, place: u64| {
            let mut session = RecordedSession::after(sequencer).until(place);
            session.entry(&header, tick(first)).expect("known");
            session.next_record().expect("whole");
            session.end()
        };
        let sequencer = offline.sequencer_mut();
        let (place, last) = (first + 7, first);
        let behind = SessionFault::Behind { place, last };
        assert_eq!(end(sequencer, place), Err(behind));
        let place = first - 2;
        let before = SessionFault::Before { place, first };
        assert_eq!(end(sequencer, place), Err(before));
        assert_eq!(end(sequencer, first - 1), Ok(()), "its beginning");
    }

    #[test]
    fn gaps_and_other_paintings_are_told() {
        let mut offline = offline();
        let mut session = RecordedSession::after(offline.sequencer_mut());
        let next = session.next_index();
        let tick = |index: u64| JournalEntry {
            index,
            entry: Entry::Tick { count: index },
        };
        let header = message(0);
        session.entry(&header, tick(next)).expect("the next");
        let missing = SessionFault::Entries {
            from: next + 1,
            to: next + 2,
        };
        assert_eq!(session.entry(&header, tick(next + 3)), Err(missing));
        session.entry(&header, tick(next + 1)).expect("the next");
        let mut come = || session.next_record().expect("whole").is_some();
        assert!(come() && come() && !come());
        assert_eq!(session.end(), Ok(()));
        let restarted = Header { epoch: 2, ..header };
        let fault = session.entry(&restarted, tick(next + 1));
        assert!(matches!(fault, Err(SessionFault::Another { .. })));
    }
}
