//! Surfaces: their tiles, the models of their paint, the grounds under them.

mod counts_at;
pub(crate) mod film;
mod part;
mod varnish;
mod well_moves;

pub(crate) use part::Changed;
pub(crate) use well_moves::WellMoves;

use std::collections::{BTreeMap, HashSet};
use std::ops::{Deref, DerefMut};
use std::sync::Arc;

use maulstick_appearance::shown_surface::ShownSurface;
use maulstick_canvas::page::Pager;
use maulstick_canvas::quantum::QUANTUM_M;
use maulstick_canvas::store::{TileRect, TileStore};
use maulstick_canvas::tile::{Tile, Version};
use maulstick_canvas::window::Window;
use maulstick_types::scene::Scene;

use maulstick_models::{ModelEntry, model_called};

use super::optics::Optics;
use crate::error::{EditError, SurfaceError};
use crate::history::{TilePlace, TileRef};

/// A surface: its tiles, the model of their paint, and the ground under them.
#[derive(Clone, Debug)]
pub(crate) struct SurfaceState {
    pub(crate) id: u32,
    pub(crate) cell_m: f64,
    pub(crate) model: &'static ModelEntry,
    pub(crate) store: TileStore,
    pub(crate) bare: Arc<ShownSurface>,
    /// Most quanta that a cell ever had: how high strips may touch.
    pub(crate) top: f32,
}

impl SurfaceState {
    /// Height of its wet paint, and depth of its tooth, cells.
    pub(crate) fn heights(&self) -> [f32; 2] {
        let wet = self.top * (QUANTUM_M / self.cell_m) as f32;
        [wet, (self.bare.relief.depth_m() / self.cell_m) as f32]
    }

    /// A window on its tiles; `None` while another one holds some of them.
    pub(crate) fn open_window(&mut self, rect: TileRect) -> Option<Window> {
        Window::open(&mut self.store, rect, &self.bare.relief)
    }

    /// Its painted tiles.
    pub(crate) fn tiles(&self) -> impl Iterator<Item = &Arc<Tile>> {
        let versions = self.store.iter();
        versions.filter_map(|(_, version)| version.tile.as_ref())
    }
}

/// The surfaces of a painting, in the order of its scene, the canvas first.
#[derive(Clone, Debug)]
pub(crate) struct Surfaces {
    states: Vec<SurfaceState>,
    pub(crate) pager: Arc<Pager>,
    /// Number of the newest tile version.
    pub(crate) newest_version: u64,
}

impl Surfaces {
    /// The surfaces of a scene, blank.
    pub(crate) fn new(
        scene: &Scene,
        optics: &Optics,
        pager: Arc<Pager>,
    ) -> Result<Self, EditError> {
        let states = scene.surfaces.iter().map(|surface| {
            Ok(SurfaceState {
                id: surface.id,
                cell_m: surface.cell_m,
                model: model_called(&surface.model)?,
                store: TileStore::paged(surface.cells, &pager),
                bare: Arc::new(optics.blank(surface, None)?),
                top: 0.0,
            })
        });
        Ok(Self {
            states: states.collect::<Result<_, EditError>>()?,
            pager,
            newest_version: 1,
        })
    }

    /// Side of a cell of the canvas, m.
    pub(crate) fn cell_m(&self) -> f64 {
        self.states[0].cell_m
    }

    /// Index of a surface.
    pub(crate) fn at(&self, id: u32) -> Result<usize, SurfaceError> {
        let found = self.states.iter().position(|surface| surface.id == id);
        found.ok_or(SurfaceError::Unknown(id))
    }

    /// A surface by its number.
    pub(crate) fn find(&self, id: u32) -> Option<&SurfaceState> {
        self.states.iter().find(|surface| surface.id == id)
    }

    /// A surface by its number.
    pub(crate) fn find_mut(&mut self, id: u32) -> Option<&mut SurfaceState> {
        self.states.iter_mut().find(|surface| surface.id == id)
    }

    /// Current content of a tile.
    pub(crate) fn tile(&self, (surface, id): TilePlace) -> TileRef {
        self.find(surface)?.store.version(id).tile.clone()
    }

    /// Replaces a tile, and returns the old one.
    pub(crate) fn put(&mut self, (surface, id): TilePlace, tile: TileRef) -> TileRef {
        self.newest_version += 1;
        let number = self.newest_version;
        let found = self.find_mut(surface)?;
        found.store.replace(id, Version { number, tile }).tile
    }

    /// Writes the windows of a surface back to its tiles; `replaced` receives the old tiles.
    pub(crate) fn commit(
        &mut self,
        on: usize,
        window: &mut Window,
        mut replaced: impl FnMut(TilePlace, TileRef),
    ) {
        let surface = &mut self.states[on];
        let id = surface.id;
        window.commit(
            &mut surface.store,
            &mut self.newest_version,
            |tile, version| {
                replaced((id, tile), version.tile);
            },
        );
    }

    /// Names of their models, by their numbers.
    pub(crate) fn model_names(&self) -> BTreeMap<u32, &'static str> {
        self.iter().map(|own| (own.id, own.model.name)).collect()
    }

    /// Most quanta that a cell of each surface ever had.
    pub(crate) fn tops(&self) -> BTreeMap<u32, f32> {
        self.iter().map(|own| (own.id, own.top)).collect()
    }

    /// Tiles that changed since a version, and the number of all that were ever painted on.
    pub(crate) fn changed_since(&self, version: u64) -> (Vec<(TilePlace, Version)>, u64) {
        let (mut changed, mut all) = (Vec::new(), 0);
        for surface in self.iter() {
            for (id, own) in surface.store.iter() {
                all += u64::from(own.number > 0);
                if own.number > version {
                    changed.push(((surface.id, id), own.clone()));
                }
            }
        }
        (changed, all)
    }

    /// All tiles where something was painted.
    pub(crate) fn painted(&self) -> BTreeMap<TilePlace, TileRef> {
        let tiles = self.iter().flat_map(|surface| {
            let versions = surface.store.iter();
            versions.map(|(id, version)| ((surface.id, id), &version.tile))
        });
        let bare = |tile: &TileRef| tile.as_deref().is_none_or(Tile::is_bare);
        let painted = tiles.filter(|(_, tile)| !bare(tile));
        painted.map(|(place, tile)| (place, tile.clone())).collect()
    }

    /// Bytes of the pages of the tiles that are shown, and of `others`.
    pub(crate) fn held_bytes<'a>(&'a self, others: impl Iterator<Item = &'a Arc<Tile>>) -> u64 {
        let shown = self.iter().flat_map(SurfaceState::tiles);
        let mut counted = HashSet::new();
        let pages = shown.chain(others).flat_map(|tile| tile.pages());
        let once = pages.filter(|page| counted.insert(page.id()));
        once.map(|page| page.held_bytes() as u64).sum()
    }
}

impl Deref for Surfaces {
    type Target = [SurfaceState];

    fn deref(&self) -> &[SurfaceState] {
        &self.states
    }
}

impl DerefMut for Surfaces {
    fn deref_mut(&mut self) -> &mut [SurfaceState] {
        &mut self.states
    }
}
