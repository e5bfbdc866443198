//! The angles of a head's joints in a solve.

use maulstick_types::brush::Solve;

use super::Head;

impl Head {
    /// The angles of its joints in a solve, without the rest of the permanent set that a head in the air has; absent
    /// where they are another head's.
    #[must_use]
    pub fn angles<'a>(&self, solve: &'a Solve) -> Option<&'a [[f32; 2]]> {
        let (angles, rest) = solve.angles_rad.split_at_checked(self.joints)?;
        (rest.is_empty() || solve.contacts.is_empty()).then_some(angles)
    }
}
