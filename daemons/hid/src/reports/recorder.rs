//! Writes a device's reports as a recording, on a thread that nobody waits for until it ends.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{SyncSender, TrySendError, sync_channel};
use std::thread::JoinHandle;

use maulstick_rig::UserError;
use maulstick_rig::files::{Kind, check_writable, write_whole};
use maulstick_rig::thread::start;

use crate::device_source::Identity;
use crate::recording::{Event, Recorded};

/// Lines that wait for the disk.
const WAITING: usize = 65_536;

/// A recording that is being written: it has its name once it is whole.
#[derive(Debug)]
pub struct Recorder {
    path: PathBuf,
    lines: Option<SyncSender<String>>,
    thread: Option<JoinHandle<std::io::Result<()>>>,
    devices: Vec<Recorded>,
    start_ns: Option<u64>,
    lost: u64,
}

impl Recorder {
    /// Begins a recording.
    ///
    /// # Errors
    /// A [`UserError`] where the file cannot be written.
    pub fn begin(path: &Path) -> Result<Self, UserError> {
        check_writable(path, Kind::Recording).map_err(|error| UserError::writing(path, &error))?;
        let (lines, written) = sync_channel::<String>(WAITING);
        let to = path.to_owned();
        let write = move || {
            write_whole(&to, Kind::Recording, |file| {
                let mut lines = written.iter();
                lines.try_for_each(|line| file.write_all(line.as_bytes()))
            })
        };
        Ok(Self {
            path: path.to_owned(),
            lines: Some(lines),
            thread: Some(start("recorder", write)?),
            devices: Vec::new(),
            start_ns: None,
            lost: 0,
        })
    }

    /// A device was opened: what follows is of it.
    pub fn device(&mut self, identity: &Identity, descriptor: &[u8]) {
        let device = Recorded {
            identity: identity.clone(),
            descriptor: descriptor.to_vec(),
            events: Vec::new(),
        };
        // Plugged in again it is the same one, wherever.
        let same = |known: &Recorded| {
            let Identity {
                vendor, product, ..
            } = known.identity;
            known.descriptor == device.descriptor
                && (vendor, product) == (identity.vendor, identity.product)
        };
        let known = self.devices.iter().position(same);
        let number = u32::try_from(known.unwrap_or(self.devices.len())).unwrap_or(u32::MAX);
        match known {
            Some(_) => self.line(format!("D: {number}\n")),
            None => {
                self.line(device.heading(number));
                self.devices.push(device);
            }
        }
    }

    /// A report came.
    pub fn event(&mut self, event: &Event) {
        let start_ns = *self.start_ns.get_or_insert(event.time_ns);
        let since = Event {
            time_ns: event.time_ns.saturating_sub(start_ns),
            report: event.report.clone(),
        };
        self.line(since.line());
    }

    fn line(&mut self, line: String) {
        let Some(lines) = &self.lines else {
            return;
        };
        match lines.try_send(line) {
            Ok(()) => {}
            Err(TrySendError::Full(_)) => {
                if self.lost == 0 {
                    tracing::warn!(
                        "{}: the disk is too slow, reports are missing",
                        self.path.display()
                    );
                }
                self.lost += 1;
            }
            // The thread has ended by a fault, which `end` returns.
            Err(TrySendError::Disconnected(_)) => self.lines = None,
        }
    }

    /// Ends the recording: it is there under its name.
    ///
    /// # Errors
    /// A [`UserError`] where it could not be written.
    pub fn end(mut self) -> Result<(), UserError> {
        self.lines = None;
        match self.thread.take().map(JoinHandle::join) {
            Some(Ok(Ok(()))) | None => Ok(()),
            Some(Ok(Err(error))) => Err(UserError::writing(&self.path, &error)),
            Some(Err(_)) => Err(UserError::failure(
                "the recording has ended by a fault of its own",
            )
            .help("its own message above says why")),
        }
    }
}

/// Also where the daemon fails, what was recorded until then is whole.
impl Drop for Recorder {
    fn drop(&mut self) {
        self.lines = None;
        if let Some(thread) = self.thread.take() {
            thread.join().ok();
        }
    }
}
