//! Work beside the painting: exports, another file, small pictures.

#![allow(clippy::panic, reason = "a test fails by it")]

use std::time::Instant;

use maulstick_bus::bus::{Answer, Pending};
use maulstick_bus::typed::Receiver;
use maulstick_bus::{Faults, MemoryBus, MemoryNet, Qos, Queue};
use maulstick_document::{Access, DocumentSettings};
use maulstick_optics::PaintLibrary;
use maulstick_painting::PaintingSetup;
use maulstick_painting::edits::{Fill, FillPaint, Forget, Keep};
use maulstick_types::command::{Command, CommandReply, CommandRequest, ExportOrder, Outcome};
use maulstick_types::command::{FileCommand, SaveAs, TakeCommand};
use maulstick_types::paint::{PaintStatus, StepName, ThumbnailReply, ThumbnailRequest};
use maulstick_types::scene::CANVAS;
use maulstick_types::values::{FilmThickness, VersionName, WholePath};
use maulstick_types::{Flags, Message, Mixture, decode, encode};

use super::*;

const ME: Origin = Origin {
    source: 1,
    epoch: 1,
};

fn painting() -> Painting {
    let setup = PaintingSetup {
        cells: [192, 128],
        ..PaintingSetup::default()
    };
    let library = PaintLibrary::measured().expect("whole");
    Painting::new(&setup, library).expect("a painting")
}

/// A node with a client.
pub(super) struct Rig {
    net: MemoryNet,
    pub(super) client: MemoryBus,
    pub(super) topics: Topics,
    pub(super) node: PaintNode,
    number: u64,
}

impl Rig {
    pub(super) fn new() -> Self {
        let net = MemoryNet::new(1, 1_000_000_000, Faults::default());
        let bus: Arc<dyn Bus> = Arc::new(net.bus());
        let topics = Topics::new("t");
        let node = PaintNode::new(bus, &topics, &Wake::new(), ME, painting()).expect("a node");
        Self {
            client: net.bus(),
            net,
            topics,
            node,
            number: 0,
        }
    }

    pub(super) fn turn(&mut self) {
        self.net.advance(1_000_000);
        self.node.poll().expect("a turn");
        self.net.advance(1_000);
    }

    fn begin<Q: Message>(&mut self, topic: &str, question: &Q) -> Pending {
        let bytes = encode(&ME, Flags::NONE, 0, 0, 0, question).expect("it fits");
        let limit = Duration::from_secs(3600);
        self.client
            .ask(topic, Qos::Control, bytes, limit, &Wake::new())
            .expect("asked")
    }

    pub(super) fn ask<Q: Message, A: Message>(&mut self, topic: &str, question: &Q) -> A {
        let pending = self.begin(topic, question);
        let give_up = Instant::now() + Duration::from_secs(120);
        loop {
            self.turn();
            if let Some(Answer::Bytes(bytes)) = pending.try_recv() {
                return decode::<A>(&bytes).expect("an answer").1;
            }
            assert!(Instant::now() < give_up, "no answer");
        }
    }

    /// Asks again and again until the command is done or refused.
    fn command(&mut self, command: Command) -> Outcome {
        self.number += 1;
        let request = CommandRequest {
            client: 9,
            number: self.number,
            after: None,
            command,
        };
        let topic = self.topics.command("paint");
        loop {
            let reply: CommandReply = self.ask(&topic, &request);
            if reply.outcome != Outcome::Waiting {
                return reply.outcome;
            }
        }
    }

    pub(super) fn done(&mut self, command: Command) -> String {
        match self.command(command) {
            Outcome::Done { detail, .. } => detail.to_string(),
            other => panic!("{other:?}"),
        }
    }

    pub(super) fn refused(&mut self, command: Command, words: &[&str]) {
        let asked = format!("{command:?}");
        let outcome = self.command(command);
        let Outcome::Refused { what, advice } = outcome else {
            panic!("{asked} is not refused: {outcome:?}");
        };
        let said = format!("{what}; {advice}");
        assert!(words.iter().all(|word| said.contains(word)), "{said}");
    }

    pub(super) fn fill(&mut self, paint: &str) {
        self.done(Command::from(Fill {
            paint: FillPaint::Mixture {
                mixture: Mixture::pure(paint),
            },
            thickness: FilmThickness::new(1e-4).expect("in range"),
            surface: CANVAS,
        }));
    }

    fn thumbnail(&mut self, version: &str, side: u32) -> ThumbnailReply {
        let topic = self.topics.thumbnail();
        let request = ThumbnailRequest {
            version: version.to_owned(),
            side,
            step: None,
        };
        self.ask(&topic, &request)
    }
}

pub(super) fn save_as(path: &Path, replace: bool) -> Command {
    Command::from(FileCommand::SaveAs(SaveAs {
        path: WholePath::new(path.display().to_string()).expect("valid"),
        replace,
    }))
}

/// The painting of a file, and how many steps it can undo.
pub(super) fn kept(path: &Path) -> (Painting, usize) {
    let settings = DocumentSettings::new(path, Access::Read);
    let (_document, opened) = Document::open(&settings).expect("whole");
    let mut painting = opened
        .expect("a painting")
        .sequencer()
        .expect("whole")
        .into_painting();
    let steps = painting.history_depth().0;
    let still = painting.still();
    // Its pages are read while the document is open.
    let store = still.store(CANVAS).expect("a canvas");
    assert!(store.counts().iter().sum::<u64>() > 0, "there is paint");
    (painting, steps)
}

#[test]
fn small_pictures_show_versions_and_the_painting_as_it_is() {
    let mut rig = Rig::new();
    let bare = rig.thumbnail("", 48);
    assert_eq!((bare.width, bare.height), (48, 32));
    assert_eq!(bare.rgb.len(), 48 * 32 * 3);
    rig.fill("Yellow Ochre");
    rig.done(Command::from(Keep {
        name: VersionName::new("yellow").expect("valid"),
    }));
    let yellow = rig.thumbnail("", 48);
    rig.fill("Bone Black");
    let black = rig.thumbnail("", 48);
    let light =
        |picture: &ThumbnailReply| -> u64 { picture.rgb.iter().map(|byte| u64::from(*byte)).sum() };
    assert!(light(&bare) > light(&yellow) && light(&yellow) > light(&black));
    assert_eq!(rig.thumbnail("yellow", 48).rgb, yellow.rgb);
    assert_ne!(rig.thumbnail("yellow", 24).rgb.len(), yellow.rgb.len());
    assert_eq!(rig.thumbnail("nobody", 48).width, 0);
    // Another version of its name is another picture.
    rig.done(Command::from(Forget {
        name: VersionName::new("yellow").expect("valid"),
    }));
    assert_eq!(rig.thumbnail("yellow", 48).width, 0);
    rig.done(Command::from(Keep {
        name: VersionName::new("yellow").expect("valid"),
    }));
    assert_eq!(rig.thumbnail("yellow", 48).rgb, black.rgb);
}

#[test]
fn an_export_is_of_the_moment_it_was_asked_for_and_done_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let mut rig = Rig::new();
    rig.fill("Yellow Ochre");
    let snapshot = |rig: &mut Rig, name: &str| {
        rig.done(Command::from(TakeCommand::Snapshot {
            path: WholePath::new(at(name).display().to_string()).expect("valid"),
            ledger: None,
        }));
        std::fs::read(at(name)).expect("written")
    };
    let before = snapshot(&mut rig, "before.png");
    let order = ExportOrder::to(at("a.png").display().to_string().parse().expect("whole"));
    let request = CommandRequest {
        client: 5,
        number: 1,
        after: None,
        command: Command::from(FileCommand::Export(order)),
    };
    let topic = rig.topics.command("paint");
    let reply: CommandReply = rig.ask(&topic, &request);
    assert_eq!(reply.outcome, Outcome::Waiting);
    rig.fill("Bone Black");
    let give_up = Instant::now() + Duration::from_secs(120);
    while matches!(
        rig.ask::<_, CommandReply>(&topic, &request).outcome,
        Outcome::Waiting
    ) {
        assert!(Instant::now() < give_up, "it does not end");
    }
    assert_eq!(std::fs::read(at("a.png")).expect("written"), before);
    assert_ne!(
        snapshot(&mut rig, "after.png"),
        before,
        "a fault would pass"
    );
    // Asked again it is answered again, not done again.
    std::fs::remove_file(at("a.png")).expect("removed");
    let again: CommandReply = rig.ask(&topic, &request);
    assert!(matches!(again.outcome, Outcome::Done { .. }));
    assert!(!at("a.png").exists());
    rig.refused(
        Command::from(FileCommand::StopExport),
        &["nothing is being exported"],
    );
}

#[test]
fn a_painting_in_memory_becomes_a_file_and_then_another() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let mut rig = Rig::new();
    rig.fill("Yellow Ochre");
    rig.fill("Bone Black");
    rig.refused(save_as(&at("no/a.maul"), false), &["folder"]);
    assert_eq!(rig.node.document_path(), None);
    std::fs::write(at("list.txt"), "a shopping list").expect("written");
    rig.refused(
        save_as(&at("list.txt"), true),
        &["not a Maulstick painting"],
    );
    rig.done(save_as(&at("a.maul"), false));
    assert_eq!(rig.node.document_path(), Some(&*at("a.maul")));
    rig.fill("Pyrrole Red");
    rig.done(save_as(&at("b.maul"), false));
    rig.fill("Titanium White");
    rig.refused(save_as(&at("a.maul"), false), &["already", "may go"]);
    rig.done(save_as(&at("b.maul"), false));
    let depth = rig.node.sequencer.painting().history_depth().0;
    let counts = |painting: &Painting| painting.store(CANVAS).expect("a canvas").counts();
    let end = counts(rig.node.sequencer.painting());
    rig.node.close().expect("closed");
    let (first, steps) = kept(&at("a.maul"));
    assert_eq!(steps, depth - 1, "what came later is not in it");
    drop(first);
    let (second, steps) = kept(&at("b.maul"));
    assert_eq!(steps, depth);
    drop(second);
    assert!(end.iter().sum::<u64>() > 0);
    let names: Vec<_> = std::fs::read_dir(folder.path())
        .expect("a folder")
        .flatten()
        .map(|entry| entry.file_name())
        .collect();
    assert_eq!(names.len(), 3, "nothing is left beside them: {names:?}");
}

/// Asks for a painting in memory alone to be put there, and waits for nothing.
fn begins_to_save(rig: &mut Rig, path: &Path) {
    rig.number += 1;
    let request = CommandRequest {
        client: 9,
        number: rig.number,
        after: None,
        command: save_as(path, false),
    };
    let topic = rig.topics.command("paint");
    let reply: CommandReply = rig.ask(&topic, &request);
    assert_eq!(reply.outcome, Outcome::Waiting);
}

fn names(folder: &Path) -> Vec<std::ffi::OsString> {
    let entries = std::fs::read_dir(folder).expect("a folder");
    entries.flatten().map(|entry| entry.file_name()).collect()
}

#[test]
fn a_node_that_ends_as_it_saves_leaves_the_painting_under_its_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.maul");
    let mut rig = Rig::new();
    rig.fill("Yellow Ochre");
    begins_to_save(&mut rig, &path);
    rig.node.close().expect("closed");
    assert_eq!(kept(&path).1, 1);
    assert_eq!(names(folder.path()), ["a.maul"]);
}

#[test]
fn a_painting_that_is_refused_its_name_says_none_and_gets_another() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let mut rig = Rig::new();
    let topic = rig.topics.paint_status();
    let (wake, queue) = (Wake::new(), Queue::Ring(64));
    let mut statuses: Receiver<PaintStatus> =
        Receiver::new(&rig.client, &topic, Qos::Background, queue, &wake).expect("one");
    rig.fill("Yellow Ochre");
    begins_to_save(&mut rig, &at("a.maul"));
    std::fs::write(at("a.maul"), "a shopping list").expect("written");
    while rig.node.files.home().is_moving() {
        rig.turn();
    }
    let unnamed = rig.node.document_path().map(Path::to_owned);
    assert_eq!(unnamed, Some(maulstick_document::unfinished(&at("a.maul"))));
    rig.fill("Bone Black");
    let last = |rig: &mut Rig, statuses: &mut Receiver<PaintStatus>| {
        for _ in 0..200 {
            rig.turn();
        }
        std::iter::from_fn(|| statuses.try_recv())
            .last()
            .expect("a status")
            .message
    };
    let told = last(&mut rig, &mut statuses);
    assert!(told.path.is_empty() && !told.all_committed, "{told:?}");
    rig.done(save_as(&at("b.maul"), false));
    let told = last(&mut rig, &mut statuses);
    assert!(told.path.ends_with("/b.maul"), "{told:?}");
    rig.node.close().expect("closed");
    assert_eq!(kept(&at("b.maul")).1, 2);
    let mut names = names(folder.path());
    names.sort();
    assert_eq!(names, ["a.maul", "b.maul"]);
    assert_eq!(
        std::fs::read(at("a.maul")).expect("there"),
        b"a shopping list"
    );
}

#[test]
fn small_pictures_of_steps_show_the_painting_after_each() {
    let mut rig = Rig::new();
    let mut shown = vec![(0, rig.thumbnail("", 48))];
    for paint in ["Titanium White", "Yellow Ochre", "Bone Black"] {
        rig.fill(paint);
        let steps = rig.node.sequencer.painting().history().around(30);
        assert!(steps[0].done && steps[0].what == StepName::Fill);
        shown.push((steps[0].id, rig.thumbnail("", 48)));
    }
    let after = |rig: &mut Rig, step: u64| -> ThumbnailReply {
        let topic = rig.topics.thumbnail();
        let request = ThumbnailRequest {
            version: String::new(),
            side: 48,
            step: Some(step),
        };
        rig.ask(&topic, &request)
    };
    let far = |one: &ThumbnailReply, other: &ThumbnailReply| {
        let bytes = one.rgb.iter().zip(other.rgb.iter());
        bytes.map(|(one, other)| one.abs_diff(*other)).max()
    };
    for (step, picture) in &shown {
        let drawn = after(&mut rig, *step);
        assert_eq!((drawn.width, drawn.height), (48, 32));
        assert!(far(&drawn, picture) <= Some(1), "step {step}");
    }
    assert!(
        far(&shown[2].1, &shown[3].1) > Some(20),
        "a fault would pass"
    );
    assert_eq!(after(&mut rig, 999).width, 0);
}
