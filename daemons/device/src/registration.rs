//! Registration of a 6-DOF device on the desk: by position, rotation and scale, or such that three of its points become
//! the corners of the canvas.
//!
//! The canvas is in the desk's z = 0, its middle at the desk's origin.

use std::f64::consts::FRAC_PI_2;

use glam::{DMat3, DQuat, DVec2, DVec3};
use maulstick_num::geometry::{Rigid, canonical};
use maulstick_rig::UserError;
use maulstick_rig::config::{CanvasSection, DeviceSection};

/// Desk lengths per device length that a device may have.
const SCALES: std::ops::RangeInclusive<f64> = 0.05..=20.0;
/// CornerCalibration that a hand has touched are those of the canvas within this: of the ratio of its sides,
/// and of the sine of the angle that is too much between them.
pub const TOLERANCE: f64 = 0.1;

/// A similarity: `p ↦ translation + scale·rotation·p`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Similarity {
    /// Rotation, and translation in the lengths of the image, m.
    pub rigid: Rigid,
    /// Lengths of the image per length; above 0.
    pub scale: f64,
}

impl Similarity {
    /// Nothing moves.
    pub const IDENTITY: Self = Self {
        rigid: Rigid::IDENTITY,
        scale: 1.0,
    };

    /// The image of a point.
    #[must_use]
    pub fn point(&self, p: DVec3) -> DVec3 {
        self.rigid.point(p * self.scale)
    }

    /// The point of an image.
    #[must_use]
    pub fn point_back(&self, image: DVec3) -> DVec3 {
        self.turn_back(image - self.rigid.translation) / self.scale
    }

    /// The image of a difference of points, of a velocity.
    #[must_use]
    pub fn vector(&self, v: DVec3) -> DVec3 {
        self.rigid.vector(v * self.scale)
    }

    /// Vector that is rotated into `image`, of its length.
    #[must_use]
    pub fn turn_back(&self, image: DVec3) -> DVec3 {
        self.rigid.rotation.conjugate() * image
    }

    /// The image of an orientation.
    #[must_use]
    pub fn turned(&self, orientation: DQuat) -> DQuat {
        canonical(self.rigid.rotation * orientation)
    }

    /// The orientation of an image.
    #[must_use]
    pub fn turned_back(&self, image: DQuat) -> DQuat {
        canonical(self.rigid.rotation.conjugate() * image)
    }
}

/// Fit of three touched places to three corners of the canvas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CornerFit {
    /// Width by height of the places, by that of the canvas: 1 where they fit.
    pub ratio: f64,
    /// Angle at the lower left corner, rad: a right one where they fit.
    pub angle_rad: f64,
    /// Farthest distance of a point from its corner, m of the desk.
    pub off_m: f64,
}

impl CornerFit {
    /// True if they fit within [`TOLERANCE`].
    #[must_use]
    pub fn is_good(&self) -> bool {
        let least = 1.0 - TOLERANCE;
        (least..=1.0 / least).contains(&self.ratio)
            && maulstick_num::sin(self.angle_rad - FRAC_PI_2).abs() <= TOLERANCE
    }
}

impl std::fmt::Display for CornerFit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "the ratio of width to height is {:.1} % of the canvas's, the angle {:.1} degrees",
            self.ratio * 100.0,
            self.angle_rad.to_degrees()
        )
    }
}

/// Registration of a device to the desk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Registration {
    /// Device frame to desk frame.
    pub to_desk: Similarity,
    /// From the point that it senses to where head and ferrule meet, brush frame, m of the device.
    pub ferrule_m: DVec3,
    /// Fit of its corners to the canvas, if it has any.
    pub corners: Option<CornerFit>,
}

impl Registration {
    /// A device that is its own desk.
    pub const IDENTITY: Self = Self {
        to_desk: Similarity::IDENTITY,
        ferrule_m: DVec3::ZERO,
        corners: None,
    };

    /// A device that stands so on a desk as large as it is.
    #[must_use]
    pub fn standing(rigid: Rigid) -> Self {
        let scale = 1.0;
        Self {
            to_desk: Similarity { rigid, scale },
            ..Self::IDENTITY
        }
    }

    /// As a section of `rig.toml` says: by its corners where it has them, else by position,
    /// orientation and scale.
    ///
    /// # Errors
    /// A [`UserError`] for corners that span no plane, or a scale out of range.
    pub fn of(device: &DeviceSection, canvas: &CanvasSection) -> Result<Self, UserError> {
        let plain = Similarity {
            rigid: Rigid {
                rotation: canonical(DQuat::from_array(device.orientation)),
                translation: device.position_m.into(),
            },
            scale: device.scale.unwrap_or(1.0),
        };
        let (to_desk, corners) = match &device.corners_m {
            None => (plain, None),
            Some(corners) => {
                let size = canvas_m(canvas);
                let (to_desk, fit) = by_corners(&corners.map(DVec3::from_array), size)
                    .map_err(|fault| fault.at(format!("corners_m of '{}'", device.name)))?;
                (to_desk, Some(fit))
            }
        };
        Ok(Self {
            to_desk,
            ferrule_m: device.ferrule_m.into(),
            corners,
        })
    }

    /// Warning about the corners, if they do not fit the canvas.
    #[must_use]
    pub fn warning(&self) -> Option<String> {
        let bad = self.corners.filter(|fit| !fit.is_good())?;
        Some(format!("corners_m do not fit the canvas: {bad}"))
    }
}

/// Width and height of the canvas, m.
#[must_use]
pub fn canvas_m(canvas: &CanvasSection) -> DVec2 {
    let [across, up] = canvas.cells().map(f64::from);
    DVec2::new(across, up) * (canvas.cell_mm * 1e-3)
}

/// Checks that the canvas whose corners are `places` is seen from the side of the hand, whose handle
/// points to `handle`, of any length; 0 where that is not known.
///
/// # Errors
/// A [`UserError`] where it would be seen from behind.
pub fn check_side(places: &[DVec3; 3], handle: DVec3) -> Result<(), UserError> {
    let normal = (places[1] - places[0]).cross(places[2] - places[0]);
    if normal.dot(handle) < 0.0 {
        let what =
            "the corners were touched in another order: the canvas would be seen from behind";
        let help = "touch lower left, then lower right, then upper left; begin again";
        return Err(UserError::failure(what).help(help));
    }
    Ok(())
}

/// The similarity that takes three places nearest to the lower left, lower right and upper left
/// corners of a canvas of `size`, m, by least squares, and how near that is. As the places span a plane
/// and the corners another, it is found within these, where turning and scaling is multiplying by a
/// complex number: Σ z̄·w / Σ |z|² for the places z and the corners w about their means.
///
/// # Errors
/// A [`UserError`] for places that span no plane, or that differ from the canvas in size too much.
pub fn by_corners(places: &[DVec3; 3], size: DVec2) -> Result<(Similarity, CornerFit), UserError> {
    let again = "touch them again: `maulstick device fit`";
    let (right, up) = (places[1] - places[0], places[2] - places[0]);
    let normal = right.cross(up);
    let sine = normal.length() / (right.length() * up.length());
    if !sine.is_finite() || sine < TOLERANCE {
        return Err(UserError::usage("the three corners lie on one line").help(again));
    }
    let x = right.normalize();
    let z = normal.normalize();
    let flat = DMat3::from_cols(x, z.cross(x), z);
    let mean = (places[0] + places[1] + places[2]) / 3.0;
    let corners = [[-0.5, -0.5], [0.5, -0.5], [-0.5, 0.5]].map(|c| DVec2::from_array(c) * size);
    let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    let (mut turn, mut square) = (DVec2::ZERO, 0.0);
    for (place, corner) in places.iter().zip(corners) {
        let from = (flat.transpose() * (*place - mean)).truncate();
        let to = corner - middle;
        turn += DVec2::new(from.dot(to), from.perp_dot(to));
        square += from.length_squared();
    }
    let scale = turn.length() / square;
    if !SCALES.contains(&scale) {
        let what = format!(
            "the canvas is {scale:.3} times as large as the area between the touched corners"
        );
        return Err(UserError::usage(what).help(again));
    }
    let turn = turn.normalize();
    let in_plane = DMat3::from_cols(
        DVec3::new(turn.x, turn.y, 0.0),
        DVec3::new(-turn.y, turn.x, 0.0),
        DVec3::Z,
    );
    let rotation = canonical(DQuat::from_mat3(&(in_plane * flat.transpose())));
    let mut to_desk = Similarity {
        rigid: Rigid {
            rotation,
            translation: DVec3::ZERO,
        },
        scale,
    };
    to_desk.rigid.translation = middle.extend(0.0) - to_desk.point(mean);
    let off = places
        .iter()
        .zip(corners)
        .map(|(place, corner)| (to_desk.point(*place) - corner.extend(0.0)).length());
    let fit = CornerFit {
        ratio: right.length() / up.length() * (size.y / size.x),
        angle_rad: right.angle_between(up),
        off_m: off.fold(0.0, f64::max),
    };
    Ok((to_desk, fit))
}

#[cfg(test)]
mod tests {
    use maulstick_num::geometry::rotation;
    use proptest::prelude::*;

    use super::*;

    const SIZE: DVec2 = DVec2::new(0.256, 0.192);

    fn corners() -> [DVec3; 3] {
        [[-0.5, -0.5], [0.5, -0.5], [-0.5, 0.5]].map(|c| (DVec2::from_array(c) * SIZE).extend(0.0))
    }

    fn similarity() -> impl Strategy<Value = Similarity> {
        let part = -1.0..1.0f64;
        let axis = (part.clone(), part.clone(), part.clone())
            .prop_map(|(x, y, z)| DVec3::new(x, y, z))
            .prop_filter("a direction", |axis| axis.length() > 0.1);
        let place = (part.clone(), part.clone(), part).prop_map(|(x, y, z)| DVec3::new(x, y, z));
        (axis, -3.0..3.0f64, place, 0.2..5.0f64).prop_map(|(axis, angle, place, scale)| {
            Similarity {
                rigid: Rigid {
                    rotation: canonical(rotation(axis.normalize(), angle)),
                    translation: place,
                },
                scale,
            }
        })
    }

    proptest! {
        #[test]
        fn a_similarity_is_undone_point_by_point(s in similarity(), x in -1.0..1.0f64) {
            let p = DVec3::new(x, 0.3, -0.7);
            prop_assert!((s.point_back(s.point(p)) - p).length() < 1e-12);
            let along = s.vector(DVec3::X);
            prop_assert!((s.turn_back(along) / s.scale - DVec3::X).length() < 1e-12);
            prop_assert!((s.point(p + DVec3::X) - s.point(p) - along).length() < 1e-12);
            let turned = s.turned_back(s.turned(DQuat::IDENTITY));
            prop_assert!(turned.angle_between(DQuat::IDENTITY) < 1e-6);
        }

        /// Wherever a device stands, its touched corners say so.
        #[test]
        fn three_corners_give_the_similarity_back(s in similarity()) {
            let places = corners().map(|corner| s.point_back(corner));
            let (found, fit) = by_corners(&places, SIZE).expect("corners");
            prop_assert!((found.scale / s.scale - 1.0).abs() < 1e-12);
            prop_assert!((found.rigid.translation - s.rigid.translation).length() < 1e-11);
            prop_assert!(found.rigid.rotation.angle_between(s.rigid.rotation) < 1e-6);
            prop_assert!(fit.is_good() && fit.off_m < 1e-12, "{fit:?}");
        }

        /// With corners that a hand has missed no other similarity comes nearer: it is the least squares'.
        #[test]
        fn no_similarity_beside_it_fits_missed_corners_better(
            s in similarity(),
            missed in prop::array::uniform9(-5e-3..5e-3f64),
            aside in prop::array::uniform7(-1e-3..1e-3f64),
        ) {
            let mut places = corners();
            for (place, by) in places.iter_mut().zip(missed.as_chunks::<3>().0) {
                *place = s.point_back(*place + DVec3::from_array(*by));
            }
            let (found, _) = by_corners(&places, SIZE).expect("corners");
            let off = |s: &Similarity| -> f64 {
                let square = |(p, c): (&DVec3, DVec3)| (s.point(*p) - c).length_squared();
                places.iter().zip(corners()).map(square).sum()
            };
            let [x, y, z, u, v, w, k] = aside;
            let turn = rotation(DVec3::Z, u) * rotation(DVec3::X, v) * rotation(DVec3::Y, w);
            let mean = (places[0] + places[1] + places[2]) / 3.0;
            let mut other = found;
            other.scale *= 1.0 + k;
            other.rigid.rotation = canonical(turn * other.rigid.rotation);
            let kept = found.point(mean) + DVec3::new(x, y, z);
            other.rigid.translation += kept - other.point(mean);
            prop_assert!(off(&found) <= off(&other) * (1.0 + 1e-9) + 1e-18);
        }
    }

    #[test]
    fn places_that_are_no_rectangle_of_the_canvas_shape_are_told() {
        let warning = |corners: [DVec3; 3]| {
            let mut device = DeviceSection::new("arm", "polhem", "main");
            device.corners_m = Some(corners.map(|corner| corner.to_array()));
            let canvas = CanvasSection {
                width_mm: 256.0,
                height_mm: 192.0,
                ..CanvasSection::default()
            };
            Registration::of(&device, &canvas)
                .expect("a plane")
                .warning()
        };
        assert_eq!(warning(corners()), None);
        let moved = |which: usize, by: DVec3| {
            let mut places = corners();
            places[which] += by;
            places
        };
        assert_eq!(warning(moved(1, DVec3::X * 0.01)), None, "4 % longer");
        let long = warning(moved(1, DVec3::X * 0.04)).expect("16 % longer");
        assert!(long.contains("115.6 %"), "{long}");
        let skew = warning(moved(2, DVec3::X * 0.03)).expect("9 degrees askew");
        assert!(skew.contains("81.1 degrees"), "{skew}");
    }

    #[test]
    fn what_no_canvas_can_be_fitted_to_is_refused() {
        let line = [DVec3::ZERO, DVec3::X, DVec3::new(2.0, 0.01, 0.0)];
        assert!(by_corners(&line, SIZE).is_err());
        let tiny = corners().map(|corner| corner * 0.04);
        assert!(by_corners(&tiny, SIZE).is_err());
        assert!(by_corners(&[DVec3::NAN; 3], SIZE).is_err());
    }

    #[test]
    fn a_canvas_that_would_be_seen_from_behind_is_refused() {
        let [origin, right, up] = corners();
        let leaning = DVec3::new(0.7, 0.0, 0.3);
        for handle in [DVec3::Z, leaning, DVec3::ZERO] {
            assert_eq!(check_side(&[origin, right, up], handle), Ok(()));
        }
        assert!(check_side(&[origin, up, right], leaning).is_err());
    }

    #[test]
    fn without_corners_position_orientation_and_scale_say_it() {
        let mut device = DeviceSection::new("arm", "polhem", "main");
        let canvas = CanvasSection::default();
        let registration =
            |device: &DeviceSection| Registration::of(device, &canvas).expect("a registration");
        assert_eq!(registration(&device).to_desk, Similarity::IDENTITY);
        device.position_m = [0.1, 0.0, -0.2];
        device.scale = Some(2.0);
        device.ferrule_m = [0.0, 0.0, -0.05];
        let found = registration(&device);
        assert_eq!(found.to_desk.point(DVec3::X), DVec3::new(2.1, 0.0, -0.2));
        assert_eq!((found.ferrule_m.z, found.corners), (-0.05, None));
    }
}
