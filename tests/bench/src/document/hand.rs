//! A hand that paints strokes anywhere, from a seed.

use std::path::Path;
use std::time::{Duration, Instant};

use maulstick_brush::BrushFile;
use maulstick_document::{Access, Document, DocumentSettings};
use maulstick_optics::PaintLibrary;
use maulstick_painting::edits::Load;
use maulstick_painting::{Painting, PaintingSetup, Sequencer};
use maulstick_rig::UserError;
use maulstick_session::Autosave;
use maulstick_types::Pose;
use maulstick_types::brush::{BrushState, Solve};
use maulstick_types::scene::CANVAS;
use maulstick_types::values::BrushName;
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::Rng as _;

use super::fault;
use crate::header::header_of;
use crate::thread_cpu::thread_cpu;

const BRUSH: &str = "main";
const PAINTS: [&str; 4] = [
    "Ultramarine Blue",
    "Titanium White",
    "Yellow Ochre",
    "Pyrrole Red=0.5,Bone Black=0.5",
];
/// Path between two states, m: of a quick hand in 8 ms.
const STATE_M: f64 = 2e-3;

/// A painting in a document with the hand over it.
pub(super) struct Easel {
    pub(super) sequencer: Sequencer,
    pub(super) autosave: Autosave,
    size_m: [f64; 2],
    file: BrushFile,
    dice: Pcg64Mcg,
    stroke: u64,
    seq: u64,
    begun: Instant,
}

/// Duration of painting.
#[derive(Clone, Debug, Default)]
pub(super) struct Took {
    /// Steps of the paint model.
    pub(super) steps: u64,
    /// Time of this thread's processor.
    pub(super) busy: Duration,
    /// Time to page in, for each state of the brush.
    pub(super) paging_ms: Vec<f64>,
}

impl Easel {
    /// A canvas of `cells` cells either way, in a new file.
    pub(super) fn new(
        path: &Path,
        cells: u32,
        memory: usize,
        quota: u64,
    ) -> Result<Self, UserError> {
        let settings = DocumentSettings {
            memory,
            ..DocumentSettings::new(path, Access::Paint)
        };
        let (document, _) = Document::open(&settings).map_err(fault)?;
        let setup = PaintingSetup {
            cells: [cells, cells],
            ..PaintingSetup::default()
        };
        let library = PaintLibrary::measured().map_err(fault)?;
        let pager = document.pager().clone();
        let painting = Painting::paged(&setup, library, pager).map_err(fault)?;
        let mut sequencer = Sequencer::new(painting);
        sequencer.painting_mut().set_quota(quota);
        let autosave = Autosave::new(document, &mut sequencer, 0);
        let file = BrushFile::library("round").map_err(fault)?;
        sequencer
            .define_brush(BRUSH, file.clone())
            .expect("a brush");
        Ok(Self {
            sequencer,
            autosave,
            size_m: [f64::from(cells) * setup.cell_m; 2],
            file,
            dice: Pcg64Mcg::new(7),
            stroke: 0,
            seq: 0,
            begun: Instant::now(),
        })
    }

    /// A canvas that was painted before.
    pub(super) fn again(path: &Path, memory: usize) -> Result<Self, UserError> {
        let settings = DocumentSettings {
            memory,
            ..DocumentSettings::new(path, Access::Paint)
        };
        let (document, opened) = Document::open(&settings).map_err(fault)?;
        let opened = opened.ok_or_else(|| fault("the painting is gone"))?;
        let since = opened.snapshot().versions;
        let mut sequencer = opened.sequencer().map_err(fault)?;
        let autosave = Autosave::new(document, &mut sequencer, since);
        let canvas = &sequencer.painting().scene().surfaces[0];
        let size_m = canvas.cells.map(|cells| f64::from(cells) * canvas.cell_m);
        Ok(Self {
            size_m,
            sequencer,
            autosave,
            file: BrushFile::library("round").map_err(fault)?,
            dice: Pcg64Mcg::new(8),
            stroke: 1 << 32,
            seq: 0,
            begun: Instant::now(),
        })
    }

    fn unit(&mut self) -> f64 {
        (self.dice.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Loads a paint in turn.
    pub(super) fn load(&mut self) -> Result<(), UserError> {
        let text = PAINTS[self.stroke as usize % PAINTS.len()];
        let command = Load {
            mixture: text.parse().map_err(fault)?,
            beside: None,
            brush: BrushName::new(BRUSH).expect("valid"),
        };
        self.sequencer.edit(command).map_err(fault)?;
        Ok(())
    }

    /// A stroke of `length_m` anywhere, in any direction.
    pub(super) fn stroke(&mut self, length_m: f64, took: &mut Took) -> Result<(), UserError> {
        let margin = 0.02f64.min(0.25 * self.size_m[0]);
        let from = [0, 1].map(|i| margin + self.unit() * (self.size_m[i] - 2.0 * margin));
        let (sine, cosine) = maulstick_num::sin_cos(std::f64::consts::TAU * self.unit());
        self.stroke += 1;
        let states = (length_m / STATE_M).ceil().max(2.0) as u32;
        for state in 0..=states {
            let way = length_m * f64::from(state) / f64::from(states);
            let at = [from[0] + cosine * way, from[1] + sine * way];
            let at = [0, 1].map(|i| at[i].clamp(0.0, self.size_m[i]));
            self.state(at, took)?;
        }
        self.keep();
        Ok(())
    }

    /// Hands over the records due to the document.
    pub(super) fn keep(&mut self) {
        let now_ns = self.begun.elapsed().as_nanos() as u64;
        self.sequencer.drain_journal();
        self.autosave.turn(&mut self.sequencer, now_ns);
    }

    fn state(&mut self, [x, y]: [f64; 2], took: &mut Took) -> Result<(), UserError> {
        let joints = self.file.spines.all_joints();
        let solve = Solve {
            event_ns: 0,
            stroke: self.stroke,
            surface: CANVAS,
            flags: 0,
            pose: Pose {
                position_m: [x, y, 0.55 * self.file.length_m()],
                orientation: [0.0, 0.0, 0.0, 1.0],
            },
            zoom: 1.0,
            angles_rad: vec![[0.25, 0.3]; joints],
            contacts: Vec::new(),
        };
        let header = header_of(BRUSH, self.seq);
        self.seq += 1;
        let state = BrushState {
            device: 1,
            device_epoch: 1,
            device_seq: 0,
            solves: vec![solve],
        };
        let steps = self.sequencer.painting().work().0;
        let paged = self.autosave.document().page_in_cpu();
        let busy = thread_cpu();
        let (_, painted) = self.sequencer.state(BRUSH, &header, &state);
        took.busy += thread_cpu().saturating_sub(busy);
        painted.map_err(fault)?;
        let paged = self.autosave.document().page_in_cpu().saturating_sub(paged);
        took.paging_ms.push(1e3 * paged.as_secs_f64());
        took.steps += self.sequencer.painting().work().0 - steps;
        Ok(())
    }
}

/// Memory of this process, bytes.
pub(super) fn resident() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    let kib = line.and_then(|line| line.trim().trim_end_matches(" kB").parse::<u64>().ok());
    kib.unwrap_or(0) << 10
}
