//! `maulstick render`: a take, painted in one process.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;
use maulstick_device::Take;
use maulstick_nodes::paint_node::write_snapshot;
use maulstick_nodes::{Keeper, Offline};
use maulstick_paint::{Painting, Sequencer};
use maulstick_rig::files::check_writable;
use maulstick_rig::{Fault, RigConfig};

use crate::commands::progress_bar;
use crate::destination::export;
use crate::document::{go_on, presence, wrong};
use crate::kit::use_kit;
use crate::performance::{PaintingOptions, brush_file, library_from, painting_setup, refused};

/// Options of `maulstick render`.
#[derive(Args, Clone, Debug)]
pub struct RenderOptions {
    /// The take
    take: PathBuf,
    /// The picture, a PNG
    #[arg(short, long, value_name = "PNG")]
    output: PathBuf,
    /// Settings of the rig
    #[arg(long, value_name = "FILE")]
    rig: Option<PathBuf>,
    /// Where the picture goes: srgb, display-p3, or the ICC file of a display or printer; that of
    /// rig.toml if absent
    #[arg(long, value_name = "PROFILE")]
    profile: Option<String>,
    /// How colours come into its gamut: soft, clamp; that of rig.toml if absent
    #[arg(long, value_name = "MAPPING")]
    gamut: Option<String>,
    /// Paints in this painting, and keeps it there; it is begun where there is none
    #[arg(long, value_name = "FILE")]
    document: Option<PathBuf>,
    #[command(flatten)]
    painting: PaintingOptions,
}

/// Paints the take.
///
/// # Errors
/// A [`Fault`] for bad input, or where the picture cannot be written.
pub fn run(options: &RenderOptions) -> Result<i32, Fault> {
    let mut config = match &options.rig {
        Some(path) => RigConfig::read(path)?,
        None => RigConfig::default(),
    };
    let take = Take::read(&options.take)?;
    let folder = tempfile::tempdir().map_err(|error| Fault::failure(error.to_string()))?;
    let embedded = use_kit(&take, &options.take, folder.path(), &mut config)?;
    let section = options.painting.apply(&mut config)?;
    for (setting, option) in [
        (&mut config.view.profile, &options.profile),
        (&mut config.view.gamut, &options.gamut),
    ] {
        if let Some(value) = option {
            setting.clone_from(value);
        }
    }
    let export = export(&config.view, "--profile, --gamut")?;
    let library = library_from(config.paint.paints.as_deref())?;
    let loads = options.painting.kit.mixtures(&embedded, &library)?;
    let unloaded = loads.is_empty();
    for path in [Some(&options.output), options.painting.ledger.as_ref()]
        .into_iter()
        .flatten()
    {
        if is_same(path, &options.take) {
            return Err(Fault::usage("the take would be overwritten")
                .at(path.display().to_string())
                .help("give the picture another name"));
        }
        check_writable(path).map_err(|error| Fault::writing(path, &error))?;
    }
    let (mut keeper, sequencer) = match &options.document {
        Some(path) => {
            presence(path, &options.painting)?;
            let (document, mut sequencer, since) = go_on(&config, path)?;
            let keeper = Keeper::new(document, &mut sequencer, since);
            (Some(keeper), sequencer)
        }
        None => {
            let setup = painting_setup(&config, &library)?;
            let painting = Painting::new(&setup, library).map_err(refused)?;
            (None, Sequencer::new(painting))
        }
    };
    let file = brush_file(&section)?;
    let (name, share) = (&section.name, section.depth_share);
    let mut offline = Offline::going_on(sequencer, name, file, share, loads).map_err(refused)?;
    let begun = Instant::now();
    let bar = progress_bar(take.length_ns()).with_message("painting");
    // The start does not matter to the painting; a live one has the clock's time here.
    let (start_ns, first_ns) = (1_000_000_000, take.samples[0].time_ns);
    for (number, sample) in take.samples.iter().enumerate() {
        let time_ns = sample.time_ns - first_ns;
        offline
            .sample(start_ns + time_ns, &sample.sample)
            .map_err(refused)?;
        if number % 64 == 0 {
            bar.set_position(time_ns / 1_000_000);
            if let Some(keeper) = &mut keeper {
                keeper.turn(offline.sequencer_mut(), begun.elapsed().as_nanos() as u64);
            }
        }
    }
    bar.finish_and_clear();
    let ledger = options.painting.ledger.as_deref();
    write_snapshot(offline.painting_mut(), &options.output, ledger, &export)
        .map_err(|(path, error)| Fault::writing(path.as_ref(), &error))?;
    if let (Some(keeper), Some(path)) = (keeper, &options.document) {
        let closed = keeper.close(offline.sequencer_mut());
        closed.map_err(|error| wrong(path, &error))?;
    }
    if unloaded {
        eprintln!("the brush carried no paint: `--load \"Ultramarine Blue\"` gives it some");
    }
    Ok(0)
}

/// Whether two names lead to one file.
fn is_same(one: &Path, other: &Path) -> bool {
    let real = |path: &Path| std::fs::canonicalize(path).ok();
    real(one).is_some_and(|one| real(other) == Some(one))
}
