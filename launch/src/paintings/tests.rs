//! What each painting must look like, measured at a small size.

use std::ops::Range;

use maulstick_paint::picture::{Picture, unlit_picture};
use maulstick_paint::quantum::QUANTUM_M;
use maulstick_types::paint::TILE;
use maulstick_types::scene::CANVAS;

use super::*;

/// Side of a cell, mm.
const CELL_MM: f64 = 0.5;
/// Thickness of the toned ground that lies under all, µm, and a little more.
const GROUND_UM: f32 = 40.0;

/// A finished painting, measured.
struct Measured {
    /// As if it were flat.
    colours: Picture,
    /// Thickness of all paint, wet and dry, µm, rows from the bottom.
    thickness_um: Vec<f32>,
    width: usize,
}

impl Measured {
    fn of(name: &str) -> Self {
        let library = PaintLibrary::measured().expect("whole");
        let mut offline = paint(name, CELL_MM, library, ProgressBar::hidden()).expect(name);
        let painting = offline.painting_mut();
        let report = painting.report();
        assert_eq!(report.quanta_missing, 0, "{name}: {report:?}");
        let balance: f64 = report.accounts_m3.values().sum();
        assert!(balance.abs() < 1e-15, "{name}: {balance} m³");
        let colours = unlit_picture(painting, CANVAS);
        let (width, height) = (colours.width, colours.height);
        let mut thickness_um = vec![0.0; width * height];
        for (id, version) in painting.store(CANVAS).expect("a canvas").iter() {
            let Some(tile) = &version.tile else { continue };
            let mut add = |plane: &[f32]| {
                for (at, value) in plane.iter().enumerate() {
                    let x = id.x as usize * TILE + at % TILE;
                    let y = id.y as usize * TILE + at / TILE;
                    if x < width && y < height {
                        thickness_um[y * width + x] += 1e6 * QUANTUM_M as f32 * value;
                    }
                }
            };
            for (_, plane) in &*tile.wet() {
                add(plane);
            }
            if let Some(dry) = tile.dry() {
                add(&dry.height());
            }
        }
        Self {
            colours,
            thickness_um,
            width,
        }
    }

    /// Cells of a region in mm from the lower left corner, as columns and rows from the bottom.
    fn cells(&self, [x, y]: [Range<f64>; 2]) -> Vec<[usize; 2]> {
        let cell = |mm: f64| (mm / CELL_MM) as usize;
        let columns = cell(x.start)..cell(x.end).min(self.width);
        let rows = cell(y.start)..cell(y.end).min(self.colours.height);
        rows.flat_map(|y| columns.clone().map(move |x| [x, y]))
            .collect()
    }

    /// Mean red, green and blue, 0 to 255.
    fn colour(&self, region: [Range<f64>; 2]) -> [f64; 3] {
        let cells = self.cells(region);
        [0, 1, 2].map(|i| {
            let of = cells.iter().map(|[x, y]| {
                let row = self.colours.height - 1 - y;
                f64::from(self.colours.rgb[3 * (row * self.width + x) + i])
            });
            of.sum::<f64>() / cells.len() as f64
        })
    }

    /// Mean thickness, µm.
    fn thickness(&self, region: [Range<f64>; 2]) -> f64 {
        let cells = self.cells(region);
        let of = cells
            .iter()
            .map(|[x, y]| self.thickness_um[y * self.width + x]);
        of.map(f64::from).sum::<f64>() / cells.len() as f64
    }

    /// Share of the canvas on which more than the toned ground lies.
    fn covered(&self) -> f64 {
        let over = self.thickness_um.iter().filter(|um| **um > GROUND_UM);
        over.count() as f64 / self.thickness_um.len() as f64
    }
}

fn value([red, green, blue]: [f64; 3]) -> f64 {
    0.3 * red + 0.6 * green + 0.1 * blue
}

#[test]
fn each_script_is_small_and_says_its_size() {
    let library = PaintLibrary::measured().expect("whole");
    for (name, text) in PAINTINGS {
        assert!(text.len() < 300 * 1024, "{name}: {} bytes", text.len());
        let script = script(name, &library).expect(name);
        let size = script.canvas_mm.expect(name);
        assert!(size.iter().all(|side| (140.0..=240.0).contains(side)));
        assert!(script.files.is_empty(), "{name}");
    }
    let fault = script("still-live", &library).expect_err("none");
    assert!(fault.help.is_some_and(|help| help.contains("'still-life'")));
}
