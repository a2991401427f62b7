//! The files that a program is made of, as far as its command names them.

use std::path::PathBuf;

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

#[cfg(test)]
mod tests {
    use super::*;

    /// The files of a command, by their names.
    fn names(arguments: &[&str], files: &[&str]) -> Vec<String> {
        let folder = tempfile::tempdir().unwrap();
        files.iter().for_each(|name| std::fs::write(folder.path().join(name), "").unwrap());
        let arguments = arguments.iter().map(|argument| (*argument).to_owned()).collect();
        let program = Program { arguments, directory: folder.path().to_owned(), environment: Vec::new() };
        let own = program_files(&program);
        own.iter().map(|file| file.strip_prefix(folder.path()).unwrap().display().to_string()).collect()
    }

    #[test]
    fn the_files_of_a_command_are_known() {
        let files = ["m.py", "helper.py", "in.dat", "run.sh"];
        assert_eq!(names(&["python3", "./m.py", "in.dat"], &files), ["m.py", "in.dat"]);
        assert_eq!(names(&["./run.sh"], &files), ["run.sh"]);
        // What is looked for in PATH is not beside the study.
        assert!(names(&["m.py"], &files).is_empty());
    }
}
