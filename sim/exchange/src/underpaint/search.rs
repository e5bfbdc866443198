//! Mixtures for all colours of a picture, which change as smoothly as the colours do.
//!
//! Recipes are sought for the corners of a lattice of colours first. An unreachable corner moves toward grey until it
//! is reachable, along a line of one hue in Oklab ([`maulstick_optics::gamut`], with its grey as far as the paints can
//! make it); a corner darker than the paints becomes the nearest reachable colour. The search for a colour then begins
//! between the recipes of the corners around it, so no seams show between sets of paints, under any light.
//!
//! A colour just outside of the paints' gamut becomes the nearest one inside. For one far outside, the nearest would
//! jump between neighbours, so it is interpolated from the corners around it.

use std::thread::scope;

use maulstick_optics::Studio;
use maulstick_optics::colour::{Matrix, RgbSpace, apply, delta_e_2000, inverse, lab, srgb_decode};
use maulstick_optics::gamut::{FOR_COLOUR, Gamut, GamutMapping};

use super::candidates::Candidates;
use super::films::{Films, MOST_PAINTS, Shares};
use super::recipes::{Recipe, Target, refine};

/// Threads that search: painting itself needs the others.
const THREADS: usize = 2;
/// Colours, and corners, that are solved between two reports of progress.
const BATCH: usize = 4096;
const CORNER_BATCH: usize = 256;
/// Steps of a channel between corners of the lattice, and corners along each of its sides.
const LATTICE: u8 = 15;
const SIDE: usize = 18;
/// Candidates from which the search for a corner begins.
const STARTS: usize = 3;
/// A corner as near as this counts as reached.
const REACHED: f64 = 0.3;
/// Number of halvings between a grey and a corner.
const HALVINGS: usize = 7;
/// Steps of the greys that are tried, and how far inside of them ways begin, Oklab's lightness.
const GREYS: usize = 40;
const INSIDE: f32 = 0.02;
/// Lightness in Oklab over which dark colours become the nearest that are reached instead.
const DUSK: f32 = 0.1;
/// Below the first, a colour becomes the nearest reachable one; above the second, it is interpolated from the corners
/// around it.
const FAR_DELTA_E: [f64; 2] = [0.5, 4.0];

/// A colour that is sought, encoded sRGB, over one of the grounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct TargetColour {
    pub(crate) rgb: [u8; 3],
    /// Number of the ground.
    pub(crate) ground: u64,
}

/// A corner of the lattice: its recipe, and the shift of its colour in CIELAB.
#[derive(Clone, Copy, Debug, Default)]
struct Corner {
    shares: Shares,
    moved: [f64; 3],
}

/// The search with one set of paints, under one light.
pub(crate) struct Search<'a> {
    films: &'a Films,
    from_rgb: Matrix,
    white: [f64; 3],
    linear: [f64; 256],
    gamut: Gamut,
    /// Internal reflectances over which corners are solved.
    mean: Vec<f64>,
    candidates: Candidates,
    /// The darkest and the lightest reachable grey, Oklab's lightness; `None` where none is.
    greys: Option<[f32; 2]>,
}

/// Work on each item, on [`THREADS`] threads, in order.
pub(crate) fn shared<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let share = items.len().div_ceil(THREADS).max(1);
    let parts = scope(|scope| {
        let run = |part: &[T]| part.iter().map(&work).collect::<Vec<R>>();
        let helpers: Vec<_> = items
            .chunks(share)
            .map(|part| scope.spawn(move || run(part)))
            .collect();
        let joined = helpers.into_iter().map(std::thread::ScopedJoinHandle::join);
        joined.collect::<Result<Vec<_>, _>>()
    });
    match parts {
        Ok(parts) => parts.into_iter().flatten().collect(),
        Err(panic) => std::panic::resume_unwind(panic),
    }
}

/// The corners around a colour, by their number, with their weights.
fn around(rgb: [u8; 3]) -> impl Iterator<Item = (usize, f64)> {
    let place = rgb.map(|channel| {
        let low = channel / LATTICE;
        let share = f64::from(channel - low * LATTICE) / f64::from(LATTICE);
        (usize::from(low), share)
    });
    let corner = move |which: usize| {
        let (mut number, mut weight) = (0, 1.0);
        for (axis, (low, share)) in place.iter().enumerate() {
            let high = which >> axis & 1;
            number = number * SIDE + low + high;
            weight *= if high == 1 { *share } else { 1.0 - share };
        }
        (number, weight)
    };
    // Beyond the last corner of a side weights are 0.
    (0..8).map(corner).filter(|(_, weight)| *weight > 0.0)
}

/// The colour of a corner.
fn colour_of(corner: usize) -> [u8; 3] {
    let place = [corner / (SIDE * SIDE), corner / SIDE % SIDE, corner % SIDE];
    place.map(|place| (place * usize::from(LATTICE)).min(255) as u8)
}

impl<'a> Search<'a> {
    /// A search with `films` under the light of a studio; `mean` is the mean reflectance of the ground.
    pub(crate) fn new(films: &'a Films, studio: &Studio, mean: Vec<f64>) -> Self {
        let mut search = Self {
            films,
            from_rgb: inverse(studio.to_rgb()),
            white: studio.white(),
            linear: std::array::from_fn(|i| srgb_decode(i as f64 / 255.0)),
            gamut: Gamut::new(GamutMapping::Soft, &RgbSpace::Srgb.from_working()),
            candidates: Candidates::new(films, &mean),
            mean,
            greys: None,
        };
        search.greys = search.greys();
        search
    }

    fn target(&self, linear: [f64; 3]) -> Target {
        Target::new(lab(apply(&self.from_rgb, linear), self.white))
    }

    fn linear(&self, rgb: [u8; 3]) -> [f64; 3] {
        rgb.map(|byte| self.linear[usize::from(byte)])
    }

    /// The nearest recipe that is found over the mean ground.
    fn nearest(&self, target: &Target) -> Recipe {
        let starts = self.candidates.nearest::<STARTS>(target.lab());
        let found = starts
            .into_iter()
            .map(|start| refine(self.films, start, &self.mean, target));
        let best = found.min_by(|a, b| a.off.total_cmp(&b.off));
        best.unwrap_or(Recipe {
            shares: [0.0; MOST_PAINTS],
            off: f64::INFINITY,
        })
    }

    fn greys(&self) -> Option<[f32; 2]> {
        let reached = |step: &usize| {
            let lightness = *step as f64 / GREYS as f64;
            let grey = lightness * lightness * lightness;
            self.nearest(&self.target([grey; 3])).off < REACHED
        };
        let steps: Vec<usize> = (0..=GREYS).collect();
        let greys = shared(&steps, reached);
        let first = greys.iter().position(|reached| *reached)?;
        let last = greys.iter().rposition(|reached| *reached)?;
        let lightness = |step: usize| step as f32 / GREYS as f32;
        let (low, high) = (lightness(first) + INSIDE, lightness(last) - INSIDE);
        (low < high).then_some([low, high])
    }

    /// The shares of each colour; `under` are the reflectances of the grounds by their number.
    pub(crate) fn all(
        &self,
        sought: &[TargetColour],
        under: &(dyn Fn(u64) -> Vec<f64> + Sync),
        progress: &mut dyn FnMut(u64, u64),
    ) -> Vec<Shares> {
        let mut needed: Vec<usize> = sought
            .iter()
            .flat_map(|sought| around(sought.rgb))
            .map(|(corner, _)| corner)
            .collect();
        needed.sort_unstable();
        needed.dedup();
        let all = (needed.len() + sought.len()) as u64;
        let mut done = 0;
        progress(done, all);
        let mut lattice = vec![Corner::default(); SIDE * SIDE * SIDE];
        for batch in needed.chunks(CORNER_BATCH) {
            let solved = shared(batch, |corner| self.corner(*corner));
            for (corner, solved) in batch.iter().zip(solved) {
                lattice[*corner] = solved;
            }
            done += batch.len() as u64;
            progress(done, all);
        }
        let mut found = Vec::with_capacity(sought.len());
        for batch in sought.chunks(BATCH) {
            found.extend(shared(batch, |sought| {
                self.between(sought.rgb, &under(sought.ground), &lattice)
            }));
            done += batch.len() as u64;
            progress(done, all);
        }
        found
    }

    /// Solves a corner of the lattice.
    fn corner(&self, number: usize) -> Corner {
        let linear = self.linear(colour_of(number));
        let target = self.target(linear);
        let nearest = self.nearest(&target);
        let moved = |became: [f64; 3]| [0, 1, 2].map(|i| became[i] - target.lab()[i]);
        if nearest.off < REACHED {
            return Corner {
                shares: nearest.shares,
                moved: [0.0; 3],
            };
        }
        let mut shares = nearest.shares;
        let light = self.lightness_left(linear);
        if light > 0.0
            && let Some(grey) = self.toward_grey(linear)
        {
            let [near, far] = [shares, grey].map(|shares| self.films.lab(&shares, &self.mean));
            let between = [0, 1, 2].map(|i| near[i] + light * (far[i] - near[i]));
            shares = if light < 1.0 {
                refine(self.films, grey, &self.mean, &Target::new(between)).shares
            } else {
                grey
            };
        }
        Corner {
            shares,
            moved: moved(self.films.lab(&shares, &self.mean)),
        }
    }

    /// 1 for colours at least as light as the darkest grey, 0 for those darker by [`DUSK`]: toward grey
    /// these would lose the little by which they differ.
    fn lightness_left(&self, linear: [f64; 3]) -> f64 {
        let [lightness, ..] = self.gamut.lab(linear.map(|channel| channel as f32));
        let darkest = self.greys.map_or(0.0, |[darkest, _]| darkest);
        f64::from((1.0 + (lightness - darkest) / DUSK).clamp(0.0, 1.0))
    }

    /// The recipe of the most colourful reachable colour between a grey and a colour.
    fn toward_grey(&self, linear: [f64; 3]) -> Option<Shares> {
        let [darkest, lightest] = self.greys?;
        let [lightness, a, b] = self.gamut.lab(linear.map(|channel| channel as f32));
        let from_middle = lightness - 0.5;
        let side = if from_middle < 0.0 { -1.0 } else { 1.0 };
        let e = 0.5 + from_middle.abs() + FOR_COLOUR * (a * a + b * b).sqrt();
        let root = (e * e - 2.0 * from_middle.abs()).max(0.0).sqrt();
        let grey = (0.5 + 0.5 * side * (e - root)).clamp(darkest, lightest);
        let way = [lightness - grey, a, b];
        let at = |share: f32| {
            let place = [grey + share * way[0], share * way[1], share * way[2]];
            let cones = self.gamut.from_lab.map(|row| {
                let root = row[0] * place[0] + row[1] * place[1] + row[2] * place[2];
                root * root * root
            });
            let row = |row: [f32; 3]| row[0] * cones[0] + row[1] * cones[1] + row[2] * cones[2];
            self.target(self.gamut.from_cones.map(|r| f64::from(row(r))))
        };
        let begun = self.nearest(&at(0.0));
        if begun.off >= REACHED {
            return None;
        }
        let (mut low, mut high, mut shares) = (0.0, 1.0, begun.shares);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let target = at(middle);
            let mut found = refine(self.films, shares, &self.mean, &target);
            if found.off >= REACHED {
                found = self.nearest(&target);
            }
            if found.off < REACHED {
                (low, shares) = (middle, found.shares);
            } else {
                high = middle;
            }
        }
        Some(shares)
    }

    /// The recipe of a colour over a ground, from those of the corners around it.
    fn between(&self, rgb: [u8; 3], under: &[f64], lattice: &[Corner]) -> Shares {
        let (mut start, mut moved) = ([0.0; MOST_PAINTS], [0.0; 3]);
        for (number, weight) in around(rgb) {
            let corner = &lattice[number];
            let shares = start.iter_mut().zip(corner.shares);
            shares.for_each(|(sum, share)| *sum += weight * share);
            (0..3).for_each(|i| moved[i] += weight * corner.moved[i]);
        }
        let sum: f64 = start.iter().sum();
        let start = start.map(|share| share / sum);
        let target = self.target(self.linear(rgb));
        let nearest = refine(self.films, start, under, &target);
        let far =
            ((nearest.off - FAR_DELTA_E[0]) / (FAR_DELTA_E[1] - FAR_DELTA_E[0])).clamp(0.0, 1.0);
        if far == 0.0 || moved == [0.0; 3] {
            return nearest.shares;
        }
        let far = far * far * (3.0 - 2.0 * far);
        let near = self.films.lab(&nearest.shares, under);
        let other = [0, 1, 2].map(|i| target.lab()[i] + moved[i]);
        let between = [0, 1, 2].map(|i| near[i] + far * (other[i] - near[i]));
        refine(self.films, start, under, &Target::new(between)).shares
    }

    /// Distance of a mixture over a ground from a colour, ΔE₀₀.
    pub(crate) fn off(&self, sought: &TargetColour, under: &[f64], shares: &Shares) -> f64 {
        let target = self.target(self.linear(sought.rgb));
        delta_e_2000(self.films.lab(shares, under), target.lab())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::underpaint::films::tests::palette;

    #[test]
    fn neighbours_differ_little_however_far_outside_they_are() {
        let (studio, paints) = palette();
        let films = Films::new(&studio, &paints, 60e-6);
        let mean = vec![0.95; studio.wavelengths()];
        let search = Search::new(&films, &studio, mean.clone());
        // From blue over violet to magenta, and from green to a lighter one.
        let violet = (0..=255u8).map(|v| [v, 0, 255]);
        let green = (0..=255u8).map(|v| [v / 2, 255, v / 2]);
        let sought: Vec<TargetColour> = violet
            .chain(green)
            .map(|rgb| TargetColour { rgb, ground: 0 })
            .collect();
        let found = search.all(&sought, &|_| mean.clone(), &mut |_, _| {});
        let labs: Vec<[f64; 3]> = found.iter().map(|s| films.lab(s, &mean)).collect();
        let steps = |range: std::ops::Range<usize>| {
            let pairs = labs[range].windows(2).map(|p| delta_e_2000(p[0], p[1]));
            pairs.fold(0.0, f64::max)
        };
        let (violet, green) = (steps(0..256), steps(256..512));
        println!("violet {violet:.3}, green {green:.3}");
        assert!(violet < 1.5 && green < 1.5);
        // The nearest alone jumps.
        let nearest: Vec<[f64; 3]> = sought[..256]
            .iter()
            .map(|sought| search.nearest(&search.target(search.linear(sought.rgb))))
            .map(|recipe| films.lab(&recipe.shares, &mean))
            .collect();
        let jumps = nearest.windows(2).map(|p| delta_e_2000(p[0], p[1]));
        assert!(jumps.fold(0.0, f64::max) > 3.0, "a fault would pass");
    }

    #[test]
    fn corners_are_around_their_colours() {
        for rgb in [[0, 0, 0], [255, 255, 255], [7, 100, 254], [15, 30, 45]] {
            let mut mean = [0.0; 3];
            let mut weights = 0.0;
            for (corner, weight) in around(rgb) {
                let colour = colour_of(corner);
                (0..3).for_each(|i| mean[i] += weight * f64::from(colour[i]));
                weights += weight;
            }
            let off = (0..3).map(|i| (mean[i] - f64::from(rgb[i])).abs());
            assert!(off.fold(0.0, f64::max) < 1e-9 && (weights - 1.0f64).abs() < 1e-12);
        }
    }
}
