//! The page docs/commands.md.

use std::fmt::Write as _;

use clap::{Arg, ArgAction, Command};

use super::Headings;

/// Beginning of the page.
const HEAD: &str = "# Commands

`maulstick COMMAND --help` explains the options. Defaults stand in brackets; MM, UM, S and HZ are units of values.
Commands on a running rig take `--name RIG` [studio]. `--overwrite` lets any command overwrite a file that is not a painting.

This page is generated: `cargo run --release -p maulstick -- completions markdown > docs/commands.md`.
";

/// A page of all commands: a table for each group, with options and defaults.
pub(crate) fn page(program: &Command, headings: &Headings) -> String {
    let mut page = HEAD.to_owned();
    for (heading, names) in headings {
        // Writing to a String cannot fail.
        writeln!(page, "\n## {heading}").ok();
        let found = names
            .iter()
            .filter_map(|name| program.find_subcommand(name));
        let (groups, single): (Vec<_>, Vec<_>) = found.partition(|found| is_group(found));
        let rows: Vec<_> = single.into_iter().flat_map(|one| rows(one, "")).collect();
        if !rows.is_empty() {
            page.push_str(&table(&rows));
        }
        for group in groups {
            writeln!(page, "\n### {}\n\n{}.", group.get_name(), about(group)).ok();
            page.push_str(&table(&rows_below(group, group.get_name())));
        }
    }
    page
}

/// True for a group without an action of its own.
fn is_group(command: &Command) -> bool {
    command.is_subcommand_required_set()
}

fn about(command: &Command) -> String {
    command
        .get_about()
        .map(ToString::to_string)
        .unwrap_or_default()
}

fn table(rows: &[[String; 3]]) -> String {
    let mut table = "\n| command | does | options |\n| --- | --- | --- |\n".to_owned();
    for row in rows {
        let [command, about, options] = row.each_ref().map(|cell| cell.replace('|', "\\|"));
        writeln!(table, "| {command} | {about} | {options} |").ok();
    }
    table
}

/// The rows of a command and of those below it, whose names begin with `path`.
fn rows(command: &Command, path: &str) -> Vec<[String; 3]> {
    let path = format!("{path} {}", command.get_name());
    let path = path.trim_start();
    let own = (!is_group(command)).then(|| row(command, path));
    own.into_iter().chain(rows_below(command, path)).collect()
}

fn rows_below(command: &Command, path: &str) -> Vec<[String; 3]> {
    let below = command.get_subcommands();
    below.flat_map(|below| rows(below, path)).collect()
}

fn row(command: &Command, path: &str) -> [String; 3] {
    let mut usage = path.to_owned();
    let places = command.get_positionals();
    for place in places.filter(|place| !place.is_hide_set()) {
        let more = if is_list(place) { "…" } else { "" };
        let name = values(place);
        let shown = if place.is_required_set() {
            format!(" {name}{more}")
        } else {
            format!(" [{name}{more}]")
        };
        usage.push_str(&shown);
    }
    let options = command.get_arguments().filter(|option| {
        let is_common = option.get_id() == "name" && default(option) == "studio";
        !option.is_positional() && !option.is_hide_set() && !is_common
    });
    let options: Vec<_> = options.map(option).collect();
    [format!("`{usage}`"), about(command), options.join(", ")]
}

fn is_list(argument: &Arg) -> bool {
    matches!(argument.get_action(), ArgAction::Append)
}

/// The names of an argument's values.
fn values(argument: &Arg) -> String {
    let names = argument.get_value_names().unwrap_or_default();
    let names: Vec<_> = names.iter().map(|name| name.as_str()).collect();
    names.join(" ")
}

/// The values that stand where none are given; empty if there are none.
fn default(argument: &Arg) -> String {
    let values = argument.get_default_values().iter();
    let values: Vec<_> = values.map(|value| value.to_string_lossy()).collect();
    values.join(",")
}

fn option(option: &Arg) -> String {
    let name = option.get_long().map(|long| format!("--{long}"));
    let name = name.or_else(|| option.get_short().map(|short| format!("-{short}")));
    let name = name.unwrap_or_default();
    if !option.get_action().takes_values() {
        return format!("`{name}`");
    }
    let default = match default(option) {
        value if value.is_empty() => value,
        // Stars would begin bold type.
        value => format!(" [{}]", value.replace('*', "\\*")),
    };
    format!("`{name} {}`{default}", values(option))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_has_places_options_and_defaults() {
        let place = |name: &'static str| Arg::new(name).value_name(name);
        let command = Command::new("cut").about("Cut a|b").args([
            place("TAKE").required(true),
            place("MORE").action(ArgAction::Append),
            Arg::new("s")
                .long("seconds")
                .value_name("S")
                .default_value("2"),
            Arg::new("json").long("json").action(ArgAction::SetTrue),
            Arg::new("name")
                .long("name")
                .value_name("RIG")
                .default_value("studio"),
            Arg::new("own").long("own").hide(true),
        ]);
        let [usage, about, options] = row(&command, "take cut");
        assert_eq!(usage, "`take cut TAKE [MORE…]`");
        assert_eq!(options, "`--seconds S` [2], `--json`");
        assert!(table(&[[usage, about, options]]).contains("| Cut a\\|b |"));
    }
}
