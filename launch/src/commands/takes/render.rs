//! `maulstick render`: a take, or a script, painted in one process.

use std::path::{Path, PathBuf};

use maulstick_appearance::picture::Export;
use maulstick_brush::speed_limit::FASTEST_M_S;
use maulstick_device::{Take, use_kit};
use maulstick_document::Document;
use maulstick_optics::PaintLibrary;
use maulstick_paint_node::snapshots::write_snapshot;
use maulstick_painting::{Painting, Sequencer};
use maulstick_recorder::session_file::SessionFile;
use maulstick_rig::files::{Kind, ending};
use maulstick_rig::{RigConfig, UserError};
use maulstick_session::{Autosave, Offline};
use maulstick_types::Mixture;

pub use super::render_options::RenderOptions;
use maulstick_painting_setup::backend::choose_backend;
use maulstick_painting_setup::cells::picture_settings;
use maulstick_painting_setup::destination::export;
use maulstick_painting_setup::document::{Presence, go_on, presence, wrong};
use maulstick_painting_setup::outputs::{UsedFile, check_apart, check_outputs, named_by};
use maulstick_painting_setup::{brush_file, library_from, painting_setup, refused};
use maulstick_script::ScriptRunner;
use maulstick_script::{Act, Script, advice};

use super::render_session::render_session;
use crate::commands::progress_bar;

impl RenderOptions {
    /// The files that are read, except those named by the script.
    fn inputs(&self, config: &RigConfig) -> Vec<UsedFile> {
        let document = self.document.iter();
        named_by(config)
            .into_iter()
            .chain(UsedFile::given("the take", self.take.as_ref()))
            .chain(UsedFile::given("the script", self.script.as_ref()))
            .chain(UsedFile::given("the settings", self.rig.as_ref()))
            .chain(document.map(|path| UsedFile::painting(path)))
            .collect()
    }

    /// The take, if it is a recorded session.
    fn session(&self) -> Result<Option<SessionFile>, UserError> {
        let session = self.take.as_deref().map(SessionFile::find).transpose()?;
        Ok(session.flatten())
    }

    /// Puts profile and gamut mapping into the settings.
    fn show(&self, config: &mut RigConfig) {
        for (setting, option) in [
            (&mut config.view.profile, &self.profile),
            (&mut config.view.gamut, &self.gamut),
        ] {
            if let Some(value) = option {
                setting.clone_from(value);
            }
        }
    }

    /// The files that are written, except the painting.
    fn outputs(&self) -> Vec<UsedFile> {
        std::iter::once(UsedFile::new("the picture", &self.output).of(Kind::Png))
            .chain(UsedFile::written(
                "the ledger",
                self.painting.ledger.as_ref(),
                Kind::Ledger,
            ))
            .collect()
    }

    /// Rejects options without effect.
    fn check_idle(&self) -> Result<(), UserError> {
        let painting = &self.painting;
        if self.until.is_some() {
            return Err(UserError::usage("--until is for a recorded session")
                .help("cut a take with `maulstick take cut`"));
        }
        if let (Some(_), Some(load)) = (&self.script, painting.kit.load.first()) {
            return Err(UserError::usage("--load does nothing beside --script")
                .help(format!("load in the script: {{ load = {load:?} }}")));
        }
        for (option, given) in [
            ("--memory", &painting.memory),
            ("--history", &painting.history),
            ("--record", &painting.record),
        ] {
            if given.is_some() && self.document.is_none() {
                return Err(
                    UserError::usage(format!("{option} does nothing without --document"))
                        .help("it is for a painting in a file: --document FILE.maul"),
                );
            }
        }
        Ok(())
    }
}

/// Prints the number of samples that were faster than a hand, where strokes have gaps.
fn tell_haste(too_fast: u64) {
    if too_fast > 0 {
        eprintln!(
            "samples faster than {FASTEST_M_S} m/s: {too_fast}; the brush began anew at each, and nothing is painted on \
             the way to it; `maulstick take retime` makes a take slower"
        );
    }
}

/// Reads a take; a script in its place is refused with advice.
fn read_take(path: &Path) -> Result<Take, UserError> {
    Take::read(path).map_err(|fault| {
        if ending(path) == "toml" && path.exists() {
            fault.help(format!(
                "a script is painted with `--script {}`",
                path.display()
            ))
        } else {
            fault
        }
    })
}

/// Paints the take.
///
/// # Errors
/// A [`UserError`] for bad input, or where the picture cannot be written.
pub fn run(options: &RenderOptions) -> Result<i32, UserError> {
    let mut config = match &options.rig {
        Some(path) => RigConfig::read(path)?,
        None => picture_settings(),
    };
    if let Some(session) = options.session()? {
        options.show(&mut config);
        check_outputs(&options.outputs(), &options.inputs(&config))?;
        return render_session(options, session, &config);
    }
    options.check_idle()?;
    let take = match &options.take {
        Some(path) => Some((path, read_take(path)?)),
        None => None,
    };
    let folder = tempfile::tempdir().map_err(|error| UserError::failure(error.to_string()))?;
    let embedded = match &take {
        Some((path, take)) => use_kit(take, path, folder.path(), &mut config)?,
        None => Vec::new(),
    };
    let section = options.painting.apply(&mut config)?;
    options.show(&mut config);
    let export = export(&config.view, "--profile, --gamut")?;
    let (outputs, inputs) = (options.outputs(), options.inputs(&config));
    check_apart(&outputs, &inputs)?;
    let begun = match &options.document {
        Some(path) if presence(path, &options.painting)? == Presence::There => {
            Some(go_on(&config, path)?)
        }
        _ => None,
    };
    let library = match &begun {
        // It has its own paints.
        Some((_, sequencer, _)) => sequencer.painting().library().clone(),
        None => library_from(config.paint.paints.as_deref())?,
    };
    let loads = options.painting.kit.mixtures(&embedded, &library)?;
    let unloaded = loads.is_empty() && options.script.is_none();
    let script = options.steps(take, &loads, &library)?;
    options.take_size(&script, &mut config)?;
    let mut written = outputs.clone();
    written.extend(options.document.iter().map(|path| UsedFile::painting(path)));
    check_apart(&written, &script.files)?;
    check_outputs(&outputs, &inputs)?;
    let (autosave, mut sequencer) = options.sequencer(&config, library, begun)?;
    choose_backend(&mut sequencer, &config.paint.backend)?;
    let file = brush_file(&section)?;
    let (name, share) = (&section.name, section.depth_share);
    let offline = Offline::resume(sequencer, name, file, share, loads).map_err(refused)?;
    let too_fast = options.paint(offline, autosave, script, &export)?;
    if unloaded {
        eprintln!("the brush carried no paint: `--load \"Ultramarine Blue\"` gives it some");
    }
    tell_haste(too_fast);
    Ok(0)
}

impl RenderOptions {
    /// The steps of the script, or the take as the only one.
    fn steps(
        &self,
        take: Option<(&PathBuf, Take)>,
        loads: &[Mixture],
        library: &PaintLibrary,
    ) -> Result<Script, UserError> {
        if let Some(path) = &self.script {
            return Script::read(path, library);
        }
        let act = |(path, take): (&PathBuf, Take)| {
            (path.display().to_string(), Act::Take(take, loads.to_vec()))
        };
        Ok(Script {
            steps: take.map(act).into_iter().collect(),
            ..Script::default()
        })
    }

    /// Puts the size that a script asks for into the settings.
    fn take_size(&self, script: &Script, config: &mut RigConfig) -> Result<(), UserError> {
        let Some(size_mm) = script.canvas_mm else {
            return Ok(());
        };
        if self.painting.kit.size.is_some() {
            return Err(
                UserError::usage("--size does nothing beside a script's 'canvas_mm'")
                    .help("leave one of them out"),
            );
        }
        [config.canvas.width_mm, config.canvas.height_mm] = size_mm;
        Ok(())
    }

    /// The painting to paint in, and its autosave if it is in a file.
    fn sequencer(
        &self,
        config: &RigConfig,
        library: PaintLibrary,
        begun: Option<(Document, Sequencer, u64)>,
    ) -> Result<(Option<Autosave>, Sequencer), UserError> {
        let Some(path) = &self.document else {
            let setup = painting_setup(config, &library)?;
            let painting = Painting::new(&setup, library).map_err(refused)?;
            return Ok((None, Sequencer::new(painting)));
        };
        let (document, mut sequencer, since) = match begun {
            Some(begun) => begun,
            None => go_on(config, path)?,
        };
        let autosave = Autosave::new(document, &mut sequencer, since);
        Ok((Some(autosave), sequencer))
    }

    /// Paints and writes the picture; returns how many samples were faster than a hand.
    fn paint(
        &self,
        offline: Offline,
        mut autosave: Option<Autosave>,
        script: Script,
        export: &Export,
    ) -> Result<u64, UserError> {
        let bar = progress_bar(script.length_ns()).with_message("painting");
        let mut runner = ScriptRunner::new(offline, &mut autosave, bar);
        let painted = runner.follow_script(script);
        let mut offline = runner.offline;
        let mut close = |offline: &mut Offline| match (autosave.take(), &self.document) {
            (Some(autosave), Some(path)) => autosave
                .close(offline.sequencer_mut())
                .map_err(|error| wrong(path, &error)),
            _ => Ok(()),
        };
        if let Err(fault) = painted {
            // The strokes painted before it are saved.
            close(&mut offline)?;
            let is_script = self.script.is_some();
            return Err(if is_script {
                fault.worded(advice::words)
            } else {
                fault
            });
        }
        let ledger = self.painting.ledger.as_deref();
        write_snapshot(offline.painting_mut(), &self.output, ledger, export)
            .map_err(|(path, error)| UserError::writing(&path, &error))?;
        close(&mut offline)?;
        Ok(offline.too_fast())
    }
}
