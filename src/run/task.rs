//! What an executor runs: a source of pieces of rows, how a worker evaluates one, and a sink.

use super::RunError;
use super::remote::Abroad;
use crate::model::{GiveUp, Worker};

/// Most rows of a piece.
const MOST_ROWS: u64 = 4096;

/// Rows to be run: a source of pieces, how a worker evaluates one, and a sink of what comes of them. A source that knows
/// the outputs of some rows already does not give them out.
pub(crate) trait Task: Sync {
    /// Some of the rows.
    type Piece: Send;
    /// What comes of them.
    type Output: Send;
    /// What a thread keeps from piece to piece.
    type Scratch;

    /// Scratch space for one thread.
    fn scratch(&self) -> Self::Scratch;

    /// The source: a piece of best `most` rows for one of `workers` workers; `None` if there is none left.
    fn next(&self, most: u64, workers: usize) -> Option<Self::Piece>;

    /// Rows of a piece.
    fn rows(&self, piece: &Self::Piece) -> u64;

    /// What a worker makes of a piece; `on_rows` is told of rows as soon as they are evaluated.
    fn evaluate(
        &self,
        worker: &mut dyn Worker,
        scratch: &mut Self::Scratch,
        piece: &Self::Piece,
        on_rows: &dyn Fn(u64),
    ) -> Evaluated<Self::Output>;

    /// The sink. An error ends the run.
    fn accept(&self, piece: &Self::Piece, output: Self::Output) -> Result<Finished, RunError>;

    /// Most rows that a worker asks for at once.
    fn most_rows(&self) -> u64 {
        MOST_ROWS
    }

    /// How its pieces and outputs travel, if workers in other processes can evaluate them.
    fn abroad(&self) -> Option<&dyn Abroad<Self::Piece, Self::Output>> {
        None
    }
}

/// What has come of a piece.
pub(crate) struct Evaluated<O> {
    /// `None` if there is nothing to hand over, since the worker has given up.
    pub output: Option<O>,
    pub given_up: Option<GiveUp>,
}

/// Rows that have gone into the sink.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Finished {
    pub rows: u64,
    /// Those that failed in at least one output.
    pub failed: u64,
}
