//! The manifest of a design file: written next to it, it holds all that `analyze` needs in addition to the outputs.

use std::path::{Path, PathBuf};

use apportion::design::Matrix;
use apportion::screening::ScreeningSettings;
use apportion::study::{Study, Target};
use serde::{Deserialize, Serialize};

use super::error::{TableError, refused};

/// The manifest of a design file, as described in `docs/reference/exchange-formats.md`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Manifest {
    /// `"apportion-design"`.
    format: String,
    /// 1.
    version: u32,
    /// Version of the program that wrote it.
    apportion_version: String,
    /// The study.
    study: ManifestStudy,
    /// The rows of the design file.
    design: ManifestDesign,
    /// The columns of the design file.
    factors: Vec<ManifestFactor>,
    /// SHA-256 of the design file as it was written.
    #[serde(default)]
    pub file_sha256: String,
}

/// The study of a design file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct ManifestStudy {
    /// Its name.
    name: String,
    /// Its file, as named on the command line.
    file: String,
    /// SHA-256 of the file.
    sha256: String,
    /// Changes made on the command line.
    overrides: Vec<String>,
    /// The text of the file, unchanged.
    text: String,
}

/// The rows of a design file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct ManifestDesign {
    /// The sampler.
    sampler: String,
    /// The seed.
    seed: u64,
    /// Number of independent randomisations.
    replicates: u64,
    /// Total number of base samples.
    base_samples: u64,
    /// Number of rows of each base sample.
    rows_per_point: u64,
    /// Total number of rows.
    rows: u64,
    /// The order of the rows, in words.
    order: String,
    /// The rows of a base sample.
    layout: Vec<ManifestRun>,
    /// SHA-256 of the numbers, row by row, each as a little-endian double.
    sha256: String,
    /// Settings of the screening, if the rows are its trajectories: then those above are of the study's own design.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    screening: Option<ScreeningSettings>,
}

/// A row of a base sample: that of the matrix `base`, with `columns` from the matrix `from`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct ManifestRun {
    /// A, B, or "plain 1" and so on for rows that serve only surrogates.
    base: String,
    /// Names of factors.
    columns: Vec<String>,
    /// Likewise.
    from: String,
    /// Names of dependent factors that come from neither matrix, and follow the others.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    following: Vec<String>,
}

/// A column of a design file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct ManifestFactor {
    /// The factor, which is the header of its column.
    name: String,
    /// The unit of its values.
    unit: String,
    /// The labels of a factor of categories.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    labels: Option<Vec<String>>,
}

const FORMAT: &str = "apportion-design";
const VERSION: u32 = 1;

impl Manifest {
    /// Creates the manifest of the design of `study`, read from `file`, whose numbers have this SHA-256.
    pub fn new(study: &Study, file: &Path, screening: Option<ScreeningSettings>, sha256: String) -> Self {
        let settings = study.design().settings();
        let factors = study.space().factors();
        let layout = study.design().runs().iter().map(|run| ManifestRun {
            base: matrix(run.base),
            columns: run.columns.iter().map(|factor| factors[*factor].name.clone()).collect(),
            from: matrix(run.from),
            following: run.mixed.iter().map(|(factor, _)| factors[*factor].name.clone()).collect(),
        });
        let factors = factors.iter().map(|factor| ManifestFactor {
            name: factor.name.clone(),
            unit: factor.unit().to_string(),
            labels: factor.distribution().labels().map(<[String]>::to_vec),
        });
        Self {
            format: FORMAT.to_owned(),
            version: VERSION,
            apportion_version: env!("CARGO_PKG_VERSION").to_owned(),
            study: ManifestStudy {
                name: study.name().to_owned(),
                file: file.display().to_string(),
                sha256: study.sha256().to_owned(),
                overrides: study.overrides().to_vec(),
                text: study.source().to_owned(),
            },
            design: ManifestDesign {
                sampler: settings.sampler.name().to_owned(),
                seed: settings.seed,
                replicates: settings.replicates,
                base_samples: settings.base_samples,
                rows_per_point: study.design().rows_per_point(),
                rows: study.design().rows(),
                order: "replicate by replicate, base point by base point, the rows of `layout` of each: the row of \
                        matrix `base` with `columns` of matrix `from`"
                    .to_owned(),
                layout: layout.collect(),
                sha256,
                screening,
            },
            factors: factors.collect(),
            file_sha256: String::new(),
        }
    }

    /// Returns whether it describes the design of the study of that name, in a file with that SHA-256.
    pub fn describes(&self, study: &str, sha256: &str) -> bool {
        self.study.name == study && self.file_sha256 == sha256
    }

    /// Returns the settings of the screening whose points are in the file; `None` for the points of a design.
    pub fn screening(&self) -> Option<ScreeningSettings> {
        self.design.screening
    }

    /// Returns the path of the manifest of the design file `design`: next to it.
    ///
    /// ```
    /// # use apportion_files::exchange::Manifest;
    /// assert_eq!(Manifest::path_for("a/x.csv".as_ref()), std::path::Path::new("a/x.csv.manifest.json"));
    /// ```
    pub fn path_for(design: &Path) -> PathBuf {
        let mut name = design.as_os_str().to_owned();
        name.push(".manifest.json");
        name.into()
    }

    /// Reads a manifest from its text.
    ///
    /// # Errors
    /// [`TableError`] if it is not a manifest, or of a later version.
    pub fn parse(text: &str) -> Result<Self, TableError> {
        let manifest: Self = serde_json::from_str(text)
            .map_err(|error| TableError::Refused(format!("not a manifest of a design: {error}")))?;
        match (manifest.format.as_str(), manifest.version) {
            (FORMAT, ..=VERSION) => Ok(manifest),
            (FORMAT, later) => refused(format!(
                "format version {later} of the manifest is unknown: this program reads versions up to {VERSION}"
            )),
            (other, _) => {
                refused(format!("not a manifest of a design: its format is {other:?}, expected \"{FORMAT}\""))
            }
        }
    }

    /// Formats the manifest as JSON, ending in a line feed.
    pub fn json(&self) -> String {
        // Serialisation fails only on maps without text keys, of which there is none.
        serde_json::to_string_pretty(self).expect("a manifest is plain data") + "\n"
    }

    /// Returns the study of this design; it does not grow beyond the rows of the file.
    ///
    /// # Errors
    /// [`TableError`] if the manifest contradicts itself.
    pub fn study(&self) -> Result<Study, TableError> {
        let ManifestStudy { file, text, overrides, sha256, .. } = &self.study;
        let study = crate::parse_study(text, Path::new(file), overrides)
            .map_err(|error| TableError::Refused(format!("the study in the manifest: {error}")))?;
        if study.sha256() != *sha256 {
            let actual = study.sha256();
            return refused(format!(
                "the study in the manifest was changed after `sample` wrote it: its SHA-256 is {actual}, not {sha256}"
            ));
        }
        if self.design != Self::new(&study, Path::new(file), self.screening(), self.design.sha256.clone()).design {
            return refused(
                "the design of the manifest is not that of its study: it was changed after `sample` wrote it",
            );
        }
        Ok(study.with_target(Target::default()))
    }

    /// Checks that the numbers of the design of `study` are those of the manifest.
    ///
    /// # Errors
    /// [`TableError`] if they are not.
    pub fn check_points(&self, sha256: &str) -> Result<(), TableError> {
        if self.design.sha256 == sha256 {
            return Ok(());
        }
        let (here, written) = (env!("CARGO_PKG_VERSION"), &self.apportion_version);
        refused(format!(
            "the points of this manifest are not those that version {here} makes of its study (it was written by version \
             {written}): analyse them with that version, or sample again"
        ))
    }
}

fn matrix(matrix: Matrix) -> String {
    match matrix {
        Matrix::A => "A".to_owned(),
        Matrix::B => "B".to_owned(),
    }
}
