//! A recording guides the hand at the simulated device.

#[path = "../support/mod.rs"]
mod support;

use glam::{DQuat, DVec3};
use maulstick_brush::BrushFile;
use maulstick_bus::Qos;
use maulstick_bus::typed::Receiver;
use maulstick_device::{Take, TakeSample};
use maulstick_types::stylus::{StylusPose, StylusSample, StylusStatus, axes};
use support::replay::Replay;
use support::{Launcher, PATIENCE, Place, drain, fault, has, hear, listen, wait_for};

/// Strokes of 10 cm along x in 2 s each, `aside` m to both sides of a straight path, with lifts of half a second.
fn strokes(path: &std::path::Path, count: u64, aside: f64) {
    let samples = (0..250 * count).map(|number| {
        let way = (number % 250) as f64 / 200.0;
        let lifted = way >= 1.0;
        let x = if lifted {
            0.05 - 0.4 * (way - 1.0)
        } else {
            0.1 * way - 0.05
        };
        let swing = maulstick_num::sin(2.0 * std::f64::consts::PI * way);
        TakeSample {
            time_ns: number * 10_000_000,
            sample: StylusSample {
                senses: axes::POSITION | axes::PRESSURE | axes::TILT,
                pose: StylusPose::Contact {
                    point_m: [x, aside * swing, 0.0],
                    tilt_rad: [0.0; 2],
                    twist_rad: 0.0,
                    pressure: if lifted { 0.0 } else { 0.5 },
                },
                in_range: true,
                ..StylusSample::away()
            },
        }
    });
    let take = Take {
        setup: None,
        device: "hand".into(),
        samples: samples.collect(),
    };
    take.write(path).expect("written");
}

fn tip(sample: &StylusSample, head_length_m: f64) -> Option<DVec3> {
    let StylusPose::Ferrule { pose } = &sample.pose else {
        return None;
    };
    let bristles = DQuat::from_array(pose.orientation) * DVec3::NEG_Z;
    Some(DVec3::from_array(pose.position_m) + bristles * head_length_m)
}

/// Mean distance of a painting hand from the straight path in three of its strokes, m.
fn aside(samples: &mut Receiver<StylusSample>, head_length_m: f64) -> f64 {
    drain(samples);
    let (mut first_ns, mut sum, mut count) = (None, 0.0, 0u32);
    let ended = wait_for(PATIENCE, || {
        while let Some(received) = samples.try_recv() {
            let event_ns = received.header.event_ns;
            let tip = tip(&received.message, head_length_m).expect("a ferrule");
            if tip.z < -1e-3 {
                sum += tip.y.abs();
                count += 1;
            }
            if event_ns > *first_ns.get_or_insert(event_ns) + 7_500_000_000 {
                return Some(());
            }
        }
        None
    });
    assert!(ended.is_some() && count > 750, "{count} samples");
    sum / f64::from(count)
}

/// Guides the hand along the recorded path, without strength at first; a device that is not there is refused.
fn guide(place: &Place) -> Replay {
    let guide = ["recording", "replay", "path.mcap", "--guide"];
    let nobody = [&guide[..], &["nobody"]].concat();
    has(&fault(place, &nobody, 2), &["nobody", "device list"]);
    let options = ["phantom", "--strength", "0", "--loop", "--json"];
    Replay::start(place.maulstick(&[&guide[..], &options].concat()))
}

#[test]
fn a_guided_hand_paints_nearer_to_the_recorded_path_until_force_is_off() {
    let place = Place::new();
    strokes(&place.path("path.mcap"), 2, 0.0);
    strokes(&place.path("hand.mcap"), 70, 4e-3);
    let brush = BrushFile::library("round").expect("a brush");
    let head_length_m = brush.scaled_to(10.0).expect("a size").length_m();
    place.write_settings(&[("# hand = \"demo.mcap\"", "hand = \"hand.mcap\"")]);
    let mut launcher = Launcher::up(&place, &["--rig", "rig.toml"]);
    launcher.wait_says("is up");
    let (bus, topics) = support::join(&place);
    let mut samples = listen::<StylusSample>(&bus, &topics.sample("phantom"), Qos::RealTime);
    let status = topics.stylus_status("phantom");
    let mut statuses = listen::<StylusStatus>(&bus, &status, Qos::Background);
    let mut guide = guide(&place);

    guide.until(|line| line["strength"] == 0.0 && line["strokes"] == 2);
    let free_m = aside(&mut samples, head_length_m);
    drain(&mut statuses);
    assert!(hear(&mut statuses, |_| true).is_some_and(|status| !status.is_guided));
    guide.order("strength 0.8");
    guide.until(|line| line["strength"] == 0.8);
    assert!(hear(&mut statuses, |status| status.is_guided).is_some());
    let guided_m = aside(&mut samples, head_length_m);
    println!("{:.2} mm, guided {:.2} mm", free_m * 1e3, guided_m * 1e3);
    assert!(guided_m < 0.85 * free_m, "{guided_m} m, free {free_m} m");
    guide.until(|line| line["traced"] == 1);

    place.done(&["device", "force", "guidance", "20%", "--device", "phantom"]);
    let is_weak = |status: &StylusStatus| status.is_guided && status.guidance == 0.2;
    assert!(hear(&mut statuses, is_weak).is_some());
    place.done(&["device", "force", "off", "--device", "phantom"]);
    assert!(hear(&mut statuses, |status| !status.is_on).is_some());
    drain(&mut samples);
    let is_free = |sample: &StylusSample| sample.force_n == [0.0; 3];
    assert!((0..200).all(|_| hear(&mut samples, |_| true).is_some_and(|own| is_free(&own))));
    guide.order("end");
    guide.finish();
    assert!(hear(&mut statuses, |status| !status.is_guided).is_some());
    bus.close();
}
