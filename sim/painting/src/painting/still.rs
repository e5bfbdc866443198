//! A snapshot of a painting, for reading beside the painting itself.

use maulstick_canvas::tile::{TileId, Version};

use super::Painting;
use super::bench::Workbench;
use crate::clock::Clock;
use crate::error::EditError;
use crate::history::Direction;

impl Painting {
    /// The current painting, with its versions, without brushes and history. Its tiles are shared with this one,
    /// whatever happens to it; making it takes as long as counting them.
    pub fn still(&mut self) -> Self {
        self.commit();
        let mut bench = Workbench::new(self.bench.desk.clone());
        bench.accounts.clone_from(&self.bench.accounts);
        bench.past.versions.clone_from(&self.bench.past.versions);
        Self {
            bench,
            clock: Clock::default(),
        }
    }

    /// Shows the painting of a version in a [`still`](Self::still).
    ///
    /// # Errors
    /// [`EditError`] for an unknown version.
    pub fn show_version(&mut self, name: &str) -> Result<(), EditError> {
        let Workbench { desk, past, .. } = &mut self.bench;
        let version = past.versions.find(name)?;
        for surface in desk.surfaces.iter_mut() {
            let [across, up] = surface.store.grid();
            for id in (0..up).flat_map(|y| (0..across).map(move |x| TileId { x, y })) {
                let tile = version.tiles.get(&(surface.id, id)).cloned().flatten();
                let number = surface.store.version(id).number;
                surface.store.replace(id, Version { number, tile });
            }
        }
        desk.restore(Some(&version.rest.layers), Some(&version.rest.materials));
        Ok(())
    }

    /// A [`still`](Self::still) of the painting when the step with this number was the newest done one, 0 for before
    /// all of them; `None` if there is no such step.
    pub fn still_after(&mut self, step: u64) -> Option<Self> {
        let mut still = self.still();
        if self.bench.past.history.is_open(step) {
            // Of steps that are not finished none counts as newer.
            return Some(still);
        }
        let open = self.bench.open_steps();
        let way = self.bench.past.history.way_to(step)?;
        let back = way.first().is_none_or(|(way, _)| *way == Direction::Undo);
        let open = open
            .iter()
            .rev()
            .filter(|_| back)
            .map(|open| (Direction::Undo, open));
        let (mut layers, mut materials) = (None, None);
        for (way, step) in open.chain(way) {
            let to = way.ends()[1];
            for (place, change) in &*step.tiles {
                still
                    .bench
                    .desk
                    .surfaces
                    .put(*place, change.end(to).clone());
            }
            let effects = &step.effects;
            layers = effects.layers.as_ref().map(|ends| &ends[to]).or(layers);
            let made = effects.materials.as_ref();
            materials = made.map(|ends| &ends[to]).or(materials);
        }
        if layers.is_some() || materials.is_some() {
            still.bench.desk.restore(layers, materials);
        }
        Some(still)
    }

    /// True if no paint was ever applied to it, and no version saved: loads of brushes do not count.
    #[must_use]
    pub fn is_blank(&self) -> bool {
        let untouched = self
            .bench
            .past
            .history
            .steps()
            .all(|step| step.tiles.is_empty());
        self.bench.accounts.work.steps == 0
            && self.bench.past.versions.iter().len() == 0
            && untouched
    }
}

#[cfg(test)]
mod tests {
    use crate::edits::{Dry, Fill, FillPaint, Ground};
    use maulstick_optics::PaintLibrary;
    use maulstick_types::Mixture;
    use maulstick_types::scene::CANVAS;
    use maulstick_types::values::{FilmThickness, LayerName, Share};

    use super::*;
    use crate::error::HistoryError;
    use crate::picture::picture;
    use crate::setup::PaintingSetup;

    #[test]
    fn a_still_stays_as_it_is_and_shows_versions_as_returning_to_them_does() {
        let setup = PaintingSetup {
            cells: [128, 128],
            ..PaintingSetup::default()
        };
        let library = PaintLibrary::measured().expect("whole");
        let mut painting = Painting::new(&setup, library).expect("a painting");
        assert!(painting.is_blank());
        let lay = |painting: &mut Painting, paint: &str| {
            painting
                .apply(Fill {
                    paint: FillPaint::Mixture {
                        mixture: Mixture::pure(paint),
                    },
                    thickness: FilmThickness::new(4e-5).expect("in range"),
                    surface: CANVAS,
                })
                .expect("laid");
        };
        lay(&mut painting, "Yellow Ochre");
        assert!(!painting.is_blank());
        painting
            .apply(Dry {
                share: Share::new(1.0).expect("in range"),
                layer: LayerName::new("first").ok(),
                ..Dry::whole(CANVAS)
            })
            .expect("dried");
        painting.keep("yellow").expect("kept");
        let yellow = picture(&mut painting, CANVAS);
        lay(&mut painting, "Bone Black");
        painting
            .apply(Ground::named(CANVAS, "grey").expect("valid"))
            .expect("a ground");
        let black = picture(&mut painting, CANVAS);
        let mut still = painting.still();
        lay(&mut painting, "Pyrrole Red");
        painting.bench.forget("yellow").expect("forgotten");
        assert_eq!(picture(&mut still, CANVAS), black);
        assert!(still.show_version("yelow").is_err());
        still.show_version("yellow").expect("it had it");
        assert_eq!(picture(&mut still, CANVAS), yellow);
        let red = picture(&mut painting, CANVAS);
        assert!(red != black && red != yellow, "a fault would pass");
    }

    #[test]
    fn going_to_a_step_leads_there_as_undo_and_redo_do_and_a_still_shows_it_before() {
        let setup = PaintingSetup {
            cells: [96, 64],
            ..PaintingSetup::default()
        };
        let library = PaintLibrary::measured().expect("whole");
        let mut painting = Painting::new(&setup, library).expect("a painting");
        let mut pictures = vec![(0, picture(&mut painting, CANVAS))];
        for paint in ["Yellow Ochre", "Pyrrole Red", "Bone Black"] {
            let film = Fill {
                paint: FillPaint::Mixture {
                    mixture: Mixture::pure(paint),
                },
                thickness: FilmThickness::new(3e-5).expect("in range"),
                surface: CANVAS,
            };
            painting.apply(film).expect("laid");
            pictures.push((painting.newest_step(), picture(&mut painting, CANVAS)));
        }
        painting
            .apply(Ground::named(CANVAS, "black").expect("valid"))
            .expect("a ground");
        pictures.push((painting.newest_step(), picture(&mut painting, CANVAS)));
        for (from, to) in [(4, 1), (1, 3), (3, 0), (0, 4), (4, 4), (4, 0), (0, 2)] {
            let (step, expected) = &pictures[to];
            let mut still = painting.still_after(*step).expect("it is there");
            assert!(picture(&mut still, CANVAS) == *expected, "{from} to {to}");
            painting.go_to(*step).expect("nothing lies over it");
            assert!(
                picture(&mut painting, CANVAS) == *expected,
                "{from} to {to}"
            );
            assert_eq!(painting.history_depth(), (to, 4 - to));
            assert_eq!(painting.report().quanta_missing, 0);
        }
        assert!(pictures[1].1 != pictures[2].1, "a fault would pass");
        assert_eq!(painting.go_to(77), Err(HistoryError::NoStep.into()));
        assert!(painting.still_after(77).is_none());
        assert_eq!(painting.history_depth(), (2, 2), "nothing has changed");
    }
}
