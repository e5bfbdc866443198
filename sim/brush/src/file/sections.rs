//! The sections of a brush file.

use serde::{Deserialize, Serialize};

/// The outline of a ferrule.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Outline {
    /// A circle, or an ellipse where the thickness is not the width.
    #[default]
    Round,
    /// A rectangle with rounded corners.
    Flat,
}

/// Material of the bristles, for their appearance and the transfer of paint.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Hair {
    /// Hog bristle: straw.
    #[default]
    Hog,
    /// Sable and similar hair: red brown.
    Sable,
    /// Badger: grey with light points; blends the paint that it moves through.
    Badger,
    /// The steel of a palette knife, which scrapes.
    Steel,
}

impl Hair {
    /// Its colour in the light, sRGB of 0 to 255.
    #[must_use]
    pub const fn srgb(self) -> [f32; 3] {
        match self {
            Self::Hog => [238.0, 214.0, 170.0],
            Self::Sable => [186.0, 112.0, 66.0],
            Self::Badger => [226.0, 222.0, 214.0],
            Self::Steel => [226.0, 230.0, 235.0],
        }
    }
}

/// The head's shape.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Head {
    /// The outline of the ferrule.
    #[serde(default)]
    pub outline: Outline,
    /// Appearance of its bristles.
    #[serde(default)]
    pub hair: Hair,
    /// Greatest width, mm.
    pub width_mm: f64,
    /// Greatest thickness, mm; as the width if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thickness_mm: Option<f64>,
    /// Length from the ferrule to the point, mm.
    pub length_mm: f64,
    /// Place along the head from 0 to 1, and half the width there as a share of half the widest.
    pub profile: Vec<[f64; 2]>,
    /// The same for the thickness; equal to `profile` if empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub thickness_profile: Vec<[f64; 2]>,
    /// Place across the head (flat: −1 to 1 along the width; round: 0 to 1 from the middle), and the
    /// length of the bristles there as a share of the longest; all alike if empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tip: Vec<[f64; 2]>,
}

/// Arrangement of the spines in the ferrule.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Layout {
    /// One in the middle and a ring around it.
    #[default]
    Ring,
    /// A row along the width.
    Row,
    /// Each spine where its own chain puts it.
    Chains,
}

/// A spine of its own shape.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Chain {
    /// Root in the brush frame, mm.
    pub root_mm: [f64; 3],
    /// Segments at rest, from the ferrule to the point: the vector along each, mm.
    pub segments_mm: Vec<[f64; 3]>,
    /// Stiffness of the joint at the beginning of each segment, N·mm/rad.
    pub stiffness_n_mm: Vec<f64>,
    /// Inner friction of each joint, N·mm.
    pub damping_n_mm: Vec<f64>,
}

/// The spines, which bend.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spines {
    /// Arrangement of the spines in the ferrule.
    #[serde(default)]
    pub layout: Layout,
    /// Number of spines in the ring (beside the middle one) or the row.
    #[serde(default)]
    pub count: usize,
    /// Position of the outer ones, as a share of half the head's width and thickness.
    #[serde(default = "half")]
    pub share: f64,
    /// Number of joints of each.
    #[serde(default)]
    pub joints: usize,
    /// Bending stiffness EI of the whole head at the ferrule, N·mm².
    #[serde(default)]
    pub bending_stiffness_n_mm2: f64,
    /// Place along the head, and the stiffness there as a share of that at the ferrule.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub stiffness_profile: Vec<[f64; 2]>,
    /// Torque of a joint's inner friction as a share of its spring's torque at 1 rad.
    #[serde(default)]
    pub damping: f64,
    /// Factor on the inner friction of a soaked head: wet hair drags on hair.
    #[serde(default = "two", skip_serializing_if = "is_two")]
    pub damping_soaked: f64,
    /// Curl of the outer bristles toward the middle (outward if negative) at rest, from the ferrule to the point,
    /// degrees.
    #[serde(default)]
    pub curl_deg: f64,
    /// Stiffness with which spines keep their spacing at rest, as a multiple of the stiffness of a spine's point
    /// against a force across it.
    #[serde(default)]
    pub volume: f64,
    /// Stiffness of the bond between spines and the bend of the whole head, as a multiple of that of their joints:
    /// dry, and soaked.
    #[serde(default = "bond")]
    pub bond: [f64; 2],
    /// The spines of the layout `chains`.
    #[serde(default, rename = "chain", skip_serializing_if = "Vec::is_empty")]
    pub chains: Vec<Chain>,
}

fn half() -> f64 {
    0.5
}

fn bond() -> [f64; 2] {
    [0.1, 1.0]
}

impl Spines {
    /// Number of spines.
    #[must_use]
    pub fn number(&self) -> usize {
        match self.layout {
            Layout::Ring => self.count + 1,
            Layout::Row => self.count,
            Layout::Chains => self.chains.len(),
        }
    }

    /// Number of joints of all spines.
    #[must_use]
    pub fn all_joints(&self) -> usize {
        match self.layout {
            Layout::Chains => self.chains.iter().map(|c| c.segments_mm.len()).sum(),
            Layout::Ring | Layout::Row => self.number() * self.joints,
        }
    }
}

/// The bristle strips, which paint.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Strips {
    /// Number of strips.
    pub count: usize,
    /// Seed of their places and of how unruly each is.
    pub seed: u64,
    /// Width at the ferrule, mm.
    pub width_mm: f64,
    /// Thickness, mm.
    pub thickness_mm: f64,
    /// Share of the width that is lost up to the point.
    #[serde(default)]
    pub taper: f64,
    /// Height of the most unruly strip over the surface while the head is hardly pressed, mm.
    pub lift_mm: f64,
    /// Additional depth of the fully pressed head in the tooth, mm.
    pub sink_mm: f64,
    /// Width of the fully pressed point by that of the head.
    pub open: f64,
    /// Relative spread of the strips' paint capacity about the mean.
    pub unevenness: f64,
    /// Number of clumps in which the strips stick together; 0 for none.
    #[serde(default)]
    pub clumps: usize,
    /// Convergence of the points of a clump on a clean brush and on a full one, 0 to 1.
    #[serde(default)]
    pub clumping: [f64; 2],
    /// Number of the file's strips that one strip of a [thinned](super::BrushFile::thinned) head stands for; not in
    /// the file.
    #[serde(skip, default = "itself")]
    pub stands_for: f64,
}

const fn itself() -> f64 {
    1.0
}

/// The skin: a closed surface around the strips, which paints where they are close together.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Surface {
    /// Number of subdivisions of its control mesh (Catmull and Clark 1978).
    pub levels: usize,
    /// Distance by which the skin recedes within the strips as the head is pressed open, mm.
    pub recede_mm: f64,
    /// The control mesh; the head's own shape if empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub vertices_mm: Vec<[f64; 3]>,
    /// Faces of the control mesh: three or more vertices each, counterclockwise from outside.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faces: Vec<Vec<usize>>,
    /// Joints that move each vertex, counted through all spines from the first, with their weights.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub weights: Vec<Vec<(usize, f64)>>,
}

/// Friction of the bristles with the surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// Coefficient of friction while sliding.
    pub friction: f64,
    /// Coefficient of friction while sticking; as while sliding if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction_static: Option<f64>,
    /// C_η: the share of friction that a pulled bristle lacks.
    #[serde(default)]
    pub anisotropy: f64,
    /// k > 1: how sharply the missing friction is focused on the direction in which the bristle is pulled.
    #[serde(default = "two")]
    pub focus: f64,
}

fn two() -> f64 {
    2.0
}

#[allow(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde passes a reference"
)]
fn is_two(value: &f64) -> bool {
    *value == two()
}

/// Load of the head.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Load {
    /// Film on the strips of a freshly loaded head, µm.
    pub film_um: f64,
    /// Paint inside the strips, as the thickness of a film spread over them, µm.
    pub inside_um: f64,
}

/// Force on the hand.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Force {
    /// The five tuples of the piecewise cubic (Baxter 2004, fig. 8.2): depth as a fraction of the
    /// head's length along the surface's normal, force, N, and slope, N per such fraction. The first
    /// is no force at no depth, the first two are the compressive part, the fourth, at depth 1, is
    /// where the handle meets the surface.
    pub hermite: Vec<[f64; 3]>,
}
