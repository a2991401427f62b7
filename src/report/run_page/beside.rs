//! The files beside the page: it links to those only that are there.

use crate::report::page::{Link, Part};

/// Names of the files beside the page.
#[derive(Clone, Copy)]
pub(super) struct Beside<'a> {
    pub files: &'a [String],
    /// Name of the study, with which every file begins.
    pub study: &'a str,
}

impl Beside<'_> {
    /// A link to the study's file with this ending, if it is there.
    pub fn table(self, suffix: &str, text: &str) -> Option<Link> {
        self.link(format!("{}{suffix}", self.study), text)
    }

    /// Links to the pictures of the chart whose files begin with `stem`.
    pub fn pictures(self, stem: &str) -> Vec<Link> {
        let picture = |(ending, text): (&str, &str)| self.link(format!("{stem}{ending}"), text);
        [(".svg", "SVG"), (".png", "PNG")].into_iter().filter_map(picture).collect()
    }

    fn link(self, file: String, text: &str) -> Option<Link> {
        self.files.contains(&file).then(|| Link { text: text.to_owned(), to: file })
    }

    /// Links to all of them.
    pub fn all(self) -> Part {
        Part::Links(self.files.iter().map(|file| Link { text: file.clone(), to: file.clone() }).collect())
    }
}

/// What the names of the charts of an output end in, before the ending of the format.
pub const RUN_CHARTS: [&str; 6] = ["", "-indices", "-interactions", "-scatter", "-distribution", "-convergence"];
