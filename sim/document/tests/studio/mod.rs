//! A painter with random actions from a seed.

#![allow(dead_code, unreachable_pub, reason = "each test uses a part")]

use maulstick_brush::BrushFile;
use maulstick_brush::palette_place::{mirrored, size_m};
use maulstick_canvas::page::Pager;
use maulstick_optics::PaintLibrary;
use maulstick_painting::edits::{
    Branch, Clean, Dry, Fill, FillPaint, Forget, GoTo, Ground, Keep, LayerRef, Load, NameLayer,
    Opacity, Redo, ReturnTo, Scrape, StopDrying, Tooth, Undo, Wells, Wet,
};
use maulstick_painting::history::{TilePlace, TileRef};
use maulstick_painting::setup::wells_of;
use maulstick_painting::{Painting, PaintingSetup, Sequencer};
use maulstick_types::brush::{BrushState, Solve};
use maulstick_types::command::{Command, CommandRequest, Outcome};
use maulstick_types::scene::{CANVAS, PALETTE};
use maulstick_types::values::{
    BrushName, FilmThickness, LayerName, MaterialName, OpacityFactor, Share, Ticks, VersionName,
};
use maulstick_types::{Flags, Header, Mixture, Pose, Region, name_hash};
use proptest::prelude::ProptestConfig;
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::Rng as _;
use std::collections::BTreeMap;
use std::sync::Arc;

pub const BRUSHES: [&str; 2] = ["main", "other"];
const MIXTURES: [&str; 3] = [
    "Titanium White",
    "Ultramarine Blue=0.6,Titanium White=0.4",
    "Yellow Ochre=0.5,Pyrrole Red=0.25,Bone Black=0.25",
];
/// Cells of the canvas: more than a tile, and not a multiple of it.
const CELLS: [u32; 2] = [150, 100];

/// Number of cases, or that in `PROPTEST_CASES`.
pub fn cases(usual: u32) -> ProptestConfig {
    let asked = std::env::var("PROPTEST_CASES").ok();
    let asked = asked.and_then(|cases| cases.parse().ok());
    ProptestConfig {
        failure_persistence: None,
        ..ProptestConfig::with_cases(asked.unwrap_or(usual))
    }
}

pub fn mixture(text: &str) -> Mixture {
    text.parse().expect("a mixture")
}

pub fn brush(strips: usize) -> BrushFile {
    let mut file = BrushFile::library("round").expect("round");
    file.strips.count = strips;
    file.scaled_to(10.0).expect("a size")
}

/// A new painting on these pages, with two brushes.
pub fn sequencer(pager: Arc<Pager>) -> Sequencer {
    sequencer_of("impasto", pager)
}

/// A new painting with this paint model on its canvas.
pub fn sequencer_of(model: &str, pager: Arc<Pager>) -> Sequencer {
    let setup = PaintingSetup {
        cells: CELLS,
        model: model.to_owned(),
        wells: MIXTURES.map(mixture).to_vec(),
        ..PaintingSetup::default()
    };
    let library = PaintLibrary::measured().expect("whole");
    let painting = Painting::paged(&setup, library, pager).expect("a painting");
    Sequencer::new(painting)
}

/// Gives a new painting its brushes.
pub fn equip(sequencer: &mut Sequencer) {
    for name in BRUSHES {
        sequencer.define_brush(name, brush(48)).expect("a brush");
    }
}

/// Numbers from a seed.
#[derive(Clone)]
pub struct Dice(Pcg64Mcg);

impl Dice {
    pub fn new(seed: u64) -> Self {
        Self(Pcg64Mcg::new(u128::from(seed) << 1 | 1))
    }

    pub fn below(&mut self, bound: u64) -> u64 {
        self.0.next_u64() % bound
    }

    fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * (self.below(1 << 30) as f64 / f64::from(1 << 30))
    }
}

/// Next action of the painter.
#[derive(Clone, Debug)]
pub enum Act {
    Paint(usize, bool, Vec<Solve>),
    Command(Command),
    Redefine(usize, usize),
    Ticks(u32),
}

impl std::fmt::Display for Act {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Paint(brush, new, way) => {
                let stroke = if *new { "stroke" } else { "stroke on" };
                write!(f, "{stroke} of {} on {}", BRUSHES[*brush], way[0].surface)
            }
            Self::Command(command) => write!(f, "{command:?}"),
            Self::Redefine(brush, strips) => write!(f, "{} with {strips}", BRUSHES[*brush]),
            Self::Ticks(ticks) => write!(f, "{ticks} ticks"),
        }
    }
}

/// A part of the canvas, or one beside it.
fn part(dice: &mut Dice) -> Region {
    Region {
        corner_m: [dice.between(-5e-3, 40e-3), dice.between(-5e-3, 25e-3)],
        size_m: [dice.between(1e-4, 30e-3), dice.between(1e-4, 30e-3)],
    }
}

fn fill(mixture: Mixture) -> Command {
    Command::from(Fill {
        paint: FillPaint::Mixture { mixture },
        thickness: FilmThickness::new(2e-5).expect("in range"),
        surface: CANVAS,
    })
}

/// A painter whose next action depends on the seed alone.
#[derive(Clone)]
pub struct Painter {
    pub dice: Dice,
    strokes: [u64; 2],
    seqs: [u64; 2],
    commands: u64,
}

impl Painter {
    pub fn new(seed: u64) -> Self {
        Self {
            dice: Dice::new(seed),
            strokes: [1; 2],
            seqs: [0; 2],
            commands: 0,
        }
    }

    fn way(&mut self, stroke: u64) -> Vec<Solve> {
        let dice = &mut self.dice;
        let file = brush(48);
        let palette = dice.below(5) == 0;
        let (surface, middle) = if palette {
            (PALETTE, [20.0, dice.between(20.0, 230.0)])
        } else {
            (CANVAS, [dice.between(3.0, 34.0), dice.between(3.0, 22.0)])
        };
        let count = 2 + dice.below(3);
        let joints = file.spines.all_joints();
        let place = |dice: &mut Dice| {
            let at = middle.map(|mm: f64| (mm + dice.between(-4.0, 4.0)) * 1e-3);
            let (sine, cosine) = maulstick_num::sin_cos(dice.between(-0.3, 0.3));
            let bend = [
                dice.between(-0.4, 0.4) as f32,
                dice.between(-0.4, 0.4) as f32,
            ];
            Solve {
                event_ns: 0,
                stroke,
                surface,
                flags: 0,
                pose: Pose {
                    position_m: [at[0], at[1], dice.between(0.3, 0.9) * file.length_m()],
                    orientation: [0.0, 0.0, sine, cosine],
                },
                zoom: 1.0,
                angles_rad: (0..joints).map(|_| bend).collect(),
                contacts: Vec::new(),
            }
        };
        (0..count).map(|_| place(dice)).collect()
    }

    fn region(&mut self) -> Option<Region> {
        (self.dice.below(2) == 0).then(|| part(&mut self.dice))
    }

    pub fn next(&mut self) -> Act {
        let b = self.dice.below(2) as usize;
        let brush = BrushName::new(BRUSHES[b]).expect("valid");
        let mixture = mixture(MIXTURES[self.dice.below(3) as usize]);
        let command = match self.dice.below(60) {
            0..15 => {
                let new = self.dice.below(2) == 0;
                self.strokes[b] += u64::from(new);
                let way = self.way(self.strokes[b]);
                return Act::Paint(b, new, way);
            }
            15..18 => Command::from(Load {
                mixture,
                beside: None,
                brush,
            }),
            18 => Command::from(Clean { brush }),
            19..21 => Command::from(Dry {
                share: self.share(),
                ..Dry::whole(CANVAS)
            }),
            21 => self.thin_layer(),
            22 => fill(mixture),
            23 => self.named_ground(),
            24 => self.tooth(),
            kind @ 25..30 => self.version(kind),
            30..35 => Command::from(Undo {
                brush: self.sometimes(brush),
            }),
            35..39 => Command::from(Redo {
                brush: self.sometimes(brush),
            }),
            39 => return Act::Redefine(b, self.one_of([31, 48])),
            40..46 => return Act::Ticks(self.one_of([7, 45, 150, 400])),
            46..49 => self.dry_over_time(),
            49 => Command::from(StopDrying { surface: CANVAS }),
            50..52 => self.dry_part(),
            52..54 => self.wet(),
            54 => self.change_part(),
            55 => Command::from(Scrape {
                region: self.region(),
                surface: self.one_of([CANVAS, PALETTE]),
            }),
            57..59 => self.wells(),
            59 => Command::from(GoTo {
                step: self.dice.below(40),
            }),
            _ => self.spectral_ground(),
        };
        Act::Command(command)
    }

    fn one_of<T: Copy, const N: usize>(&mut self, all: [T; N]) -> T {
        all[self.dice.below(N as u64) as usize]
    }

    /// The brush, once in three times.
    fn sometimes(&mut self, brush: BrushName) -> Option<BrushName> {
        (self.dice.below(3) == 0).then_some(brush)
    }

    fn share(&mut self) -> Share {
        Share::new(self.one_of([1.0, 0.4])).expect("in range")
    }

    fn version_name(&mut self) -> VersionName {
        VersionName::new(self.one_of(["one", "two", "three"])).expect("valid")
    }

    /// Halves the opacity of a layer, which may not be there.
    fn thin_layer(&mut self) -> Command {
        Command::from(Opacity {
            layer: LayerRef::Number {
                number: 1 + self.dice.below(3) as u32,
            },
            opacity: OpacityFactor::new(0.5).expect("in range"),
        })
    }

    /// Changes the layer that [a part of the canvas](Self::dry_part) became.
    fn change_part(&mut self) -> Command {
        match self.dice.below(2) {
            0 => Command::from(Opacity {
                layer: "part".parse().expect("valid"),
                opacity: OpacityFactor::new(0.5).expect("in range"),
            }),
            _ => Command::from(NameLayer {
                layer: 1,
                name: LayerName::new("renamed").expect("valid"),
            }),
        }
    }

    fn named_ground(&mut self) -> Command {
        let name = self.one_of(["gesso", "grey", "black"]);
        Command::from(Ground::named(CANVAS, name).expect("valid"))
    }

    fn spectral_ground(&mut self) -> Command {
        let spectrum = format!("400,0.{}\n700,0.5", 1 + self.dice.below(3));
        Command::from(Ground::spectrum(CANVAS, &spectrum).expect("valid"))
    }

    fn tooth(&mut self) -> Command {
        Command::from(Tooth {
            tooth: MaterialName::new(self.one_of(["linen", "paper"])).expect("valid"),
            seed: self.dice.below(3),
            surface: CANVAS,
        })
    }

    /// The edit of versions with this number among the [acts](Self::next).
    fn version(&mut self, kind: u64) -> Command {
        match kind {
            25..27 => Command::from(Keep {
                name: self.version_name(),
            }),
            27 => Command::from(ReturnTo {
                name: self.version_name(),
            }),
            28 => Command::from(Branch {
                from: self.version_name(),
                name: self.version_name(),
            }),
            _ => Command::from(Forget {
                name: self.version_name(),
            }),
        }
    }

    fn dry_over_time(&mut self) -> Command {
        Command::from(Dry {
            over: Some(Ticks::new(self.one_of([20, 200, 2000])).expect("in range")),
            region: self.region(),
            ..Dry::whole(CANVAS)
        })
    }

    fn dry_part(&mut self) -> Command {
        Command::from(Dry {
            share: self.share(),
            layer: LayerName::new("part").ok(),
            region: Some(part(&mut self.dice)),
            ..Dry::whole(CANVAS)
        })
    }

    fn wet(&mut self) -> Command {
        Command::from(Wet {
            // 0 means all.
            layers: Some(self.dice.below(3) as u32).filter(|count| *count > 0),
            region: self.region(),
            surface: CANVAS,
        })
    }

    /// Other wells, sometimes mirrored.
    fn wells(&mut self) -> Command {
        let palette = PaintingSetup::default().scene().surfaces.remove(1);
        let mixtures = MIXTURES.map(mixture);
        let left_out = self.dice.below(3) as usize;
        let mut wells = wells_of(&mixtures[left_out..], palette.cells, palette.cell_m);
        if self.dice.below(2) == 0 {
            wells = mirrored(&wells, size_m(&palette));
        }
        Command::from(Wells::new(PALETTE, wells).expect("valid"))
    }

    /// Does an action; an impossible one is refused, as for any painter.
    pub fn act(&mut self, sequencer: &mut Sequencer, act: &Act) {
        match act {
            Act::Paint(b, _, solves) => {
                let header = Header {
                    version: 1,
                    schema: 0,
                    source: name_hash(BRUSHES[*b]),
                    epoch: 1,
                    flags: Flags::NONE,
                    length: 0,
                    seq: self.seqs[*b],
                    event_ns: 0,
                    sent_ns: 0,
                };
                self.seqs[*b] += 1;
                let state = BrushState {
                    device: 1,
                    device_epoch: 1,
                    device_seq: 0,
                    solves: solves.clone(),
                };
                let (_, painted) = sequencer.state(BRUSHES[*b], &header, &state);
                painted.expect("it fits");
            }
            Act::Command(command) => drop(self.command(sequencer, command.clone())),
            Act::Redefine(b, strips) => sequencer
                .define_brush(BRUSHES[*b], brush(*strips))
                .expect("a brush"),
            Act::Ticks(ticks) => {
                (0..*ticks).for_each(|_| sequencer.tick());
                sequencer.drain_journal();
            }
        }
    }

    pub fn command(&mut self, sequencer: &mut Sequencer, command: impl Into<Command>) -> Outcome {
        self.commands += 1;
        let request = CommandRequest {
            client: 7,
            number: self.commands,
            after: None,
            command: command.into(),
        };
        let outcome = sequencer.command(request).outcome;
        sequencer.drain_journal();
        outcome
    }
}

/// Contents of a tile as numbers.
pub fn content(held: &TileRef) -> Vec<u64> {
    let Some(tile) = held else { return Vec::new() };
    let mut words = Vec::new();
    let mut add = |planes: &maulstick_canvas::planes::Planes| {
        for (slot, plane) in planes {
            words.push(*slot as u64);
            let sum = plane.iter().enumerate().fold(17u64, |sum, (cell, count)| {
                let word = (cell as u64) << 32 | u64::from(count.to_bits());
                (sum ^ word)
                    .wrapping_mul(0x9e37_79b9_7f4a_7c15)
                    .rotate_left(23)
            });
            words.push(sum);
        }
    };
    add(&tile.wet());
    for layer in tile.dry().into_iter().flat_map(|stack| stack.layers()) {
        add(&layer.planes.get());
    }
    let layers = tile.dry().into_iter().flat_map(|stack| stack.layers());
    words.extend(layers.map(|layer| u64::from(layer.number)));
    words
}

/// Contents of every painted tile.
pub fn tiles(sequencer: &mut Sequencer) -> BTreeMap<TilePlace, Vec<u64>> {
    let painting = sequencer.painting_mut();
    painting.commit();
    let mut tiles = BTreeMap::new();
    for surface in [CANVAS, PALETTE] {
        let store = painting.store(surface).expect("a surface");
        let words = store
            .iter()
            .map(|(id, version)| ((surface, id), content(&version.tile)));
        tiles.extend(words.filter(|(_, words)| !words.is_empty()));
    }
    tiles
}

/// Complete state of a painting, for comparisons.
pub fn print(sequencer: &mut Sequencer) -> Vec<String> {
    let painting = sequencer.painting_mut();
    let report = painting.report();
    assert_eq!(report.quanta_missing, 0, "the books balance");
    let mut lines = vec![
        format!("{report:?}"),
        // State that undo does not restore.
        format!("{:?} {:?}", painting.history_depth(), painting.clock()),
    ];
    let mut scene = painting.scene().clone();
    scene.version = 0;
    lines.push(format!("{scene:?}"));
    for surface in [CANVAS, PALETTE] {
        let store = painting.store(surface).expect("a surface");
        for (id, version) in store.iter() {
            let words = content(&version.tile);
            if !words.is_empty() {
                lines.push(format!("{surface} {id:?} {words:?}"));
            }
        }
    }
    for version in painting.named() {
        lines.push(format!("{} from {:?}", version.name, version.parent));
        for (place, held) in &*version.tiles {
            lines.push(format!("{place:?} {:?}", content(held)));
        }
    }
    lines
}
