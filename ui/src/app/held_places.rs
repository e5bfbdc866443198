//! Placements of surfaces that wait until no brush touches one.

use maulstick_client::request::Request;

use crate::rig::state::BrushContact;

/// Waiting placements: the desk is never moved under a brush.
#[derive(Debug, Default)]
pub(super) struct HeldPlaces {
    held: Vec<Request>,
}

impl HeldPlaces {
    /// The requests that may be sent now, the oldest first: those that waited, once the brushes are lifted, and from
    /// `requests` all that move no surface or need not wait. The free hand does not wait, and is not overwritten: its
    /// placement replaces an earlier request for that surface.
    #[must_use]
    pub(super) fn release(
        &mut self,
        contact: BrushContact,
        requests: Vec<Request>,
        free_hand: &[Request],
    ) -> Vec<Request> {
        let mut all = std::mem::take(&mut self.held);
        all.extend(requests);
        all.retain(|request| {
            let mut later = free_hand.iter();
            !(request.moves_surface() && later.any(|later| later.sets() == request.sets()))
        });
        match contact {
            BrushContact::Lifted => all,
            BrushContact::Held => {
                let (held, ready) = all.into_iter().partition(Request::moves_surface);
                self.held = held;
                ready
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Rect, pos2, vec2};
    use glam::DVec3;
    use maulstick_brush::palette_place::Side;
    use maulstick_brush::placement::SurfacePlacement;
    use maulstick_painting::PaintingSetup;
    use maulstick_painting::edits::Clean;
    use maulstick_types::scene::{CANVAS, PALETTE};
    use maulstick_types::values::BrushName;

    use super::*;
    use crate::view::camera::View;

    /// Placement of a surface, enlarged about the middle of the desk.
    fn zoomed(surface: u32, factor: f64) -> Request {
        let surfaces = PaintingSetup::default().scene().surfaces;
        let own = surfaces.iter().find(|own| own.id == surface);
        let lie = SurfacePlacement::from(own.expect("a surface"));
        let edit = lie.zoomed(DVec3::ZERO, factor).edit(surface);
        Request::of(edit.expect("within reach"))
    }

    /// The canvas at the size of the window.
    fn fit() -> Request {
        let surfaces = PaintingSetup::default().scene().surfaces;
        let area = Rect::from_min_size(pos2(0.0, 0.0), vec2(1000.0, 600.0));
        let view = View::of(area, &surfaces[0], surfaces.get(1), Side::Left, 72.0);
        let lie = view.expect("a view").fitted(&surfaces[0]);
        Request::of(lie.edit(CANVAS).expect("within reach"))
    }

    fn clean() -> Request {
        Request::of(Clean {
            brush: BrushName::main(),
        })
    }

    #[test]
    fn placements_alone_move_a_surface() {
        let places = [zoomed(CANVAS, 1.25), zoomed(PALETTE, 1.25), fit()];
        assert!(places.iter().all(Request::moves_surface));
        assert!(!clean().moves_surface());
    }

    #[test]
    fn a_zoom_by_keys_and_the_fit_of_another_window_wait_until_the_brush_is_lifted() {
        for place in [zoomed(CANVAS, 1.25), fit()] {
            // Each window holds its own while any brush touches the desk.
            let mut places = HeldPlaces::default();
            let asked = vec![place.clone(), clean()];
            let sent = places.release(BrushContact::Held, asked, &[]);
            assert_eq!(sent, [clean()], "{place:?}");
            let sent = places.release(BrushContact::Held, Vec::new(), &[]);
            assert!(sent.is_empty(), "{sent:?}");
            let sent = places.release(BrushContact::Lifted, vec![clean()], &[]);
            assert_eq!(sent, [place, clean()]);
            let sent = places.release(BrushContact::Lifted, Vec::new(), &[]);
            assert!(sent.is_empty(), "it is sent once: {sent:?}");
        }
    }

    #[test]
    fn the_free_hands_later_place_is_not_overwritten() {
        let hand = [zoomed(CANVAS, 1.5)];
        let asked = || vec![zoomed(CANVAS, 1.25), zoomed(PALETTE, 1.25)];
        // In the stroke, and at its end.
        for contact in [BrushContact::Held, BrushContact::Lifted] {
            let mut places = HeldPlaces::default();
            let mut sent = places.release(BrushContact::Held, asked(), &[]);
            sent.extend(places.release(contact, Vec::new(), &hand));
            sent.extend(places.release(BrushContact::Lifted, Vec::new(), &[]));
            assert_eq!(sent, [zoomed(PALETTE, 1.25)], "{contact:?}");
        }
        // Requests after the hand's take effect.
        let mut places = HeldPlaces::default();
        let mut sent = places.release(BrushContact::Held, Vec::new(), &hand);
        sent.extend(places.release(BrushContact::Held, vec![fit()], &[]));
        sent.extend(places.release(BrushContact::Lifted, Vec::new(), &[]));
        assert_eq!(sent, [fit()]);
    }
}
