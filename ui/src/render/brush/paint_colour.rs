//! Paint on a brush as the window shows it: colours and films along each bristle.

use glam::Vec3;
use half::f16;
use maulstick_brush::Head;
use maulstick_types::brush::BrushLook;
use maulstick_ui_kit::display_transform::DisplayTransform;

/// Colours of films over the hair, and how thick they are.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PaintColour {
    along: usize,
    /// Strip after strip, from the ferrule: linear light, then the film's share of a full one.
    samples: Vec<(Vec3, f32)>,
    load_share: f32,
}

impl PaintColour {
    /// Colours of a message; `None` if its lengths do not fit or a number is not finite.
    #[must_use]
    pub fn of(look: &BrushLook) -> Option<Self> {
        let (strips, along) = (look.strips as usize, look.along as usize);
        if along == 0 || strips.checked_mul(along)?.checked_mul(8)? != look.samples.len() {
            return None;
        }
        let sample = |bytes: &[u8]| {
            let value = |i: usize| f16::from_le_bytes([bytes[2 * i], bytes[2 * i + 1]]).to_f32();
            (Vec3::new(value(0), value(1), value(2)), value(3))
        };
        let samples: Vec<_> = look.samples.chunks_exact(8).map(sample).collect();
        let load_share = look.load_share;
        let numbers = |(colour, film): &(Vec3, f32)| colour.is_finite() && film.is_finite();
        (samples.iter().all(numbers) && (0.0..=1.0).contains(&load_share)).then_some(Self {
            along,
            samples,
            load_share,
        })
    }

    /// As a display takes it.
    #[must_use]
    pub fn tinted(&self, tint: &DisplayTransform) -> Self {
        let tinted = |(colour, film): &(Vec3, f32)| {
            (Vec3::from_array(tint.linear(colour.to_array())), *film)
        };
        Self {
            along: self.along,
            samples: self.samples.iter().map(tinted).collect(),
            load_share: self.load_share,
        }
    }

    /// On all strips of a head, of which this has the first: each has what the nearest of those has.
    #[must_use]
    pub fn on(self, head: &Head) -> Self {
        let strips = self.strips();
        if !(1..head.strips()).contains(&strips) {
            return self;
        }
        let nearest = head.nearest_of_first(strips).into_iter();
        let own = |strip: usize| &self.samples[strip * self.along..(strip + 1) * self.along];
        Self {
            along: self.along,
            samples: nearest.flat_map(own).copied().collect(),
            load_share: self.load_share,
        }
    }

    /// Colour and film at a position along a strip, 0 at the ferrule to 1; `None` if there is no such strip.
    #[must_use]
    pub fn at(&self, strip: usize, along: f32) -> Option<(Vec3, f32)> {
        let own = self
            .samples
            .get(strip * self.along..(strip + 1) * self.along)?;
        // Each sample is the mean of its part, at whose middle it stands.
        let place = (along * self.along as f32 - 0.5).clamp(0.0, (self.along - 1) as f32);
        let below = place as usize;
        let above = (below + 1).min(self.along - 1);
        let share = place - below as f32;
        let (a, b) = (own[below], own[above]);
        Some((a.0.lerp(b.0, share), a.1 + (b.1 - a.1) * share))
    }

    /// The paint on and inside the head by that of a fully loaded one, 0 to 1.
    #[must_use]
    pub fn load_share(&self) -> f32 {
        self.load_share
    }

    /// Colours of the tip of a head in `columns` columns from left to right; a column without bristles has the colour
    /// of the one before it, or of the first that has any.
    #[must_use]
    pub fn across(&self, head: &Head, columns: usize) -> Vec<Vec3> {
        let mut sums = vec![(Vec3::ZERO, 0.0); columns];
        for (root, own) in head
            .roots()
            .iter()
            .zip(self.samples.chunks(self.along.max(1)))
        {
            let place = 0.5 * (root[0] + 1.0) * columns as f32;
            let (sum, count) = &mut sums[(place as usize).min(columns - 1)];
            for (colour, _) in &own[own.len() / 2..] {
                *sum += *colour;
                *count += 1.0;
            }
        }
        let means = sums.iter();
        let means = means.map(|(sum, count)| (*count > 0.0).then(|| *sum / *count));
        let mut last = means.clone().flatten().next().unwrap_or(Vec3::ZERO);
        means
            .map(|mean| {
                last = mean.unwrap_or(last);
                last
            })
            .collect()
    }

    /// Number of strips.
    #[must_use]
    pub fn strips(&self) -> usize {
        self.samples.len() / self.along.max(1)
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use maulstick_brush::BrushFile;

    use super::*;

    pub(crate) fn look_of(strips: u32, along: u32, samples: &[[f32; 4]]) -> BrushLook {
        let values = samples.iter().flatten();
        let bytes: Vec<u8> = values
            .flat_map(|value| f16::from_f32(*value).to_le_bytes())
            .collect();
        BrushLook {
            strips,
            along,
            samples: bytes.into(),
            load_share: 0.5,
        }
    }

    pub(crate) fn coat_of(strips: u32, along: u32, samples: &[[f32; 4]]) -> PaintColour {
        PaintColour::of(&look_of(strips, along, samples)).expect("it fits")
    }

    #[test]
    fn samples_stand_in_the_middle_of_their_parts() {
        let coat = coat_of(1, 2, &[[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 1.0]]);
        let red = |along: f32| coat.at(0, along).expect("a strip").0.x;
        assert_eq!(
            (red(0.0), red(0.25), red(0.5), red(1.0)),
            (1.0, 1.0, 0.5, 0.0)
        );
        assert_eq!(coat.at(1, 0.5), None);
        assert_eq!(coat.strips(), 1);
    }

    #[test]
    fn the_tip_is_seen_from_left_to_right() {
        let head = Head::of(&BrushFile::library("flat").expect("flat"));
        let strip = |root: &[f32; 2]| {
            if root[0] < 0.0 {
                [[0.0; 4], [1.0, 0.0, 0.0, 1.0]]
            } else {
                [[0.0; 4], [0.0, 0.0, 1.0, 1.0]]
            }
        };
        let samples: Vec<_> = head.roots().iter().flat_map(strip).collect();
        let coat = coat_of(head.strips() as u32, 2, &samples);
        assert_eq!(coat.load_share(), 0.5);
        assert_eq!(coat.across(&head, 4), [Vec3::X, Vec3::X, Vec3::Z, Vec3::Z]);
        let columns = 4096;
        let bare = head.roots().iter();
        let left = bare.map(|root| 0.5 * (root[0] + 1.0) * columns as f32);
        assert!(left.fold(f32::MAX, f32::min) > 1.0, "none is in the first");
        assert_eq!(coat.across(&head, columns)[0], Vec3::X);
    }

    /// A head that is thinned for the canvas shows its paint on all of its bristles.
    #[test]
    fn all_strips_have_what_those_that_stand_for_them_have() {
        let file = BrushFile::library("flat").expect("flat");
        let (head, few) = (Head::of(&file), Head::of(&file.thinned_to(56)));
        let red = |strip: &[f32; 2]| [f32::from(u8::from(strip[0] > 0.0)), 0.0, 0.0, 1.0];
        let samples: Vec<[f32; 4]> = few.roots().iter().map(red).collect();
        let coat = coat_of(56, 1, &samples).on(&head);
        assert_eq!(coat.strips(), head.strips());
        let right = head.roots().iter().enumerate();
        let right = right.filter(|(_, root)| root[0].abs() > 0.15);
        for (strip, root) in right {
            let (colour, _) = coat.at(strip, 0.5).expect("a strip");
            assert_eq!(colour.x > 0.5, root[0] > 0.0, "{strip}");
        }
        let alien = coat_of(1000, 1, &vec![[0.0; 4]; 1000]);
        assert_eq!(alien.clone().on(&head), alien);
    }

    #[test]
    fn what_does_not_fit_is_no_coat() {
        let fits = |look: &BrushLook| PaintColour::of(look).is_some();
        assert!(fits(&look_of(1, 1, &[[0.5; 4]])));
        assert!(!fits(&look_of(2, 1, &[[0.5; 4]])), "a strip is missing");
        assert!(!fits(&look_of(1, 1, &[[f32::NAN; 4]])));
        assert!(!fits(&look_of(1, 0, &[])));
        assert!(!fits(&look_of(u32::MAX, u32::MAX, &[[0.5; 4]])));
    }
}
