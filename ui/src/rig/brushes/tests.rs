use maulstick_brush::BrushModel;
use maulstick_bus::typed::Sender;
use maulstick_bus::{Faults, MemoryBus, MemoryNet};
use maulstick_painting::PaintingSetup;
use maulstick_types::Origin;
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose};

use super::*;
use crate::render::brush::paint_colour::tests::look_of;

const PEN: Origin = Origin {
    source: 1,
    epoch: 1,
};
const BRUSH: Origin = Origin {
    source: 2,
    epoch: 1,
};
const DEPTH: f64 = 0.5;

/// A pen, a brush node's topics, and who follows them.
struct Rig {
    net: MemoryNet,
    bus: MemoryBus,
    pen: Sender<StylusSample>,
    states: Sender<BrushState>,
    def: Sender<BrushDef>,
    model: BrushModel,
    tracker: BrushTracker,
    desk: Desk,
    /// When the pen was sampled last.
    sampled_ns: u64,
}

impl Rig {
    fn new(quiet: u32) -> Self {
        let net = MemoryNet::new(1, 1_000_000_000, Faults::default());
        let (bus, topics) = (net.bus(), Topics::new("t"));
        let toml = BrushFile::library_text("round").expect("text");
        let file = BrushFile::parse(toml).expect("round");
        let mut def =
            Sender::new(&bus, &topics.brush_def("main"), Qos::Cached, BRUSH).expect("a sender");
        let told = BrushDef {
            brush: "main".into(),
            toml: toml.into(),
            hash: 0,
            head_length_m: 0.0,
        };
        def.send(0, 0, &told).expect("sent");
        let scene = PaintingSetup::default().scene();
        let mut model = BrushModel::new(file, DEPTH);
        model.set_scene(&scene);
        let shares = BTreeMap::from([("main".to_owned(), DEPTH)]);
        let real_time = Qos::RealTime;
        Self {
            pen: Sender::new(&bus, &topics.sample("pen"), real_time, PEN).expect("a pen"),
            states: Sender::new(&bus, &topics.brush_state("main"), real_time, BRUSH)
                .expect("states"),
            tracker: BrushTracker::new(&bus, &topics, &Wake::new(), shares, quiet)
                .expect("a follower"),
            def,
            desk: Desk::of(&scene),
            sampled_ns: 0,
            model,
            net,
            bus,
        }
    }

    fn sample(&mut self, sample: &StylusSample) {
        let now = self.bus.now_ns();
        self.sampled_ns = now;
        self.pen.send(now, now, sample).expect("sent");
    }

    fn solve(&mut self, seq: u64, sample: &StylusSample) -> BrushState {
        let (now, at) = (self.bus.now_ns(), self.sampled_ns);
        let state = self.model.state(PEN, seq, at, sample).expect("a state");
        self.states.send(now, now, &state).expect("sent");
        state
    }

    fn turn(&mut self) -> Option<(Rigid, u32, Vec<[f32; 2]>)> {
        self.net.advance(5_000_000);
        self.tracker.drain(self.bus.now_ns());
        let held = self.tracker.held(&self.desk).next()?;
        Some((held.brush, held.plane.id, held.angles))
    }
}

fn pen(x: f64, pressure: f64) -> StylusSample {
    StylusSample {
        pose: StylusPose::Contact {
            point_m: [x, 0.0, 0.0],
            tilt_rad: DEFAULT_TILT_RAD,
            twist_rad: 0.0,
            pressure,
        },
        in_range: true,
        ..StylusSample::away()
    }
}

#[test]
fn the_pose_is_that_of_the_newest_sample_and_the_bend_that_of_the_newest_state() {
    let mut rig = Rig::new(0);
    rig.sample(&pen(0.0, 0.4));
    assert_eq!(
        rig.turn(),
        None,
        "whose brush it is comes with the first state"
    );
    let first = rig.solve(0, &pen(0.0, 0.4));
    rig.sample(&pen(0.01, 0.4));
    let (shown, surface, angles) = rig.turn().expect("a brush");
    let second = rig.solve(1, &pen(0.01, 0.4));
    let newest = |state: &BrushState| state.solves.last().cloned().expect("a solve");
    let (solved, old) = (&newest(&second), &newest(&first));
    let off = |solve: &maulstick_types::brush::Solve| {
        (shown.translation - Rigid::from(&solve.pose).translation).length()
    };
    assert!(
        off(solved) < 2.5e-3 && surface == solved.surface,
        "{}",
        off(solved)
    );
    assert!(off(old) > 5e-3, "a fault would pass");
    assert_eq!(angles, old.angles_rad);
    let (_, _, angles) = rig.turn().expect("a brush");
    assert_eq!(angles, solved.angles_rad);
    assert_ne!(angles, old.angles_rad);
}

#[test]
fn another_brush_is_where_the_hand_rests() {
    let mut rig = Rig::new(PEN.source);
    rig.sample(&pen(0.0, 0.0));
    rig.turn();
    rig.solve(0, &pen(0.0, 0.0));
    let (round, ..) = rig.turn().expect("a brush");
    let told = BrushDef {
        brush: "main".into(),
        toml: BrushFile::library_text("fan").expect("text").into(),
        hash: 1,
        head_length_m: 0.0,
    };
    let now = rig.bus.now_ns();
    rig.def.send(now, now, &told).expect("sent");
    let (fan, ..) = rig.turn().expect("it is there though the hand keeps still");
    assert_ne!(round, fan, "it has its own length");
    let held = rig.tracker.held(&rig.desk).next().expect("a brush");
    assert!(
        Head::of(held.file).fits(held.angles.len()),
        "its bristles stand"
    );
    assert!(rig.tracker.aim("main").is_some());
}

#[test]
fn a_stroke_stays_on_its_surface_and_a_hovering_brush_changes_it() {
    let mut rig = Rig::new(0);
    let (canvas, palette) = (0.0, -0.2);
    rig.sample(&pen(canvas, 0.4));
    rig.solve(0, &pen(canvas, 0.4));
    rig.sample(&pen(palette, 0.4));
    assert_eq!(rig.turn().map(|held| held.1), Some(0));
    rig.solve(1, &pen(canvas, 0.0));
    rig.sample(&pen(palette, 0.0));
    assert_eq!(rig.turn().map(|held| held.1), Some(1));
}

#[test]
fn a_device_out_of_range_or_silent_holds_no_brush_but_a_still_mouse_does() {
    for (quiet, shown) in [(0, false), (PEN.source, true)] {
        let mut rig = Rig::new(quiet);
        rig.sample(&pen(0.0, 0.0));
        rig.solve(0, &pen(0.0, 0.0));
        assert!(rig.turn().is_some());
        rig.net.advance(SILENCE_NS);
        assert_eq!(rig.turn().is_some(), shown);
        rig.sample(&pen(0.0, 0.0));
        assert!(rig.turn().is_some());
        rig.sample(&StylusSample::away());
        assert!(rig.turn().is_none());
    }
}

#[test]
fn a_brush_has_the_paint_that_was_told_newest() {
    let mut rig = Rig::new(0);
    let key = Topics::new("t").brush_look("main");
    let mut looks = Sender::new(&rig.bus, &key, Qos::Cached, BRUSH).expect("a sender");
    rig.sample(&pen(0.0, 0.4));
    rig.solve(0, &pen(0.0, 0.4));
    let mut told = |rig: &mut Rig, look: &BrushLook| {
        rig.sample(&pen(0.0, 0.4));
        looks.send(0, 0, look).expect("sent");
        rig.turn();
        let held = rig.tracker.held(&rig.desk).next();
        held.expect("a brush").coat.map(|coat| coat.at(0, 0.5))
    };
    let [blue, red] = [[0.0, 0.0, 1.0, 1.0], [1.0, 0.0, 0.0, 0.5]];
    let first = told(&mut rig, &look_of(1, 1, &[blue]));
    let second = told(&mut rig, &look_of(1, 1, &[red]));
    assert_eq!(first, Some(Some((glam::Vec3::Z, 1.0))));
    assert_eq!(
        second,
        Some(Some((glam::Vec3::X, 0.5))),
        "a fault would pass"
    );
    // A look that does not fit shows a bare brush.
    assert_eq!(told(&mut rig, &look_of(2, 1, &[red])), None);
}
