//! Devices and brushes side by side: none takes from another, and none waits for another.

mod support;

use maulstick_brush::BrushFile;
use maulstick_brush_node::contact_model::ForceKind;
use maulstick_bus::credit::Stamp;
use maulstick_bus::typed::{Receiver, Sender};
use maulstick_bus::{CreditSender, Faults, MemoryNet, Qos, Queue, Wake};
use maulstick_painting::edits::{Dry, Fill, FillPaint, Load, Tune, Undo};
use maulstick_painting::picture::picture;
use maulstick_types::brush::{BrushDef, BrushState};
use maulstick_types::command::BrushCommand;
use maulstick_types::command::{Command, Outcome};
use maulstick_types::haptics::{ContactModel, FluidForce, ForceLaw, heights_um};
use maulstick_types::scene::{CANVAS, Tuning};
use maulstick_types::stylus::{StylusInfo, StylusSample, axes};
use maulstick_types::values::{BrushName, BrushToml, FilmThickness};
use maulstick_types::{Flags, Origin, name_hash};
use support::{Device, Live, START_NS, loads, pen, take};

fn live() -> Live {
    Live::new(MemoryNet::new(1, START_NS, Faults::default()))
}

/// Lets everybody have a few turns.
fn turn(live: &mut Live) {
    for _ in 0..4 {
        live.net.advance(1_000_000);
        live.brush.poll().expect("turned");
        live.net.advance(1_000_000);
        live.paint.poll().expect("turned");
    }
}

/// A device that drives a force says so.
fn force_device(live: &Live) -> Device {
    let bus = live.net.bus();
    let arm = live.device("arm", 42);
    let topic = live.topics.stylus_info("arm");
    let mut info = Sender::new(&bus, &topic, Qos::Cached, arm.samples.origin()).expect("one");
    let told = StylusInfo {
        device: "arm".into(),
        driver: "foreign".into(),
        brush: "main".into(),
        priority: 0,
        senses: axes::POSITION,
        drives: axes::FORCE,
        rate_hz: 1000.0,
        max_force_n: 3.0,
        max_stiffness_n_m: 800.0,
        workspace_m: [0.0; 6],
    };
    info.send(0, 0, &told).expect("sent");
    arm
}

/// The contact models of that device.
fn models(live: &Live) -> Receiver<ContactModel> {
    let topic = live.topics.contact_model("arm");
    let (bus, queue) = (live.net.bus(), Queue::Ring(512));
    Receiver::new(&bus, &topic, Qos::RealTime, queue, &Wake::new()).expect("subscribed")
}

#[test]
fn a_force_device_with_a_number_of_its_own_gets_its_model() {
    let mut live = live();
    let mut models = models(&live);
    let mut arm = force_device(&live);
    turn(&mut live);
    arm.send(&pen(0.0, 0.0, 0.3));
    turn(&mut live);
    let model = models.try_recv().expect("a model").message;
    assert_eq!((model.device, model.device_epoch), (42, 11));
}

#[test]
fn wet_paint_drags_a_moving_hand_by_the_fluid_force_and_by_no_model() {
    let mut live = live();
    let mut models = models(&live);
    let topic = live.topics.fluid_force("arm");
    let (bus, queue) = (live.net.bus(), Queue::Ring(512));
    let mut forces: Receiver<FluidForce> =
        Receiver::new(&bus, &topic, Qos::RealTime, queue, &Wake::new()).expect("subscribed");
    let mut arm = force_device(&live);
    turn(&mut live);
    let mut stroke = |live: &mut Live| {
        for step in 0..40 {
            arm.send(&StylusSample {
                velocity_m_s: [0.1, 0.02, 0.0],
                ..pen(1e-3 * f64::from(step), 0.0, 0.5)
            });
            turn(live);
        }
        arm.send(&pen(0.04, 0.0, 0.0));
        (0..20).for_each(|_| turn(live));
        std::iter::from_fn(|| forces.try_recv())
            .map(|force| force.message)
            .collect::<Vec<_>>()
    };
    assert!(
        stroke(&mut live).is_empty(),
        "a clean brush on a bare canvas"
    );
    let load = Command::from(Load {
        mixture: loads()[0].clone(),
        beside: None,
        brush: BrushName::main(),
    });
    live.command(1, load);
    let felt = stroke(&mut live);
    println!("{} forces", felt.len());
    let (mut dragged, mut most_n) = (0, 0.0f64);
    for force in &felt {
        assert_eq!((force.device, force.device_epoch), (42, 11));
        maulstick_haptics::Fluid::new(force, 1.0).expect("a servo takes it");
        let power: f64 = (0..6).map(|i| force.wrench[i] * force.velocity[i]).sum();
        dragged += usize::from(power < 0.0);
        most_n = force.wrench[..3]
            .iter()
            .map(|n| n * n)
            .sum::<f64>()
            .sqrt()
            .max(most_n);
    }
    println!("at .1 m/s at most {most_n:.3} N");
    assert!(dragged > 5 && most_n > 0.03, "{dragged}, {most_n} N");
    // Never twice in the hand.
    let all: Vec<_> = std::iter::from_fn(|| models.try_recv()).collect();
    assert!(!all.is_empty() && all.iter().all(|it| it.message.viscous_n_s_m == 0.0));
}

/// Mean height of the newest relief that a servo takes, µm.
fn felt_um(live: &mut Live, arm: &mut Device, models: &mut Receiver<ContactModel>) -> f64 {
    for step in 0..60 {
        arm.send(&pen(1e-5 * f64::from(step), 0.0, 0.1));
        turn(live);
    }
    let newest = models.newest().expect("a model").message;
    maulstick_haptics::Contact::new(&newest).expect("a servo takes it");
    let heights: Vec<i16> = heights_um(&newest.relief.heights_um).collect();
    assert_eq!(heights.len(), 256, "{:?}", newest.relief);
    heights.iter().map(|um| f64::from(*um)).sum::<f64>() / 256.0
}

#[test]
fn dried_paint_is_felt_and_wet_paint_hardly() {
    let mut live = live();
    let mut models = models(&live);
    let mut arm = force_device(&live);
    turn(&mut live);
    let ground = felt_um(&mut live, &mut arm, &mut models);
    // Linen is 80 µm deep.
    assert!((-80.0..0.0).contains(&ground), "{ground}");
    let lay = Fill {
        paint: FillPaint::Mixture {
            mixture: loads()[0].clone(),
        },
        thickness: FilmThickness::new(3e-4).expect("in range"),
        surface: CANVAS,
    };
    live.command(1, lay.into());
    let wet = felt_um(&mut live, &mut arm, &mut models) - ground;
    live.command(2, Dry::whole(CANVAS).into());
    let dry = felt_um(&mut live, &mut arm, &mut models) - ground;
    println!("{ground:.0} µm of ground, {wet:.0} µm of wet paint, {dry:.0} µm of dry");
    assert!((dry - 300.0).abs() < 20.0 && (0.0..100.0).contains(&wet));
}

#[test]
fn a_hand_feels_the_brush_of_a_take_and_paints_nothing_into_it() {
    let mut live = live();
    let mut models = models(&live);
    let mut arm = force_device(&live);
    turn(&mut live);
    live.announce(1);
    let samples = take();
    let mut felt = 0;
    for sent in 1..=samples.len() {
        live.player_turn(&samples[..sent]);
        if (2..samples.len()).contains(&sent) {
            arm.send(&pen(0.02, 0.02, 0.9));
        }
        turn(&mut live);
        while let Some(model) = models.try_recv() {
            assert_eq!((model.message.device, model.message.device_epoch), (42, 11));
            felt += 1;
        }
    }
    (0..100).for_each(|_| turn(&mut live));
    assert!(felt > 50, "{felt} models while the take played");
    let painted = picture(live.paint.painting_mut(), 0).rgb;
    assert!(painted == support::offline(), "the hand has painted");
}

/// Contact model of a pressed brush for a device with a force law.
fn pressed(kind: ForceKind) -> ForceLaw {
    let net = MemoryNet::new(1, START_NS, Faults::default());
    let mut settings = support::settings();
    settings.devices.laws.insert("arm".into(), kind);
    let mut live = Live::with(net, settings);
    let mut models = models(&live);
    let mut arm = force_device(&live);
    turn(&mut live);
    let mut law = None;
    for _ in 0..8 {
        arm.send(&pen(0.0, 0.0, 0.4));
        turn(&mut live);
        while let Some(model) = models.try_recv() {
            maulstick_haptics::Contact::new(&model.message).expect("a servo takes it");
            law = Some(model.message.law);
        }
    }
    law.expect("a model")
}

#[test]
fn a_law_that_changes_acts_at_once() {
    let mut live = live();
    let mut models = models(&live);
    let mut arm = force_device(&live);
    turn(&mut live);
    let mut law = |live: &mut Live| {
        for _ in 0..8 {
            arm.send(&pen(0.0, 0.0, 0.4));
            turn(live);
        }
        std::iter::from_fn(|| models.try_recv())
            .last()
            .map(|model| model.message.law)
    };
    assert!(matches!(law(&mut live), Some(ForceLaw::Linear { .. })));
    let mut devices = support::settings().devices;
    devices.laws.insert("arm".into(), ForceKind::None);
    live.brush.set_devices(devices);
    assert!(matches!(law(&mut live), Some(ForceLaw::None)));
}

#[test]
fn each_device_feels_the_brush_by_its_own_law() {
    assert!(matches!(pressed(ForceKind::None), ForceLaw::None));
    assert!(matches!(pressed(ForceKind::Rigid), ForceLaw::Rigid { .. }));
    assert!(matches!(
        pressed(ForceKind::Linear),
        ForceLaw::Linear { .. }
    ));
    let ForceLaw::Hermite { knots } = pressed(ForceKind::Hermite) else {
        panic!("a curve");
    };
    assert_eq!((knots.len(), knots[3].depth), (5, 1.0));
    let ForceLaw::Local {
        force_n,
        stiffness_n_m,
        ..
    } = pressed(ForceKind::Local)
    else {
        panic!("a local force");
    };
    assert!(force_n[2] > 0.05 && force_n[2] < 3.0, "{force_n:?}");
    assert!(stiffness_n_m[2][2] < 0.0, "{stiffness_n_m:?}");
}

#[test]
fn two_devices_of_one_number_are_two_devices() {
    let mut live = live();
    let (mut one, mut two) = (live.device("one", 7), live.device("two", 7));
    two.samples.restart(12);
    for _ in 0..5 {
        one.send(&pen(0.0, 0.0, 0.0));
        two.send(&pen(0.0, 0.0, 0.0));
        turn(&mut live);
    }
    assert_eq!((one.consumed(), two.consumed()), (5, 5));
}

#[test]
fn a_brush_without_a_file_holds_up_no_other() {
    let mut live = live();
    let load = Command::from(Load {
        mixture: loads()[0].clone(),
        beside: None,
        brush: BrushName::main(),
    });
    live.command(1, load);
    let (bus, wake) = (live.net.bus(), Wake::new());
    let origin = Origin {
        source: name_hash("ghost"),
        epoch: 1,
    };
    let topic = live.topics.brush_state("ghost");
    let mut ghost = CreditSender::new(&bus, &live.topics, &topic, origin, &wake).expect("a sender");
    let state = BrushState {
        device: 1,
        device_epoch: 1,
        device_seq: 0,
        solves: Vec::new(),
    };
    let stamp = Stamp {
        now_ns: START_NS,
        event_ns: START_NS,
    };
    ghost.send(Flags::NONE, stamp, &state).expect("sent");
    turn(&mut live);
    let mut mouse = live.device("mouse", 5);
    for step in 0..20 {
        mouse.send(&pen(1e-3 * f64::from(step), 0.0, 0.5));
        turn(&mut live);
    }
    assert!(live.paint.painting_mut().report().steps > 0);
}

#[test]
fn a_take_without_credit_holds_up_no_other_device() {
    let mut live = live();
    live.announce(1);
    let samples = take();
    // Paint has no turn: the brush may send no more than 64 states.
    for _ in 0..100 {
        live.player_turn(&samples);
        live.net.advance(1_000_000);
        live.brush.poll().expect("turned");
    }
    assert_eq!(live.brush.sent(), 64);
    let mut mouse = live.device("mouse", 5);
    mouse.send(&pen(0.0, 0.0, 0.5));
    for _ in 0..4 {
        live.net.advance(1_000_000);
        live.brush.poll().expect("turned");
    }
    assert_eq!(mouse.consumed(), 1);
}

/// Tells the brush's own node something and returns what it says against it.
fn tell_brush(live: &mut Live, number: u64, command: Command) -> Option<String> {
    match live.ask("main", number, command) {
        Outcome::Refused { what, .. } => Some(what),
        Outcome::Done { .. } | Outcome::Waiting => None,
    }
}

#[test]
fn another_brush_is_taken_up_and_a_bad_file_leaves_the_one_in_hand() {
    let mut live = live();
    let (bus, wake) = (live.net.bus(), Wake::new());
    let topic = live.topics.brush_def("main");
    let mut defs = Receiver::<BrushDef>::new(&bus, &topic, Qos::Cached, Queue::Ring(8), &wake)
        .expect("subscribed");
    let define = |toml: String| {
        Command::from(BrushCommand::Define {
            brush: BrushName::main(),
            toml: BrushToml::new(toml).expect("valid"),
        })
    };
    let text = BrushFile::library_text("flat").expect("flat").to_owned();
    let misspelt = text.replace("friction =", "frictoin =");
    let said = tell_brush(&mut live, 1, define(misspelt)).expect("refused");
    assert!(said.contains("frictoin"), "{said}");
    let negative = text.replace("length_mm = 26.0", "length_mm = -26.0");
    let said = tell_brush(&mut live, 2, define(negative)).expect("refused");
    assert!(said.contains("head.length_mm"), "{said}");
    let undo = Command::from(Undo { brush: None });
    let refused = undo.misaddressed();
    assert_eq!(live.ask("main", 3, undo), refused);
    let mut mouse = live.device("mouse", 5);
    let load = Command::from(Load {
        mixture: loads()[0].clone(),
        beside: None,
        brush: BrushName::main(),
    });
    live.command(4, load);
    let mut paint = |live: &mut Live, y: f64| {
        for step in 0..20 {
            mouse.send(&pen(1e-3 * f64::from(step), y, 0.5));
            turn(live);
        }
        let busy = tell_brush(live, 5, define(text.clone()));
        mouse.send(&pen(0.0, y, 0.0));
        turn(live);
        let report = live.paint.painting_mut().report();
        (busy, report.covered_cells, report.quanta_missing)
    };
    let (busy, round, missing) = paint(&mut live, 0.0);
    assert!(busy.is_some_and(|said| said.contains("painting")));
    assert!(round > 0 && missing == 0);
    assert!(defs.try_recv().is_some(), "the first one");
    assert_eq!(tell_brush(&mut live, 6, define(text.clone())), None);
    turn(&mut live);
    let newest = std::iter::from_fn(|| defs.try_recv()).last();
    let told = newest.expect("another one").message;
    assert_eq!(BrushFile::parse(&told.toml).expect("whole").kind, "flat");
    let (_, both, missing) = paint(&mut live, 0.01);
    println!(
        "{:?} refused {:?}",
        live.paint.painting_mut().report(),
        live.paint
    );
    assert!(both > round + round / 2, "{round} {both}");
    assert_eq!(missing, 0, "what the round carried is on the flat");
}

#[test]
fn a_softer_brush_pushes_back_less() {
    let mut live = live();
    let mut models = models(&live);
    let mut arm = force_device(&live);
    turn(&mut live);
    let mut felt = |live: &mut Live| {
        let mut k1 = 0.0;
        for _ in 0..8 {
            arm.send(&pen(0.0, 0.0, 0.4));
            turn(live);
            while let Some(model) = models.try_recv() {
                let ForceLaw::Linear { k1_n, .. } = model.message.law else {
                    panic!("a linear law");
                };
                assert!(model.message.recovery_ns > 0, "no jump in the hand");
                k1 = k1_n;
            }
        }
        k1
    };
    let stiff = felt(&mut live);
    let tuning = Tuning {
        brush: "main".into(),
        stiffness: 1.0,
        wetness: 1.0,
    };
    live.command(1, Command::from(Tune::try_from(&tuning).expect("in range")));
    let soft = felt(&mut live);
    assert!(
        soft < 0.7 * stiff && soft > 0.3 * stiff,
        "a soaked head is half as stiff: {stiff} N, {soft} N"
    );
}
