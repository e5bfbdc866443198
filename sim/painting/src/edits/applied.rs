//! Results of edits, and their words.

use std::fmt;

use maulstick_convert::{Distance, OBVIOUS_DELTA_E};
use maulstick_types::Mixture;
use maulstick_types::command::Detail;
use maulstick_types::paint::StepName;
use maulstick_types::scene::Layer;

/// Result of an edit.
#[derive(Clone, Debug, PartialEq)]
pub enum Applied {
    /// Nothing to report.
    Done,
    /// Paint has dried into this layer.
    Dried(Layer),
    /// Paint dries within a number of seconds.
    Drying(f64),
    /// Dry layers are wet again.
    Rewet {
        /// Their names, the newest first.
        layers: Vec<String>,
        /// Cells that could not hold all of it.
        full_cells: usize,
    },
    /// A step was undone or redone.
    Step(StepName),
    /// A brush has taken up a mixture.
    Loaded(Mixture),
    /// A file is written.
    Written(String),
    /// A surface has another paint model.
    Converted {
        /// Distance of its colours from the old ones.
        distance: Distance,
        /// Side of its cells, m.
        cell_m: f64,
    },
}

impl From<Applied> for Detail {
    fn from(applied: Applied) -> Self {
        match applied {
            Applied::Step(name) => Self::Step { name },
            Applied::Dried(layer) => Self::Dried { layer },
            Applied::Loaded(mixture) => Self::Loaded { mixture },
            other => Self::say(other.to_string()),
        }
    }
}

impl fmt::Display for Applied {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Done => Ok(()),
            Self::Dried(_) | Self::Step(_) | Self::Loaded(_) => Detail::from(self.clone()).fmt(f),
            Self::Drying(seconds) => write!(f, "within {seconds:.1} s"),
            Self::Rewet { layers, full_cells } => {
                f.write_str(&layers.join(", "))?;
                match full_cells {
                    0 => Ok(()),
                    cells => write!(f, "; {cells} cells could not hold all of it"),
                }
            }
            Self::Converted { distance, cell_m } => converted(distance, *cell_m, f),
            Self::Written(path) => f.write_str(path),
        }
    }
}

/// Text of the distance of colours, with the place of the greatest, and the reason.
fn converted(distance: &Distance, cell_m: f64, f: &mut fmt::Formatter<'_>) -> fmt::Result {
    let Some(farthest) = &distance.farthest else {
        return f.write_str("colours as before");
    };
    write!(
        f,
        "colours within \u{394}E\u{2080}\u{2080} {:.2} in the mean",
        distance.mean()
    )?;
    let [x, y] = farthest.cell.map(|cell| (cell as f64 + 0.5) * cell_m * 1e3);
    let film_um = farthest.film_m * 1e6;
    let why = if farthest.is_thin() {
        "a film so thin does not hide as it did"
    } else {
        "no mixture of the paints has that colour"
    };
    let worst = distance.worst;
    write!(
        f,
        "; {worst:.1} at most, {x:.1} mm from the left and {y:.1} mm from below, under {film_um:.0} µm of paint"
    )?;
    if worst <= OBVIOUS_DELTA_E {
        return Ok(());
    }
    let share = 100.0 * distance.far as f64 / distance.cells.max(1) as f64;
    write!(
        f,
        ": {why}; {share:.1} % of the paint is off by more than {OBVIOUS_DELTA_E}"
    )
}
