//! Pictures of a painting's surfaces, once all open strokes are on them.

use maulstick_appearance::bands::Banded;
use maulstick_appearance::lamp::lamp_over;
use maulstick_appearance::picture::{Drawing, Export, Picture};

use crate::painting::Painting;

/// A surface in bands; `None` if there is no such surface.
pub fn banded(painting: &mut Painting, surface: u32) -> Option<Banded<'_>> {
    painting.commit();
    let mut surfaces = painting.scene().surfaces.iter();
    let cell_m = surfaces.find(|other| other.id == surface)?.cell_m;
    Some(Banded::new(
        painting.store(surface)?,
        painting.bare(surface)?,
        painting.look(),
        cell_m,
    ))
}

/// A surface under the scene's lamp; `None` if there is no such surface.
pub fn lit_drawing<'a>(
    painting: &'a mut Painting,
    surface: u32,
    export: &'a Export,
) -> Option<Drawing<'a>> {
    let lamp = lamp_over(painting.scene(), surface);
    Some(Drawing::lit(banded(painting, surface)?, lamp, export))
}

/// A surface as if it were flat: its colours alone; `None` if there is no such surface.
pub fn flat_drawing<'a>(
    painting: &'a mut Painting,
    surface: u32,
    export: &'a Export,
) -> Option<Drawing<'a>> {
    let lamp = lamp_over(painting.scene(), surface).colour;
    Some(Drawing::flat(banded(painting, surface)?, lamp, export))
}

/// The picture of a surface under the scene's lamp, a pixel a cell, in sRGB.
pub fn picture(painting: &mut Painting, surface: u32) -> Picture {
    picture_for(painting, surface, &Export::default())
}

/// The sequencer, which alone decides about the entries of the journal and their order.
pub fn picture_for(painting: &mut Painting, surface: u32, export: &Export) -> Picture {
    whole(lit_drawing(painting, surface, export))
}

/// The picture of a surface as if it were flat: its colours alone.
pub fn unlit_picture(painting: &mut Painting, surface: u32) -> Picture {
    whole(flat_drawing(painting, surface, &Export::default()))
}

/// All bands of a drawing; empty without one.
fn whole(drawing: Option<Drawing<'_>>) -> Picture {
    drawing.map_or_else(
        || Picture::srgb(0, 0, Vec::new()),
        |drawing| Picture::of(&drawing),
    )
}
