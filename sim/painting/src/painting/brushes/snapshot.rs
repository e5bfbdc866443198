//! Brushes as a document saves them.

use std::collections::BTreeMap;
use std::sync::Arc;

use maulstick_brush::{BrushFile, Head};
use maulstick_canvas::page::Page;
use maulstick_model::brush::head::Waypoint;
use maulstick_model::brush::load::BrushLoad;
use maulstick_model::brush::traits::TEXELS_PER_STRIP;
use maulstick_model::path::PathStepper;

use super::{Brushes, PaintingBrush};
use crate::error::EditError;
use crate::painting::surfaces::Surfaces;
use crate::snapshot::BrushSnapshot;

impl Brushes {
    /// The brushes, by name, with the pages of their loads.
    pub(crate) fn snapshot(
        &self,
        surfaces: &Surfaces,
        loads: &BTreeMap<String, Page<BrushLoad>>,
    ) -> BTreeMap<String, BrushSnapshot> {
        let brushes = self.iter().map(|brush| {
            let path = brush.path.as_ref().map(|(on, path)| {
                let (at, ahead, _) = path.places();
                let surface = surfaces[*on].id;
                (surface, path.scale(), at.into(), ahead.map(Into::into))
            });
            let before = brush.path.as_ref().and_then(|(_, path)| path.places().2);
            let kept = BrushSnapshot {
                file: brush.file.to_toml().unwrap_or_default(),
                load: loads.get(&brush.name).map_or(0, Page::id),
                stroke: brush.stroke,
                path,
                before: before.map(Into::into),
                loads: brush.loads.clone(),
                strokes: brush.strokes,
                seed: brush.seed,
                way_m: brush.way_m,
            };
            (brush.name.clone(), kept)
        });
        brushes.collect()
    }

    /// The brushes of a document.
    pub(crate) fn restored(
        kept: BTreeMap<String, BrushSnapshot>,
        loads: &BTreeMap<String, Page<BrushLoad>>,
        surfaces: &Surfaces,
    ) -> Result<Self, EditError> {
        let brushes = kept.into_iter().map(|(name, brush)| {
            let load = loads.get(&name).cloned();
            PaintingBrush::restored(name, brush, load, surfaces)
        });
        Ok(Self(brushes.collect::<Result<_, _>>()?))
    }
}

impl PaintingBrush {
    fn restored(
        name: String,
        kept: BrushSnapshot,
        page: Option<Page<BrushLoad>>,
        surfaces: &Surfaces,
    ) -> Result<Self, EditError> {
        let file = BrushFile::parse(&kept.file).map_err(|error| {
            EditError::Damaged(format!(
                "the file of brush '{name}' in the document is wrong: {error}"
            ))
        })?;
        let mut brush = Self::new(&name, file, surfaces.cell_m());
        (brush.stroke, brush.strokes, brush.loads) = (kept.stroke, kept.strokes, kept.loads);
        (brush.seed, brush.way_m) = (kept.seed, kept.way_m);
        if let Some(page) = page {
            let load = page.get();
            if load.texels() > 0 {
                brush.thinned = brush.file.thinned_to(load.texels() / TEXELS_PER_STRIP);
                brush.tidy = Arc::new(Head::of(&brush.thinned));
            }
            let strips = brush.tidy.strips();
            if load.texels() == strips * TEXELS_PER_STRIP {
                (brush.load, brush.kept) = (Arc::clone(&load), Some((load, page)));
            } else {
                brush.load = Arc::new(load.onto(strips, &brush.tidy));
            }
        }
        brush.head = brush.disordered();
        brush.path = kept.path.and_then(|(surface, scale, at, ahead)| {
            let on = surfaces.at(surface).ok()?;
            let before = kept.before.map(Waypoint::from);
            let places = (Waypoint::from(at), ahead.map(Waypoint::from), before);
            Some((on, PathStepper::going_on(&brush.head, places, scale)))
        });
        Ok(brush)
    }
}
