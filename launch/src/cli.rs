//! The command line of `maulstick`.

use std::fmt::Write as _;

use clap::{CommandFactory as _, FromArgMatches as _, Parser, Subcommand};
use maulstick_rig::UserError;
use maulstick_rig::files::{allow_overwriting, clear_on_signals};

use crate::commands::{
    begin, bench, brush, calibrate, control, demo, devices, endpoint, export, fit, force, import,
    layers, light, matching, mix, mode, open, painting, paints, render, save_as, schema, surface,
    take,
};
use crate::processes::{self, NodeCommand};
use crate::up;

/// A painting rig that you can feel
#[derive(Parser, Debug)]
#[command(name = "maulstick", version, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
    /// Overwrite an existing file that is not a painting
    #[arg(long, global = true)]
    overwrite: bool,
}

#[derive(Subcommand, Debug)]
enum Command {
    /// Start a rig and keep it running
    Up(up::UpOptions),
    /// Paint a take without a rig
    Render(render::RenderOptions),
    /// Make a take from a table of strokes
    Import(import::ImportOptions),
    /// Make a demo: a take, a painting or a sheet of marks
    Demo(demo::DemoOptions),
    /// Show or repair takes
    #[command(subcommand)]
    Take(take::TakeCommand),
    /// Load a brush with paint
    Load(control::LoadOptions),
    /// Make a brush stiffer or softer
    Tune(control::TuneOptions),
    /// Clean a brush
    Clean(control::CleanOptions),
    /// Show or change the light
    Light(light::LightOptions),
    /// Dry the wet paint into a new layer
    Dry(layers::DryOptions),
    /// Make dry layers wet again
    Wet(layers::WetOptions),
    /// Make a dry layer more or less opaque
    Opacity(layers::OpacityOptions),
    /// Undo the newest step
    Undo(control::HistoryOptions),
    /// Redo the newest undone step
    Redo(control::HistoryOptions),
    /// Write the picture as a file
    Snapshot(control::SnapshotOptions),
    /// Open another painting in the running rig
    Open(open::OpenOptions),
    /// Begin a new painting in the running rig
    New(begin::NewOptions),
    /// Save the painting under another name and go on there
    SaveAs(save_as::SaveAsOptions),
    /// Export the painting for other programs
    Export(export::ExportOptions),
    /// List attached devices and how to use them
    Devices(devices::DevicesOptions),
    /// Run one process of a rig by hand
    #[command(subcommand)]
    Node(NodeCommand),
    /// Print how a program in any language joins the rig
    Endpoint(endpoint::EndpointOptions),
    /// Print the message formats
    Schema(schema::SchemaOptions),
    /// Show, export or import brushes
    #[command(subcommand)]
    Brush(brush::BrushCommand),
    /// Show, export, import, repair, pack painting files; keep versions
    #[command(subcommand)]
    Painting(painting::PaintingCommand),
    /// Lay a film of wet paint over the canvas
    Fill(surface::FillOptions),
    /// Change the ground of the canvas
    Ground(surface::GroundOptions),
    /// Change the tooth of the canvas
    Tooth(surface::ToothOptions),
    /// Size the canvas
    Size(mode::SizeOptions),
    /// Let paint on the palette deplete or last
    Piles(mode::PilesOptions),
    /// List the paints
    Paints(paints::PaintsOptions),
    /// Mix paints and show their colour
    Mix(mix::MixOptions),
    /// Propose mixtures for a colour
    Match(matching::MatchOptions),
    /// Fit paints to measured reflectances
    Fit(fit::FitCommand),
    /// Run benchmarks against reference programs
    Bench(bench::BenchOptions),
    /// Fit a device to the canvas by touching three corners
    Calibrate(calibrate::CalibrateOptions),
    /// Show the force of a brush on the hand, by depth and angle
    Force(force::ForceOptions),
}

/// The commands as `maulstick --help` lists them.
const GROUPS: &[(&str, &[&str])] = &[
    ("Rig", &["up", "node", "endpoint", "schema"]),
    (
        "Painting",
        &["new", "open", "save-as", "snapshot", "export", "painting"],
    ),
    ("Paint", &["fill", "undo", "redo"]),
    ("Canvas", &["ground", "tooth", "size", "light"]),
    ("Layers", &["dry", "wet", "opacity"]),
    ("Brush", &["load", "clean", "tune", "piles", "brush"]),
    ("Colour", &["paints", "mix", "match", "fit"]),
    ("Takes", &["demo", "import", "render", "take"]),
    ("Devices", &["devices", "calibrate", "force"]),
    ("Measure", &["bench"]),
];

/// A command whose help lists its subcommands in [`GROUPS`].
fn grouped(command: clap::Command) -> clap::Command {
    let mut list = String::new();
    for (group, names) in GROUPS {
        writeln!(list, "{group}:").ok();
        for name in *names {
            let found = command.find_subcommand(name);
            let about = found.and_then(clap::Command::get_about);
            let about = about.map(ToString::to_string).unwrap_or_default();
            writeln!(list, "  {name:<10} {about}").ok();
        }
        list.push('\n');
    }
    command.help_template(format!(
        "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n\n{list}Options:\n{{options}}\n\n\
         'maulstick COMMAND --help' shows the options of a command."
    ))
}

/// Runs the command line and returns the exit code.
///
/// # Errors
/// A [`UserError`] as the user sees it.
pub fn run() -> Result<i32, UserError> {
    let matches = grouped(Cli::command()).get_matches();
    let Cli { command, overwrite } =
        Cli::from_arg_matches(&matches).unwrap_or_else(|error| error.exit());
    if overwrite {
        allow_overwriting();
    }
    // A rig ends its processes first, a node its work, a calibration its device.
    if !matches!(
        command,
        Command::Up(_) | Command::Calibrate(_) | Command::Node(_)
    ) {
        clear_on_signals(crate::EXIT_INTERRUPTED)
            .map_err(|error| UserError::failure(format!("cannot watch for signals: {error}")))?;
    }
    match command {
        Command::Up(options) => up::run(&options),
        Command::Node(command) => processes::run(&command),
        Command::Render(options) => render::run(&options),
        Command::Import(options) => import::run(&options),
        Command::Demo(options) => demo::run(&options),
        Command::Take(command) => take::run(&command),
        Command::Load(options) => control::load(&options),
        Command::Tune(options) => control::tune(&options),
        Command::Clean(options) => control::clean(&options),
        Command::Light(options) => light::run(&options),
        Command::Dry(options) => layers::dry(&options),
        Command::Wet(options) => layers::wet(&options),
        Command::Opacity(options) => layers::opacity(&options),
        Command::Undo(options) => control::undo(&options),
        Command::Redo(options) => control::redo(&options),
        Command::Snapshot(options) => control::snapshot(&options),
        Command::Open(options) => open::run(&options),
        Command::New(options) => begin::run(&options),
        Command::SaveAs(options) => save_as::run(&options),
        Command::Export(options) => export::run(&options),
        Command::Devices(options) => devices::run(&options),
        Command::Endpoint(options) => endpoint::run(&options),
        Command::Schema(options) => schema::run(&options),
        Command::Brush(command) => brush::run(&command),
        Command::Painting(command) => painting::run(&command),
        Command::Fill(options) => surface::fill(&options),
        Command::Ground(options) => surface::ground(&options),
        Command::Tooth(options) => surface::tooth(&options),
        Command::Size(options) => mode::size(&options),
        Command::Piles(options) => mode::piles(&options),
        Command::Paints(options) => paints::run(&options),
        Command::Mix(options) => mix::run(&options),
        Command::Match(options) => matching::run(&options),
        Command::Fit(options) => fit::run(&options),
        Command::Bench(options) => bench::run(&options),
        Command::Calibrate(options) => calibrate::run(&options),
        Command::Force(options) => force::run(&options),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        grouped(Cli::command()).debug_assert();
    }

    #[test]
    fn help_lists_each_command_once() {
        let command = Cli::command();
        let mut commands: Vec<_> = command.get_subcommands().map(|c| c.get_name()).collect();
        let mut listed: Vec<_> = GROUPS
            .iter()
            .flat_map(|(_, names)| *names)
            .copied()
            .collect();
        commands.sort_unstable();
        listed.sort_unstable();
        assert_eq!(commands, listed);
        let help = grouped(command).render_help().to_string();
        assert!(
            help.contains("Rig:\n  up         Start a rig and keep it running\n"),
            "{help}"
        );
    }
}
