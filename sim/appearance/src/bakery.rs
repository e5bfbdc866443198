//! Dry layers baked into the reflectances of the ground under the wet paint (Baxter 2004, § 7.8).

use std::collections::BTreeMap;
use std::sync::Arc;

use maulstick_canvas::dry::{DryLayer, DryStack};
use maulstick_canvas::planes::TILE_CELLS;
use maulstick_canvas::sheet::sheets;
use maulstick_canvas::tile::TileId;
use maulstick_optics::backend::FilmBackend;
use maulstick_optics::{FilmPlanes, Under};

use crate::appearance::Appearance;
use crate::show_paint::{Films, ShowPaint};

/// Limit on baked tiles, bytes; one with sixteen wavelengths takes 256 KiB.
const KEPT_BYTES: usize = 128 << 20;

/// Internal reflectances of stacks, computed layer by layer for all of them together, so that all cores have work. If
/// the backend fails, which is a fault of the program, the layer is left out.
fn bake(
    look: &Appearance,
    shown: &dyn ShowPaint,
    tiles: &[Unbaked<'_>],
    backend: &mut dyn FilmBackend,
) -> Vec<Vec<f32>> {
    let (layers, mut baked): (Vec<Vec<&DryLayer>>, Vec<Option<Vec<f32>>>) =
        tiles.iter().map(Unbaked::bottom_up).unzip();
    let films: Vec<Vec<(u32, Films)>> = layers
        .iter()
        .map(|layers| {
            layers
                .iter()
                .flat_map(|layer| films_of(layer, shown))
                .collect()
        })
        .collect();
    let deepest = films.iter().map(Vec::len).max().unwrap_or(0);
    for depth in 0..deepest {
        let at: Vec<(usize, &(u32, Films))> = films
            .iter()
            .enumerate()
            .filter_map(|(tile, films)| Some((tile, films.get(depth)?)))
            .collect();
        let paints: Vec<Vec<(usize, &[f32])>> = at
            .iter()
            .map(|(_, (_, films))| {
                let slots = films.iter();
                slots.map(|(slot, film)| (*slot, film.as_slice())).collect()
            })
            .collect();
        let batch: Vec<FilmPlanes<'_>> = at
            .iter()
            .zip(&paints)
            .map(|((tile, (layer, _)), paints)| FilmPlanes {
                paints,
                opacity: look.opacity(*layer),
                under: match &baked[*tile] {
                    Some(planes) => Under::Planes(planes),
                    None => tiles[*tile].ground,
                },
            })
            .collect();
        let layers = backend.bake(&look.studio, &batch).unwrap_or_else(|_| {
            let nothing = |films: &FilmPlanes<'_>| {
                let nothing = FilmPlanes {
                    paints: &[],
                    ..*films
                };
                look.studio.bake(&nothing, TILE_CELLS)
            };
            batch.iter().map(nothing).collect()
        });
        for ((tile, _), planes) in at.iter().zip(layers) {
            baked[*tile] = Some(planes);
        }
    }
    baked.into_iter().map(Option::unwrap_or_default).collect()
}

/// The films of a layer from the lowest up, each with the layer's number: one, or body and upper sheet.
fn films_of(layer: &DryLayer, shown: &dyn ShowPaint) -> impl Iterator<Item = (u32, Films)> {
    let planes = layer.planes.get();
    let films = match sheets(&planes) {
        Some(sheets) => sheets.into(),
        None => vec![shown.films(&planes)],
    };
    let number = layer.number;
    films.into_iter().map(move |films| (number, films))
}

/// A stack over a ground, to be baked.
struct Unbaked<'a> {
    stack: &'a DryStack,
    ground: Under<'a>,
    /// A lower part of the stack that is already baked.
    known: Option<(&'a DryStack, &'a [f32])>,
}

impl Unbaked<'_> {
    /// Its unbaked layers from the lowest up, and the baked part below.
    fn bottom_up(&self) -> (Vec<&DryLayer>, Option<Vec<f32>>) {
        let mut links = Vec::new();
        let (mut next, mut start) = (Some(self.stack), None);
        while let Some(link) = next {
            if let Some((stack, baked)) = self.known
                && std::ptr::eq(stack, link)
            {
                start = Some(baked.to_vec());
                break;
            }
            links.push(link.layer());
            next = link.below().map(|below| &**below);
        }
        links.reverse();
        (links, start)
    }
}

/// A baked tile: its stack, and the time of its last use.
#[derive(Debug)]
struct Baked {
    stack: Arc<DryStack>,
    planes: Arc<[f32]>,
    used: u64,
}

/// Baked tiles of one appearance, cached until their next use.
#[derive(Debug, Default)]
pub struct Bakery {
    kept: BTreeMap<(u32, TileId), Baked>,
    bytes: usize,
    looks: u64,
    generation: u64,
}

impl Bakery {
    /// True if a tile of a surface need not be baked.
    #[must_use]
    pub fn holds(
        &self,
        look: &Appearance,
        surface: u32,
        id: TileId,
        stack: &Arc<DryStack>,
    ) -> bool {
        let kept = self.kept.get(&(surface, id));
        self.generation == look.generation()
            && kept.is_some_and(|kept| Arc::ptr_eq(&kept.stack, stack))
    }

    /// Internal reflectances of the dried paint on a tile, a plane a wavelength, over `ground`; its films are those of
    /// `shown`. For a stack that only grew since, just the new layers are computed.
    pub fn planes(
        &mut self,
        sight: (&Appearance, &mut dyn FilmBackend),
        shown: &dyn ShowPaint,
        surface: u32,
        id: TileId,
        (stack, ground): (&Arc<DryStack>, Under<'_>),
    ) -> Arc<[f32]> {
        let mut planes = self.planes_of(sight, shown, surface, &[(id, stack, ground)]);
        planes.pop().unwrap_or_default()
    }

    /// [`planes`](Self::planes) of several tiles of a surface, computed together.
    pub fn planes_of(
        &mut self,
        (look, backend): (&Appearance, &mut dyn FilmBackend),
        shown: &dyn ShowPaint,
        surface: u32,
        tiles: &[(TileId, &Arc<DryStack>, Under<'_>)],
    ) -> Vec<Arc<[f32]>> {
        if self.generation != look.generation() {
            self.kept.clear();
            (self.generation, self.bytes) = (look.generation(), 0);
        }
        self.looks += 1;
        let used = self.looks;
        let mut all: Vec<Option<Arc<[f32]>>> = Vec::with_capacity(tiles.len());
        let mut before = Vec::new();
        for (tile, (id, stack, _)) in tiles.iter().enumerate() {
            let place = (surface, *id);
            let kept = self.kept.get_mut(&place);
            all.push(kept.and_then(|kept| {
                kept.used = used;
                Arc::ptr_eq(&kept.stack, stack).then(|| Arc::clone(&kept.planes))
            }));
            if all[tile].is_none() {
                let kept = self.kept.remove(&place);
                self.bytes -= kept.as_ref().map_or(0, |kept| size_of_val(&*kept.planes));
                before.push((tile, kept));
            }
        }
        let unbaked: Vec<Unbaked<'_>> = before
            .iter()
            .map(|(tile, kept)| Unbaked {
                stack: tiles[*tile].1,
                ground: tiles[*tile].2,
                known: kept.as_ref().map(|kept| (&*kept.stack, &*kept.planes)),
            })
            .collect();
        let baked = bake(look, shown, &unbaked, backend);
        for ((tile, _), planes) in before.iter().zip(baked) {
            let planes: Arc<[f32]> = planes.into();
            all[*tile] = Some(Arc::clone(&planes));
            let (id, stack, _) = tiles[*tile];
            self.keep((surface, id), stack, planes);
        }
        all.into_iter().flatten().collect()
    }

    /// Caches a baked tile, in place of those used longest ago.
    fn keep(&mut self, place: (u32, TileId), stack: &Arc<DryStack>, planes: Arc<[f32]>) {
        self.bytes += size_of_val(&*planes);
        while self.bytes > KEPT_BYTES {
            let oldest = self.kept.iter().min_by_key(|(_, kept)| kept.used);
            let Some(place) = oldest.map(|(place, _)| *place) else {
                break;
            };
            let gone = self.kept.remove(&place);
            self.bytes -= gone.map_or(0, |gone| size_of_val(&*gone.planes));
        }
        let (stack, used) = (Arc::clone(stack), self.looks);
        self.kept.insert(
            place,
            Baked {
                stack,
                planes,
                used,
            },
        );
    }
}

#[cfg(test)]
mod tests {
    use maulstick_canvas::planes::Planes;
    use maulstick_optics::backend::CpuFilms;
    use maulstick_optics::{PaintLibrary, Studio};
    use maulstick_types::scene::Layer;

    use super::*;
    use crate::show_paint::Counted;

    fn look() -> Appearance {
        let library = PaintLibrary::measured().expect("whole");
        let mut studio = Studio::daylight();
        studio.add(library.find("Ultramarine Blue").expect("known"));
        studio.add(library.find("Hansa Yellow Opaque").expect("known"));
        Appearance::new(studio)
    }

    fn layer(number: u32, slot: usize, quanta: usize) -> DryLayer {
        let plane: Arc<[f32]> = (0..TILE_CELLS).map(|i| (i % 5 * quanta) as f32).collect();
        DryLayer {
            number,
            planes: maulstick_canvas::page::Page::loose(Planes::from_iter([(slot, plane)])),
        }
    }

    #[test]
    fn a_stack_that_grew_is_baked_as_one_that_is_baked_anew() {
        let look = look();
        let even = vec![0.9; look.studio.wavelengths()];
        let ground = Under::Even(&even);
        let id = TileId { x: 0, y: 0 };
        let first = DryStack::over(None, layer(1, 0, 9000));
        let second = DryStack::over(Some(Arc::clone(&first)), layer(2, 1, 4000));
        let mut grown = Bakery::default();
        grown.planes(
            (&look, &mut CpuFilms::new()),
            &Counted,
            0,
            id,
            (&first, ground),
        );
        assert!(!grown.holds(&look, 0, id, &second));
        let one = grown.planes(
            (&look, &mut CpuFilms::new()),
            &Counted,
            0,
            id,
            (&second, ground),
        );
        let two = Bakery::default().planes(
            (&look, &mut CpuFilms::new()),
            &Counted,
            0,
            id,
            (&second, ground),
        );
        assert!(one == two && grown.holds(&look, 0, id, &second));
        // Back to the older stack, as on undo.
        let back = grown.planes(
            (&look, &mut CpuFilms::new()),
            &Counted,
            0,
            id,
            (&first, ground),
        );
        assert!(
            back == Bakery::default().planes(
                (&look, &mut CpuFilms::new()),
                &Counted,
                0,
                id,
                (&first, ground)
            )
        );
        assert!(back != one);
    }

    #[test]
    fn opacity_scales_the_optical_thickness_and_is_baked_anew() {
        let mut look = look();
        let even = vec![0.9; look.studio.wavelengths()];
        let ground = Under::Even(&even);
        let id = TileId { x: 0, y: 0 };
        let baked = |bakery: &mut Bakery, look: &Appearance, stack: &Arc<DryStack>| {
            let mut films = CpuFilms::new();
            bakery.planes((look, &mut films), &Counted, 0, id, (stack, ground))
        };
        let stack = DryStack::over(None, layer(7, 0, 8000));
        let mut bakery = Bakery::default();
        let full = baked(&mut bakery, &look, &stack);
        let set = |look: &mut Appearance, opacity: f32| {
            look.set_layers(&[Layer {
                number: 7,
                name: String::new(),
                opacity,
            }]);
        };
        set(&mut look, 0.5);
        assert!(!bakery.holds(&look, 0, id, &stack));
        let half = baked(&mut bakery, &look, &stack);
        let thinner = DryStack::over(None, layer(7, 0, 4000));
        set(&mut look, 1.0);
        let same = baked(&mut Bakery::default(), &look, &thinner);
        assert!(
            half.iter()
                .zip(same.iter())
                .all(|(a, b)| (a - b).abs() < 1e-6)
        );
        assert!(
            half.iter()
                .zip(full.iter())
                .any(|(a, b)| (a - b).abs() > 1e-2)
        );
        set(&mut look, 0.0);
        let none = baked(&mut bakery, &look, &stack);
        assert!(
            none.iter().all(|r| (r - 0.9).abs() < 1e-6),
            "the ground shows"
        );
    }
}
