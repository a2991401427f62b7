//! A run in a thread of its own, while the thread that started it answers calls, watches for signals and tells progress.

use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use apportion::Progress;
use pyo3::prelude::*;
use rayon::ThreadPoolBuilder;

use crate::errors::failed;
use crate::function::{Event, PythonModel, Stop};

/// How long signals and progress may wait.
const LOOK: Duration = Duration::from_millis(100);

/// What a run tells while it goes on.
#[derive(Default)]
pub struct ProgressState {
    progress: Mutex<Option<Progress>>,
    messages: Mutex<Vec<String>>,
}

impl ProgressState {
    pub fn progress(&self, progress: Progress) {
        *self.progress.lock().unwrap_or_else(PoisonError::into_inner) = Some(progress);
    }

    pub fn message(&self, line: &str) {
        self.messages.lock().unwrap_or_else(PoisonError::into_inner).push(line.to_owned());
    }

    /// Passes on what is new: `progress(done, total, failed, recalled)`, and `message(line)`.
    fn tell(&self, py: Python<'_>, listeners: &Listeners) -> PyResult<()> {
        let Listeners { progress, message } = listeners;
        let latest = self.progress.lock().unwrap_or_else(PoisonError::into_inner).take();
        if let Some((progress, latest)) = progress.as_ref().zip(latest) {
            progress.call1(py, (latest.done, latest.total, latest.failed, latest.recalled))?;
        }
        let lines = std::mem::take(&mut *self.messages.lock().unwrap_or_else(PoisonError::into_inner));
        if let Some(message) = message {
            lines.into_iter().try_for_each(|line| message.call1(py, (line,)).map(|_| ()))?;
        }
        Ok(())
    }
}

/// Who listens.
#[derive(Default)]
pub struct Listeners {
    pub progress: Option<Py<PyAny>>,
    pub message: Option<Py<PyAny>>,
}

/// What there is to do in the thread that started a run.
pub struct Duty {
    pub events: Receiver<Event>,
    /// Where the end of the run is told.
    pub finished: Sender<Event>,
    /// What answers requests.
    pub model: Option<Arc<PythonModel>>,
    pub stop: Stop,
}

/// Tells of the end, whatever it is.
struct End(Sender<Event>);

impl Drop for End {
    fn drop(&mut self) {
        drop(self.0.send(Event::Finished));
    }
}

/// What `work` returns, done in a pool of its own: one that is shared waits for ever in a run whose function starts a run.
fn in_own_pool<R: Send>(work: impl FnOnce() -> R + Send) -> PyResult<R> {
    ThreadPoolBuilder::new().build().map(|pool| pool.install(work)).map_err(failed)
}

/// What `work` returns, done in a thread of its own, while `duty` is done in this one. The first error of Python ends the run
/// and is returned, an interruption among them.
pub fn attend<R: Send>(
    py: Python<'_>,
    duty: Duty,
    told: &ProgressState,
    listeners: &Listeners,
    work: impl FnOnce() -> R + Send,
) -> PyResult<R> {
    let (done, error) = py.detach(|| {
        let Duty { events, finished, model, stop } = duty;
        std::thread::scope(|scope| {
            let handle = scope.spawn(move || {
                let _end = End(finished);
                in_own_pool(work)
            });
            let mut error = None;
            let mut fail = |outcome: PyResult<()>, stop: &Stop| {
                if let Err(new) = outcome {
                    stop.set();
                    error.get_or_insert(new);
                }
            };
            let mut looked = Instant::now();
            loop {
                match events.recv_timeout(LOOK) {
                    Ok(Event::Request(request)) => match &model {
                        Some(model) if !stop.is_set() => fail(Python::attach(|py| model.serve(py, request)), &stop),
                        _ => request.refuse(),
                    },
                    Ok(Event::Finished) | Err(RecvTimeoutError::Disconnected) => break,
                    Err(RecvTimeoutError::Timeout) => (),
                }
                if looked.elapsed() >= LOOK {
                    fail(Python::attach(|py| py.check_signals().and_then(|()| told.tell(py, listeners))), &stop);
                    looked = Instant::now();
                }
            }
            (handle.join(), error)
        })
    });
    if let Some(error) = error {
        return Err(error);
    }
    told.tell(py, listeners)?;
    done.unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

/// What `work` returns, done in a thread of its own while this one watches for signals. An interruption is told at once: `work`,
/// which owns all that it needs and has nothing of Python, then ends by itself where it next looks at `stop`.
pub fn watched<R: Send + 'static>(py: Python<'_>, work: impl FnOnce(&Stop) -> R + Send + 'static) -> PyResult<R> {
    let (stop, (sender, receiver)) = (Stop::default(), channel());
    let seen = stop.clone();
    let handle =
        std::thread::Builder::new().spawn(move || drop(sender.send(in_own_pool(|| work(&seen))))).map_err(failed)?;
    py.detach(move || {
        loop {
            match receiver.recv_timeout(LOOK) {
                Ok(result) => return result,
                Err(RecvTimeoutError::Timeout) => {
                    Python::attach(|py| py.check_signals()).inspect_err(|_| stop.set())?
                }
                Err(RecvTimeoutError::Disconnected) => break,
            }
        }
        match handle.join() {
            Err(panic) => std::panic::resume_unwind(panic),
            Ok(()) => Err(failed("the computation ended without a result")),
        }
    })
}
