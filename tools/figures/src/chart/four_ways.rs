//! One graded mixture by four ways of mixing, as in Baxter 2004, fig. 7.9.

use maulstick_appearance::picture::Picture;
use maulstick_optics::comparison::{Grading, Way};
use maulstick_rig::UserError;

use maulstick::page::Page;

/// Parts of the second paint in 64 of the first, then the reverse: strong paints and weak ones both show their whole
/// range.
const DOUBLINGS: i32 = 6;
/// Size of a patch, gap between rows, margin, pixels.
const PATCH: [usize; 2] = [56, 64];
const GAP: usize = 12;
const MARGIN: usize = 20;
/// Heights of words, pixels.
const TITLE: f32 = 22.0;
const SMALL_TEXT_PX: f32 = 16.0;

/// Shares of the second paint, and their labels: 0, 1:64 by doublings to 64:1, 1.
pub(crate) fn shares() -> Vec<(f64, String)> {
    let step = |k: i32| {
        let ratio = f64::from(1 << k.unsigned_abs());
        if k < 0 {
            (1.0 / (1.0 + ratio), format!("{ratio}:1"))
        } else {
            (ratio / (1.0 + ratio), format!("1:{ratio}"))
        }
    };
    let mut shares = vec![(0.0, "1:0".to_owned())];
    shares.extend((-DOUBLINGS..=DOUBLINGS).map(step));
    shares.push((1.0, "0:1".to_owned()));
    shares
}

/// Title of a method of mixing; `rule` is the rule's name.
pub(crate) fn title(way: Way, rule: &str) -> String {
    match way {
        Way::Reference => "101 samples".into(),
        Way::Rule => rule.into(),
        Way::Three => "three samples as RGB".into(),
        Way::LinearRgb => "linear RGB".into(),
    }
}

/// Mean and greatest distance from the reference, ΔE₀₀.
pub(crate) fn mean_and_most(delta_e: &[f64]) -> [f64; 2] {
    let most = delta_e.iter().copied().fold(0.0, f64::max);
    let mean = delta_e.iter().sum::<f64>() / delta_e.len().max(1) as f64;
    [mean, most]
}

/// The four rows with their captions.
///
/// # Errors
/// A [`UserError`] where the font cannot be read.
pub(crate) fn picture(
    gradings: &[Grading],
    ends: [&str; 2],
    rule: &str,
) -> Result<Picture, UserError> {
    let measure = Page::new(1, 1)?;
    let shares = shares();
    let lines: Vec<[String; 2]> = gradings
        .iter()
        .map(|grading| {
            let [mean, most] = mean_and_most(&grading.delta_e);
            let off = match grading.way {
                Way::Reference => "Kubelka-Munk, the reference".into(),
                _ => format!("off by ΔE00 {mean:.1}, at most {most:.1}"),
            };
            [title(grading.way, rule), off]
        })
        .collect();
    let widths = lines.iter().map(|[title, off]| {
        measure
            .length(title, TITLE)
            .max(measure.length(off, SMALL_TEXT_PX))
    });
    let left = 2 * MARGIN + widths.max().unwrap_or(0);
    let top = MARGIN + 52;
    let across = shares.len() * PATCH[0];
    let width = left + across + MARGIN;
    let mut page = Page::new(
        width,
        top + gradings.len() * (PATCH[1] + GAP) + MARGIN - GAP,
    )?;
    page.write(ends[0], [left, MARGIN + 18], TITLE);
    let length = page.length(ends[1], TITLE);
    page.write(
        ends[1],
        [left + across - length.min(across), MARGIN + 18],
        TITLE,
    );
    for (i, (_, words)) in shares.iter().enumerate() {
        let inset = PATCH[0].saturating_sub(page.length(words, SMALL_TEXT_PX)) / 2;
        page.write(words, [left + i * PATCH[0] + inset, top - 8], SMALL_TEXT_PX);
    }
    for (row, (grading, [title, off])) in gradings.iter().zip(&lines).enumerate() {
        let y = top + row * (PATCH[1] + GAP);
        page.write(title, [MARGIN, y + 30], TITLE);
        page.write(off, [MARGIN, y + 52], SMALL_TEXT_PX);
        for (i, seen) in grading.seen.iter().enumerate() {
            page.fill([left + i * PATCH[0], y], PATCH, seen.bytes());
        }
    }
    Ok(page.done())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_rise_from_the_first_paint_to_the_second() {
        let shares = shares();
        assert_eq!(shares.len(), 15);
        assert!(shares.windows(2).all(|two| two[0].0 < two[1].0));
        assert_eq!(shares[7], (0.5, "1:1".into()));
        assert_eq!(
            (shares[1].1.as_str(), shares[13].1.as_str()),
            ("64:1", "1:64")
        );
    }
}
