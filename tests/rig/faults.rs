//! Sixty faults in a random order while a hand paints: processes that die or freeze, garbage, floods, hands that are too
//! fast, sockets that are removed, a machine that stands still. Nothing committed is lost, and the rig paints again.

#![allow(clippy::panic, reason = "helpers of tests say what they saw")]

#[path = "../support/mod.rs"]
mod support;

#[path = "faults/hand.rs"]
mod hand;

use std::time::{Duration, Instant};

use hand::Hand;
use maulstick_bus::{Bus as _, Qos, ZenohBus};
use maulstick_types::paint::{Entry, JournalEntry, PaintStatus};
use maulstick_types::wire::topics::Topics;
use nix::sys::signal::Signal;
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng as _, SeedableRng as _};
use support::{Launcher, PATIENCE, Place, drain, hear, info, join, listen, signal, wait_for};

/// How often each fault strikes.
const EACH: usize = 6;
/// Seed of the order and of the garbage.
const SEED: u64 = 20_261_127;
/// Painting goes on once states have been accepted for so long without a longer break than [`BREAK`].
const STEADY: Duration = Duration::from_secs(1);
const BREAK: Duration = Duration::from_millis(300);
/// A process may hold so much more memory after all floods than before the first.
const MORE_BYTES: u64 = 64 << 20;

/// The launcher takes three failures of a node within ten seconds for one that does not stay up: there are two at most.
const APART: Duration = Duration::from_secs(11);

/// What is done to a rig.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fault {
    BrushDies,
    PaintDies,
    BrushFreezes,
    PaintFreezes,
    Garbage,
    Flood,
    FastHand,
    NotFinite,
    SocketGone,
    MachineStandsStill,
}

const FAULTS: [Fault; 10] = [
    Fault::BrushDies,
    Fault::PaintDies,
    Fault::BrushFreezes,
    Fault::PaintFreezes,
    Fault::Garbage,
    Fault::Flood,
    Fault::FastHand,
    Fault::NotFinite,
    Fault::SocketGone,
    Fault::MachineStandsStill,
];

impl Fault {
    /// True if a process ends by it.
    fn ends_a_node(self) -> bool {
        matches!(
            self,
            Self::BrushDies
                | Self::PaintDies
                | Self::BrushFreezes
                | Self::PaintFreezes
                | Self::SocketGone
        )
    }
}

/// A rig under attack.
struct Attack<'a> {
    place: &'a Place,
    bus: &'a ZenohBus,
    topics: &'a Topics,
    hand: Hand,
    dice: Pcg64Mcg,
}

impl Attack<'_> {
    fn pid(&self, program: &str) -> u32 {
        wait_for(PATIENCE, || self.place.pid(program)).expect("the node runs")
    }

    fn put(&self, topic: &str, bytes: Vec<u8>) {
        let publisher = self.bus.publisher(topic, Qos::Data).expect("declared");
        publisher.put(bytes).expect("sent");
    }

    fn garbage(&mut self) {
        let topics = [
            self.topics.sample("hand"),
            self.topics.brush_state("main"),
            self.topics.brush_def("main"),
            self.topics.brush_consumed("main"),
            self.topics.paint_consumed(),
            self.topics.scene(),
            self.topics.journal(),
        ];
        for topic in &topics {
            for _ in 0..20 {
                let mut bytes = vec![0; (self.dice.next_u32() % 4096) as usize];
                self.dice.fill_bytes(&mut bytes);
                // Half of them begin as a message of the rig does.
                if self.dice.next_u32().is_multiple_of(2) {
                    let whole = self.hand.encoded();
                    let kept = bytes.len().min(whole.len() / 2);
                    bytes[..kept].copy_from_slice(&whole[..kept]);
                }
                self.put(topic, bytes);
            }
        }
    }

    fn remove_socket(&self) {
        let folder = self.place.path("maulstick/studio");
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            let name = entry.file_name().to_string_lossy().into_owned();
            if name.contains("brush") && name.contains("sock") {
                std::fs::remove_file(entry.path()).ok();
            }
        }
    }

    /// Strikes; the time from which the rig can paint again.
    fn strike(&mut self, fault: Fault, launcher: &Launcher) -> Instant {
        let struck = Instant::now();
        match fault {
            Fault::BrushDies => signal(self.pid("maulstick-brush"), Signal::SIGKILL),
            Fault::PaintDies => signal(self.pid("maulstick-paint"), Signal::SIGKILL),
            Fault::BrushFreezes => signal(self.pid("maulstick-brush"), Signal::SIGSTOP),
            Fault::PaintFreezes => signal(self.pid("maulstick-paint"), Signal::SIGSTOP),
            Fault::Garbage => self.garbage(),
            Fault::Flood => self.hand.flood(self.bus, self.topics, 20_000),
            Fault::FastHand => self.hand.leap(1000),
            Fault::NotFinite => self.hand.not_finite(self.bus, self.topics),
            Fault::SocketGone => {
                self.remove_socket();
                signal(self.pid("maulstick-paint"), Signal::SIGKILL);
            }
            Fault::MachineStandsStill => {
                self.stand_still(launcher);
                // It painted nothing until now, which is nobody's fault.
                return Instant::now();
            }
        }
        struck
    }

    /// Stops all processes of the rig for eight seconds.
    fn stand_still(&self, launcher: &Launcher) {
        let all: Vec<u32> = self.place.processes().iter().map(|(pid, _)| *pid).collect();
        signal(launcher.pid(), Signal::SIGSTOP);
        for pid in &all {
            signal(*pid, Signal::SIGSTOP);
        }
        wait_for(Duration::from_secs(8), || None::<()>);
        for pid in &all {
            signal(*pid, Signal::SIGCONT);
        }
        signal(launcher.pid(), Signal::SIGCONT);
    }
}

/// Bytes of memory that a process holds.
fn resident(pid: u32) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{pid}/status")).unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    let kib = line.and_then(|line| line.trim().trim_end_matches(" kB").parse::<u64>().ok());
    kib.unwrap_or_default() << 10
}

/// [`EACH`] of each, shuffled.
fn order(dice: &mut Pcg64Mcg) -> Vec<Fault> {
    let mut order = FAULTS.repeat(EACH);
    for last in (1..order.len()).rev() {
        order.swap(last, dice.next_u32() as usize % (last + 1));
    }
    order
}

/// Waits until states have been accepted steadily; how long that took to begin.
fn paints_steadily(struck: Instant, mut accepted: impl FnMut() -> Option<()>) -> Option<Duration> {
    let (mut since, mut newest) = (struck, struck);
    wait_for(PATIENCE, || {
        if accepted().is_some() {
            if newest.elapsed() > BREAK {
                since = Instant::now();
            }
            newest = Instant::now();
        }
        let steady = newest.elapsed() < BREAK && since.elapsed() > STEADY;
        steady.then_some(since.duration_since(struck))
    })
}

/// Faults that ended a node, by their times.
#[derive(Default)]
struct Failures(Vec<Instant>);

impl Failures {
    /// Waits until another one leaves two at most within [`APART`].
    fn wait_for_room(&self) {
        let before_last = self.0.iter().nth_back(1);
        let passed = before_last.map_or(APART, Instant::elapsed);
        wait_for(APART.saturating_sub(passed), || None::<()>);
    }
}

/// Prints the times until the rig painted again.
fn print_times(mut times: Vec<Duration>) {
    times.sort();
    println!(
        "{} faults: painting again after {:.2} s in the median, {:.2} s at most",
        times.len(),
        times[times.len() / 2].as_secs_f64(),
        times[times.len() - 1].as_secs_f64()
    );
}

/// Memory of brush and paint after all floods is about that after the first.
fn check_memory(held: &[[u64; 2]]) {
    println!("memory after floods {held:?}");
    if let (Some(first), Some(last)) = (held.first(), held.last()) {
        let mut pairs = last.iter().zip(first);
        let grows = pairs.any(|(last, first)| *last > first + MORE_BYTES);
        assert!(!grows, "{held:?}");
    }
}

#[test]
#[ignore = "takes four minutes: `./test --long`"]
fn sixty_faults_lose_nothing_and_the_rig_paints_again() {
    let place = Place::new();
    let launcher = Launcher::up(&place, &["p.maul", "--cell-mm", "0.5"]);
    let (bus, topics) = join(&place);
    let mut status = listen::<PaintStatus>(&bus, &topics.paint_status(), Qos::Background);
    let mut journal = listen::<JournalEntry>(&bus, &topics.journal(), Qos::Data);
    let mut attack = Attack {
        place: &place,
        hand: Hand::new(&place),
        bus: &bus,
        topics: &topics,
        dice: Pcg64Mcg::seed_from_u64(SEED),
    };
    let mut accepted = || {
        let mut heard = false;
        while let Some(received) = journal.try_recv() {
            heard |= matches!(received.message.entry, Entry::States { .. });
        }
        heard.then_some(())
    };
    wait_for(PATIENCE, &mut accepted).expect("the hand paints");

    let mut committed = 0;
    let (mut times, mut failures) = (Vec::new(), Failures::default());
    let mut held = Vec::new();
    for (number, fault) in order(&mut attack.dice).into_iter().enumerate() {
        let what = format!("fault {number}, {fault:?}");
        if fault.ends_a_node() {
            failures.wait_for_room();
        }
        let struck = attack.strike(fault, &launcher);
        let again = paints_steadily(struck, &mut accepted);
        let again = again.unwrap_or_else(|| panic!("{what}: {}", launcher.said()));
        println!("{what}: painting again after {:.2} s", again.as_secs_f64());
        times.push(again);
        if fault.ends_a_node() {
            failures.0.push(Instant::now());
        }
        drain(&mut status);
        let told = hear(&mut status, |_| true).expect("a status");
        let now = told.committed;
        assert!(now >= committed, "{what}: {committed} were in the file");
        assert_eq!(told.fault, "", "{what}");
        committed = now;
        if matches!(fault, Fault::Flood | Fault::FastHand) {
            let nodes = ["maulstick-brush", "maulstick-paint"];
            held.push(nodes.map(|node| resident(attack.pid(node))));
        }
    }
    print_times(times);
    check_memory(&held);
    drop(attack);
    bus.close();
    launcher.close(&place);
    let there = info(&place, "p.maul");
    assert!(there["journal"].as_u64() >= Some(committed), "{there}");
    assert_eq!(there["ledger"]["quanta_missing"], 0);
}
