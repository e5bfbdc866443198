//! The command line of `maulstick`.

use std::fmt::Write as _;

use clap::{CommandFactory as _, FromArgMatches as _, Parser, Subcommand};
use maulstick_rig::UserError;
use maulstick_rig::files::allow_overwriting;
use nix::sys::prctl::set_name;

use crate::advice;
use crate::beside;
use crate::commands::completions::{self, CompletionsCommand, Headings};
use crate::commands::edit::{self, DAILY, DailyEdit, LayerEdit, PaletteEdit};
use crate::commands::{
    brush, canvas, colour, demo, device, doctor, endpoint, nodes, painting, recording, render,
    schema, snapshot, take, topic,
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
    /// Check this machine, with a remedy for each fault
    Doctor(doctor::DoctorOptions),
    /// List the processes of a rig, or run one by hand
    #[command(subcommand)]
    Node(NodesCommand),
    /// Print how a program in any language joins the rig
    Endpoint(endpoint::EndpointOptions),
    /// Print the message formats
    Schema(schema::SchemaOptions),
    /// An edit of the painting
    #[command(flatten)]
    Daily(DailyEdit),
    /// As `take render`
    Render(render::RenderOptions),
    /// As `painting snapshot`
    Snapshot(snapshot::SnapshotOptions),
    /// Begin, open, save, export, undo; show, film, repair, pack painting files; keep versions
    #[command(subcommand)]
    Painting(painting::PaintingCommand),
    /// Change ground, tooth, size, light and paint model; lay an even film
    #[command(subcommand)]
    Canvas(canvas::CanvasCommand),
    /// Scrape the palette, let its paint deplete or last
    #[command(subcommand)]
    Palette(PaletteEdit),
    /// Dry paint into a layer, make layers wet again, set their opacity
    #[command(subcommand)]
    Layer(LayerEdit),
    /// Load, clean, tune, take in hand, set the mode; show brushes, import one
    #[command(subcommand)]
    Brush(brush::BrushCommand),
    /// List paints, mix them, match a colour, draw charts, fit paints to measurements
    #[command(subcommand)]
    Colour(colour::ColourCommand),
    /// Make, paint, show, cut, join, place, retime, recover takes; fill an outline by example
    #[command(subcommand)]
    Take(take::TakeCommand),
    /// Record a rig, replay into it; show a recording, export its messages
    #[command(subcommand)]
    Recording(recording::RecordingCommand),
    /// List, print, measure, draw what a rig sends; show it in Foxglove
    #[command(subcommand)]
    Topic(topic::TopicCommand),
    /// List, add, choose, fit and remove devices, also while painting; force
    #[command(subcommand)]
    Device(device::DeviceCommand),
    /// Make a demo: a take, a painting, a sheet of effects, the force of a fluid
    #[command(subcommand)]
    Demo(demo::DemoCommand),
    /// Print completions for a shell, write manual pages
    #[command(subcommand)]
    Completions(CompletionsCommand),
}

/// Commands of `maulstick node`.
#[derive(Subcommand, Debug)]
enum NodesCommand {
    /// List the processes of a rig
    List(nodes::NodesOptions),
    /// One of them
    #[command(flatten)]
    Run(NodeCommand),
}

/// The commands as `maulstick --help` lists them.
const HEADINGS: &Headings = &[
    ("Rig", &["up", "doctor", "node", "endpoint", "schema"]),
    ("Daily", &DAILY_NAMES),
    (
        "Paint",
        &["painting", "canvas", "palette", "layer", "brush", "colour"],
    ),
    ("Motions and streams", &["take", "recording", "topic"]),
    ("Devices", &["device"]),
    ("Program", &["demo", "bench", "completions"]),
];

/// Names of the daily commands.
const DAILY_NAMES: [&str; DAILY.len()] = {
    let mut names = [""; DAILY.len()];
    let mut place = 0;
    while place < names.len() {
        names[place] = DAILY[place].0;
        place += 1;
    }
    names
};

/// Help of a command, and its long form.
fn help(command: &clap::Command) -> [String; 2] {
    let about = command.get_about().map(ToString::to_string);
    let about = about.unwrap_or_default();
    let long = command.get_long_about().map(ToString::to_string);
    let long = long.unwrap_or_else(|| about.clone());
    [about, long]
}

/// The program: its short commands have the help of those that they are short for.
fn program() -> clap::Command {
    let program = beside::with_commands(Cli::command());
    DAILY.iter().fold(program, |program, (name, group)| {
        let group_of = program.find_subcommand(group);
        let long_form = group_of.and_then(|group| group.find_subcommand(name));
        let [about, long] = long_form.map(help).unwrap_or_default();
        program.mut_subcommand(name, |short| {
            short
                .about(format!("{about} (short for {group} {name})"))
                .long_about(format!("{long}\n\nShort for `maulstick {group} {name}`."))
        })
    })
}

/// A program whose help lists its commands under [`HEADINGS`].
fn grouped(program: clap::Command) -> clap::Command {
    let mut list = String::new();
    for (heading, names) in HEADINGS {
        writeln!(list, "{heading}:").ok();
        for name in *names {
            let [about, _] = program.find_subcommand(name).map(help).unwrap_or_default();
            writeln!(list, "  {name:<11} {about}").ok();
        }
        list.push('\n');
    }
    program.help_template(format!(
        "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n\n{list}Options:\n{{options}}\n\n\
         'maulstick COMMAND --help' shows the commands or the options of a command."
    ))
}

/// Runs the command line and returns the exit code.
///
/// # Errors
/// A [`UserError`] as the user sees it.
pub fn run() -> Result<i32, UserError> {
    let matches = match grouped(program()).try_get_matches() {
        Ok(matches) => matches,
        Err(error) => return beside::run_unknown(&error),
    };
    beside::run_given(&matches)?;
    let Cli { command, overwrite } =
        Cli::from_arg_matches(&matches).unwrap_or_else(|error| error.exit());
    if overwrite {
        allow_overwriting();
    }
    // A process started by the window is named after the link in /proc to its program.
    set_name(c"maulstick").ok();
    // A rig ends its processes first, a node its work, a fitting its device.
    let handles_signals = match &command {
        Command::Up(_) | Command::Node(_) | Command::Topic(_) => true,
        Command::Device(command) => command.handles_signals(),
        Command::Recording(command) => command.handles_signals(),
        _ => false,
    };
    if !handles_signals {
        beside::clear_files_on_signals()?;
    }
    carry_out(command).map_err(|fault| fault.worded(advice::words))
}

fn carry_out(command: Command) -> Result<i32, UserError> {
    match command {
        Command::Up(options) => up::run(&options),
        Command::Doctor(options) => doctor::run(&options),
        Command::Node(NodesCommand::List(options)) => nodes::run(&options),
        Command::Node(NodesCommand::Run(command)) => processes::run(&command),
        Command::Endpoint(options) => endpoint::run(&options),
        Command::Schema(options) => schema::run(&options),
        Command::Daily(edit) => edit::run(&edit),
        Command::Render(options) => render::run(&options),
        Command::Snapshot(options) => snapshot::snapshot(&options),
        Command::Painting(command) => painting::run(&command),
        Command::Canvas(command) => canvas::run(&command),
        Command::Palette(edit) => edit::run(&edit),
        Command::Layer(edit) => edit::run(&edit),
        Command::Brush(command) => brush::run(&command),
        Command::Colour(command) => colour::run(&command),
        Command::Take(command) => take::run(&command),
        Command::Recording(command) => recording::run(&command),
        Command::Topic(command) => topic::run(&command),
        Command::Device(command) => device::run(&command),
        Command::Demo(command) => demo::run(&command),
        Command::Completions(command) => completions::run(&command, program(), HEADINGS),
    }
}

#[cfg(test)]
mod tests {
    use maulstick_painting::edits::{self, Relight};
    use maulstick_types::Edit;
    use maulstick_types::scene::Light;

    use super::*;
    use maulstick_painting_setup::lamp::changed;

    #[test]
    fn the_command_line_is_consistent() {
        grouped(program()).debug_assert();
    }

    /// The edit that a command line means.
    fn edit_of(arguments: &[&str]) -> Option<Edit> {
        let words = std::iter::once(&"maulstick").chain(arguments);
        let matches = grouped(program()).try_get_matches_from(words);
        let matches = matches.unwrap_or_else(|error| panic!("{arguments:?}: {error}"));
        match Cli::from_arg_matches(&matches).expect("read").command {
            Command::Daily(command) => Some(command.edit),
            Command::Layer(command) => Some(command.edit),
            Command::Palette(command) => Some(command.edit),
            Command::Brush(brush::BrushCommand::Edit(command)) => Some(command.edit),
            Command::Painting(painting::PaintingCommand::Edit(command)) => Some(command.edit),
            Command::Painting(painting::PaintingCommand::Versions(options)) => options.edit(),
            Command::Canvas(canvas::CanvasCommand::Edit(command)) => Some(command.edit),
            Command::Canvas(canvas::CanvasCommand::Light(options)) => {
                let light = changed(options.change(), &Light::default()).expect("a light");
                let expose = false;
                Some(Relight { light, expose }.into())
            }
            _ => None,
        }
    }

    /// Edits of the window alone, whose numbers come from the pointer.
    const POINTED_AT: [&str; 4] = ["go_to", "name_layer", "place", "wells"];

    #[test]
    fn each_edit_is_read_from_its_command_line() {
        let mut without = Vec::new();
        for entry in edits::entries() {
            match entry.arguments {
                Some(arguments) => {
                    let example = (entry.example)().expect("in range");
                    assert_eq!(edit_of(arguments), Some(example), "{arguments:?}");
                }
                None => without.push(entry.name),
            }
        }
        without.sort_unstable();
        assert_eq!(without, POINTED_AT);
    }

    #[test]
    fn what_is_out_of_range_is_rejected_on_the_command_line() {
        for (arguments, word) in [
            ("layer|dry|--share|3", "above 0, at most 1"),
            ("layer|dry|--over|soon", "90s"),
            ("layer|dry|--share|0.5|--over|90s", "cannot be used with"),
            ("layer|dry|--region|1,2", "X,Y,WxH"),
            ("layer|opacity|sky|-1", "0 to 1"),
            ("canvas|fill|Bone Black|--um|9000", "1 to 5000 µm"),
            ("canvas|fill", "MIXTURE"),
            ("layer|wet|--layers|0", "1.."),
            ("canvas|size|-2", "0 to 1000 µm"),
            ("brush|tune|--stiffness|99", "0.05 to 20"),
            ("load|Bone Black=0", "not a number above 0"),
            ("brush|load|Bone Black|--brush|a/b", "letters, digits"),
            ("palette|piles|stay", "deplete"),
            ("brush|mode|spunge", "'sponge'"),
        ] {
            let words = std::iter::once("maulstick").chain(arguments.split('|'));
            let rejected = grouped(program()).try_get_matches_from(words);
            let said = rejected.expect_err(arguments).to_string();
            assert!(said.contains(word), "{arguments}: {said}");
        }
    }

    /// Greatest length of a command's line of help, characters: a list of them fits 100 columns.
    const LINE: usize = 90;

    /// The fault of a line of help.
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

    /// Faults in the help of a command and its subcommands.
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
        faults(&program(), "maulstick", &mut found);
        assert!(found.is_empty(), "{found:#?}");
        let code = clap::Command::new("x").about("`x`, with which a y is stopped");
        let nothing = clap::Arg::new("y").long("y");
        faults(&code.arg(nothing), "x", &mut found);
        assert_eq!(found.len(), 2, "a fault would pass: {found:?}");
    }

    #[test]
    fn help_lists_each_command_once() {
        let program = program();
        let mut commands: Vec<_> = program.get_subcommands().map(|c| c.get_name()).collect();
        let mut listed: Vec<_> = HEADINGS
            .iter()
            .flat_map(|(_, names)| *names)
            .copied()
            .collect();
        commands.sort_unstable();
        listed.sort_unstable();
        assert_eq!(commands, listed);
        assert!(commands.len() <= 24, "fewer doors: {commands:?}");
        let help = grouped(program).render_help().to_string();
        let lines: Vec<&str> = help.lines().collect();
        for (heading, names) in HEADINGS {
            let heading = format!("{heading}:");
            let place = lines.iter().position(|line| *line == heading);
            let below = &lines[1 + place.expect("a heading")..];
            let listed = below
                .iter()
                .map_while(|line| line.split_whitespace().next());
            assert_eq!(listed.collect::<Vec<_>>(), *names, "{help}");
        }
    }

    #[test]
    fn a_short_command_is_the_one_of_its_group() {
        let options = |command: &clap::Command| -> Vec<String> {
            let ids = command.get_arguments().map(|one| one.get_id().to_string());
            ids.collect()
        };
        let program = program();
        for (name, group) in DAILY {
            let short = program.find_subcommand(name).expect(name);
            let group_of = program.find_subcommand(group).expect(group);
            let long = group_of.find_subcommand(name).expect(name);
            assert_eq!(options(short), options(long));
            let [about, _] = help(short);
            assert!(
                about.ends_with(&format!("(short for {group} {name})")),
                "{about}"
            );
        }
    }

    #[test]
    fn the_page_of_commands_is_generated() {
        let page = completions::page(&program(), HEADINGS);
        assert!(
            page == include_str!("../../docs/commands.md"),
            "write it anew: cargo run --release -p maulstick -- completions markdown > docs/commands.md"
        );
    }
}
