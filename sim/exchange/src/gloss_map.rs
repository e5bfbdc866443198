//! The gloss of a painting as a picture: light is glossy.

use std::io::Write;

use maulstick_appearance::Bakery;
use maulstick_optics::light::gloss::ROUGHNESS;
use maulstick_painting::Painting;

use crate::ExchangeError;
use crate::grey_map::write_grey_map;
use crate::surface::{Progress, Steps, banded, check_whole};

/// Writes the gloss of a surface, 0 to 1, as a grey PNG of 16 bits; its `tEXt` gives the formula for GGX's roughness α.
/// `pHYs` has the size of a cell.
///
/// # Errors
/// [`ExchangeError`].
pub fn write_gloss_map(
    painting: &mut Painting,
    surface: u32,
    to: impl Write,
    progress: Progress<'_>,
) -> Result<(), ExchangeError> {
    let banded = banded(painting, surface)?;
    let mut steps = Steps::new(progress, banded.bands());
    let [least, most] = ROUGHNESS;
    let text = format!(
        "65535 is 1; GGX's roughness alpha is {least} + {:.1} (1 - gloss)^2",
        most - least
    );
    let values = |band: usize| {
        let mut gloss = vec![0.0; banded.rows(band).len() * banded.cells()[0]];
        for (id, tile) in banded.tiles(band) {
            let shown = banded.shown(id, tile, &mut Bakery::default());
            banded.spread(id, &shown.gloss, &mut gloss);
        }
        let levels = gloss.iter().map(|gloss| (gloss * 65_535.0 + 0.5) as u16);
        levels.collect()
    };
    write_grey_map(&banded, ("Gloss", text), values, to, &mut steps)?;
    check_whole(painting)?;
    Ok(())
}
