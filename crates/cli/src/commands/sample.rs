//! `apportion sample`: the points of a study as a file, for an external model.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use apportion::screening::ScreeningSettings;
use apportion_base::digest::sha256_of_file;
use apportion_base::files::read_text;
use apportion_files::exchange::{Format, Manifest, Points, sample as write_sample};
use apportion_report::{prepare_outputs, stream_atomically, write_atomically};

use super::screen::screening_design;
use super::stop::Stoppable;
use super::{DesignChanges, StudyArguments, counted, say};
use crate::failure::OfFile;

#[derive(clap::Args)]
#[command(after_help = "FILE.manifest.json next to FILE describes the points: keep them together. When the outputs \
                        are computed: apportion analyze OUTPUTS --design FILE")]
pub struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    #[command(flatten)]
    design: DesignChanges,
    /// Write the points of a screening instead: radial (the default), or trajectory; `analyze` then gives its measures
    #[arg(long, value_name = "DESIGN", num_args = 0..=1, default_missing_value = "radial", value_parser = ["radial", "trajectory"],
          conflicts_with_all = ["base_samples", "accuracy", "runs"])]
    screening: Option<String>,
    /// Number of trajectories of the screening; each costs (1 + factors) runs
    #[arg(long, value_name = "R", requires = "screening", default_value_t = 32)]
    trajectories: u64,
    /// Overwrite an existing file that is not a design of this study
    #[arg(long)]
    force: bool,
    /// The file for the points, .csv or .npy [default: NAME-design.csv]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

pub fn sample(arguments: &Arguments) -> anyhow::Result<()> {
    let study = arguments.study.load_any(&arguments.design.overrides())?;
    let default = PathBuf::from(format!("{}-design.csv", study.name()));
    let path = arguments.output.clone().unwrap_or(default);
    let format = Format::from_path(&path).in_file(&path)?;
    let manifest_path = Manifest::path_for(&path);
    let is_own = arguments.force || is_design_of(&path, study.name());
    prepare_outputs(&study.files(), &[path.clone(), manifest_path.clone()], is_own)?;
    let in_study = study.design().settings();
    let screening = arguments.screening.as_deref().map(|design| ScreeningSettings {
        design: screening_design(design, None, in_study.sampler),
        trajectories: arguments.trajectories,
        seed: in_study.seed,
    });
    let points = Points::from_study(&study, screening)?;
    if study.target().grows() && screening.is_none() {
        say("note: a run of this study adds points until its target is met: these are its first points");
    }
    // A manifest of other points must not stay after they are replaced.
    if let Err(error) = std::fs::remove_file(&manifest_path)
        && error.kind() != std::io::ErrorKind::NotFound
    {
        return Err(anyhow!("cannot replace {}: {error}", manifest_path.display()));
    }
    let factors = counted(study.space().factors().len() as u64, "factor");
    let file = &arguments.study.study;
    let mut manifest =
        stream_atomically(&path, |out| write_sample(&study, file, &points, format, &mut Stoppable::new(out)))?;
    manifest.file_sha256 = sha256_of_file(&path)?;
    write_atomically(&manifest_path, manifest.json().as_bytes())?;
    let rows = points.rows();
    say(&format!("wrote {rows} points of {factors} to {}", path.display()));
    say(&format!("wrote {}", manifest_path.display()));
    Ok(())
}

/// Whether the file at `path` is a design of the study called `name` as `sample` wrote it: the manifest next to it has its digest.
fn is_design_of(path: &Path, name: &str) -> bool {
    let manifest = read_text(&Manifest::path_for(path)).ok().and_then(|text| Manifest::parse(&text).ok());
    manifest.zip(sha256_of_file(path).ok()).is_some_and(|(manifest, sha256)| manifest.describes(name, &sha256))
}
