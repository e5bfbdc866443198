//! Reports with their times, live or from a recording.
//!
//! A live device is read on a thread of its own into a bounded queue, so that no stroke waits for the bus.
//! A recording is played by the rig's clock, and its reports have the times at which they were recorded:
//! the samples that follow do not depend on when the daemon takes its turns.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;

use maulstick_bus::{Bus, Inbox, Queue, Wake};
use maulstick_rig::Fault;

use crate::recording::{Event, LONGEST_REPORT};
use crate::source::HidSource;

/// Reports that wait for the daemon: seconds of the fastest tablet.
const WAITING: usize = 8192;
/// How long the thread waits for a report before it looks whether to end.
const LIMIT: Duration = Duration::from_millis(100);

/// What a feed gives.
#[derive(Debug)]
pub enum Heard {
    /// A report, at a time of the rig's clock.
    Report(Event),
    /// Nothing for now; the time at which there will be something, ns, where that is known.
    Nothing(Option<u64>),
    /// A recording is over.
    Over,
    /// The device is gone.
    Lost(Fault),
}

/// A device's reports in order.
#[derive(Debug)]
pub enum Feed {
    /// Of a device.
    Live(Live),
    /// Of a recording.
    Played(Played),
}

impl Feed {
    /// The next report that is due.
    pub fn hear(&mut self, now_ns: u64) -> Heard {
        match self {
            Self::Live(live) => live.hear(),
            Self::Played(played) => played.hear(now_ns),
        }
    }

    /// Reports that did not fit into the queue.
    #[must_use]
    pub fn dropped(&self) -> u64 {
        match self {
            Self::Live(live) => live.inbox.counts().dropped,
            Self::Played(_) => 0,
        }
    }
}

/// A device that a thread reads.
#[derive(Debug)]
pub struct Live {
    inbox: Inbox<Result<Event, Fault>>,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Live {
    /// Starts to read a device; each report rings `wake` and has the bus's time of its reading.
    ///
    /// # Errors
    /// A [`Fault`] where the system has no thread for it.
    pub fn start(
        mut source: Box<dyn HidSource>,
        bus: Arc<dyn Bus>,
        wake: &Wake,
    ) -> Result<Self, Fault> {
        let inbox = Inbox::new(Queue::Bounded(WAITING), wake);
        let stop = Arc::new(AtomicBool::new(false));
        let (queue, ended) = (inbox.clone(), Arc::clone(&stop));
        let read = move || {
            let mut report = vec![0; LONGEST_REPORT];
            while !ended.load(Ordering::Relaxed) {
                let heard = match source.read(&mut report, LIMIT) {
                    Ok(0) => continue,
                    Ok(length) => Ok(Event {
                        time_ns: bus.now_ns(),
                        report: report[..length.min(report.len())].to_vec(),
                    }),
                    Err(fault) => Err(fault),
                };
                let is_over = heard.is_err();
                queue.push(heard);
                if is_over {
                    return;
                }
            }
        };
        let thread = std::thread::Builder::new()
            .name("hid".into())
            .spawn(read)
            .map_err(|error| Fault::failure(format!("the device has no thread: {error}")))?;
        Ok(Self {
            inbox,
            stop,
            thread: Some(thread),
        })
    }

    fn hear(&mut self) -> Heard {
        match self.inbox.try_recv() {
            Some(Ok(event)) => Heard::Report(event),
            Some(Err(fault)) => Heard::Lost(fault),
            // A queue that was full lost the thread's last word.
            None if self.thread.as_ref().is_none_or(JoinHandle::is_finished)
                && self.inbox.is_empty() =>
            {
                Heard::Lost(
                    Fault::failure("the device is not read any more").help("plug it in again"),
                )
            }
            None => Heard::Nothing(None),
        }
    }
}

impl Drop for Live {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            thread.join().ok();
        }
    }
}

/// A recording that is played once.
#[derive(Debug)]
pub struct Played {
    events: std::vec::IntoIter<Event>,
    /// Recorded times are from here, rig clock, ns.
    start_ns: u64,
}

impl Played {
    /// Plays from `now_ns` on; the first report is due then.
    #[must_use]
    pub fn start(events: Vec<Event>, now_ns: u64) -> Self {
        let first = events.first().map_or(0, |event| event.time_ns);
        Self {
            events: events.into_iter(),
            start_ns: now_ns.saturating_sub(first),
        }
    }

    fn hear(&mut self, now_ns: u64) -> Heard {
        let Some(next) = self.events.as_slice().first() else {
            return Heard::Over;
        };
        let due_ns = self.start_ns + next.time_ns;
        if due_ns > now_ns {
            return Heard::Nothing(Some(due_ns));
        }
        match self.events.next() {
            Some(event) => Heard::Report(Event {
                time_ns: due_ns,
                ..event
            }),
            None => Heard::Over,
        }
    }
}
