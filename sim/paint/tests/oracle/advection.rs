//! Stage 3: the displaced column shared out among four cells, the stain left behind.

use maulstick_paint::impasto::advection::{Advection, STAIN};
use maulstick_paint::impasto::footprint::{Contact, Footprint};
use maulstick_paint::quantum::CELL_MAX;
use maulstick_paint::relief::Relief;
use maulstick_paint::window::Window;

use crate::scene::{CELL_M, Random, Scene, lying, planes, spill, window};

/// A plane as it should be, and how many quanta it may be off: each of a cell's contributions is
/// truncated, and is a product of five factors rounded to 2⁻²⁴.
struct Expected {
    slot: usize,
    quanta: Vec<f64>,
    bound: Vec<f64>,
}

fn oracle(contacts: &[Contact], window: &Window) -> Vec<Expected> {
    let width = window.width();
    let limit = window.limit();
    let mut expected: Vec<Expected> = Vec::new();
    for (slot, plane) in window.planes() {
        let mut quanta: Vec<f64> = plane.iter().map(|count| f64::from(*count)).collect();
        let mut bound = vec![0.0; quanta.len()];
        for contact in contacts {
            let cell = contact.cell as usize;
            let total: f64 = window.planes().map(|(_, p)| f64::from(p[cell])).sum();
            let loose = (total - f64::from(STAIN)).max(0.0) / total.max(1.0);
            let at = [cell % width, cell / width];
            let mut to = at;
            let mut part = [0.0; 2];
            for i in 0..2 {
                let v = f64::from(contact.velocity[i]);
                let next = at[i] as i64 + if v < 0.0 { -1 } else { 1 };
                if (0..limit[i] as i64).contains(&next) {
                    (to[i], part[i]) = (next as usize, v.abs());
                }
            }
            let [u, v] = part;
            let shares = [
                ([to[0], at[1]], u * (1.0 - v)),
                ([at[0], to[1]], v * (1.0 - u)),
                (to, u * v),
            ];
            for (to, share) in shares {
                let sent = f64::from(plane[cell]) * loose * share;
                let error = if sent > 0.0 {
                    1.0 + sent * 5.0 / 16_777_216.0
                } else {
                    0.0
                };
                for (place, sent) in [(cell, -sent), (to[1] * width + to[0], sent)] {
                    quanta[place] += sent;
                    bound[place] += error;
                }
            }
        }
        expected.push(Expected {
            slot,
            quanta,
            bound,
        });
    }
    expected
}

fn agrees(got: &[(usize, Vec<f32>)], expected: &[Expected]) -> bool {
    got.len() == expected.len()
        && got.iter().zip(expected).all(|((slot, plane), want)| {
            let cells = plane.iter().zip(want.quanta.iter().zip(&want.bound));
            *slot == want.slot
                && cells
                    .into_iter()
                    .all(|(got, (want, bound))| (f64::from(*got) - want).abs() <= *bound)
        })
}

/// Contacts on a share of the cells, with velocities up to one cell, also just one and none.
fn contacts(window: &Window, random: &mut Random, share: f64) -> Vec<Contact> {
    let mut contacts = Vec::new();
    for y in 0..window.limit()[1] {
        for x in 0..window.limit()[0] {
            if random.unit() >= share {
                continue;
            }
            let component = |random: &mut Random| match random.below(6) {
                0 => -1.0,
                1 => 1.0,
                2 => 0.0,
                _ => random.range(-1.0, 1.0) as f32,
            };
            contacts.push(Contact {
                cell: (y * window.width() + x) as u32,
                cover: 1.0,
                velocity: [component(random), component(random)],
                ..Contact::default()
            });
        }
    }
    contacts
}

fn run(contacts: &[Contact], window: &mut Window) {
    let mut footprint = Footprint::default();
    footprint.contacts = contacts.to_vec();
    Advection::default().run(&footprint, window);
}

#[test]
fn paint_goes_where_its_shares_say() {
    for seed in 0..24 {
        let mut random = Random::new(seed);
        let mut window = Scene::new(seed).window;
        let contacts = contacts(&window, &mut random, 0.5);
        let (before, expected) = (lying(&window), oracle(&contacts, &window));
        run(&contacts, &mut window);
        assert_eq!(lying(&window), before, "scene {seed}");
        let mut got = planes(&window);
        assert!(agrees(&got, &expected), "scene {seed}");
        let moved = &expected[0].bound;
        let cell = (0..moved.len()).max_by(|a, b| moved[*a].total_cmp(&moved[*b]));
        let cell = cell.expect("cells");
        got[0].1[cell] += 10.0 * moved[cell].ceil() as f32;
        assert!(!agrees(&got, &expected), "a fault in scene {seed} passes");
    }
}

#[test]
fn at_the_edge_of_the_surface_paint_stays() {
    let mut window = window(&Relief::flat(CELL_M));
    let (width, [right, top]) = (window.width(), window.limit());
    let corner = (top - 1) * width + right - 1;
    window.plane_mut(0)[corner] = 1e5;
    let contact = Contact {
        cell: corner as u32,
        velocity: [0.7, 1.0],
        ..Contact::default()
    };
    run(&[contact], &mut window);
    assert_eq!(window.total(corner), 1e5);
    let contact = Contact {
        velocity: [-1.0, 1.0],
        ..contact
    };
    run(&[contact], &mut window);
    assert_eq!(window.total(corner), STAIN);
    assert_eq!(window.total(corner - 1), 1e5 - STAIN);
}

/// Full cells among others: what was there is there, and no cell holds more than it can.
#[test]
fn no_cell_takes_more_than_it_can_hold() {
    let full = CELL_MAX as f32;
    for seed in 0..40 {
        let mut random = Random::new(seed);
        let mut window = window(&Relief::flat(CELL_M));
        // From thin paint around full cells to hardly any room anywhere.
        let around = [0.0, 0.02, 0.09, 0.3, 0.9][seed as usize % 5];
        spill(&mut window, &mut random, around * full);
        let [right, top] = window.limit();
        for _ in 0..600 {
            let cell = random.below(top) * window.width() + random.below(right);
            let missing = [0.0, 1.0, 63.0, 1000.0, 2e5][random.below(5)];
            let room = full - window.total(cell) - missing;
            window.plane_mut(2 * random.below(4))[cell] += room.max(0.0);
        }
        let touched = contacts(&window, &mut random, 0.8);
        // In some scenes no full cell is touched itself, in some a half of them.
        let share = [0.0, 0.5][seed as usize % 2];
        let touched: Vec<Contact> = touched
            .into_iter()
            .filter(|c| window.total(c.cell as usize) < 0.5 * full || random.unit() < share)
            .collect();
        let before = lying(&window);
        for _ in 0..3 {
            run(&touched, &mut window);
            for cell in 0..window.width() * window.height() {
                let total: u64 = window.planes().map(|(_, p)| p[cell] as u64).sum();
                assert!(total <= u64::from(CELL_MAX), "scene {seed}: {total} quanta");
            }
            assert_eq!(lying(&window), before, "scene {seed}");
        }
    }
}

/// What the test above would miss if counts beyond the most were not looked at.
#[test]
fn a_quantum_on_a_full_cell_is_lost() {
    assert_eq!(CELL_MAX as f32 + 1.0, CELL_MAX as f32);
}
