//! `maulstick colour compare`: one graded mixture, mixed in four ways.

use maulstick::commands::colour::mix::blend;
use maulstick::commands::{print_json, print_text, write_picture};
use maulstick::swatch::{Terminal, hex};
use maulstick_optics::Seen;
use maulstick_optics::comparison::{Grading, compare};
use maulstick_painting_setup::library_from;
use maulstick_painting_setup::outputs::{UsedFile, check_outputs};
use maulstick_rig::UserError;
use maulstick_rig::files::Kind;
use maulstick_tool_options::figures::CompareOptions;
use serde_json::{Value, json};

use crate::chart::four_ways;

/// A graded mixture, mixed.
struct Comparison {
    ends: [String; 2],
    shares: Vec<f64>,
    /// Labels of the shares.
    ratios: Vec<String>,
    rows: [Grading; 4],
    /// Name of the rule.
    rule: String,
}

pub(super) fn run(options: &CompareOptions) -> Result<i32, UserError> {
    let output = UsedFile::written("the picture", options.output.as_ref(), Kind::Png);
    let inputs = UsedFile::given("the paints", options.paints.as_ref()).into_iter();
    let inputs: Vec<_> = inputs
        .chain(UsedFile::light(&options.viewing.illuminant))
        .collect();
    check_outputs(output.as_slice(), &inputs)?;
    let compared = mixed(options)?;
    if let Some(path) = &options.output {
        let [from, to] = compared.ends.each_ref().map(String::as_str);
        let picture = four_ways::picture(&compared.rows, [from, to], &compared.rule)?;
        if !options.json {
            super::write(&picture, path)?;
            return Ok(0);
        }
        write_picture(&picture, path)?;
    }
    if options.json {
        print_json(&compared.as_json())?;
    } else {
        print_text(&compared.as_text())?;
    }
    Ok(0)
}

fn mixed(options: &CompareOptions) -> Result<Comparison, UserError> {
    let library = library_from(options.paints.as_deref())?;
    let ends = ends(&options.mixtures)?;
    let (from, to) = (blend(&ends[0], &library)?, blend(&ends[1], &library)?);
    let reference = options.viewing.reference()?;
    let viewing = options.viewing.viewing(&library)?;
    let (shares, ratios): (Vec<f64>, Vec<String>) = four_ways::shares().into_iter().unzip();
    let rows = compare([&from, &to], &shares, &reference, &viewing);
    Ok(Comparison {
        ends,
        shares,
        ratios,
        rows,
        rule: options.viewing.rule_in_words(),
    })
}

/// The two ends of a graded mixture: given ones, those of a mixture of two paints, or the dissertation's as far as
/// measured (its Prussian blue is not).
fn ends(mixtures: &[String]) -> Result<[String; 2], UserError> {
    match mixtures {
        [] => Ok(["Yellow Ochre", "Phthalo Blue Green Shade"].map(str::to_owned)),
        [one, two] => Ok([one.clone(), two.clone()]),
        [one] if one.matches(',').count() == 1 => {
            let name = |part: &str| part.split('=').next().unwrap_or_default().trim().to_owned();
            let (first, second) = one.split_once(',').unwrap_or((one, one));
            Ok([name(first), name(second)])
        }
        _ => Err(UserError::usage(format!(
            "a graded mixture has two ends, not {}",
            mixtures.len()
        ))
        .help("give two mixtures: \"Yellow Ochre\" \"Phthalo Blue Green Shade\"")),
    }
}

impl Comparison {
    fn as_json(&self) -> Value {
        let row = |row: &Grading| {
            json!({
                "name": four_ways::title(row.way, &self.rule),
                "lab": row.seen.iter().map(|seen| seen.lab).collect::<Vec<_>>(),
                "srgb": row.seen.iter().map(Seen::srgb).collect::<Vec<_>>(),
                "delta_e": row.delta_e,
            })
        };
        json!({
            "from": self.ends[0],
            "to": self.ends[1],
            "shares": self.shares,
            "rows": self.rows.iter().map(row).collect::<Vec<_>>(),
        })
    }

    fn as_text(&self) -> String {
        let terminal = Terminal::of_stdout();
        let [from, to] = &self.ends;
        let mut text = format!("{from} to {to}, {}\n", self.ratios.join(" "));
        for row in &self.rows {
            let [mean, most] = four_ways::mean_and_most(&row.delta_e);
            let title = four_ways::title(row.way, &self.rule);
            text += &format!("{title:<21} ΔE₀₀ {mean:5.2}, at most {most:5.2} ");
            for seen in &row.seen {
                text += &match terminal {
                    Terminal::Colours => terminal.block(seen.bytes(), 3).trim_end().to_owned(),
                    Terminal::Plain => format!(" {}", hex(seen.bytes())),
                };
            }
            text.push('\n');
        }
        text
    }
}
