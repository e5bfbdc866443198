//! Solids of paint at known places.

use std::collections::BTreeMap;
use std::sync::Arc;

use maulstick_appearance::Appearance;
use maulstick_appearance::blank_surface::BlankSurface;
use maulstick_appearance::ground::Ground;
use maulstick_appearance::show_paint::{Counted, ShowPaint};
use maulstick_appearance::shown_surface::ShownSurface;
use maulstick_canvas::own_plane::OwnPlane;
use maulstick_canvas::page::Page;
use maulstick_canvas::planes::{Planes, TILE_CELLS};
use maulstick_canvas::relief::Relief;
use maulstick_canvas::relief::tooth::Tooth;
use maulstick_canvas::store::TileStore;
use maulstick_canvas::tile::{Tile, Version};
use maulstick_optics::{PaintLibrary, Studio};
use maulstick_types::paint::TILE;

use maulstick_stokes_paint::layer_planes::shape_of;
use maulstick_stokes_paint::layers::Layers;
use maulstick_stokes_paint::overhangs::Overhangs;

use super::*;

const CELL_M: f64 = 2.5e-4;
/// Quanta of a voxel: 2⁻²⁴ of 25 mm each.
const FULL: f32 = 167_772.0;
/// Across two tiles, and up one.
const CELLS: [u32; 2] = [90, 40];
const SETUP: SolidSetup = SolidSetup {
    base_mm: 1.0,
    exaggeration: 1.0,
    step: 1,
};

/// Paint as its share of each voxel, by place and layer.
type Fill<'a> = &'a dyn Fn([usize; 3]) -> f32;

/// Paint in a number of layers, the lowest `first`; each voxel half of each of two paints.
fn planes(tile: [usize; 2], first: usize, layers: usize, fill: Fill<'_>) -> Planes {
    let count = |cell: usize, layer: usize| {
        let at = [
            tile[0] * TILE + cell % TILE,
            tile[1] * TILE + cell / TILE,
            layer,
        ];
        (0.5 * FULL * fill(at)).round()
    };
    let all = |cell: usize| {
        (first..first + layers)
            .map(|layer| count(cell, layer))
            .sum()
    };
    let plane: Arc<[f32]> = (0..TILE_CELLS).map(all).collect();
    let own = (first + 1..first + layers).flat_map(|layer| {
        [0, 1].map(|slot| OwnPlane {
            shape: shape_of(slot, layer),
            bytes: (0..TILE_CELLS)
                .flat_map(|cell| count(cell, layer).to_le_bytes())
                .collect(),
        })
    });
    let planes: Planes = [(0, Arc::clone(&plane)), (1, plane)].into_iter().collect();
    planes.with_own(own)
}

struct Surface {
    store: TileStore,
    bare: ShownSurface,
    look: Appearance,
}

impl Surface {
    fn new(relief: Relief) -> Self {
        let mut studio = Studio::daylight();
        let library = PaintLibrary::measured().expect("whole");
        for paint in ["Ultramarine Blue", "Pyrrole Red"] {
            studio.add(library.find(paint).expect("known"));
        }
        Self {
            store: TileStore::new(CELLS),
            bare: ShownSurface {
                shown: &Overhangs,
                blank: BlankSurface {
                    cells: CELLS,
                    ground: Ground::Even(vec![0.9; studio.wavelengths()]),
                    relief: Arc::new(relief),
                    wells: Vec::new(),
                },
            },
            look: Appearance::new(studio),
        }
    }

    fn flat() -> Self {
        Self::new(Relief::flat(CELL_M))
    }

    /// Adds wet paint over the existing paint, which dries.
    fn lay(mut self, first: usize, layers: usize, fill: Fill<'_>) -> Self {
        let ids: Vec<_> = self.store.iter().map(|(id, _)| id).collect();
        for id in ids {
            let before = self.store.version(id).tile.clone();
            let dry = before.and_then(|tile| tile.dried(1, 1.0, &[])?.dry().cloned());
            let planes = planes([id.x as usize, id.y as usize], first, layers, fill);
            let tile = Tile::of_pages(Some(Page::loose(planes)), dry);
            let tile = Some(Arc::new(tile));
            self.store.replace(id, Version { number: 2, tile });
        }
        self
    }

    /// Displayed heights, cells.
    fn shown(&self, shown: &'static dyn ShowPaint) -> Vec<f32> {
        let bare = ShownSurface {
            shown,
            ..self.bare.clone()
        };
        let banded = Banded::new(&self.store, &bare, &self.look, CELL_M);
        let bands = (0..banded.bands()).rev().map(|band| banded.heights(band));
        let heights = bands.flat_map(|band| band.to_vec());
        heights.map(|m| m / CELL_M as f32).collect()
    }

    /// The solid, lengths in cells, its reported size, and the height of its lowest place.
    fn solid(&self, setup: SolidSetup) -> (Made, SolidSize, f64) {
        let banded = Banded::new(&self.store, &self.bare, &self.look, CELL_M);
        let mut tell = |_, _| {};
        let mut steps = Steps::new(&mut tell, 2);
        let solid = Solid::measure(&banded, setup, u64::MAX, &mut steps).expect("measured");
        let made = solid.triangulate(1.0 / CELL_M, false, &mut steps, Made::default());
        let made = made.expect("made");
        assert_eq!(made.facets.len() as u64, solid.triangles());
        assert_eq!(made.vertices.len() as u64, solid.counts.vertices);
        (made, solid.extent(), solid.range_m[0] / CELL_M)
    }

    /// Its solid, and the volume of its paint, voxels: the difference from the solid without paint.
    fn paint(&self) -> (Made, f64) {
        let bare = Self {
            store: TileStore::new(CELLS),
            bare: self.bare.clone(),
            look: self.look.clone(),
        };
        let (made, _, lowest) = self.solid(SETUP);
        let (ground, _, lowest_ground) = bare.solid(SETUP);
        let lifted = (lowest - lowest_ground) * f64::from(CELLS[0] * CELLS[1]);
        let volume = made.volume() - ground.volume() + lifted;
        (made, volume)
    }
}

#[derive(Default)]
struct Made {
    vertices: Vec<Point>,
    facets: Vec<[Point; 3]>,
    complete: u32,
}

impl MeshSink for Made {
    fn add_vertex(&mut self, at: Point, _colour: Colour) {
        self.vertices.push(at);
    }

    fn add_surface_facet(&mut self, corners: [Corner; 3]) -> Result<(), ExchangeError> {
        for corner in corners {
            assert!(corner.id >= self.complete);
            assert_eq!(self.vertices[corner.id as usize], corner.at);
        }
        self.add_wall_facet(corners.map(|corner| corner.at), [0.0; 3])
    }

    fn add_wall_facet(
        &mut self,
        corners: [Point; 3],
        _colour: Colour,
    ) -> Result<(), ExchangeError> {
        self.facets.push(corners);
        Ok(())
    }

    fn complete_vertices(&mut self, end: u32) -> Result<(), ExchangeError> {
        self.complete = end;
        Ok(())
    }
}

impl Made {
    /// By the theorem of Gauss.
    fn volume(&self) -> f64 {
        let parts = self.facets.iter().map(|facet| {
            let n = area_normal(facet);
            (0..3).map(|i| n[i] * f64::from(facet[0][i])).sum::<f64>() / 6.0
        });
        parts.sum()
    }

    /// Facets along each edge in either direction.
    fn edges(&self) -> BTreeMap<[[u32; 3]; 2], [u32; 2]> {
        let mut edges: BTreeMap<[[u32; 3]; 2], [u32; 2]> = BTreeMap::new();
        for facet in &self.facets {
            let bits = facet.map(|corner| corner.map(f32::to_bits));
            for i in 0..3 {
                let (from, to) = (bits[i], bits[(i + 1) % 3]);
                edges.entry([from.min(to), from.max(to)]).or_default()[usize::from(from > to)] += 1;
            }
        }
        edges
    }

    /// Twice the area of the smallest facet.
    fn least_area(&self) -> f64 {
        let length = |n: [f64; 3]| n.iter().map(|part| part * part).sum::<f64>().sqrt();
        let areas = self.facets.iter().map(|facet| length(area_normal(facet)));
        areas.fold(f64::INFINITY, f64::min)
    }

    /// Share of places, four in each cell, over which air and paint do not alternate upward, where facets cross.
    fn crossed(&self) -> f64 {
        const PLACES: [[f64; 2]; 4] = [[0.31, 0.17], [0.83, 0.36], [0.64, 0.71], [0.12, 0.94]];
        let mut met: BTreeMap<[usize; 3], Vec<(f64, bool)>> = BTreeMap::new();
        for facet in &self.facets {
            let [a, b, c] = facet.map(|corner| corner.map(f64::from));
            let n = area_normal(facet);
            let ends = |axis: usize| {
                let along = [a[axis], b[axis], c[axis]];
                let least = along.iter().copied().fold(f64::INFINITY, f64::min);
                let most = along.iter().copied().fold(0.0, f64::max);
                least as usize..=most as usize
            };
            // The bottom is met everywhere.
            if n[2] == 0.0 || [a[2], b[2], c[2]] == [0.0; 3] {
                continue;
            }
            for (x, y, place) in ends(0)
                .flat_map(|x| ends(1).flat_map(move |y| (0..4).map(move |place| (x, y, place))))
            {
                let at = [x as f64 + PLACES[place][0], y as f64 + PLACES[place][1]];
                let turn = |from: [f64; 3], to: [f64; 3]| {
                    (to[0] - from[0]) * (at[1] - from[1]) - (to[1] - from[1]) * (at[0] - from[0])
                };
                let turns = [turn(a, b), turn(b, c), turn(c, a)];
                if turns.iter().all(|turn| turn * n[2] > 0.0) {
                    let z = a[2] - ((at[0] - a[0]) * n[0] + (at[1] - a[1]) * n[1]) / n[2];
                    met.entry([x, y, place]).or_default().push((z, n[2] > 0.0));
                }
            }
        }
        let all = met.len() as f64;
        let is_crossed = |places: &mut Vec<(f64, bool)>| {
            places.sort_by(|one, other| one.0.total_cmp(&other.0));
            let mut in_turn = places.iter().enumerate();
            !in_turn.all(|(place, (_, is_top))| *is_top == place.is_multiple_of(2))
        };
        met.into_values()
            .filter_map(|mut places| is_crossed(&mut places).then_some(()))
            .count() as f64
            / all
    }

    /// True if each edge has two facets that run along it in opposite directions.
    fn is_closed(&self) -> bool {
        self.edges().values().all(|runs| *runs == [1, 1])
    }

    /// Heights in cells above the ground at which the surface crosses the middle of a cell.
    fn heights(&self, [x, y]: [usize; 2]) -> Vec<f32> {
        let middle = [x, y].map(|at| at as f32 + 0.5);
        let base = (SETUP.base_mm / (CELL_M * MM)) as f32;
        let here = self.vertices.iter().filter(|at| [at[0], at[1]] == middle);
        let mut heights: Vec<f32> = here.map(|at| at[2] - base).collect();
        heights.sort_by(f32::total_cmp);
        heights
    }
}

fn near(one: &[f32], other: &[f32], within: f32) -> bool {
    one.len() == other.len() && one.iter().zip(other).all(|(a, b)| (a - b).abs() < within)
}

#[test]
fn a_level_film_has_its_thickness_to_a_part_of_a_cell() {
    for thickness in [0.04, 0.37, 1.0, 2.63] {
        let level = |[_, _, layer]: [usize; 3]| (thickness - layer as f32).clamp(0.0, 1.0);
        let (made, volume) = Surface::flat().lay(0, 4, &level).paint();
        let want = f64::from(CELLS[0] * CELLS[1]) * f64::from(thickness);
        println!("{thickness}: volume off by {:.1e}", volume / want - 1.0);
        assert!(made.is_closed() && (volume / want - 1.0).abs() < 0.002);
    }
    let film = |[x, _, layer]: [usize; 3]| if x < 45 && layer == 0 { 0.37 } else { 0.0 };
    let (made, volume) = Surface::flat().lay(0, 4, &film).paint();
    let want = 45.0 * f64::from(CELLS[1]) * 0.37;
    let off = |want: f64| (volume / want - 1.0).abs();
    assert!(made.is_closed() && off(want) < 0.002);
    assert!(off(1.05 * want) > 0.02, "a fault would pass");
    assert!(near(&made.heights([20, 20]), &[0.37], 1e-3));
}

#[test]
fn an_overhang_has_air_under_it_and_all_of_its_paint() {
    let wall = |[x, y, layer]: [usize; 3]| {
        let inside = (50..80).contains(&x) && (8..32).contains(&y);
        match layer {
            0..4 if inside && x < 54 => 1.0,
            4 if inside => 1.0,
            5 if inside => 0.4,
            _ => 0.0,
        }
    };
    let surface = Surface::flat().lay(0, 8, &wall);
    let (made, volume) = surface.paint();
    let want = 24.0 * (4.0 * 4.0 + 30.0 * 1.4);
    let off = |want: f64| (volume / want - 1.0).abs();
    println!("overhang: {volume:.1} of {want}");
    assert!(made.is_closed() && off(want) < 0.02);
    assert!(off(1.04 * want) > 0.02, "a fault would pass");
    assert!(near(&made.heights([52, 20]), &[5.4], 1e-3));
    assert!(
        near(&made.heights([63, 20]), &[0.0, 4.0, 5.4], 1e-3),
        "{:?}",
        made.heights([63, 20])
    );
    assert!(near(&made.heights([70, 20]), &[0.0, 4.0, 5.4], 1e-3));
    assert!(made.crossed() == 0.0, "{}", made.crossed());
    let mut faulty = Made {
        facets: made.facets.clone(),
        ..Made::default()
    };
    faulty.facets[100].swap(1, 2);
    assert!(!faulty.is_closed() && faulty.volume() != made.volume());
    let up = |facet: &&mut [Point; 3]| area_normal(facet)[2] > 0.4;
    faulty
        .facets
        .iter_mut()
        .filter(up)
        .for_each(|facet| facet.swap(1, 2));
    assert!(faulty.crossed() > 0.9, "facets that look down would pass");
    faulty.facets.swap_remove(100);
    assert!(!faulty.is_closed(), "a hole would pass");
    // As a height map it would stand on the ground.
    let (coarse, told, _) = surface.solid(SolidSetup { step: 3, ..SETUP });
    assert!(coarse.is_closed());
    assert!(
        (told.size_mm[2] - (1.0 + 5.4 * 0.25)).abs() < 1e-3,
        "no peak is lost"
    );
}

#[test]
fn a_ball_in_the_air_is_one() {
    let ball = |[x, y, layer]: [usize; 3]| {
        let from =
            [(x, 62.0), (y, 20.0), (layer, 12.0)].map(|(at, middle)| at as f32 + 0.5 - middle);
        let distance = from.iter().map(|d| d * d).sum::<f32>().sqrt();
        (8.5 - distance).clamp(0.0, 1.0)
    };
    let surface = Surface::flat().lay(0, 24, &ball);
    let (made, volume) = surface.paint();
    let want = 4.0 / 3.0 * std::f64::consts::PI * 512.0;
    println!("ball: {volume:.1} of {want:.1}");
    assert!(made.is_closed() && (volume / want - 1.0).abs() < 0.02);
    let middle = made.heights([62, 20]);
    assert!(near(&middle, &[0.0, 4.0, 20.0], 0.1), "{middle:?}");
    // The displayed height is its top, including the air under it.
    let middle = 20 * CELLS[0] as usize + 62;
    let tops = [&Overhangs as &dyn ShowPaint, &Counted].map(|shown| surface.shown(shown)[middle]);
    assert!(
        (tops[0] - 20.0).abs() < 0.1 && (tops[1] - 16.0).abs() < 0.1,
        "{tops:?}"
    );
}

#[test]
fn ragged_paint_on_linen_wet_and_dry_is_closed_and_whole() {
    let linen = Relief::new(Tooth::new("linen", 1, CELL_M).expect("a tooth"), CELL_M);
    let below = Layers::over(&linen, CELL_M).below as usize;
    let ragged = |seed: usize| {
        move |[x, y, layer]: [usize; 3]| {
            let part = |at: usize| (at * 7 + seed) % 23;
            let hash = (x / 3 * 73 + y / 2 * 151 + layer * 211 + seed * 37) % 101;
            if part(x) < 14 && hash < 45 {
                0.02 * hash as f32 + 0.1
            } else {
                0.0
            }
        }
    };
    let [dry, wet] = [1, 5].map(ragged);
    let surface = Surface::new(linen).lay(below, 9, &dry).lay(below, 5, &wet);
    let mut want = 0.0;
    for y in 0..CELLS[1] as usize {
        for x in 0..CELLS[0] as usize {
            let sum = |fill: Fill<'_>, layers: usize| {
                (below..below + layers)
                    .map(|layer| f64::from(fill([x, y, layer])))
                    .sum::<f64>()
            };
            want += sum(&dry, 9) + sum(&wet, 5);
        }
    }
    let (made, volume) = surface.paint();
    println!(
        "ragged: {volume:.1} of {want:.1}, {} facets",
        made.facets.len()
    );
    assert!(made.is_closed() && made.least_area() > 0.0);
    assert!((volume / want - 1.0).abs() < 0.02);
    println!("crossed: {:.2e}", made.crossed());
    assert!(made.crossed() < 0.01);
}

#[test]
fn the_edge_of_a_thin_ridge_does_not_cross_itself() {
    // A sheet whose height and thickness differ from cell to cell.
    let sheet = |[x, y, layer]: [usize; 3]| {
        let lowest = 4 + (x * 7 + y * 3) % 5 / 3;
        match layer {
            0 => 0.3,
            _ if y < 15 || layer < lowest => 0.0,
            _ if layer == lowest => 1.0,
            _ if layer == lowest + 1 => 0.05 * ((x * 11 + y * 5) % 17) as f32,
            _ => 0.0,
        }
    };
    let (made, _) = Surface::flat().lay(0, 8, &sheet).paint();
    assert!(made.is_closed() && made.least_area() > 0.0);
    assert!(made.crossed() == 0.0, "{}", made.crossed());
}

/// A ridge along the left edge that leans over the rim's tiles, and one that ends at the upper edge.
fn at_the_rim([x, y, layer]: [usize; 3]) -> f32 {
    let up = CELLS[1] as usize;
    match layer {
        0..3 if x < 2 || (y + 2 >= up && x > 70) => 1.0,
        3 if x < 9 || (y + 9 >= up && x > 70) => 1.0,
        _ => 0.0,
    }
}

#[test]
fn overhangs_at_the_rim_are_walled() {
    let surface = Surface::flat().lay(0, 4, &at_the_rim);
    let (made, volume) = surface.paint();
    let [across, up] = CELLS.map(f64::from);
    let want = up * (2.0 * 3.0 + 9.0) + (across - 71.0) * (2.0 * 3.0 + 9.0);
    println!("rim: {volume:.1} of {want}");
    assert!(made.crossed() == 0.0, "{}", made.crossed());
    assert!(made.is_closed() && made.least_area() > 0.0);
    assert!((volume / want - 1.0).abs() < 0.02);
}

#[test]
fn heights_made_small_leave_no_slivers() {
    let surface = Surface::flat().lay(0, 4, &at_the_rim);
    for exaggeration in [0.0, 1e-9, 1e-3, 1000.0] {
        let (made, told, _) = surface.solid(SolidSetup {
            exaggeration,
            base_mm: 1000.0,
            ..SETUP
        });
        assert!(made.is_closed(), "{exaggeration}");
        assert!(made.least_area() > 0.0, "{exaggeration}");
        let highest = made.vertices.iter().map(|at| at[2]).fold(0.0, f32::max);
        let of_told = told.size_mm[2] / (CELL_M * MM);
        assert!((f64::from(highest) / of_told - 1.0).abs() < 1e-6);
    }
    let (mut made, ..) = surface.solid(SETUP);
    made.facets[9][1] = made.facets[9][0];
    assert!(made.least_area() == 0.0, "a fault would pass");
}
