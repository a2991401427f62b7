//! Digests of the user's files on which the outputs of a study depend, to identify the model.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::Read;
use std::path::Path;

use serde_json::{Map, Value};

use crate::study::Study;
use apportion_base::digest::Sha256;

/// Returns the digests of the files of `study` (path: SHA-256); files that cannot be read are left out.
pub(super) fn digests(study: &Study) -> Value {
    let mut digests = Map::new();
    for path in study.subject.files() {
        if let Ok(digest) = sha256(&path) {
            digests.insert(path.display().to_string(), digest.into());
        }
    }
    Value::Object(digests)
}

/// Computes the digest in pieces: data may be larger than the memory.
fn sha256(path: &Path) -> std::io::Result<String> {
    let (mut file, mut hash) = (File::open(path)?, Sha256::default());
    let mut piece = vec![0; 1 << 16];
    loop {
        match file.read(&mut piece)? {
            0 => return Ok(hash.finish()),
            length => hash.update(&piece[..length]),
        }
    }
}

/// Returns the names of files (path: digest) that differ between before and now, if any. Files are compared by name, so
/// that a study may move and be given by any path; several of one name are compared in the order of their paths.
pub(super) fn differing(before: &Value, now: &Value) -> Option<String> {
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
mod tests;
