//! Non-empty stretches of fields: loops over them cost by the paint in a window and not by its size.

use std::ops::Range;

use maulstick_num::{fork_join, wide};

/// Alignment of the beginning and end of a stretch, places.
const BLOCK: usize = 16;
/// Greatest gap over which stretches are merged, places.
const GAP: usize = 32;
/// Number of places from which cores share a loop.
const WORTH: usize = 4096;
/// Number of places of a window from which cores share field-by-field work.
const WINDOW_WORTH: usize = 14_000;
/// Number of parts of all stretches, whatever the number of threads.
const PARTS: usize = 4;

/// Stretches of a field, from the first place on.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Runs {
    list: Vec<Range<usize>>,
    /// Index of the first stretch of each part, and the number of all.
    cuts: [usize; PARTS + 1],
    len: usize,
}

/// Does the work on each share of a window, on several cores where its number of places justifies it.
pub(crate) fn share<S: Send>(places: usize, shares: &mut [S], work: impl Fn(&mut S) + Sync) {
    if places < WINDOW_WORTH {
        shares.iter_mut().for_each(work);
    } else {
        fork_join::each(shares, work);
    }
}

wide! {
    /// Stretches with a value that is not 0.
    fn find(list: &mut Vec<Range<usize>>, begin: usize, field: &[f32]) {
        for (number, block) in field.chunks(BLOCK).enumerate() {
            let mut bits = 0;
            for value in block {
                bits |= value.to_bits();
            }
            if bits != 0 {
                let start = begin + number * BLOCK;
                let end = start + block.len();
                match list.last_mut() {
                    Some(last) if start <= last.end + GAP => last.end = end,
                    _ => list.push(start..end),
                }
            }
        }
    }
}

/// A part of the work on fields: its stretches, the offset of its parts of the fields, and these.
type Share<'a, T, const N: usize> = (&'a [Range<usize>], usize, [&'a mut [T]; N]);

impl Runs {
    /// Finds the stretches within a range where a mask is not 0.
    pub fn find(&mut self, range: Range<usize>, mask: &[f32]) {
        self.list.clear();
        find(&mut self.list, range.start, &mask[range]);
        self.len = self.list.iter().map(ExactSizeIterator::len).sum();
        self.cut();
    }

    /// Cuts the stretches into parts of the same length.
    fn cut(&mut self) {
        let (mut run, mut done) = (0, 0);
        for part in 1..PARTS {
            let wanted = (part * self.len / PARTS).next_multiple_of(BLOCK);
            while run < self.list.len() && done + self.list[run].len() <= wanted {
                done += self.list[run].len();
                run += 1;
            }
            if run < self.list.len() && done < wanted {
                let Range { start, end } = self.list[run];
                let middle = start + wanted - done;
                self.list[run] = start..middle;
                self.list.insert(run + 1, middle..end);
                done = wanted;
                run += 1;
            }
            self.cuts[part] = run;
        }
        self.cuts[PARTS] = self.list.len();
    }

    /// Pieces of these stretches outside of all `others`.
    #[must_use]
    pub fn without(&self, others: &Self) -> Vec<Range<usize>> {
        let mut left = Vec::new();
        let mut next = 0;
        for run in &self.list {
            let mut start = run.start;
            while let Some(other) = others.list.get(next).filter(|other| other.start < run.end) {
                if other.start > start {
                    left.push(start..other.start);
                }
                start = start.max(other.end);
                if other.end > run.end {
                    break;
                }
                next += 1;
            }
            if start < run.end {
                left.push(start..run.end);
            }
        }
        left
    }

    /// The stretches.
    pub fn iter(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        self.list.iter().cloned()
    }

    /// Number of places.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.len
    }

    /// True if there is none.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Parts that threads share.
    fn shares(&self) -> usize {
        if self.len < WORTH {
            return 1;
        }
        match fork_join::threads() {
            1 => 1,
            2 | 3 => 2,
            _ => PARTS,
        }
    }

    /// Writes fields: calls with each stretch and its parts of them, on several cores where that is worthwhile.
    pub fn write<T: Send, const N: usize>(
        &self,
        fields: [&mut [T]; N],
        work: impl Fn(Range<usize>, [&mut [T]; N]) + Sync,
    ) {
        match self.shares() {
            1 => perform((&self.list, 0, fields), &work),
            2 => self.spread::<T, N, 2>(fields, &work),
            _ => self.spread::<T, N, PARTS>(fields, &work),
        }
    }

    fn spread<T: Send, const N: usize, const SHARES: usize>(
        &self,
        fields: [&mut [T]; N],
        work: &(impl Fn(Range<usize>, [&mut [T]; N]) + Sync),
    ) {
        let (mut rest, mut begin) = (fields, 0);
        let mut shares: [Option<Share<'_, T, N>>; SHARES] = std::array::from_fn(|share| {
            let [from, to] = [share, share + 1].map(|share| self.cuts[share * PARTS / SHARES]);
            let runs = &self.list[from..to];
            let end = runs.last().map_or(begin, |run| run.end);
            let own = rest.each_mut().map(|field| {
                let (own, others) = std::mem::take(field).split_at_mut(end - begin);
                *field = others;
                own
            });
            Some((runs, std::mem::replace(&mut begin, end), own))
        });
        fork_join::each(&mut shares, |share| {
            if let Some(share) = share.take() {
                perform(share, work);
            }
        });
    }

    /// Sums over parts, added up in their order.
    pub fn sum<const N: usize>(
        &self,
        work: impl Fn(&[Range<usize>]) -> [f64; N] + Sync,
    ) -> [f64; N] {
        let part = |part: usize| &self.list[self.cuts[part]..self.cuts[part + 1]];
        let mut parts: [_; PARTS] = std::array::from_fn(|number| (part(number), [0.0; N]));
        if self.shares() == 1 {
            parts.iter_mut().for_each(|(runs, sums)| *sums = work(runs));
        } else {
            fork_join::each(&mut parts, |(runs, sums)| *sums = work(runs));
        }
        let mut total = [0.0; N];
        for (_, sums) in parts {
            total
                .iter_mut()
                .zip(sums)
                .for_each(|(total, sum)| *total += sum);
        }
        total
    }
}

fn perform<T, const N: usize>(
    (runs, begin, mut fields): Share<'_, T, N>,
    work: &impl Fn(Range<usize>, [&mut [T]; N]),
) {
    for run in runs {
        let own = run.start - begin..run.end - begin;
        let parts = fields.each_mut().map(|field| &mut field[own.clone()]);
        work(run.clone(), parts);
    }
}

#[cfg(test)]
mod tests {
    use maulstick_num::fork_join::with_threads;

    use super::*;

    fn mask(len: usize) -> Vec<f32> {
        (0..len)
            .map(|i| f32::from(u8::from(i % 700 < 430 && i > 90)))
            .collect()
    }

    #[test]
    fn every_place_of_the_mask_is_in_one_stretch() {
        for len in [64, 1000, 30_000] {
            let mask = mask(len);
            let mut runs = Runs::default();
            runs.find(40..len - 8, &mask);
            let mut seen = vec![0; len];
            runs.iter().flatten().for_each(|place| seen[place] += 1);
            for place in 40..len - 8 {
                let wanted = i32::from(mask[place] > 0.0);
                assert!(seen[place] >= wanted && seen[place] < 2, "{place}");
            }
            assert_eq!(seen.iter().sum::<i32>() as usize, runs.len());
            assert!(runs.len() < len - 48 || len == 64, "gaps are left out");
        }
    }

    #[test]
    fn what_is_left_of_stretches_is_in_none_of_the_others() {
        let all = mask(9000);
        let some = |keep: fn(usize) -> bool| {
            let kept = all.iter().enumerate();
            let kept: Vec<f32> = kept
                .map(|(i, on)| if keep(i) { *on } else { 0.0 })
                .collect();
            let mut runs = Runs::default();
            runs.find(0..kept.len(), &kept);
            runs
        };
        let cuts: [fn(usize) -> bool; 5] = [
            |_| true,
            |_| false,
            |i| i > 4000,
            |i| i % 200 < 100,
            |i| i % 330 > 150,
        ];
        for one in cuts {
            for other in cuts {
                let (one, other) = (some(one), some(other));
                let mut seen = vec![false; all.len()];
                one.without(&other)
                    .into_iter()
                    .flatten()
                    .for_each(|place| seen[place] = true);
                for place in 0..all.len() {
                    let [in_one, in_other] =
                        [&one, &other].map(|runs| runs.iter().any(|run| run.contains(&place)));
                    assert_eq!(seen[place], in_one && !in_other);
                }
            }
        }
    }

    #[test]
    fn threads_write_and_add_the_same() {
        let mask = mask(30_000);
        let mut runs = Runs::default();
        runs.find(0..mask.len(), &mask);
        let work = || {
            let mut fields = [vec![0.0; mask.len()], vec![0.0; mask.len()]];
            let [a, b] = &mut fields;
            runs.write([a, b], |run, [a, b]| {
                for ((a, b), place) in a.iter_mut().zip(b).zip(run) {
                    (*a, *b) = (1.0 / place as f32, place as f32);
                }
            });
            let add =
                |run: &Range<usize>| run.clone().map(|at| f64::from(fields[0][at])).sum::<f64>();
            let sums = runs.sum(|runs| [runs.iter().map(add).sum()]);
            (fields, sums)
        };
        let one = work();
        let places: f64 = one.0[1].iter().map(|place| f64::from(*place)).sum();
        let wanted: usize = runs.iter().flatten().sum();
        assert_eq!(places, wanted as f64);
        for threads in [2, 3, 5] {
            assert!(with_threads(threads, work) == one, "{threads}");
        }
    }
}
