//! Rows of reading distance whose names begin with a word, case by case: `rows carry 0.125 0`.

use maulstick_looks::marks::Painter;
use maulstick_looks::reading::{ALL, case::CASES};

fn main() -> Result<(), maulstick_rig::UserError> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let number = |i: usize| words.get(i).and_then(|word| word.parse::<f64>().ok());
    if words.first().is_some_and(|word| word == "marks") {
        let trial = maulstick_looks::marks::Trial {
            cell_mm: 0.125,
            painter: Painter::Able,
        };
        for measure in maulstick_looks::marks::ALL {
            for (name, value, unit) in measure(trial)? {
                println!("{name} {value:.3} {unit}");
            }
        }
    }
    for own in ALL {
        if words.first().is_some_and(|word| {
            !own.rows
                .iter()
                .any(|(name, ..)| name.contains(word.as_str()))
        }) {
            continue;
        }
        for case in CASES {
            let is_meant = number(1).is_none_or(|cell| cell == case.cell_mm)
                && number(2).is_none_or(|heading| heading == case.heading_deg)
                && number(3).is_none_or(|size| size == case.size)
                && number(4).is_none_or(|paint| CASES[6 * paint as usize].paints == case.paints);
            if !is_meant || !(own.shows)(&case) {
                continue;
            }
            println!(
                "{} mm, {}°, size {}, {}",
                case.cell_mm, case.heading_deg, case.size, case.paints[0]
            );
            for (name, value) in (own.read)(case, Painter::Able)? {
                let row = own.rows.iter().find(|(own, ..)| *own == name);
                let Some((_, unit, bound)) = row else {
                    continue;
                };
                let says = if bound.keeps(value) { " " } else { "*" };
                println!("{says} {name:28} {value:9.4} {unit:3} {bound:?}");
            }
        }
    }
    Ok(())
}
