//! The log of a painting from its record: senders, actions and times.

use std::collections::BTreeMap;

use maulstick_document::{Document, DocumentError, Opened};
use maulstick_painting::sequencer::{Accepted, Record};
use maulstick_types::brush::BrushState;
use maulstick_types::command::Command;
use maulstick_types::paint::{Decision, Entry};
use maulstick_types::{Flags, Header, name_hash};

use crate::reexecution::each_record;
use crate::work_clock::contacts;

/// Something that was done.
#[derive(Clone, Debug, PartialEq)]
pub struct Logged {
    /// Wall-clock time, ms since 1970: of the beginning of a live stroke, and otherwise of writing, at most a second
    /// later; `None` if unknown.
    pub time_ms: Option<u64>,
    /// The event.
    pub what: LoggedWhat,
}

/// Event of a painting.
#[derive(Clone, Debug, PartialEq)]
pub enum LoggedWhat {
    /// A stroke of a brush.
    Stroke(LoggedStroke),
    /// A command.
    Command {
        /// Its sender; 0 is the painting's program.
        client: u64,
        /// The command.
        command: Command,
    },
    /// A stroke that an undo dropped before all of it was painted.
    Dropped {
        /// The sender of the undo.
        client: u64,
        /// Name of the brush.
        brush: String,
    },
    /// A decision of the program: the backend, or the reopening of the painting.
    Decision(Decision),
    /// A brush was introduced, or changed.
    Brush(String),
}

/// A stroke.
#[derive(Clone, Debug, PartialEq)]
pub struct LoggedStroke {
    /// Name of the brush.
    pub brush: String,
    /// The device that led it: the hash of its name.
    pub device: u32,
    /// True if a take was played.
    pub is_replayed: bool,
    /// The surface where it began.
    pub surface: u32,
    /// Time from its first contact to its last, s.
    pub seconds: f64,
    /// Length of the handle's path along the surface, m.
    pub length_m: f64,
}

/// Least rig-clock time that is the wall clock of a machine with a set clock, ns: 2001-09-09.
const WALL_NS: u64 = 1_000_000_000_000_000_000;

/// A stroke that may continue.
struct OpenStroke {
    /// Epoch of the brush and number of the stroke.
    stroke: (u32, u64),
    /// Its index in the log.
    place: usize,
    begun_ns: u64,
    /// The newest place on the surface, m.
    at_m: [f64; 2],
}

/// The log of a record; empty without one.
///
/// # Errors
/// [`DocumentError::Damaged`] if the record is not intact.
pub fn painting_log(document: &Document, opened: &Opened) -> Result<Vec<Logged>, DocumentError> {
    let Some(beginning) = opened.beginning() else {
        return Ok(Vec::new());
    };
    let brushes = beginning.painting.brushes.keys();
    let mut log = LogWriter {
        log: Vec::new(),
        brushes: brushes
            .map(|name| (name_hash(name), name.clone()))
            .collect(),
        open: BTreeMap::new(),
    };
    each_record(document, beginning.sequencer.serial, |time_ms, record| {
        log.add(time_ms, record);
        Ok::<(), DocumentError>(())
    })?;
    Ok(log.log)
}

struct LogWriter {
    log: Vec<Logged>,
    /// Names of the brushes by their hashes.
    brushes: BTreeMap<u32, String>,
    open: BTreeMap<u32, OpenStroke>,
}

impl LogWriter {
    fn add(&mut self, time_ms: Option<u64>, record: Record) {
        let what = match record.what {
            Accepted::State { header, state } => return self.add_state(time_ms, &header, &state),
            Accepted::Entry(Entry::Brush { brush, .. }) => {
                self.brushes.insert(name_hash(&brush), brush.clone());
                LoggedWhat::Brush(brush)
            }
            Accepted::Entry(Entry::Command {
                client, command, ..
            }) => LoggedWhat::Command { client, command },
            Accepted::Entry(Entry::Cut { client, brush, .. }) => {
                LoggedWhat::Dropped { client, brush }
            }
            Accepted::Entry(Entry::Decision { what }) => LoggedWhat::Decision(what),
            Accepted::Entry(Entry::Tick { .. } | Entry::States { .. }) => return,
        };
        self.log.push(Logged { time_ms, what });
    }

    fn add_state(&mut self, time_ms: Option<u64>, header: &Header, state: &BrushState) {
        for solve in contacts(state) {
            let stroke = (header.epoch, solve.stroke);
            let [x, y, _] = solve.pose.position_m;
            let at_m = [x, y];
            let open = self.open.get_mut(&header.source);
            if let Some(open) = open.filter(|open| open.stroke == stroke) {
                let [dx, dy] = [x - open.at_m[0], y - open.at_m[1]];
                let way_m = (dx * dx + dy * dy).sqrt();
                open.at_m = at_m;
                if let Some(Logged {
                    what: LoggedWhat::Stroke(stroke),
                    ..
                }) = self.log.get_mut(open.place)
                {
                    stroke.length_m += way_m;
                    stroke.seconds = 1e-9 * solve.event_ns.saturating_sub(open.begun_ns) as f64;
                }
                continue;
            }
            self.open.insert(
                header.source,
                OpenStroke {
                    stroke,
                    place: self.log.len(),
                    begun_ns: solve.event_ns,
                    at_m,
                },
            );
            let is_replayed = header.flags.has(Flags::REPLAY);
            let is_wall = !is_replayed && solve.event_ns > WALL_NS;
            let brush = self.brushes.get(&header.source).cloned();
            self.log.push(Logged {
                time_ms: if is_wall {
                    Some(solve.event_ns / 1_000_000)
                } else {
                    time_ms
                },
                what: LoggedWhat::Stroke(LoggedStroke {
                    brush: brush.unwrap_or_else(|| format!("{:08x}", header.source)),
                    device: state.device,
                    is_replayed,
                    surface: solve.surface,
                    seconds: 0.0,
                    length_m: 0.0,
                }),
            });
        }
    }
}
