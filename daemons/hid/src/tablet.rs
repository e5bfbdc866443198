//! A tablet on the desk: where its points are on the canvas, how its tilts turn, how its pressure goes.
//!
//! The canvas lies in the middle of the desk. In order of what `rig.toml` says:
//!
//! 1. `corners_m`: three touched corners of the canvas give an affine map, whatever else is said.
//! 2. `scale`: the tablet's middle comes to `position_m`, turned about z as `orientation` turns x.
//! 3. Neither: the same, with the least scale at which the tablet covers the canvas.

use glam::{DMat2, DQuat, DVec2, DVec3};
use maulstick_device::registration::canvas_m;
use maulstick_num::{atan2, sin_cos};
use maulstick_rig::UserError;
use maulstick_rig::config::{CanvasSection, DeviceSection};
use maulstick_types::limits::FARTHEST_M;
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample, switch};

use maulstick_device::pen::{End, Presence, Reading, STEEPEST_RAD};
use maulstick_device::pressure_curve::given;

use crate::layout::wrapped;

/// A tablet fitted to the desk.
#[derive(Clone, Debug)]
pub struct Tablet {
    /// Tablet frame to desk frame.
    linear: DMat2,
    translation: DVec2,
    lifted_m: f64,
    /// Rotation of tilts and twist, rad.
    turn: f64,
    area_m: [f64; 2],
    curve: Vec<[f64; 2]>,
    senses: u32,
}

impl Tablet {
    /// Fits a tablet of an active area, m, that senses `senses`.
    ///
    /// # Errors
    /// A [`UserError`] where the corners are on one line, or in another order.
    pub fn fit(
        area_m: [f64; 2],
        senses: u32,
        device: &DeviceSection,
        canvas: &CanvasSection,
    ) -> Result<Self, UserError> {
        let size = canvas_m(canvas);
        let (linear, translation) = match &device.corners_m {
            Some(corners) => by_corners(corners, size)?,
            None => in_the_middle(DVec2::from_array(area_m), size, device),
        };
        Ok(Self {
            turn: atan2(linear.x_axis.y, linear.x_axis.x),
            linear,
            translation,
            lifted_m: match device.corners_m {
                Some(_) => 0.0,
                None => device.position_m[2],
            },
            area_m,
            curve: device.pressure_curve.clone(),
            senses,
        })
    }

    /// Desk point of a tablet point, m.
    #[must_use]
    pub fn place(&self, point_m: [f64; 2]) -> [f64; 2] {
        let on_desk = self.linear * DVec2::from_array(point_m) + self.translation;
        on_desk
            .to_array()
            .map(|at| at.clamp(-FARTHEST_M, FARTHEST_M))
    }

    /// The desk's box around the active area: least x, y, z, then greatest, m.
    #[must_use]
    pub fn workspace_m(&self) -> [f64; 6] {
        let [width, height] = self.area_m;
        let corners = [[0.0, 0.0], [width, 0.0], [0.0, height], [width, height]];
        let corners = corners.map(|corner| DVec2::from_array(self.place(corner)));
        let least = corners.iter().fold(DVec2::INFINITY, |all, at| all.min(*at));
        let most = corners
            .iter()
            .fold(DVec2::NEG_INFINITY, |all, at| all.max(*at));
        [
            least.x,
            least.y,
            self.lifted_m,
            most.x,
            most.y,
            self.lifted_m,
        ]
    }

    /// The sample of a reading.
    #[must_use]
    pub fn sample(&self, reading: &Reading) -> StylusSample {
        let [x, y] = self.place(reading.point_m);
        let eraser = match reading.end {
            End::Tip => 0,
            End::Eraser => switch::ERASER,
        };
        let pressure = match reading.presence {
            Presence::Touching => given(&self.curve, reading.pressure),
            _ => 0.0,
        };
        let z = (self.lifted_m + reading.height_m).clamp(-FARTHEST_M, FARTHEST_M);
        StylusSample {
            senses: self.senses,
            pose: StylusPose::Contact {
                point_m: [x, y, z],
                tilt_rad: reading
                    .tilt_rad
                    .map_or(DEFAULT_TILT_RAD, |tilt| turned(tilt, self.turn)),
                twist_rad: reading
                    .twist_rad
                    .map_or(0.0, |twist| wrapped(twist + self.turn)),
                pressure,
            },
            switches: reading.switches | eraser,
            in_range: reading.presence != Presence::Away,
            ..StylusSample::away()
        }
    }
}

/// The affine map that takes three points of the tablet to the lower left, lower right and upper left corner
/// of the canvas.
fn by_corners(corners: &[[f64; 3]; 3], size: DVec2) -> Result<(DMat2, DVec2), UserError> {
    let [origin, right, up] = corners.map(|[x, y, _]| DVec2::new(x, y));
    let sides = DMat2::from_cols(right - origin, up - origin);
    let lengths = (right - origin).length() * (up - origin).length();
    if sides.determinant() <= 0.1 * lengths {
        return Err(UserError::usage(
            "corners_m are no corners of a canvas that lies on the tablet",
        )
        .help("touch lower left, lower right and upper left again with `maulstick device fit`"));
    }
    let linear = DMat2::from_diagonal(size) * sides.inverse();
    Ok((linear, -0.5 * size - linear * origin))
}

fn in_the_middle(area: DVec2, size: DVec2, device: &DeviceSection) -> (DMat2, DVec2) {
    let axis = DQuat::from_array(device.orientation) * DVec3::X;
    let angle = atan2(axis.y, axis.x);
    let (sin, cos) = sin_cos(angle);
    let scale = device.scale.unwrap_or_else(|| {
        // The canvas as the tablet sees it: the box around it, turned back.
        let seen = DVec2::new(
            cos.abs() * size.x + sin.abs() * size.y,
            sin.abs() * size.x + cos.abs() * size.y,
        );
        (seen / area).max_element()
    });
    let linear = DMat2::from_cols(DVec2::new(cos, sin), DVec2::new(-sin, cos)) * scale;
    let middle = DVec2::new(device.position_m[0], device.position_m[1]);
    (linear, middle - linear * (0.5 * area))
}

/// A lean toward x and y, seen from a frame that is turned about z.
fn turned(tilt_rad: [f64; 2], turn: f64) -> [f64; 2] {
    let [x, y] = tilt_rad.map(|tilt| {
        let (sin, cos) = sin_cos(tilt);
        sin / cos
    });
    let (sin, cos) = sin_cos(turn);
    [cos * x - sin * y, sin * x + cos * y]
        .map(|tangent| atan2(tangent, 1.0).clamp(-STEEPEST_RAD, STEEPEST_RAD))
}
