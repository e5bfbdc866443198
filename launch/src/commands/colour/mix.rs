//! `maulstick colour mix`: the colour of a mixture.

use std::path::{Path, PathBuf};

use clap::Args;
use maulstick_appearance::picture::Picture;
use maulstick_optics::comparison::compare;
use maulstick_optics::surface::SurfaceCorrection;
use maulstick_optics::{Blend, Coat, Layer, PaintLibrary, Seen, Spectrum};
use maulstick_rig::UserError;
use maulstick_rig::files::Kind;
use serde_json::json;

use crate::chart::{every_pair, four_ways};
use crate::commands::{print_json, print_text, write_picture};
use crate::outputs::{UsedFile, check_outputs};
use crate::performance::{library_from, mixture_of};
use crate::swatch::{Terminal, hex, in_words, sparkline};
use crate::viewing::ViewingOptions;

/// Options of `maulstick colour mix`.
#[derive(Args, Clone, Debug)]
pub struct MixOptions {
    /// Mixture, shares by volume, such as "2 Cobalt Blue, 1 Titanium White"; with --compare the two
    /// ends of a graded mixture, or one mixture of two paints
    #[arg(value_name = "MIX", required_unless_present_any = ["chart", "compare"])]
    mixtures: Vec<String>,
    /// Draw the mixing chart of all paints
    #[arg(long, requires = "output", conflicts_with_all = ["mixtures", "compare", "json", "FilmOptions"])]
    chart: bool,
    /// Draw one graded mixture, mixed in four ways: K-M with 101 samples, with the rule, with three
    /// samples taken for red, green and blue, and linear RGB
    #[arg(long, conflicts_with = "FilmOptions")]
    compare: bool,
    /// Picture of --chart or --compare to write, a PNG
    #[arg(short, long, value_name = "PNG")]
    output: Option<PathBuf>,
    #[command(flatten)]
    film: FilmOptions,
    #[command(flatten)]
    viewing: ViewingOptions,
    /// Paint file instead of the measured paints
    #[arg(long, value_name = "FILE")]
    paints: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// How the paint lies.
#[derive(Args, Clone, Debug)]
pub struct FilmOptions {
    /// Thickness of a film, µm, thinner included [default: an opaque layer]
    #[arg(long, value_name = "UM", value_parser = thickness, allow_negative_numbers = true)]
    film_um: Option<f64>,
    /// Ground under the film: white, black, or its reading by an instrument, gloss included, 0 to 1, as in
    /// the column `over` of `maulstick colour fit`
    #[arg(long, value_name = "R", requires = "film_um", default_value = "white", value_parser = ground, allow_negative_numbers = true)]
    over: f64,
    /// Share of clear medium in the film, by volume; does not change an opaque layer
    #[arg(long, value_name = "SHARE", default_value = "0", value_parser = share, allow_negative_numbers = true)]
    thinner: f64,
    /// Include the reflections of the paint's surface, as an eye or a spectrometer sees them; otherwise show
    /// the reflectance inside the paint
    #[arg(long)]
    saunderson: bool,
}

fn number(text: &str, range: std::ops::RangeInclusive<f64>, what: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|value| range.contains(value));
    let (low, high) = (range.start(), range.end());
    value.ok_or_else(|| format!("'{text}' is no {what} from {low} to {high}"))
}

fn thickness(text: &str) -> Result<f64, String> {
    number(text, 0.0..=100_000.0, "thickness in µm")
}

fn share(text: &str) -> Result<f64, String> {
    number(text, 0.0..=1.0, "share")
}

fn ground(text: &str) -> Result<f64, String> {
    match text {
        "white" => Ok(1.0),
        "black" => Ok(0.0),
        _ => number(text, 0.0..=1.0, "reading").map_err(|what| what + ", nor white or black"),
    }
}

impl FilmOptions {
    fn coat(&self) -> Coat {
        Coat {
            layer: match self.film_um {
                None => Layer::Opaque,
                Some(um) => Layer::Film {
                    thickness_m: um * 1e-6,
                    thinner: self.thinner,
                    ground: SurfaceCorrection::default().internal(self.over).max(0.0),
                },
            },
            surface: self.saunderson.then(SurfaceCorrection::default),
        }
    }
}

/// Shows a mixture, the chart, or the four ways of mixing.
///
/// # Errors
/// A [`UserError`] for a bad mixture, paint file or light, or a picture that cannot be written.
pub fn run(options: &MixOptions) -> Result<i32, UserError> {
    let library = library_from(options.paints.as_deref())?;
    let output = UsedFile::written("the picture", options.output.as_ref(), Kind::Png);
    let inputs: Vec<_> = UsedFile::given("the paints", options.paints.as_ref())
        .into_iter()
        .chain(UsedFile::light(&options.viewing.illuminant))
        .collect();
    check_outputs(output.as_slice(), &inputs)?;
    if options.chart {
        draw_chart(options, &library)?;
    } else if options.compare {
        four(options, &library)?;
    } else {
        show(options, &library)?;
    }
    Ok(0)
}

fn blend(text: &str, library: &PaintLibrary) -> Result<Blend, UserError> {
    let mixture = mixture_of(text, library).map_err(|fault| fault.at(format!("{text:?}")))?;
    Blend::of(library, &mixture).map_err(|error| UserError::usage(error.to_string()))
}

fn show(options: &MixOptions, library: &PaintLibrary) -> Result<(), UserError> {
    let [text] = options.mixtures.as_slice() else {
        return Err(UserError::usage("more than one mixture")
            .help("put a comma between the paints, and quotes around them: \"A=0.7,B=0.3\""));
    };
    let viewing = options.viewing.viewing(library)?;
    let (blend, coat) = (blend(text, library)?, options.film.coat());
    let (reflectance, seen) = (blend.reflectance(&coat), viewing.coat(&blend, &coat));
    if options.json {
        return print_json(&json!({
            "reflectance": reflectance.0.as_slice(),
            "xyz": seen.xyz.map(|value| 100.0 * value),
            "lab": seen.lab,
            "srgb": seen.srgb(),
            "in_gamut": seen.in_gamut(),
        }));
    }
    print_text(&swatch(text, &reflectance, &seen))
}

fn swatch(text: &str, reflectance: &Spectrum, seen: &Seen) -> String {
    let block = Terminal::of_stdout().block(seen.bytes(), 12);
    let [x, y, z] = seen.xyz.map(|value| 100.0 * value);
    let [low, high] = reflectance
        .0
        .iter()
        .fold([f64::INFINITY, 0.0], |[low, high], r| {
            [r.min(low), r.max(high)]
        });
    let lines = [
        text.to_owned(),
        in_words(seen),
        format!("XYZ {x:.2} {y:.2} {z:.2}"),
        sparkline(reflectance, high.max(1e-9)),
        format!("reflectance from 380 to 780 nm, {low:.3} to {high:.3}"),
    ];
    lines.map(|line| format!("{block}{line}\n")).concat()
}

fn write(picture: &Picture, path: &Path) -> Result<(), UserError> {
    write_picture(picture, path)?;
    let (width, height) = (picture.width, picture.height);
    print_text(&format!("{}: {width}×{height} pixels\n", path.display()))
}

fn draw_chart(options: &MixOptions, library: &PaintLibrary) -> Result<(), UserError> {
    let Some(path) = &options.output else {
        return Ok(());
    };
    let viewing = options.viewing.viewing(library)?;
    write(&every_pair::chart(library, &viewing)?, path)
}

/// The two ends of a graded mixture: given, those of a mixture of two paints, or the dissertation's
/// as far as they are measured (its Prussian blue is not).
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
        .at("--compare")
        .help("give two mixtures: --compare \"Yellow Ochre\" \"Phthalo Blue Green Shade\"")),
    }
}

fn four(options: &MixOptions, library: &PaintLibrary) -> Result<(), UserError> {
    let names = ends(&options.mixtures)?;
    let (from, to) = (blend(&names[0], library)?, blend(&names[1], library)?);
    let (reference, viewing) = (
        options.viewing.reference()?,
        options.viewing.viewing(library)?,
    );
    let (shares, ratios): (Vec<f64>, Vec<String>) = four_ways::shares().into_iter().unzip();
    let rows = compare([&from, &to], &shares, &reference, &viewing);
    let rule = options.viewing.rule_in_words();
    if let Some(path) = &options.output {
        let ends = [names[0].as_str(), names[1].as_str()];
        let picture = four_ways::picture(&rows, ends, &rule)?;
        if !options.json {
            return write(&picture, path);
        }
        write_picture(&picture, path)?;
    }
    if options.json {
        let rows: Vec<_> = rows
            .iter()
            .map(|row| {
                json!({
                    "name": four_ways::title(row.way, &rule),
                    "lab": row.seen.iter().map(|seen| seen.lab).collect::<Vec<_>>(),
                    "srgb": row.seen.iter().map(Seen::srgb).collect::<Vec<_>>(),
                    "delta_e": row.delta_e,
                })
            })
            .collect();
        return print_json(&json!({
            "from": names[0],
            "to": names[1],
            "shares": shares,
            "rows": rows,
        }));
    }
    let terminal = Terminal::of_stdout();
    let mut text = format!("{} to {}, {}\n", names[0], names[1], ratios.join(" "));
    for row in &rows {
        let [mean, most] = four_ways::mean_and_most(&row.delta_e);
        let title = four_ways::title(row.way, &rule);
        text += &format!("{title:<21} ΔE₀₀ {mean:5.2}, at most {most:5.2} ");
        for seen in &row.seen {
            text += &match terminal {
                Terminal::Colours => terminal.block(seen.bytes(), 3).trim_end().to_owned(),
                Terminal::Plain => format!(" {}", hex(seen.bytes())),
            };
        }
        text.push('\n');
    }
    print_text(&text)
}
