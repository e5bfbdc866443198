//! The command line of `maulstick`.

use clap::{Parser, Subcommand};
use maulstick_rig::Fault;
use maulstick_rig::files::{allow_overwriting, clear_on_signals};

use crate::commands::{
    begin, bench, brush, calibrate, control, demo, devices, endpoint, export, fit, force, import,
    layers, light, matching, mix, mode, open, painting, paints, render, save_as, schema, surface,
    take,
};
use crate::up;

/// A painting rig that you can feel
#[derive(Parser, Debug)]
#[command(name = "maulstick", version, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
    /// Write over a file of another kind; over a painting never
    #[arg(long, global = true)]
    overwrite: bool,
}

#[derive(Subcommand, Debug)]
enum Command {
    /// Starts a rig and keeps it running
    Up(up::UpOptions),
    /// Paints a take without a rig
    Render(render::RenderOptions),
    /// Makes a take of a table of strokes
    Import(import::ImportOptions),
    /// Makes a take of a performance from a seed
    Demo(demo::DemoOptions),
    /// Shows or repairs takes
    #[command(subcommand)]
    Take(take::TakeCommand),
    /// Loads a brush of a running rig
    Load(control::LoadOptions),
    /// Makes a brush of a running rig stiffer or softer
    Tune(control::TuneOptions),
    /// Takes all paint off a brush of a running rig
    Clean(control::CleanOptions),
    /// Shows or changes the light over a running rig
    Light(light::LightOptions),
    /// Dries the wet paint of a running rig into a new layer
    Dry(layers::DryOptions),
    /// Makes dry layers of a running rig wet again
    Wet(layers::WetOptions),
    /// Makes a dry layer of a running rig more or less opaque
    Opacity(layers::OpacityOptions),
    /// Takes the newest step in a running rig back
    Undo(control::HistoryOptions),
    /// Does the newest undone step in a running rig again
    Redo(control::HistoryOptions),
    /// Writes the picture of a running rig
    Snapshot(control::SnapshotOptions),
    /// Goes on in another painting in a running rig
    Open(open::OpenOptions),
    /// Begins a painting in a running rig
    New(begin::NewOptions),
    /// Puts the painting of a running rig into another file, where it goes on
    SaveAs(save_as::SaveAsOptions),
    /// Writes the painting of a running rig for other programs
    Export(export::ExportOptions),
    /// Lists what is attached, and how to use it
    Devices(devices::DevicesOptions),
    /// Tells a program in any language how to join a running rig
    Endpoint(endpoint::EndpointOptions),
    /// Prints the messages of the rig
    Schema(schema::SchemaOptions),
    /// Shows the brushes
    #[command(subcommand)]
    Brush(brush::BrushCommand),
    /// Shows, exports, imports, repairs and packs paintings, and keeps versions of them
    #[command(subcommand)]
    Painting(painting::PaintingCommand),
    /// Lays a film of wet paint over the canvas of a running rig
    Fill(surface::FillOptions),
    /// Gives the canvas of a running rig another ground
    Ground(surface::GroundOptions),
    /// Gives the canvas of a running rig another tooth
    Tooth(surface::ToothOptions),
    /// Sizes the canvas of a running rig
    Size(mode::SizeOptions),
    /// Says whether paint on the palette of a running rig depletes or lasts
    Piles(mode::PilesOptions),
    /// Lists the paints
    Paints(paints::PaintsOptions),
    /// Mixes paints and shows their colour
    Mix(mix::MixOptions),
    /// Proposes mixtures for a colour
    Match(matching::MatchOptions),
    /// Makes paints of measured reflectances
    Fit(fit::FitCommand),
    /// Measures, beside peers
    Bench(bench::BenchOptions),
    /// Fits a device to the canvas by three corners that a hand touches
    Calibrate(calibrate::CalibrateOptions),
    /// Shows the force that a brush gives to the hand, by depth and angle
    Force(force::ForceOptions),
}

/// Runs the command line and returns the exit code.
///
/// # Errors
/// A [`Fault`] as the user sees it.
pub fn run() -> Result<i32, Fault> {
    let Cli { command, overwrite } = Cli::parse();
    if overwrite {
        allow_overwriting();
    }
    // A rig has processes to end first, a device to be let go.
    if !matches!(command, Command::Up(_) | Command::Calibrate(_)) {
        clear_on_signals(crate::EXIT_INTERRUPTED)
            .map_err(|error| Fault::failure(format!("cannot watch for signals: {error}")))?;
    }
    match command {
        Command::Up(options) => up::run(&options),
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
    use clap::CommandFactory as _;

    #[test]
    fn the_command_line_is_consistent() {
        super::Cli::command().debug_assert();
    }
}
