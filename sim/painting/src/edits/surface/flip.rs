//! Flips a surface left to right.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use maulstick_canvas::dry::{DRY_LAYERS_MOST, DryLayer, DryStack};
use maulstick_canvas::own_plane::{OwnPlane, OwnShape};
use maulstick_canvas::page::{Page, Pager};
use maulstick_canvas::planes::{Planes, TILE_CELLS};
use maulstick_canvas::tile::{Tile, TileId};
use maulstick_types::EditFields;
use maulstick_types::paint::{StepName, TILE};
use maulstick_types::scene::CANVAS;
use maulstick_types::values::ValueError;

use crate::edits::{Applied, Form, PaintingEdit, StepForm, read, words};
use crate::error::EditError;
use crate::painting::Painting;

/// Flip the canvas left to right, to see the drawing afresh
///
/// All paint is mirrored, wet and dry; flipped twice it is as before. Tooth and ground stay.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::Args))]
pub struct Flip {
    /// The surface.
    #[serde(default = "read::canvas")]
    #[cfg_attr(feature = "cli", arg(skip = CANVAS))]
    pub surface: u32,
}

impl EditFields for Flip {
    const NAME: &'static str = "flip";
}

impl Form for Flip {
    const STEPS: &'static [StepForm] = &[StepForm::switch("flip", &[], "{ flip = true }")];
    const ARGUMENTS: Option<&'static [&'static str]> = Some(&["canvas", "flip"]);
    #[cfg(feature = "cli")]
    const COMMAND: Option<crate::edits::CommandForm> =
        Some(crate::edits::CommandForm::of::<Self>("flip", "canvas"));

    fn example() -> Result<Self, ValueError> {
        Ok(Self { surface: CANVAS })
    }
}

impl PaintingEdit for Flip {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let Painting { bench, clock } = painting;
        let on = bench.desk.surfaces.at(self.surface)?;
        if !bench.desk.scene.surfaces[on].wells.is_empty() {
            return Err(EditError::Own {
                what: "a palette is not flipped: its wells would not follow",
                help: "flip the canvas",
            });
        }
        bench.close_windows();
        let surfaces = &bench.desk.surfaces;
        let surface = &surfaces[on];
        let mut mirror = Mirror::of(surface.store.cells()[0] as usize, &surfaces.pager);
        let tile = |id: TileId| surface.store.version(id).tile.as_deref();
        let [across, up] = surface.store.grid();
        let mut tiles = Vec::new();
        for y in 0..up {
            for x in 0..across {
                let near = across - 1 - x;
                let sources = [Some(near), near.checked_sub(1)];
                let sources = sources.map(|x| x.and_then(|x| tile(TileId { x, y })));
                let flipped = mirror.tile(sources);
                let id = TileId { x, y };
                if !tile(id).map_or(flipped.is_bare(), |own| own.is(&flipped)) {
                    tiles.push((id, Arc::new(flipped)));
                }
            }
        }
        let mut depths = tiles
            .iter()
            .filter_map(|(_, tile)| Some(tile.dry()?.depth()));
        if depths.any(|depth| depth > DRY_LAYERS_MOST) {
            return Err(EditError::Own {
                what: "a tile of the flipped canvas would have more dry layers than it can hold",
                help: "make layers wet and dry them as one first",
            });
        }
        clock.stop(Some(self.surface));
        let words = "flip".to_owned();
        bench.begin_step(StepName::Words { words }, None);
        bench.put_changed(on, tiles);
        bench.end_own_step();
        Ok(Applied::Done)
    }

    fn log_words(&self) -> String {
        format!("flip the {}", words::surface(self.surface))
    }
}

/// The two tiles of which a mirrored one is made, the right one first: the width of a surface is no multiple of a tile's.
type Sources<T> = [Option<T>; 2];

/// Mirrored pages; those of tiles that are alike are one and the same.
struct Mirror<'a> {
    /// Columns of a mirrored tile that come from the right one of its two sources.
    columns: usize,
    pager: &'a Arc<Pager>,
    known: HashMap<Sources<u64>, Option<Page<Planes>>>,
    /// Mirrored links by the sources' newest links.
    stacks: HashMap<Sources<u64>, Option<Arc<DryStack>>>,
}

impl<'a> Mirror<'a> {
    fn of(width: usize, pager: &'a Arc<Pager>) -> Self {
        Self {
            columns: (width - 1) % TILE + 1,
            pager,
            known: HashMap::new(),
            stacks: HashMap::new(),
        }
    }

    fn tile(&mut self, sources: Sources<&Tile>) -> Tile {
        let dry = self.stack(sources.map(|tile| tile?.dry()));
        // The wet page comes after the links: paint drying from it is a separate layer.
        let wet = self.page(sources.map(|tile| tile?.wet_page()));
        Tile::of_pages(wet, dry)
    }

    /// Links of a layer, in their order of drying in both tiles.
    fn stack(&mut self, sources: Sources<&Arc<DryStack>>) -> Option<Arc<DryStack>> {
        let key = sources.map(|stack| stack.map(|stack| stack.id()));
        if let Some(known) = self.stacks.get(&key) {
            return known.clone();
        }
        let mut layers: BTreeMap<u32, Sources<Vec<&Page<Planes>>>> = BTreeMap::new();
        for (place, stack) in sources.iter().enumerate() {
            for layer in stack.iter().flat_map(|stack| stack.layers()) {
                let links = layers.entry(layer.number).or_default();
                links[place].get_or_insert_default().push(&layer.planes);
            }
        }
        let mut mirrored = None;
        for (number, links) in layers {
            let count = links.iter().flatten().map(Vec::len).max().unwrap_or(0);
            let mut pages: Vec<Page<Planes>> = Vec::new();
            let mut last = 0;
            for place in 0..count {
                // The newest is the first.
                let of = |own: &Option<Vec<&'_ Page<Planes>>>| {
                    let own = own.as_ref()?;
                    own.len().checked_sub(place + 1).map(|at| own[at].clone())
                };
                let sources = [of(&links[0]), of(&links[1])];
                let page = self.page([sources[0].as_ref(), sources[1].as_ref()]);
                if page.is_some() {
                    last = place + 1;
                }
                pages.push(page.unwrap_or_else(|| Page::new(self.pager, Arc::default(), None)));
            }
            for planes in pages.into_iter().take(last) {
                mirrored = Some(DryStack::over(mirrored, DryLayer { number, planes }));
            }
        }
        self.stacks.insert(key, mirrored.clone());
        mirrored
    }

    fn page(&mut self, sources: Sources<&Page<Planes>>) -> Option<Page<Planes>> {
        let key = sources.map(|page| page.map(Page::id));
        if let Some(known) = self.known.get(&key) {
            return known.clone();
        }
        let planes = self.planes(sources.map(|page| page.map(Page::get)));
        let same = sources
            .into_iter()
            .flatten()
            .find(|page| *page.get() == planes);
        let page = match same {
            _ if planes.is_empty() => None,
            Some(page) => Some(page.clone()),
            None => Some(Page::new(self.pager, Arc::new(planes), None)),
        };
        self.known.insert(key, page.clone());
        page
    }

    fn planes(&self, sources: Sources<Arc<Planes>>) -> Planes {
        let mut counts: BTreeMap<usize, Vec<f32>> = BTreeMap::new();
        let mut own: BTreeMap<OwnShape, Vec<u8>> = BTreeMap::new();
        for (place, planes) in sources.iter().enumerate() {
            for (slot, plane) in planes.iter().flat_map(|planes| planes.iter()) {
                let into = counts.entry(*slot).or_insert_with(|| vec![0.0; TILE_CELLS]);
                self.copy(place, plane, into, 1);
            }
            for plane in planes.iter().flat_map(|planes| planes.own()) {
                let into = own.entry(plane.shape);
                let into = into.or_insert_with(|| vec![0; plane.bytes.len()]);
                self.copy(place, &plane.bytes, into, plane.shape.cell_bytes());
            }
        }
        let counts = counts.into_iter();
        let counts = counts.filter(|(_, plane)| plane.iter().any(|count| *count != 0.0));
        let own = own.into_iter().map(|(shape, bytes)| OwnPlane {
            shape,
            bytes: bytes.into(),
        });
        let counts: Planes = counts.map(|(slot, plane)| (slot, plane.into())).collect();
        counts.with_own(own)
    }

    /// Copies the cells of one of the two sources, with a number of values each.
    fn copy<T: Copy>(&self, place: usize, from: &[T], into: &mut [T], values: usize) {
        let (columns, shift) = match place {
            0 => (0..self.columns, 0),
            _ => (self.columns..TILE, TILE),
        };
        for row in 0..TILE {
            for column in columns.clone() {
                let to = (row * TILE + column) * values;
                let at = (row * TILE + self.columns + shift - 1 - column) * values;
                into[to..to + values].copy_from_slice(&from[at..at + values]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use maulstick_optics::PaintLibrary;
    use maulstick_types::Region;
    use maulstick_types::scene::PALETTE;

    use super::*;
    use crate::edits::{Dry, Fill, FillPaint, Scrape};
    use crate::setup::PaintingSetup;

    /// A painting of two dry layers, one of them on a part, and wet paint on the left.
    fn painting(width: u32) -> Painting {
        let setup = PaintingSetup {
            cells: [width, 70],
            ..PaintingSetup::default()
        };
        let mut painting =
            Painting::new(&setup, PaintLibrary::measured().expect("paints")).expect("made");
        let cell_m = painting.scene().surfaces[0].cell_m;
        let left = |share: f64| Region {
            corner_m: [0.0; 2],
            size_m: [share * f64::from(width) * cell_m, 1.0],
        };
        let film = |painting: &mut Painting, paint: &str| {
            let mixture = paint.parse().expect("a paint");
            let fill = Fill {
                paint: FillPaint::Mixture { mixture },
                thickness: Default::default(),
                surface: CANVAS,
            };
            painting.apply(fill).expect("laid");
        };
        film(&mut painting, "Bone Black");
        let dry = Dry {
            region: Some(left(0.3)),
            ..Dry::whole(CANVAS)
        };
        painting.apply(dry).expect("dried");
        painting.apply(Dry::whole(CANVAS)).expect("dried");
        film(&mut painting, "Cobalt Blue=0.5,Titanium White=0.5");
        let scrape = Scrape {
            region: Some(left(0.4)),
            surface: CANVAS,
        };
        painting.apply(scrape).expect("scraped");
        painting
    }

    /// Wet and dry counts of each cell of a row of the canvas, from the left.
    fn row(painting: &Painting) -> Vec<Vec<(u32, usize, f32)>> {
        let store = painting.store(CANVAS).expect("a canvas");
        let cell = |x: u32| {
            let side = TILE as u32;
            let id = TileId { x: x / side, y: 1 };
            let at = (x % side) as usize;
            let tile = store.version(id).tile.clone().unwrap_or_default();
            let wet = tile.wet();
            let mut all: Vec<_> = wet
                .iter()
                .map(|(slot, plane)| (0, *slot, plane[at]))
                .collect();
            for layer in tile.dry().iter().flat_map(|stack| stack.layers()) {
                for (slot, plane) in &*layer.planes.get() {
                    all.push((layer.number, *slot, plane[at]));
                }
            }
            all.retain(|(_, _, count)| *count > 0.0);
            all
        };
        (0..store.cells()[0]).map(cell).collect()
    }

    #[test]
    fn each_cell_goes_to_the_other_side_and_twice_back() {
        for width in [128, 130, 100, 40] {
            let mut painting = painting(width);
            let tiles = |painting: &Painting| -> Vec<_> {
                let store = painting.store(CANVAS).expect("a canvas").iter();
                store
                    .map(|(id, version)| (id, version.tile.clone()))
                    .collect()
            };
            let (before, cells) = (tiles(&painting), row(&painting));
            let mirrored: Vec<_> = cells.iter().rev().cloned().collect();
            assert_ne!(cells, mirrored, "its sides differ");
            painting.apply(Flip { surface: CANVAS }).expect("flipped");
            assert_eq!(row(&painting), mirrored, "{width}");
            assert_eq!(painting.report().quanta_missing, 0);
            painting.undo(None).expect("undone");
            assert_eq!(tiles(&painting), before);
            painting.redo(None).expect("redone");
            assert_eq!(row(&painting), mirrored);
            painting.apply(Flip { surface: CANVAS }).expect("flipped");
            assert_eq!(tiles(&painting), before, "{width}");
            assert_eq!(painting.report().quanta_missing, 0);
        }
    }

    #[test]
    fn planes_of_a_models_own_are_mirrored_and_tiles_that_are_alike_stay_one() {
        let pager = Arc::default();
        let mirror = Mirror::of(130, &pager);
        let shape = OwnShape {
            kind: 1,
            values: maulstick_canvas::own_plane::ValueType::U8,
            per_cell: 2,
        };
        let bytes: Vec<u8> = (0..shape.tile_bytes()).map(|at| at as u8).collect();
        let own = OwnPlane {
            shape,
            bytes: bytes.clone().into(),
        };
        let planes = Arc::new(Planes::new().with_own([own]));
        let mirrored = mirror.planes([Some(Arc::clone(&planes)), Some(planes)]);
        let mirrored = &mirrored.own()[0].bytes;
        // The two columns of the edge come from the right tile, all others from the left one.
        assert_eq!(mirrored[..4], [bytes[2], bytes[3], bytes[0], bytes[1]]);
        assert_eq!(mirrored[4..6], bytes[126..128]);

        let mut painting = painting(6400);
        let before = painting.pager().counts().resident;
        painting.apply(Flip { surface: CANVAS }).expect("flipped");
        let after = painting.pager().counts().resident;
        assert!(after < before + (1 << 20), "{before} B, then {after} B");
    }

    #[test]
    fn a_palette_is_not_flipped() {
        let mut painting = painting(40);
        let refused = painting.apply(Flip { surface: PALETTE });
        assert!(matches!(refused, Err(EditError::Own { .. })));
        assert!(painting.apply(Flip { surface: 7 }).is_err());
    }
}
