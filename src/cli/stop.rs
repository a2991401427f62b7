//! Ctrl-C and its relatives: a run ends in order, with what it has.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

static STOP: AtomicBool = AtomicBool::new(false);

/// The flag that Ctrl-C, SIGTERM and SIGHUP set from now on. The second of them ends the program at once.
pub fn on_signal() -> &'static AtomicBool {
    static INSTALLED: OnceLock<()> = OnceLock::new();
    INSTALLED.get_or_init(|| {
        let handler = || {
            if STOP.swap(true, Ordering::Relaxed) {
                std::process::exit(1);
            }
            super::say("stopping: what is under way is brought to an end (once more ends the program at once)");
        };
        if let Err(error) = ctrlc::set_handler(handler) {
            super::say(&format!("warning: Ctrl-C will end the program at once: {error}"));
        }
    });
    &STOP
}
