//! The tuft: where the spines of a head stand in the ferrule.

use glam::{DQuat, DVec3};
use maulstick_num::geometry::{Rigid, shortest_arc};
use maulstick_num::sin_cos;

use crate::file::BrushFile;
use crate::spine::Spine;

/// Where a spine begins and which way it goes at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seat {
    /// Its root in the brush frame, m.
    pub root: DVec3,
    /// Turns the brush frame so that its −z is the spine's direction at rest.
    pub lean: DQuat,
}

impl Seat {
    /// The seat of a brush that is held at `brush`: root and orientation of the spine's own frame.
    #[must_use]
    pub fn held(&self, brush: &Rigid) -> Rigid {
        Rigid {
            rotation: brush.rotation * self.lean,
            translation: brush.point(self.root),
        }
    }
}

/// The spines of a head: alike, each in its seat.
#[derive(Clone, Debug, PartialEq)]
pub struct Tuft {
    /// The one in the middle first, then those around it, counterclockwise seen from the point.
    pub seats: Vec<Seat>,
    /// Their springs: each has its share of the head's stiffness.
    pub spine: Spine,
}

impl Tuft {
    /// The tuft of a brush file: one spine in the middle and a ring around it, which leans inward
    /// as the head tapers.
    #[must_use]
    pub fn of(file: &BrushFile) -> Self {
        let spines = &file.spines;
        let share = spines.ring_share;
        let (base, point) = (share * file.radius_m(0.0), share * file.radius_m(1.0));
        let mut seats = vec![Seat {
            root: DVec3::ZERO,
            lean: DQuat::IDENTITY,
        }];
        for i in 0..spines.ring {
            let turn = 2.0 * std::f64::consts::PI * i as f64 / spines.ring as f64;
            let (sine, cosine) = sin_cos(turn);
            let out = DVec3::new(cosine, sine, 0.0);
            let along = (out * (point - base) - DVec3::Z * file.length_m()).normalize();
            seats.push(Seat {
                root: out * base,
                lean: shortest_arc(DVec3::NEG_Z, along),
            });
        }
        let ei = spines.bending_stiffness_n_mm2 * 1e-6 / seats.len() as f64;
        let spine = Spine::uniform(file.length_m(), spines.joints, ei).damped(spines.damping);
        Self { seats, spine }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spines_lean_to_the_point() {
        let file = BrushFile::library("round").expect("round");
        let tuft = Tuft::of(&file);
        assert_eq!(tuft.seats.len(), file.spines.number());
        let reach = file.spines.ring_share * file.radius_m(1.0);
        for seat in &tuft.seats[1..] {
            let held = seat.held(&Rigid::IDENTITY);
            let tip = held.point(DVec3::NEG_Z * file.length_m());
            assert!(
                (tip.truncate().length() - reach).abs() < 0.05 * file.radius_m(0.0),
                "{tip}"
            );
            assert!(tip.truncate().dot(seat.root.truncate()) > 0.0);
        }
        let whole: f64 = tuft.seats.len() as f64 * tuft.spine.stiffness[1];
        let one = Spine::uniform(
            file.length_m(),
            file.spines.joints,
            file.spines.bending_stiffness_n_mm2 * 1e-6,
        );
        assert!((whole / one.stiffness[1] - 1.0).abs() < 1e-12);
    }
}
