//! The user's program as a child process: started without a shell, ended with all processes it started.

use std::collections::BTreeSet;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use apportion_base::text::masked;

/// A program with its arguments.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Program {
    /// The program and its arguments, not interpreted by a shell. A relative path with a slash is relative to
    /// `directory`; a name without one is searched for in PATH.
    pub arguments: Vec<String>,
    /// The working directory, an absolute path.
    pub directory: PathBuf,
    /// Environment variables that are set for it.
    pub environment: Vec<(String, String)>,
}

impl Program {
    fn name(&self) -> &str {
        self.arguments.first().map_or("", String::as_str)
    }

    /// Returns the program's file, unless it is searched for in PATH.
    pub(super) fn file(&self) -> Option<PathBuf> {
        let is_path = Path::new(self.name()).components().count() > 1 || self.name().starts_with('.');
        is_path.then(|| self.directory.join(self.name()))
    }

    /// Builds a command in a new process group, in `directory`.
    pub(super) fn command(&self, directory: &Path) -> Command {
        let mut command = Command::new(self.file().unwrap_or_else(|| self.name().into()));
        command.args(self.arguments.iter().skip(1)).current_dir(directory);
        command.envs(self.environment.iter().map(|(name, value)| (name, value)));
        isolate(&mut command);
        command
    }

    /// Explains why it cannot be started, and what to do.
    pub(super) fn refusal(&self, error: &io::Error) -> String {
        let name = self.name();
        let help = match error.kind() {
            io::ErrorKind::NotFound if !self.directory.is_dir() => {
                format!("there is no directory {}", self.directory.display())
            }
            io::ErrorKind::NotFound if self.file().is_none() => {
                "is it installed, and in PATH? (a program in the folder of the study is named with a slash, as in \"./model\")"
                    .to_owned()
            }
            io::ErrorKind::NotFound => {
                format!("a path with a slash is relative to {}", self.directory.display())
            }
            io::ErrorKind::PermissionDenied => {
                "make it executable, or name its interpreter first, as in [\"python3\", \"my_model.py\"]".to_owned()
            }
            _ if error.to_string().contains("format") => {
                "begin it with a line such as #!/bin/sh, or name its interpreter first".to_owned()
            }
            _ => too_many_files(error).unwrap_or("try it by hand, and with fewer `workers`").to_owned(),
        };
        format!("cannot start the program `{name}`: {error}; {help}")
    }
}

/// Returns what to do, if the process has as many open files as it may have.
pub(super) fn too_many_files(error: &io::Error) -> Option<&'static str> {
    const EMFILE: i32 = 24;
    let advice = "allow more open files (`ulimit -n 4096`), or use fewer `workers`: each keeps several open";
    (cfg!(unix) && error.raw_os_error() == Some(EMFILE)).then_some(advice)
}

/// Returns the existing files among the program and its arguments, without the files that the program reads or imports.
pub(crate) fn program_files(program: &Program) -> Vec<PathBuf> {
    let arguments = program.arguments.iter().enumerate();
    // A program without a slash is searched for in PATH.
    let arguments = arguments.filter(|(place, _)| *place > 0 || program.file().is_some());
    let paths = arguments.map(|(_, argument)| program.directory.join(argument).components().collect::<PathBuf>());
    let mut files: Vec<PathBuf> = paths.filter(|path| path.is_file()).collect();
    files.dedup();
    files
}

/// Gives the child a process group, so that it can be ended with all its children; on Linux the system also ends it
/// when the thread that started it ends, for example because the engine is killed.
#[cfg(unix)]
fn isolate(command: &mut Command) {
    use std::os::unix::process::CommandExt;
    command.process_group(0);
    // SAFETY: between fork and exec the function makes one system call and neither allocates nor locks.
    #[allow(unsafe_code)]
    unsafe {
        command.pre_exec(reset_sigxfsz);
    }
    #[cfg(target_os = "linux")]
    {
        let parent = rustix::process::getpid();
        // SAFETY: between fork and exec the closure makes two system calls and neither allocates nor locks.
        #[allow(unsafe_code)]
        unsafe {
            command.pre_exec(move || end_with(parent));
        }
    }
}

/// Restores the default action of a signal that the engine ignores, and a child would too: a program that exceeds its
/// limit of file sizes ends.
#[cfg(unix)]
fn reset_sigxfsz() -> io::Result<()> {
    // SAFETY: no handler is installed.
    #[allow(unsafe_code)]
    unsafe {
        libc::signal(libc::SIGXFSZ, libc::SIG_DFL);
    }
    Ok(())
}

/// Makes the system end this process when the thread that started it ends.
#[cfg(target_os = "linux")]
fn end_with(parent: rustix::process::Pid) -> io::Result<()> {
    rustix::process::set_parent_process_death_signal(Some(rustix::process::Signal::KILL))?;
    // The engine may have ended in between.
    if rustix::process::getppid() == Some(parent) { Ok(()) } else { Err(io::ErrorKind::Interrupted.into()) }
}

#[cfg(not(unix))]
fn isolate(_: &mut Command) {}

/// A child process that is waited for once.
pub(super) struct Running {
    child: Child,
    /// How it ended, once it has been waited for: its process number may then be reused.
    ended: Option<Option<ExitStatus>>,
}

/// The programs that have not been waited for: their numbers are not reused.
static RUNNING: Mutex<BTreeSet<u32>> = Mutex::new(BTreeSet::new());

/// Ends all programs of this process with all processes that they started, for a caller that is about to exit: only
/// the programs themselves end with it.
pub fn end_all_programs() {
    #[cfg(unix)]
    for number in RUNNING.lock().unwrap_or_else(PoisonError::into_inner).iter() {
        if let Some(group) = rustix::process::Pid::from_raw(number.cast_signed()) {
            let _ = rustix::process::kill_process_group(group, rustix::process::Signal::KILL);
        }
    }
}

impl Running {
    pub(super) fn new(child: Child) -> Self {
        RUNNING.lock().unwrap_or_else(PoisonError::into_inner).insert(child.id());
        Self { child, ended: None }
    }

    /// Returns whether the program itself has ended, without waiting for it, so that its number and group are not
    /// reused.
    #[cfg(unix)]
    pub(super) fn has_ended(&mut self) -> bool {
        use rustix::process::{Pid, WaitId, WaitIdOptions, waitid};
        if self.ended.is_some() {
            return true;
        }
        let options = WaitIdOptions::EXITED | WaitIdOptions::NOHANG | WaitIdOptions::NOWAIT;
        // An error: the child does not exist any more.
        waitid(WaitId::Pid(Pid::from_child(&self.child)), options).map_or(true, |status| status.is_some())
    }

    #[cfg(not(unix))]
    pub(super) fn has_ended(&mut self) -> bool {
        self.ended.is_some() || !matches!(self.child.try_wait(), Ok(None))
    }

    /// Waits at most `timeout` until it has ended by itself, and returns whether it has.
    pub(super) fn ends_within(&mut self, timeout: Duration) -> bool {
        let (start, mut pause) = (Instant::now(), Duration::from_micros(200));
        while !self.has_ended() {
            if start.elapsed() >= timeout {
                return false;
            }
            std::thread::sleep(pause);
            pause = (pause * 2).min(Duration::from_millis(20));
        }
        true
    }

    /// Ends it and its group, if they have not ended, and returns how the program itself ended.
    pub(super) fn end(&mut self) -> Option<ExitStatus> {
        if let Some(status) = self.ended {
            return status;
        }
        #[cfg(unix)]
        {
            use rustix::process::{Pid, Signal, kill_process_group};
            // Fails if no process of the group is left.
            let _ = kill_process_group(Pid::from_child(&self.child), Signal::KILL);
        }
        #[cfg(not(unix))]
        let _ = self.child.kill();
        RUNNING.lock().unwrap_or_else(PoisonError::into_inner).remove(&self.child.id());
        let status = self.child.wait().ok();
        self.ended = Some(status);
        status
    }
}

/// Says how a program ended, with the last line of its standard error.
pub(super) fn ended_in_words(status: Option<ExitStatus>, last_words: &str) -> String {
    // Such as "exit status: 1" or "signal: 11 (SIGSEGV) (core dumped)".
    let status = status.map_or_else(|| "an unknown exit status".to_owned(), |status| status.to_string());
    let status = status.replacen(": ", " ", 1).replace(" (core dumped)", "");
    let last = masked(last_words);
    let last = if last.is_empty() { last } else { format!(": {last}") };
    format!("the program ended with {status}{last}")
}
