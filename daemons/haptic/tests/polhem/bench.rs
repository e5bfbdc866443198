//! A stylus' firmware at a wire on a virtual clock, with what may go wrong on the way, and the beat of a
//! servo over it.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard};

use glam::DVec3;
use maulstick_haptic::device::driver::{DeviceError, Driver, Reading, Wrench};
use maulstick_haptic::drivers::polhem::Polhem;
use maulstick_haptic::drivers::polhem::frame::Length;
use maulstick_haptic::drivers::polhem::link::Wire;
use nix::errno::Errno;

use super::firmware::{Firmware, Reads, Style};

/// The servo's own: a tick without a reading for longer writes no force.
const LONGEST_S: f64 = 0.005;

/// Devices on the bench.
pub(crate) struct Bench {
    pub(crate) firmware: Firmware,
    pub(crate) now_s: f64,
    /// Delay of an answer, s.
    pub(crate) latency_s: f64,
    /// Bytes that a read gives at most.
    pub(crate) piece: usize,
    /// Bytes that a write takes at most; none where 0.
    pub(crate) room: usize,
    /// Bytes after which the wire is full.
    pub(crate) left: usize,
    /// Answers to come that are lost.
    pub(crate) losses: usize,
    /// Sent ahead of each answer.
    pub(crate) garbage: Vec<u8>,
    /// Error of every call of the wire.
    pub(crate) broken: Option<Errno>,
    /// Bytes that the host sent, call by call.
    pub(crate) sent: Vec<Vec<u8>>,
    /// On its way to the host, with when it is there.
    coming: VecDeque<(f64, u8)>,
}

/// The host's end.
#[derive(Clone)]
pub(crate) struct Cable(Arc<Mutex<Bench>>);

impl Cable {
    pub(crate) fn to(firmware: Firmware) -> Self {
        Self(Arc::new(Mutex::new(Bench {
            firmware,
            now_s: 0.0,
            latency_s: 0.0,
            piece: usize::MAX,
            room: usize::MAX,
            left: usize::MAX,
            losses: 0,
            garbage: Vec::new(),
            broken: None,
            sent: Vec::new(),
            coming: VecDeque::new(),
        })))
    }

    pub(crate) fn bench(&self) -> MutexGuard<'_, Bench> {
        self.0.lock().expect("no test panics with it")
    }

    pub(crate) fn advance(&self, step_s: f64) {
        let mut bench = self.bench();
        bench.now_s += step_s;
        let now_s = bench.now_s;
        bench.firmware.watch(now_s);
    }
}

impl Wire for Cable {
    fn read(&mut self, bytes: &mut [u8]) -> Result<usize, Errno> {
        let mut bench = self.bench();
        if let Some(errno) = bench.broken {
            return Err(errno);
        }
        let (now_s, most) = (bench.now_s, bench.piece.min(bytes.len()));
        let mut count = 0;
        while count < most
            && let Some((at_s, byte)) = bench.coming.front().copied()
            && at_s <= now_s
        {
            bytes[count] = byte;
            bench.coming.pop_front();
            count += 1;
        }
        match count {
            0 => Err(Errno::EAGAIN),
            count => Ok(count),
        }
    }

    fn write(&mut self, bytes: &[u8]) -> Result<usize, Errno> {
        let mut bench = self.bench();
        if let Some(errno) = bench.broken {
            return Err(errno);
        }
        let room = bench.room.min(bench.left);
        if room == 0 {
            return Err(Errno::EAGAIN);
        }
        let bytes = &bytes[..bytes.len().min(room)];
        bench.left -= bytes.len();
        bench.sent.push(bytes.to_vec());
        let now_s = bench.now_s;
        let answer = bench.firmware.hear(bytes, now_s);
        if bench.losses > 0 && !answer.is_empty() {
            bench.losses -= 1;
            return Ok(bytes.len());
        }
        let at_s = now_s + bench.latency_s;
        let line = [bench.garbage.clone(), answer].concat();
        bench
            .coming
            .extend(line.into_iter().map(|byte| (at_s, byte)));
        Ok(bytes.len())
    }
}

/// A servo's beat over a driver, a millisecond at a time.
pub(crate) struct TickHarness {
    pub(crate) polhem: Polhem<Cable>,
    pub(crate) cable: Cable,
    waited_s: f64,
    /// The longest time from a reading to the next, s.
    pub(crate) longest_s: f64,
}

impl TickHarness {
    pub(crate) fn over(style: Style, reads: Reads, length: Length) -> Self {
        let cable = Cable::to(Firmware::new(style, reads));
        let mut harness = Self {
            polhem: Polhem::new(cable.clone(), length),
            cable,
            waited_s: 0.0,
            longest_s: 0.0,
        };
        // The first pose, as after waking.
        while harness.tick(DVec3::ZERO).expect("there").is_none() {}
        harness.longest_s = 0.0;
        harness
    }

    /// A tick in which the servo asks for `force`, if there is a reading.
    pub(crate) fn tick(&mut self, force: DVec3) -> Result<Option<Reading>, DeviceError> {
        self.cable.advance(1e-3);
        self.waited_s += 1e-3;
        self.longest_s = self.longest_s.max(self.waited_s);
        let reading = self.polhem.read(self.waited_s)?;
        let force = match reading {
            Some(_) => force,
            None if self.waited_s > LONGEST_S => DVec3::ZERO,
            None => return Ok(None),
        };
        if reading.is_some() {
            self.waited_s = 0.0;
        }
        self.polhem.write(Wrench {
            force,
            torque: DVec3::ZERO,
        })?;
        Ok(reading)
    }

    /// So many ticks; how many of them had a reading.
    pub(crate) fn ticks(&mut self, count: usize, force: DVec3) -> usize {
        (0..count)
            .filter(|_| self.tick(force).expect("there").is_some())
            .count()
    }

    /// Force on the hand, device frame, N.
    pub(crate) fn felt(&self) -> DVec3 {
        let theirs = self.cable.bench().firmware.force();
        DVec3::new(theirs[1], theirs[2], theirs[0])
    }
}
