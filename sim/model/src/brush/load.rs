//! Load of a brush: a texture over its strips, a film on their surface and paint inside.

mod soak;

use maulstick_brush::Head;
use maulstick_canvas::page::backing::Content;
use maulstick_canvas::quantum::{Counts, SLOTS};
use maulstick_types::Mixture;

use crate::brush::streaks::streaks;
use crate::brush::traits::{BrushTraits, TEXELS_PER_STRIP};

/// One paint on a brush: counts by texel, `strip · TEXELS_PER_STRIP + along`, 0 at the ferrule.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Held {
    film: Vec<u32>,
    inside: Vec<u32>,
}

/// One paint on a brush, to be moved: counts by texel.
#[derive(Debug)]
pub struct PaintOnBrush<'a> {
    /// Its slot.
    pub slot: usize,
    /// Its films.
    pub film: &'a mut [u32],
    /// Paint inside.
    pub inside: &'a mut [u32],
}

/// The bristles that take paint up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Half {
    /// Both halves.
    Both,
    /// Half toward −x of the brush.
    Left,
    /// Half toward +x of the brush.
    Right,
}

impl Half {
    /// The share that a bristle takes whose root is at `x` of half the ferrule's width: the colours
    /// of a double-loaded brush run into each other a little in its middle.
    fn share(self, x: f64) -> f64 {
        let right = (0.5 + 2.5 * x).clamp(0.0, 1.0);
        match self {
            Self::Both => 1.0,
            Self::Left => 1.0 - right,
            Self::Right => right,
        }
    }
}

/// The seed of a load is the upper half of its count of steps.
const SEED_SHIFT: u32 = 32;
/// By this share the film of thinner alone is thinner than one of paint.
const RUNS_OFF: f64 = 0.7;

/// Thickness of a full film by that of paint, where `thinner` is a share of it.
#[must_use]
pub fn film_share(thinner: f64) -> f64 {
    1.0 - RUNS_OFF * thinner
}

/// The paint on a brush, and the bend that stays in it.
#[derive(Clone, Debug, PartialEq)]
pub struct BrushLoad {
    texels: usize,
    held: [Option<Box<Held>>; SLOTS],
    /// Counts of all paints in each texel's film.
    films: Vec<u32>,
    /// Number of steps with contact.
    steps: u64,
    /// Permanent set: the angles of a solve in the air, rad; empty for an unbent head.
    pub set: Vec<[f32; 2]>,
}

impl BrushLoad {
    /// Bytes in memory.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let planes = 1 + 2 * self.held.iter().flatten().count();
        planes * self.texels * size_of::<u32>()
    }

    /// A saved load: steps with contact, all paints' films as last counted, and for each paint its films and its paint
    /// inside, by texel. `None` if the planes do not fit.
    #[must_use]
    pub fn of_planes(
        steps: u64,
        films: Vec<u32>,
        planes: Vec<(usize, [Vec<u32>; 2])>,
    ) -> Option<Self> {
        let texels = films.len();
        let mut load = Self::clean(0);
        (load.texels, load.steps, load.films) = (texels, steps, films);
        for (slot, [film, inside]) in planes {
            if slot >= SLOTS || film.len() != texels || inside.len() != texels {
                return None;
            }
            load.held[slot] = Some(Box::new(Held { film, inside }));
        }
        Some(load)
    }

    /// Seed of the disorder of its bristles: a new one after each load and at each stroke.
    #[must_use]
    pub fn seed(&self) -> u64 {
        self.steps >> SEED_SHIFT
    }

    /// Draws the disorder of the bristles from another seed.
    pub fn disorder(&mut self, seed: u64) {
        self.steps = seed << SEED_SHIFT | self.steps & ((1 << SEED_SHIFT) - 1);
    }

    /// Steps with contact that it has made.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// A clean brush with this many strips.
    #[must_use]
    pub fn clean(strips: usize) -> Self {
        let texels = strips * TEXELS_PER_STRIP;
        Self {
            texels,
            held: [const { None }; SLOTS],
            films: vec![0; texels],
            steps: 0,
            set: Vec::new(),
        }
    }

    /// Number of texels.
    #[must_use]
    pub fn texels(&self) -> usize {
        self.texels
    }

    /// Counts by slot.
    #[must_use]
    pub fn counts(&self) -> Counts {
        let sum = |plane: &[u32]| plane.iter().map(|count| u64::from(*count)).sum::<u64>();
        std::array::from_fn(|slot| {
            self.held[slot]
                .as_ref()
                .map_or(0, |held| sum(&held.film) + sum(&held.inside))
        })
    }

    /// All counts.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.counts().iter().sum()
    }

    /// All paints' films, as last counted.
    #[must_use]
    pub fn films(&self) -> &[u32] {
        &self.films
    }

    /// Counts of a texel's film.
    #[must_use]
    #[inline]
    pub fn film(&self, texel: usize) -> u32 {
        self.films[texel]
    }

    /// Counts of the thickest film.
    #[must_use]
    pub fn thickest(&self) -> u32 {
        self.films.iter().copied().max().unwrap_or(0)
    }

    /// Counts of all films by those of full ones, 0 to 1.
    #[must_use]
    pub fn fullness(&self, traits: &BrushTraits) -> f32 {
        let full = traits.film_full * self.texels as f64;
        let held: u64 = self.films.iter().map(|count| u64::from(*count)).sum();
        if full > 0.0 {
            (held as f64 / full).min(1.0) as f32
        } else {
            0.0
        }
    }

    /// Counts of the thickest film of a strip.
    #[must_use]
    pub fn thickest_of(&self, strip: usize) -> u32 {
        let run = &self.films[strip * TEXELS_PER_STRIP..(strip + 1) * TEXELS_PER_STRIP];
        run.iter().copied().max().unwrap_or(0)
    }

    /// Takes all paint off; the brush stays bent.
    pub fn take_all(&mut self) -> Counts {
        let (counts, set) = (self.counts(), std::mem::take(&mut self.set));
        *self = Self::clean(self.texels / TEXELS_PER_STRIP);
        self.set = set;
        counts
    }

    /// Fills a half of a clean brush from tubes: full films, and the brush's amount inside, in the mixture's shares,
    /// with random variation from this seed. Paint with thinner in it clings in a thinner film.
    pub fn fill(
        &mut self,
        head: &Head,
        traits: &BrushTraits,
        mixture: &[(usize, f64)],
        thinner: Option<usize>,
        (half, seed): (Half, u64),
    ) {
        let taken = streaks(head, seed);

        let thin = thinner.map_or(0.0, |thinner| {
            let shares = mixture.iter().filter(|(slot, _)| *slot == thinner);
            shares.map(|(_, share)| share).sum()
        });
        let film_full = traits.film_full * film_share(thin);
        for (slot, share) in mixture {
            let held = self.held_mut(*slot);
            let texels = held.film.iter_mut().zip(&mut held.inside);
            for (texel, (film, inside)) in texels.enumerate() {
                let strip = texel / TEXELS_PER_STRIP;
                let half = half.share(f64::from(head.roots()[strip][0]));
                let part = share * half * f64::from(taken[strip]);
                *film += (film_full * part) as u32;
                *inside += (traits.inside_full * part) as u32;
            }
        }
        self.steps = seed << SEED_SHIFT;
        self.count_films();
    }

    /// Share of a slot in all that it carries; 0 of a clean brush.
    #[must_use]
    pub fn share(&self, slot: usize) -> f64 {
        match self.total() {
            0 => 0.0,
            total => self.counts()[slot] as f64 / total as f64,
        }
    }

    /// A brush with another number of strips that carries the same paint, spread evenly: in films of at most
    /// `film_full` quanta a texel, and inside.
    #[must_use]
    pub fn spread(strips: usize, counts: &Counts, film_full: f64) -> Self {
        let mut load = Self::clean(strips);
        let texels = load.texels as u64;
        let all = counts.iter().sum::<u64>().max(1) as f64;
        for (slot, count) in counts.iter().enumerate().filter(|(_, count)| **count > 0) {
            let held = load.held_mut(slot);
            let each = count / texels;
            let film = each.min((film_full * *count as f64 / all) as u64);
            held.film.fill(film as u32);
            held.inside.fill((each - film) as u32);
            held.inside[0] += (count - each * texels) as u32;
        }
        load.count_films();
        load
    }

    /// This load on a head with `strips` strips, where `finer` is the head with more: the paint of several strips is
    /// merged on the one that represents them, or divided among them evenly. A load of another head is spread.
    #[must_use]
    pub fn onto(&self, strips: usize, finer: &Head) -> Self {
        let own = self.texels / TEXELS_PER_STRIP;
        if own == strips {
            return self.clone();
        }
        if own == 0 || finer.strips() != own.max(strips) {
            return Self::spread(strips, &self.counts(), 0.0);
        }
        let mut load = Self::clean(strips);
        (load.steps, load.set) = (self.steps, self.set.clone());
        let stands = finer.nearest_of_first(own.min(strips));
        let mut shares = vec![0; own.min(strips)];
        stands.iter().for_each(|strip| shares[*strip] += 1);
        for (slot, held) in self.held.iter().enumerate() {
            let Some(held) = held else { continue };
            let into = load.held_mut(slot);
            for (from, to) in [
                (&held.film, &mut into.film),
                (&held.inside, &mut into.inside),
            ] {
                for (strip, stands) in stands.iter().enumerate() {
                    for k in 0..TEXELS_PER_STRIP {
                        let (fine, coarse) =
                            (strip * TEXELS_PER_STRIP + k, stands * TEXELS_PER_STRIP + k);
                        if strips < own {
                            to[coarse] += from[fine];
                            continue;
                        }
                        // The first strip, which represented the others, gets the remainder.
                        let (whole, parts) = (from[coarse], shares[*stands]);
                        to[fine] = whole / parts + if strip == *stands { whole % parts } else { 0 };
                    }
                }
            }
        }
        load.count_films();
        load
    }

    /// Counts a step with contact.
    pub fn count_step(&mut self) {
        self.steps += 1;
    }

    /// True if the load may have any of a paint.
    #[must_use]
    pub fn has(&self, slot: usize) -> bool {
        self.held[slot].is_some()
    }

    /// A paint's films and what it has inside.
    pub fn planes_mut(&mut self, slot: usize) -> Option<(&mut [u32], &mut [u32])> {
        let held = self.held[slot].as_mut()?;
        Some((&mut held.film, &mut held.inside))
    }

    /// All paints' films as last counted; then each paint's slot, its films, and what it has inside.
    pub fn parts_mut(&mut self) -> (&mut [u32], impl Iterator<Item = PaintOnBrush<'_>>) {
        let held = self.held.iter_mut().enumerate();
        let paints = held.filter_map(|(slot, held)| {
            let Held { film, inside } = held.as_deref_mut()?;
            Some(PaintOnBrush { slot, film, inside })
        });
        (&mut self.films, paints)
    }

    /// Amount of a paint inside each texel.
    #[must_use]
    pub fn inside(&self, slot: usize) -> Option<&[u32]> {
        self.held[slot].as_ref().map(|held| held.inside.as_slice())
    }

    /// A paint's films.
    #[must_use]
    pub fn film_of(&self, slot: usize) -> Option<&[u32]> {
        self.held[slot].as_ref().map(|held| held.film.as_slice())
    }

    /// Adds paint to a texel's film.
    pub fn add_film(&mut self, slot: usize, texel: usize, count: u32) {
        self.held_mut(slot).film[texel] += count;
    }

    /// Adds to a paint on a texel's film, or subtracts from it.
    #[inline]
    pub fn change_film(&mut self, slot: usize, texel: usize, change: i32) {
        let count = &mut self.held_mut(slot).film[texel];
        *count = count.saturating_add_signed(change);
    }

    /// Sets the amount of a paint in a texel, in its film and inside; returns the former amounts.
    pub fn set_texel(&mut self, slot: usize, texel: usize, holds: [u32; 2]) -> [u32; 2] {
        if holds == [0; 2] && !self.has(slot) {
            return [0; 2];
        }
        let held = self.held_mut(slot);
        let [film, inside] = holds;
        [
            std::mem::replace(&mut held.film[texel], film),
            std::mem::replace(&mut held.inside[texel], inside),
        ]
    }

    /// Counts the films of all paints on these texels afresh.
    pub fn count_films_of(&mut self, texels: &[u32]) {
        for texel in texels {
            self.films[*texel as usize] = 0;
        }
        for held in self.held.iter().flatten() {
            for texel in texels {
                self.films[*texel as usize] += held.film[*texel as usize];
            }
        }
    }

    /// Counts the films of all paints afresh.
    pub fn count_films(&mut self) {
        self.films.fill(0);
        for held in self.held.iter().flatten() {
            self.films
                .iter_mut()
                .zip(&held.film)
                .for_each(|(sum, count)| *sum += count);
        }
    }

    fn held_mut(&mut self, slot: usize) -> &mut Held {
        let texels = self.texels;
        self.held[slot].get_or_insert_with(|| {
            Box::new(Held {
                film: vec![0; texels],
                inside: vec![0; texels],
            })
        })
    }
}

/// A mixture by slots.
pub fn by_slot<E>(
    mixture: &Mixture,
    mut slot: impl FnMut(&str) -> Result<usize, E>,
) -> Result<Vec<(usize, f64)>, E> {
    mixture
        .parts
        .iter()
        .map(|part| Ok((slot(&part.paint)?, part.share)))
        .collect()
}

impl Content for BrushLoad {
    fn bytes(&self) -> usize {
        self.bytes()
    }

    fn nothing() -> Self {
        Self::clean(0)
    }
}

#[cfg(test)]
mod tests {
    use maulstick_brush::BrushFile;

    use super::*;

    /// Thinning to any number of strips conserves their paint, close to its place.
    #[test]
    fn what_thinned_strips_carry_is_all_there() {
        let file = BrushFile::library("flat").expect("flat");
        let (head, few) = (Head::of(&file), file.thinned_to(112));
        assert_eq!(few.strips.count, 112);
        let traits = BrushTraits::of(&file, 2.5e-4, 1.0);
        let mut load = BrushLoad::clean(head.strips());
        load.fill(&head, &traits, &[(3, 1.0)], None, (Half::Left, 7));
        load.add_film(5, 4321, 17);
        let on_few = load.onto(112, &head);
        let again = on_few.onto(head.strips(), &head);
        for other in [&on_few, &again] {
            assert_eq!((other.counts(), other.seed()), (load.counts(), load.seed()));
        }
        let roots = head.roots();
        assert_eq!(&roots[..112], Head::of(&few).roots());
        let is_left = |load: &BrushLoad| {
            let right = |texel: &usize| roots[*texel / TEXELS_PER_STRIP][0] > 0.3;
            let inside = load.inside(3).expect("carried");
            let carried = |texel| u64::from(load.film(texel)) + u64::from(inside[texel]);
            let whole: u64 = (0..load.texels()).map(carried).sum();
            let right: u64 = (0..load.texels()).filter(right).map(carried).sum();
            right < whole / 1000
        };
        assert!(is_left(&load) && is_left(&on_few) && is_left(&again));
        let evenly = BrushLoad::spread(112, &load.counts(), 0.0);
        assert!(!is_left(&evenly), "a fault passes: spread evenly");
    }

    /// A page that cannot be read is a load of no strips.
    #[test]
    fn no_strips_carry_nothing() {
        let head = Head::of(&BrushFile::library("flat").expect("flat"));
        let load = BrushLoad::clean(0).onto(head.strips(), &head);
        assert_eq!(load.texels(), head.strips() * TEXELS_PER_STRIP);
        assert_eq!(load.counts(), [0; SLOTS]);
    }

    #[test]
    fn what_is_spread_over_other_strips_is_all_there() {
        let mut counts = [0; SLOTS];
        (counts[0], counts[7]) = (1_000_003, 17);
        let load = BrushLoad::spread(24, &counts, 0.0);
        assert_eq!(load.counts(), counts);
        let mut load = BrushLoad::spread(300, &load.counts(), 40.0);
        // Its films are as full as possible, with less than a quantum of the rare blue.
        assert!(load.films().iter().all(|film| *film == 39));
        assert_eq!(load.take_all(), counts);
        assert_eq!(load.total(), 0);
    }
}
