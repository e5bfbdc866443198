//! The task that records: messages of a rig into one file after another.

use std::collections::BTreeMap;
use std::fs::File;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use maulstick_rig::files::create_private;
use maulstick_rig::pulse::Pulse;
use maulstick_streams::Traffic;
use maulstick_streams::topic_pattern::matches;
use maulstick_types::node::NodeStatus;
use tokio::sync::Notify;
use tokio::sync::mpsc::UnboundedSender;
use tokio::time::{Instant, MissedTickBehavior, interval, interval_at, sleep};

use super::event::{Continuation, CopyTrouble, FileSummary, RecorderEvent};
use super::journal_watch::{Break, JournalWatch};
use super::painting_copy::PaintingCopy;
use super::part::Part;
use super::ring::Ring;
use super::settings::RecorderSettings;
use crate::error::RecorderError;
use crate::listener::{Listener, ReceivedMessage};
use crate::session_file::JOURNAL;

/// Longest time of which messages are lost with this process.
const FLUSH: Duration = Duration::from_millis(500);
/// Time between two checks whether a status for the launcher is due.
const BEAT: Duration = Duration::from_nanos(NodeStatus::PERIOD_NS / 2);
/// Shortest time of a file: however often a journal breaks off, or seems to, there are not thousands of them.
const SHORTEST: Duration = Duration::from_secs(1);

/// A recording in progress.
pub(super) struct Recording {
    settings: RecorderSettings,
    /// Ends the wait for a copy of the painting.
    hurry: Arc<Notify>,
    listener: Listener,
    pulse: Option<Pulse>,
    events: UnboundedSender<RecorderEvent>,
    ring: Ring,
    part: Part,
    state: State,
    /// The copy of the painting for the present file, until it has it.
    copy: Option<PaintingCopy>,
    watch: JournalWatch,
    /// True where the rest of the file is no part of its session.
    is_broken: bool,
}

impl Recording {
    /// Records until the listener is asked to stop, the time is over, or the rig ends; then leaves the rig.
    ///
    /// # Errors
    /// A [`RecorderError`] where a file cannot be written: what was written until then can be read.
    pub(super) async fn record(
        (settings, hurry): (RecorderSettings, Arc<Notify>),
        ring: Ring,
        listener: Listener,
        pulse: Option<Pulse>,
        events: UnboundedSender<RecorderEvent>,
    ) -> Result<(), RecorderError> {
        let part = Part::begin(ring.newest(), ring.create, &listener, settings.json_hz)?;
        let paints = matches(&settings.topic, JOURNAL);
        let mut recording = Self {
            state: State::new(paints, &listener),
            settings,
            hurry,
            listener,
            pulse,
            events,
            ring,
            part,
            copy: paints.then(|| PaintingCopy::new(None, BTreeMap::new())),
            watch: JournalWatch::default(),
            is_broken: false,
        };
        let done = recording.run().await;
        recording.listener.member.leave();
        done
    }

    async fn run(&mut self) -> Result<(), RecorderError> {
        self.report(RecorderEvent::Begun {
            file: self.part.path().to_owned(),
        });
        self.ring.trim()?;
        let mut flush = interval_at(Instant::now() + FLUSH, FLUSH);
        flush.set_missed_tick_behavior(MissedTickBehavior::Delay);
        let mut beat = interval(BEAT);
        beat.set_missed_tick_behavior(MissedTickBehavior::Delay);
        let length = self.settings.length;
        let over = sleep(length.unwrap_or_default());
        tokio::pin!(over);
        loop {
            tokio::select! {
                received = self.listener.arrival() => match received {
                    Some(received) => self.write(received)?,
                    None => break,
                },
                copied = PaintingCopy::made(&mut self.copy) => self.attach(copied)?,
                _ = beat.tick() => self.beat(),
                _ = flush.tick() => {
                    self.flush()?;
                    if !self.listener.has_rig() {
                        break;
                    }
                }
                () = &mut over, if length.is_some() => break,
            }
        }
        self.finish().await
    }

    fn report(&self, event: RecorderEvent) {
        // An owner that has gone needs to know nothing.
        self.events.send(event).ok();
    }

    fn beat(&mut self) {
        let now_ns = self.listener.member.bus.now_ns();
        if let Some(Err(error)) = self.pulse.as_mut().map(|pulse| pulse.poll(now_ns)) {
            tracing::debug!("{error}");
        }
    }

    /// Writes a message: into another file where the journal broke off.
    fn write(&mut self, received: ReceivedMessage) -> Result<(), RecorderError> {
        match self.watch.note(&received) {
            // What is missing is in the painting that the file will begin with.
            Some(Break::Gap) if self.copy.is_some() => self.copy_anew(),
            found => self.is_broken |= self.state.paints && found.is_some(),
        }
        self.part_broken()?;
        self.part.write(&received)?;
        if let Some(copy) = &mut self.copy
            && let Some(trouble) = copy.note(&received)
        {
            self.report(RecorderEvent::PaintingUnavailable(trouble));
        }
        self.state.add(received);
        Ok(())
    }

    /// Writes what waits, into another file from then on where this one is full, and has the painting copied once it may be.
    fn flush(&mut self) -> Result<(), RecorderError> {
        let division = &self.settings.division;
        let most_bytes = division.most_of_a_file();
        let longest = division.time_of_a_file();
        let is_full = most_bytes.is_some_and(|most| self.part.bytes() >= most)
            || longest.is_some_and(|longest| self.part.age() >= longest);
        self.part_broken()?;
        // A copy belongs to the file at whose beginning it was asked for.
        if is_full && !self.copy.as_ref().is_some_and(PaintingCopy::is_made) {
            self.begin_next_file(Continuation::Full)?;
        }
        self.part.flush()?;
        if let Some(copy) = &mut self.copy {
            copy.begin_if_due(&self.listener.member);
        }
        Ok(())
    }

    fn part_broken(&mut self) -> Result<(), RecorderError> {
        if self.is_broken && self.part.age() >= SHORTEST {
            self.begin_next_file(Continuation::JournalBroke)?;
        }
        Ok(())
    }

    fn copy_anew(&mut self) {
        let unpainted = self.watch.unpainted();
        self.copy = Some(PaintingCopy::new(self.copy.take(), unpainted));
    }

    /// Goes on in another file.
    fn begin_next_file(&mut self, cause: Continuation) -> Result<(), RecorderError> {
        let next = self.ring.next().to_owned();
        self.end_file(Some(&next))?;
        let create: fn(&Path) -> std::io::Result<File> = create_private;
        self.part = Part::begin(&next, create, &self.listener, self.settings.json_hz)?;
        self.report(RecorderEvent::Continued { file: next, cause });
        self.ring.trim()?;
        // What is sent rarely is in each file, from its beginning on.
        let now_ns = self.listener.member.bus.now_ns();
        for received in self.state.kept.values() {
            let mut again = received.clone();
            again.message.arrived_ns = now_ns;
            self.part.write(&again)?;
        }
        if self.state.paints {
            self.copy_anew();
        }
        self.is_broken = false;
        Ok(())
    }

    /// Handles the end of a copy: the file has the painting, or the copy is made again later.
    fn attach(&mut self, copied: Result<Vec<u8>, RecorderError>) -> Result<(), RecorderError> {
        match copied {
            Ok(painting) => {
                self.part.attach(&painting)?;
                self.copy = None;
                self.report(RecorderEvent::PaintingAttached {
                    file: self.part.path().to_owned(),
                });
            }
            Err(fault) => {
                let copy = self.copy.as_mut();
                let trouble = copy.and_then(|copy| copy.refused(CopyTrouble::Failed(fault)));
                if let Some(trouble) = trouble {
                    self.report(RecorderEvent::PaintingUnavailable(trouble));
                }
            }
        }
        Ok(())
    }

    /// Writes what has arrived, and the painting whose copy is being made, and ends the file.
    async fn finish(&mut self) -> Result<(), RecorderError> {
        for received in self.listener.rest() {
            self.part.write(&received)?;
            self.state.add(received);
        }
        if self.copy.as_ref().is_some_and(PaintingCopy::is_made) {
            let copied = tokio::select! {
                copied = PaintingCopy::made(&mut self.copy) => Some(copied),
                // A rig that ends copies nothing any more.
                () = self.listener.rig_gone() => None,
                () = self.hurry.notified() => None,
                () = sleep(self.settings.longest_wait) => None,
            };
            if let Some(copied) = copied {
                self.attach(copied)?;
            }
        }
        self.end_file(None)
    }

    /// Ends a file, with the name of the one in which the recording goes on, and says what it holds.
    fn end_file(&mut self, next: Option<&Path>) -> Result<(), RecorderError> {
        let missing = self.state.missing(&self.listener);
        let [lost, dropped, _] = missing;
        let messages = self.part.finish(missing, next)?;
        let file = self.part.path().to_owned();
        self.report(RecorderEvent::FileEnded(FileSummary {
            bytes: std::fs::metadata(&file).map_or(0, |data| data.len()),
            file,
            messages,
            seconds: self.part.age().as_secs_f64(),
            lost,
            dropped,
            lacks_painting: self.state.paints && !self.part.has_painting(),
        }));
        Ok(())
    }
}

/// Messages received so far, over all files.
struct State {
    /// True if the journal of the painting is among the topics.
    paints: bool,
    traffic: Traffic,
    /// The last message of each topic that is kept for late joiners.
    kept: BTreeMap<String, ReceivedMessage>,
    /// Messages that were lost, dropped and foreign before this file.
    before: [u64; 3],
}

impl State {
    fn new(paints: bool, listener: &Listener) -> Self {
        Self {
            paints,
            traffic: Traffic::since(listener.member.bus.now_ns()),
            kept: BTreeMap::new(),
            before: [0; 3],
        }
    }

    fn add(&mut self, received: ReceivedMessage) {
        self.traffic.add(&received.topic, &received.message);
        if Listener::is_cached(&received.topic) {
            self.kept.insert(received.topic.clone(), received);
        }
    }

    /// Messages that were lost, dropped and foreign since the last question.
    fn missing(&mut self, listener: &Listener) -> [u64; 3] {
        let lost = self.traffic.streams().map(|(_, _, stream)| stream.lost);
        let all = [lost.sum(), listener.dropped(), listener.foreign];
        let before = std::mem::replace(&mut self.before, all);
        // One that came late after all was lost in the file before.
        std::array::from_fn(|place| all[place].saturating_sub(before[place]))
    }
}
