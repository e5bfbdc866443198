//! Levelling under the brush: the flow of a thin layer of a Bingham fluid, face by face.

use maulstick_canvas::window::{Area, Window};
use maulstick_impasto::stages::levelling::{Body, Levelling, Paints, Round};
use maulstick_impasto::stages::velocity::Faces;

use crate::scene::{Random, Scene};

/// Side of a cell, m: twice that is larger than the cells of the coarsest grid.
const CELL_M: f64 = 5.1e-4;

/// Surface tension of linseed oil, N/m, and weight of paint of 1,800 kg/m³, N/m³.
const TENSION: f64 = 0.03;
const WEIGHT: f64 = 1800.0 * 9.81;
/// Greatest explicit share of a scheme of fourth order, which is stable up to 1/32.
const STABLE: f64 = 1.0 / 40.0;
/// The slope at which an edge advances onto bare ground.
const ADVANCES: f64 = 1.0;
/// Greatest share of a donor that goes through one of its four faces.
const MOST: f64 = 0.25;
/// 2⁻²⁴, the rounding of a height.
const EPS: f64 = 1.0 / 16_777_216.0;

/// The least and the greatest pressure gradient of a wave by that of its differences, which bends and falls by this
/// between two cells, m. Its differences tell its length, and so its gradient: by (½θ/sin ½θ)³, of which 1 % may be
/// missing, and 14 % where it is shorter than three cells.
fn gradients_by(bends: f64, drop: f64, rounding: f64) -> [f64; 2] {
    if drop.abs() <= rounding {
        return [0.99, 4.0];
    }
    let exact = |[bent, fallen]: [f64; 2]| {
        let short = (bends + bent * rounding) / (drop + fallen * rounding);
        let sine = 0.5 * short.clamp(0.0, 4.0).sqrt();
        let half = maulstick_num::atan2(sine, (1.0 - sine * sine).sqrt());
        let exact = if sine > 0.0 {
            (half / sine).powi(3)
        } else {
            1.0
        };
        let near = if short < 3.0 {
            [0.99, 1.01]
        } else {
            [0.94, 1.14]
        };
        near.map(|by| by * exact)
    };
    let corners = [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]].map(exact);
    let least = corners.iter().map(|[least, _]| *least);
    let most = corners.iter().map(|[_, most]| *most);
    [least.fold(f64::MAX, f64::min), most.fold(0.0, f64::max)]
}

/// The paint of an area during levelling.
struct Film<'a> {
    window: &'a Window,
    body: Body,
    seconds: f64,
    bare: f64,
    paints: Paints,
    to_cells: f64,
}

impl Film<'_> {
    /// Quanta on a cell; beyond the surface those of its edge.
    fn quanta(&self, [x, y]: [i64; 2]) -> f64 {
        let place = self.place([x, y]);
        let planes = self.window.planes();
        planes.map(|(_, plane)| f64::from(plane[place])).sum()
    }

    fn place(&self, at: [i64; 2]) -> usize {
        let limit = self.window.limit();
        let [x, y] = [0, 1].map(|i| at[i].clamp(0, limit[i] as i64 - 1) as usize);
        y * self.window.width() + x
    }

    /// Height of the surface, m.
    fn surface(&self, at: [i64; 2]) -> f64 {
        let base = f64::from(self.window.base()[self.place(at)]);
        CELL_M * (base + self.to_cells * self.quanta(at))
    }

    /// Curvature, 1/m.
    fn curvature(&self, [x, y]: [i64; 2]) -> f64 {
        let beside = [[x - 1, y], [x + 1, y], [x, y - 1], [x, y + 1]];
        let sum: f64 = beside.map(|at| self.surface(at)).iter().sum();
        (sum - 4.0 * self.surface([x, y])) / (CELL_M * CELL_M)
    }

    /// Share of thinner.
    fn thin(&self, at: [i64; 2]) -> f64 {
        let plane = self.paints.thinner.and_then(|slot| self.window.plane(slot));
        let thin = plane.map_or(0.0, |plane| f64::from(plane[self.place(at)]));
        if thin > 0.0 {
            thin / self.quanta(at)
        } else {
            0.0
        }
    }

    /// Yield stress by that of the body: of the paints by volume, and of that what thinner leaves: a share of one half
    /// takes all away.
    fn left(&self, at: [i64; 2]) -> f64 {
        let place = self.place(at);
        let (mut all, mut sum) = (0.0, 0.0);
        for (slot, plane) in self.window.planes() {
            if Some(slot) != self.paints.thinner {
                all += f64::from(plane[place]);
                sum += f64::from(plane[place]) * f64::from(self.paints.yields[slot]);
            }
        }
        sum / all.max(1.0) * (1.0 - 2.0 * self.thin(at)).max(0.0).powi(3)
    }

    /// The least and the greatest share of the donor's paint from `at` to `next`, given the gradient's rounding.
    fn share(&self, at: [i64; 2], next: [i64; 2]) -> [f64; 2] {
        let (s, s_next) = (self.surface(at), self.surface(next));
        let curved = (self.curvature(next) - self.curvature(at)) / CELL_M;
        let gradient = WEIGHT * (s - s_next) / CELL_M + TENSION * curved;
        // Greatest height on the surface: eight cells.
        let rounding = 8.0 * CELL_M * EPS;
        let off = 24.0 * rounding * (TENSION / CELL_M.powi(3) + WEIGHT / CELL_M);
        let off = off + 8.0 * EPS * gradient.abs();
        let by = gradients_by(curved * CELL_M.powi(3), s - s_next, 24.0 * rounding);
        let mean = |of: &dyn Fn([i64; 2]) -> f64| 0.5 * (of(at) + of(next));
        let height = mean(&|at| self.to_cells * self.quanta(at) * CELL_M);
        // Bare cells have no body. Thinner alone is e⁷ times as fluid.
        let wet: Vec<[i64; 2]> = [at, next]
            .into_iter()
            .filter(|at| self.quanta(*at) > 0.0)
            .collect();
        let of_paint = |of: &dyn Fn([i64; 2]) -> f64| {
            wet.iter().map(|at| of(*at)).sum::<f64>() / wet.len().max(1) as f64
        };
        let left = of_paint(&|at| self.left(at));
        let (yields, advances) = (self.body.yield_pa.max(1e-9) * left, ADVANCES * left);
        let fluid = of_paint(&|at| maulstick_num::exp(7.0 * self.thin(at))).max(1e-9);
        let viscosity = self.body.viscosity_pa_s.max(1e-9) / fluid;
        let goes = |gradient: f64, by: f64| {
            let sheared = (height - yields / (by * gradient.abs()).max(1e-300)).max(0.0);
            let mobility = sheared * sheared * (3.0 * height - sheared) / (6.0 * viscosity);
            // As a share of a cell's height, in the time of the round.
            let mobility = by * mobility * self.seconds / (CELL_M * CELL_M);
            let most = STABLE * CELL_M * CELL_M / TENSION;
            let volume = mobility.min(most) * gradient;
            let (donor, onto) = if volume > 0.0 { (at, next) } else { (next, at) };
            let held = self.quanta(donor);
            let bare = self.quanta(onto) <= self.bare;
            let steep = (s - s_next).abs() / CELL_M >= advances;
            if held <= self.bare || bare && !steep {
                return 0.0;
            }
            (volume / (self.to_cells * held)).clamp(-MOST, MOST)
        };
        let gradients = [gradient - off, gradient, gradient + off];
        let all = gradients.map(|gradient| by.map(|by| goes(gradient, by)));
        let mut shares = all.concat();
        // A slope near the bound within rounding may count as either.
        if ((s - s_next).abs() / CELL_M - advances).abs() < 1e-5 {
            shares.push(0.0);
        }
        shares.sort_by(f64::total_cmp);
        let off = |share: f64| 1e-5 * share.abs() + 1e-7;
        let most = shares[shares.len() - 1];
        [shares[0] - off(shares[0]), most + off(most)]
    }

    /// Flow through the right and upper faces of an area's cells; none through its border.
    fn oracle(&self, area: &Area) -> [Vec<[f64; 2]>; 2] {
        let [columns, rows] = area.size;
        [0, 1].map(|axis| {
            let cells = (0..rows).flat_map(|y| (0..columns).map(move |x| [x, y]));
            let face = |[x, y]: [usize; 2]| {
                let border = [x + 1 == columns, y + 1 == rows][axis];
                let at = [x + area.from[0], y + area.from[1]].map(|cell| cell as i64);
                let next = [at[0] + [1, 0][axis], at[1] + [0, 1][axis]];
                if border {
                    [0.0; 2]
                } else {
                    self.share(at, next)
                }
            };
            cells.map(face).collect()
        })
    }
}

fn agrees(faces: &Faces, want: &[Vec<[f64; 2]>; 2]) -> bool {
    let near = |got: &[f32], want: &[[f64; 2]]| {
        let mut pairs = got.iter().zip(want);
        got.len() == want.len()
            && pairs.all(|(got, [low, high])| (*low..=*high).contains(&f64::from(*got)))
    };
    near(&faces.right, &want[0]) && near(&faces.above, &want[1])
}

/// The flow of which the oracle is surest, of those through a face that are not small.
fn best_known<'a>(faces: &'a mut Faces, want: &[Vec<[f64; 2]>; 2]) -> &'a mut f32 {
    let flows = faces.right.iter_mut().chain(&mut faces.above);
    let known = flows.zip(want.iter().flatten());
    let off = |v: f32, [low, high]: &[f64; 2]| (high - low) / f64::from(v.abs());
    let large = known.filter(|(v, _)| v.abs() > 1e-4);
    let surest = large.min_by(|(v, a), (w, b)| off(**v, a).total_cmp(&off(**w, b)));
    surest.expect("a flow").0
}

/// Result of levelling on an area alone.
fn levelled(film: &Film<'_>, area: &Area) -> (Faces, f32) {
    let to_cells = film.to_cells as f32;
    let round = Round::new(film.body, CELL_M, film.seconds, to_cells, film.bare as f32);
    let mut faces = Faces::still(area);
    let planes = [&mut faces.right[..], &mut faces.above[..]];
    let most = Levelling::default().add(film.window, area, &round, &film.paints, (1, 0.0), planes);
    (faces, most)
}

/// Paints of a scene: in each second four scenes one is thinner, in each third the others differ in body, where the scene yields.
fn paints(seed: u64) -> Paints {
    let mut paints = Paints::from([None, Some(2)][seed as usize / 4 % 2]);
    if seed % 3 == 1 {
        paints.yields[0] = 1.2;
        paints.yields[1] = 0.8;
    }
    paints
}

/// An area anywhere on the surface, now and then all of it or a row.
fn area(random: &mut Random, limit: [usize; 2]) -> Area {
    let from = limit.map(|cells| random.below(cells - 1));
    let size = [0, 1].map(|i| 1 + random.below(limit[i] - from[i]));
    match random.below(4) {
        0 => Area {
            from: [0; 2],
            size: limit,
        },
        1 => Area {
            from,
            size: [size[0], 1],
        },
        _ => Area { from, size },
    }
}

#[test]
fn paint_levels_as_a_bingham_fluid() {
    let (mut seen, mut told) = ([0; 4], [0; 2]);
    for seed in 0..24 {
        let mut random = Random::new(seed);
        let scene = Scene::new(seed);
        let film = Film {
            window: &scene.window,
            body: [
                Body {
                    yield_pa: 50.0,
                    viscosity_pa_s: 20.0,
                },
                Body {
                    yield_pa: 0.0,
                    viscosity_pa_s: 20.0,
                },
                Body {
                    yield_pa: 300.0,
                    viscosity_pa_s: 2.0,
                },
            ][seed as usize % 3],
            seconds: [2e-3, 0.06][seed as usize / 3 % 2],
            bare: [0.0, 2013.0][seed as usize / 2 % 2],
            paints: paints(seed),
            to_cells: f64::from(scene.traits.cells_per_quantum),
        };
        let area = area(&mut random, scene.window.limit());
        let (mut faces, most) = levelled(&film, &area);
        let want = film.oracle(&area);
        assert!(agrees(&faces, &want), "scene {seed}");
        let all = || faces.right.iter().chain(&faces.above);
        let largest = all().fold(0.0f32, |most, v| v.abs().max(most));
        assert!((largest - most).abs() <= 1e-6 * most, "scene {seed}");
        for v in all() {
            let kinds = [*v == 0.0, *v > 0.0, *v < 0.0, v.abs() > 0.02];
            seen = std::array::from_fn(|i| seen[i] + usize::from(kinds[i]));
        }
        if most < 1e-3 {
            continue;
        }
        // Where the yield stress decides least of it, a flow a fiftieth larger differs.
        *best_known(&mut faces, &want) *= 1.02;
        told[usize::from(agrees(&faces, &want))] += 1;
    }
    assert!(seen.iter().all(|seen| *seen > 100), "{seen:?}");
    let [found, passes] = told;
    assert!(
        found > 4 * passes,
        "a fault passes: {found} found, {passes} not"
    );
}

/// Seeded faults in the parameters of the flow.
#[test]
fn other_paint_is_told_apart() {
    let scene = Scene::new(1);
    let limit = scene.window.limit();
    let all = Area {
        from: [0; 2],
        size: limit,
    };
    let film = |change: fn(&mut Film<'_>)| {
        let mut film = Film {
            window: &scene.window,
            body: Body {
                yield_pa: 80.0,
                viscosity_pa_s: 20.0,
            },
            seconds: 2e-3,
            bare: 2013.0,
            paints: paints(4),
            to_cells: f64::from(scene.traits.cells_per_quantum),
        };
        change(&mut film);
        levelled(&film, &all).0
    };
    let own = |_: &mut Film<'_>| {};
    let want = Film {
        window: &scene.window,
        body: Body {
            yield_pa: 80.0,
            viscosity_pa_s: 20.0,
        },
        seconds: 2e-3,
        bare: 2013.0,
        paints: paints(4),
        to_cells: f64::from(scene.traits.cells_per_quantum),
    }
    .oracle(&all);
    assert!(agrees(&film(own), &want));
    let faults: [fn(&mut Film<'_>); 6] = [
        |film| film.body.yield_pa *= 1.02,
        |film| film.body.viscosity_pa_s *= 1.02,
        |film| film.seconds *= 0.98,
        |film| film.bare = 50_000.0,
        |film| film.paints.thinner = None,
        |film| film.paints.yields[0] *= 1.1,
    ];
    for (number, fault) in faults.iter().enumerate() {
        assert!(!agrees(&film(*fault), &want), "fault {number} passes");
    }
}
