//! Target of a pen: desk or panel, by what it touches first.

use std::sync::Arc;

use maulstick_device::pen::{End, Presence, Reading};
use maulstick_types::stylus::{StylusSample, switch};
use maulstick_window_pen::window::PointerEvent;
use maulstick_window_pen::{Axes, PenReading, Tool};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::Rng as _;

use crate::desk::{Desk, PANEL, PIXEL_M, Window, contact, words};

const ALL: Axes = Axes {
    pressure: true,
    tilt: true,
    twist: true,
    range: true,
};

fn read(time_ms: u32, x: f64, presence: Presence) -> PenReading {
    PenReading {
        tool: Tool(1),
        axes: ALL,
        time_ms,
        point_px: [x, 100.0],
        reading: Reading {
            presence,
            pressure: 0.5,
            tilt_rad: Some([0.2, 0.1]),
            twist_rad: Some(0.3),
            ..Reading::AWAY
        },
    }
}

#[test]
fn a_touch_belongs_to_what_lies_where_it_began() {
    use Presence::{Hovering, Touching};
    let heard = |way: &[(f64, Presence)]| {
        let (mut desk, mut hand) = Desk::new();
        for (ms, (x, presence)) in (1u32..).zip(way) {
            desk.net.advance(1_000_000);
            hand.read(&read(ms, *x, *presence)).expect("sent");
        }
        let heard = desk.heard();
        let samples = heard.iter().map(|(_, sample)| words(sample));
        let presses = desk.link.state().pointer.into_iter();
        let presses = presses.filter(|news| matches!(news, PointerEvent::Pressed(..)));
        (
            samples
                .map(|([x, _], pressure, near)| ((x / PIXEL_M).round(), pressure, near))
                .collect::<Vec<_>>(),
            presses.collect::<Vec<_>>(),
        )
    };
    let (samples, presses) = heard(&[
        (400.0, Hovering),
        (400.0, Touching),
        (600.0, Touching),
        (600.0, Hovering),
    ]);
    let expected = [
        (400.0, 0.0, true),
        (400.0, 0.5, true),
        (600.0, 0.5, true),
        (600.0, 0.0, true),
    ];
    assert_eq!(samples, expected, "a stroke goes on over a panel");
    assert_eq!(presses, [], "and presses nothing there");
    let (samples, presses) = heard(&[
        (600.0, Hovering),
        (600.0, Touching),
        (400.0, Touching),
        (400.0, Hovering),
    ]);
    assert_eq!(
        samples,
        [(400.0, 0.0, true)],
        "a panel's touch is no stroke"
    );
    let at = |x: f64, down| PointerEvent::Pressed([x, 100.0], down);
    assert_eq!(presses, [at(600.0, true), at(400.0, false)]);
}

#[test]
fn pressure_is_bent_as_the_window_says() {
    let (mut desk, mut hand) = Desk::new();
    desk.link
        .bend_pressure(&[[0.0, 0.0], [0.5, 0.2], [1.0, 1.0]]);
    desk.net.advance(1_000_000);
    hand.read(&read(1, 400.0, Presence::Touching))
        .expect("sent");
    let heard = desk.heard();
    let pressure: Vec<f64> = heard.iter().map(|(_, sample)| words(sample).1).collect();
    assert_eq!(pressure, [0.2]);
    assert_eq!(
        desk.link.state().pressure,
        0.5,
        "the window shows what is sensed"
    );
}

#[test]
fn a_brush_over_a_panel_is_away() {
    let (mut desk, mut hand) = Desk::new();
    for (ms, x) in [(1, 400.0), (2, 600.0), (3, 700.0), (4, 300.0)] {
        desk.net.advance(1_000_000);
        hand.read(&read(ms, x, Presence::Hovering)).expect("sent");
    }
    let near: Vec<bool> = desk.heard().iter().map(|(_, told)| told.in_range).collect();
    assert_eq!(near, [true, false, true]);
}

/// With Ctrl, say, a touch of the desk is the window's; the brush still hovers there.
#[test]
fn with_a_key_a_touch_of_the_desk_is_the_pointer_s() {
    let (mut desk, mut stylus) = Desk::new();
    let key = Window {
        key: true,
        ..Window::default()
    };
    desk.link.show(Some(Arc::new(key)), "main");
    for (ms, presence) in [(1, Presence::Hovering), (2, Presence::Touching)] {
        desk.net.advance(1_000_000);
        stylus.read(&read(ms, 100.0, presence)).expect("sent");
    }
    let heard = desk.heard();
    let told: Vec<_> = heard
        .iter()
        .map(|(_, sample)| (words(sample).1, sample.in_range))
        .collect();
    assert_eq!(told, [(0.0, true), (0.0, false)]);
    let pressed = PointerEvent::Pressed([100.0, 100.0], true);
    assert_eq!(desk.link.state().pointer.last(), Some(&pressed));
}

#[test]
fn tilt_and_twist_are_the_desk_s_also_in_a_mirror() {
    let of = |mirrored: bool| {
        let (mut desk, mut hand) = Desk::new();
        desk.link.show(
            Some(Arc::new(Window {
                mirrored,
                ..Window::default()
            })),
            "main",
        );
        let mut touch = read(1, 100.0, Presence::Touching);
        touch.reading.end = End::Eraser;
        hand.read(&touch).expect("sent");
        let (_, sample) = desk.heard().pop().expect("a sample");
        assert_eq!(sample.switches & switch::ERASER, switch::ERASER);
        let (_, tilt, twist, _) = contact(&sample);
        (tilt, twist)
    };
    assert_eq!(of(false), ([0.2, 0.1], 0.3));
    assert_eq!(of(true), ([-0.2, 0.1], -0.3));
}

#[test]
fn another_tool_waits_until_the_first_is_lifted() {
    let (mut desk, mut hand) = Desk::new();
    let by = |tool: u64, ms, x, presence| PenReading {
        tool: Tool(tool),
        ..read(ms, x, presence)
    };
    for told in [
        by(1, 1, 100.0, Presence::Touching),
        by(2, 2, 200.0, Presence::Touching),
        by(1, 3, 110.0, Presence::Hovering),
        by(2, 4, 210.0, Presence::Touching),
    ] {
        desk.net.advance(1_000_000);
        hand.read(&told).expect("sent");
    }
    let heard = desk.heard();
    let told: Vec<_> = heard.iter().map(|(_, sample)| words(sample)).collect();
    let told: Vec<_> = told
        .iter()
        .map(|(at, p, near)| ((at[0] / PIXEL_M).round(), *p, *near))
        .collect();
    let expected = [
        (100.0, 0.5, true),
        (110.0, 0.0, true),
        (110.0, 0.0, false),
        (210.0, 0.5, true),
    ];
    assert_eq!(told, expected);
}

#[test]
fn a_resting_pen_goes_on_and_one_that_nobody_hears_of_leaves() {
    let (mut desk, mut hand) = Desk::new();
    let mut touch = read(1, 100.0, Presence::Touching);
    touch.axes.range = false;
    hand.read(&touch).expect("sent");
    for _ in 0..40 {
        desk.net.advance(50_000_000);
        hand.rest().expect("sent");
    }
    let heard = desk.heard();
    assert!(
        heard
            .iter()
            .all(|(_, sample)| words(sample).1 == 0.5 && sample.in_range)
    );
    let gaps = heard.windows(2).map(|pair| pair[1].0 - pair[0].0);
    assert!(
        gaps.max().expect("some") <= 100_000_000,
        "a brush would begin anew"
    );
    touch.time_ms = 2001;
    touch.reading.presence = Presence::Hovering;
    hand.read(&touch).expect("sent");
    for _ in 0..40 {
        desk.net.advance(50_000_000);
        hand.rest().expect("sent");
    }
    let last = desk.heard().pop().expect("samples").1;
    assert!(!last.in_range && !desk.link.state().is_near);
}

/// Also over a panel, where nothing is sent: mouse and fingers would be refused until it came back.
#[test]
fn a_pen_that_nobody_hears_of_over_a_panel_leaves() {
    let (desk, mut stylus) = Desk::new();
    let mut hover = read(1, 600.0, Presence::Hovering);
    hover.axes.range = false;
    stylus.read(&hover).expect("sent");
    assert!(desk.link.state().is_near);
    let mut waited_ns = 0;
    while let Some(due_ns) = stylus.due_in_ns() {
        desk.net.advance(due_ns.max(1));
        waited_ns += due_ns.max(1);
        stylus.rest().expect("sent");
        assert!(waited_ns < 3_000_000_000, "it stays");
    }
    assert!(!desk.link.state().is_near && waited_ns >= 1_000_000_000);
}

/// The brush in the hand changes while a panel is pressed, or the window system goes: the panel is let go.
#[test]
fn a_pressed_panel_is_always_let_go() {
    let presses = |desk: &Desk| {
        let pointer = desk.link.state().pointer.into_iter();
        let presses = pointer.filter_map(|event| match event {
            PointerEvent::Pressed(_, down) => Some(down),
            _ => None,
        });
        presses.collect::<Vec<bool>>()
    };
    let (desk, mut stylus) = Desk::new();
    stylus
        .read(&read(1, 600.0, Presence::Touching))
        .expect("sent");
    desk.link.show(Some(Arc::new(Window::default())), "second");
    stylus
        .read(&read(2, 400.0, Presence::Touching))
        .expect("sent");
    stylus
        .read(&read(3, 400.0, Presence::Hovering))
        .expect("sent");
    assert_eq!(presses(&desk), [true, false]);
    stylus
        .read(&read(4, 600.0, Presence::Touching))
        .expect("sent");
    stylus.end().expect("sent");
    assert_eq!(presses(&desk), [true, false]);
}

#[test]
fn another_brush_is_taken_after_the_first_was_lifted() {
    let (mut desk, mut hand) = Desk::new();
    hand.read(&read(1, 100.0, Presence::Touching))
        .expect("sent");
    desk.link.show(Some(Arc::new(Window::default())), "second");
    hand.read(&read(2, 110.0, Presence::Touching))
        .expect("sent");
    let told: Vec<bool> = desk
        .heard()
        .iter()
        .map(|(_, sample)| sample.in_range)
        .collect();
    assert_eq!(
        told,
        [true, true, false, true],
        "lifted, gone, and there again"
    );
    let brushes = std::iter::from_fn(|| desk.infos.try_recv());
    let mut brushes: Vec<String> = brushes.map(|info| info.message.brush).collect();
    brushes.dedup();
    assert_eq!(brushes, ["main", "second"]);
}

#[test]
fn nan_and_infinite_readings_are_rejected() {
    let (mut desk, mut hand) = Desk::new();
    let mut odd = read(1, f64::NAN, Presence::Touching);
    hand.read(&odd).expect("refused in silence");
    odd.point_px = [100.0, 1e300];
    odd.reading.tilt_rad = Some([f64::NAN, 9.0]);
    odd.reading.twist_rad = Some(f64::INFINITY);
    odd.reading.pressure = 7.0;
    hand.read(&odd).expect("sent");
    let heard = desk.heard();
    assert_eq!(heard.len(), 1);
    assert_eq!(heard[0].1.fault(), None);
}

/// 1,000 gestures over desk and panel: nothing is both, and nothing paints that did not begin on the desk.
#[test]
fn no_gesture_paints_and_presses() {
    let (mut desk, mut hand) = Desk::new();
    let mut random = Pcg64Mcg::new(0x5eed);
    let mut below = |bound: u64| random.next_u64() % bound;
    let (mut ms, mut strokes, mut clicks) = (0, 0, 0);
    for _ in 0..1000 {
        let mut x = below(1000) as f64;
        let began_on_desk = x < PANEL;
        let steps = 2 + below(6);
        for step in 0..=steps {
            let presence = match step {
                0 => Presence::Hovering,
                _ if step == steps => [Presence::Hovering, Presence::Away][below(2) as usize],
                _ => Presence::Touching,
            };
            if step > 1 {
                x = below(1000) as f64;
            }
            ms += 1;
            desk.net.advance(1_000_000);
            hand.read(&read(ms, x, presence)).expect("sent");
        }
        let heard = desk.heard();
        let paints = |sample: &StylusSample| words(sample).1 > 0.0;
        let painted = heard.iter().any(|(_, sample)| paints(sample));
        assert!(
            !heard.last().is_some_and(|(_, sample)| paints(sample)),
            "lifted at its end"
        );
        let news = desk.link.state();
        let presses = news.pointer.iter().filter_map(|news| match news {
            PointerEvent::Pressed(_, down) => Some(*down),
            _ => None,
        });
        let presses: Vec<bool> = presses.collect();
        if began_on_desk {
            assert_eq!((painted, &presses[..]), (true, &[][..]))
        } else {
            assert_eq!((painted, &presses[..]), (false, &[true, false][..]))
        }
        strokes += u32::from(painted);
        clicks += u32::from(!presses.is_empty());
    }
    assert!(strokes > 300 && clicks > 300, "{strokes} {clicks}");
}
