//! Pictures in an OpenRaster file, each of the painting up to one of its layers.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use maulstick_appearance::Bakery;
use maulstick_appearance::bands::Banded;
use maulstick_appearance::picture::{Depth, Drawing};
use maulstick_canvas::dry::DryStack;
use maulstick_canvas::planes::{Planes, TILE_CELLS};
use maulstick_canvas::tile::{Tile, TileId};
use maulstick_types::paint::TILE;
use maulstick_types::scene::Layer;

/// Size of a pixel with and without its opacity, bytes.
const RGBA: usize = 4;
const RGB: usize = 3;

/// Content of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shows {
    Ground,
    /// The newest layer of the painting up to the dry layer of this number.
    Dry(u32),
    Wet,
    Merged,
}

/// A picture of the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Image {
    /// Name of the layer for painters; `None` if it is not a layer.
    pub(super) layer: Option<String>,
    pub(super) file: String,
    pub(super) shows: Shows,
}

impl Image {
    /// Encoding of its pixels.
    pub(super) fn colour(&self) -> png::ColorType {
        match self.shows {
            Shows::Merged => png::ColorType::Rgb,
            _ => png::ColorType::Rgba,
        }
    }
}

/// The layers of a surface from the lowest, and the whole of it; `layers` has the names of the dry ones.
pub(super) fn images(banded: &Banded<'_>, layers: &[Layer]) -> Vec<Image> {
    let (mut dried, mut wet) = (BTreeSet::new(), false);
    for (_, version) in banded.store().iter() {
        let Some(tile) = &version.tile else {
            continue;
        };
        wet |= tile.wet_page().is_some();
        let stack = tile.dry().into_iter().flat_map(|stack| stack.layers());
        dried.extend(stack.map(|layer| layer.number));
    }
    let layer = |name: String, file: String, shows| Image {
        layer: Some(name),
        file: format!("data/{file}.png"),
        shows,
    };
    let name = |number: u32| {
        let found = layers.iter().find(|layer| layer.number == number);
        found.map_or_else(|| Layer::default_name(number), |layer| layer.name.clone())
    };
    let mut images = vec![layer("ground".into(), "ground".into(), Shows::Ground)];
    images.extend(dried.into_iter().map(|number| {
        let file = format!("dry{number}");
        layer(name(number), file, Shows::Dry(number))
    }));
    if wet {
        images.push(layer("wet paint".into(), "wet".into(), Shows::Wet));
    }
    images.push(Image {
        layer: None,
        file: "mergedimage.png".into(),
        shows: Shows::Merged,
    });
    images
}

/// True for cells with any paint.
fn painted(planes: &Planes) -> Vec<bool> {
    let mut any = vec![false; TILE_CELLS];
    for (_, plane) in planes {
        let cells = any.iter_mut().zip(plane.iter());
        cells.for_each(|(any, count)| *any |= *count > 0.0);
    }
    any
}

/// The stacks of a tile by the number of their newest layer.
fn stacks(tile: Option<&Tile>) -> BTreeMap<u32, Arc<DryStack>> {
    let mut stacks = BTreeMap::new();
    let mut next = tile.and_then(Tile::dry);
    while let Some(stack) = next {
        stacks.insert(stack.layer().number, Arc::clone(stack));
        next = stack.below();
    }
    stacks
}

/// The pixels of a band of some of the pictures, each from its top row.
pub(super) fn draw(drawing: &Drawing<'_>, images: &[Image], band: usize) -> Vec<Vec<u8>> {
    let banded = drawing.banded();
    let pixels = banded.rows(band).len() * banded.cells()[0];
    let blank = |image: &Image| vec![0; pixels * image.colour().samples()];
    let mut bands: Vec<Vec<u8>> = images.iter().map(blank).collect();
    // The pictures of the newest layer and of those under it.
    let [mut opaque, mut below] = [(); 2].map(|()| drawing.blank(band, Depth::Eight));
    for (id, tile) in banded.tiles(band) {
        let stacks = stacks(tile);
        // From the ground up, so that each baked layer lies on the one before.
        let mut bakery = Bakery::default();
        for (image, band) in images.iter().zip(&mut bands) {
            let (shown, any) = match image.shows {
                Shows::Ground => (banded.shown(id, None, &mut bakery), None),
                Shows::Dry(number) => {
                    let Some(stack) = stacks.get(&number) else {
                        continue;
                    };
                    let any = painted(&stack.layer().planes.get());
                    let dried = Tile::of_pages(None, Some(Arc::clone(stack)));
                    (banded.shown(id, Some(&dried), &mut bakery), Some(any))
                }
                Shows::Wet => {
                    let Some(page) = tile.and_then(Tile::wet_page) else {
                        continue;
                    };
                    (
                        banded.shown(id, tile, &mut bakery),
                        Some(painted(&page.get())),
                    )
                }
                Shows::Merged => {
                    let shown = banded.shown(id, tile, &mut bakery);
                    drawing.lay((id, &shown), None, Depth::Eight, band);
                    continue;
                }
            };
            std::mem::swap(&mut opaque, &mut below);
            drawing.lay((id, &shown), None, Depth::Eight, &mut opaque);
            cut(banded, id, any.as_deref(), ([&opaque, &below], band));
        }
    }
    bands
}

/// Copies the pixels of a tile where there is any paint, or where paint beside them changes them.
fn cut(
    banded: &Banded<'_>,
    id: TileId,
    any: Option<&[bool]>,
    ([opaque, below], band): ([&[u8]; 2], &mut [u8]),
) {
    let [across, rows] = banded.within(id);
    let (width, left) = (banded.cells()[0], id.x as usize * TILE);
    for y in 0..rows {
        for x in 0..across {
            let pixel = (rows - 1 - y) * width + left + x;
            let [own, other] = [opaque, below].map(|band| &band[pixel * RGB..][..RGB]);
            if any.is_some_and(|any| !any[y * TILE + x]) && own == other {
                continue;
            }
            let to = &mut band[pixel * RGBA..][..RGBA];
            to[..RGB].copy_from_slice(own);
            to[RGB] = u8::MAX;
        }
    }
}
