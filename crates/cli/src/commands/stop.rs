//! Ctrl-C and similar signals: a run stops in order and keeps its results.

use std::io::Write;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

static STOP: AtomicBool = AtomicBool::new(false);

/// The flag that Ctrl-C, SIGTERM and SIGHUP set from now on. The second of them ends the program at once.
pub fn on_signal() -> &'static AtomicBool {
    static INSTALLED: OnceLock<()> = OnceLock::new();
    INSTALLED.get_or_init(|| {
        let installed = ctrlc::set_handler(|| {
            if STOP.swap(true, Ordering::SeqCst) {
                apportion_files::end_all_programs();
                std::process::exit(1);
            }
            super::say("stopping after the runs in progress (press Ctrl-C again to stop at once)");
        });
        if let Err(error) = installed {
            super::say(&format!("warning: Ctrl-C will stop the program at once: {error}"));
        }
    });
    &STOP
}

/// Ignores signals: another process, which gets them too, stops this one.
#[cfg(feature = "mpi")]
pub fn leave_to_another() {
    if let Err(error) = ctrlc::set_handler(|| ()) {
        super::say(&format!("warning: Ctrl-C will stop this rank at once: {error}"));
    }
}

/// Lets a write beyond the limit of file sizes (`ulimit -f`) return an error: by default the system kills the program.
pub fn ignore_sigxfsz() {
    // SAFETY: no handler is installed; the call only changes the system's action on a signal.
    #[cfg(unix)]
    #[allow(unsafe_code)]
    unsafe {
        libc::signal(libc::SIGXFSZ, libc::SIG_IGN);
    }
}

/// A file being written, which takes nothing more once the program is to end: its temporary file is then removed.
pub struct Stoppable<'a> {
    out: &'a mut (dyn Write + Send),
    stop: &'static AtomicBool,
}

impl<'a> Stoppable<'a> {
    /// Writes to `out` until a signal comes.
    pub fn new(out: &'a mut (dyn Write + Send)) -> Self {
        Self { out, stop: on_signal() }
    }
}

impl Write for Stoppable<'_> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        if self.stop.load(Ordering::Relaxed) {
            return Err(std::io::Error::other("interrupted"));
        }
        self.out.write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.out.flush()
    }
}
