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

use super::pose_error::LARGEST_VALUE;
pub use super::pose_error::{PoseError, PoseFault};

/// A number for all joints, or one for each.
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

/// The headings of a list of poses.
pub const HEADER: &str = "t,x,y,z,qx,qy,qz,qw";
const COLUMNS: [&str; 8] = ["t", "x", "y", "z", "qx", "qy", "qz", "qw"];
/// Tolerance of a quaternion's length about 1; beyond it the quaternion is rejected.
const NEARLY_UNIT: f64 = 1e-3;

/// Reads a list of poses: a table whose first line names the columns of [`HEADER`] in any order, then a line a pose, time
/// rising (s, m, unit quaternion).
///
/// # Errors
/// A [`PoseError`] with the line.
pub fn poses(text: &str) -> Result<Vec<TrialPose>, PoseError> {
    let table = Table::parse(text, HeadingLine::First)?;
    let line = table.first_line();
    let headless = |fault| PoseError { line, fault };
    if table.headings().is_empty() {
        return Err(headless(PoseFault::Empty));
    }
    let found = table.columns(COLUMNS);
    let found = found.map_err(|error| headless(PoseFault::Headings(error)))?;
    let mut places = [0; COLUMNS.len()];
    for ((place, found), name) in places.iter_mut().zip(found).zip(COLUMNS) {
        *place = found.ok_or_else(|| headless(PoseFault::Missing(name)))?;
    }
    let mut poses: Vec<TrialPose> = Vec::new();
    for row in table.rows() {
        let pose = pose(row, &places)?;
        if let Some(last) = poses.last().filter(|last| last.t >= pose.t) {
            let (line, fault) = (row.line(), PoseFault::Time(pose.t, last.t));
            return Err(PoseError { line, fault });
        }
        poses.push(pose);
    }
    if poses.is_empty() {
        return Err(headless(PoseFault::NoPoses));
    }
    Ok(poses)
}

fn pose(row: Row<'_>, places: &[usize; COLUMNS.len()]) -> Result<TrialPose, PoseError> {
    let line = row.line();
    let (cells, columns) = (row.len(), COLUMNS.len());
    if cells < columns {
        return Err(TableError::new(line, Fault::Narrow { cells, columns }).into());
    }
    let mut values = [0.0; COLUMNS.len()];
    for (value, place) in values.iter_mut().zip(places) {
        *value = row.number(*place)?;
    }
    let [t, x, y, z, qx, qy, qz, qw] = values;
    let rotation = DQuat::from_xyzw(qx, qy, qz, qw);
    let length = rotation.length();
    if (length - 1.0).abs() > NEARLY_UNIT {
        let fault = PoseFault::Length(length);
        return Err(PoseError { line, fault });
    }
    let far = [x, y, z].into_iter().map(f64::abs).fold(0.0, f64::max);
    if far > LARGEST_VALUE {
        let fault = PoseFault::Far(far);
        return Err(PoseError { line, fault });
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
    fn refuses_bad_fields() {
        let with = |more: &str| format!("{SPINE}{more}\n");
        for (text, field) in [
            (with("mue = 0.2"), "mue"),
            (with("damping_nm = 'none'"), "damping_nm"),
            ("lengths_m = [0.01]".to_owned(), "stiffness_nm_per_rad"),
        ] {
            let error = SpineFile::parse(&text).expect_err(field);
            assert!(matches!(error, BrushError::File(text) if text.contains(field)));
        }
    }

    /// Field and value of the error in a file.
    fn range(text: &str) -> (String, f64) {
        match SpineFile::parse(text).expect_err(text) {
            BrushError::Range { field, value, .. } => (field, value),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn refuses_out_of_range() {
        assert!(SpineFile::parse(SPINE).is_ok());
        for (more, field, value) in [
            ("mu = -0.1", "mu", -0.1),
            ("mu = 0.4\nmu_static = 0.3", "mu_static", 0.3),
            ("c_eta = 1.1", "c_eta", 1.1),
            ("k = 1.0", "k", 1.0),
            ("damping_nm = -1.0", "damping_nm", -1.0),
            ("damping_nm = [0.0, -1.0]", "damping_nm[1]", -1.0),
            ("damping_nm = [0.0]", "damping_nm (number)", 1.0),
        ] {
            let found = range(&format!("{SPINE}{more}\n"));
            assert_eq!(found, (field.to_owned(), value), "{more}");
        }
        let (field, value) = range(&format!("{SPINE}mu = nan\n"));
        assert!(field == "mu" && value.is_nan());
        for (from, to, field, value) in [
            ("0.008", "0.0", "lengths_m[1]", 0.0),
            ("0.008", "-0.008", "lengths_m[1]", -0.008),
            ("0.008", "inf", "lengths_m[1]", f64::INFINITY),
            ("1e-4", "-1e-4", "stiffness_nm_per_rad[1]", -1e-4),
            (", 1e-4", "", "stiffness_nm_per_rad (number)", 1.0),
            ("0.01, 0.008", "", "lengths_m (number)", 0.0),
        ] {
            let found = range(&SPINE.replace(from, to));
            assert_eq!(found, (field.to_owned(), value), "{to}");
        }
    }

    #[test]
    fn most_joints() {
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
        assert_eq!(range(&many(65)), ("lengths_m (number)".to_owned(), 65.0));
    }

    #[test]
    fn bad_poses_have_their_line() {
        let error = |text: &str, line: usize, fault: PoseFault| {
            assert_eq!(poses(text), Err(PoseError { line, fault }), "{text}");
        };
        let row = |rows: &str, line: usize, fault: PoseFault| {
            error(&format!("{HEADER}\n{rows}\n"), line, fault);
        };
        let one = format!("{HEADER}\n0,0,0,1,0,0,0,1\n\n");
        assert_eq!(poses(&one).map(|poses| poses.len()), Ok(1));
        error("", 1, PoseFault::Empty);
        let headless = poses("0,0,0,1,0,0,0,1\n").expect_err("no headings");
        assert!(headless.line == 1 && matches!(headless.fault, PoseFault::Headings(_)));
        error(HEADER, 1, PoseFault::NoPoses);
        let columns = COLUMNS.len();
        let narrow = TableError::new(2, Fault::Narrow { cells: 7, columns });
        row("0,0,0,1,0,0,0", 2, PoseFault::Row(narrow));
        let wide = TableError {
            column: Some(9),
            ..TableError::new(2, Fault::Wide { cells: 9, columns })
        };
        row("0,0,0,1,0,0,0,1,2", 2, PoseFault::Row(wide));
        let same_time = "0,0,0,1,0,0,0,1\n0,0,0,1,0,0,0,1";
        row(same_time, 3, PoseFault::Time(0.0, 0.0));
        row("0,0,0,1,0,0,0,0.9", 2, PoseFault::Length(0.9));
        row("0,0,0,1e10,0,0,0,1", 2, PoseFault::Far(1e10));
    }

    #[test]
    fn bad_numbers_have_their_column() {
        let cell = |rows: &str, line: usize, (column, heading): (usize, &str), fault: Fault| {
            let error = TableError {
                line,
                column: Some(column),
                heading: heading.to_owned(),
                fault,
            };
            let text = format!("{HEADER}\n{rows}\n");
            assert_eq!(poses(&text), Err(error.into()), "{rows}");
        };
        let text = |cell: &str| cell.to_owned();
        let word = Fault::NotANumber { cell: text("a") };
        cell("0,0,0,a,0,0,0,1", 2, (4, "z"), word);
        let nan = Fault::NotFinite { cell: text("nan") };
        cell("0,0,0,1,0,0,0,1\n1,nan,0,1,0,0,0,1", 3, (2, "x"), nan);
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
