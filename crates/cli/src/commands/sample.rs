//! `apportion sample`: the points of a study as a file, for an external model.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use apportion_base::files::read_text;
use apportion_files::exchange::{
    Format, Manifest, ReadOptions, open_table, random_design, sample as write_sample, write_rows,
};
use apportion_report::{prepare_file, stream_atomically, write_atomically};

use super::stop::Stoppable;
use super::{DesignChanges, StudyArguments, counted, say};
use crate::failure::{OfFile, bad_input};

/// Most random points.
const MAX_RANDOM: u64 = 2 * apportion::design::Design::MAX_POINTS;

#[derive(clap::Args)]
#[command(after_help = "FILE.manifest.json next to FILE describes the points: keep them together. When the outputs \
                        are computed: apportion analyze OUTPUTS --design FILE")]
pub struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    #[command(flatten)]
    design: DesignChanges,
    /// Write N random points instead of those of the design: for few runs, analysed with `apportion given-data`
    #[arg(long, value_name = "N", conflicts_with_all = ["base_samples", "accuracy", "runs"], value_parser = clap::value_parser!(u64).range(1..=MAX_RANDOM))]
    random: Option<u64>,
    /// Overwrite an existing file that is not a design of this study
    #[arg(long)]
    force: bool,
    /// The file for the points, .csv or .npy [default: NAME-design.csv, or NAME-random.csv]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

pub fn sample(arguments: &Arguments) -> anyhow::Result<()> {
    let study = arguments.study.load_any(&arguments.design.overrides())?;
    let kind = if arguments.random.is_some() { "random" } else { "design" };
    let default = PathBuf::from(format!("{}-{kind}.csv", study.name()));
    let path = arguments.output.clone().unwrap_or(default);
    let format = Format::from_path(&path).in_file(&path)?;
    let manifest_path = Manifest::path_for(&path);
    if !arguments.force && path.is_file() && !is_design_of(&path, study.name()) {
        let what = "exists already, and is not a design that `sample` wrote of this study";
        return Err(bad_input(format!("{} {what}: give another name, or add --force", path.display())));
    }
    prepare_file(&path)?;
    prepare_file(&manifest_path)?;
    if arguments.random.is_none() && study.target().grows() {
        say("note: a run of this study adds points until its target is met: these are its first points");
    }
    // A manifest of other points must not stay after they are replaced.
    if let Err(error) = std::fs::remove_file(&manifest_path)
        && error.kind() != std::io::ErrorKind::NotFound
    {
        return Err(anyhow!("cannot replace {}: {error}", manifest_path.display()));
    }
    let factors = counted(study.space().factors().len() as u64, "factor");
    if let Some(rows) = arguments.random {
        let design = random_design(&study, rows)?;
        stream_atomically(&path, |out| write_rows(&study, &design, None, rows, format, &mut Stoppable::new(out)))?;
        say(&format!("wrote {rows} random points of {factors} to {}", path.display()));
        return Ok(());
    }
    let file = &arguments.study.study;
    let manifest = stream_atomically(&path, |out| write_sample(&study, file, format, &mut Stoppable::new(out)))?;
    write_atomically(&manifest_path, manifest.json().as_bytes())?;
    let rows = study.design().rows();
    say(&format!("wrote {rows} points of {factors} to {}", path.display()));
    say(&format!("wrote {}", manifest_path.display()));
    Ok(())
}

/// Whether the file at `path` is a design of the study called `name` as `sample` wrote it: the manifest next to it says so, and no
/// outputs have been put in.
fn is_design_of(path: &Path, name: &str) -> bool {
    let manifest = read_text(&Manifest::path_for(path)).ok().and_then(|text| Manifest::parse(&text).ok());
    let width = open_table(path, &ReadOptions::default()).map(|rows| rows.width());
    manifest.zip(width.ok()).is_some_and(|(manifest, width)| manifest.describes(name, width))
}
