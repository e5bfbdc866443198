//! Mixtures with thinner.

use maulstick_types::Mixture;
use maulstick_types::mixture::Part;
use maulstick_types::values::ThinnerShare;

use crate::paints::THINNER;

/// A mixture with a share of its volume of thinner added to its own.
#[must_use]
pub fn thinned(mixture: &Mixture, share: ThinnerShare) -> Mixture {
    let share = share.get();
    if share <= 0.0 {
        return mixture.clone();
    }
    let mut parts: Vec<Part> = Vec::new();
    let mut thinner = share;
    for part in &mixture.parts {
        let left = part.share * (1.0 - share);
        if part.paint == THINNER {
            thinner += left
        } else {
            parts.push(Part {
                paint: part.paint.clone(),
                share: left,
            })
        }
    }
    parts.push(Part {
        paint: THINNER.to_owned(),
        share: thinner,
    });
    Mixture { parts }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinner_is_added_to_its_own_and_the_rest_keeps_its_proportions() {
        let mixture: Mixture = "Cobalt Blue=0.45,Bone Black=0.15,Thinner=0.4"
            .parse()
            .expect("a mixture");
        let half = ThinnerShare::in_unit(0.5).expect("a share");
        let thin = thinned(&mixture, half);
        assert_eq!(
            thin.to_string(),
            "Cobalt Blue=0.225,Bone Black=0.075,Thinner=0.7"
        );
        assert_eq!(thin.check(), Ok(()));
        assert_eq!(thinned(&mixture, ThinnerShare::NONE), mixture);
    }
}
