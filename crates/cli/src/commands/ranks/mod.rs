//! A run on the ranks of an MPI job: rank 0 is the usual program, the others evaluate rows for it.

#[cfg(feature = "mpi")]
pub mod mpi;

use std::path::Path;

use crate::failure::{Silent, bad_input};
use apportion::RemoteWorkers;
use apportion::study::Study;

/// The other ranks of the job, as rank 0 sees them.
pub trait Ranks: RemoteWorkers {
    /// Lets the other ranks work for the run of `study`, whose file is at `path`, each with so many workers; returns how
    /// many ranks there are, rank 0 included.
    ///
    /// # Errors
    /// If the path is not text in UTF-8.
    fn begin(&self, study: &Study, path: &Path, threads: usize) -> anyhow::Result<usize>;
}

/// Set to `off`, this lets every process of a job be a program by itself.
const SWITCH: &str = "APPORTION_MPI";

/// Where launchers say how many processes there are, and which of them this one is.
const VARIABLES: [(&str, &str); 5] = [
    ("OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"),
    ("PMI_SIZE", "PMI_RANK"),
    ("MV2_COMM_WORLD_SIZE", "MV2_COMM_WORLD_RANK"),
    ("SLURM_NTASKS", "PMIX_RANK"),
    ("SLURM_STEP_NUM_TASKS", "SLURM_PROCID"),
];

/// The number of ranks of the MPI job in which this process was started, if there are more than one, and its own.
pub fn job() -> Option<(usize, usize)> {
    if std::env::var(SWITCH).is_ok_and(|switch| switch == "off") {
        return None;
    }
    let job = VARIABLES.iter().find_map(|&(size, rank)| {
        let [size, rank] = [size, rank].map(|name| std::env::var(name).ok()?.trim().parse::<usize>().ok());
        Some((size?, rank?))
    });
    job.filter(|(size, _)| *size > 1)
}

/// Refuses to run a study once on every rank, all at the same files.
///
/// # Errors
/// [`Silent`] on all ranks but the first, which has said why.
pub fn refuse_copies() -> anyhow::Result<()> {
    match job().filter(|_| cfg!(not(feature = "mpi"))) {
        None => Ok(()),
        Some((size, 0)) => Err(bad_input(format!(
            "started as {size} ranks of an MPI job, but this program was built without MPI: every rank would run the whole study \
             and write the same files. Build it with `cargo install --path . --features mpi` (needs an MPI library and \
             libclang), or divide the run with `--shard I/N`. ({SWITCH}=off lets every rank run the whole study)"
        ))),
        Some(_) => Err(Silent.into()),
    }
}
