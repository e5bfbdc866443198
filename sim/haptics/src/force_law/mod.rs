//! Normal force and stiffness by depth, for each law of a contact model.
//!
//! | module | holds |
//! | --- | --- |
//! | [`linear`] | two straight pieces (Baxter 2004, eq. 8.1) |
//! | [`hermite`] | the piecewise cubic with its compressive part (fig. 8.2, eq. 8.2) |
//! | [`local`] | a force linearised about a pose |

pub mod hermite;
pub mod linear;
pub mod local;

use maulstick_types::haptics::ForceLaw;

use self::hermite::Curve;
use self::linear::Linear;
use self::local::Local;

/// Penetration of a head into the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Penetration {
    /// d_p: depth of the undeformed point below the plane, m; negative above it.
    pub depth_m: f64,
    /// l_p: length of the head along the normal, m; never less than a fifth of its length.
    pub projected_m: f64,
    /// cos θ, θ between the normal and the negated direction of the bristles.
    pub cosine: f64,
}

/// Normal force at a depth.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Normal {
    /// The force, N; not negative.
    pub force_n: f64,
    /// Its derivative by depth, N/m.
    pub stiffness_n_m: f64,
}

/// Normal force by depth, ready for the servo: evaluation does not allocate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Law {
    None,
    Linear(Linear),
    Hermite(Curve),
    Local(Local),
    Rigid { stiffness: f64 },
}

impl Law {
    pub(crate) fn new(law: &ForceLaw) -> Result<Self, &'static str> {
        let good = |values: &[f64]| values.iter().all(|v| v.is_finite() && *v >= 0.0);
        match law {
            ForceLaw::None => Ok(Self::None),
            ForceLaw::Linear { k1_n, k2_n } if good(&[*k1_n, *k2_n]) => Ok(Self::Linear(Linear {
                k1_n: *k1_n,
                k2_n: *k2_n,
            })),
            ForceLaw::Hermite { knots } => Curve::new(knots).map(Self::Hermite),
            ForceLaw::Local {
                pose,
                force_n,
                stiffness_n_m,
            } => Local::new(pose, *force_n, *stiffness_n_m).map(Self::Local),
            ForceLaw::Rigid { stiffness_n_m } if good(&[*stiffness_n_m]) => Ok(Self::Rigid {
                stiffness: *stiffness_n_m,
            }),
            _ => Err("a stiffness is negative or not finite"),
        }
    }

    /// Normal force of a law that depends on depth; its slope is at most `max_stiffness`, N/m.
    pub(crate) fn normal(&self, penetration: &Penetration, max_stiffness: f64) -> Normal {
        if penetration.depth_m <= 0.0 {
            return Normal::default();
        }
        match self {
            Self::None | Self::Local(_) => Normal::default(),
            Self::Linear(linear) => linear.normal(penetration, max_stiffness),
            Self::Hermite(curve) => curve.normal(penetration, max_stiffness),
            Self::Rigid { stiffness } => {
                let stiffness_n_m = stiffness.min(max_stiffness);
                Normal {
                    force_n: stiffness_n_m * penetration.depth_m,
                    stiffness_n_m,
                }
            }
        }
    }
}
