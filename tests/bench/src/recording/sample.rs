//! A recording like a rig's: a pen of 1 kHz, the states of a brush, credit and status, and a painting of 50 MB.

use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use maulstick_rig::UserError;
use maulstick_streams::{FieldTable, RateLimit, RecordingWriter};
use maulstick_types::brush::{BrushState, Solve};
use maulstick_types::paint::{BrushCredit, PaintConsumed};
use maulstick_types::stylus::{StylusPose, StylusSample, axes};
use maulstick_types::{Flags, HEADER_BYTES, Header, Message, Origin, Pose, encode, name_hash};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng as _, SeedableRng as _};

use super::fault;

/// Length of the recording, s.
pub(super) const SECONDS: u64 = 600;
/// The attached painting, bytes.
const PAINTING: usize = 50_000_000;
/// Spines of the brush.
const SPINES: usize = 26;
/// Messages a second that are JSON too.
const JSON_HZ: u32 = 20;

/// A sender of a topic.
struct Sender {
    topic: &'static str,
    origin: Origin,
    table: FieldTable,
    seq: u64,
}

/// The file, and the filter of its JSON.
struct Recorder {
    writer: RecordingWriter<BufWriter<File>>,
    json: RateLimit,
}

impl Sender {
    fn new<M: Message>(topic: &'static str, name: &str) -> Result<Self, UserError> {
        Ok(Self {
            topic,
            origin: Origin {
                source: name_hash(name),
                epoch: 1,
            },
            table: FieldTable::of(M::schema()).map_err(fault)?,
            seq: 0,
        })
    }

    fn send<M: Message>(
        &mut self,
        to: &mut Recorder,
        at_ns: u64,
        message: &M,
    ) -> Result<(), UserError> {
        let (origin, seq) = (&self.origin, self.seq);
        let bytes = encode(origin, Flags::NONE, seq, at_ns, at_ns, message).map_err(fault)?;
        self.seq += 1;
        let header = Header::from_bytes(&bytes).map_err(fault)?;
        let arrived_ns = at_ns + 200_000;
        to.writer
            .write(self.topic, &header, &bytes, arrived_ns)
            .map_err(fault)?;
        if to.json.admits(self.topic, arrived_ns) {
            let value = self.table.decode(&bytes[HEADER_BYTES..]).map_err(fault)?;
            to.writer
                .write_json(self.topic, &self.table, &header, &value, arrived_ns)
                .map_err(fault)?;
        }
        Ok(())
    }
}

/// The pen somewhere.
fn sample(mut noise: impl FnMut() -> f64) -> StylusSample {
    StylusSample {
        senses: axes::POSITION | axes::PRESSURE,
        in_range: true,
        pose: StylusPose::Contact {
            point_m: [noise(), noise(), 0.0],
            tilt_rad: [noise(), noise()],
            twist_rad: noise(),
            pressure: noise() + 0.5,
        },
        ..StylusSample::away()
    }
}

/// The brush at a millisecond.
fn state(ms: u64, at_ns: u64, mut noise: impl FnMut() -> f64) -> BrushState {
    let solve = |event_ns: u64, angles_rad: Vec<[f32; 2]>| Solve {
        event_ns,
        stroke: ms / 2000,
        surface: 0,
        flags: 0,
        pose: Pose::IDENTITY,
        zoom: 1.0,
        angles_rad,
        contacts: Vec::new(),
    };
    let mut angles = || {
        let joints = 0..2 * SPINES;
        joints.map(|_| [noise() as f32, noise() as f32]).collect()
    };
    BrushState {
        device: name_hash("pen"),
        device_epoch: 1,
        device_seq: ms,
        solves: (0..2).map(|step| solve(at_ns + step, angles())).collect(),
    }
}

/// Writes it.
pub(super) fn write(path: &Path) -> Result<(), UserError> {
    let mut dice = Pcg64::seed_from_u64(7);
    let mut noise = move || f64::from(dice.next_u32()) / f64::from(u32::MAX) - 0.5;
    let file = BufWriter::new(File::create(path).map_err(fault)?);
    let mut to = Recorder {
        writer: RecordingWriter::begin(file).map_err(fault)?,
        json: RateLimit::new(JSON_HZ),
    };
    let painting: Vec<u8> = (0..PAINTING)
        .map(|_| (noise() * 256.0) as i8 as u8)
        .collect();
    to.writer
        .attach("painting.maul", "application/vnd.sqlite3", &painting)
        .map_err(fault)?;
    drop(painting);
    let mut hand = Sender::new::<StylusSample>("stylus/pen/sample", "pen")?;
    let mut brush = Sender::new::<BrushState>("brush/main/state", "main")?;
    let mut credit = Sender::new::<PaintConsumed>("paint/consumed", "paint")?;
    for ms in 0..SECONDS * 1000 {
        let at_ns = ms * 1_000_000;
        hand.send(&mut to, at_ns, &sample(&mut noise))?;
        if ms % 4 == 0 {
            brush.send(&mut to, at_ns, &state(ms, at_ns, &mut noise))?;
        }
        if ms % 20 == 0 {
            let own = BrushCredit {
                brush: name_hash("main"),
                epoch: 1,
                next: ms / 4,
                wetness: noise() as f32,
                film_m: 1e-4,
                viscosity_m2_s: 1e-3,
                contact_m: 1e-3,
                file: 0,
            };
            credit.send(&mut to, at_ns, &PaintConsumed { brushes: vec![own] })?;
        }
        if ms % 500 == 499 {
            to.writer.flush().map_err(fault)?;
        }
    }
    to.writer.finish().map_err(fault)
}
