//! Stop flag of a process: a signal, or the launcher's end.

use std::io::Read as _;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicI32, Ordering};
use std::time::Duration;

use maulstick_bus::Wake;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::iterator::Signals;

/// Stop flag of this process.
#[derive(Clone, Debug, Default)]
pub struct Stop {
    flag: Arc<AtomicBool>,
    /// The signal that requested it, 0 without one.
    signal: Arc<AtomicI32>,
}

impl Stop {
    /// Watches for SIGTERM, SIGINT and SIGHUP (the terminal is closed), and rings `wake` when they come.
    ///
    /// # Errors
    /// The system's error if signals cannot be watched.
    pub fn on_signals(wake: &Wake) -> std::io::Result<Self> {
        let stop = Self::default();
        let mut signals = Signals::new([SIGTERM, SIGINT, SIGHUP])?;
        let (flag, signal, wake) = (
            Arc::clone(&stop.flag),
            Arc::clone(&stop.signal),
            wake.clone(),
        );
        std::thread::Builder::new()
            .name("signals".into())
            .spawn(move || {
                for number in signals.forever() {
                    signal.store(number, Ordering::SeqCst);
                    flag.store(true, Ordering::SeqCst);
                    wake.ring();
                }
            })?;
        Ok(stop)
    }

    /// Also stops when the standard input ends, which the launcher holds open: so a node follows its launcher even if
    /// that was killed. Should the node not stop in time, it is ended.
    ///
    /// # Errors
    /// The system's error if no thread can be started.
    pub fn on_launcher_end(&self, wake: &Wake) -> std::io::Result<()> {
        let (flag, wake) = (Arc::clone(&self.flag), wake.clone());
        std::thread::Builder::new()
            .name("launcher".into())
            .spawn(move || {
                let mut byte = [0];
                while matches!(std::io::stdin().read(&mut byte), Ok(n) if n > 0) {}
                flag.store(true, Ordering::SeqCst);
                wake.ring();
                std::thread::sleep(Duration::from_millis(1500));
                std::process::exit(crate::user_error::EXIT_FAILURE);
            })?;
        Ok(())
    }

    /// Asks to stop.
    pub fn request(&self) {
        self.flag.store(true, Ordering::SeqCst);
    }

    /// True once the process is to stop.
    #[must_use]
    pub fn requested(&self) -> bool {
        self.flag.load(Ordering::SeqCst)
    }

    /// True if a signal requested the stop.
    #[must_use]
    pub fn by_signal(&self) -> bool {
        self.signal.load(Ordering::SeqCst) != 0
    }

    /// The exit code after a stop: `interrupted` after Ctrl-C, 128 and its number after another signal, else 0.
    #[must_use]
    pub fn exit_code(&self, interrupted: i32) -> i32 {
        match self.signal.load(Ordering::SeqCst) {
            0 => 0,
            SIGINT => interrupted,
            other => 128 + other,
        }
    }
}
