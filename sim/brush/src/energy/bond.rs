//! Bond between the spines of a head.

use glam::DVec3;

/// Bond of a segment: it is bound to where the head as a whole would carry it.
///
/// Wet hair sticks together in bundles that bend as one (Bico and others 2004, "Elastocapillary coalescence in wet
/// hair").
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bond {
    /// Unit direction that the segment would have if its spine bent as the core of the head does.
    pub toward: DVec3,
    /// Torque by the sine of the angle between the two, N·m.
    pub stiffness: f64,
}

impl Bond {
    /// E = k·(1 − d·g), d the segment's direction and g the one that it is bound to, J.
    #[must_use]
    pub fn value(&self, direction: DVec3) -> f64 {
        // 1 − d·g loses its digits where d and g nearly coincide.
        0.5 * self.stiffness * (direction - self.toward).length_squared()
    }

    /// dE/dd, in space: −k·g, N·m; it has no derivative but by the curvature of the sphere.
    #[must_use]
    pub fn slope(&self) -> DVec3 {
        self.toward * -self.stiffness
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_turns_a_segment_back_and_its_slope_agrees() {
        let bond = Bond {
            toward: DVec3::new(0.6, 0.0, -0.8),
            stiffness: 3e-4,
        };
        assert_eq!(bond.value(bond.toward), 0.0);
        let d = DVec3::new(0.0, 0.28, -0.96);
        for tangent in [DVec3::X, d.cross(DVec3::X)] {
            let at = |h: f64| bond.value((d + tangent * h).normalize());
            let numeric = (at(1e-5) - at(-1e-5)) / 2e-5;
            let analytic = bond.slope().dot(tangent);
            assert!((numeric - analytic).abs() < 1e-6 * bond.stiffness);
            assert!(
                (numeric - 1.01 * analytic).abs() > 1e-6 * bond.stiffness,
                "a fault would pass"
            );
        }
    }
}
