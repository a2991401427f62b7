//! Digests of the user's files on which the outputs of a study depend, to identify the model.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use serde_json::Value;

use super::RunError;
use apportion_base::digest::sha256_of_file;

/// The files of a model as they were when a run began: outputs of other ones must not be mixed with its own.
#[derive(Debug, Default)]
pub(crate) struct ModelFiles {
    paths: Vec<PathBuf>,
    /// Path: SHA-256, without files that cannot be read.
    pub digests: Value,
    /// When the files were found to have these digests.
    stamps: Vec<Stamp>,
}

/// The time of the last change and the length of a file, if it exists: while they are the same, it is not read again.
type Stamp = Option<(Option<SystemTime>, u64)>;

impl ModelFiles {
    /// Reads the files.
    pub fn new(paths: Vec<PathBuf>) -> Self {
        // Stamps first: a change while the files are read is then seen later.
        Self { stamps: stamps(&paths), digests: digests(&paths), paths }
    }

    /// Checks that the files are still the same; reads only those that seem to have changed.
    ///
    /// # Errors
    /// [`RunError::OtherFiles`] if they are not.
    pub fn check(&self) -> Result<(), RunError> {
        if self.stamps == stamps(&self.paths) { Ok(()) } else { self.check_contents() }
    }

    /// Does the same, but reads all files.
    ///
    /// # Errors
    /// [`RunError::OtherFiles`] if they are not.
    pub fn check_contents(&self) -> Result<(), RunError> {
        differing(&self.digests, &digests(&self.paths)).map_or(Ok(()), |files| Err(RunError::OtherFiles { files }))
    }
}

fn stamps(paths: &[PathBuf]) -> Vec<Stamp> {
    paths.iter().map(|path| path.metadata().ok().map(|about| (about.modified().ok(), about.len()))).collect()
}

/// Returns the digests of files (path: SHA-256); files that cannot be read are left out.
fn digests(paths: &[PathBuf]) -> Value {
    let digest = |path: &PathBuf| Some((path.display().to_string(), sha256_of_file(path).ok()?.into()));
    Value::Object(paths.iter().filter_map(digest).collect())
}

/// Returns the names of files (path: digest) that differ between before and now, if any. Files are compared by name, so
/// that a study may move and be given by any path; several of one name are compared in the order of their paths.
pub(crate) fn differing(before: &Value, now: &Value) -> Option<String> {
    let (before, now) = (by_name(before), by_name(now));
    let names: BTreeSet<&String> = before.keys().chain(now.keys()).collect();
    let names: Vec<&str> =
        names.into_iter().filter(|name| before.get(*name) != now.get(*name)).map(String::as_str).collect();
    (!names.is_empty()).then(|| names.join(", "))
}

/// Returns the digests of the files of every name, in the order of their paths.
fn by_name(files: &Value) -> BTreeMap<String, Vec<String>> {
    let mut entries: Vec<(&String, &str)> =
        files.as_object().into_iter().flatten().filter_map(|(path, digest)| Some((path, digest.as_str()?))).collect();
    entries.sort_unstable();
    let mut digests_by_name: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (path, digest) in entries {
        if let Some(name) = Path::new(path).file_name() {
            digests_by_name.entry(name.to_string_lossy().into_owned()).or_default().push(digest.to_owned());
        }
    }
    digests_by_name
}

#[cfg(test)]
#[path = "tests/model_files.rs"]
mod tests;
