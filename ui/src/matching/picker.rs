//! Search for mixtures that match a colour of the picture on the canvas. It runs on a thread, since it takes
//! seconds among many paints. Only the newest pick is answered.

use std::sync::Arc;
use std::task::Poll;

use eframe::egui::Context;
use maulstick_appearance::lamp::exposure_under;
use maulstick_appearance::light::studio_settings;
use maulstick_optics::matching::{Proposal, propose};
use maulstick_optics::{Paint, PaintLibrary, Viewing};
use maulstick_types::Mixture;
use maulstick_types::scene::{Light, Surface, WellKind};
use maulstick_ui_kit::background_task::BackgroundTask;

/// Number of mixtures proposed.
const PROPOSED: usize = 3;
/// Light that is weaker than this shows no colour.
const DARK: f64 = 1e-3;

/// A search: the colour and the allowed paints.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Ask {
    /// The colour as a display shows it, linear sRGB.
    pub linear: [f64; 3],
    /// The paints by name; `None` for all.
    pub paints: Option<Vec<String>>,
    /// The light over the canvas.
    pub light: Light,
}

/// A mixture near the colour.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Match {
    pub mixture: Mixture,
    /// Its difference from the colour, ΔE₀₀.
    pub delta_e: f64,
    /// Its colour on the canvas, encoded sRGB.
    pub rgb: [u8; 3],
}

/// Reason why no mixture can be found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(crate) enum NoMatch {
    /// A single paint.
    #[error("one paint alone")]
    OnePaint,
    /// Too little light.
    #[error("too dark")]
    Dark,
    /// A light without colours.
    #[error("{0}")]
    Light(String),
    /// The search has ended without a result.
    #[error("no result")]
    Failed,
}

impl NoMatch {
    /// It and advice, in the language of the window.
    pub(crate) fn words(&self) -> String {
        match self {
            Self::OnePaint => {
                tr!("With one paint there is nothing to mix. Search among all paints.").to_owned()
            }
            Self::Dark => tr!("It is too dark to compare colours. Turn the light up.").to_owned(),
            Self::Light(why) => tr!("The light is none to compare colours in: {why}.", why),
            Self::Failed => tr!("The search has failed. Pick again.").to_owned(),
        }
    }
}

/// Result of a search.
pub(crate) type Matches = Result<Vec<Match>, NoMatch>;

/// The paints of the wells of a palette, each once; `None` for a palette without any.
#[must_use]
pub(crate) fn of_palette(palette: Option<&Surface>) -> Option<Vec<String>> {
    let wells = palette.into_iter().flat_map(|palette| &palette.wells);
    let mut names: Vec<String> = Vec::new();
    for well in wells {
        if let WellKind::Paint { mixture } = &well.kind {
            for part in &mixture.parts {
                if !names.contains(&part.paint) {
                    names.push(part.paint.clone());
                }
            }
        }
    }
    (!names.is_empty()).then_some(names)
}

/// Searches.
///
/// # Errors
/// [`NoMatch`].
pub(crate) fn search(ask: &Ask, library: &PaintLibrary) -> Matches {
    let paints: Vec<Paint> = match &ask.paints {
        None => library.paints().to_vec(),
        Some(names) => {
            let found = names.iter().filter_map(|name| library.find(name).ok());
            found.cloned().collect()
        }
    };
    if paints.len() < 2 {
        return Err(NoMatch::OnePaint);
    }
    let gain = ask.light.intensity * exposure_under(&ask.light);
    if gain < DARK {
        return Err(NoMatch::Dark);
    }
    let settings = studio_settings(&ask.light);
    let settings = settings.map_err(|refusal| NoMatch::Light(refusal.to_string()))?;
    let viewing = Viewing::new(&settings, library.paints());
    let target = viewing
        .display(ask.linear.map(|channel| channel / gain))
        .lab;
    let found = propose(&paints, &viewing, target, PROPOSED);
    let mut all: Vec<Proposal> = found.pairs.into_iter().chain(found.triples).collect();
    all.sort_by(|one, other| one.delta_e.total_cmp(&other.delta_e));
    all.truncate(PROPOSED);
    let shown = |proposal: Proposal| {
        let mut seen = proposal.seen;
        seen.linear = seen.linear.map(|channel| channel * gain);
        Match {
            rgb: seen.bytes(),
            mixture: proposal.mixture,
            delta_e: proposal.delta_e,
        }
    };
    Ok(all.into_iter().map(shown).collect())
}

#[derive(Debug, Default)]
pub(crate) struct Picker {
    asked: Option<Ask>,
    running: Option<(Ask, BackgroundTask<Matches>)>,
    found: Option<Matches>,
}

impl Picker {
    /// Requests a search, unless it repeats the last one.
    pub(crate) fn ask(&mut self, ask: Ask) {
        if self.asked.as_ref() != Some(&ask) {
            (self.asked, self.found) = (Some(ask), None);
        }
    }

    pub(crate) fn forget(&mut self) {
        (self.asked, self.found) = (None, None);
    }

    /// Result for the newest pick; `None` while the search runs.
    pub(crate) fn found(
        &mut self,
        context: &Context,
        library: &Arc<PaintLibrary>,
    ) -> Option<&Matches> {
        if let Some((ask, task)) = &self.running
            && let Poll::Ready(found) = task.poll()
        {
            if Some(ask) == self.asked.as_ref() {
                self.found = Some(found.unwrap_or(Err(NoMatch::Failed)));
            }
            self.running = None;
        }
        // One search at a time: the paint needs the processor too.
        if self.running.is_none()
            && self.found.is_none()
            && let Some(ask) = &self.asked
        {
            let (own, library) = (ask.clone(), Arc::clone(library));
            let run = move || search(&own, &library);
            self.running = Some((ask.clone(), BackgroundTask::start(context, "picker", run)));
        }
        self.found.as_ref()
    }
}

#[cfg(test)]
mod tests {
    use maulstick_optics::colour::srgb_decode;
    use maulstick_painting::PaintingSetup;
    use maulstick_types::scene::PALETTE;

    use super::*;

    fn ask(bytes: [u8; 3]) -> Ask {
        Ask {
            linear: bytes.map(|byte| srgb_decode(f64::from(byte) / 255.0)),
            paints: None,
            light: PaintingSetup::default().scene().light,
        }
    }

    #[test]
    fn the_paints_of_a_palette_are_those_of_its_wells_each_once() {
        let mut scene = PaintingSetup::default().scene();
        let palette = scene.surfaces.iter_mut().find(|s| s.id == PALETTE);
        let palette = palette.expect("a palette");
        let names = of_palette(Some(palette)).expect("paints");
        assert_eq!((names.len(), names[0].as_str()), (10, "Titanium White"));
        palette.wells.push(palette.wells[0].clone());
        assert_eq!(of_palette(Some(palette)), Some(names));
        palette.wells.clear();
        assert_eq!((of_palette(Some(palette)), of_palette(None)), (None, None));
    }

    #[test]
    fn the_nearest_three_are_told_as_they_look_under_the_light() {
        let library = PaintLibrary::measured().expect("whole");
        let palette = PaintingSetup::default().scene();
        let paints = of_palette(palette.surfaces.get(1));
        let ask = Ask {
            paints,
            ..ask([138, 90, 60])
        };
        let found = search(&ask, &library).expect("mixtures");
        assert_eq!(found.len(), 3);
        assert!(found.windows(2).all(|two| two[0].delta_e <= two[1].delta_e));
        let far = |rgb: [u8; 3]| {
            let pairs = rgb.iter().zip([138u8, 90, 60]);
            pairs.map(|(a, b)| a.abs_diff(b)).max().expect("channels")
        };
        println!("{found:?}");
        assert!(
            found[0].delta_e < 2.0 && far(found[0].rgb) < 12,
            "{found:?}"
        );
        // Without the light's strength it would look darker than the picked colour.
        let mut bright = ask.clone();
        bright.light.exposure = 1.0;
        bright.light.intensity = 0.8;
        let other = search(&bright, &library).expect("mixtures");
        assert!(far(other[0].rgb) < 12, "{other:?}");
        assert!(other[0].mixture != found[0].mixture, "a fault would pass");
    }

    #[test]
    fn what_cannot_be_searched_is_told() {
        let library = PaintLibrary::measured().expect("whole");
        let mut dark = ask([9; 3]);
        dark.light.intensity = 0.0;
        assert_eq!(search(&dark, &library), Err(NoMatch::Dark));
        let one = Ask {
            paints: Some(vec!["Titanium White".into(), "no such paint".into()]),
            ..ask([9; 3])
        };
        assert_eq!(search(&one, &library), Err(NoMatch::OnePaint));
    }

    #[test]
    fn the_newest_pick_counts() {
        let library = Arc::new(PaintLibrary::measured().expect("whole"));
        let names = ["Titanium White", "Bone Black"].map(str::to_owned);
        let grey = |byte: u8| Ask {
            paints: Some(names.to_vec()),
            ..ask([byte; 3])
        };
        let context = Context::default();
        let mut picker = Picker::default();
        picker.ask(grey(40));
        assert!(picker.found(&context, &library).is_none());
        picker.ask(grey(200));
        let found = loop {
            match picker.found(&context, &library) {
                Some(found) => break found.clone().expect("a mixture"),
                None => std::thread::yield_now(),
            }
        };
        assert!(found[0].rgb[0].abs_diff(200) < 12, "{found:?}");
    }
}
