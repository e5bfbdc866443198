//! `maulstick graph`: the processes of a running rig and what they send each other, as a picture.
//!
//! | module | holds |
//! | --- | --- |
//! | [`processes`] | the graph, of what each process says that it sends and receives |
//! | [`mermaid`], [`svg`] | its pictures |

mod mermaid;
mod processes;
mod svg;

use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use maulstick_rig::UserError;
use maulstick_rig::files::{Kind, write_whole};

use self::processes::Graph;
use super::listener::Listener;
use super::measure::duration;
use crate::commands::client::Target;
use crate::commands::{print_json, print_text};

/// Options of `maulstick graph`.
#[derive(Args, Clone, Debug)]
pub struct GraphOptions {
    /// Form of the picture [default: svg for a FILE that ends so, else mermaid]
    #[arg(long, value_enum)]
    format: Option<Form>,
    /// File to write; otherwise it is printed
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Measure rates for so long, s
    #[arg(long, value_name = "S", default_value_t = 1.0)]
    seconds: f64,
    /// Print JSON
    #[arg(long, conflicts_with_all = ["format", "output"])]
    json: bool,
    #[command(flatten)]
    target: Target,
}

/// Form of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Form {
    /// Text that GitHub and many editors draw
    Mermaid,
    /// Drawing
    Svg,
}

/// Draws the running rig.
///
/// # Errors
/// A [`UserError`] for a rig that does not run, a time that is out of range, or a file that cannot be written.
pub fn run(options: &GraphOptions) -> Result<i32, UserError> {
    let time = duration(options.seconds)?;
    let mut listener = Listener::open(&options.target, "**")?;
    let traffic = listener.traffic(time);
    let mut rates = BTreeMap::new();
    for (topic, _, stream) in traffic.streams() {
        *rates.entry(topic).or_insert(0.0) += stream.rate_hz();
    }
    let participants = listener.member.participants()?;
    let graph = Graph::of(&participants, &rates, &listener.member.topics);
    if options.json {
        print_json(&graph.json())?;
        return Ok(0);
    }
    let is_svg = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "svg");
    let form = options
        .format
        .unwrap_or(match options.output.as_ref().is_some_and(is_svg) {
            true => Form::Svg,
            false => Form::Mermaid,
        });
    let text = match form {
        Form::Mermaid => mermaid::text(&graph),
        Form::Svg => svg::text(&graph),
    };
    match &options.output {
        None => print_text(&text)?,
        Some(path) => write_whole(path, Kind::Graph, |file| file.write_all(text.as_bytes()))
            .map_err(|error| UserError::writing(path, &error))?,
    }
    Ok(0)
}
