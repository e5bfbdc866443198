//! Pictures of viscous paint: `cargo run --release -p maulstick-stokes --example pictures -- FOLDER [NAME…]`.
//!
//! Flows with known answers (`cavity`, `channel`, `squeeze`, `level`) and paint at work (`ridge`, `knife`); without a name,
//! all of them.

mod cavity;
mod channel;
mod image;
mod knife;
mod level;
mod plot;
mod ridge;
mod slice;
mod squeeze;

use std::error::Error;
use std::path::Path;

type Drawn = Result<(), Box<dyn Error>>;
/// Draws pictures into a folder.
type Draw = fn(&Path) -> Drawn;

/// Quanta that fill a cell.
const CAPACITY: u32 = 167_772;

fn main() -> Drawn {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().ok_or("which folder?")?;
    let names: Vec<String> = arguments.collect();
    let pictures: [(&str, Draw); 6] = [
        ("cavity", cavity::draw),
        ("channel", channel::draw),
        ("squeeze", squeeze::draw),
        ("level", level::draw),
        ("ridge", ridge::draw),
        ("knife", knife::draw),
    ];
    if let Some(name) = (names.iter()).find(|name| !pictures.iter().any(|(known, _)| known == name))
    {
        return Err(format!("no picture is named {name}").into());
    }
    for (name, draw) in pictures {
        if names.is_empty() || names.iter().any(|wanted| wanted == name) {
            draw(Path::new(&folder))?;
        }
    }
    Ok(())
}
