//! A program kept alive: rows to its standard input, replies from its standard output, each on a thread of its own, so
//! that neither side blocks the other with a full pipe. Standard error is passed on as messages, with the last line kept
//! for reasons of failure.

use std::io::{self, Read, Write};
use std::process::{ChildStdout, ExitStatus, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender, SyncSender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use apportion::model::Messages;
use apportion_base::text::cut;

use super::program::{Program, Running};

/// An event of a process.
pub(super) enum Event {
    /// Bytes of its standard output.
    Output(Vec<u8>),
    /// A text has been written to it.
    Sent,
    /// Its standard output is closed.
    Closed,
}

/// How a process ended.
pub(super) struct Ending {
    /// Its exit status, if there is one.
    pub status: Option<ExitStatus>,
    /// Whether it ended by itself.
    pub by_itself: bool,
    /// The last line that it wrote to standard error.
    pub last_words: String,
}

/// A process that is kept alive. When dropped, its input is closed and it has a moment to end by itself.
pub(super) struct Process {
    running: Running,
    input: Option<Sender<String>>,
    events: Receiver<Event>,
    last_words: Arc<Mutex<String>>,
    stderr_closed: Receiver<()>,
    /// Keeps the thread that started the process alive.
    keeper: Option<Sender<()>>,
}

/// Maximum number of texts waiting to be written and of output blocks waiting to be read; it bounds the memory.
pub(super) const IN_TRANSIT: usize = 4;
/// Number of bytes read at once.
const BLOCK: usize = 1 << 16;
/// Time for a process to end after the end of its input.
pub(super) const PATIENCE: Duration = Duration::from_secs(1);

impl Process {
    pub(super) fn start(program: &Program, messages: &Messages) -> io::Result<Self> {
        let mut command = program.command(&program.directory);
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let (input, texts) = mpsc::channel::<String>();
        let (keeper, kept) = mpsc::channel::<()>();
        let (sender, events) = mpsc::sync_channel(IN_TRANSIT * 2);
        let (started, start) = mpsc::channel();
        let writer_sender = sender.clone();
        // This thread starts the process, since on Linux the process ends with the thread.
        thread::Builder::new().spawn(move || {
            let mut child = match command.spawn() {
                Ok(child) => child,
                Err(error) => return drop(started.send(Err(error))),
            };
            let stdin = child.stdin.take();
            if started.send(Ok(child)).is_ok() {
                if let Some(stdin) = stdin {
                    write_all(stdin, &texts, &writer_sender);
                }
                // Nothing is ever sent: the receiver notices that the sender is dropped.
                let _ = kept.recv();
            }
        })?;
        let mut child = start.recv().map_err(|_| io::Error::other("the thread that starts it has ended"))??;
        let (stdout, stderr) = (child.stdout.take(), child.stderr.take());
        let (stderr_open, stderr_closed) = mpsc::channel();
        let last_words = Arc::new(Mutex::new(String::new()));
        let process = Self {
            running: Running::new(child),
            input: Some(input),
            events,
            last_words,
            stderr_closed,
            keeper: Some(keeper),
        };
        if let Some(stdout) = stdout {
            thread::Builder::new().spawn(move || read_all(stdout, &sender))?;
        }
        if let Some(stderr) = stderr {
            let (messages, last) = (messages.clone(), Arc::clone(&process.last_words));
            thread::Builder::new().spawn(move || {
                listen(&messages, stderr, &last);
                drop(stderr_open);
            })?;
        }
        Ok(process)
    }

    /// Closes its input after the texts that have been queued.
    pub(super) fn close_input(&mut self) {
        self.input = None;
    }

    /// Ends the processes it has left behind if it has ended by itself, and returns whether it has: these may hold its
    /// output open.
    pub(super) fn clear_away(&mut self) -> bool {
        self.running.has_ended().then(|| self.running.end()).is_some()
    }

    /// Queues a text to be written; [`Event::Sent`] follows.
    pub(super) fn send(&self, text: String) {
        // An error shows as the end of the replies.
        let _ = self.input.as_ref().map(|input| input.send(text));
    }

    /// Returns the next event, if it comes within `timeout`.
    pub(super) fn event(&self, timeout: Duration) -> Option<Event> {
        match self.events.recv_timeout(timeout) {
            Ok(event) => Some(event),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => Some(Event::Closed),
        }
    }

    /// Ends the process, after a moment to end by itself if its output is `closed` already.
    pub(super) fn end(&mut self, closed: bool) -> Ending {
        let by_itself = closed && self.running.ends_within(PATIENCE);
        let status = self.running.end();
        self.keeper = None;
        // Everything that it printed comes before this, unless a process outside its group still holds the pipe.
        let _ = self.stderr_closed.recv_timeout(Duration::from_millis(300));
        let last_words = self.last_words.lock().unwrap_or_else(PoisonError::into_inner).clone();
        Ending { status, by_itself, last_words }
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        self.input = None;
        // Later events are dropped.
        self.events = mpsc::sync_channel(0).1;
        self.running.ends_within(PATIENCE);
        self.running.end();
        self.keeper = None;
    }
}

fn write_all(mut stdin: impl Write, texts: &Receiver<String>, sender: &SyncSender<Event>) {
    let mut open = true;
    for text in texts {
        // A process that reads no more may still reply to what it has read.
        open = open && stdin.write_all(text.as_bytes()).and_then(|()| stdin.flush()).is_ok();
        if open && sender.send(Event::Sent).is_err() {
            open = false;
        }
    }
}

fn read_all(mut stdout: ChildStdout, sender: &SyncSender<Event>) {
    let mut is_read = true;
    loop {
        let mut bytes = vec![0; BLOCK];
        match stdout.read(&mut bytes) {
            Ok(0) => break,
            Ok(count) => {
                bytes.truncate(count);
                // Output after the last row is dropped, but the process must not wait for it to be read.
                is_read = is_read && sender.send(Event::Output(bytes)).is_ok();
            }
            Err(error) if error.kind() == io::ErrorKind::Interrupted => (),
            Err(_) => break,
        }
    }
    if is_read {
        let _ = sender.send(Event::Closed);
    }
}

/// Maximum number of characters of a line that are passed on.
const MAX_LETTERS: usize = 400;

/// Passes on the standard error of a process until it ends, and stores its last line in `last`.
pub(super) fn listen(messages: &Messages, mut from: impl Read, last: &Mutex<String>) {
    const LONGEST: usize = 4096;
    let (mut line, mut bytes) = (Vec::new(), [0; 4096]);
    loop {
        let count = match from.read(&mut bytes) {
            Ok(count) => count,
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => continue,
            Err(_) => 0,
        };
        for &byte in &bytes[..count] {
            match byte {
                b'\n' => take_line(messages, &mut line, last),
                _ if line.len() < LONGEST => line.push(byte),
                // The rest of a long line is dropped.
                _ => (),
            }
        }
        if count == 0 {
            return take_line(messages, &mut line, last);
        }
    }
}

fn take_line(messages: &Messages, line: &mut Vec<u8>, last: &Mutex<String>) {
    let text = String::from_utf8_lossy(line).into_owned();
    line.clear();
    if !text.trim().is_empty() {
        messages.send_printed(&format!("the program: {}", cut(&text, MAX_LETTERS)));
        text.trim().clone_into(&mut last.lock().unwrap_or_else(PoisonError::into_inner));
    }
}
