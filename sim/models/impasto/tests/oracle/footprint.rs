//! Stage 1: every cell tests every segment of every strip for cover, and for the height of the bristle, round below, on
//! the relief.

use maulstick_brush::head::STATIONS;
use maulstick_model::brush::head::low_bounds;
use maulstick_model::brush::load::Half;
use maulstick_model::brush::traits::TEXELS_PER_STRIP;
use maulstick_model::footprint::Footprint;
use maulstick_model::footprint::contact::Contact;

use crate::scene::{CELL_M, CELLS, Scene};

/// Greatest height added to a ribbon that covers a cell only in part.
const EDGE_PENALTY: f64 = 0.9;
const RANKS: f64 = 0.02;
const BENT: f64 = 0.2;
/// Least width of a soft end, cells.
const SHARP: f64 = 0.25;
/// Extension of a strip beyond its tip, cells.
const TIP: f64 = 0.5;
/// Sixteen roundings of a place below 128 cells in f32.
const ROUNDING: f64 = 16.0 * 128.0 / 33_554_432.0;

/// A segment that covers a cell.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    score: f64,
    /// Height of its middle line, cells.
    z: f64,
    /// Distance from the surface below it, cells.
    keeps: f64,
    /// Place across it, 0 in the middle to 1 at an edge, and its tolerance.
    across: f64,
    across_off: f64,
    cover: f64,
    strip: usize,
    along: f64,
    moved: [f64; 2],
    /// Tolerance of its values.
    off: f64,
    /// True if it certainly covers the cell.
    sure: bool,
}

/// Possible contacts of a cell, or none.
#[derive(Clone, Debug, Default)]
struct Cell {
    /// Possible contacts, with the tolerances of place and height.
    contacts: Vec<(Contact, [f64; 2])>,
    /// Tolerance of the cover.
    cover_off: f64,
    none: bool,
}

/// The segment from station `station − 1` of a strip in the middle of the step, in f64.
struct Segment {
    /// Places, cells.
    ends: [[f64; 3]; 2],
    moved: [[f64; 2]; 2],
    is_last: bool,
}

fn segment(scene: &Scene, strip: usize, station: usize) -> Segment {
    let point = |station: usize| {
        let i = station * scene.head.strips() + strip;
        let (from, to) = (&scene.from, &scene.to);
        // Motion is a difference of places in f32, as in the stage's input.
        let moved = [to.x[i] - from.x[i], to.y[i] - from.y[i]];
        let ways = [moved[0], moved[1], to.z[i] - from.z[i]].map(f64::from);
        let at = [to.x[i], to.y[i], to.z[i]].map(f64::from);
        (
            [0, 1, 2].map(|k| at[k] - 0.5 * ways[k]),
            moved.map(f64::from),
        )
    };
    let ((a, from), (b, to)) = (point(station - 1), point(station));
    Segment {
        ends: [a, b],
        moved: [from, to],
        is_last: station == STATIONS - 1,
    }
}

/// Cover of the cell with this middle by a segment of a half width, if any; parts above `height` are ignored.
fn cover(s: &Segment, middle: [f64; 2], half: f64, height: f64) -> Option<Candidate> {
    let [z, z_end] = s.ends.map(|end| end[2]);
    if z.min(z_end) >= height {
        return None;
    }
    let crosses = (height - z) / (z_end - z);
    let [begins, above] = [z > height, z_end > height];
    let stops = above || s.is_last;
    let shares = [
        if begins { crosses } else { 0.0 },
        if above { crosses } else { 1.0 },
    ];
    let at = |t: f64, i: usize| s.ends[0][i] + t * (s.ends[1][i] - s.ends[0][i]);
    let went = |t: f64, i: usize| s.moved[0][i] + t * (s.moved[1][i] - s.moved[0][i]);
    let [a, b] = shares.map(|t| [0, 1, 2].map(|i| at(t, i)));
    let d = [0, 1, 2].map(|i| b[i] - a[i]);
    let major = usize::from(d[1].abs() > d[0].abs());
    let minor = 1 - major;
    let length = d[major].abs();
    let (slope, steep) = if length > 1e-4 {
        (d[minor] / d[major], d[2] / length)
    } else {
        (0.0, 0.0)
    };
    let cosine = 1.0 / (1.0 + slope * slope).sqrt();
    // Its motion in the step: across it, and along its major axis.
    let way = [0, 1].map(|i| 0.5 * (went(shares[0], i) + went(shares[1], i)));
    let soft = ((way[minor] - slope * way[major]) * cosine).abs().max(1.0);
    let blurred = (way[major] + slope * way[minor]).abs() * cosine * cosine;
    let blurred = blurred.max(SHARP);
    // A short remainder has an inexact direction.
    let off =
        ROUNDING * (1.0 + steep.abs() + (1.0 + TIP) / length.max(1e-9) + 1.0 / blurred).min(1e4);
    let along = (middle[major] - a[major]) * d[major].signum();
    let end = length + if stops { TIP } else { 0.0 };
    // A continuing segment owns the cells.
    if (!begins && along < -off) || (!stops && along > end + off) {
        return None;
    }
    let there = match (begins, stops) {
        (false, false) => 1.0,
        (true, false) => 0.5 + along / blurred,
        (false, true) => 0.5 + (end - along) / blurred,
        // A piece shorter than its motion is over no cell for the whole of it.
        (true, true) => {
            let least = (along.min(end - along) / blurred + 0.5).min(end / blurred);
            least.min(1.0)
        }
    };
    let line = a[minor] + (middle[major] - a[major]) * slope;
    let aside = (middle[minor] - line).abs() * cosine;
    // A ribbon narrower than its soft edges covers one half plus its width relative to them.
    let most = (half / soft + 0.5).min(1.0);
    let across = ((half + 0.5 * soft - aside) / soft).min(most);
    if across.min(there) < -2.0 * off {
        return None;
    }
    let cover = across * there.clamp(0.0, 1.0);
    let near = |value: f64| value.abs() <= 2.0 * off;
    let owned = (!begins && near(along)) || (!stops && near(along - end));
    let cut = near(z - height) || near(z_end - height);
    let diagonal = near(d[0].abs() - d[1].abs());
    let sure = !(owned || cut || near(cover) || diagonal) && length > 1e-3;
    let t = if length > 1e-4 {
        (along / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let cover = cover.clamp(0.0, 1.0);
    let low = a[2] + t * d[2];
    let place = shares[0] + t * (shares[1] - shares[0]);
    Some(Candidate {
        score: low + (1.0 - cover) * EDGE_PENALTY,
        z: low,
        keeps: 0.0,
        across: ((aside - 0.5 * (soft - 1.0)).max(0.0) / half).min(1.0),
        across_off: off / half,
        cover,
        strip: 0,
        along: place,
        moved: [0, 1].map(|i| went(place, i)),
        off: 2.0 * off,
        sure,
    })
}

/// Sinking of the pressed head into the surface below it, cells.
fn sink(scene: &Scene) -> f64 {
    f64::from(scene.traits.sink) * f64::from(scene.to.press)
}

/// All segments that cover a cell of the surface.
fn candidates(scene: &Scene, at: [usize; 2], most: f64) -> Vec<Candidate> {
    let traits = &scene.traits;
    let loose = f64::from(traits.loose(scene.to.press));
    // A pressed part may lie below the deepest ride by its sinking.
    let low = most + sink(scene) + f64::from(scene.window.ride_below());
    let wide = f64::from(traits.half_width);
    let bend = scene.to.bend.map(f64::from);
    let middle = at.map(|cell| cell as f64 + 0.5);
    let mut found = Vec::new();
    for strip in 0..scene.head.strips() {
        let lift = scene.head.lift();
        let unruly = f64::from(lift[strip]);
        // Each load turns the strips differently.
        let seed = scene.load.seed() as usize;
        let keeps = loose * f64::from(lift[(strip + seed) % lift.len()]);
        let film =
            f64::from(scene.load.thickest_of(strip)) * f64::from(traits.film_cells_per_quantum);
        let height = low + film - keeps;
        let root = scene.head.roots()[strip].map(f64::from);
        let inner = (root[0] * bend[0] + root[1] * bend[1])
            / (bend[0] * bend[0] + bend[1] * bend[1]).sqrt().max(BENT);
        let rank = RANKS * (0.5 + 0.25 * (inner + unruly));
        for station in 1..STATIONS {
            let s = segment(scene, strip, station);
            let along = (station as f64 - 0.5) / (STATIONS - 1) as f64;
            let half = wide * (1.0 - f64::from(traits.taper) * along);
            found.extend(cover(&s, middle, half, height).map(|c| Candidate {
                score: c.score + keeps + rank,
                keeps,
                strip,
                along: (station as f64 - 1.0 + c.along)
                    * (TEXELS_PER_STRIP / (STATIONS - 1)) as f64,
                ..c
            }));
        }
    }
    found
}

/// The contact of a cell from its deepest candidates, with bristles on `ride`.
fn cell(scene: &Scene, ride: &[f32], at: [usize; 2], candidates: &[Candidate]) -> Cell {
    let mut cell = Cell::default();
    let sure = candidates.iter().filter(|c| c.sure);
    let best = sure.map(|c| c.score + c.off).fold(f64::MAX, f64::min);
    cell.none = best == f64::MAX;
    let place = at[1] * scene.window.width() + at[0];
    let wet: f64 = scene
        .window
        .planes()
        .map(|(_, p)| f64::from(p[place]))
        .sum();
    let wet = wet * f64::from(scene.traits.cells_per_quantum);
    let open: f64 = candidates.iter().map(|c| 1.0 - c.cover).product();
    let doubt = |c: &Candidate| if c.sure { c.off } else { c.cover + c.off };
    cell.cover_off = 1e-5 + candidates.iter().map(doubt).sum::<f64>();
    for c in candidates.iter().filter(|c| c.score - c.off <= best) {
        let last = (TEXELS_PER_STRIP - 1) as f64;
        let texels =
            [c.along - 2.0 * c.off, c.along + 2.0 * c.off].map(|k| k.clamp(0.0, last) as usize);
        for along in texels[0]..=texels[1] {
            let texel = c.strip * TEXELS_PER_STRIP + along;
            let film =
                f64::from(scene.load.film(texel)) * f64::from(scene.traits.film_cells_per_quantum);
            // Solved on a plane at 0: it follows the ride down, and rests on it where that is higher.
            let ride = f64::from(ride[place]);
            let rests = (c.z + ride.min(0.0)).max(ride);
            // A strip's edges are higher by its thickness, like those of a parabola.
            let round = 2.0 * f64::from(scene.traits.half_thickness);
            let bottom = rests - sink(scene) + c.keeps + round * c.across * c.across;
            let off = c.off + round * c.across_off * (2.0 * c.across + c.across_off);
            let reach = f64::from(scene.window.base()[place]) + wet - bottom;
            cell.none |= reach + film <= off;
            if reach + film < -off {
                continue;
            }
            let depth = reach.clamp(0.0, wet);
            let contact = Contact {
                cell: place as u32,
                texel: texel as u32,
                cover: (1.0 - open) as f32,
                moved: c.moved.map(|v| v as f32),
                depth: depth as f32,
                fraction: if wet > 0.0 { (depth / wet) as f32 } else { 0.0 },
                gap: (-reach).max(0.0) as f32,
                local: 0,
            };
            cell.contacts.push((contact, [c.off, off]));
        }
    }
    cell
}

/// Tolerances of cover, motion, depth, fraction and gap, from those of place and height.
fn tolerances(([place, height], cover_off): ([f64; 2], f64), want: &Contact) -> [f64; 6] {
    let wet = f64::from(want.depth) / f64::from(want.fraction).max(1e-9);
    let fraction = if want.fraction > 0.0 {
        height / wet.max(height)
    } else {
        1.0
    };
    let fraction = fraction.max(1e-6);
    [cover_off, place, place, height, fraction, height]
}

fn values(c: &Contact) -> [f64; 6] {
    [c.cover, c.moved[0], c.moved[1], c.depth, c.fraction, c.gap].map(f64::from)
}

fn is(got: &Contact, (want, off): &(Contact, [f64; 2]), cover_off: f64) -> bool {
    let pairs = values(got).into_iter().zip(values(want));
    got.texel == want.texel
        && pairs
            .zip(tolerances((*off, cover_off), want))
            .all(|((a, b), tolerance)| (a - b).abs() <= tolerance)
}

/// Possible contacts of every cell of the surface, row by row, with bristles on `ride`.
fn oracle(scene: &Scene, ride: &[f32]) -> Vec<Cell> {
    let [right, top] = CELLS.map(|cells| cells as usize);
    let (low, high) = scene.bounds;
    let inside = |x: usize, y: usize| {
        let at = [x as i64, y as i64];
        (0..2).all(|i| (low[i]..high[i]).contains(&at[i]))
    };
    let cells = (0..top).flat_map(|y| (0..right).map(move |x| [x, y]));
    let top = |[x, y]: [usize; 2]| {
        let place = y * scene.window.width() + x;
        let planes = scene.window.planes();
        let wet: f64 = planes.map(|(_, p)| f64::from(p[place])).sum();
        f64::from(scene.window.base()[place]) + wet * f64::from(scene.traits.cells_per_quantum)
    };
    let grid = cells.clone().filter(|[x, y]| inside(*x, *y));
    let most = grid.map(top).fold(0.0, f64::max);
    cells
        .map(|[x, y]| {
            if inside(x, y) {
                cell(scene, ride, [x, y], &candidates(scene, [x, y], most))
            } else {
                Cell {
                    none: true,
                    ..Cell::default()
                }
            }
        })
        .collect()
}

/// The first cell that differs from its oracle.
fn compare(scene: &Scene, contacts: &[Contact], oracle: &[Cell]) -> Result<(), String> {
    let mut got = vec![None; oracle.len()];
    let across = CELLS[0] as usize;
    for c in contacts {
        let (x, y) = (
            c.cell as usize % scene.window.width(),
            c.cell as usize / scene.window.width(),
        );
        if x >= across || got[y * across + x].replace(*c).is_some() {
            return Err(format!("{c:?} beside the surface, or twice"));
        }
    }
    for (place, (got, want)) in got.iter().zip(oracle).enumerate() {
        let fine = got.map_or(want.none, |got| {
            let mut contacts = want.contacts.iter();
            contacts.any(|contact| is(&got, contact, want.cover_off))
        });
        if !fine {
            return Err(format!(
                "cell {}, {}: {got:?}, not {want:?}",
                place % across,
                place / across
            ));
        }
    }
    Ok(())
}

fn found(scene: &mut Scene) -> Footprint {
    let mut footprint = Footprint::default();
    footprint.find(&mut scene.step());
    footprint
}

#[test]
fn the_deepest_strip_touches_where_it_reaches() {
    let (mut touched, mut doubtful) = (0, 0);
    for seed in 0..32 {
        let mut scene = match seed % 4 {
            0 => Scene::far(seed, 4.0),
            1 => Scene::far(seed, 0.01),
            _ => Scene::new(seed),
        };
        let contacts = found(&mut scene).contacts;
        let oracle = oracle(&scene, scene.window.ride());
        compare(&scene, &contacts, &oracle).unwrap_or_else(|error| panic!("scene {seed}: {error}"));
        touched += contacts.len();
        let doubts = |cell: &&Cell| cell.contacts.len() + usize::from(cell.none) > 1;
        doubtful += oracle.iter().filter(doubts).count();
    }
    println!("{touched} cells touched, {doubtful} in doubt");
    assert!(
        touched > 5000 && doubtful * 50 < touched,
        "{doubtful} of {touched}"
    );
}

#[test]
fn faults_in_a_footprint_are_found() {
    let mut scene = Scene::new(2);
    let contacts = found(&mut scene).contacts;
    let oracle = oracle(&scene, scene.window.ride());
    let across = CELLS[0] as usize;
    let of = |c: &Contact| {
        let (x, y) = (
            c.cell as usize % scene.window.width(),
            c.cell as usize / scene.window.width(),
        );
        &oracle[y * across + x]
    };
    let clear = |c: &Contact| {
        let cell = of(c);
        let alone = cell.contacts.len() == 1 && !cell.none && cell.cover_off < 1e-2;
        alone && c.fraction > 0.01
    };
    let at = contacts.iter().position(clear).expect("a clear contact");
    let (want, off) = of(&contacts[at]).contacts[0];
    let tolerances = tolerances((off, of(&contacts[at]).cover_off), &want)
        .map(|tolerance| 10.0 * tolerance as f32);
    let faults: [fn(&mut Contact, [f32; 6]); 7] = [
        |c, by| c.cover += by[0],
        |c, by| c.moved[0] += by[1],
        |c, by| c.moved[1] -= by[2],
        |c, by| c.depth += by[3],
        |c, by| c.fraction -= by[4],
        |c, by| c.gap += by[5],
        |c, _| c.texel += 1,
    ];
    assert_eq!(compare(&scene, &contacts, &oracle), Ok(()));
    for (number, fault) in faults.iter().enumerate() {
        let mut faulty = contacts.clone();
        fault(&mut faulty[at], tolerances);
        assert!(
            compare(&scene, &faulty, &oracle).is_err(),
            "fault {number} passes"
        );
    }
    let mut missing = contacts.clone();
    missing.remove(at);
    assert!(
        compare(&scene, &missing, &oracle).is_err(),
        "a missing cell passes"
    );
    let touched = |cell: u32| contacts.iter().any(|c| c.cell == cell);
    let bare = (0..across as u32)
        .find(|cell| !touched(*cell))
        .expect("a bare cell");
    let mut added = contacts.clone();
    added.push(Contact {
        cell: bare,
        ..contacts[at]
    });
    assert!(
        compare(&scene, &added, &oracle).is_err(),
        "one cell too many passes"
    );
}

/// Seeded faults that the comparison must detect: flat strips, strips that follow the tooth into each gap, strips on a
/// plane, those of another load.
#[test]
fn other_bristles_and_rides_are_told_apart() {
    let mut scene = Scene::new(2);
    let contacts = found(&mut scene).contacts;
    let ride = scene.window.ride().to_vec();
    let fine =
        |scene: &Scene, ride: &[f32]| compare(scene, &contacts, &oracle(scene, ride)).is_ok();
    assert!(fine(&scene, &ride));
    assert!(!fine(&scene, scene.window.base()), "without a ride");
    assert!(!fine(&scene, &vec![0.0; ride.len()]), "on a plane");
    let thick = std::mem::take(&mut scene.traits.half_thickness);
    assert!(!fine(&scene, &ride), "flat strips");
    scene.traits.half_thickness = thick;
    let sink = std::mem::take(&mut scene.traits.sink);
    assert!(!fine(&scene, &ride), "strips that do not sink in");
    scene.traits.sink = sink;
    let (head, traits) = (&scene.head, &scene.traits);
    scene.load.fill(head, traits, &[], None, (Half::Both, 3));
    assert!(
        !fine(&scene, &ride),
        "bristles that stand out with another load"
    );
}

/// The bounds of a painting's search contain all cells that the head touches, and those beside them to which paint may
/// be pushed.
#[test]
fn the_bounds_hold_all_that_is_touched() {
    let mut touched = 0;
    for seed in 0..40 {
        let mut scene = Scene::far(seed, [1.0, 4.0][seed as usize % 2]);
        for slot in 0..16 {
            scene.window.plane_mut(slot).fill(0.0);
        }
        scene.bounds = ([-200; 2], [300; 2]);
        let contacts = found(&mut scene).contacts;
        let film = scene.load.thickest() as f32 * scene.traits.film_cells_per_quantum;
        // Linen is 80 µm deep.
        let height = film + scene.traits.sink + (80e-6 / CELL_M) as f32;
        let bounds = low_bounds(&scene.head, &scene.to, &scene.traits, height);
        for c in &contacts {
            let width = scene.window.width();
            let at = [c.cell as usize % width, c.cell as usize / width].map(|cell| cell as i64);
            let (from, to) = bounds.expect("something is touched");
            let held = (0..2).all(|i| from[i] < at[i] && at[i] + 1 < to[i]);
            assert!(held, "scene {seed}: {at:?} in {from:?}..{to:?}");
        }
        touched += contacts.len();
    }
    assert!(touched > 1000, "{touched}");
}
