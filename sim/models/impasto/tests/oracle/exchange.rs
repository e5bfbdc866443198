//! Stages 4 and 5: Algorithm 3 by path length, both ways, and what lies on top afterwards.

use std::collections::BTreeMap;

use maulstick_brush::BrushFile;
use maulstick_canvas::quantum::{QUANTA_PER_UNIT, SLOTS};
use maulstick_canvas::window::Window;
use maulstick_impasto::stages::exchange::Exchange;
use maulstick_model::brush::load::BrushLoad;
use maulstick_model::brush::traits::BrushTraits;
use maulstick_model::footprint::Footprint;
use maulstick_model::footprint::contact::Contact;
use maulstick_model::interface::{Handling, Transfer};

use crate::scene::{CELL_M, Random, Scene, lying};

/// Exchange rule of a head: the share kept and that of a skin swapped without a gap, along a reference cell.
#[derive(Clone, Copy)]
pub(crate) struct Rule {
    kept: f64,
    blade: bool,
    /// Most that goes over along a reference cell, m.
    most_m: f64,
    swap: f64,
    /// Share of the shear under this press.
    shear: f64,
}

/// Press of the heads, and its share of the shear of bristles: these shear fully from .45 on, and less by the square.
pub(crate) const PRESS: f32 = 0.3;
const LIGHT: f64 = 4.0 / 9.0;

pub(crate) const RULES: [(&str, Rule); 3] = [
    (
        "round",
        Rule {
            kept: 0.9,
            blade: false,
            most_m: 1e-4,
            swap: 1.0,
            shear: LIGHT,
        },
    ),
    (
        "knife",
        Rule {
            kept: 0.4,
            blade: true,
            most_m: 0.025,
            swap: 0.01,
            shear: 1.0,
        },
    ),
    (
        "badger",
        Rule {
            kept: 0.9,
            blade: false,
            most_m: 0.675e-5,
            swap: 0.05,
            shear: 1.0,
        },
    ),
];

/// Baxter 2004, Algorithm 3, by path length (item 19 of the reading guide): units to the canvas. Near equality is
/// measured by the donor's content, not by the text's 833 µm, so films of oil even out by their difference, at most 100
/// µm along a reference cell (6.75 µm of a blender). The part of a film beyond the gap under it fills the gap 16 times as
/// fast, until 3/10 of all is on the brush. A blade takes up all that it reaches, and evens nothing out.
fn algorithm_3([a_b, a_c, lies, gap]: [f64; 4], travel: f64, rule: Rule) -> f64 {
    let stays = |times: f64| maulstick_num::powf(rule.kept, times * travel);
    let free = (a_b - gap).max(0.0);
    let most = if rule.blade {
        free
    } else {
        (0.7 * a_b - 0.3 * lies).clamp(0.0, free)
    };
    let fill = (1.0 - stays(16.0)) * gap.min(most);
    let carried = if rule.blade { 0.0 } else { free };
    let most = rule.most_m / 0.025;
    let difference = carried - a_c;
    let donor = if difference > 0.0 { a_b - fill } else { a_c };
    let amount = ((1.0 - stays(1.0)) * difference.abs()).clamp(0.0, (most * travel).min(donor));
    fill + if difference > 0.0 { amount } else { -amount }
}

/// Expected paint on cells and films, with tolerances in quanta.
#[derive(Default)]
pub(crate) struct Expected {
    /// Quanta that a contact gives to its cell, by slot and contact.
    pub(crate) given: BTreeMap<(usize, usize), [f64; 2]>,
    cells: BTreeMap<(usize, usize), [f64; 2]>,
    films: BTreeMap<(usize, usize), [f64; 2]>,
    uppers: BTreeMap<(usize, usize), [f64; 2]>,
    deposits: usize,
    uptakes: usize,
    swaps: usize,
    overdrawn: usize,
    overfilled: usize,
    /// Contacts that take from the upper sheet alone, from both sheets, and those whose sheet sinks as it is too thick.
    sheets: [usize; 3],
}

impl Expected {
    /// Adds the cases of another scene.
    fn count(&mut self, other: &Self) {
        self.deposits += other.deposits;
        self.uptakes += other.uptakes;
        self.swaps += other.swaps;
        self.overdrawn += other.overdrawn;
        self.overfilled += other.overfilled;
        for (sum, more) in self.sheets.iter_mut().zip(other.sheets) {
            *sum += more;
        }
    }
}

pub(crate) fn film(load: &BrushLoad, texel: usize) -> f64 {
    let films = (0..SLOTS).filter_map(|slot| load.film_of(slot));
    films.map(|film| f64::from(film[texel])).sum()
}

pub(crate) fn on(window: &Window, slot: usize, cell: usize) -> f64 {
    let plane = window.planes().find(|(of, _)| *of == slot);
    plane.map_or(0.0, |(_, plane)| f64::from(plane[cell]))
}

/// What of a paint is in the upper sheet of a cell.
fn above(window: &Window, slot: usize, cell: usize) -> f64 {
    let noted = window
        .upper(slot)
        .map_or(0.0, |upper| f64::from(upper[cell]));
    noted.min(on(window, slot, cell))
}

/// Share of the upper sheet's paint that goes to the brush, of the body's, share of the rest of the sheet that does not
/// sink, and share of that and of what comes which stays on top, after `travel` reference cells of bristles that shear
/// `reach` quanta. Bristles take from as deep as they shear. A sheet is at most 250 µm thick; where they plough through
/// all paint half of it sinks along 20 mm; under 20 µm of quite another mixture 1/e of it is left.
fn parted(
    [top, body]: [f64; 2],
    [comes, goes]: [f64; 2],
    (reach, travel, differs): (f64, f64, f64),
) -> [f64; 4] {
    const QUANTUM_M: f64 = 0.025 / QUANTA_PER_UNIT;
    let reach = reach.max(goes);
    let over = top / reach.max(1.0);
    let off_top = (goes * over.min(1.0)).min(top);
    let halves = travel * 0.25 / 20.0 * (1.0 - over).max(0.0);
    let covered = comes * differs * QUANTUM_M / 20e-6;
    let kept = maulstick_num::powf(0.5, halves) * maulstick_num::exp(-covered);
    let left = (top - off_top) * kept + comes;
    [
        off_top / top.max(1.0),
        (goes - off_top) / body.max(1.0),
        kept,
        (250e-6 / QUANTUM_M / left.max(1.0)).min(1.0),
    ]
}

/// Quanta that a cell demands from its texel, and offers to it.
fn wants(
    c: &Contact,
    window: &Window,
    load: &BrushLoad,
    traits: &BrushTraits,
    handling: &Handling,
    rule: Rule,
) -> [f64; 2] {
    let cell = c.cell as usize;
    let lying: f64 = (0..SLOTS).map(|slot| on(window, slot, cell)).sum();
    let [u, v] = c.moved.map(f64::from);
    let travel = (u * u + v * v).sqrt() * f64::from(traits.cell_per_reference);
    let a_b = film(load, c.texel as usize) * f64::from(traits.film_units_per_quantum);
    let lies = lying / QUANTA_PER_UNIT;
    let a_c = lies * f64::from(c.fraction) * rule.shear;
    // A unit is 25 mm.
    let gap = f64::from(c.gap) * CELL_M / 0.025;
    let mut net = algorithm_3([a_b, a_c, lies, gap], travel, rule);
    // Films that touch across a gap shear a skin of 90 µm, half as much where the gap is 15 µm.
    let skin = (a_b - gap).clamp(0.0, 90e-6 / 0.025).min(lies);
    let mut both =
        (rule.shear * rule.swap * travel * 15e-6 / (15e-6 + 0.025 * gap)).min(1.0) * skin;
    if let Transfer::Marker { flow } = handling.transfer {
        (net, both) = (f64::from(flow) * travel, 0.0);
    }
    let quanta = |units: f64| units * f64::from(c.cover) * QUANTA_PER_UNIT;
    // A limited brush deposits the same again in a hollow of that depth.
    let most = f64::from(handling.most);
    let most = most + most.min(gap * QUANTA_PER_UNIT);
    let room = (QUANTA_PER_UNIT.min(most) - lying).max(0.0);
    let both = quanta(both).min(room);
    [
        (quanta(net.max(0.0)) + both).min(room),
        (quanta((-net).max(0.0)) + both).min(lying),
    ]
}

/// What a texel grants: shares of the demands and the offers, their sums, and the number of cells that share it.
struct Grant {
    drawn: f64,
    offered: f64,
    sharers: f64,
    granted: f64,
    taken_in: f64,
}

/// What a contact's texel grants, where its cells demand and offer these sums.
fn grant(c: &Contact, scene: &Scene, [drawn, offered, sharers]: [f64; 3]) -> Grant {
    let there = film(&scene.load, c.texel as usize);
    let mut granted = if drawn > there { there / drawn } else { 1.0 };
    let room = (scene.traits.film_most - there + drawn * granted).max(0.0);
    let mut taken_in = if offered > room { room / offered } else { 1.0 };
    if scene.handling.transfer == Transfer::Sponge {
        (granted, taken_in) = (1.0, 1.0);
    }
    Grant {
        drawn,
        offered,
        sharers,
        granted,
        taken_in,
    }
}

fn on_texel(c: &Contact, load: &BrushLoad, slot: usize) -> f64 {
    let film = load.film_of(slot);
    film.map_or(0.0, |film| f64::from(film[c.texel as usize]))
}

/// What becomes of a contact's sheets, as [`parted`] has it, and whether there may be two.
fn sheets(c: &Contact, scene: &Scene, sides: [f64; 2], rule: Rule) -> ([f64; 4], bool, f64) {
    let (window, load, cell) = (&scene.window, &scene.load, c.cell as usize);
    let lying: f64 = (0..SLOTS).map(|slot| on(window, slot, cell)).sum();
    let top: f64 = (0..SLOTS).map(|slot| above(window, slot, cell)).sum();
    let is_there = |slot: &usize| on(window, *slot, cell) + on_texel(c, load, *slot) > 0.0;
    let several = (0..SLOTS).filter(is_there).count() > 1;
    let [u, v] = c.moved.map(f64::from);
    let travel = (u * u + v * v).sqrt() * f64::from(scene.traits.cell_per_reference);
    let reach = lying * f64::from(c.fraction) * rule.shear;
    let dot = |of: &dyn Fn(usize) -> [f64; 2]| -> f64 {
        (0..SLOTS)
            .map(|slot| of(slot).iter().product::<f64>())
            .sum()
    };
    let film = |slot: usize| on_texel(c, load, slot);
    let sheet = |slot: usize| above(window, slot, cell);
    let products = dot(&|slot| [film(slot), sheet(slot)]);
    let squares = dot(&|slot| [film(slot); 2]) * dot(&|slot| [sheet(slot); 2]);
    let alike = if squares > 0.0 {
        products / squares.sqrt()
    } else {
        0.0
    };
    let work = (reach, travel, 1.0 - alike);
    (parted([top, lying - top], sides, work), several, top)
}

pub(crate) fn oracle(contacts: &[Contact], scene: &Scene, rule: Rule) -> Expected {
    let (window, load, traits) = (&scene.window, &scene.load, &scene.traits);
    let wants: Vec<[f64; 2]> = contacts
        .iter()
        .map(|c| wants(c, window, load, traits, &scene.handling, rule))
        .collect();
    // Demand and offer of each texel, and the number of their cells.
    let mut demand = BTreeMap::<u32, [f64; 3]>::new();
    for (c, [given, taken]) in contacts.iter().zip(&wants) {
        let sums = demand.entry(c.texel).or_default();
        sums[0] += given;
        sums[1] += taken;
        sums[2] += 1.0;
    }
    let mut expected = Expected::default();
    for (number, (c, [given, taken])) in contacts.iter().zip(&wants).enumerate() {
        let grant = grant(c, scene, demand[&c.texel]);
        let there = film(load, c.texel as usize);
        expected.deposits += usize::from(*given > *taken + 1.0);
        expected.uptakes += usize::from(*taken > *given + 1.0);
        expected.swaps += usize::from(*given > 1.0 && *taken > 1.0);
        expected.overdrawn += usize::from(*given > 1.0 && grant.granted < 1.0 && there > 0.0);
        expected.overfilled +=
            usize::from(*taken > 1.0 && grant.taken_in < 1.0 && grant.taken_in > 0.0);
        expected.exchange((number, c), scene, [*given, *taken], &grant, rule);
    }
    expected
}

impl Expected {
    /// Adds what a contact exchanges with its texel.
    fn exchange(
        &mut self,
        (number, c): (usize, &Contact),
        scene: &Scene,
        [given, taken]: [f64; 2],
        grant: &Grant,
        rule: Rule,
    ) {
        let (window, load) = (&scene.window, &scene.load);
        let (cell, texel) = (c.cell as usize, c.texel as usize);
        let there = film(load, texel);
        let comes = if there > 0.0 {
            given * grant.granted
        } else {
            0.0
        };
        let sides = [comes, taken * grant.taken_in];
        let ([from_top, from_body, kept, fits], several, top) = sheets(c, scene, sides, rule);
        self.sheets[0] += usize::from(top > 100.0 && from_top > 0.0 && from_body < 1e-9);
        self.sheets[1] += usize::from(top > 100.0 && from_top > 0.0 && from_body > 1e-6);
        self.sheets[2] += usize::from(several && top > 100.0 && kept < 0.9);
        for slot in 0..SLOTS {
            let of_film = on_texel(c, load, slot);
            let (of_cell, of_top) = (on(window, slot, cell), above(window, slot, cell));
            let to_canvas = given * grant.granted * of_film / there.max(1.0);
            let to_brush = from_top * of_top + from_body * (of_cell - of_top);
            // The demand and the transfer from each sheet are truncated; a sum of truncated demands lacks up to a
            // quantum for each cell of the texel, and a film's free capacity changes with both. Single precision adds
            // 10⁻⁶.
            let shared = |granted: f64, sum: f64, own: f64| {
                let bound = (granted < 1.0).then(|| 2.0 * grant.sharers / sum * own);
                bound.unwrap_or_default()
            };
            let off = |moved: f64, shared: f64| {
                let bound = (moved > 0.0).then_some(3.0 + shared + 4e-6 * moved);
                bound.unwrap_or_default()
            };
            let of_given = off(to_canvas, shared(grant.granted, grant.drawn, given));
            self.given.insert((slot, number), [to_canvas, of_given]);
            let bound = of_given + off(to_brush, shared(grant.taken_in, grant.offered, taken));
            let put =
                |to: &mut [f64; 2], moved: f64| (to[0], to[1]) = (to[0] + moved, to[1] + bound);
            let onto = to_canvas - to_brush;
            put(
                self.cells.entry((slot, cell)).or_insert([of_cell, 0.0]),
                onto,
            );
            // Single precision tells mixtures that are nearly alike apart by 10⁻⁴.
            let left = (of_top - from_top * of_top) * kept + to_canvas;
            let upper = if several { left * fits } else { 0.0 };
            let upper = [upper, bound + 2.0 + 2e-4 * upper];
            self.uppers.insert((slot, cell), upper);
            let film = self.films.entry((slot, texel));
            let film = film.or_insert([of_film, 0.0]);
            if scene.handling.transfer != Transfer::Sponge {
                put(film, -onto);
            }
        }
    }
}

fn agrees(scene: &Scene, expected: &Expected) -> bool {
    let near = |got: f64, [want, bound]: &[f64; 2]| (got - want).abs() <= *bound;
    let film = |slot: usize, texel: usize| {
        let film = scene.load.film_of(slot);
        film.map_or(0.0, |film| f64::from(film[texel]))
    };
    let mut cells = expected.cells.iter();
    let mut films = expected.films.iter();
    let mut uppers = expected.uppers.iter();
    let upper = |slot: usize, cell: usize| {
        let upper = scene.window.upper(slot);
        upper.map_or(0.0, |upper| f64::from(upper[cell]))
    };
    uppers.all(|((slot, cell), want)| near(upper(*slot, *cell), want))
        && cells.all(|((slot, cell), want)| near(on(&scene.window, *slot, *cell), want))
        && films.all(|((slot, texel), want)| near(film(*slot, *texel), want))
}

/// All cells draw on two texels, over a long path.
fn crowd(contacts: &mut [Contact]) {
    for contact in contacts {
        contact.texel %= 2;
        contact.moved = contact.moved.map(|cells| 8.0 * cells);
    }
}

/// Puts a part of the paint of each cell in the upper sheet; of one cell in eight all, and more than there is.
fn lay_on_top(scene: &mut Scene, seed: u64) {
    let mut random = Random::new(seed + 900);
    let cells = scene.window.width() * scene.window.height();
    for cell in 0..cells {
        let share = random.range(0.0, 1.15);
        for slot in 0..SLOTS {
            if scene.window.has(slot) {
                let [plane, upper] = scene.window.sheets_mut(slot);
                upper[cell] = (plane[cell] * share as f32).floor();
            }
        }
    }
}

/// A scene of the test, whose deposits stay on their cells, its footprint and the rule of its head.
fn prepared(seed: usize) -> (Scene, Footprint, Rule) {
    let mut scene = Scene::new(seed as u64);
    scene.traits.step_cells = 0.0;
    let mut footprint = Footprint::default();
    footprint.find(&mut scene.step());
    scene.handling.transfer = match seed {
        24..28 => Transfer::Sponge,
        28..32 => Transfer::Marker { flow: 0.0004 },
        _ => Transfer::Paint,
    };
    if seed.is_multiple_of(4) {
        scene.handling.most = 60_000.0;
    }
    if seed % 2 == 1 {
        crowd(&mut footprint.contacts);
        scene.traits.film_most *= 0.05;
    }
    let (kind, rule) = RULES[[0, 1, 0, 1, 2][seed / 8]];
    let file = BrushFile::library(kind).expect(kind);
    scene.traits.exchanging = BrushTraits::of(&file, CELL_M, 1.0).exchanging;
    if seed % 5 != 4 {
        lay_on_top(&mut scene, seed as u64);
    }
    scene.to.press = PRESS;
    (scene, footprint, rule)
}

/// Faults of a count, and of a sheet, differ.
fn faults_are_told(scene: &mut Scene, expected: &Expected) {
    let cells = expected.cells.iter();
    let most = cells.max_by(|a, b| a.1[1].total_cmp(&b.1[1]));
    let (&(slot, cell), [_, bound]) = most.expect("contacts");
    let fault = 10.0 * bound.ceil() as f32;
    scene.window.plane_mut(slot)[cell] += fault;
    assert!(!agrees(scene, expected), "a fault passes");
    scene.window.plane_mut(slot)[cell] -= fault;
    let (&(slot, cell), [_, bound]) = expected.uppers.iter().next().expect("contacts");
    let [_, upper] = scene.window.sheets_mut(slot);
    upper[cell] += 10.0 * bound.ceil() as f32;
    assert!(!agrees(scene, expected), "a fault in a sheet passes");
}

#[test]
fn paint_goes_both_ways_as_algorithm_3_says() {
    let mut seen = Expected::default();
    let (mut told, mut by_shares) = (0, 0);
    for seed in 0..40 {
        let (mut scene, footprint, rule) = prepared(seed);
        let before = scene.counts();
        let expected = oracle(&footprint.contacts, &scene, rule);
        let kept = 0.99 * rule.kept;
        let other = oracle(&footprint.contacts, &scene, Rule { kept, ..rule });
        let from_nowhere = Exchange::default().run(&footprint, &mut scene.step());
        let after = scene.counts();
        for slot in 0..SLOTS {
            let came = after[slot] as i64 - before[slot] as i64;
            assert_eq!(came, from_nowhere[slot], "scene {seed}");
        }
        let sponge = scene.handling.transfer == Transfer::Sponge;
        assert_eq!(sponge, from_nowhere != [0; SLOTS], "scene {seed}");
        lying(&scene.window);
        assert!(agrees(&scene, &expected), "scene {seed}");
        let by_share = !matches!(scene.handling.transfer, Transfer::Marker { .. });
        told += usize::from(by_share && !agrees(&scene, &other));
        by_shares += usize::from(by_share);
        for texel in 0..scene.load.texels() {
            let counted = f64::from(scene.load.film(texel));
            assert_eq!(counted, film(&scene.load, texel), "counted afresh");
        }
        seen.count(&expected);
        faults_are_told(&mut scene, &expected);
    }
    let shares = (told, by_shares);
    assert!(
        10 * told > 9 * by_shares,
        "another share passes: {shares:?}"
    );
    let often = [seen.deposits, seen.uptakes, seen.swaps];
    assert!(often.iter().all(|count| *count > 1000), "{often:?}");
    let sheets = seen.sheets;
    assert!(sheets.iter().all(|count| *count > 200), "{sheets:?}");
    let bound = [seen.overdrawn, seen.overfilled];
    assert!(bound.iter().all(|count| *count > 20), "{bound:?}");
}

/// A nearly full cell takes only what fits.
#[test]
fn a_full_cell_takes_nothing() {
    for missing in [0.0, 1.0, 500.0] {
        let mut scene = Scene::new(3);
        let mut footprint = Footprint::default();
        footprint.find(&mut scene.step());
        for contact in &mut footprint.contacts {
            contact.fraction = 0.0;
            let cell = contact.cell as usize;
            let room = QUANTA_PER_UNIT as f32 - scene.window.total(cell) - missing;
            scene.window.plane_mut(9)[cell] += room;
        }
        let before = scene.counts();
        Exchange::default().run(&footprint, &mut scene.step());
        assert_eq!(scene.counts(), before);
        for contact in &footprint.contacts {
            let cell = contact.cell as usize;
            let total: u64 = scene.window.planes().map(|(_, p)| p[cell] as u64).sum();
            assert!(total <= QUANTA_PER_UNIT as u64, "{total}");
        }
    }
}
