//! A painting to dry, and its measurements.

use super::*;
use crate::studio::{BRUSH, header, painting, round, solve, state};

pub(super) fn brush() -> BrushFile {
    round(8.0, 48)
}

pub(super) fn sequencer() -> Sequencer {
    let mut sequencer = Sequencer::new(painting(&PaintingSetup {
        cells: CELLS,
        cell_m: CELL_M,
        ..PaintingSetup::default()
    }));
    sequencer.define_brush(BRUSH, brush()).expect("a brush");
    sequencer
}

pub(super) fn dry(share: f32, layer: &str, region: Option<Region>) -> Dry {
    Dry {
        share: Share::new(share).expect("in range"),
        layer: LayerName::new(layer).ok(),
        region,
        ..Dry::whole(CANVAS)
    }
}

pub(super) fn dry_over(ticks: u32) -> Dry {
    Dry {
        layer: LayerName::new("slow").ok(),
        over: Some(Ticks::new(ticks).expect("in range")),
        ..Dry::whole(CANVAS)
    }
}

pub(super) fn wet(layers: u32, region: Option<Region>) -> Wet {
    Wet {
        layers: (layers > 0).then_some(layers),
        region,
        surface: CANVAS,
    }
}

/// A part of a stroke from left to right; at the end the brush is lifted if `lifts`.
pub(super) fn stroke(sequencer: &mut Sequencer, seq: u64, stroke: u64, y_mm: f64, lifts: bool) {
    let file = brush();
    let solve = |x_mm: f64, stroke: u64| solve(&file, stroke, [x_mm, y_mm], 0.6, [0.2, 0.3]);
    let mut solves = vec![solve(6.0, stroke), solve(18.0, stroke), solve(30.0, stroke)];
    if lifts {
        solves.push(solve(30.0, 0));
    }
    let (_, painted) = sequencer.state(BRUSH, &header(seq, 0), &state(solves));
    painted.expect("it fits");
}

pub(super) fn ticks(sequencer: &mut Sequencer, count: u32) {
    (0..count).for_each(|_| sequencer.tick());
}

/// Wet and dry counts of the canvas.
pub(super) fn counts(sequencer: &mut Sequencer) -> [Counts; 2] {
    let painting = sequencer.painting_mut();
    assert_eq!(painting.report().quanta_missing, 0);
    let store = painting.store(CANVAS).expect("a canvas");
    [store.counts(), store.dry_counts()]
}

pub(super) fn sum(counts: &Counts) -> u64 {
    counts.iter().sum()
}

pub(super) fn both([wet, dry]: [Counts; 2]) -> Counts {
    std::array::from_fn(|slot| wet[slot] + dry[slot])
}

/// The wet counts of all cells by slot, row after row from the bottom.
pub(super) fn wet_cells(sequencer: &mut Sequencer) -> Vec<[u32; SLOTS]> {
    let painting = sequencer.painting_mut();
    painting.commit();
    let store = painting.store(CANVAS).expect("a canvas");
    let mut cells = vec![[0; SLOTS]; (CELLS[0] * CELLS[1]) as usize];
    for (id, version) in store.iter() {
        let planes = version
            .tile
            .as_ref()
            .map(|tile| tile.wet())
            .unwrap_or_default();
        for (slot, plane) in &*planes {
            for (cell, count) in plane.iter().enumerate().filter(|(_, count)| **count > 0.0) {
                let at = [
                    id.x as usize * 64 + cell % 64,
                    id.y as usize * 64 + cell / 64,
                ];
                cells[at[1] * CELLS[0] as usize + at[0]][*slot] = *count as u32;
            }
        }
    }
    cells
}

/// Unlit linear colours of all cells of the canvas.
pub(super) fn colours(sequencer: &mut Sequencer) -> Vec<[f32; 3]> {
    let painting = sequencer.painting_mut();
    painting.commit();
    let store = painting.store(CANVAS).expect("a canvas");
    let bare = painting.bare(CANVAS).expect("a canvas");
    let banded = Banded::new(store, bare, painting.look(), CELL_M);
    let mut bakery = Bakery::default();
    let shown = store.iter().map(|(id, version)| {
        let tile = banded.shown(id, version.tile.as_deref(), &mut bakery);
        (0..TILE_CELLS).map(move |cell| [0, 1, 2].map(|c| tile.rgb[c][cell]))
    });
    shown.flatten().collect()
}

pub(super) fn farthest(one: &[[f32; 3]], other: &[[f32; 3]]) -> f32 {
    let pairs = one.iter().flatten().zip(other.iter().flatten());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// Mean difference of channels.
pub(super) fn mean_off(one: &[[f32; 3]], other: &[[f32; 3]]) -> f64 {
    let pairs = one.iter().flatten().zip(other.iter().flatten());
    let sum: f64 = pairs.map(|(a, b)| f64::from((a - b).abs())).sum();
    sum / (3 * one.len()) as f64
}

/// Greatest number of links of a stack.
pub(super) fn depth(sequencer: &Sequencer) -> usize {
    let store = sequencer.painting().store(CANVAS).expect("a canvas");
    let tiles = store.iter().filter_map(|(_, version)| version.tile.clone());
    tiles
        .filter_map(|tile| Some(tile.dry()?.depth()))
        .max()
        .unwrap_or(0)
}

pub(super) fn painted() -> Sequencer {
    let mut sequencer = sequencer();
    sequencer
        .edit(fill("Yellow Ochre=0.3,Titanium White=0.7", 30.0))
        .expect("filled");
    sequencer
        .edit(load("Ultramarine Blue=0.6,Titanium White=0.4"))
        .expect("loaded");
    stroke(&mut sequencer, 0, 1, 8.0, true);
    stroke(&mut sequencer, 1, 2, 14.0, true);
    sequencer
}
