//! A recorder: the streams of a running rig into files.
//!
//! | module | holds |
//! | --- | --- |
//! | [`part`] | one file |
//! | [`ring`] | the files of a recording, and those that go for newer ones |
//! | [`painting_copy`], [`on_the_way`] | the painting as it is at the beginning of a file |
//! | [`journal_watch`] | where the journal breaks off, and another file begins |
//! | [`voice`] | what a recorder says |

mod journal_watch;
mod on_the_way;
mod painting_copy;
mod part;
mod ring;
mod voice;

use std::collections::BTreeMap;
use std::path::Path;
use std::time::{Duration, Instant};

use maulstick_rig::UserError;
use maulstick_rig::files::create_private;
use maulstick_streams::Traffic;
use maulstick_streams::topic_pattern::matches;

use self::journal_watch::{Break, JournalWatch};
use self::painting_copy::PaintingCopy;
use self::part::Part;
pub(crate) use self::ring::Ring;
pub(crate) use self::voice::Voice;
use self::voice::{RecorderNews, Summary};
use super::listener::{Listener, ReceivedMessage};
use crate::commands::client::Target;
use crate::commands::takes::session_file::JOURNAL;

/// Shortest time of which the newest files are kept: each needs time for its painting.
pub(crate) const LEAST_LAST: Duration = Duration::from_secs(10);
/// Of a quota the part that one file has.
const QUOTA_FILES: u64 = 8;
/// At most so much is lost with this process.
const FLUSH: Duration = Duration::from_millis(500);
/// Shortest time of a file: however often a journal breaks off, or seems to, there are not thousands of them.
const SHORTEST: Duration = Duration::from_secs(1);

/// How a recording is divided into files, and which of them are kept.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Division {
    /// Most bytes of a file's messages, before they are compressed.
    pub most_bytes: Option<u64>,
    /// Longest time of a file.
    pub after: Option<Duration>,
    /// Time of which the newest files are kept.
    pub last: Option<Duration>,
    /// Most bytes of all files.
    pub quota_bytes: Option<u64>,
}

impl Division {
    fn most_of_a_file(&self) -> Option<u64> {
        let of_quota = self.quota_bytes.map(|quota| quota / QUOTA_FILES);
        self.most_bytes.into_iter().chain(of_quota).min()
    }

    fn time_of_a_file(&self) -> Option<Duration> {
        self.after.or(self.last.map(|last| last / ring::FILES))
    }
}

/// What is recorded, and how.
#[derive(Clone, Debug)]
pub(crate) struct RecorderSettings {
    /// The rig.
    pub target: Target,
    /// Topics, as a pattern.
    pub topic: String,
    /// Length of the recording, if it has an end of its own.
    pub lasts: Option<Duration>,
    /// Its files.
    pub division: Division,
    /// Most messages a second of each topic that are written as JSON too; 0 for none.
    pub json_hz: u32,
    /// Longest wait at the end for a copy of the painting that is being made.
    pub longest_wait: Duration,
    /// How it says what it does.
    pub voice: Voice,
}

/// How the first file is created.
pub(crate) use self::part::Create;

/// Records until this process is told to end, the time is over, or the rig ends.
///
/// # Errors
/// A [`UserError`] where a file cannot be written: what was written until then can be read.
pub(crate) fn record(
    settings: &RecorderSettings,
    listener: &mut Listener,
    mut ring: Ring,
    create: Create,
) -> Result<(), UserError> {
    let RecorderSettings {
        target, division, ..
    } = settings;
    let voice = settings.voice;
    let begin = |path: &Path, create: Create, listener: &Listener| {
        Part::begin(path, create, listener, settings.json_hz)
    };
    let begun = Instant::now();
    let end = settings.lasts.map(|lasts| begun + lasts);
    let paints = matches(&settings.topic, JOURNAL);
    let mut state = State::new(paints, listener);
    let mut part = begin(ring.newest(), create, listener)?;
    voice.say(&RecorderNews::Begun { file: part.path() })?;
    ring.trim()?;
    let mut flush_at = begun + FLUSH;
    let mut copy = paints.then(|| PaintingCopy::new(None, BTreeMap::new()));
    let mut watch = JournalWatch::default();
    // True where the rest of the file is no part of its session.
    let mut is_broken = false;
    while !listener.is_over() && end.is_none_or(|end| Instant::now() < end) {
        let until = end.map_or(flush_at, |end| end.min(flush_at));
        let received = listener.next(until);
        match received.as_ref().and_then(|own| watch.note(own)) {
            // What is missing is in the painting that the file will begin with.
            Some(Break::Gap) if copy.is_some() => {
                copy = Some(PaintingCopy::new(copy.take(), watch.unpainted()));
            }
            found => is_broken |= paints && found.is_some(),
        }
        let is_due = Instant::now() >= flush_at;
        let is_full = is_due
            && (division
                .most_of_a_file()
                .is_some_and(|most| part.bytes() >= most)
                || division
                    .time_of_a_file()
                    .is_some_and(|after| part.age() >= after));
        let breaks_off = is_broken && part.age() >= SHORTEST;
        // A copy belongs to the file at whose beginning it was asked for.
        let goes_on = is_full && !copy.as_ref().is_some_and(PaintingCopy::is_made);
        if breaks_off || goes_on {
            let next = ring.next().to_owned();
            finish(part, &mut state, listener, voice, Some(&next))?;
            part = begin(&next, create_private, listener)?;
            let file = part.path();
            voice.say(&match breaks_off {
                true => RecorderNews::BreaksOff { file },
                false => RecorderNews::GoesOn { file },
            })?;
            ring.trim()?;
            // What is sent rarely is in each file, from its beginning on.
            let now_ns = listener.member.bus.now_ns();
            for received in state.kept.values() {
                let mut again = received.clone();
                again.message.arrived_ns = now_ns;
                part.write(&again)?;
            }
            copy = paints.then(|| PaintingCopy::new(copy.take(), watch.unpainted()));
            is_broken = false;
        }
        if let Some(received) = received {
            part.write(&received)?;
            if let Some(copy) = &mut copy {
                copy.note(&received, voice)?;
            }
            state.add(received);
        }
        if !is_due {
            continue;
        }
        flush_at = Instant::now() + FLUSH;
        part.flush()?;
        if let Some(own) = &mut copy
            && let Some(painting) = own.look(target, voice)?
        {
            part.attach(&painting)?;
            voice.say(&RecorderNews::HasPainting { file: part.path() })?;
            copy = None;
        }
        if !listener.has_rig() {
            break;
        }
    }
    for received in listener.rest() {
        part.write(&received)?;
        state.add(received);
    }
    // A rig that ends copies nothing any more.
    let ended = Instant::now();
    let is_vain = || !listener.has_rig() || ended.elapsed() > settings.longest_wait;
    if let Some(painting) = copy.and_then(|copy| copy.wait(&is_vain)) {
        part.attach(&painting)?;
    }
    finish(part, &mut state, listener, voice, None)
}

/// Ends a file, with the name of the one in which the recording goes on, and says what it holds.
fn finish(
    part: Part,
    state: &mut State,
    listener: &Listener,
    voice: Voice,
    next: Option<&Path>,
) -> Result<(), UserError> {
    let (file, seconds) = (part.path().to_owned(), part.age().as_secs_f64());
    let lacks_painting = state.paints && !part.has_painting();
    let missing = state.missing(listener);
    let messages = part.finish(missing, next)?;
    let [lost, dropped, _] = missing;
    voice.say(&RecorderNews::Ended(Summary {
        bytes: std::fs::metadata(&file).map_or(0, |data| data.len()),
        file: &file,
        messages,
        seconds,
        lost,
        dropped,
        lacks_painting,
    }))
}

/// What was received so far, over all files.
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
