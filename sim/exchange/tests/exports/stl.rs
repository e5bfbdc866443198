//! STL files, measured.

use std::io::Cursor;

use maulstick_exchange::{
    ExchangeError, SOLID_TRIANGLES, SolidSetup, SolidSize, solid_step, write_stl,
};
use maulstick_painting::Painting;
use maulstick_types::scene::CANVAS;

use crate::mesh::{StlFacet, corners, cross, dot, is_watertight, stl_facets, volume};
use crate::support::{CELL_M, CELLS, STL, bare, heights, painted, speck};

fn solid(painting: &mut Painting, setup: &SolidSetup) -> (SolidSize, Vec<StlFacet>) {
    let mut to = Cursor::new(Vec::new());
    let size = write_stl(painting, CANVAS, setup, &mut to, &mut |_, _| {}).expect("written");
    let file = to.into_inner();
    assert!(!file.starts_with(b"solid"), "that would be text");
    let count = u32::from_le_bytes(file[80..84].try_into().expect("four"));
    assert_eq!(u64::from(count), size.triangles);
    assert_eq!(file.len(), 84 + 50 * count as usize);
    (size, stl_facets(&file))
}

fn normals_fit(facets: &[StlFacet]) -> bool {
    facets.iter().all(|facet| {
        let [normal, a, b, c] = facet.map(|point| point.map(f64::from));
        let side = |to: [f64; 3]| [0, 1, 2].map(|i| to[i] - a[i]);
        let own = cross(side(b), side(c));
        let length = dot(own, own).sqrt();
        length > 0.0 && (dot(own, normal) / length - 1.0).abs() < 1e-5
    })
}

/// Middles of blocks of `step` cells with their cells, and both edges with those of the block beside them.
fn vertices(cells: usize, step: usize) -> Vec<(f64, std::ops::Range<usize>)> {
    let starts = (0..cells).step_by(step);
    let blocks: Vec<_> = starts
        .map(|start| start..(start + step).min(cells))
        .collect();
    let middle = |block: &std::ops::Range<usize>| (block.start + block.end) as f64 / 2.0;
    let mut all: Vec<_> = blocks
        .iter()
        .map(|block| (middle(block), block.clone()))
        .collect();
    all.insert(0, (0.0, blocks[0].clone()));
    all.push((cells as f64, blocks[blocks.len() - 1].clone()));
    all
}

/// mm³, by prisms under the triangles between the highest cells of blocks.
fn expected(heights: &[f32], setup: &SolidSetup) -> f64 {
    let [width, height] = CELLS.map(|cells| cells as usize);
    let step = setup.step as usize;
    let (xs, ys) = (vertices(width, step), vertices(height, step));
    let highest = |i: usize, j: usize| {
        let (across, up) = (xs[i].1.clone(), ys[j].1.clone());
        let cells = up.flat_map(|y| across.clone().map(move |x| (height - 1 - y) * width + x));
        cells
            .map(|cell| f64::from(heights[cell]))
            .fold(f64::MIN, f64::max)
    };
    let tops: Vec<Vec<f64>> = (0..ys.len())
        .map(|j| (0..xs.len()).map(|i| highest(i, j)).collect())
        .collect();
    let least = tops.iter().flatten().copied().fold(f64::MAX, f64::min);
    let z = |i: usize, j: usize| setup.base_mm + (tops[j][i] - least) * setup.exaggeration * 1e3;
    let mut sum = 0.0;
    for j in 1..ys.len() {
        for i in 1..xs.len() {
            let area = (xs[i].0 - xs[i - 1].0) * (ys[j].0 - ys[j - 1].0) * (CELL_M * 1e3).powi(2);
            let corners = 2.0 * (z(i - 1, j - 1) + z(i, j)) + z(i, j - 1) + z(i - 1, j);
            sum += area * corners / 6.0;
        }
    }
    sum
}

#[test]
fn no_peak_is_lost_however_coarse_the_solid_is() {
    let mut painting = painted();
    let heights = heights(&mut painting);
    let ends = |values: &mut dyn Iterator<Item = f32>| {
        values.fold([f32::MAX, f32::MIN], |[least, most], z| {
            [least.min(z), most.max(z)]
        })
    };
    let [lowest, peak] = ends(&mut heights.iter().copied()).map(f64::from);
    for step in [1, 2, 5, 64] {
        let setup = SolidSetup {
            step,
            exaggeration: 1.0,
            ..STL
        };
        let (_, facets) = solid(&mut painting, &setup);
        let tops = facets
            .iter()
            .flat_map(|facet| &facet[1..])
            .map(|point| point[2]);
        let [least, most] = ends(&mut tops.filter(|z| *z > 0.0)).map(f64::from);
        let printed = 1e3 * (most - least);
        println!(
            "step {step}: {printed:.1} of {:.1} µm",
            1e6 * (peak - lowest)
        );
        // Coarser solids rise from the highest of the lowest block.
        let from = if step == 1 {
            lowest
        } else {
            peak - printed * 1e-6
        };
        assert!((printed - 1e6 * (peak - from)).abs() < 0.5, "step {step}");
        assert!(from >= lowest - 1e-9, "step {step}");
    }
}

#[test]
fn a_relief_is_a_solid_of_the_right_volume() {
    let mut painting = painted();
    let heights = heights(&mut painting);
    for step in [1, 2, 3, 64, 100, 1000] {
        let setup = SolidSetup { step, ..STL };
        let (size, facets) = solid(&mut painting, &setup);
        assert!(is_watertight(&corners(&facets)), "step {step}");
        assert!(normals_fit(&facets), "step {step}");
        let top = facets
            .iter()
            .flatten()
            .map(|point| point[2])
            .fold(0.0, f32::max);
        assert!((f64::from(top) - size.size_mm[2]).abs() < 1e-5);
        assert_eq!(size.size_mm[..2], [37.5, 17.5]);
        let expected = |exaggeration: f64| {
            let setup = SolidSetup {
                exaggeration,
                ..setup
            };
            expected(&heights, &setup)
        };
        let off = |expected: f64| (volume(&corners(&facets)) / expected - 1.0).abs();
        println!(
            "step {step}: {} triangles, off by {:.1e}",
            size.triangles,
            off(expected(5.0))
        );
        assert!(off(expected(5.0)) < 1e-6, "step {step}");
        assert!(
            off(expected(5.05)) > 1e-6 || step > 64,
            "a fault would pass"
        );
    }
    let (_, mut facets) = solid(&mut painting, &STL);
    let whole = volume(&corners(&facets));
    let [normal, a, b, c] = facets[100];
    facets[100] = [normal, a, c, b];
    assert!(
        !is_watertight(&corners(&facets))
            && !normals_fit(&facets)
            && volume(&corners(&facets)) < whole
    );
    facets.remove(100);
    assert!(!is_watertight(&corners(&facets)), "a hole would pass");
}

#[test]
fn a_cell_is_a_block() {
    let (size, facets) = solid(&mut speck(), &STL);
    assert_eq!((size.triangles, facets.len()), (32, 32));
    assert!(is_watertight(&corners(&facets)) && normals_fit(&facets));
    assert!((volume(&corners(&facets)) - 0.25 * 0.25 * 2.0).abs() < 1e-7);
}

#[test]
fn a_proposed_step_gives_as_many_triangles_as_programs_bear() {
    let triangles = |cells: [u32; 2], step: u32| {
        let [across, up] = cells.map(|cells| u64::from(cells.div_ceil(step)) + 1);
        2 * across * up + 6 * (across + up)
    };
    for (cells, step) in [
        ([1, 1], 1),
        (CELLS, 1),
        ([1024, 1024], 1),
        ([16_384, 16_384], 12),
        ([65_536, 1], 1),
    ] {
        assert_eq!(solid_step(cells), step);
        assert!(triangles(cells, step) <= SOLID_TRIANGLES);
        assert!(step == 1 || triangles(cells, step - 1) > SOLID_TRIANGLES);
    }
}

#[test]
fn measures_out_of_range_are_refused() {
    let mut painting = speck();
    for setup in [
        SolidSetup {
            base_mm: 0.0,
            ..STL
        },
        SolidSetup {
            base_mm: f64::NAN,
            ..STL
        },
        SolidSetup {
            exaggeration: -1.0,
            ..STL
        },
        SolidSetup {
            exaggeration: f64::INFINITY,
            ..STL
        },
        SolidSetup { step: 0, ..STL },
    ] {
        let mut to = Vec::new();
        let error = write_stl(&mut painting, CANVAS, &setup, &mut to, &mut |_, _| {});
        println!("{}", error.as_ref().expect_err("refused"));
        assert!(matches!(error, Err(ExchangeError::OutOfRange { .. })));
        assert!(to.is_empty());
    }
    let flat = SolidSetup {
        exaggeration: 0.0,
        ..STL
    };
    assert_eq!(solid(&mut painted(), &flat).0.size_mm[2], 2.0);
}

#[test]
fn more_triangles_than_a_file_can_count_are_refused_with_a_step_that_fits() {
    let mut vast = bare([65_536, 65_536]);
    let setup = SolidSetup { step: 1, ..STL };
    let mut to = Vec::new();
    let error = write_stl(&mut vast, CANVAS, &setup, &mut to, &mut |_, _| {});
    println!("{}", error.as_ref().expect_err("refused"));
    assert!(to.is_empty());
    assert!(matches!(
        error,
        Err(ExchangeError::TooManyTriangles { step: 47, .. })
    ));
}
