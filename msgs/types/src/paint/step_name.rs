//! Names of the steps of the history.

use std::fmt;

use crate::wire::define::wire_enum;
use crate::wire::worded::{Worded, words_alternative};

wire_enum! {
    /// Name of a step of the history. A window has its own words for it; logs and command lines use `Display`.
    #[derive(Eq)]
    pub enum StepName {
        /// A stroke of a brush.
        Stroke {
            /// Kind of the brush.
            kind: String,
            /// True where it reached nothing but the palette: it changes no picture.
            on_palette: bool,
        },
        /// A stroke of a brush that takes paint away.
        Wipe {
            /// Kind of the brush.
            kind: String,
            /// True where it reached nothing but the palette.
            on_palette: bool,
        },
        /// A brush was loaded.
        Load {
            /// Names of the paints.
            paints: Vec<String>,
        },
        /// A brush was cleaned.
        Clean,
        /// Paint was scraped off.
        Scrape,
        /// A film of paint was laid.
        Fill,
        /// A picture was painted as underpainting.
        Underpainting,
        /// The wells of the palette.
        Wells,
        /// The ground of a surface.
        Ground,
        /// The tooth of a surface.
        Tooth,
        /// The paint model of a surface.
        Model,
        /// Paint was dried at once.
        Dry,
        /// Paint dried over time.
        Drying,
        /// Dry paint was made wet again.
        Wet,
        /// The opacity of a dry layer.
        LayerOpacity,
        /// The name of a dry layer.
        LayerName,
        /// The painting was returned to a version.
        Return {
            /// Name of the version.
            version: String,
        },
        /// Several steps that were merged.
        Merged {
            /// Their number.
            count: u64,
        },
        /// State before the first step.
        Beginning,
        /// A stroke that was dropped before it was painted.
        Unpainted,
        /// A step that its edit alone names, or that only another version knows.
        Words {
            /// Its words.
            words: String,
        },
    }
}

impl StepName {
    /// The name of what a brush did on the palette alone, or also elsewhere.
    #[must_use]
    pub fn placed(mut self, is_on_palette: bool) -> Self {
        if let Self::Stroke { on_palette, .. } | Self::Wipe { on_palette, .. } = &mut self {
            *on_palette = is_on_palette;
        }
        self
    }

    /// The name with each of its texts cut to `letters`, and of the paints those that fit.
    #[must_use]
    pub fn shortened(&self, letters: usize) -> Self {
        let cut = |text: &String| text.chars().take(letters).collect();
        let mut name = self.clone();
        match &mut name {
            Self::Stroke { kind: text, .. }
            | Self::Wipe { kind: text, .. }
            | Self::Return { version: text }
            | Self::Words { words: text } => *text = cut(text),
            Self::Load { paints } => {
                let mut left = letters;
                paints.retain(|paint| {
                    let rest = left.checked_sub(paint.chars().count());
                    left = rest.unwrap_or(0);
                    rest.is_some()
                });
            }
            _ => {}
        }
        name
    }

    /// Words of a step that has no fields.
    fn plain(&self) -> Option<&'static str> {
        Some(match self {
            Self::Clean => "clean brush",
            Self::Scrape => "scrape",
            Self::Fill => "fill",
            Self::Underpainting => "underpainting",
            Self::Wells => "paints on the palette",
            Self::Ground => "ground",
            Self::Tooth => "tooth",
            Self::Model => "paint model",
            Self::Dry => "dry",
            Self::Drying => "drying",
            Self::Wet => "wet",
            Self::LayerOpacity => "layer opacity",
            Self::LayerName => "layer name",
            Self::Beginning => "the beginning",
            Self::Unpainted => "a stroke that was not painted yet",
            Self::Stroke { .. }
            | Self::Wipe { .. }
            | Self::Load { .. }
            | Self::Return { .. }
            | Self::Merged { .. }
            | Self::Words { .. } => return None,
        })
    }
}

/// The steps without fields that earlier versions had in words.
static PLAIN: [StepName; 15] = [
    StepName::Clean,
    StepName::Scrape,
    StepName::Fill,
    StepName::Underpainting,
    StepName::Wells,
    StepName::Ground,
    StepName::Tooth,
    StepName::Model,
    StepName::Dry,
    StepName::Drying,
    StepName::Wet,
    StepName::LayerOpacity,
    StepName::LayerName,
    StepName::Beginning,
    StepName::Unpainted,
];

/// Words after those of what a brush did, on the palette alone and elsewhere.
static PLACES: [(&str, bool); 2] = [(" on the palette", true), ("", false)];

fn place(on_palette: bool) -> &'static str {
    let [(there, _), (elsewhere, _)] = PLACES;
    if on_palette { there } else { elsewhere }
}

/// Words before and after the text of a step that has one, and the step of such a text.
type Form = (&'static str, &'static str, fn(&str) -> Option<StepName>);

/// Forms of the steps that earlier versions had in words with a text in them.
static FORMS: [Form; 5] = [
    ("", " stroke", |kind| {
        let (kind, on_palette) = (kind.to_owned(), false);
        Some(StepName::Stroke { kind, on_palette })
    }),
    ("", " wipe", |kind| {
        let (kind, on_palette) = (kind.to_owned(), false);
        Some(StepName::Wipe { kind, on_palette })
    }),
    ("load ", "", |paints| {
        let paints = paints.split(" + ").map(str::to_owned).collect();
        Some(StepName::Load { paints })
    }),
    ("return to '", "'", |version| {
        let version = version.to_owned();
        Some(StepName::Return { version })
    }),
    ("", " steps", |count| {
        let count = count.parse().ok()?;
        Some(StepName::Merged { count })
    }),
];

impl fmt::Display for StepName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stroke { kind, on_palette } => write!(f, "{kind} stroke{}", place(*on_palette)),
            Self::Wipe { kind, on_palette } => write!(f, "{kind} wipe{}", place(*on_palette)),
            Self::Load { paints } => write!(f, "load {}", paints.join(" + ")),
            Self::Return { version } => write!(f, "return to '{version}'"),
            Self::Merged { count } => write!(f, "{count} steps"),
            Self::Words { words } => f.write_str(words),
            plain => f.write_str(plain.plain().unwrap_or_default()),
        }
    }
}

impl Worded for StepName {
    fn of_words(words: &str) -> Self {
        if let Some(name) = PLAIN.iter().find(|name| name.plain() == Some(words)) {
            return name.clone();
        }
        // Earlier versions said it of loads and cleanings too.
        let mut places = PLACES.iter();
        let placed = places.find_map(|(end, place)| Some((words.strip_suffix(end)?, *place)));
        let (done, on_palette) = placed.unwrap_or((words, false));
        if Self::Clean.plain() == Some(done) {
            return Self::Clean;
        }
        let named = FORMS.iter().find_map(|(before, after, name)| {
            let text = done.strip_prefix(before)?.strip_suffix(after)?;
            name(text)
        });
        if let Some(name) = named {
            return name.placed(on_palette);
        }
        let words = words.to_owned();
        Self::Words { words }
    }

    words_alternative!();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_in_words_is_the_same_step() {
        let text = str::to_owned;
        let named = [
            StepName::Load {
                paints: vec![text("Cobalt Blue"), text("Ivory Black")],
            },
            StepName::Return {
                version: text("first 'one'"),
            },
            StepName::Merged { count: 12 },
            StepName::Words {
                words: text("none of these"),
            },
        ];
        let strokes = [false, true].into_iter().flat_map(|on_palette| {
            let kind = || text("round");
            [
                StepName::Stroke {
                    kind: kind(),
                    on_palette,
                },
                StepName::Wipe {
                    kind: kind(),
                    on_palette,
                },
            ]
        });
        let plain = PLAIN.iter().cloned();
        for name in plain.chain(named).chain(strokes) {
            let words = name.to_string();
            assert_eq!(StepName::of_words(&words), name, "{words}");
        }
    }

    #[test]
    fn a_long_name_is_cut() {
        let paints = vec!["x".repeat(50), "y".repeat(50), "z".repeat(9)];
        let load = StepName::Load { paints }.shortened(60);
        let paints = vec!["x".repeat(50)];
        assert_eq!(load, StepName::Load { paints });
        let version = "ä".repeat(50);
        let back = StepName::Return { version }.shortened(3);
        let version = "äää".to_owned();
        assert_eq!(back, StepName::Return { version });
    }
}
