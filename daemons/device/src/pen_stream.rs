//! Samples of a pen on the bus, in order of time.
//!
//! A brush takes a leap of more than a tenth of a second for a new beginning, and many tablets are silent while nothing
//! changes. So the sample of a near and silent pen is repeated, and a resting stroke continues. Where nothing would say
//! that a pen is away, one that hovers in silence for a second counts as away.

use maulstick_bus::credit::Stamp;
use maulstick_bus::{BusError, CreditSender};
use maulstick_types::Flags;
use maulstick_types::stylus::StylusSample;

use crate::pen::{Pen, Presence, Reading};

/// Interval at which the sample of a silent pen is repeated, ns.
pub const REPEAT_NS: u64 = 50_000_000;
/// Silence after which a hovering pen counts as away, on tablets that do not report it, ns.
pub const GONE_NS: u64 = 1_000_000_000;
/// Samples are at least this far apart, ns: reports that were read together did not come together.
pub const SPACING_NS: u64 = 500_000;
/// A silence of more than this, ns, is not filled: the machine slept.
const LONGEST_NS: u64 = 60_000_000_000;

/// Outcome of a pen's reading on the desk.
pub trait DeskFit {
    /// Its sample.
    fn sample(&mut self, reading: &Reading) -> StylusSample;

    /// It was sent.
    fn sent(&mut self, _sample: &StylusSample) {}
}

/// A pen on the bus.
pub struct PenStream {
    pen: Pen,
    samples: CreditSender<StylusSample>,
    /// True if it is said when the pen is away.
    tells_range: bool,
    newest: StylusSample,
    event_ns: u64,
    /// When the pen was last read, ns.
    heard_ns: u64,
    sent: u64,
}

impl PenStream {
    /// A pen that is away.
    #[must_use]
    pub fn new(samples: CreditSender<StylusSample>) -> Self {
        Self {
            pen: Pen::default(),
            samples,
            tells_range: true,
            newest: StylusSample::away(),
            event_ns: 0,
            heard_ns: 0,
            sent: 0,
        }
    }

    /// True if the tablet reports that its pen is away.
    pub fn set_reports_range(&mut self, reports: bool) {
        self.tells_range = reports;
    }

    /// The newest sample that was sent.
    #[must_use]
    pub fn newest(&self) -> &StylusSample {
        &self.newest
    }

    /// Samples sent.
    #[must_use]
    pub fn sent(&self) -> u64 {
        self.sent
    }

    /// A reading of time `event_ns`.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn read(
        &mut self,
        reading: Reading,
        (event_ns, now_ns): (u64, u64),
        desk: &mut dyn DeskFit,
    ) -> Result<(), BusError> {
        // A reading at the same time needs no fill-in.
        self.silent(event_ns.saturating_sub(1), now_ns, desk)?;
        self.heard_ns = event_ns;
        let mut readings = Vec::with_capacity(3);
        self.pen.follow(reading, &mut |told| readings.push(told));
        self.tell(&readings, (event_ns, now_ns), desk)
    }

    /// Nothing came until `until_ns`.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn silent(
        &mut self,
        until_ns: u64,
        now_ns: u64,
        desk: &mut dyn DeskFit,
    ) -> Result<(), BusError> {
        if self.newest.in_range && until_ns.saturating_sub(self.event_ns) > LONGEST_NS {
            self.event_ns = until_ns;
        }
        let gone_ns = self.gone_ns().filter(|gone_ns| *gone_ns <= until_ns);
        let near_ns = gone_ns.unwrap_or(until_ns);
        while self.newest.in_range && self.event_ns + REPEAT_NS <= near_ns {
            let stamp = (self.event_ns + REPEAT_NS, now_ns);
            self.send(self.newest.clone(), stamp, desk)?;
        }
        match gone_ns {
            Some(gone_ns) => self.leave(gone_ns, now_ns, desk),
            None => Ok(()),
        }
    }

    /// Time at which a hovering pen counts as away, ns; `None` if that will be said.
    fn gone_ns(&self) -> Option<u64> {
        let hovers = self.pen.newest().presence == Presence::Hovering;
        (hovers && !self.tells_range).then_some(self.heard_ns + GONE_NS)
    }

    /// The pen is gone at `event_ns`, or its tablet: it is lifted, and leaves.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn leave(
        &mut self,
        event_ns: u64,
        now_ns: u64,
        desk: &mut dyn DeskFit,
    ) -> Result<(), BusError> {
        let mut readings = Vec::with_capacity(2);
        self.pen.leave(&mut |told| readings.push(told));
        self.tell(&readings, (event_ns, now_ns), desk)
    }

    /// Answers for lost samples. Nobody waits for credit on a live device.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn serve(&mut self, now_ns: u64) -> Result<(), BusError> {
        self.samples.reset_credit();
        self.samples.serve(now_ns)
    }

    /// Time at which the sample of a silent pen is due again, ns.
    #[must_use]
    pub fn due_ns(&self) -> Option<u64> {
        self.newest.in_range.then_some(self.event_ns + REPEAT_NS)
    }

    fn tell(
        &mut self,
        readings: &[Reading],
        at: (u64, u64),
        desk: &mut dyn DeskFit,
    ) -> Result<(), BusError> {
        for reading in readings {
            let sample = desk.sample(reading);
            self.send(sample, at, desk)?;
        }
        Ok(())
    }

    fn send(
        &mut self,
        sample: StylusSample,
        (event_ns, now_ns): (u64, u64),
        desk: &mut dyn DeskFit,
    ) -> Result<(), BusError> {
        self.event_ns = event_ns.max(self.event_ns + SPACING_NS);
        let stamp = Stamp {
            now_ns,
            event_ns: self.event_ns,
        };
        self.samples.send(Flags::NONE, stamp, &sample)?;
        desk.sent(&sample);
        self.newest = sample;
        self.sent += 1;
        Ok(())
    }
}

impl std::fmt::Debug for PenStream {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PenStream")
            .field("pen", &self.pen)
            .field("sent", &self.sent)
            .finish_non_exhaustive()
    }
}
