//! § 4.2: the brush touches where it is near enough to the top of the surface, with its film.

use maulstick_dab::touching::{BRIDGED, Brush, Canvas, Touching, touch};
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng as _;

/// Height of a quantum on its cell, cells.
const CELLS: f64 = 1.5e-9 / 1.25e-4;
const SINK: f64 = 0.3;

/// Fault of an oracle.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    None,
    /// The film of the brush is ignored.
    Bare,
    /// A bristle does not follow the ride into valleys.
    Stiff,
    /// A bristle does not sink in.
    Floats,
    /// Dry relief is ignored.
    Flat,
    /// Wet paint is ignored.
    Dry,
}

/// A cell: cover, height, clearance, base, ride, quanta on the brush and on the canvas.
type Cell = [f64; 7];

/// True if a cell touches; share of the wet paint that is reached; the gap, quanta.
fn meets(
    [cover, height, clearance, base, ride, film, lies]: Cell,
    fault: Fault,
) -> (bool, f64, f64) {
    let has = |what: Fault, value: f64| if fault == what { 0.0 } else { value };
    let wet = has(Fault::Dry, lies * CELLS);
    let below = if fault == Fault::Stiff {
        0.0
    } else {
        ride.min(0.0)
    };
    let rests = (height + below).max(ride);
    let reach = has(Fault::Flat, base) + wet - rests + has(Fault::Floats, SINK) - clearance;
    let touches = cover > 0.0 && reach + has(Fault::Bare, film * CELLS) > 0.0;
    let share = if lies > 0.0 {
        reach.clamp(0.0, wet) / wet.max(1e-30)
    } else {
        0.0
    };
    (
        touches,
        share,
        f64::from(BRIDGED) * (-reach).max(0.0) / CELLS,
    )
}

/// Cells at random, of numbers that f32 has.
fn random_cells(count: usize) -> Vec<Cell> {
    let mut random = Pcg32::new(11, 3);
    let mut unit = || f64::from(random.next_u32()) / 4_294_967_296.0;
    let cell = |_| {
        let cover = if unit() < 0.2 { 0.0 } else { unit() };
        let [height, clearance] = [unit(), 0.6 * unit()];
        let ride = 0.8 * (unit() - 0.5);
        let base = ride - 0.3 * unit();
        let film = (unit() * 60_000.0).floor();
        let lies = if unit() < 0.1 {
            0.0
        } else {
            (unit() * 60_000.0).floor()
        };
        let cell = [cover, height, clearance, base, ride, film, lies];
        cell.map(|value| f64::from(value as f32))
    };
    (0..count).map(cell).collect()
}

/// Counts as two paints: a third and the rest.
fn parted(plane: &[f32]) -> [Vec<f32>; 2] {
    let third: Vec<f32> = plane.iter().map(|count| (count / 3.0).floor()).collect();
    let rest = plane.iter().zip(&third);
    let rest = rest.map(|(all, part)| all - part).collect();
    [third, rest]
}

/// Touches a row of cells of two paints a side, the second of which is the thinner.
fn touched(cells: &[Cell]) -> Touching {
    let plane = |i: usize| -> Vec<f32> { cells.iter().map(|cell| cell[i] as f32).collect() };
    let planes: Vec<Vec<f32>> = (0..7).map(plane).collect();
    let (mut film, mut lies) = (parted(&planes[5]), parted(&planes[6]));
    let way: Vec<f32> = planes[0].iter().map(|cover| 2.0 * cover).collect();
    let mut found = Touching::default();
    found.begin(cells.len());
    touch(
        &Brush {
            count: cells.len(),
            cover: &planes[0],
            rate: &planes[0],
            way: &way,
            height: &planes[1],
            clearance: &planes[2],
            film: &film.each_mut().map(|plane| &mut plane[..]),
            start: 0,
            sink: SINK as f32,
        },
        &Canvas {
            base: &planes[3],
            ride: &planes[4],
            wet: &lies.each_mut().map(|plane| &mut plane[..]),
            thinner: Some(1),
            start: 0,
            cells_per_quantum: CELLS as f32,
        },
        &mut found,
    );
    found
}

/// True if a cell was touched as by the oracle.
fn is_like(found: &Touching, i: usize, cell: &Cell, fault: Fault) -> bool {
    let (touches, reach, gap) = meets(*cell, fault);
    let [rate, way] = [1.0, 2.0].map(|factor| if touches { factor * cell[0] } else { 0.0 });
    let near = |got: f32, want: f64, by: f64| (f64::from(got) - want).abs() < by;
    let is_covered = cell[0] > 0.0;
    near(found.rate[i], rate, 1e-6)
        && near(found.way[i], way, 1e-6)
        && (!is_covered || near(found.reach[i], reach, 1e-3))
        && (!is_covered || near(found.gap[i], gap, 2.0 + 1e-5 * gap))
}

#[test]
fn a_row_touches_as_its_cells_do_and_each_fault_is_found() {
    let cells = random_cells(997);
    let found = touched(&cells);
    let off = |fault: Fault| {
        let wrong = cells.iter().enumerate();
        let wrong = wrong.filter(|(i, cell)| !is_like(&found, *i, cell, fault));
        wrong.count()
    };
    assert_eq!(off(Fault::None), 0);
    for fault in [
        Fault::Bare,
        Fault::Stiff,
        Fault::Floats,
        Fault::Flat,
        Fault::Dry,
    ] {
        let found = off(fault);
        println!("{fault:?} {found}");
        assert!(found > 20, "{fault:?}: {found}");
    }
    let touching = cells.iter().filter(|cell| meets(**cell, Fault::None).0);
    let lies: Vec<f32> = touching.map(|cell| cell[6] as f32).collect();
    let sum = |counts: &[f32]| counts.iter().copied().map(f64::from).sum::<f64>();
    let [_, thinner] = parted(&lies);
    assert_eq!(
        (found.cells, found.wet),
        (lies.len() as f64, [sum(&lies), sum(&thinner)])
    );
}
