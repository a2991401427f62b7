//! The names of the files of a document: safe and unique for any names of outputs and factors.

use std::collections::HashSet;

use apportion_base::names::{file_part, named};

/// The folder of the charts, below that of the page.
pub(super) const CHARTS: &str = "charts";

named! {
    /// A format of charts, whose name is the ending of its files.
    pub enum ChartFormat {
        /// Vector graphics.
        Svg = "svg",
        /// Pixels.
        Png = "png",
        /// A page of vectors and text, for papers.
        Pdf = "pdf",
    }
}

/// Returns the prefixes of the files of each of `names`, so that with `suffixes` appended no two files have one name,
/// even where case is ignored: the name, with a number where it would equal another file's.
///
/// ```
/// let stems = apportion_report::file_stems("s", &["y", "y-indices", "Y"], &["", "-indices"]);
/// assert_eq!(stems, ["s-y", "s-y-indices-2", "s-Y-3"]);
/// assert_eq!(apportion_report::file_stems("s", &["y"], &[""]), ["s"]);
/// ```
pub fn file_stems(study: &str, names: &[&str], suffixes: &[&str]) -> Vec<String> {
    if names.len() == 1 {
        return vec![study.to_owned()];
    }
    let mut taken: HashSet<String> = HashSet::new();
    let mut stems = Vec::new();
    for (number, name) in (1..).zip(names) {
        let part = file_part(name);
        let numbered = (number..).map(|n| format!("{study}-{part}-{n}"));
        for stem in std::iter::once(format!("{study}-{part}")).chain(numbered) {
            let files: Vec<String> = suffixes.iter().map(|suffix| format!("{stem}{suffix}").to_lowercase()).collect();
            if files.iter().all(|file| !taken.contains(file)) {
                taken.extend(files);
                stems.push(stem);
                break;
            }
        }
    }
    stems
}
