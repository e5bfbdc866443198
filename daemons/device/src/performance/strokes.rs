//! Strokes of a generated performance, drawn from a seed.

use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng as _;

/// Course of the pressure over a stroke.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Pressure {
    /// It swells and fades.
    Swell,
    /// It grows from a touch to the whole.
    Grow,
}

/// A stroke: a curve through points on the desk, m, its pressure and its duration.
pub(crate) struct Stroke {
    pub(crate) points: Vec<[f64; 2]>,
    pub(crate) pressure: f64,
    pub(crate) course: Pressure,
    pub(crate) seconds: f64,
}

/// Random numbers of a seed, and the strokes drawn with them.
pub(crate) struct Strokes {
    random: Pcg32,
    drawn: Vec<Stroke>,
}

impl Strokes {
    /// No strokes yet.
    pub(crate) fn new(random: Pcg32) -> Self {
        Self {
            random,
            drawn: Vec::new(),
        }
    }

    /// A number in 0..1.
    pub(crate) fn chance(&mut self) -> f64 {
        f64::from(self.random.next_u32()) / (f64::from(u32::MAX) + 1.0)
    }

    /// A number within `spread` of `middle`.
    pub(crate) fn about(&mut self, middle: f64, spread: f64) -> f64 {
        middle + spread * (2.0 * self.chance() - 1.0)
    }

    /// Adds a stroke.
    pub(crate) fn push(&mut self, stroke: Stroke) {
        self.drawn.push(stroke);
    }

    /// Adds a stroke whose pressure swells and fades.
    pub(crate) fn stroke(&mut self, points: Vec<[f64; 2]>, pressure: f64, seconds: f64) {
        self.push(Stroke {
            points,
            pressure,
            course: Pressure::Swell,
            seconds,
        });
    }

    /// Takes the strokes drawn so far.
    pub(crate) fn take(&mut self) -> Vec<Stroke> {
        std::mem::take(&mut self.drawn)
    }
}
