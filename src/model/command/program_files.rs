//! The files that a program is made of, as far as its command names them.

use std::path::{Path, PathBuf};

use regex::Regex;

use super::program::Program;

/// The existing files among the program and its arguments. What a program reads or imports besides is not among them.
pub fn program_files(program: &Program) -> Vec<PathBuf> {
    let arguments = program.arguments.iter().enumerate();
    // A program without a slash is looked for in PATH.
    let arguments = arguments.filter(|(place, _)| *place > 0 || program.file().is_some());
    let paths = arguments.map(|(_, argument)| program.directory.join(argument).components().collect::<PathBuf>());
    let mut files: Vec<PathBuf> = paths.filter(|path| path.is_file()).collect();
    files.dedup();
    files
}

/// Files beside the sources among `files` that these import or include, and that are not among `files`: as far as lines such as
/// `import helper`, `from helper import f`, `source("helper.R")` or `. ./helper.sh` tell.
pub fn imported_neighbours(files: &[PathBuf]) -> Vec<PathBuf> {
    /// Largest source that is looked at.
    const LARGEST: u64 = 1 << 20;
    let Ok(import) = Regex::new(r#"(?m)^\s*(?:import|from|source|include|require|\.)[ \t("']+([\w./, \t-]+)"#) else {
        return Vec::new();
    };
    let mut found = Vec::new();
    for file in files.iter().filter(|file| file.metadata().is_ok_and(|about| about.len() <= LARGEST)) {
        let (Ok(text), Some(folder)) = (std::fs::read_to_string(file), file.parent()) else { continue };
        let ending = file.extension().unwrap_or_default();
        let lists = import.captures_iter(&text).filter_map(|found| found.get(1));
        let names = lists.flat_map(|list| list.as_str().split(',')).filter_map(|name| name.split_whitespace().next());
        for name in names {
            let module = Path::new(name.split('.').next().unwrap_or_default());
            let neighbours = [Path::new(name).to_owned(), module.with_extension(ending), module.join("__init__.py")];
            let neighbours = neighbours.iter().map(|name| folder.join(name).components().collect::<PathBuf>());
            found.extend(neighbours.filter(|path| path.is_file() && !files.contains(path)));
        }
    }
    found.sort_unstable();
    found.dedup();
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The files of a command and those that they import, by their names.
    fn names(arguments: &[&str], files: &[(&str, &str)]) -> [Vec<String>; 2] {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in files {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        }
        let arguments = arguments.iter().map(|argument| (*argument).to_owned()).collect();
        let program = Program { arguments, directory: folder.path().to_owned(), environment: Vec::new() };
        let own = program_files(&program);
        let imported = imported_neighbours(&own);
        [own, imported].map(|files| {
            files.iter().map(|file| file.strip_prefix(folder.path()).unwrap().display().to_string()).collect()
        })
    }

    #[test]
    fn the_files_of_a_command_are_known_and_what_they_import_is_seen() {
        let python = "import os, helper as h\nfrom lib.parts import spring\nfrom math import sin\nprint('plot')\n";
        let files = [("m.py", python), ("helper.py", ""), ("lib/__init__.py", ""), ("plot.py", ""), ("in.dat", "")];
        let [own, imported] = names(&["python3", "./m.py", "in.dat"], &files);
        assert_eq!(
            (own, imported),
            (vec!["m.py".into(), "in.dat".into()], vec!["helper.py".into(), "lib/__init__.py".into()])
        );
        let r = [("m.R", "source(\"f.R\")\nlibrary(MASS)\n"), ("f.R", "")];
        assert_eq!(names(&["Rscript", "m.R"], &r), [vec!["m.R".to_owned()], vec!["f.R".to_owned()]]);
        let shell = [("run.sh", "#!/bin/sh\n. ./f.sh\nexec ./model\n"), ("f.sh", ""), ("model", "")];
        assert_eq!(names(&["./run.sh"], &shell), [vec!["run.sh".to_owned()], vec!["f.sh".to_owned()]]);
        // What is looked for in PATH is not beside the study.
        assert_eq!(names(&["m.R"], &r), [Vec::<String>::new(), Vec::new()]);
    }
}
