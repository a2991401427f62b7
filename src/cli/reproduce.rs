//! `apportion reproduce`: the papers' studies.

use std::path::PathBuf;

use apportion::analyse;
use apportion::report::prepare_folder;
use apportion::reproduce::{Reproduced, comparison_table, studies, write_all};

use super::progress::Meter;
use super::{DesignChanges, Failure, Threads, print, say, say_notes};

#[derive(clap::Args)]
pub struct Arguments {
    /// Folder for the results
    #[arg(long, value_name = "DIR", default_value = "results/reproduce")]
    out: PathBuf,
    #[command(flatten)]
    design: DesignChanges,
    #[command(flatten)]
    threads: Threads,
}

pub fn reproduce(arguments: &Arguments) -> Result<(), Failure> {
    let studies = studies(&arguments.design.overrides())?;
    prepare_folder(&arguments.out)?;
    let count = studies.len();
    if let Some((_, _, study)) = studies.first() {
        say_notes(study);
    }
    let mut reproduced = Vec::with_capacity(count);
    for (number, (group, friction, study)) in studies.iter().enumerate() {
        let meter = Meter::new(&format!("{} of {count} {:<21}", number + 1, study.name), study.design.rows());
        let result = analyse(study, arguments.threads.number(), &|progress| meter.update(progress))?;
        meter.finish(result.provenance.model_runs, result.provenance.wall_seconds);
        reproduced.push(Reproduced { friction: *friction, group: *group, result });
    }
    let files = write_all(&arguments.out, &reproduced).map_err(|error| Failure::Run(error.into()))?;
    print(&comparison_table(&reproduced))?;
    say(&format!("wrote {} files to {}", files.len(), arguments.out.display()));
    Ok(())
}
