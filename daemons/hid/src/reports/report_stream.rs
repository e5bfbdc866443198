//! Reports with their times, from a device or a recording.
//!
//! A live device is read on a thread of its own into a bounded queue, so that no stroke waits for the bus.
//! A recording is played by the rig's clock, and its reports have the times at which they were recorded:
//! the samples that follow do not depend on when the daemon takes its turns.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;

use maulstick_bus::{Bus, Inbox, Queue, Wake};
use maulstick_rig::UserError;
use maulstick_rig::thread::start;

use crate::device_source::HidSource;
use crate::recording::{Event, LONGEST_REPORT};

/// Capacity of the queue to the daemon: seconds of the fastest tablet.
const WAITING: usize = 8192;
/// Time that the thread waits for a report before it checks for its end.
const LIMIT: Duration = Duration::from_millis(100);

/// Item of a report stream.
#[derive(Debug)]
pub enum StreamItem {
    /// A report, at a time of the rig's clock.
    Report(Event),
    /// Nothing for now; the time of the next report, ns, if that is known.
    Nothing(Option<u64>),
    /// End of a recording.
    Over,
    /// Loss of the device.
    Lost(UserError),
}

/// Reports of a device in order.
#[derive(Debug)]
pub enum ReportStream {
    /// Of a device that is read now.
    Live(Live),
    /// Of a recording.
    Played(Played),
}

impl ReportStream {
    /// The next item that is due.
    pub fn next(&mut self, now_ns: u64) -> StreamItem {
        match self {
            Self::Live(live) => live.next(),
            Self::Played(played) => played.next(now_ns),
        }
    }

    /// Number of reports that did not fit into the queue.
    #[must_use]
    pub fn dropped(&self) -> u64 {
        match self {
            Self::Live(live) => live.inbox.counts().dropped,
            Self::Played(_) => 0,
        }
    }
}

/// Reports of a device that a thread reads.
#[derive(Debug)]
pub struct Live {
    inbox: Inbox<Result<Event, UserError>>,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Live {
    /// Starts to read a device; each report rings `wake` and carries the bus's time of its reading.
    ///
    /// # Errors
    /// A [`UserError`] where the system has no thread for it.
    pub fn start(
        mut source: Box<dyn HidSource>,
        bus: Arc<dyn Bus>,
        wake: &Wake,
    ) -> Result<Self, UserError> {
        let inbox = Inbox::new(Queue::Bounded(WAITING), wake);
        let stop = Arc::new(AtomicBool::new(false));
        let (queue, ended) = (inbox.clone(), Arc::clone(&stop));
        let run = move || {
            let mut report = vec![0; LONGEST_REPORT];
            while !ended.load(Ordering::Relaxed) {
                let read = match source.read(&mut report, LIMIT) {
                    Ok(0) => continue,
                    Ok(length) => Ok(Event {
                        time_ns: bus.now_ns(),
                        report: report[..length.min(report.len())].to_vec(),
                    }),
                    Err(fault) => Err(fault),
                };
                let is_over = read.is_err();
                queue.push(read);
                if is_over {
                    return;
                }
            }
        };
        Ok(Self {
            inbox,
            stop,
            thread: Some(start("hid", run)?),
        })
    }

    fn next(&mut self) -> StreamItem {
        match self.inbox.try_recv() {
            Some(Ok(event)) => StreamItem::Report(event),
            Some(Err(fault)) => StreamItem::Lost(fault),
            // A full queue lost the thread's last item.
            None if self.thread.as_ref().is_none_or(JoinHandle::is_finished)
                && self.inbox.is_empty() =>
            {
                StreamItem::Lost(
                    UserError::failure("the device is not read any more").help("plug it in again"),
                )
            }
            None => StreamItem::Nothing(None),
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
    /// Origin of the recorded times, rig clock, ns.
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

    fn next(&mut self, now_ns: u64) -> StreamItem {
        let Some(next) = self.events.as_slice().first() else {
            return StreamItem::Over;
        };
        let due_ns = self.start_ns + next.time_ns;
        if due_ns > now_ns {
            return StreamItem::Nothing(Some(due_ns));
        }
        match self.events.next() {
            Some(event) => StreamItem::Report(Event {
                time_ns: due_ns,
                ..event
            }),
            None => StreamItem::Over,
        }
    }
}
