//! `maulstick device force`: the force that a brush gives to the hand, by depth and angle.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use glam::{DQuat, DVec3};
use maulstick_brush::BrushFile;
use maulstick_brush::head_stiffness::{press, tuples};
use maulstick_haptics::Contact;
use maulstick_haptics::contact::HandleState;
use maulstick_num::cos;
use maulstick_num::geometry::rotation;
use maulstick_rig::UserError;
use maulstick_rig::config::BrushSection;
use maulstick_rig::files::Kind;
use maulstick_types::haptics::{ContactModel, ForceLaw};
use serde_json::json;

use maulstick_painting_setup::brush_file;
use maulstick_painting_setup::outputs::{UsedFile, check_outputs};

use crate::commands::force_order::{Order, give};
use crate::commands::option_error::{OptionError, number_within};
use crate::commands::{print_text, write_picture};
use crate::plot::{Axis, Curve, Panel, from_zero, plot};

/// A law of force.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Model {
    /// No force
    None,
    /// Two straight pieces (Baxter 2004, eq. 8.1), which end where the brush file's curve ends
    Linear,
    /// The brush file's piecewise cubic (fig. 8.2); its first touch depends on the angle (eq. 8.2)
    Hermite,
    /// The solved head, linearised where it is
    Local,
    /// A hard wall
    Rigid,
}

impl Model {
    fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Linear => "linear",
            Self::Hermite => "hermite",
            Self::Local => "local",
            Self::Rigid => "rigid",
        }
    }
}

/// Options of `maulstick device force`.
#[derive(Args, Clone, Debug)]
#[command(args_conflicts_with_subcommands = true)]
pub struct ForceOptions {
    #[command(subcommand)]
    order: Option<Order>,
    /// Force law
    #[arg(long, default_value = "hermite")]
    model: Model,
    /// Brush of the library, or a brush file
    #[arg(long, default_value = "round")]
    brush: String,
    /// Width of the head, mm [default: that of its file]
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    size_mm: Option<f64>,
    /// Depths of the undeformed tip below the canvas, mm: FROM..TO in steps of .5, or a list
    #[arg(long, value_name = "DEPTHS", default_value = "0..40", value_parser = depths)]
    depth_mm: List,
    /// Angles between the handle and the canvas normal, degrees, a list
    #[arg(long, value_name = "ANGLES", default_value = "0,15,30,45", value_parser = angles)]
    angle_deg: List,
    /// Stiffness of the hard wall, N/m [default: 500]
    #[arg(long, value_name = "N/M", value_parser = stiffness)]
    stiffness_n_m: Option<f64>,
    /// Largest stiffness that the device bears, N/m
    #[arg(long, value_name = "N/M", default_value_t = 500.0, value_parser = stiffness)]
    max_stiffness_n_m: f64,
    /// Print JSON, one line for each depth at each angle
    #[arg(long)]
    json: bool,
    /// Picture of the curves to write, a PNG
    #[arg(long, value_name = "PNG")]
    plot: Option<PathBuf>,
}

/// Numbers of an option.
#[derive(Clone, Debug, PartialEq)]
struct List(Vec<f64>);

/// Step of a range of depths, mm.
const STEP_MM: f64 = 0.5;
/// Default stiffness of a wall, N/m.
const WALL_N_M: f64 = 500.0;
/// Depths of any brush, mm.
const DEEPEST_MM: f64 = 1000.0;
/// Flattest pose of a brush for which its head is solved, degrees.
const FLATTEST_SOLVED: f64 = 80.0;

fn numbers(text: &str, within: impl Fn(f64) -> bool, expected: &str) -> Result<List, OptionError> {
    let wrong = || OptionError::unexpected(text, expected);
    let one = |part: &str| {
        part.trim()
            .parse()
            .ok()
            .filter(|value: &f64| within(*value))
    };
    let list: Option<Vec<f64>> = text.split(',').map(one).collect();
    list.map(List).ok_or_else(wrong)
}

fn depths(text: &str) -> Result<List, OptionError> {
    let what = "depths from 0 to 1000 mm, such as 0..40 or 0,5,10";
    let within = |mm: f64| (0.0..=DEEPEST_MM).contains(&mm);
    let Some((from, to)) = text.split_once("..") else {
        // A head is pressed down, and a curve has one force at a depth.
        return numbers(text, within, what).map(|List(mut depths)| {
            depths.sort_by(f64::total_cmp);
            depths.dedup();
            List(depths)
        });
    };
    let (from, to) = (numbers(from, within, what)?, numbers(to, within, what)?);
    match (from.0.as_slice(), to.0.as_slice()) {
        ([from], [to]) if from < to => {
            let steps = ((to - from) / STEP_MM - 1e-9).ceil() as usize;
            let place = |i: usize| (from + STEP_MM * i as f64).min(*to);
            Ok(List((0..=steps).map(place).collect()))
        }
        ([_], [_]) => Err(OptionError::Backwards(text.to_owned())),
        _ => Err(OptionError::unexpected(text, what)),
    }
}

fn angles(text: &str) -> Result<List, OptionError> {
    let within = |degrees: f64| (0.0..=90.0).contains(&degrees);
    numbers(
        text,
        within,
        "angles from 0 to 90 degrees, such as 0,15,30,45",
    )
}

fn stiffness(text: &str) -> Result<f64, OptionError> {
    number_within(text, 0.0..=1e6, "stiffness in N/m")
}

/// The force at a depth.
struct Row {
    depth_m: f64,
    angle_rad: f64,
    force_n: f64,
    stiffness_n_m: f64,
}

/// Prints and draws the force by depth and angle.
///
/// # Errors
/// A [`UserError`] for a bad brush file or a picture that cannot be written; for an order where no device of
/// a rig takes it.
pub fn run(options: &ForceOptions) -> Result<i32, UserError> {
    if let Some(order) = &options.order {
        return give(order);
    }
    if options.stiffness_n_m.is_some() && options.model != Model::Rigid {
        let what = format!(
            "--stiffness-n-m does nothing beside --model {}",
            options.model.name()
        );
        return Err(UserError::usage(what)
            .help("it is the hard wall's: --model rigid; --max-stiffness-n-m bounds any model"));
    }
    let plot_file = UsedFile::written("the plot", options.plot.as_ref(), Kind::Png);
    let brush = UsedFile::named("the brush", &options.brush);
    check_outputs(plot_file.as_slice(), brush.as_slice())?;
    let file = brush_file(&BrushSection {
        name: "main".into(),
        kind: options.brush.clone(),
        size_mm: options.size_mm,
        depth_share: 0.0,
    })?;
    let angles = options.angle_deg.0.iter();
    let curves: Vec<Vec<Row>> = angles
        .map(|degrees| rows(options, &file, *degrees))
        .collect::<Result<_, _>>()?;
    let mut text = String::new();
    if !options.json {
        text += "   depth  angle    force  stiffness\n      mm      °        N        N/m\n";
    }
    for row in curves.iter().flatten() {
        text += &if options.json {
            let row = json!({
                "depth_m": row.depth_m,
                "angle_rad": row.angle_rad,
                "force_n": row.force_n,
                "stiffness_n_per_m": row.stiffness_n_m,
            });
            format!("{row}\n")
        } else {
            format!(
                "{:>8.2} {:>6.1} {:>8.4} {:>10.2}\n",
                row.depth_m * 1e3,
                row.angle_rad.to_degrees(),
                row.force_n,
                row.stiffness_n_m
            )
        };
    }
    if let Some(path) = &options.plot {
        write_picture(&plot(&panels(options, &curves))?, path)?;
    }
    print_text(&text)?;
    Ok(0)
}

fn panels(options: &ForceOptions, curves: &[Vec<Row>]) -> [Panel; 2] {
    let all = || curves.iter().flatten();
    let x = Axis {
        label: "depth of the undeformed point (mm)".into(),
        range: from_zero(all().map(|row| row.depth_m * 1e3)),
    };
    let panel = |title: String, label: &str, value: fn(&Row) -> f64| Panel {
        title,
        x: x.clone(),
        y: Axis {
            label: label.into(),
            range: from_zero(all().map(value)),
        },
        curves: (options.angle_deg.0.iter().zip(curves))
            .map(|(degrees, rows)| Curve {
                name: format!("{degrees}°"),
                points: rows.iter().map(|r| [r.depth_m * 1e3, value(r)]).collect(),
            })
            .collect(),
    };
    let name = format!("{}, {}", options.brush, options.model.name());
    [
        panel(format!("{name}: normal force"), "force (N)", |row| {
            row.force_n
        }),
        panel(format!("{name}: stiffness"), "stiffness (N/m)", |row| {
            row.stiffness_n_m
        }),
    ]
}

/// The force at each depth of a brush that leans by an angle, as a servo evaluates it.
fn rows(options: &ForceOptions, file: &BrushFile, degrees: f64) -> Result<Vec<Row>, UserError> {
    let (angle, length) = (degrees.to_radians(), file.length_m());
    let depths: Vec<f64> = options.depth_mm.0.iter().map(|mm| mm * 1e-3).collect();
    let lean = rotation(DVec3::Y, angle);
    let knots = tuples(file);
    let law = match options.model {
        Model::None => ForceLaw::None,
        Model::Linear => ForceLaw::Linear {
            k1_n: knots[3].force_n,
            k2_n: knots[4].slope_n,
        },
        Model::Hermite => ForceLaw::Hermite { knots },
        Model::Rigid => ForceLaw::Rigid {
            stiffness_n_m: options.stiffness_n_m.unwrap_or(WALL_N_M),
        },
        Model::Local => return solved(options, file, degrees, &depths),
    };
    let contact = contact(file, law)?;
    Ok(depths
        .into_iter()
        .map(|depth| {
            let height = length * cos(angle) - depth;
            let force = contact.evaluate(&still(lean, height), options.max_stiffness_n_m);
            row(depth, angle, &force)
        })
        .collect())
}

/// The same of the solved head: a model for each depth.
fn solved(
    options: &ForceOptions,
    file: &BrushFile,
    degrees: f64,
    depths: &[f64],
) -> Result<Vec<Row>, UserError> {
    if degrees > FLATTEST_SOLVED {
        return Err(
            UserError::usage(format!("a head is not solved at {degrees}°"))
                .at("--angle-deg")
                .help(format!("hold it at {FLATTEST_SOLVED}° or steeper")),
        );
    }
    let angle = degrees.to_radians();
    let (lean, length) = (rotation(DVec3::Y, angle), file.length_m());
    let pressed = press(file, angle, depths);
    let rows = depths.iter().zip(pressed).map(|(depth, press)| {
        let k = press.stiffness_n_m;
        let law = ForceLaw::Local {
            pose: press.pose.to_pose(),
            force_n: [0.0, 0.0, press.force_n],
            stiffness_n_m: [[0.0; 3], [0.0; 3], [0.0, 0.0, -k]],
        };
        let handle = still(lean, length * cos(angle) - depth);
        Ok(row(
            *depth,
            angle,
            &contact(file, law)?.evaluate(&handle, options.max_stiffness_n_m),
        ))
    });
    rows.collect()
}

fn still(orientation: DQuat, height_m: f64) -> HandleState {
    HandleState {
        position: DVec3::Z * height_m,
        orientation,
        velocity: DVec3::ZERO,
    }
}

fn row(depth_m: f64, angle_rad: f64, contact: &maulstick_haptics::ContactForce) -> Row {
    Row {
        depth_m,
        angle_rad,
        force_n: contact.force.z,
        stiffness_n_m: contact.stiffness_n_m,
    }
}

/// A model over the plane z = 0.
fn contact(file: &BrushFile, law: ForceLaw) -> Result<Contact, UserError> {
    let model = ContactModel::bare(law, file.length_m());
    Contact::new(&model).map_err(UserError::failure)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depths_and_angles_are_read_or_refused() {
        let list = |text| depths(text).map(|list| list.0);
        assert_eq!(list("0..1.2"), Ok(vec![0.0, 0.5, 1.0, 1.2]));
        assert_eq!(list("0..40").map(|list| list.len()), Ok(81));
        assert_eq!(list("3, 1.5, 3"), Ok(vec![1.5, 3.0]));
        let backwards = OptionError::Backwards("5..5".into());
        assert_eq!(list("5..5"), Err(backwards));
        for text in [
            "", "5..1", "1..", "0..1..2", "-1..2", "0..nan", "0..2000", "0,,1",
        ] {
            assert!(list(text).is_err(), "{text}");
        }
        assert_eq!(angles("0,45"), Ok(List(vec![0.0, 45.0])));
        for text in ["", "-1", "91", "x"] {
            assert!(angles(text).is_err(), "{text}");
        }
    }
}
