//! The command line of `maulstick`.

use std::fmt::Write as _;

use clap::{CommandFactory as _, FromArgMatches as _, Parser, Subcommand};
use maulstick_rig::UserError;
use maulstick_rig::files::{allow_overwriting, clear_on_signals};
use maulstick_types::edits::commands;
use nix::sys::prctl::set_name;

use crate::advice;
use crate::commands::measure::Measure;
use crate::commands::{
    begin, bench, bridge, brush, demo, device, echo, edit, endpoint, export, fit, force, graph,
    import, light, matching, measure, mix, motion, nodes, open, painting, paints, record,
    recording, render, replay, save_as, schema, snapshot, take,
};
use crate::doctor;
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
    /// Check this machine, and say what mends what is wrong
    Doctor(doctor::DoctorOptions),
    /// Paint a take without a rig
    Render(render::RenderOptions),
    /// Make a take from a table of strokes
    Import(import::ImportOptions),
    /// Make a demo: a take, a painting or a sheet of marks
    Demo(demo::DemoOptions),
    /// Show takes, make them of what was painted, complete or recover them
    #[command(subcommand)]
    Take(take::TakeCommand),
    /// Cut, join, place, mirror, retime takes; fill an outline by example
    #[command(subcommand)]
    Motion(motion::MotionCommand),
    /// An edit of the painting
    #[command(flatten)]
    Edit(edit::EditCommand),
    /// Show or change the light
    Light(light::LightOptions),
    /// Write the picture as a file
    Snapshot(snapshot::SnapshotOptions),
    /// Open another painting in the running rig
    Open(open::OpenOptions),
    /// Begin a new painting in the running rig
    New(begin::NewOptions),
    /// Save the painting under another name and go on there
    SaveAs(save_as::SaveAsOptions),
    /// Export the painting for other programs
    Export(export::ExportOptions),
    /// List, add, choose, fit and remove devices, also while painting
    #[command(subcommand)]
    Device(device::DeviceCommand),
    /// Run one process of a rig by hand
    #[command(subcommand)]
    Node(NodeCommand),
    /// Print how a program in any language joins the rig
    Endpoint(endpoint::EndpointOptions),
    /// Print the message formats
    Schema(schema::SchemaOptions),
    /// Show brushes, take one in hand, set its mode, import one
    #[command(subcommand)]
    Brush(brush::BrushCommand),
    /// Show, export, import, film, repair, pack painting files; keep versions
    #[command(subcommand)]
    Painting(painting::PaintingCommand),
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
    /// Show the force of a brush on the hand, by depth and angle
    Force(force::ForceOptions),
    /// List the processes of a rig
    Nodes(nodes::NodesOptions),
    /// List what a rig sends
    Topics(measure::MeasureOptions),
    /// Draw the processes of a rig and what they send each other
    Graph(graph::GraphOptions),
    /// Print the messages of a topic as they come
    Echo(echo::EchoOptions),
    /// Measure how often messages come, and how many are missing
    Hz(measure::MeasureOptions),
    /// Measure how long messages are on the way
    Latency(measure::MeasureOptions),
    /// Record what a rig sends
    Record(record::RecordOptions),
    /// Show a running rig in Foxglove
    Bridge(bridge::BridgeOptions),
    /// Show a recording, or export its messages
    #[command(subcommand)]
    Recording(recording::RecordingCommand),
    /// Play a recording into a running rig
    Replay(replay::ReplayOptions),
}

/// The commands as `maulstick --help` lists them; those of edits stand before them, as each edit says.
const GROUPS: &[(&str, &[&str])] = &[
    ("Rig", &["up", "doctor", "node", "endpoint", "schema"]),
    (
        "Painting",
        &["new", "open", "save-as", "snapshot", "export", "painting"],
    ),
    ("Paint", &[]),
    ("Canvas", &["light"]),
    ("Layers", &[]),
    ("Brush", &["brush"]),
    ("Colour", &["paints", "mix", "match", "fit"]),
    ("Takes", &["demo", "import", "render", "take", "motion"]),
    (
        "Streams",
        &[
            "nodes",
            "topics",
            "graph",
            "echo",
            "hz",
            "latency",
            "record",
            "recording",
            "replay",
            "bridge",
        ],
    ),
    ("Devices", &["device", "force"]),
    ("Measure", &["bench"]),
];

/// Names of the commands of a group.
fn in_group<'a>(group: &str, names: &'a [&'a str]) -> Vec<&'a str> {
    let edits = commands().into_iter().filter(|form| form.group == group);
    edits
        .map(|form| form.name)
        .chain(names.iter().copied())
        .collect()
}

/// A command whose help lists its subcommands in [`GROUPS`].
fn grouped(command: clap::Command) -> clap::Command {
    let mut list = String::new();
    for (group, names) in GROUPS {
        writeln!(list, "{group}:").ok();
        for name in in_group(group, names) {
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
    // What a window starts is called after the link in /proc that leads to its program.
    set_name(c"maulstick").ok();
    // A rig ends its processes first, a node its work, a fitting its device.
    let handles_signals = match &command {
        Command::Up(_) | Command::Node(_) => true,
        Command::Device(command) => command.handles_signals(),
        Command::Nodes(_)
        | Command::Topics(_)
        | Command::Graph(_)
        | Command::Echo(_)
        | Command::Hz(_)
        | Command::Latency(_)
        | Command::Record(_)
        | Command::Replay(_)
        | Command::Bridge(_) => true,
        _ => false,
    };
    if !handles_signals {
        clear_on_signals(crate::EXIT_INTERRUPTED)
            .map_err(|error| UserError::failure(format!("cannot watch for signals: {error}")))?;
    }
    carry_out(command).map_err(|fault| fault.worded(advice::words))
}

fn carry_out(command: Command) -> Result<i32, UserError> {
    match command {
        Command::Up(options) => up::run(&options),
        Command::Doctor(options) => doctor::run(&options),
        Command::Node(command) => processes::run(&command),
        Command::Render(options) => render::run(&options),
        Command::Replay(options) => replay::run(&options),
        Command::Import(options) => import::run(&options),
        Command::Demo(options) => demo::run(&options),
        Command::Take(command) => take::run(&command),
        Command::Motion(command) => motion::run(&command),
        Command::Edit(command) => edit::run(&command),
        Command::Light(options) => light::run(&options),
        Command::Snapshot(options) => snapshot::snapshot(&options),
        Command::Open(options) => open::run(&options),
        Command::New(options) => begin::run(&options),
        Command::SaveAs(options) => save_as::run(&options),
        Command::Export(options) => export::run(&options),
        Command::Device(command) => device::run(&command),
        Command::Endpoint(options) => endpoint::run(&options),
        Command::Schema(options) => schema::run(&options),
        Command::Brush(command) => brush::run(&command),
        Command::Painting(command) => painting::run(&command),
        Command::Paints(options) => paints::run(&options),
        Command::Mix(options) => mix::run(&options),
        Command::Match(options) => matching::run(&options),
        Command::Fit(options) => fit::run(&options),
        Command::Bench(options) => bench::run(&options),
        Command::Force(options) => force::run(&options),
        Command::Nodes(options) => nodes::run(&options),
        Command::Topics(options) => measure::run(&options, Measure::Topics),
        Command::Graph(options) => graph::run(&options),
        Command::Echo(options) => echo::run(&options),
        Command::Hz(options) => measure::run(&options, Measure::Rates),
        Command::Latency(options) => measure::run(&options, Measure::Delays),
        Command::Record(options) => record::run(&options),
        Command::Bridge(options) => bridge::run(&options),
        Command::Recording(command) => recording::run(&command),
    }
}

#[cfg(test)]
mod tests {
    use maulstick_types::edits::{self, Edit, Form as _, Relight};
    use maulstick_types::scene::Light;

    use super::*;
    use crate::lamp::changed;

    #[test]
    fn the_command_line_is_consistent() {
        grouped(Cli::command()).debug_assert();
    }

    /// The edit that a command line means.
    fn edit_of(arguments: &str) -> Option<Edit> {
        let words = std::iter::once("maulstick").chain(arguments.split('|'));
        let matches = grouped(Cli::command()).try_get_matches_from(words);
        let matches = matches.unwrap_or_else(|error| panic!("{arguments}: {error}"));
        match Cli::from_arg_matches(&matches).expect("read").command {
            Command::Edit(command) => Some(command.edit),
            Command::Brush(brush::BrushCommand::Mode(options)) => Some(options.edit().into()),
            Command::Painting(painting::PaintingCommand::Versions(options)) => options.edit(),
            Command::Light(options) => {
                let light = changed(options.change(), &Light::default()).expect("a light");
                let expose = false;
                Some(Relight { light, expose }.into())
            }
            _ => None,
        }
    }

    /// Edits that only a window asks for: their numbers are found with the pointer.
    const POINTED_AT: [&str; 4] = ["GoTo", "NameLayer", "Place", "Wells"];

    macro_rules! walk {
        ($($edit:ident),*) => {
            #[test]
            fn each_edit_is_read_from_its_command_line() {
                let mut without = Vec::new();
                $(
                    let example = edits::$edit::example().expect("in range");
                    match edits::$edit::ARGUMENTS {
                        Some(arguments) => {
                            assert_eq!(edit_of(arguments), Some(example.into()), "{arguments}");
                        }
                        None => without.push(stringify!($edit)),
                    }
                )*
                without.sort_unstable();
                assert_eq!(without, POINTED_AT);
            }
        };
    }

    maulstick_types::for_each_edit!(walk);

    #[test]
    fn what_is_out_of_range_is_rejected_on_the_command_line() {
        for (arguments, word) in [
            ("dry|--share|3", "above 0, at most 1"),
            ("dry|--over|soon", "90s"),
            ("dry|--share|0.5|--over|90s", "cannot be used with"),
            ("dry|--region|1,2", "X,Y,WxH"),
            ("opacity|sky|-1", "0 to 1"),
            ("fill|Bone Black|--um|9000", "1 to 5000 µm"),
            ("fill", "MIXTURE"),
            ("wet|--layers|0", "1.."),
            ("size|-2", "0 to 1000 µm"),
            ("tune|--stiffness|99", "0.05 to 20"),
            ("load|Bone Black=0", "not a number above 0"),
            ("load|Bone Black|--brush|a/b", "letters, digits"),
            ("piles|stay", "deplete"),
            ("brush|mode|spunge", "'sponge'"),
        ] {
            let words = std::iter::once("maulstick").chain(arguments.split('|'));
            let rejected = grouped(Cli::command()).try_get_matches_from(words);
            let said = rejected.expect_err(arguments).to_string();
            assert!(said.contains(word), "{arguments}: {said}");
        }
    }

    /// Characters of the line that says what a command does, at most: a list of them stays in 100 columns.
    const LINE: usize = 90;

    /// What is wrong with a line of help.
    fn fault_of(line: &str) -> Option<&'static str> {
        let first = line.chars().next();
        match first {
            None => Some("says nothing"),
            Some(first) if first.is_lowercase() || first == '`' => {
                Some("begins as a comment of the code does")
            }
            _ if line.ends_with('.') => Some("ends as a sentence"),
            _ if line.contains("[`") || line.contains("::") => Some("names what is in the code"),
            _ => None,
        }
    }

    /// What is wrong with the help of a command and of those below it.
    fn faults(command: &clap::Command, path: &str, found: &mut Vec<String>) {
        let about = command.get_about().map(ToString::to_string);
        let about = about.unwrap_or_default();
        let long = (about.chars().count() > LINE).then_some("is too long");
        let lines = command.get_arguments().map(|argument| {
            let help = argument.get_help().map(ToString::to_string);
            (argument.get_id().to_string(), help.unwrap_or_default())
        });
        let wrong = lines.filter_map(|(name, help)| Some((name, fault_of(&help)?)));
        let own = fault_of(&about)
            .or(long)
            .map(|fault| (String::new(), fault));
        let wrong = own.into_iter().chain(wrong);
        found.extend(wrong.map(|(name, fault)| format!("{path} {name}: {fault}")));
        for below in command.get_subcommands() {
            faults(below, &format!("{path} {}", below.get_name()), found);
        }
    }

    #[test]
    fn all_help_is_for_people() {
        let mut found = Vec::new();
        faults(&Cli::command(), "maulstick", &mut found);
        assert!(found.is_empty(), "{found:#?}");
        let code = clap::Command::new("x").about("`x`, with which a y is stopped");
        let nothing = clap::Arg::new("y").long("y");
        faults(&code.arg(nothing), "x", &mut found);
        assert_eq!(found.len(), 2, "a fault would pass: {found:?}");
    }

    #[test]
    fn help_lists_each_command_once() {
        let command = Cli::command();
        let mut commands: Vec<_> = command.get_subcommands().map(|c| c.get_name()).collect();
        let mut listed: Vec<_> = GROUPS
            .iter()
            .flat_map(|(group, names)| in_group(group, names))
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
