//! Switches of a stylus beside a brush node and a paint node.

#[path = "../../paint/tests/support/mod.rs"]
mod support;

use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::DVec3;
use maulstick_brush::desk::Desk;
use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus, Faults, MemoryNet, Qos, Queue, Wake};
use maulstick_device::actions::{Actions, Actor};
use maulstick_painting::edits::{Clean, Handle, Place, Undo};
use maulstick_rig::config::DeviceSection;
use maulstick_types::command::Command;
use maulstick_types::paint::{Entry, JournalEntry};
use maulstick_types::scene::{BrushHandling, BrushMode, CANVAS, PALETTE, Scene, Surface};
use maulstick_types::stylus::{StylusSample, switch};
use maulstick_types::values::BrushName;

use crate::support::{Live, START_NS};

const PICK: u32 = 1;
const PALETTE_SWITCH: u32 = 2;
const UNDO: u32 = 4;
const CLEAN: u32 = 8;

/// A rig with a stylus of four switches.
struct Rig {
    live: Live,
    journal: Receiver<JournalEntry>,
    commands: Vec<Command>,
}

fn net() -> MemoryNet {
    MemoryNet::new(1, START_NS, Faults::default())
}

fn actor(net: &MemoryNet, live: &Live, brush: &str) -> Actor {
    let mut device = DeviceSection::new("arm", "polhem", brush);
    let names = ["pick", "palette", "undo", "clean"];
    device.switches = Some(names.map(String::from).into());
    let bus: Arc<dyn Bus> = Arc::new(net.bus());
    Actor::start(bus, &live.topics, brush, Actions::of(&device)).expect("an actor")
}

fn hold(actor: &mut Actor, switches: u32) {
    actor.receive(&StylusSample {
        switches,
        in_range: true,
        ..StylusSample::away()
    });
}

impl Rig {
    fn new() -> (Self, Actor) {
        let net = net();
        let live = Live::new(net.clone());
        let actor = actor(&net, &live, "main");
        let journal = live.topics.journal();
        let (queue, wake) = (Queue::Ring(4096), Wake::new());
        let journal = Receiver::new(&net.bus(), &journal, Qos::Data, queue, &wake);
        let rig = Self {
            live,
            journal: journal.expect("subscribed"),
            commands: Vec::new(),
        };
        (rig, actor)
    }

    fn turn(&mut self) {
        self.live.net.advance(1_000_000);
        self.live.paint.poll().expect("turned");
        while let Some(received) = self.journal.try_recv() {
            if let Entry::Command { command, .. } = received.message.entry {
                self.commands.push(command);
            }
        }
        std::thread::yield_now();
    }

    fn scene(&mut self) -> Scene {
        self.live.paint.painting_mut().scene().clone()
    }

    /// Lets the rig live until it is as `wanted`.
    fn until(&mut self, what: &str, mut wanted: impl FnMut(&mut Self) -> bool) {
        let give_up = Instant::now() + Duration::from_secs(60);
        while !wanted(self) {
            assert!(Instant::now() < give_up, "{what}: {:?}", self.commands);
            self.turn();
        }
    }

    fn mode(&mut self) -> BrushMode {
        let scene = self.scene();
        let mut handlings = scene.handlings.into_iter();
        let ours = handlings.find(|handling| handling.brush == "main");
        ours.map_or(BrushMode::Normal, |handling| handling.mode)
    }

    fn until_mode(&mut self, mode: &BrushMode) {
        self.until(&format!("{mode:?}"), |rig| rig.mode() == *mode);
    }

    /// The ways of using the brush that were asked for, in order.
    fn modes(&self) -> Vec<BrushMode> {
        let commands = self.commands.iter();
        let modes = commands.filter_map(|command| Some(command.edit::<Handle>()?.mode));
        modes.collect()
    }

    fn surface(&mut self, id: u32) -> Surface {
        let scene = self.scene();
        let mut surfaces = scene.surfaces.into_iter();
        surfaces.find(|surface| surface.id == id).expect("there")
    }
}

#[test]
fn undo_takes_the_newest_step_of_its_brush_back_and_clean_cleans_it() {
    let (mut rig, mut actor) = Rig::new();
    rig.live.announce(1);
    let mut order = (0..3u8).cycle();
    rig.live.play(&mut || order.next().expect("endless"), 5000);
    let covered = |rig: &mut Rig| rig.live.paint.painting_mut().report().covered_cells;
    let before = covered(&mut rig);
    hold(&mut actor, UNDO);
    rig.until("an undo", |rig| covered(rig) < before);
    // Held on it does nothing more; nor does letting go.
    hold(&mut actor, UNDO);
    hold(&mut actor, 0);
    hold(&mut actor, CLEAN);
    rig.until("a cleaning", |rig| {
        rig.commands.contains(&Command::from(Clean {
            brush: BrushName::main(),
        }))
    });
    let undone = Command::from(Undo {
        brush: Some(BrushName::main()),
    });
    assert_eq!(rig.commands.iter().filter(|c| **c == undone).count(), 1);
}

#[test]
fn a_brush_picks_while_its_switch_is_held_and_is_used_as_before_then() {
    let (mut rig, mut actor) = Rig::new();
    let before = BrushHandling {
        mode: BrushMode::Marker,
        flow: 2e-3,
        most_m: 3e-5,
        ..BrushHandling::normal("main")
    };
    let handling = before.clone();
    rig.live.command(
        1,
        Command::from(Handle::try_from(&handling).expect("in range")),
    );
    hold(&mut actor, PICK);
    rig.until_mode(&BrushMode::Sampler);
    hold(&mut actor, 0);
    rig.until("as before", |rig| rig.scene().handlings == [before.clone()]);
}

#[test]
fn quick_presses_are_done_in_order_and_leave_the_brush_as_it_was() {
    let (mut rig, mut actor) = Rig::new();
    for _ in 0..8 {
        hold(&mut actor, PICK);
        hold(&mut actor, 0);
    }
    rig.until("all", |rig| rig.modes().len() == 16);
    let pairs = rig.modes();
    for pair in pairs.chunks(2) {
        assert_eq!(pair, [BrushMode::Sampler, BrushMode::Normal]);
    }
    rig.until_mode(&BrushMode::Normal);
}

#[test]
fn the_eraser_end_lifts_paint_off_while_it_is_near() {
    let (mut rig, mut actor) = Rig::new();
    hold(&mut actor, switch::ERASER);
    rig.until_mode(&BrushMode::Vacuum);
    hold(&mut actor, switch::ERASER | PICK);
    hold(&mut actor, PICK);
    rig.until_mode(&BrushMode::Sampler);
    hold(&mut actor, switch::ERASER);
    rig.until_mode(&BrushMode::Vacuum);
    // Out of range it is not near.
    actor.receive(&StylusSample {
        switches: switch::ERASER,
        ..StylusSample::away()
    });
    rig.until_mode(&BrushMode::Normal);
}

#[test]
fn the_palette_slides_over_the_canvas_where_a_brush_finds_it_and_back() {
    let (mut rig, mut actor) = Rig::new();
    let rest = rig.surface(PALETTE).pose;
    let under = |rig: &mut Rig| {
        let desk = Desk::of(&rig.scene());
        desk.under(DVec3::Z * 0.02).map(|plane| plane.id)
    };
    assert_eq!(under(&mut rig), Some(CANVAS));
    for _ in 0..2 {
        hold(&mut actor, PALETTE_SWITCH);
        rig.until("over", |rig| under(rig) == Some(PALETTE));
        let desk = Desk::of(&rig.scene());
        let palette = desk.plane(PALETTE).expect("there");
        let gap = palette.half_space().gap(DVec3::ZERO);
        assert!((gap + 0.01).abs() < 1e-12, "its board lies over the paint");
        hold(&mut actor, 0);
        hold(&mut actor, PALETTE_SWITCH);
        rig.until("at rest", |rig| rig.surface(PALETTE).pose == rest);
        hold(&mut actor, 0);
    }
    // One that another daemon left over the canvas goes where a painting begins with it.
    hold(&mut actor, PALETTE_SWITCH);
    rig.until("over", |rig| under(rig) == Some(PALETTE));
    let mut another = self::actor(&rig.live.net, &rig.live, "main");
    hold(&mut another, PALETTE_SWITCH);
    rig.until("aside", |rig| under(rig) == Some(CANVAS));
    let pose = rig.surface(PALETTE).pose;
    let off = DVec3::from(pose.position_m) - DVec3::from(rest.position_m);
    assert!(off.length() < 1e-9, "{off}");
}

#[test]
fn what_is_refused_is_told_and_the_next_switch_works() {
    let (mut rig, _actor) = Rig::new();
    let mut stranger = actor(&rig.live.net, &rig.live, "nobody");
    hold(&mut stranger, CLEAN);
    hold(&mut stranger, CLEAN | PICK);
    hold(&mut stranger, PALETTE_SWITCH);
    rig.until("a palette that moves", |rig| rig.commands.len() == 1);
    assert!(rig.commands[0].edit::<Place>().is_some());
}

#[test]
fn a_daemon_that_ends_while_a_switch_is_held_leaves_the_brush_as_it_was() {
    let (mut rig, mut actor) = Rig::new();
    hold(&mut actor, PICK);
    rig.until_mode(&BrushMode::Sampler);
    let ending = std::thread::spawn(move || drop(actor));
    rig.until("the end", |_| ending.is_finished());
    assert_eq!(rig.mode(), BrushMode::Normal);
    ending.join().expect("ended");
}

/// Two pens on one brush, or one daemon after another that was killed while its eraser was near: what
/// one holds is not how the other uses the brush as before.
#[test]
fn what_another_device_holds_is_not_restored() {
    let (mut rig, mut one) = Rig::new();
    let mut other = actor(&rig.live.net, &rig.live, "main");
    hold(&mut one, switch::ERASER);
    rig.until_mode(&BrushMode::Vacuum);
    hold(&mut other, PICK);
    rig.until_mode(&BrushMode::Sampler);
    hold(&mut one, 0);
    rig.until_mode(&BrushMode::Normal);
    hold(&mut other, 0);
    rig.until("both to let go", |rig| rig.modes().len() == 4);
    assert_eq!(rig.modes()[3], BrushMode::Normal);
}

#[test]
fn a_letting_go_that_nobody_answers_is_asked_for_until_somebody_does() {
    let (mut rig, mut actor) = Rig::new();
    hold(&mut actor, PICK);
    rig.until_mode(&BrushMode::Sampler);
    rig.live.net.set_faults(Faults {
        loss: 1.0,
        ..Faults::default()
    });
    hold(&mut actor, 0);
    // Longer than a command is patient.
    let since = Instant::now();
    rig.until("the end of patience", |_| {
        since.elapsed() > Duration::from_secs(3)
    });
    assert_eq!(rig.mode(), BrushMode::Sampler);
    rig.live.net.set_faults(Faults::default());
    rig.until_mode(&BrushMode::Normal);
}

#[test]
fn a_palette_over_a_canvas_that_has_moved_since_goes_back_to_where_it_was() {
    let (mut rig, mut actor) = Rig::new();
    let rest = rig.surface(PALETTE).pose;
    hold(&mut actor, PALETTE_SWITCH);
    rig.until("over", |rig| rig.surface(PALETTE).pose != rest);
    let mut pose = rig.surface(CANVAS).pose;
    pose.position_m[0] += 0.05;
    let (surface, zoom) = (CANVAS, 1.0);
    let moved = Command::from(Place::new(surface, pose.clone(), zoom).expect("in reach"));
    rig.live.command(1, moved);
    rig.until("moved", |rig| rig.surface(CANVAS).pose == pose);
    hold(&mut actor, 0);
    hold(&mut actor, PALETTE_SWITCH);
    rig.until("at rest", |rig| rig.surface(PALETTE).pose == rest);
}

#[test]
fn a_rig_without_a_paint_node_does_not_hold_the_device_up() {
    let net = net();
    let mut device = DeviceSection::new("arm", "polhem", "main");
    device.switches = Some(vec!["undo".into()]);
    let bus: Arc<dyn Bus> = Arc::new(net.bus());
    let topics = maulstick_types::wire::topics::Topics::new("t");
    let mut actor = Actor::start(bus, &topics, "main", Actions::of(&device)).expect("an actor");
    // More edges than fit; each call returns, and so does the end.
    for _ in 0..1000 {
        hold(&mut actor, 1);
        hold(&mut actor, 0);
    }
    drop(actor);
}
