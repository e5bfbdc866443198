//! A take that is played from its start to its picture, whichever process dies meanwhile.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, mpsc};
use std::time::Duration;

use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus, BusError, Qos, Queue, Wake};
use maulstick_device::player::Rate;
use maulstick_rig::UserError;
use maulstick_rig::command_client::CommandClient;
use maulstick_rig::config::RigConfig;
use maulstick_types::command::TakeCommand;
use maulstick_types::stylus::{TakeEnd, TakeStatus};
use maulstick_types::wire::topics::Topics;
use tokio::task::spawn_blocking;

use maulstick_painting_setup::outputs::Relayed;

use crate::processes::{PLAYER, Program};
use crate::up::plan::{NodeSpec, Role, node};

/// A take to play, and its output.
#[derive(Clone, Debug)]
pub struct Performance {
    /// The take.
    pub take: PathBuf,
    /// Playback rate.
    pub rate: Rate,
    /// The brush that follows it.
    pub brush: String,
    /// Loads of the strokes, in turn.
    pub loads: Vec<String>,
    /// The picture to write at its end.
    pub snapshot: Option<Relayed>,
    /// The ledger to write at its end.
    pub ledger: Option<Relayed>,
    /// Length of the take, ns.
    pub length_ns: u64,
}

/// Follows a take being played.
#[derive(Debug)]
pub struct Conductor {
    /// The performance.
    pub performance: Performance,
    statuses: Receiver<TakeStatus>,
    wake: Wake,
    epoch: Option<u32>,
    forgotten: Option<u32>,
    /// True if the strokes of it that were painted are to be undone first.
    again: bool,
    position_ns: u64,
    end: Option<TakeEnd>,
    writing: Option<Writing>,
}

/// The picture being written: its outcome, and a flag for an abandoned wait.
#[derive(Debug)]
struct Writing {
    outcome: mpsc::Receiver<Result<(), UserError>>,
    given_up: Arc<AtomicBool>,
}

/// Longest wait until the picture is written.
const SNAPSHOT: Duration = Duration::from_secs(300);

impl Conductor {
    /// Listens to the player.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub fn new(
        bus: &dyn Bus,
        topics: &Topics,
        performance: Performance,
        wake: &Wake,
    ) -> Result<Self, BusError> {
        let topic = topics.take_status(PLAYER);
        let statuses = Receiver::new(bus, &topic, Qos::Background, Queue::Ring(64), wake)?;
        Ok(Self {
            performance,
            statuses,
            wake: wake.clone(),
            epoch: None,
            forgotten: None,
            again: false,
            position_ns: 0,
            end: None,
            writing: None,
        })
    }

    /// The player's process; it plays as fast as it can up to where the take has been before.
    #[must_use]
    pub fn player(&self, config: &RigConfig) -> NodeSpec {
        let performance = &self.performance;
        let mut args = vec![
            "--take".to_owned(),
            performance.take.display().to_string(),
            "--rate".to_owned(),
            performance.rate.to_string(),
            "--brush".to_owned(),
            performance.brush.clone(),
            "--resume-ns".to_owned(),
            self.position_ns.to_string(),
            "--stay".to_owned(),
        ];
        if self.again {
            args.push("--again".to_owned());
        }
        for load in &performance.loads {
            args.extend(["--load".to_owned(), load.clone()]);
        }
        node(config, PLAYER, Role::Player, Program::Player, args)
    }

    /// Updates the player's progress; returns its position in the take, ns.
    pub fn follow(&mut self) -> u64 {
        while let Some(status) = self.statuses.try_recv() {
            let told = status.message;
            if Some(told.epoch) == self.forgotten {
                continue;
            }
            self.epoch = Some(told.epoch);
            self.position_ns = self.position_ns.max(told.position_ns);
            self.end = told.end;
        }
        self.position_ns
    }

    /// Resets the progress, because the take is played again.
    pub fn begin_again(&mut self) {
        self.follow();
        self.again = true;
        // A second fault may come before the player that was started after the first says anything.
        self.forgotten = self.epoch.take().or(self.forgotten);
        self.end = None;
        if let Some(writing) = self.writing.take() {
            writing.given_up.store(true, Ordering::SeqCst);
        }
    }

    /// Writes the picture once paint has consumed the end of the take; true when it is written.
    ///
    /// # Errors
    /// A [`UserError`] where it cannot be written.
    pub fn snapshot(&mut self, bus: &Arc<dyn Bus>, topics: &Topics) -> Result<bool, UserError> {
        let Some(end) = &self.end else {
            return Ok(false);
        };
        if let Some(writing) = &self.writing {
            return match writing.outcome.try_recv() {
                Ok(outcome) => {
                    outcome?;
                    let Performance {
                        snapshot, ledger, ..
                    } = &self.performance;
                    for written in snapshot.iter().chain(ledger) {
                        written.arrive("")?;
                    }
                    Ok(true)
                }
                Err(_) => Ok(false),
            };
        }
        let command = match &self.performance.snapshot {
            Some(picture) => TakeCommand::Snapshot {
                path: picture.asked()?,
                ledger: self
                    .performance
                    .ledger
                    .as_ref()
                    .map(Relayed::asked)
                    .transpose()?,
            },
            None => TakeCommand::Mark,
        };
        let (to_conductor, outcome) = mpsc::channel();
        let given_up = Arc::new(AtomicBool::new(false));
        let stop = Arc::clone(&given_up);
        let mut commander = CommandClient::new(Arc::clone(bus), topics);
        let after = Some(end.after.clone());
        let wake = self.wake.clone();
        spawn_blocking(move || {
            let stop = || stop.load(Ordering::SeqCst);
            let sent = commander.send(command, after, SNAPSHOT, &stop);
            to_conductor.send(sent.map(drop)).ok();
            wake.ring();
        });
        self.writing = Some(Writing { outcome, given_up });
        Ok(false)
    }
}
