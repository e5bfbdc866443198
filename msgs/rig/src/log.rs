//! Output of a process: its log, one line an event, whatever the texts in it hold, and its prints. Nobody waits until
//! the log is read, nor for what is printed where that was asked for.

mod lossy_writer;

use std::any::Any;
use std::fmt::{self, Debug};
use std::fs::File;
use std::io::{self, ErrorKind, IsTerminal as _, Write};
use std::os::fd::AsFd;
use std::panic::PanicHookInfo;
use std::sync::OnceLock;
use std::time::Duration;

use maulstick_bus::reason;
use maulstick_types::plain;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use tracing::field::Field;
use tracing_subscriber::EnvFilter;
use tracing_subscriber::field::MakeExt as _;
use tracing_subscriber::fmt::format::{FormatFields, Writer, debug_fn};
use tracing_subscriber::fmt::{MakeWriter, SubscriberBuilder};

use lossy_writer::LossyWriter;

/// Time that the last lines of a process have; a node has not much more to end in.
const LAST_WORDS: Duration = Duration::from_millis(200);

/// Time that they have on a busy machine, while the standard error is read.
const BUSY: Duration = Duration::from_secs(2);

/// The log of this process, if it has one.
static LOG: OnceLock<LossyWriter> = OnceLock::new();

/// The standard output of this process, once a thread of its own writes to it.
static OUTPUT: OnceLock<LossyWriter> = OnceLock::new();

/// Sends log lines of `level` and above to the standard error, by a thread of their own; of the libraries only what a
/// painter can do something about. Panics are said there, too.
pub fn log_to_stderr(level: &str) {
    let quiet = "zenoh=error,zenoh::api::session=off,zenoh_transport=off,zenoh_shm=off,zenoh_link=off,\
                 wgpu=error,wgpu_core=error,wgpu_hal=error,winit=error,egui_winit=error,egui_wgpu=error,eframe=error,naga=error";
    let Ok(log) = own_stderr().and_then(LossyWriter::start) else {
        return;
    };
    let log = LOG.get_or_init(|| log);
    lines(log.clone(), io::stderr().is_terminal())
        .with_env_filter(EnvFilter::new(format!("{quiet},{level}")))
        .try_init()
        .ok();
    if std::env::var_os("RUST_BACKTRACE").is_none_or(|asked| asked == "0") {
        std::panic::set_hook(Box::new(say_panic));
    }
}

/// Says text that ends lines, beside the log lines; where this process has no log, on the standard error.
pub fn say(text: &str) {
    match LOG.get() {
        Some(log) => log.push(text.as_bytes()),
        None => io::stderr().write_all(text.as_bytes()).unwrap_or_default(),
    }
}

/// Has the standard output written by a thread of its own, for a command that must not wait for its terminal.
pub fn print_beside() {
    if let Ok(output) = LossyWriter::start(io::stdout()) {
        OUTPUT.set(output).ok();
    }
}

/// Prints text on the standard output, and waits until it is taken, except after [`print_beside`].
///
/// # Errors
/// The system's, where it waits.
pub fn print(text: &str) -> io::Result<()> {
    if let Some(output) = OUTPUT.get() {
        output.push(text.as_bytes());
        return Ok(());
    }
    let mut output = io::stdout().lock();
    output.write_all(text.as_bytes())?;
    output.flush()
}

/// Shows a passing display on the standard error, unless something waits to be said.
pub fn show(display: &str) {
    if let Some(log) = LOG.get() {
        log.show(display.as_bytes());
    }
}

/// Gives what was said and printed a short time to be written: for a process that ends.
pub fn flush() {
    if let Some(log) = LOG.get() {
        last_words(log, &io::stderr());
    }
    if let Some(output) = OUTPUT.get() {
        last_words(output, &io::stdout());
    }
}

fn last_words(lines: &LossyWriter, to: &impl AsFd) {
    if !lines.flush_within(LAST_WORDS) && has_room(to) {
        lines.flush_within(BUSY);
    }
}

/// True if bytes could be written at once: a terminal that stands still, or a full pipe, has no room.
fn has_room(to: &impl AsFd) -> bool {
    let mut ready = [PollFd::new(to.as_fd(), PollFlags::POLLOUT)];
    let polled = poll(&mut ready, PollTimeout::ZERO);
    let is_ready = |fd: &PollFd<'_>| {
        fd.revents()
            .is_some_and(|events| events.contains(PollFlags::POLLOUT))
    };
    polled.is_ok() && ready.iter().any(is_ready)
}

/// Says a panic as the standard library does, but waits for no reader, except a while in the thread that ends the process.
fn say_panic(panic: &PanicHookInfo<'_>) {
    let thread = std::thread::current();
    let name = thread.name().unwrap_or("<unnamed>");
    let place = panic.location().map_or_else(String::new, |at| {
        format!("{}:{}", reason::place(at.file()), at.line())
    });
    let what = reason::reason(words(panic.payload()));
    let what = plain(&what);
    say(&format!("thread '{name}' panicked at {place}: {what}\n"));
    if name == "main" {
        flush();
    }
}

/// Message of a panic; empty if it has none.
#[must_use]
pub fn words(payload: &(dyn Any + Send)) -> &str {
    match (
        payload.downcast_ref::<&str>(),
        payload.downcast_ref::<String>(),
    ) {
        (Some(words), _) => words,
        (None, Some(words)) => words,
        (None, None) => "",
    }
}

/// The standard error of this process, beside the one of the standard library: that is locked while it is written to.
fn own_stderr() -> io::Result<Stderr> {
    let stderr = io::stderr().as_fd().try_clone_to_owned()?;
    Ok(Stderr(stderr.into()))
}

/// Standard error that is waited for, even if another program has asked that nobody wait for it.
struct Stderr(File);

impl Write for Stderr {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        loop {
            match self.0.write(bytes) {
                Err(error) if error.kind() == ErrorKind::WouldBlock => {
                    let mut ready = [PollFd::new(self.0.as_fd(), PollFlags::POLLOUT)];
                    poll(&mut ready, PollTimeout::NONE)?;
                }
                written => return written,
            }
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Events as lines without time and place.
fn lines<W>(
    to: W,
    ansi: bool,
) -> SubscriberBuilder<
    impl for<'a> FormatFields<'a> + 'static,
    tracing_subscriber::fmt::format::Format<tracing_subscriber::fmt::format::Full, ()>,
    tracing_subscriber::filter::LevelFilter,
    W,
>
where
    W: for<'a> MakeWriter<'a> + 'static,
{
    tracing_subscriber::fmt()
        .with_writer(to)
        .with_ansi(ansi)
        .without_time()
        .with_target(false)
        .fmt_fields(debug_fn(write_field).delimited(" "))
}

fn write_field(to: &mut Writer<'_>, field: &Field, value: &dyn Debug) -> fmt::Result {
    let text = format!("{value:?}");
    match field.name() {
        "message" => write!(to, "{}", plain(&reason::reason(text))),
        name => write!(to, "{name}={}", plain(&text)),
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;
    use std::sync::{Arc, Mutex, PoisonError};

    use nix::fcntl::OFlag;

    use super::*;

    #[derive(Clone, Default)]
    struct Page(Arc<Mutex<Vec<u8>>>);

    impl Write for Page {
        fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
            let mut page = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            page.extend_from_slice(bytes);
            Ok(bytes.len())
        }

        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn no_text_forges_a_line() {
        let page = Page::default();
        let to = page.clone();
        let subscriber = lines(move || to.clone(), false).finish();
        tracing::subscriber::with_default(subscriber, || {
            let name = "x\n INFO the painting is saved\u{1b}[2J";
            tracing::warn!("{name}: is refused");
            tracing::warn!(name, "a field");
        });
        let page = page.0.lock().unwrap_or_else(PoisonError::into_inner);
        let said = String::from_utf8_lossy(&page).into_owned();
        assert_eq!(said.lines().count(), 2, "{said}");
        let first = " WARN x\\n INFO the painting is saved\\u{1b}[2J: is refused\n";
        assert!(said.starts_with(first), "{said}");
        assert!(!said.contains('\u{1b}'));
    }

    #[test]
    fn a_full_pipe_has_no_room() {
        let (_read, write) = nix::unistd::pipe2(OFlag::O_NONBLOCK).expect("a pipe");
        let write = File::from(write);
        assert!(has_room(&write));
        while (&write).write(&[b'.'; 512]).is_ok() {}
        assert!(!has_room(&write));
    }

    #[test]
    fn a_panic_is_said_whatever_it_holds() {
        let (text, string): (Box<dyn Any + Send>, Box<dyn Any + Send>) =
            (Box::new("a"), Box::new("b".to_owned()));
        assert_eq!([words(&*text), words(&*string), words(&1)], ["a", "b", ""]);
    }
}
