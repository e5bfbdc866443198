//! `maulstick painting versions`: the versions of a painting, in a file or in a running rig.

use std::path::PathBuf;

use clap::Args;
use maulstick_bus::Qos;
use maulstick_painting::edits::versions::VersionOptions;
use maulstick_rig::{RigConfig, UserError};
use maulstick_types::Edit;
use maulstick_types::scene::{NamedVersion, Scene};
use serde_json::json;

use maulstick_painting_setup::document::{go_on, there, wrong};
use maulstick_painting_setup::refused;

use crate::commands::client::{Client, Target};
use crate::commands::{print_json, say};

use super::compare::compare;

/// Options of `maulstick painting versions`.
#[derive(Args, Clone, Debug)]
pub struct VersionsOptions {
    /// Painting [default: that of the running rig]
    file: Option<PathBuf>,
    #[command(flatten)]
    edit: VersionOptions,
    /// Draw two versions and their difference side by side; "now" is the current painting
    #[arg(long, value_names = ["ONE", "OTHER"], num_args = 2, group = "act", requires = "output", requires = "file")]
    compare: Option<Vec<String>>,
    /// Picture of the difference to write, a PNG
    #[arg(short, long, value_name = "PNG", requires = "compare")]
    output: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    target: Target,
}

impl VersionsOptions {
    /// The requested edit, if any.
    pub(crate) fn edit(&self) -> Option<Edit> {
        self.edit.edit()
    }
}

/// Lists versions, or applies the requested edit.
///
/// # Errors
/// A [`UserError`] for an unknown version, or where there is no painting.
pub(super) fn run(options: &VersionsOptions) -> Result<i32, UserError> {
    let edit = options.edit();
    let Some(path) = &options.file else {
        let session = Client::open(&options.target)?;
        if let Some(edit) = edit {
            session.send(edit)?;
        }
        let mut scenes = session.follow::<Scene>(&session.topics().scene(), Qos::Cached)?;
        return list(&scenes.wait_for_next()?.message, options.json);
    };
    if let (Some([one, other]), Some(output)) = (options.compare.as_deref(), &options.output) {
        return compare(path, [one, other], output, options.json);
    }
    let Some(edit) = edit else {
        let (_document, opened) = maulstick_painting_setup::document::read(path)?;
        return list(
            opened.sequencer().map_err(refused)?.painting().scene(),
            options.json,
        );
    };
    there(path)?;
    let (document, mut sequencer, since) = go_on(&RigConfig::default(), path)?;
    let autosave = maulstick_session::Autosave::new(document, &mut sequencer, since);
    let done = sequencer.edit(edit).map_err(refused);
    autosave
        .close(&mut sequencer)
        .map_err(|error| wrong(path, &error))?;
    done.map_err(|fault| fault.at(path.display().to_string()))?;
    list(sequencer.painting().scene(), options.json)
}

fn list(scene: &Scene, as_json: bool) -> Result<i32, UserError> {
    if as_json {
        let versions: Vec<_> = scene
            .versions
            .iter()
            .map(|version| json!({"name": version.name, "parent": version.parent, "here": version.here}))
            .collect();
        print_json(&json!({ "versions": versions }))?;
        return Ok(0);
    }
    if scene.versions.is_empty() {
        say!("no versions yet: --keep NAME adds one of the current painting");
    }
    let roots = scene
        .versions
        .iter()
        .filter(|version| version.parent.is_empty());
    for root in roots {
        show(&scene.versions, root, 0)?;
    }
    Ok(0)
}

fn show(all: &[NamedVersion], version: &NamedVersion, depth: usize) -> Result<(), UserError> {
    let here = if version.here {
        "  ← painted on from here"
    } else {
        ""
    };
    say!("{:indent$}{}{here}", "", version.name, indent = 2 * depth);
    let children = all.iter().filter(|other| other.parent == version.name);
    for child in children {
        // A chain of parents has no cycle: names are unique, and a parent exists before its child.
        if depth < all.len() {
            show(all, child, depth + 1)?;
        }
    }
    Ok(())
}
