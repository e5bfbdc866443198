//! The force of the head on the hand as a function of depth.

use maulstick_types::haptics::HermiteKnot;

use super::BrushModel;
use crate::head_stiffness::{AT_ONCE_M, HeadStiffness, Press, tuned, tuples};

impl BrushModel {
    /// Force on the hand from the head as it is bent now.
    #[must_use]
    pub fn stiffness(&self) -> HeadStiffness {
        let length = self.file.length_m();
        match &self.tracked {
            Some(tracked) => HeadStiffness::bent(
                &self.tuft,
                length,
                &self.placed(tracked, &tracked.newest),
                tracked.force_n,
            ),
            None => HeadStiffness::at_rest(&self.tuft, length),
        }
    }

    /// The tuples of the Hermite curve of the head as it is tuned.
    #[must_use]
    pub fn tuples(&self) -> Vec<HermiteKnot> {
        tuned(&tuples(&self.file), self.tuned)
    }

    /// Contact of the head in its current pose, in the desk frame, and the change of its force with depth, from one
    /// more solve half a millimetre deeper; `None` in the air.
    #[must_use]
    pub fn press(&mut self) -> Option<Press> {
        let tracked = self
            .tracked
            .as_ref()
            .filter(|tracked| tracked.force_n > 0.0)?;
        let desk = self.desk.as_ref()?;
        let plane = desk.plane(tracked.surface)?;
        let (force_n, mut further) = (tracked.force_n, tracked.head.clone());
        let here = self.placed(tracked, &tracked.newest);
        let mut deeper = here;
        deeper.translation.z -= AT_ONCE_M;
        let obstacles = desk.obstacles(plane, deeper.translation, self.file.length_m());
        let pose = plane.to_desk.after(&here);
        self.tuft.raise(&mut deeper, self.file.length_m());
        let (tuft, settings) = (&self.tuft, &self.settings);
        further.solve(&mut self.solver, tuft, &deeper, &obstacles, settings);
        Some(Press {
            pose,
            force_n,
            stiffness_n_m: ((further.force_n() - force_n) / AT_ONCE_M).max(0.0),
        })
    }

    /// The normal force of all contacts now, N.
    #[must_use]
    pub fn force_n(&self) -> f64 {
        self.tracked.as_ref().map_or(0.0, |tracked| tracked.force_n)
    }
}
