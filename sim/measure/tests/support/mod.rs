//! Synthetic measurements of the measured paints, for tests and for the example of the guide.

#![allow(
    dead_code,
    unreachable_pub,
    missing_docs,
    reason = "shared by test programs and an example, each of which uses a part"
)]

pub mod guide;

use std::fmt::Write as _;

use maulstick_measure::surface::Surface;
use maulstick_optics::{Paint, PaintLibrary, km};
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng as _;

/// Disturbance of readings.
#[derive(Clone, Copy, Debug)]
pub enum Noise {
    None,
    /// Normal, this share of the reading.
    Relative(f64),
    /// Normal, this much.
    Absolute(f64),
}

/// A sample to be made.
#[derive(Clone, Debug)]
pub struct Sample {
    pub name: String,
    pub shares: Vec<f64>,
    /// Thickness in µm, the cell `over`, and the ground's bare reading.
    pub film: Option<(f64, String, f64)>,
}

/// A workbench with some of the measured paints.
pub struct Bench {
    pub paints: Vec<Paint>,
    pub wavelengths_nm: Vec<f64>,
    pub surface: Surface,
    pub samples: Vec<Sample>,
    /// Bare grounds: name and reading.
    pub grounds: Vec<(String, f64)>,
    pub random: Pcg32,
}

pub fn grid(from: f64, to: f64, step: f64) -> Vec<f64> {
    let count = ((to - from) / step).round() as usize;
    (0..=count).map(|i| from + step * i as f64).collect()
}

impl Bench {
    pub fn new(names: &[&str], seed: u64) -> Self {
        let library = PaintLibrary::measured().expect("whole");
        let paints = names
            .iter()
            .map(|name| library.find(name).expect("known").clone());
        Self {
            paints: paints.collect(),
            wavelengths_nm: grid(380.0, 780.0, 4.0),
            surface: Surface::default(),
            samples: Vec::new(),
            grounds: Vec::new(),
            random: Pcg32::new(seed, 1),
        }
    }

    pub fn uniform(&mut self) -> f64 {
        f64::from(self.random.next_u32()) / 4_294_967_296.0
    }

    /// Of the standard normal distribution, by the sum of twelve.
    pub fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }

    /// Adds an opaque mixture of (paint, share).
    pub fn mix(&mut self, parts: &[(usize, f64)]) -> &mut Sample {
        let mut shares = vec![0.0; self.paints.len()];
        for (paint, share) in parts {
            shares[*paint] += share;
        }
        let number = self.samples.len() + 1;
        self.samples.push(Sample {
            name: format!("{number}"),
            shares,
            film: None,
        });
        let last = self.samples.len() - 1;
        &mut self.samples[last]
    }

    /// Masstones of all, then mixtures of two and three until there are `count`. Each paint is mixed
    /// with the first.
    pub fn mixtures(&mut self, count: usize) {
        let paints = self.paints.len();
        for paint in 0..paints {
            self.mix(&[(paint, 1.0)]);
        }
        for paint in 1..paints {
            self.mix(&[(paint, 0.5), (0, 0.5)]);
        }
        while self.samples.len() < count {
            let mut pick = || (self.uniform() * paints as f64) as usize;
            let (a, b, c) = (pick(), pick(), pick());
            if a == b || b == c || a == c {
                continue;
            }
            // Whole percent, as weighed.
            let x = (5.0 + 90.0 * self.uniform()).round() * 0.01;
            let third = self.uniform() < 0.5;
            let y = if third {
                ((1.0 - x) * self.uniform() * 100.0).round() * 0.01
            } else {
                0.0
            };
            self.mix(&[(a, x), (b, 1.0 - x - y), (c, y)]);
        }
    }

    /// Reading of a sample by a noiseless instrument.
    pub fn reading(&self, sample: &Sample, nm: f64) -> f64 {
        let (mut k, mut s) = (0.0, 0.0);
        for (paint, share) in self.paints.iter().zip(&sample.shares) {
            k += share * paint.k.at(nm);
            s += share * paint.s.at(nm);
        }
        let inner = match &sample.film {
            None => km::opaque(k, s),
            Some((um, _, ground)) => {
                let d = um * 1e-6;
                let ground = self.surface.internal(*ground).max(0.0);
                km::over(km::film(k * d, s * d), ground)
            }
        };
        self.surface.reading(inner).0
    }

    /// All samples as read, with noise.
    pub fn read(&mut self, noise: Noise) -> Vec<Vec<f64>> {
        let mut rows = Vec::new();
        for sample in self.samples.clone() {
            let mut row = Vec::new();
            for nm in self.wavelengths_nm.clone() {
                let r = self.reading(&sample, nm);
                let off = match noise {
                    Noise::None => 0.0,
                    Noise::Relative(share) => share * r * self.normal(),
                    Noise::Absolute(size) => size * self.normal(),
                };
                row.push((r + off).max(0.0));
            }
            rows.push(row);
        }
        rows
    }

    /// A table of readings, `digits` behind the point.
    pub fn table(&self, readings: &[Vec<f64>], digits: usize) -> String {
        let films = self.samples.iter().any(|sample| sample.film.is_some());
        let mut text = "sample".to_owned();
        if !self.grounds.is_empty() {
            text.push_str(",kind");
        }
        for paint in &self.paints {
            write!(text, ",{}", paint.name).expect("written");
        }
        if films {
            text.push_str(",thickness_um,over");
        }
        for nm in &self.wavelengths_nm {
            write!(text, ",{nm}").expect("written");
        }
        text.push('\n');
        for (name, r) in &self.grounds {
            let empty = ",".repeat(self.paints.len() + if films { 2 } else { 0 });
            let values = format!(",{r:.digits$}").repeat(self.wavelengths_nm.len());
            writeln!(text, "{name},ground{empty}{values}").expect("written");
        }
        for (sample, row) in self.samples.iter().zip(readings) {
            text.push_str(&sample.name);
            if !self.grounds.is_empty() {
                text.push(',');
            }
            for share in &sample.shares {
                let rounded = (share * 1e4).round() / 1e4;
                let cell = if *share == 0.0 {
                    String::new()
                } else {
                    rounded.to_string()
                };
                write!(text, ",{cell}").expect("written");
            }
            if films {
                let cells = match &sample.film {
                    Some((um, over, _)) => format!("{um},{over}"),
                    None => ",".into(),
                };
                write!(text, ",{cells}").expect("written");
            }
            for r in row {
                write!(text, ",{r:.digits$}").expect("written");
            }
            text.push('\n');
        }
        text
    }
}
