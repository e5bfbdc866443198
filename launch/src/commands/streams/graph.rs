//! `maulstick topic graph`: the processes of a running rig and what they send each other, as a picture.

use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use maulstick_graph::{Graph, mermaid, svg};
use maulstick_recorder::Listener;
use maulstick_rig::UserError;
use maulstick_rig::files::{Kind, ending, write_whole};

use maulstick_painting_setup::outputs::{UsedFile, check_outputs};

use super::measure::duration;
use crate::commands::client::Target;
use crate::commands::{print_json, print_text};

/// Options of `maulstick topic graph`.
#[derive(Args, Clone, Debug)]
pub struct GraphOptions {
    /// Form of the picture [default: as the FILE ends, .svg or .mmd; mermaid without one]
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

impl GraphOptions {
    /// The requested form.
    ///
    /// # Errors
    /// A [`UserError`] for a file name without a known form, or with another one.
    fn form(&self) -> Result<Form, UserError> {
        let Some(path) = &self.output else {
            return Ok(self.format.unwrap_or(Form::Mermaid));
        };
        let told = match ending(path).as_str() {
            "svg" => Some(Form::Svg),
            "mmd" | "mermaid" | "md" => Some(Form::Mermaid),
            _ => None,
        };
        let outputs = [UsedFile::new("the graph", path).of(Kind::Graph)];
        check_outputs(&outputs, &[])?;
        let wrong = |what: &str| {
            UserError::usage(what)
                .at(path.display().to_string())
                .help("end it in .svg or .mmd, or give --format")
        };
        match (self.format, told) {
            (None, Some(told)) => Ok(told),
            (None, None) => Err(wrong("the name does not say which form to draw")),
            (Some(asked), Some(told)) if asked != told => {
                Err(wrong("the name says another form than --format"))
            }
            (Some(asked), _) => Ok(asked),
        }
    }
}

/// Draws the running rig.
///
/// # Errors
/// A [`UserError`] if no rig runs, for a time out of range, or a file that cannot be written.
pub(super) fn run(options: &GraphOptions) -> Result<i32, UserError> {
    let time = duration(options.seconds)?;
    let form = options.form()?;
    let mut listener = Listener::open(options.target.rig(), "**")?;
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

#[cfg(test)]
mod tests {
    use super::*;

    fn form(name: &str, format: Option<Form>) -> Result<Form, String> {
        let folder = tempfile::tempdir().expect("a folder");
        let options = GraphOptions {
            format,
            output: Some(folder.path().join(name)),
            seconds: 1.0,
            json: false,
            target: Target::named("studio"),
        };
        options.form().map_err(|fault| fault.to_string())
    }

    #[test]
    fn the_name_says_the_form_in_small_letters_or_capitals() {
        for name in ["g.svg", "G.SVG"] {
            assert_eq!(form(name, None), Ok(Form::Svg));
        }
        for name in ["g.mmd", "G.MD"] {
            assert_eq!(form(name, None), Ok(Form::Mermaid));
        }
        assert_eq!(form("graph", Some(Form::Svg)), Ok(Form::Svg));
        for name in ["graph", "g.dot", "g.png"] {
            assert!(form(name, None).expect_err(name).contains(".svg"));
        }
        assert!(form("g.mmd", Some(Form::Svg)).is_err());
    }
}
