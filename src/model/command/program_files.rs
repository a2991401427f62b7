//! The files that a program is made of, as far as its command and its own sources name them.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use super::program::Program;

/// Endings of files that hold programs. Data files are not looked for in sources: a program may write what it names.
const SOURCES: [&str; 17] =
    ["awk", "bash", "jl", "js", "lua", "m", "mjs", "pl", "py", "pyw", "r", "rb", "sh", "tcl", "ts", "zsh", "R"];

/// Largest source that is read for the files that it names.
const LARGEST: u64 = 1 << 20;

/// Most files that are followed.
const MOST: usize = 1000;

/// The existing files among the program and its arguments, and those that they name: programs and sources in the words of the
/// command and of its sources, and modules that Python sources import, beside the file that names them or where the program runs.
/// What a program finds in another way (by its environment, or a path that it puts together) is not among them.
pub fn program_files(program: &Program) -> Vec<PathBuf> {
    let mut found = Found::default();
    for (place, argument) in program.arguments.iter().enumerate() {
        let path = program.directory.join(argument);
        // A program without a slash is looked for in PATH.
        if path.is_file() && (place > 0 || program.file().is_some()) {
            found.add(path);
            continue;
        }
        let is_module = place > 0 && program.arguments[place - 1] == "-m";
        if is_module {
            found.add_module(argument, &[&program.directory]);
        } else if place > 0 {
            found.add_named(argument, &[&program.directory]);
        }
    }
    let beside: Vec<PathBuf> = found.files.iter().filter_map(|file| Some(file.parent()?.to_owned())).collect();
    let mut next = 0;
    while next < found.files.len() && found.files.len() < MOST {
        let file = found.files[next].clone();
        next += 1;
        let Some(text) = source(&file) else { continue };
        let own = file.parent().map(Path::to_owned);
        let folders: Vec<&Path> =
            own.iter().chain(&beside).map(PathBuf::as_path).chain([program.directory.as_path()]).collect();
        found.add_named(&text, &folders);
        if is_python(&file, &text) {
            for module in imported(&text) {
                found.add_module(&module, &folders);
            }
        }
    }
    found.files
}

/// The text of a file that may be a source: small, and text.
fn source(path: &Path) -> Option<String> {
    if path.metadata().ok()?.len() > LARGEST {
        return None;
    }
    let mut text = String::new();
    File::open(path).ok()?.take(LARGEST).read_to_string(&mut text).ok()?;
    (has_ending(path) || text.starts_with("#!")).then_some(text)
}

fn has_ending(path: &Path) -> bool {
    path.extension().and_then(|ending| ending.to_str()).is_some_and(|ending| SOURCES.contains(&ending))
}

fn is_python(path: &Path, text: &str) -> bool {
    let ending = path.extension().and_then(|ending| ending.to_str());
    matches!(ending, Some("py" | "pyw")) || text.lines().next().is_some_and(|line| line.contains("python"))
}

/// The modules that a Python source imports, with dots: `a.b` and `a.b.c` of `from a.b import c`; relative ones without the dots
/// in front.
fn imported(text: &str) -> Vec<String> {
    let mut modules = Vec::new();
    for line in text.lines() {
        let mut words = line.trim_start().splitn(2, char::is_whitespace);
        match (words.next(), words.next()) {
            (Some("import"), Some(list)) => modules.extend(list.split(',').map(first_word)),
            (Some("from"), Some(rest)) => {
                let Some((module, names)) = rest.split_once(" import") else { continue };
                let module = module.trim().trim_start_matches('.').to_owned();
                let inside = |name: &str| {
                    if module.is_empty() { first_word(name) } else { format!("{module}.{}", first_word(name)) }
                };
                modules.extend(names.trim_matches(['(', ')', ' ']).split(',').map(inside));
                modules.push(module);
            }
            _ => (),
        }
    }
    modules.retain(|module| !module.is_empty());
    modules
}

fn first_word(text: &str) -> String {
    text.split_whitespace().next().unwrap_or("").trim_matches(['(', ')', ';', '\\']).to_owned()
}

/// Files in the order in which they were found, each once.
#[derive(Default)]
struct Found {
    files: Vec<PathBuf>,
    known: BTreeSet<PathBuf>,
}

impl Found {
    fn add(&mut self, path: PathBuf) {
        let path: PathBuf = path.components().collect();
        if self.files.len() < MOST && self.known.insert(path.clone()) {
            self.files.push(path);
        }
    }

    /// The programs and sources that a word of `text` names.
    fn add_named(&mut self, text: &str, folders: &[&Path]) {
        let is_part = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '.' | '/' | '+');
        let words: BTreeSet<&str> = text.split(|c| !is_part(c)).map(|word| word.trim_end_matches('.')).collect();
        for folder in folders {
            let names = names_in(folder);
            for word in &words {
                // One look at the folder spares one at the disk for every word.
                let first = word.trim_start_matches("./").split('/').next().unwrap_or("");
                let may_be = word.starts_with(['/']) || first == ".." || names.contains(&OsString::from(first));
                let path = folder.join(word);
                if may_be && !first.is_empty() && path.is_file() && (has_ending(&path) || is_executable(&path)) {
                    self.add(path);
                }
            }
        }
    }

    /// The files of a Python module, if it lies in one of the folders.
    fn add_module(&mut self, module: &str, folders: &[&Path]) {
        let parts: Vec<&str> = module.split('.').collect();
        for folder in folders {
            let mut path = folder.to_path_buf();
            for part in &parts {
                path.push(part);
                let files = [path.with_extension("py"), path.join("__init__.py")];
                files.into_iter().filter(|file| file.is_file()).for_each(|file| self.add(file));
            }
            let main = path.join("__main__.py");
            if main.is_file() {
                self.add(main);
            }
        }
    }
}

fn names_in(folder: &Path) -> BTreeSet<OsString> {
    std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.file_name()).collect()
}

#[cfg(unix)]
fn is_executable(path: &Path) -> bool {
    use std::os::unix::fs::PermissionsExt;
    path.metadata().is_ok_and(|about| about.permissions().mode() & 0o111 != 0)
}

#[cfg(not(unix))]
fn is_executable(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "exe")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(arguments: &[&str], files: &[(&str, &str)]) -> Vec<String> {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in files {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        }
        let arguments = arguments.iter().map(|argument| (*argument).to_owned()).collect();
        let program = Program { arguments, directory: folder.path().to_owned(), environment: Vec::new() };
        let name = |file: &PathBuf| file.strip_prefix(folder.path()).unwrap().display().to_string();
        let mut names: Vec<String> = program_files(&program).iter().map(name).collect();
        names.sort();
        names
    }

    #[test]
    fn modules_that_are_imported_belong_to_a_program() {
        let files = [
            (
                "m.py",
                "import os, helper as h\nfrom lib.parts import (spring,\n  mass)\nfrom . import near\nprint('plot')\n",
            ),
            ("helper.py", "import deep\n"),
            ("deep.py", ""),
            ("near.py", ""),
            ("plot.py", ""),
            ("lib/__init__.py", ""),
            ("lib/parts/spring.py", ""),
            ("lib/parts/mass.py", ""),
        ];
        let of_script = names(&["python3", "m.py"], &files);
        assert_eq!(of_script, ["deep.py", "helper.py", "lib/__init__.py", "lib/parts/spring.py", "m.py", "near.py"]);
        assert_eq!(names(&["python3", "-m", "helper"], &files), ["deep.py", "helper.py"]);
        assert_eq!(names(&["python3", "-m", "lib"], &files), ["lib/__init__.py"]);
    }

    #[test]
    fn programs_that_a_command_or_a_script_names_belong_to_it_and_what_it_writes_does_not() {
        let files = [
            ("run.sh", "#!/bin/sh\nexec python3 ./k.py > out.csv 2>log.txt\n"),
            ("k.py", ""),
            ("out.csv", "1"),
            ("log.txt", ""),
        ];
        assert_eq!(names(&["./run.sh"], &files), ["k.py", "run.sh"]);
        assert_eq!(names(&["sh", "-c", "exec python3 k.py"], &files), ["k.py"]);
        // What is looked for in PATH is not beside the study.
        assert_eq!(names(&["k.py", "out.csv"], &files), ["out.csv"]);
    }

    #[test]
    fn sources_that_name_each_other_come_to_an_end() {
        assert_eq!(names(&["python3", "a.py"], &[("a.py", "import b"), ("b.py", "import a, b")]), ["a.py", "b.py"]);
    }
}
