//! A single spine without a head: a spine file, a list of poses, and the solver's results.
//!
//! Texts come in, rows go out; `maulstick brush solve` is the command around it.
//!
//! ```toml
//! lengths_m = [0.01, 0.008, 0.007]              # of the segments, from the ferrule to the point
//! stiffness_nm_per_rad = [3e-4, 1.2e-4, 8e-5]   # of the joint at the beginning of each, as it is
//! damping_nm = [0.0, 0.0, 0.0]                  # inner friction of each; a number is that of all
//! mu = 0.25                                     # friction with the surface while sliding
//! mu_static = 0.32                              # while sticking; as mu if absent
//! c_eta = 0.3                                   # share of friction that a pulled bristle lacks
//! k = 2.0                                       # how sharply that is focused
//! ```

use glam::{DQuat, DVec3};
use maulstick_num::geometry::Rigid;
use maulstick_tables::{Fault, HeadingLine, Row, Table, TableError};
use serde::{Deserialize, Serialize};

use crate::energy::friction::Anisotropy;
use crate::file::BrushError;
use crate::file::check::{MOST_JOINTS, within};
use crate::solver::{ContactConstraint, Energy, Settings, Solver};
use crate::spine::{Spine, SpineShape};

/// One number for all joints, or one for each.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    untagged,
    expecting = "damping_nm is a number for all joints, or a list with one for each"
)]
pub enum Each {
    /// The number of all joints.
    All(f64),
    /// A number for each joint.
    List(Vec<f64>),
}

/// A spine and its contact with the surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpineFile {
    /// Lengths of the segments from the ferrule to the point, m.
    pub lengths_m: Vec<f64>,
    /// Stiffness of the joint at the beginning of each segment, N·m/rad, used as it is.
    pub stiffness_nm_per_rad: Vec<f64>,
    /// Inner friction of each joint, N·m.
    #[serde(default = "none")]
    pub damping_nm: Each,
    /// Coefficient of friction while sliding.
    #[serde(default = "quarter")]
    pub mu: f64,
    /// Coefficient of friction while sticking; as while sliding if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mu_static: Option<f64>,
    /// C_η (Baxter 2004, eq. 3.14): the share of friction that a pulled bristle lacks.
    #[serde(default)]
    pub c_eta: f64,
    /// k of the same equation: how sharply the missing friction is focused on the direction in which the bristle is
    /// pulled.
    #[serde(default = "two")]
    pub k: f64,
}

fn none() -> Each {
    Each::All(0.0)
}

fn quarter() -> f64 {
    0.25
}

fn two() -> f64 {
    2.0
}

/// Least value of lengths and stiffness, so that floating point can square them.
const SMALLEST_VALUE: f64 = 1e-12;
const LARGEST_VALUE: f64 = 1e9;

impl SpineFile {
    /// Reads a spine file.
    ///
    /// # Errors
    /// [`BrushError::File`] with the line, or [`BrushError::Range`] with the field.
    pub fn parse(text: &str) -> Result<Self, BrushError> {
        let file: Self = toml::from_str(text)
            .map_err(|error| BrushError::File(error.to_string().trim_end().to_owned()))?;
        file.check()?;
        Ok(file)
    }

    /// Checks all numbers.
    ///
    /// # Errors
    /// [`BrushError::Range`] with the field.
    pub fn check(&self) -> Result<(), BrushError> {
        let joints = self.lengths_m.len();
        within(
            "lengths_m (number)",
            joints as f64,
            1.0..=MOST_JOINTS as f64,
        )?;
        one_each(
            "stiffness_nm_per_rad",
            self.stiffness_nm_per_rad.len(),
            joints,
        )?;
        each("lengths_m", &self.lengths_m, positive)?;
        each("stiffness_nm_per_rad", &self.stiffness_nm_per_rad, positive)?;
        let friction = |field: &str, value: f64| within(field, value, 0.0..=LARGEST_VALUE);
        match &self.damping_nm {
            Each::All(value) => friction("damping_nm", *value)?,
            Each::List(values) => {
                one_each("damping_nm", values.len(), joints)?;
                each("damping_nm", values, friction)?;
            }
        }
        within("mu", self.mu, 0.0..=10.0)?;
        if let Some(sticking) = self.mu_static {
            within("mu_static", sticking, self.mu..=10.0)?;
        }
        within("c_eta", self.c_eta, 0.0..=1.0)?;
        within("k", self.k, 1.01..=100.0)
    }

    /// The spine, straight at rest.
    #[must_use]
    pub fn spine(&self) -> Spine {
        Spine {
            damping: match &self.damping_nm {
                Each::All(value) => vec![*value; self.lengths_m.len()],
                Each::List(values) => values.clone(),
            },
            lengths_m: self.lengths_m.clone(),
            stiffness: self.stiffness_nm_per_rad.clone(),
            rest: Vec::new(),
        }
    }

    /// Its friction with the surface.
    #[must_use]
    pub fn settings(&self) -> Settings {
        Settings {
            friction: self.mu,
            friction_static: self.mu_static.unwrap_or(self.mu),
            anisotropy: Anisotropy {
                share: self.c_eta,
                focus: self.k,
                ..Anisotropy::default()
            },
            ..Settings::for_length(self.lengths_m.iter().sum())
        }
    }
}

fn positive(field: &str, value: f64) -> Result<(), BrushError> {
    if (SMALLEST_VALUE..=LARGEST_VALUE).contains(&value) {
        return Ok(());
    }
    Err(BrushError::Range {
        field: field.to_owned(),
        value,
        range: format!("above 0 ({SMALLEST_VALUE:e} to {LARGEST_VALUE:e})"),
    })
}

/// Checks all values of a list.
fn each(
    field: &str,
    values: &[f64],
    check: impl Fn(&str, f64) -> Result<(), BrushError>,
) -> Result<(), BrushError> {
    let mut numbered = values.iter().enumerate();
    numbered.try_for_each(|(i, value)| check(&format!("{field}[{i}]"), *value))
}

fn one_each(field: &str, number: usize, joints: usize) -> Result<(), BrushError> {
    if number == joints {
        return Ok(());
    }
    Err(BrushError::Range {
        field: format!("{field} (number)"),
        value: number as f64,
        range: format!("one for each of {joints} joints"),
    })
}

/// Pose of the ferrule at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrialPose {
    /// Time, s.
    pub t: f64,
    /// Brush frame to surface frame: the spine begins at the origin of the brush frame and rests along its −z, above
    /// the plane z = 0 of the surface frame.
    pub brush: Rigid,
}

/// Error in a list of poses.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{what}")]
pub struct PoseError {
    /// Line in the text, from 1.
    pub line: usize,
    /// Description of the error.
    pub what: String,
    /// Remedy.
    pub help: &'static str,
}

/// The headings of a list of poses.
pub const HEADER: &str = "t,x,y,z,qx,qy,qz,qw";
const COLUMNS: [&str; 8] = ["t", "x", "y", "z", "qx", "qy", "qz", "qw"];
/// Tolerance of a quaternion's length about 1; beyond it the quaternion is rejected.
const NEARLY_UNIT: f64 = 1e-3;

impl From<TableError> for PoseError {
    fn from(error: TableError) -> Self {
        Self {
            line: error.line,
            what: error.what(),
            help: match error.fault {
                Fault::Narrow { .. } | Fault::Wide { .. } => {
                    "each line after the headings is a pose: t,x,y,z,qx,qy,qz,qw"
                }
                Fault::NotFinite { .. } => "leave out poses that are not known",
                other => other.help(),
            },
        }
    }
}

/// Reads a list of poses: a table whose first line names the columns of [`HEADER`] in any order, then a line a pose, time
/// rising (s, m, unit quaternion).
///
/// # Errors
/// A [`PoseError`] with the line.
pub fn poses(text: &str) -> Result<Vec<TrialPose>, PoseError> {
    let table = Table::parse(text, HeadingLine::First)?;
    let headless = |what: String| PoseError {
        line: table.first_line(),
        what,
        help: "the first line is: t,x,y,z,qx,qy,qz,qw",
    };
    if table.headings().is_empty() {
        return Err(headless("the file is empty".to_owned()));
    }
    let found = table.columns(COLUMNS);
    let found = found.map_err(|error| headless(error.what()))?;
    let mut places = [0; COLUMNS.len()];
    for ((place, found), name) in places.iter_mut().zip(found).zip(COLUMNS) {
        *place = found.ok_or_else(|| headless(format!("the column '{name}' is missing")))?;
    }
    let mut poses: Vec<TrialPose> = Vec::new();
    for row in table.rows() {
        let pose = pose(row, &places)?;
        if let Some(last) = poses.last().filter(|last| last.t >= pose.t) {
            return Err(PoseError {
                line: row.line(),
                what: format!("time does not rise: {} s after {} s", pose.t, last.t),
                help: "sort the poses by time",
            });
        }
        poses.push(pose);
    }
    if poses.is_empty() {
        return Err(PoseError {
            line: table.first_line(),
            what: "there are no poses".to_owned(),
            help: "each line after the headings is a pose: t,x,y,z,qx,qy,qz,qw",
        });
    }
    Ok(poses)
}

fn pose(row: Row<'_>, places: &[usize; COLUMNS.len()]) -> Result<TrialPose, PoseError> {
    let wrong = |what: String, help: &'static str| PoseError {
        line: row.line(),
        what,
        help,
    };
    let (cells, columns) = (row.len(), COLUMNS.len());
    if cells < columns {
        return Err(TableError::new(row.line(), Fault::Narrow { cells, columns }).into());
    }
    let mut values = [0.0; COLUMNS.len()];
    for (value, place) in values.iter_mut().zip(places) {
        *value = row.number(*place)?;
    }
    let [t, x, y, z, qx, qy, qz, qw] = values;
    let rotation = DQuat::from_xyzw(qx, qy, qz, qw);
    let length = rotation.length();
    if (length - 1.0).abs() > NEARLY_UNIT {
        let what = format!("qx,qy,qz,qw has the length {length}, not 1");
        return Err(wrong(what, "a rotation is a unit quaternion, w last"));
    }
    let far = [x, y, z].into_iter().map(f64::abs).fold(0.0, f64::max);
    if far > LARGEST_VALUE {
        let what = format!("x,y,z: {far} m is farther than {LARGEST_VALUE} m");
        return Err(wrong(what, "lengths are in metres"));
    }
    Ok(TrialPose {
        t,
        brush: Rigid {
            rotation: rotation.normalize(),
            translation: DVec3::new(x, y, z),
        },
    })
}

/// Solved spine at a pose.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TrialRow {
    /// Time of the pose, s.
    pub t: f64,
    /// The far end of each segment in the surface frame, m: the tip last, the root left out.
    pub joints: Vec<[f64; 3]>,
    /// θ of each joint (Baxter 2004, eq. 3.10), rad.
    pub theta: Vec<f64>,
    /// φ of each joint, rad.
    pub phi: Vec<f64>,
    /// Contributions to the energy, J.
    pub energy: TrialEnergy,
    /// Deepest joint below the surface, m.
    pub penetration_m: f64,
    /// ‖∇L‖∞ by the stiffness of the stiffest joint.
    pub residual: f64,
    /// Number of Newton steps.
    pub iterations: usize,
    /// True if the solver reached its tolerance; if not, the spine kept its shape.
    pub converged: bool,
}

/// Contributions to the energy, J.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TrialEnergy {
    /// Energy of the springs.
    pub spring: f64,
    /// Work against friction with the surface.
    pub friction: f64,
    /// Work against friction in the joints.
    pub damping: f64,
    /// Sum of all contributions.
    pub total: f64,
}

impl From<Energy> for TrialEnergy {
    fn from(energy: Energy) -> Self {
        Self {
            spring: energy.spring,
            friction: energy.friction,
            damping: energy.damping,
            total: energy.total(),
        }
    }
}

/// Bends a spine through the poses: it starts straight and without friction at the first, and at each other one with
/// the bend of the one before.
#[must_use]
pub fn follow(file: &SpineFile, poses: &[TrialPose]) -> Vec<TrialRow> {
    let (spine, settings) = (file.spine(), file.settings());
    let Some(first) = poses.first() else {
        return Vec::new();
    };
    let mut solver = Solver::default();
    let mut constraints = ContactConstraint::on_surface(spine.joints());
    let Rigid {
        rotation,
        translation,
    } = first.brush;
    let mut shape = SpineShape::straight(translation, rotation, spine.joints());
    let mut ends = Vec::new();
    let mut row = |pose: &TrialPose| {
        shape.carry(pose.brush.translation, pose.brush.rotation);
        let solution = solver.solve(&spine, &mut shape, &mut constraints, &[], &settings);
        shape.joints(&spine, &mut ends);
        let (theta, phi) = shape
            .exact_angles()
            .map(|[theta, phi]| (theta, phi))
            .unzip();
        TrialRow {
            t: pose.t,
            joints: ends.iter().map(DVec3::to_array).collect(),
            theta,
            phi,
            energy: solution.energy.into(),
            penetration_m: solution.penetration_m,
            residual: solution.residual / spine.stiffest(),
            iterations: solution.iterations,
            converged: solution.converged,
        }
    };
    poses.iter().map(&mut row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPINE: &str = "lengths_m = [0.01, 0.008]\nstiffness_nm_per_rad = [3e-4, 1e-4]\n";

    #[test]
    fn bad_spines_name_their_field() {
        let error = |text: &str| {
            let error = SpineFile::parse(text).expect_err(text);
            error.to_string()
        };
        let with = |more: &str| error(&format!("{SPINE}{more}\n"));
        assert!(SpineFile::parse(SPINE).is_ok());
        assert!(with("mue = 0.2").contains("mue"));
        assert!(with("mu = -0.1").contains("mu is -0.1"));
        assert!(with("mu = nan").contains("mu is NaN"));
        assert!(with("mu = 0.4\nmu_static = 0.3").contains("mu_static is 0.3"));
        assert!(with("c_eta = 1.1").contains("c_eta is 1.1"));
        assert!(with("k = 1.0").contains("k is 1,"));
        assert!(with("damping_nm = -1.0").contains("damping_nm is -1"));
        assert!(with("damping_nm = [0.0, -1.0]").contains("damping_nm[1] is -1"));
        assert!(with("damping_nm = [0.0]").contains("damping_nm (number) is 1"));
        assert!(with("damping_nm = 'none'").contains("damping_nm is a number for all joints"));
        let swap = |from: &str, to: &str| error(&SPINE.replace(from, to));
        assert!(swap("0.008", "0.0").contains("lengths_m[1] is 0, but must be above 0"));
        assert!(swap("0.008", "-0.008").contains("lengths_m[1] is -0.008"));
        assert!(swap("0.008", "inf").contains("lengths_m[1] is inf"));
        assert!(swap("1e-4", "-1e-4").contains("stiffness_nm_per_rad[1] is -0.0001"));
        assert!(swap(", 1e-4", "").contains("stiffness_nm_per_rad (number) is 1"));
        assert!(swap("0.01, 0.008", "").contains("lengths_m (number) is 0"));
        assert!(error("lengths_m = [0.01]").contains("stiffness_nm_per_rad"));
        let many = |n: usize| {
            let list = |value: f64| format!("{:?}", vec![value; n]);
            format!(
                "lengths_m = {}\nstiffness_nm_per_rad = {}\n",
                list(0.001),
                list(1e-4)
            )
        };
        for n in [1, MOST_JOINTS] {
            assert!(SpineFile::parse(&many(n)).is_ok(), "{n}");
        }
        assert!(error(&many(65)).contains("lengths_m (number) is 65"));
    }

    #[test]
    fn bad_poses_name_their_line() {
        let error = |text: &str| {
            let error = poses(text).expect_err(text);
            (error.line, error.what)
        };
        let rows = |rows: &str| error(&format!("{HEADER}\n{rows}\n"));
        let says = |(line, what): (usize, String), at: usize, words: &str| {
            assert!(line == at && what.contains(words), "{line}: {what}");
        };
        assert_eq!(
            poses(&format!("{HEADER}\n0,0,0,1,0,0,0,1\n\n")).map(|p| p.len()),
            Ok(1)
        );
        says(error(""), 1, "empty");
        says(error("0,0,0,1,0,0,0,1\n"), 1, "column 1");
        says(error(HEADER), 1, "no poses");
        says(rows("0,0,0,1,0,0,0"), 2, "7 columns");
        says(rows("0,0,0,1,0,0,0,1,2"), 2, "9 columns");
        says(rows("0,0,0,a,0,0,0,1"), 2, "(z): 'a' is not a number");
        says(
            rows("0,0,0,1,0,0,0,1\n1,nan,0,1,0,0,0,1"),
            3,
            "(x): 'nan' is not finite",
        );
        says(
            rows("0,0,0,1,0,0,0,1\n0,0,0,1,0,0,0,1"),
            3,
            "time does not rise",
        );
        says(rows("0,0,0,1,0,0,0,0.9"), 2, "length 0.9");
        says(rows("0,0,0,1e10,0,0,0,1"), 2, "farther");
    }

    #[test]
    fn a_spine_follows_its_poses() {
        let file = SpineFile::parse(SPINE).expect("a spine");
        let text = format!(
            "{HEADER}\n0,0,0,0.02,0,0,0,1\n0.1,0,0,0.012,0,0.1,0,0.995\n0.2,0.004,0,0.012,0,0.1,0,0.995\n"
        );
        let rows = follow(&file, &poses(&text).expect("poses"));
        assert_eq!(rows.len(), 3);
        assert!(rows.iter().all(|row| row.converged && row.residual <= 1e-6));
        let tip = |row: &TrialRow| row.joints[1];
        assert!((tip(&rows[0])[2] - 0.002).abs() < 1e-12 && rows[0].energy.total < 1e-15);
        for row in &rows[1..] {
            assert!(tip(row)[2].abs() <= 1e-6 * 0.018 && row.penetration_m <= 1e-6 * 0.018);
            assert!(row.energy.spring > 0.0 && row.theta.len() == 2 && row.phi.len() == 2);
        }
        // The first touch has no friction yet, the stroke after it has.
        assert_eq!(rows[1].energy.friction, 0.0);
        assert!(rows[2].energy.friction > 0.0);
    }
}
