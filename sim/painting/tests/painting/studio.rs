//! Paintings, brushes and their actions, for all tests.

use maulstick_brush::{BrushFile, BrushModel};
use maulstick_optics::PaintLibrary;
use maulstick_painting::edits::{Fill, FillPaint, Load};
use maulstick_painting::{Painting, PaintingSetup, Sequencer};
use maulstick_types::brush::{BrushState, Solve};
use maulstick_types::scene::CANVAS;
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample};
use maulstick_types::values::{BrushName, FilmThickness};
use maulstick_types::{Flags, Header, Message as _, Mixture, Origin, Pose, name_hash};

/// Name of the brush.
pub(crate) const BRUSH: &str = "main";

pub(crate) fn mixture(text: &str) -> Mixture {
    text.parse().expect("a mixture")
}

/// A painting with the measured paints.
pub(crate) fn painting(setup: &PaintingSetup) -> Painting {
    let library = PaintLibrary::measured().expect("whole");
    Painting::new(setup, library).expect("a painting")
}

/// The library's round brush at a size, with a number of strips.
pub(crate) fn round(size_mm: f64, strips: usize) -> BrushFile {
    let mut file = BrushFile::library("round").expect("round");
    file.strips.count = strips;
    file.scaled_to(size_mm).expect("a size")
}

pub(crate) fn load(text: &str) -> Load {
    Load {
        mixture: mixture(text),
        beside: None,
        brush: BrushName::main(),
    }
}

/// Wet paint of a tile: slot, place of the tile, counts.
pub(crate) type WetPlane = (usize, u32, u32, Vec<f32>);

/// All wet paint of the canvas.
pub(crate) fn wet_paint(painting: &Painting) -> Vec<WetPlane> {
    let store = painting.store(CANVAS).expect("a canvas");
    let tiles = store
        .iter()
        .filter_map(|(id, version)| Some((id, version.tile.as_ref()?)));
    tiles
        .flat_map(|(id, tile)| {
            let planes: Vec<_> = tile
                .wet()
                .iter()
                .map(|(slot, plane)| (*slot, plane.to_vec()))
                .collect();
            planes
                .into_iter()
                .map(move |(slot, plane)| (slot, id.x, id.y, plane))
        })
        .collect()
}

/// A film of a mixture over the canvas.
pub(crate) fn fill(text: &str, um: f64) -> Fill {
    Fill {
        paint: FillPaint::Mixture {
            mixture: mixture(text),
        },
        thickness: FilmThickness::new(um * 1e-6).expect("in range"),
        surface: CANVAS,
    }
}

/// A brush upright over a place of the canvas, mm, at a height by the length of its head, all of its joints bent alike.
pub(crate) fn solve(
    file: &BrushFile,
    stroke: u64,
    [x, y]: [f64; 2],
    height: f64,
    bend: [f32; 2],
) -> Solve {
    Solve {
        event_ns: 0,
        stroke,
        surface: CANVAS,
        flags: 0,
        pose: Pose {
            position_m: [x * 1e-3, y * 1e-3, height * file.length_m()],
            ..Pose::IDENTITY
        },
        zoom: 1.0,
        angles_rad: vec![bend; file.spines.all_joints()],
        contacts: Vec::new(),
    }
}

/// A state of a brush.
pub(crate) fn state(solves: impl IntoIterator<Item = Solve>) -> BrushState {
    BrushState {
        device: 1,
        device_epoch: 1,
        device_seq: 0,
        solves: solves.into_iter().collect(),
    }
}

/// The header of a state of the brush in its first epoch.
pub(crate) fn header(seq: u64, event_ns: u64) -> Header {
    Header {
        version: BrushState::VERSION,
        schema: 0,
        source: name_hash(BRUSH),
        epoch: 1,
        flags: Flags::NONE,
        length: 0,
        seq,
        event_ns,
        sent_ns: event_ns,
    }
}

/// A brush with black, drawn by a pen over a panel of a size, mm.
pub(crate) struct Drawing {
    pub(crate) sequencer: Sequencer,
    model: BrushModel,
    seq: u64,
}

impl Drawing {
    pub(crate) fn new(file: BrushFile, size_mm: [f64; 2], cell_mm: f64) -> Self {
        let mut sequencer = Sequencer::new(painting(&PaintingSetup {
            cells: size_mm.map(|mm| (mm / cell_mm) as u32),
            cell_m: 1e-3 * cell_mm,
            tooth: "panel".into(),
            ..PaintingSetup::default()
        }));
        let mut model = BrushModel::new(file.clone(), 0.5);
        model.set_scene(sequencer.painting_mut().scene());
        sequencer.define_brush(BRUSH, file).expect("a brush");
        sequencer.edit(load("Bone Black")).expect("loaded");
        Self {
            sequencer,
            model,
            seq: 0,
        }
    }

    /// The pen at a place, m right of the middle, at a time, ms; returns the numbers of its strokes.
    pub(crate) fn sample(
        &mut self,
        ms: u64,
        x_m: f64,
        [twist_rad, pressure]: [f64; 2],
        epoch: u32,
    ) -> Vec<u64> {
        let sample = StylusSample {
            pose: StylusPose::Contact {
                point_m: [x_m, 0.0, 0.0],
                tilt_rad: DEFAULT_TILT_RAD,
                twist_rad,
                pressure,
            },
            in_range: true,
            ..StylusSample::away()
        };
        let (origin, event_ns) = (Origin { source: 1, epoch }, 1_000_000_000 + 1_000_000 * ms);
        let state = self
            .model
            .state(origin, self.seq, event_ns, &sample)
            .expect("a state");
        let header = header(self.seq, event_ns);
        self.seq += 1;
        let painted = self.sequencer.state(BRUSH, &header, &state);
        painted.1.expect("painted");
        self.sequencer.drain_journal();
        state.solves.iter().map(|solve| solve.stroke).collect()
    }
}
