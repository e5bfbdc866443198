//! Working time: that of brushes in contact and of short pauses between strokes.

use maulstick_painting::sequencer::{Accepted, Record};
use maulstick_types::brush::{BrushState, Solve, solve_flags};
use maulstick_types::command::Command;
use maulstick_types::paint::Entry;

/// A longer pause between two contacts counts as none, ns.
const PAUSE_NS: u64 = 1_000_000_000;
/// Time of an edit, ns.
const EDIT_NS: u64 = 250_000_000;

/// Clock that stops during pauses.
#[derive(Clone, Debug, Default)]
pub struct WorkClock {
    worked_ns: u64,
    /// Time of the newest contact, rig clock, ns.
    contact_ns: Option<u64>,
}

impl WorkClock {
    /// Advances to the time of a message; returns the working time after it, ns.
    pub fn pass(&mut self, record: &Record) -> u64 {
        match &record.what {
            Accepted::State { state, .. } => {
                for time_ns in contacts(state).map(|solve| solve.event_ns) {
                    self.touch(time_ns);
                }
            }
            Accepted::Entry(Entry::Command {
                command: Command::Edit(_),
                ..
            }) => self.worked_ns += EDIT_NS,
            Accepted::Entry(_) => {}
        }
        self.worked_ns
    }

    fn touch(&mut self, time_ns: u64) {
        let Some(before_ns) = self.contact_ns else {
            self.contact_ns = Some(time_ns);
            return;
        };
        // Two simultaneous brushes take turns; a restarted take begins another time.
        if time_ns > before_ns || before_ns - time_ns > PAUSE_NS {
            let passed_ns = time_ns.saturating_sub(before_ns);
            self.worked_ns += if passed_ns > PAUSE_NS { 0 } else { passed_ns };
            self.contact_ns = Some(time_ns);
        }
    }
}

/// Poses of a state in which its brush touches a surface.
pub(crate) fn contacts(state: &BrushState) -> impl Iterator<Item = &Solve> {
    let painted = |solve: &&Solve| solve.flags & solve_flags::PREVIEW == 0 && solve.stroke > 0;
    state.solves.iter().filter(painted)
}

#[cfg(test)]
mod tests {
    use maulstick_painting::edits::Undo;
    use maulstick_types::{Flags, Header, Pose};

    use super::*;

    fn record(what: Accepted) -> Record {
        Record {
            serial: 0,
            index: 0,
            what,
        }
    }

    fn state(times_ms: &[u64], stroke: u64) -> Record {
        let solve = |ms: &u64| Solve {
            event_ns: ms * 1_000_000,
            stroke,
            surface: 0,
            flags: 0,
            pose: Pose::IDENTITY,
            zoom: 1.0,
            angles_rad: Vec::new(),
            contacts: Vec::new(),
        };
        record(Accepted::State {
            header: Header {
                version: 1,
                schema: 0,
                source: 1,
                epoch: 1,
                flags: Flags::NONE,
                length: 0,
                seq: 0,
                event_ns: 0,
                sent_ns: 0,
            },
            state: BrushState {
                device: 1,
                device_epoch: 1,
                device_seq: 0,
                solves: times_ms.iter().map(solve).collect(),
            },
        })
    }

    #[test]
    fn pauses_and_brushes_in_the_air_take_no_time() {
        let mut clock = WorkClock::default();
        let mut pass = |record: &Record| clock.pass(record) / 1_000_000;
        assert_eq!(pass(&state(&[5000, 5100], 1)), 100);
        assert_eq!(pass(&state(&[5900], 2)), 900, "a short pause");
        assert_eq!(pass(&state(&[6400, 6800], 0)), 900, "in the air");
        assert_eq!(pass(&state(&[60_000], 3)), 900, "a long pause");
        assert_eq!(
            pass(&state(&[60_200, 60_150, 60_300], 3)),
            1200,
            "two at once"
        );
        assert_eq!(pass(&state(&[1000, 1500], 1)), 1700, "another take");
        let undo = Entry::Command {
            client: 0,
            number: 1,
            command: Undo { brush: None }.into(),
        };
        assert_eq!(pass(&record(Accepted::Entry(undo))), 1950);
        let tick = Entry::Tick { count: 1 };
        assert_eq!(pass(&record(Accepted::Entry(tick))), 1950);
    }
}
