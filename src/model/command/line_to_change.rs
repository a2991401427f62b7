//! What a program has to print, in the words of the language that it is written in.

use std::path::Path;

use super::program::Program;
use super::protocol::Protocol;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Language {
    Python,
    C,
    Awk,
    R,
    Julia,
    Matlab,
}

/// The line of `program` that answers a row with its number, where the language is known; else what it prints.
pub(super) fn line_to_change(program: &Program, protocol: Protocol, outputs: &[String]) -> String {
    let line = match (language(program), protocol) {
        (Some(Language::Python), Protocol::Csv) => r#"print(row["id"], y, sep=",", flush=True)"#.to_owned(),
        (Some(Language::Python), Protocol::JsonLines) => {
            let name = serde_json::Value::from(outputs.first().map_or("y", String::as_str));
            format!(r#"print(json.dumps({{"id": row["id"], {name}: y}}), flush=True)"#)
        }
        (Some(Language::C), Protocol::Csv) => r#"printf("%s,%.17g\n", id, y); fflush(stdout);"#.to_owned(),
        (Some(Language::Awk), Protocol::Csv) => r#"print $1 "," y; fflush()"#.to_owned(),
        (Some(Language::R), Protocol::Csv) => {
            r#"cat(row$id, ",", format(y, digits = 17), "\n", sep = ""); flush(stdout())"#.to_owned()
        }
        (Some(Language::Julia), Protocol::Csv) => r#"println(id, ",", y); flush(stdout)"#.to_owned(),
        (Some(Language::Matlab), Protocol::Csv) => r#"fprintf("%s,%.17g\n", id, y);"#.to_owned(),
        (_, Protocol::Csv) => "100000,1.5".to_owned(),
        (_, Protocol::JsonLines) => {
            let name = serde_json::Value::from(outputs.first().map_or("y", String::as_str));
            format!(r#"{{"id": 100000, {name}: 1.5}}"#)
        }
    };
    format!("`{line}`")
}

/// The language by what runs the program, by the ending of a file that its command names, or by a source of the same name.
fn language(program: &Program) -> Option<Language> {
    program.arguments.iter().find_map(|argument| {
        let path = Path::new(argument);
        let part =
            |part: Option<&std::ffi::OsStr>| part.map_or_else(String::new, |part| part.to_string_lossy().into_owned());
        let (name, ending) = (part(path.file_name()), part(path.extension()));
        let has_source = |ending| program.directory.join(path).with_extension(ending).is_file();
        match (name.trim_end_matches(|c: char| c.is_ascii_digit() || c == '.'), ending.as_str()) {
            ("python" | "pypy", _) | (_, "py" | "pyw") => Some(Language::Python),
            ("awk" | "gawk" | "mawk" | "nawk", _) | (_, "awk") => Some(Language::Awk),
            ("Rscript" | "R", _) | (_, "R" | "r") => Some(Language::R),
            ("julia", _) | (_, "jl") => Some(Language::Julia),
            ("octave" | "octave-cli" | "matlab", _) | (_, "m") => Some(Language::Matlab),
            _ if ["c", "cc", "cpp", "cxx"].into_iter().any(has_source) => Some(Language::C),
            _ => None,
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn languages_are_known_by_what_runs_a_program_its_ending_or_its_source() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("model.c"), "int main(void) {}").unwrap();
        for (command, expected) in [
            ("/usr/bin/python3.12 -u model", Some(Language::Python)),
            ("./run.py", Some(Language::Python)),
            ("mawk -W interactive", Some(Language::Awk)),
            ("Rscript model.R", Some(Language::R)),
            ("julia --project model.jl", Some(Language::Julia)),
            ("octave-cli --eval model", Some(Language::Matlab)),
            ("./model", Some(Language::C)),
            ("./other", None),
        ] {
            let arguments = command.split(' ').map(str::to_owned).collect();
            let program = Program { arguments, directory: folder.path().to_owned(), environment: Vec::new() };
            assert_eq!(language(&program), expected, "{command}");
            let line = line_to_change(&program, Protocol::JsonLines, &["y".to_owned()]);
            assert!(line.contains(r#""id": "#) && line.contains(r#""y": "#), "{line}");
        }
    }
}
