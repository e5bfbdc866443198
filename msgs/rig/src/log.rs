//! The log of a process: one line an event, whatever the texts in it hold.

use std::fmt::{self, Debug};
use std::io::IsTerminal as _;

use maulstick_bus::reason::reason;
use maulstick_types::plain;
use tracing::field::Field;
use tracing_subscriber::EnvFilter;
use tracing_subscriber::field::MakeExt as _;
use tracing_subscriber::fmt::format::{FormatFields, Writer, debug_fn};
use tracing_subscriber::fmt::{MakeWriter, SubscriberBuilder};

/// Sends log lines of `level` and above to the standard error; of the libraries only what a painter
/// can do something about.
pub fn log_to_stderr(level: &str) {
    let quiet = "zenoh=error,zenoh::api::session=off,zenoh_transport=off,zenoh_shm=off,zenoh_link=off,\
                 wgpu=error,wgpu_core=error,wgpu_hal=error,winit=error,egui_winit=error,egui_wgpu=error,eframe=error,naga=error";
    lines(std::io::stderr, std::io::stderr().is_terminal())
        .with_env_filter(EnvFilter::new(format!("{quiet},{level}")))
        .try_init()
        .ok();
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
        "message" => write!(to, "{}", plain(&reason(text))),
        name => write!(to, "{name}={}", plain(&text)),
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;
    use std::sync::{Arc, Mutex, PoisonError};

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
}
