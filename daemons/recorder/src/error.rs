//! Errors of recorder and player, and their words for a user.

use std::path::{Path, PathBuf};

use maulstick_bus::BusError;
use maulstick_motion::MotionError;
use maulstick_rig::UserError;
use maulstick_session::recorded::SessionFault;
use maulstick_streams::translate::ReadError;
use maulstick_types::DecodeError;

/// Reason why a rig could not be recorded, or a recording not be played.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RecorderError {
    /// An error of a file, a take, or a node of the rig.
    #[error("{}", .0.what)]
    Fault(#[from] UserError),
    /// An error of the bus.
    #[error(transparent)]
    Bus(#[from] BusError),
    /// A message that is too long.
    #[error(transparent)]
    Encode(#[from] DecodeError),
    /// A task panicked.
    #[error("internal error: {0} panicked")]
    Panicked(&'static str),
    /// A pattern that is none.
    #[error("the topic '{0}' is malformed")]
    Pattern(String),
    /// The recording of a session lacks its painting.
    #[error("the recording lacks the painting as it was at its beginning")]
    NoPainting(PathBuf),
    /// The painting in a recording is damaged.
    #[error("the painting as it was at its beginning is damaged")]
    PaintingDamaged(PathBuf),
    /// A session that cannot be painted again, from a time on, ns.
    #[error("{}", session_words(.fault, *.at_ns))]
    Session {
        /// Reason.
        fault: SessionFault,
        /// Time since the beginning, ns.
        at_ns: u64,
        /// The recording.
        file: PathBuf,
    },
    /// The recording is damaged.
    #[error("the recording is damaged: {damage}")]
    Damaged {
        /// The damage.
        damage: String,
        /// The recording.
        file: PathBuf,
    },
    /// A recorded message that this version cannot read.
    #[error("{what}: {error}")]
    Unreadable {
        /// Topic, or kind of message.
        what: String,
        /// Error of the table or the codec.
        error: ReadError,
        /// The recording, where it is known.
        file: Option<PathBuf>,
    },
    /// A start behind the end.
    #[error("the start at {start} s is not before the end")]
    Start {
        /// The start, s.
        start: String,
        /// Length of the recording, s.
        length: String,
        /// The recording.
        file: PathBuf,
    },
    /// A recording without the topics that were asked for.
    #[error("it has no topic {}", .wanted.join(", "))]
    NoTopic {
        /// Patterns of these topics.
        wanted: Vec<String>,
        /// Topics that it has.
        known: Vec<String>,
        /// The recording.
        file: PathBuf,
    },
    /// Topics that move a hand, without a device that agreed to it.
    #[error("contact models and forces of paint move the hand that holds the device")]
    MovesHand,
    /// Contact models of several devices.
    #[error("it has the contact models of several devices, and one hand feels one")]
    SeveralDevices {
        /// One of the devices.
        device: String,
        /// The recording.
        file: PathBuf,
    },
    /// A device that is not in the rig.
    #[error("no device called '{0}' is in the rig")]
    NoDevice(String),
    /// A device that does not agree to be moved.
    #[error("'{device}' may not be moved: {error}")]
    NoConsent {
        /// The device.
        device: String,
        /// Topic of the question.
        topic: String,
        /// Error of the answer.
        error: BusError,
    },
    /// A brush that the rig does not have.
    #[error("the rig has no brush '{0}'")]
    NoBrush(String),
    /// A recording without a stroke that could guide.
    #[error("it has no stroke on the canvas")]
    NoStroke(PathBuf),
    /// A recording without a hand.
    #[error("it has no samples of a hand")]
    NoHand(PathBuf),
    /// A recording of several hands, of which one is to guide.
    #[error("it has the samples of several hands, and one guides")]
    SeveralHands {
        /// Topic of one of them.
        one: String,
        /// The recording.
        file: PathBuf,
    },
    /// A take that does not fit its place.
    #[error("{fault}")]
    Place {
        /// Reason.
        fault: MotionError,
        /// The take.
        file: PathBuf,
    },
    /// A name of a file that lies beside a painting.
    #[error("a file of this name may belong to a painting")]
    CompanionName(PathBuf),
    /// A painting that is not to be written over.
    #[error("this painting is there already")]
    Exists(PathBuf),
    /// The player reads from another place on.
    #[error("the player reads from another place")]
    ReadsAnew,
}

/// Words for a session's fault, with the time where it is within the recording.
fn session_words(fault: &SessionFault, at_ns: u64) -> String {
    if is_of_its_place(fault) {
        fault.to_string()
    } else {
        format!("at {:.1} s: {fault}", tenths_s(at_ns))
    }
}

/// True for a fault of where in its painting's journal a session begins or ends.
pub(crate) fn is_of_its_place(fault: &SessionFault) -> bool {
    matches!(
        fault,
        SessionFault::Before { .. } | SessionFault::Behind { .. }
    )
}

fn tenths_s(at_ns: u64) -> f64 {
    (at_ns / 100_000_000) as f64 * 0.1
}

/// Advice for a session's fault at a time since its beginning, ns.
fn session_help(fault: &SessionFault, at_ns: u64, file: &Path) -> String {
    if is_of_its_place(fault) {
        return "`maulstick snapshot` says at which place of the journal it was made".to_owned();
    }
    let tenth_ns = 100_000_000 * u64::from(at_ns.is_multiple_of(100_000_000));
    let end_s = tenths_s(at_ns.saturating_sub(tenth_ns));
    format!(
        "`maulstick take from {} --end {end_s:.1} -o TAKE` keeps what is before it",
        file.display()
    )
}

impl From<RecorderError> for UserError {
    fn from(error: RecorderError) -> Self {
        let usage = Self::usage(error.to_string());
        let at = |file: &Path| Self::usage(error.to_string()).at(file.display().to_string());
        let version = "play it with the version of Maulstick that recorded it: `maulstick recording info` names it";
        match &error {
            RecorderError::Fault(fault) => fault.clone(),
            RecorderError::Bus(error) => error.clone().into(),
            RecorderError::Encode(_) | RecorderError::Panicked(_) | RecorderError::ReadsAnew => {
                Self::failure(error.to_string())
            }
            RecorderError::Pattern(_) => usage.help(
                "a topic such as stylus/pen/sample, with * for any one part and ** for any number of them",
            ),
            RecorderError::NoPainting(file) => at(file)
                .help("record a painting that is in a file, such as `maulstick up sea.maul`"),
            RecorderError::PaintingDamaged(file) => {
                at(file).help("nothing can be painted again from this recording")
            }
            RecorderError::Session { fault, at_ns, file } => {
                at(file).help(session_help(fault, *at_ns, file))
            }
            RecorderError::Damaged { file, .. } => at(file),
            RecorderError::Unreadable { file: Some(file), .. } => at(file).help(version),
            RecorderError::Unreadable { file: None, .. } => usage.help(version),
            RecorderError::Start { length, file, .. } => {
                at(file).help(format!("it is {length} s long"))
            }
            RecorderError::NoTopic { known, file, .. } => {
                at(file).help(format!("it has {}", known.join(", ")))
            }
            RecorderError::MovesHand => {
                usage.help("name the device, with a hand at it that expects it: --drive DEVICE")
            }
            RecorderError::SeveralDevices { device, file } => {
                at(file).help(format!("choose one: --topic 'haptics/{device}/*'"))
            }
            RecorderError::NoDevice(_) => {
                usage.help("`maulstick device list` shows which are")
            }
            RecorderError::NoConsent { topic, .. } => Self::failure(error.to_string())
                .at(topic)
                .help("its daemon has to run, in the version of this program"),
            RecorderError::NoBrush(_) => usage,
            RecorderError::NoStroke(file) => at(file).help(
                "a stroke is longer than 2 mm; `maulstick recording info` shows what there is",
            ),
            RecorderError::NoHand(file) => at(file)
                .help("record a hand that paints: `maulstick recording record -o hand.mcap`"),
            RecorderError::SeveralHands { one, file } => {
                at(file).help(format!("choose one: --topic {one}"))
            }
            RecorderError::Place { fault, file } => at(file).help(fault.help()),
            RecorderError::CompanionName(file) => at(file).help("give the painting another name"),
            RecorderError::Exists(file) => at(file)
                .help("name one that is not: the session is painted there from its beginning"),
        }
    }
}
