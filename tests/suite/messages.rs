//! What the program says: the wording of every message that a test provokes, in `messages.txt`, with a section for each test.
//!
//! `INSTA_UPDATE=always cargo test --release --test suite` writes the sections of the tests that run.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Output;
use std::sync::{Mutex, PoisonError};

use crate::common::{Folder, apportion, root, stderr, text};

/// The messages of a test, by case, which are held against its section at their end.
pub struct Messages {
    section: String,
    text: String,
    last: String,
}

/// The messages of the test that says so.
macro_rules! messages {
    () => {{
        fn here() {}
        $crate::messages::Messages::new(std::any::type_name_of_val(&here))
    }};
}
pub(crate) use messages;

impl Messages {
    /// None yet, of a test whose function `here` has this name.
    pub fn new(here: &str) -> Self {
        let name = here.trim_end_matches("::here").replace("::{{closure}}", "");
        Self { section: name.trim_start_matches("suite::").to_owned(), text: String::new(), last: String::new() }
    }

    /// Adds what is said in a case, without the names of folders of this computer and of this run, and without times.
    pub fn add(&mut self, case: &str, message: &str) {
        let case = case.replace('\n', "\\n");
        let lines = message.trim_end().lines().filter(|line| !line.ends_with(" runs/s)"));
        let message = match without_folders(&lines.collect::<Vec<_>>().join("\n")) {
            nothing if nothing.is_empty() => "(nothing)\n".to_owned(),
            message => message + "\n",
        };
        // Cases in a row of which the same is said have it once.
        if message == self.last {
            self.text.truncate(self.text.len() - message.len());
        }
        self.text += &format!("-- {}\n{message}", without_folders(case.trim_end()));
        self.last = message;
    }

    /// Adds what a command has printed: headings, sentences and names of columns that are new in this test, without numbers, rows
    /// of tables, and what depends on the speed of the computer.
    pub fn add_printed(&mut self, case: &str, printed: &str) {
        let (mut rules, mut new) = (0, String::new());
        for line in printed.lines() {
            rules += usize::from(line.starts_with('─'));
            // The first of the three rules of a table stands above the names of its columns.
            let is_cell = line.starts_with("  ") && rules % 3 != 1;
            let is_cost = ["cost: ", "disk: ", "fewer runs: "].iter().any(|start| line.starts_with(start));
            let words = line.split_whitespace().map(without_number).collect::<Vec<_>>().join(" ");
            let is_known = words.is_empty() || self.text.lines().chain(new.lines()).any(|known| known == words);
            if !(line.starts_with('─') || is_cell || is_cost || is_known) {
                new += &(words + "\n");
            }
        }
        self.add(case, &new);
    }

    /// A run of the program has ended with this exit code, and says why.
    #[track_caller]
    pub fn ended(&mut self, case: &str, code: i32, output: &Output) {
        let message = stderr(output);
        assert_eq!(output.status.code(), Some(code), "{case}: {message}");
        assert!(code == 0 || !message.is_empty(), "{case}: no reason");
        self.add(case, &message);
    }

    /// The program refuses these arguments: with exit code 2, and without a word where results are printed.
    #[track_caller]
    pub fn refused(&mut self, arguments: &[&str]) -> String {
        self.refused_as(&arguments.join(" "), arguments)
    }

    /// The same under another name than the command line.
    #[track_caller]
    pub fn refused_as(&mut self, case: &str, arguments: &[&str]) -> String {
        let output = apportion(arguments);
        self.ended(case, 2, &output);
        assert!(output.stdout.is_empty(), "{arguments:?}");
        stderr(&output)
    }

    /// A study that is read without its folder is refused at this line and column.
    #[track_caller]
    pub fn unparsed(&mut self, case: &str, study: &str, place: &str) {
        let Err(error) = apportion_files::parse_study(study, Path::new("s.toml"), &[]) else {
            panic!("{case}: no fault")
        };
        let message = error.to_string();
        assert!(message.starts_with(&format!("s.toml:{place}: ")), "{case}: not at {place}: {message}");
        self.add(case, &message);
    }

    /// `check` and `run` refuse a study alike, at this line and column, and leave nothing behind.
    #[track_caller]
    pub fn refused_study(&mut self, folder: &Folder, case: &str, study: &str, place: &str) {
        let (path, out) = (folder.with("study.toml", study), folder.path("out"));
        let output = apportion(&["check", text(&path)]);
        self.ended(case, 2, &output);
        let message = stderr(&output);
        assert!(message.contains(&format!("study.toml:{place}: ")), "{case}: not at {place}: {message}");
        let run = apportion(&["run", text(&path), "--out", text(&out)]);
        assert_eq!((run.status.code(), stderr(&run)), (Some(2), message), "{case}");
        assert!(!out.exists(), "{case}: a refused study leaves nothing behind");
    }

    /// A study that is right is refused after each of these changes, at the place of the fault: from, to, line and column.
    #[track_caller]
    pub fn spoilt(&mut self, folder: &Folder, good: &str, changes: &[(&str, &str, &str)]) {
        for (from, to, place) in changes {
            assert!(good.contains(from), "{from}");
            self.refused_study(folder, &format!("{from} -> {to}"), &good.replacen(from, to, 1), place);
        }
    }
}

impl Drop for Messages {
    fn drop(&mut self) {
        if std::thread::panicking() {
            return;
        }
        static WRITTEN: Mutex<()> = Mutex::new(());
        let _alone = WRITTEN.lock().unwrap_or_else(PoisonError::into_inner);
        let mut sections = sections();
        let held = sections.insert(self.section.clone(), self.text.clone()).unwrap_or_default();
        if held == self.text {
            return;
        }
        if std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
            let all = sections.iter().map(|(section, text)| format!("{SECTION}{section}\n{text}"));
            std::fs::write(file(), all.collect::<Vec<_>>().join("\n")).unwrap();
            return;
        }
        let same = held.lines().zip(self.text.lines()).take_while(|(held, found)| held == found).count();
        let rest = |text: &str| text.lines().skip(same.saturating_sub(2)).take(12).collect::<Vec<_>>().join("\n");
        panic!(
            "{}: other words than in tests/suite/messages.txt (INSTA_UPDATE=always writes them):\n{}\nnot\n{}",
            self.section,
            rest(&self.text),
            rest(&held)
        );
    }
}

const SECTION: &str = "==== ";

fn file() -> PathBuf {
    root().join("tests/suite/messages.txt")
}

/// The messages that were reviewed, by test.
fn sections() -> BTreeMap<String, String> {
    let all = std::fs::read_to_string(file()).unwrap_or_default();
    let mut sections = BTreeMap::new();
    for section in format!("\n{all}").split(&format!("\n{SECTION}")).skip(1) {
        let (name, text) = section.split_once('\n').unwrap();
        sections.insert(name.to_owned(), text.trim_end().to_owned() + "\n");
    }
    sections
}

/// A word with # in the place of a number.
fn without_number(word: &str) -> String {
    let start = word.trim_start_matches(['(', '[', '±', '−', '-', '<', '>']);
    if !start.starts_with(|c: char| c.is_ascii_digit()) {
        return word.to_owned();
    }
    let end = start.trim_end_matches([')', ']', ',', ';', ':', '.', '%']);
    format!("{}#{}", &word[..word.len() - start.len()], &start[end.len()..])
}

/// Folders of tests as FOLDER, and that of the sources as ROOT.
fn without_folders(message: &str) -> String {
    let start = std::env::temp_dir().join(".tmp");
    let mut parts = message.split(text(&start));
    let first = parts.next().unwrap().to_owned();
    // Six letters that tempfile draws.
    parts.fold(first, |all, part| all + "FOLDER" + &part[6..]).replace(text(root()), "ROOT")
}

#[test]
fn every_section_is_that_of_a_test() {
    for section in sections().keys() {
        let (module, test) = section.rsplit_once("::").unwrap();
        let path = root().join("tests/suite").join(module.replace("::", "/")).with_extension("rs");
        let source = std::fs::read_to_string(path).unwrap_or_default();
        let body = source.split(&format!("fn {test}(")).nth(1).and_then(|rest| rest.split("\n}\n").next());
        assert!(body.is_some_and(|body| body.contains("messages!()")), "messages.txt: no messages of a test {section}");
    }
}
