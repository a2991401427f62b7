//! Running a design through a model: fixed blocks of base points, folded into totals of constant size.
//!
//! A block is 256 base points with all of their rows. Blocks are merged in a binary tree whose shape depends only
//! on the number of blocks, so the totals have the same bits on any number of threads; memory does not grow with the
//! number of samples, unless outputs are kept.
//!
//! A run may keep the outputs of its rows in a [`Store`]: rows that it already has, from an interrupted run, another
//! machine or a file, are not evaluated again; missing ones are evaluated in batches of any size. The totals are then
//! folded from the store, to the same bits.

mod error;
mod executor;
mod failures;
mod fold;
mod growing;
pub mod journal;
mod model_files;
mod pilot;
mod remote;
mod repeats;
mod rows;
mod scratch;
mod shard;
mod store;
mod table;
mod totals;
mod tracker;

use std::sync::OnceLock;
use std::time::Duration;

pub use error::RunError;
pub use failures::RowPosition;
pub(crate) use failures::Tally;
pub(crate) use growing::GrowingRun;
use journal::Journal;
pub(crate) use model_files::{ModelFiles, differing};
pub use pilot::Pilot;
pub use remote::RemoteWorkers;
pub(crate) use remote::{DesignKey, Remote, Reply, Request};
pub(crate) use repeats::{Repeats, repeat_rows};
pub use rows::RowValues;
pub(crate) use rows::{RowWorker, answered};
pub(crate) use scratch::failed_rows;
pub use shard::{Shard, ShardError};
pub use store::{RowBlock, Store};
pub use table::TableRun;
pub(crate) use totals::SAMPLE;
pub(crate) use totals::Totals;

use crate::design::Design;
use crate::model::Model;
use crate::space::Space;
use apportion_base::names::named;

/// Base points in a block: their columns fit in the cache, and a block takes long enough to be worth a task.
pub(crate) const BLOCK: u64 = 256;

/// How long to wait for remote workers between two checks for a stop.
const STOP_POLL_INTERVAL: Duration = Duration::from_millis(20);

/// The work of a run: every row of `design`, as points of `space`, through `model`.
#[derive(Clone, Copy)]
pub(crate) struct Job<'a> {
    /// The rows in the unit cube.
    pub design: &'a Design,
    /// The distributions that map them to SI units; as many factors as the design.
    pub space: &'a Space,
    /// The model to evaluate.
    pub model: &'a dyn Model,
}

/// The progress of a run.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Progress {
    /// Model runs finished.
    pub done: u64,
    /// Those among them that were loaded when the run began.
    pub recalled: u64,
    /// Model runs of the design.
    pub total: u64,
    /// Model runs finished that have failed in at least one output.
    pub failed: u64,
    /// Time since the start.
    pub elapsed: Duration,
}

/// Maximum memory for kept outputs, in bytes: 8 GiB.
pub const MAX_STORED_BYTES: u64 = 8 << 30;

/// Records a block of evaluated rows, before its rows count as done; does nothing while the journal is not open.
pub(crate) fn record(journal: &OnceLock<Journal>, block: &RowBlock) -> Result<(), RunError> {
    journal.get().map_or(Ok(()), |journal| journal.append(block))
}

/// Returns the number of threads that a run uses when `threads` are requested.
pub fn threads_in_force(threads: usize) -> usize {
    if threads == 0 { std::thread::available_parallelism().map_or(1, usize::from) } else { threads }
}

named! {
    /// What happens when a row fails; the default first.
    pub enum FailurePolicy {
        /// Indices that need the row are estimated without its base point.
        DropBlock = "drop-block",
        /// The run stops.
        Fail = "fail",
    }
}

#[cfg(test)]
mod tests;
