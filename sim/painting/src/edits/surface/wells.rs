//! Replaces the wells of a surface.

use std::sync::Arc;

use maulstick_types::EditFields;
use maulstick_types::limits::{FARTHEST_M, WELLS_MAX};
use maulstick_types::paint::StepName;
use maulstick_types::scene::{PALETTE, Well, WellKind};
use maulstick_types::values::ValueError;
use serde::de::{Deserialize, Deserializer, Error};

use crate::edits::{Applied, Form, PaintingEdit, StepForm, words};
use crate::error::EditError;
use crate::painting::Painting;
use crate::painting::surfaces::WellMoves;

/// Give a surface other wells
///
/// Wells that move take their wet paint along; paint on removed wells, and where new ones come, is scraped off.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Wells {
    /// The surface.
    pub surface: u32,
    /// New wells: few, round and within reach.
    #[serde(deserialize_with = "few")]
    pub wells: Vec<Well>,
}

impl Wells {
    /// Wells of a surface.
    ///
    /// # Errors
    /// [`ValueError`] for too many, and for one that is not round or out of reach.
    pub fn new(surface: u32, wells: Vec<Well>) -> Result<Self, ValueError> {
        if wells.len() > WELLS_MAX {
            return Err(ValueError::Wells(wells.len()));
        }
        let near = |m: &f64| m.abs() <= FARTHEST_M;
        let good = |well: &&Well| {
            let is_round = well.radius_m > 0.0 && near(&well.radius_m);
            is_round && well.center_m.iter().all(near)
        };
        match wells.iter().find(|well| !good(well)) {
            Some(well) => Err(ValueError::Well(well.radius_m * 1e3)),
            None => Ok(Self { surface, wells }),
        }
    }
}

fn few<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<Well>, D::Error> {
    let wells = Vec::deserialize(from)?;
    let checked = Wells::new(PALETTE, wells).map_err(D::Error::custom)?;
    Ok(checked.wells)
}

impl EditFields for Wells {
    const NAME: &'static str = "wells";
}

impl Form for Wells {
    const STEPS: &'static [StepForm] = &[];
    const ARGUMENTS: Option<&'static [&'static str]> = None;

    fn example() -> Result<Self, ValueError> {
        let well = Well {
            center_m: [0.1, 0.2],
            radius_m: 0.01,
            kind: WellKind::Cleaner,
        };
        Self::new(PALETTE, vec![well])
    }
}

impl PaintingEdit for Wells {
    /// Replaces the wells of a surface. Wells that move take their wet paint along; paint on removed wells, and where
    /// new ones come, is scraped off.
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let Painting { bench, clock } = painting;
        let on = bench.desk.surfaces.at(self.surface)?;
        let changed = bench.desk.with_wells(on, &self.wells)?;
        let before = &bench.desk.scene.surfaces[on].wells;
        if changed.wells == *before {
            return Ok(Applied::Done);
        }
        let ways = WellMoves::between((before, &changed.wells), &changed);
        let relief = Some(Arc::clone(&bench.desk.surfaces[on].bare.relief));
        let bare = Arc::new(bench.desk.optics.blank(&changed, relief)?);
        bench.close_windows();
        let surfaces = &bench.desk.surfaces;
        let moved = surfaces[on].with_moved_paint(&ways, &surfaces.pager);
        // A palette that is laid out before anything was painted is nothing to undo.
        let is_step = !moved.is_empty() || bench.past.history.has_changed_surfaces();
        if !moved.is_empty() {
            clock.stop(Some(self.surface));
        }
        if is_step {
            bench.begin_step(StepName::Wells, None);
        }
        let desk = &mut bench.desk;
        desk.scene.surfaces[on] = changed;
        desk.surfaces[on].bare = bare;
        desk.scene.version += 1;
        desk.optics.renew(&desk.scene);
        if !moved.is_empty() {
            bench.put_scraped(on, moved);
        }
        if is_step {
            bench.end_own_step();
        }
        Ok(Applied::Done)
    }

    fn log_words(&self) -> String {
        format!("change the wells of the {}", words::surface(self.surface))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wells_are_few_round_and_near() {
        let check = |radius_m: f64, x: f64, count: usize| {
            let well = Well {
                center_m: [x, 0.0],
                radius_m,
                kind: WellKind::Cleaner,
            };
            Wells::new(PALETTE, vec![well; count]).map(drop)
        };
        assert_eq!(check(0.01, 0.1, WELLS_MAX), Ok(()));
        assert_eq!(
            check(0.01, 0.1, WELLS_MAX + 1),
            Err(ValueError::Wells(WELLS_MAX + 1))
        );
        for (radius_m, x) in [(0.0, 0.1), (f64::NAN, 0.1), (1e9, 0.1), (0.01, f64::NAN)] {
            let error = check(radius_m, x, 1).expect_err("no well");
            assert!(matches!(error, ValueError::Well(_)), "{error}");
        }
    }
}
