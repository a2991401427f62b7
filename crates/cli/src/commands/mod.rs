//! The command line: arguments, progress, messages and exit codes. All computation is in the library.

mod analyze;
mod check;
mod compare;
mod completions;
mod evaluate;
mod given_data;
mod journal;
mod live;
mod merge;
mod models;
mod new;
mod output;
mod progress;
mod ranks;
mod report;
mod reproduce;
mod run;
mod sample;
mod schema;
mod screen;
mod simulate;
mod stop;
mod sweep;
mod table;
mod trade;

use std::io::{Error, ErrorKind, Write};
use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::process::ExitCode;

use apportion::study::Study;
use clap::{Args, Parser, Subcommand};
use ranks::Ranks;
use rayon::ThreadPoolBuilder;

use crate::failure::{self, Silent, bad_input};

/// Sobol' global sensitivity analysis: which factors drive an output, and by how many percent.
///
/// Exit codes: 0 success, 1 the run failed, 2 the input was wrong.
#[derive(Parser)]
#[command(name = "apportion", version, about, long_about, max_term_width = 110)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Write a new study file, with comments that explain it
    New(new::Arguments),
    /// Reproduce the papers on one page: figures, a verdict on every claim, possible meanings of their percentages
    Reproduce(reproduce::Arguments),
    /// Run a study: design, model runs, indices, charts
    Run(run::Arguments),
    /// Merge the shards of a run (run --shard I/N) into its result
    Merge(merge::Arguments),
    /// Write the page, tables and charts of a result again, from its JSON file only
    Report(report::Arguments),
    /// Compare two results: differences of the indices, and whether they exceed the errors
    Compare(compare::Arguments),
    /// Screen many factors by elementary effects: a few runs for each factor
    Screen(screen::Arguments),
    /// Vary one factor at a time around the nominal point: curves, ranges and slopes of every output
    Sweep(sweep::Arguments),
    /// Accuracy against time: the cheapest settings for each accuracy
    Trade(trade::Arguments),
    /// Write the points of a study to a file, for an external model
    Sample(sample::Arguments),
    /// Estimate indices from the outputs of an external model at the points of `sample`
    Analyze(analyze::Arguments),
    /// Evaluate a study's model at points from a CSV file
    Evaluate(evaluate::Arguments),
    /// Estimate indices from an existing table of inputs and outputs
    GivenData(given_data::Arguments),
    /// Explain a study before running it: factors, cost (from a short pilot run), memory, files
    Check(check::Arguments),
    /// Simulate one scene of a study in time, with every factor at its nominal value: forces, positions, contacts
    Simulate(simulate::Arguments),
    /// Write an interactive page of a study: drag a range, and the percentages change
    Live(live::Arguments),
    /// List the models, or show one in full: formula, factors, outputs, exact indices
    Models(models::Arguments),
    /// Print the JSON Schema of study or result files, for editors and programs
    Schema(schema::Arguments),
    /// Print the script that completes commands and options in a shell
    Completions(completions::Arguments),
}

/// A study file and its changes on the command line.
#[derive(Args)]
struct StudyArguments {
    /// The study file (TOML)
    study: PathBuf,
    /// Change a setting of the study: afm.friction=hk, factor.length.max=500, outputs='["critical_time"]'
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
}

/// Changes of the design on the command line.
#[derive(Args)]
struct DesignChanges {
    /// Total number of base samples, over all replicates (the same as --set design.base_samples=N)
    #[arg(long, value_name = "N", value_parser = whole_number)]
    base_samples: Option<u64>,
    /// Half width that the 95 % interval of every index must reach; the run chooses the cheapest settings for it (the same
    /// as --set accuracy=A)
    #[arg(long, value_name = "A", conflicts_with_all = ["base_samples", "runs"])]
    accuracy: Option<f64>,
    /// Largest number of model runs; the design is the best one within it (the same as --set design.runs=N)
    #[arg(long, value_name = "N", value_parser = whole_number, conflicts_with = "base_samples")]
    runs: Option<u64>,
    /// Seed of the design (the same as --set design.seed=S)
    #[arg(long, value_name = "S", value_parser = whole_number, allow_negative_numbers = true)]
    seed: Option<u64>,
}

/// The whole numbers from 0 that TOML can hold.
fn whole_number(text: &str) -> Result<u64, String> {
    let number = text.replace('_', "").parse::<u64>().ok().filter(|number| *number <= i64::MAX as u64);
    number.ok_or_else(|| format!("expected a whole number from 0 to {}, as in 4096 or 1_000_000", i64::MAX))
}

impl DesignChanges {
    fn overrides(&self) -> Vec<String> {
        let base_samples = self.base_samples.map(|n| format!("design.base_samples={n}"));
        let seed = self.seed.map(|s| format!("design.seed={s}"));
        let accuracy = self.accuracy.map(|a| format!("accuracy={a:?}"));
        let runs = self.runs.map(|n| format!("design.runs={n}"));
        base_samples.into_iter().chain(accuracy).chain(runs).chain(seed).collect()
    }
}

impl StudyArguments {
    /// The study with the changes of `--set`, then `more`; its model can be run.
    fn load_with(&self, more: &[String]) -> anyhow::Result<Study> {
        let study = self.load_any(more)?;
        if study.subject().is_external() {
            return Err(bad_input(format!(
                "{}: its model runs outside this program: write the points with `apportion sample`, and read its outputs \
                 with `apportion analyze`",
                self.study.display()
            )));
        }
        Ok(study)
    }

    /// The study with the changes of `--set`, then `more`, whether or not its model can be run.
    fn load_any(&self, more: &[String]) -> anyhow::Result<Study> {
        let study = apportion_files::load_study(&self.study, &[&self.set, more].concat())?;
        say_notes(&study);
        Ok(study)
    }
}

fn say_notes(study: &Study) {
    for note in study.notes() {
        say(&format!("note: {note}"));
    }
}

/// Number of worker threads.
#[derive(Args)]
struct Threads {
    /// Number of worker threads, and largest number of processes of a program [default: one per core]. The result does not depend on it
    #[arg(long, value_name = "T", value_parser = |text: &str| number_in(text, 1..=1024))]
    threads: Option<usize>,
}

impl Threads {
    /// The number for the library, where 0 means one per core.
    fn number(&self) -> usize {
        self.threads.unwrap_or(0)
    }
}

/// A whole number in `range`.
fn number_in(text: &str, range: RangeInclusive<usize>) -> Result<usize, String> {
    let number = text.parse().ok().filter(|number| range.contains(number));
    number.ok_or_else(|| format!("expected a whole number from {} to {}", range.start(), range.end()))
}

/// Runs the program and returns its exit code.
pub fn main() -> ExitCode {
    stop::ignore_sigxfsz();
    // Where threads are limited, this one does all work: rayon's own pool would panic.
    if ThreadPoolBuilder::new().build().is_err() {
        let _ = ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global();
    }
    #[cfg(feature = "mpi")]
    if let Some((size, _)) = ranks::job() {
        return ranks::mpi::main(size, |mpi_ranks| command_line(Some(mpi_ranks)));
    }
    command_line(None)
}

/// Parses the command line and runs the command, with `mpi_ranks` as the other ranks of an MPI job.
fn command_line(mpi_ranks: Option<&dyn Ranks>) -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            // If printing fails, there is no other place to report it.
            let _ = error.print();
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2));
        }
    };
    exit_code(match cli.command {
        Command::New(arguments) => new::new(&arguments),
        Command::Reproduce(arguments) => reproduce::reproduce(&arguments),
        Command::Run(arguments) => run::run(&arguments, mpi_ranks),
        Command::Merge(arguments) => merge::merge(&arguments),
        Command::Sample(arguments) => sample::sample(&arguments),
        Command::Analyze(arguments) => analyze::analyze(&arguments),
        Command::Report(arguments) => report::report(&arguments),
        Command::Compare(arguments) => compare::compare(&arguments),
        Command::Screen(arguments) => screen::screen(&arguments),
        Command::Sweep(arguments) => sweep::sweep(&arguments),
        Command::Trade(arguments) => trade::trade(&arguments),
        Command::Evaluate(arguments) => evaluate::evaluate(&arguments),
        Command::GivenData(arguments) => given_data::given_data(&arguments),
        Command::Check(arguments) => check::check(&arguments),
        Command::Simulate(arguments) => simulate::simulate(&arguments),
        Command::Live(arguments) => live::live(&arguments),
        Command::Models(arguments) => models::models(&arguments),
        Command::Schema(arguments) => schema::schema(&arguments),
        Command::Completions(arguments) => completions::completions(&arguments),
    })
}

/// Returns the exit code of `outcome`, and prints its error.
fn exit_code(outcome: anyhow::Result<()>) -> ExitCode {
    let Err(error) = outcome else { return ExitCode::SUCCESS };
    // A reader that closes the pipe early has read what it needs.
    if error.downcast_ref::<Error>().is_some_and(|error| error.kind() == ErrorKind::BrokenPipe) {
        return ExitCode::SUCCESS;
    }
    if !error.is::<Silent>() {
        say(&format!("error: {}", failure::message(&error)));
    }
    ExitCode::from(failure::exit_code(&error))
}

/// A path or an argument as it is typed in a shell.
fn quoted(text: &str) -> String {
    if !text.is_empty() && text.chars().all(|c| c.is_alphanumeric() || "/._-+,:@%=".contains(c)) {
        text.to_owned()
    } else {
        format!("'{}'", text.replace('\'', r"'\''"))
    }
}

/// Writes what the program itself has made, for other programs, to standard output.
fn print_raw(bytes: &[u8]) -> anyhow::Result<()> {
    std::io::stdout()
        .write_all(bytes)
        .map_err(|error| Error::new(error.kind(), format!("cannot write to standard output: {error}")).into())
}

/// Writes `text` to standard output without panicking when its reader is gone.
fn print(text: &str) -> anyhow::Result<()> {
    print_raw(printable(text).as_bytes())
}

/// Writes a line to standard error; there is nowhere to complain if that fails.
fn say(line: &str) {
    let _ = writeln!(std::io::stderr(), "{}", printable(line));
}

/// A text without characters that would change the terminal: names and titles are untrusted input.
fn printable(text: &str) -> String {
    text.chars()
        .map(|c| if c.is_control() && c != '\n' && c != '\t' { char::REPLACEMENT_CHARACTER } else { c })
        .collect()
}

fn counted(number: u64, what: &str) -> String {
    format!("{number} {what}{}", if number == 1 { "" } else { "s" })
}
