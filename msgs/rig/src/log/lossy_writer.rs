//! Lines that a thread of their own writes: a terminal that stands still, or a pipe whose reader waits, holds up nobody who
//! has something to say. Beyond a bound the oldest lines are dropped; how many is said when lines flow again.

use std::collections::VecDeque;
use std::io::{self, Write};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use tracing_subscriber::fmt::MakeWriter;

/// Most bytes that wait to be written.
const ROOM: usize = 1 << 20;
/// Most bytes that are written at once, or one line.
const BATCH: usize = 1 << 16;

/// The way to a thread that writes lines. Nothing here waits for that thread, but for [`Self::flush_within`].
#[derive(Clone, Debug)]
pub(super) struct LossyWriter(Arc<Queue>);

/// Lines on their way to the thread.
#[derive(Debug, Default)]
struct Queue {
    waiting: Mutex<Waiting>,
    /// A line has come, or all are written.
    changed: Condvar,
}

#[derive(Debug, Default)]
struct Waiting {
    lines: VecDeque<Vec<u8>>,
    bytes: usize,
    /// Lines dropped since the last that was written.
    dropped: u64,
    is_writing: bool,
}

impl LossyWriter {
    /// Starts the thread that writes to `to`.
    ///
    /// # Errors
    /// The system's, where there is no thread for it.
    pub(super) fn start(mut to: impl Write + Send + 'static) -> io::Result<Self> {
        let writer = Self(Arc::default());
        let queue = Arc::clone(&writer.0);
        let write = move || {
            loop {
                let text = queue.next();
                // Whoever has closed the other end has lost nothing.
                to.write_all(&text).and_then(|()| to.flush()).ok();
            }
        };
        std::thread::Builder::new()
            .name("log".into())
            .spawn(write)?;
        Ok(writer)
    }

    /// Has whole lines written after all others.
    pub(super) fn push(&self, lines: &[u8]) {
        let mut waiting = self.0.lock();
        waiting.push(lines.to_vec());
        drop(waiting);
        self.0.changed.notify_all();
    }

    /// Has a passing display written, if nothing else waits.
    pub(super) fn show(&self, display: &[u8]) {
        let mut waiting = self.0.lock();
        if waiting.lines.is_empty() && !waiting.is_writing {
            waiting.push(display.to_vec());
        }
        drop(waiting);
        self.0.changed.notify_all();
    }

    /// Waits until all is written, at most for `limit`; true if it is.
    pub(super) fn flush_within(&self, limit: Duration) -> bool {
        let give_up = Instant::now() + limit;
        let mut waiting = self.0.lock();
        while !waiting.is_done() {
            let left = give_up.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return false;
            }
            let woken = self.0.changed.wait_timeout(waiting, left);
            waiting = woken.unwrap_or_else(PoisonError::into_inner).0;
        }
        true
    }
}

impl Queue {
    fn lock(&self) -> MutexGuard<'_, Waiting> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The next lines to be written, once there are some; those before are written.
    fn next(&self) -> Vec<u8> {
        let mut waiting = self.lock();
        waiting.is_writing = false;
        self.changed.notify_all();
        while waiting.is_done() {
            let woken = self.changed.wait(waiting);
            waiting = woken.unwrap_or_else(PoisonError::into_inner);
        }
        waiting.is_writing = true;
        waiting.take()
    }
}

impl Waiting {
    fn is_done(&self) -> bool {
        self.lines.is_empty() && self.dropped == 0 && !self.is_writing
    }

    fn push(&mut self, line: Vec<u8>) {
        if line.len() > ROOM {
            self.dropped += 1;
            return;
        }
        self.bytes += line.len();
        self.lines.push_back(line);
        while self.bytes > ROOM {
            let oldest = self.lines.pop_front();
            self.bytes -= oldest.map_or(0, |line| line.len());
            self.dropped += 1;
        }
    }

    /// As many lines as are written at once; before them how many are missing.
    fn take(&mut self) -> Vec<u8> {
        let mut text = match std::mem::take(&mut self.dropped) {
            0 => Vec::new(),
            dropped => format!(
                " WARN {dropped} lines of the messages were dropped: nobody read them in time\n"
            )
            .into_bytes(),
        };
        while let Some(line) = self.lines.pop_front() {
            self.bytes -= line.len();
            text.extend_from_slice(&line);
            let next = self.lines.front().map_or(0, Vec::len);
            if text.len() + next > BATCH {
                break;
            }
        }
        text
    }
}

/// An event of the log comes as one piece.
impl Write for LossyWriter {
    fn write(&mut self, line: &[u8]) -> io::Result<usize> {
        self.push(line);
        Ok(line.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl<'a> MakeWriter<'a> for LossyWriter {
    type Writer = Self;

    fn make_writer(&'a self) -> Self {
        self.clone()
    }
}

#[cfg(test)]
mod tests {
    use std::fs::File;
    use std::io::{BufRead as _, BufReader};

    use super::*;

    const SOON: Duration = Duration::from_millis(50);
    const PATIENCE: Duration = Duration::from_secs(60);

    fn pipe() -> (File, File) {
        let (read, write) = nix::unistd::pipe().expect("a pipe");
        (read.into(), write.into())
    }

    /// A line of a kilobyte with its number.
    fn line(number: u64) -> Vec<u8> {
        format!("{number:01023}\n").into_bytes()
    }

    #[test]
    fn a_pipe_that_nobody_reads_holds_nobody_up_and_what_is_lost_is_counted() {
        let (read, write) = pipe();
        let writer = LossyWriter::start(write).expect("a thread");
        let pushed = 4 * ROOM as u64 / 1024;
        (0..pushed).for_each(|number| writer.push(&line(number)));
        assert!(!writer.flush_within(SOON), "a full pipe has no room");
        // It flows again.
        let reader = std::thread::spawn(move || {
            let lines = BufReader::new(read).lines().map_while(Result::ok);
            let lines = lines.take_while(|line| line != "last");
            lines.partition(|line| line.parse::<u64>().is_ok())
        });
        assert!(writer.flush_within(PATIENCE), "all of it is read");
        writer.push(b"last\n");
        let (kept, notices): (Vec<String>, Vec<String>) = reader.join().expect("read");
        let counts = notices.iter().flat_map(|notice| notice.split_whitespace());
        let dropped: u64 = counts.filter_map(|word| word.parse::<u64>().ok()).sum();
        assert!(dropped > 0);
        assert_eq!(kept.len() as u64 + dropped, pushed);
    }

    #[test]
    fn the_newest_lines_stay_and_the_place_of_the_others_has_their_number() {
        let mut waiting = Waiting::default();
        let pushed = 3 * ROOM as u64 / 1024;
        (0..pushed).for_each(|number| waiting.push(line(number)));
        assert!(waiting.bytes <= ROOM);
        let mut text = Vec::new();
        while !waiting.lines.is_empty() {
            text.extend(waiting.take());
        }
        let text = String::from_utf8(text).expect("text");
        let (notice, rest) = text.split_once('\n').expect("lines");
        let dropped: u64 = notice
            .split_whitespace()
            .find_map(|word| word.parse().ok())
            .expect("a count");
        let kept: Vec<u64> = rest
            .lines()
            .map(|line| line.parse().expect("whole"))
            .collect();
        assert!(kept.iter().copied().eq(dropped..pushed), "{notice}");
        assert_eq!((waiting.bytes, waiting.dropped), (0, 0));
    }

    #[test]
    fn a_line_larger_than_all_room_is_counted_and_a_display_never_waits() {
        let mut waiting = Waiting::default();
        waiting.push(vec![b'x'; ROOM + 1]);
        assert_eq!((waiting.bytes, waiting.dropped), (0, 1));
        let (_read, write) = pipe();
        let writer = LossyWriter::start(write).expect("a thread");
        (0..200).for_each(|number| writer.push(&line(number)));
        assert!(!writer.flush_within(SOON));
        let before = writer.0.lock().lines.len();
        writer.show(b"50 %\r");
        assert_eq!(writer.0.lock().lines.len(), before);
    }
}
