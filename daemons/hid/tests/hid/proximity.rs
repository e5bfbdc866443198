//! The order in which a pen may say what, as Linux's own tests of tablets have it.

use maulstick_device::pen::{End, LEAST_PRESSURE, Pen, Presence, Reading};
use proptest::prelude::*;

use Presence::{Away, Hovering, Touching};

/// True if a pen may go from one state to the other.
fn may(from: &Reading, to: &Reading) -> bool {
    let same_end = from.end == to.end;
    match (from.presence, to.presence) {
        // A pen may come down faster than the tablet looks, but never goes up unseen.
        (Away, Hovering | Touching) => true,
        (Hovering, Hovering | Touching | Away) | (Touching, Touching | Hovering) => same_end,
        (Away, Away) | (Touching, Away) => false,
    }
}

fn reading(presence: Presence, end: End, pressure: f64) -> Reading {
    Reading {
        presence,
        end,
        point_m: [0.1, 0.05],
        pressure,
        ..Reading::AWAY
    }
}

fn followed(said: &[Reading]) -> Vec<Reading> {
    let (mut pen, mut told) = (Pen::default(), Vec::new());
    for reading in said {
        pen.follow(*reading, &mut |reading| told.push(reading));
    }
    told
}

/// Pairs of neighbours that no pen can have gone through.
fn impossible(told: &[Reading]) -> usize {
    let from_away = std::iter::once(Reading::AWAY).chain(told.iter().copied());
    from_away
        .zip(told)
        .filter(|(from, to)| !may(from, to))
        .count()
}

fn any_reading() -> impl Strategy<Value = Reading> {
    let presence = prop::sample::select(vec![Away, Hovering, Touching]);
    let end = prop::sample::select(vec![End::Tip, End::Eraser]);
    let pressure = prop::sample::select(vec![0.0, 0.3, 1.0]);
    (presence, end, pressure).prop_map(|(presence, end, pressure)| reading(presence, end, pressure))
}

proptest! {
    #[test]
    fn whatever_a_tablet_says_the_pen_only_does_what_it_can(
        said in prop::collection::vec(any_reading(), 0..40),
    ) {
        let told = followed(&said);
        prop_assert_eq!(impossible(&told), 0, "{:?}", told);
        for reading in &told {
            prop_assert_eq!(reading.pressure > 0.0, reading.presence == Touching);
        }
        // What was said last holds.
        let last = said.last().map_or(Away, |last| last.presence);
        prop_assert_eq!(told.last().map_or(Away, |last| last.presence), last);
    }
}

#[test]
fn what_is_passed_on_as_it_was_said_is_found_impossible() {
    for said in [
        vec![
            reading(Touching, End::Tip, 0.5),
            reading(Away, End::Tip, 0.0),
        ],
        vec![
            reading(Hovering, End::Tip, 0.0),
            reading(Hovering, End::Eraser, 0.0),
        ],
        vec![reading(Away, End::Tip, 0.0)],
    ] {
        assert_ne!(impossible(&said), 0, "{said:?}");
        assert_eq!(impossible(&followed(&said)), 0);
    }
}

#[test]
fn a_pen_that_is_snatched_away_is_lifted_where_it_was() {
    let gone = Reading {
        point_m: [0.0; 2],
        ..reading(Away, End::Tip, 0.0)
    };
    let told = followed(&[reading(Touching, End::Tip, 0.5), gone]);
    let states: Vec<_> = told
        .iter()
        .map(|told| (told.presence, told.pressure))
        .collect();
    assert_eq!(states, [(Touching, 0.5), (Hovering, 0.0), (Away, 0.0)]);
    assert!(told.iter().all(|told| told.point_m == [0.1, 0.05]));
}

#[test]
fn a_pen_that_is_turned_round_has_been_away() {
    let told = followed(&[
        reading(Touching, End::Tip, 0.5),
        reading(Touching, End::Eraser, 0.4),
    ]);
    let states: Vec<_> = told.iter().map(|told| (told.presence, told.end)).collect();
    let (tip, eraser) = (End::Tip, End::Eraser);
    assert_eq!(
        states,
        [
            (Touching, tip),
            (Hovering, tip),
            (Away, tip),
            (Touching, eraser)
        ]
    );
}

#[test]
fn a_touch_without_pressure_is_a_touch_and_pressure_without_a_touch_is_none() {
    let told = followed(&[
        reading(Hovering, End::Tip, 0.7),
        reading(Touching, End::Tip, 0.0),
    ]);
    assert_eq!(told[0].pressure, 0.0);
    assert_eq!(told[1].pressure, LEAST_PRESSURE);
}
