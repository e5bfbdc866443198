//! Rows of reading distance whose names contain a word, case by case, in all cases or in those of one side of a cell,
//! mm, and one heading, degrees: `rows carry 0.125 0`.

use std::process::ExitCode;

use maulstick_looks::marks::Painter;
use maulstick_looks::reading::case::{CASES, Case};
use maulstick_looks::reading::{ALL, Readings};
use maulstick_rig::UserError;

/// A number of the command line, if it is given.
fn number(word: Option<&String>) -> Result<Option<f64>, UserError> {
    let read = |word: &String| word.parse::<f64>();
    let number = word.map(read).transpose();
    number.map_err(|_| UserError::usage("rows [NAME [CELL_MM [HEADING_DEG]]]"))
}

/// Prints the rows of one case; those that miss their bound with a star.
fn print(own: &Readings, case: Case) -> Result<(), UserError> {
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
    Ok(())
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("rows: {error}");
            ExitCode::from(2)
        }
    }
}

fn run() -> Result<(), UserError> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let (cell_mm, heading_deg) = (number(words.get(1))?, number(words.get(2))?);
    let part = words.first().map_or("", String::as_str);
    let is_meant = |case: &Case| {
        cell_mm.is_none_or(|cell_mm| cell_mm == case.cell_mm)
            && heading_deg.is_none_or(|heading_deg| heading_deg == case.heading_deg)
    };
    let mut printed = 0;
    for own in ALL {
        if !own.rows.iter().any(|(name, ..)| name.contains(part)) {
            continue;
        }
        for case in CASES
            .iter()
            .filter(|case| is_meant(case) && (own.shows)(case))
        {
            print(own, *case)?;
            printed += 1;
        }
    }
    if printed == 0 {
        return Err(UserError::usage("no row and case are called so"));
    }
    Ok(())
}
