//! Parts shared by the results of several commands.

use serde::{Deserialize, Serialize};

use super::{FactorRecord, StudyRecord};

/// The duration of a run, and its number of threads; both 0 if it was elsewhere.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RunFacts {
    /// Threads used.
    pub threads: usize,
    /// Seconds from the first run to the last.
    pub wall_seconds: f64,
}

/// The study as it was run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StudySetup {
    /// The question.
    #[serde(flatten)]
    pub study: StudyRecord,
    /// The factors in the order of the study.
    pub factors: Vec<FactorRecord>,
    /// SHA-256 of the study file on disk, in hexadecimal.
    pub sha256: String,
}

impl std::ops::Deref for StudySetup {
    type Target = StudyRecord;

    fn deref(&self) -> &StudyRecord {
        &self.study
    }
}

impl StudyRecord {
    /// Returns the headline of its charts and documents.
    pub fn headline(&self) -> &str {
        self.title.as_deref().unwrap_or(&self.name)
    }
}

/// Returns plain data as JSON text, ending in a newline; a number that is not finite is null.
pub fn json(file: &impl Serialize) -> String {
    // A person does not read longer ones, and the blanks are half of them.
    const MAX_INDENTED: usize = 1 << 20;
    let text = serde_json::to_string(file).expect("plain data");
    let indented = (text.len() < MAX_INDENTED).then(|| serde_json::to_string_pretty(file).expect("plain data"));
    indented.unwrap_or(text) + "\n"
}
