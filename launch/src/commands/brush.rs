//! `maulstick brush`: the brushes of the library, and trials of a single spine.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use maulstick_brush::file::library::LIBRARY;
use maulstick_brush::single_spine::{SpineFile, TrialPose, TrialRow, follow, poses};
use maulstick_brush::{BrushError, BrushFile};
use maulstick_device::read_brush;
use maulstick_rig::UserError;
use maulstick_rig::config::BrushSection;
use maulstick_rig::config::toml_fault;
use maulstick_rig::files::{Kind, write_whole};
use maulstick_rig::table_file::{MOST_BYTES, read_table};
use maulstick_types::command::advice::Advice;
use maulstick_types::values::{BrushName, BrushToml};
use serde_json::json;

use maulstick_painting_setup::outputs::{UsedFile, check_outputs};
use maulstick_painting_setup::{brush_file, of_a_brush};

use crate::commands::client::{Client, Target};
use crate::commands::edit::{self, BrushEdit};
use crate::commands::say;
use crate::commands::{print_json, print_text};

/// `maulstick brush`.
#[derive(Subcommand, Clone, Debug)]
pub enum BrushCommand {
    /// List the brushes of the library
    List(ListOptions),
    /// Convert a brush modelled in Blender to a brush file
    Import(ImportOptions),
    /// Take another brush in hand
    Take(TakeOptions),
    /// An edit
    #[command(flatten)]
    Edit(BrushEdit),
    /// Bend one spine through a list of poses above the plane z = 0
    ///
    /// SPINE.toml has `lengths_m` and `stiffness_nm_per_rad` (lists from ferrule to tip, 1 to 64
    /// joints, used as given) and optionally `damping_nm` (a number or a list), `mu`, `mu_static`,
    /// `c_eta` and `k`. POSES.csv has the header t,x,y,z,qx,qy,qz,qw (s, m, unit quaternion from the
    /// brush frame to the surface frame) and one pose per line. An unbent spine runs from the pose's
    /// origin along the brush's −z. It reaches the first pose straight and without friction, and each
    /// later pose from the shape it had before.
    ///
    /// With --json, one line per pose: `joints` are the far ends of the segments (m, tip last, without
    /// the root), `theta` and `phi` the joint angles (rad), `energy` is in J, `residual` is the largest
    /// gradient of the Lagrangian over the stiffness of the stiffest joint.
    Solve(SolveOptions),
}

/// Options of `maulstick brush list`.
#[derive(Args, Clone, Debug)]
pub struct ListOptions {
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Options of `maulstick brush solve`.
#[derive(Args, Clone, Debug)]
pub struct SolveOptions {
    /// Spine file
    #[arg(long, value_name = "SPINE.toml")]
    spine: PathBuf,
    /// Poses of the handle
    #[arg(long, value_name = "POSES.csv")]
    poses: PathBuf,
    /// Print JSON, one line per pose
    #[arg(long)]
    json: bool,
}

/// Options of `maulstick brush import`.
#[derive(Args, Clone, Debug)]
pub struct ImportOptions {
    /// Model, glTF 2.0
    #[arg(value_name = "MODEL.glb")]
    model: PathBuf,
    /// Brush file to write
    #[arg(short, long, value_name = "TOML")]
    output: PathBuf,
}

/// Options of `maulstick brush take`.
#[derive(Args, Clone, Debug)]
pub struct TakeOptions {
    /// Brush of the library, or a brush file
    kind: String,
    /// Width of the head, mm [default: that of its file]
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    size_mm: Option<f64>,
    /// Brush of the rig to replace
    #[arg(long, default_value = "main")]
    brush: String,
    #[command(flatten)]
    target: Target,
}

/// Runs a command on brushes.
///
/// # Errors
/// A [`UserError`] for a bad file.
pub fn run(command: &BrushCommand) -> Result<i32, UserError> {
    match command {
        BrushCommand::List(options) => list(options),
        BrushCommand::Import(options) => import(options),
        BrushCommand::Take(options) => take_up(options),
        BrushCommand::Edit(edit) => edit::run(edit),
        BrushCommand::Solve(options) => solve(options),
    }
}

fn list(options: &ListOptions) -> Result<i32, UserError> {
    let (mut rows, mut text) = (Vec::new(), String::new());
    for (name, _) in LIBRARY {
        let brush =
            BrushFile::library(name).map_err(|error| UserError::failure(error.to_string()))?;
        let (head, spines) = (&brush.head, &brush.spines);
        let sizes: Vec<String> = brush.sizes_mm.iter().map(f64::to_string).collect();
        if options.json {
            rows.push(json!({
                "name": name,
                "about": brush.about,
                "sizes_mm": brush.sizes_mm,
                "width_mm": head.width_mm,
                "length_mm": head.length_mm,
                "spines": spines.number(),
                "joints": spines.all_joints(),
                "strips": brush.strips.count,
            }));
        } else {
            let sizes = sizes.join(", ");
            text += &format!("{name:<9} {} ({sizes} mm)\n", brush.about);
        }
    }
    if options.json {
        print_json(&json!({ "brushes": rows }))?;
    }
    print_text(&text)?;
    Ok(0)
}

fn import(options: &ImportOptions) -> Result<i32, UserError> {
    let path = &options.output;
    check_outputs(
        &[UsedFile::new("the brush file", path).of(Kind::Brush)],
        &[UsedFile::new("the model", &options.model)],
    )?;
    let text = read_brush(&options.model)
        .map_err(of_a_brush)?
        .to_toml()
        .map_err(|error| UserError::failure(error.to_string()))?;
    write_whole(path, Kind::Brush, |file| file.write_all(text.as_bytes()))
        .map_err(|error| UserError::writing(path, &error))?;
    say!("{}: {} bytes", path.display(), text.len());
    Ok(0)
}

fn take_up(options: &TakeOptions) -> Result<i32, UserError> {
    let section = BrushSection {
        name: options.brush.clone(),
        kind: options.kind.clone(),
        size_mm: options.size_mm,
        depth_share: 0.0,
    };
    let toml = brush_file(&section)?
        .to_toml()
        .map_err(|error| UserError::failure(error.to_string()))?;
    let command = maulstick_types::command::BrushCommand::Define {
        brush: BrushName::new(&*options.brush)?,
        toml: BrushToml::new(toml)?,
    };
    Client::command(&options.target, command)?;
    Ok(0)
}

fn solve(options: &SolveOptions) -> Result<i32, UserError> {
    let (spine, poses) = (read_spine(&options.spine)?, read_poses(&options.poses)?);
    let mut text = String::new();
    if !options.json {
        text += "        t        x        y        z   energy   depth residual  steps\n";
        text += "        s       mm       mm       mm       µJ      mm                \n";
    }
    for row in follow(&spine, &poses) {
        text += &if options.json {
            serde_json::to_string(&row).map_err(|e| UserError::failure(e.to_string()))?
        } else {
            in_columns(&row)
        };
        text.push('\n');
    }
    print_text(&text)?;
    Ok(0)
}

/// The tip, the energy, and how well it was found.
fn in_columns(row: &TrialRow) -> String {
    let [x, y, z] = row
        .joints
        .last()
        .map_or([0.0; 3], |tip| tip.map(|v| v * 1e3));
    format!(
        "{:>9.4} {x:>8.3} {y:>8.3} {z:>8.3} {:>8.3} {:>7.0e} {:>8.0e} {:>6}{}",
        row.t,
        row.energy.total * 1e6,
        row.penetration_m * 1e3,
        row.residual,
        row.iterations,
        if row.converged { "" } else { "  not found" }
    )
}

fn read(path: &Path) -> Result<(String, String), UserError> {
    let text = std::fs::read_to_string(path).map_err(|error| UserError::reading(path, &error))?;
    // Spreadsheets begin a table with a byte order mark.
    let text = text.trim_start_matches('\u{feff}').to_owned();
    Ok((text, path.display().to_string()))
}

fn read_spine(path: &Path) -> Result<SpineFile, UserError> {
    const HELP: &str = "see what a spine file holds: `maulstick brush solve --help`";
    let (text, name) = read(path)?;
    let file: SpineFile = toml::from_str(&text).map_err(|error| {
        // An unknown key has the keys that there are as its advice.
        let own = |advice: &Advice| (*advice == Advice::DefaultSettings).then(|| HELP.to_owned());
        toml_fault(&text, &name, &error).worded(own)
    })?;
    let refused = |error: BrushError| UserError::usage(error.to_string()).at(name).help(HELP);
    file.check().map_err(refused)?;
    Ok(file)
}

fn read_poses(path: &Path) -> Result<Vec<TrialPose>, UserError> {
    let text = read_table(path, MOST_BYTES)?;
    poses(&text).map_err(|error| {
        UserError::usage(error.to_string())
            .at(format!("{}:{}", path.display(), error.line))
            .help(error.help())
    })
}
