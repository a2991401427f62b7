//! Threads for what is estimated from runs.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use rayon::{ThreadPool, ThreadPoolBuilder};

use super::{RunError, threads_in_force};

/// Pools by their number of threads. To start one takes longer than many a run.
static POOLS: Mutex<BTreeMap<usize, Arc<ThreadPool>>> = Mutex::new(BTreeMap::new());

/// A pool of `threads` threads (0: one per core), the same one for all runs that do not run inside of another pool: those
/// would wait for threads that wait for them. `None` where there are no threads, as in WebAssembly: the one that runs
/// all does this too.
///
/// # Errors
/// [`RunError::Threads`] if the threads cannot be started.
pub(super) fn thread_pool(threads: usize) -> Result<Option<Arc<ThreadPool>>, RunError> {
    if cfg!(target_family = "wasm") {
        return Ok(None);
    }
    let threads = threads_in_force(threads);
    let new = || {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        pool.map(Arc::new).map_err(|source| RunError::Threads { threads, source: source.into() })
    };
    if rayon::current_thread_index().is_some() {
        return new().map(Some);
    }
    let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(pool) = pools.get(&threads) {
        return Ok(Some(Arc::clone(pool)));
    }
    let pool = new()?;
    pools.insert(threads, Arc::clone(&pool));
    Ok(Some(pool))
}
