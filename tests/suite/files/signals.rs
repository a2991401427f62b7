//! Signals while files are written, and other objects in place of a file.
#![cfg(unix)]

use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::common::{Folder, all_files, apportion, program, stderr, text};
use crate::messages::messages;

/// A study whose charts take a while: four of each of 11 outputs, twice.
fn many_charts() -> String {
    let outputs: String = (0..11).map(|k| format!("y{k} = \"a + {k} * b\"\n")).collect();
    format!(
        "model = \"expression\"\n[design]\nbase_samples = 256\n[outputs]\n{outputs}[[factor]]\nname = \"a\"\nmin = 0\nmax = 1\n\
         [[factor]]\nname = \"b\"\nmin = 0\nmax = 2\n"
    )
}

/// Every picture is complete, and no file is partly written.
fn assert_whole(folder: &Path) {
    for name in all_files(folder) {
        let bytes = std::fs::read(folder.join(&name)).unwrap();
        let whole = match name.rsplit('.').next().unwrap() {
            "svg" => bytes.ends_with(b"</svg>\n") || bytes.ends_with(b"</svg>"),
            "png" => bytes[..bytes.len() - 4].ends_with(b"IEND"),
            "json" => serde_json::from_slice::<serde_json::Value>(&bytes).is_ok(),
            "html" => String::from_utf8(bytes).unwrap().trim_end().ends_with("</html>"),
            "csv" => bytes.ends_with(b"\n"),
            _ => !name.contains(".apportion-"),
        };
        assert!(whole, "{name}");
    }
}

#[test]
fn a_signal_takes_effect_while_charts_are_drawn() {
    let folder = Folder::new();
    let (study, mut messages) = (folder.with("s.toml", many_charts()), messages!());
    for (signal, moment) in [("-INT", 1), ("-TERM", 8), ("-INT", 16), ("-HUP", 24), ("-TERM", 32)] {
        let out = folder.path(&format!("out{moment}"));
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("apportion"));
        command.args(["run", text(&study), "--out", text(&out), "--no-journal"]);
        let mut run = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        let begun = Instant::now();
        let drawn = || {
            std::fs::read_dir(out.join("charts"))
                .map_or(0, |all| all.flatten().filter(|f| f.path().extension().is_some_and(|e| e == "png")).count())
        };
        while drawn() < moment {
            assert!(begun.elapsed() < Duration::from_secs(120) && run.try_wait().unwrap().is_none());
            std::thread::sleep(Duration::from_millis(5));
        }
        assert!(Command::new("kill").args([signal, &run.id().to_string()]).status().unwrap().success());
        let heard = Instant::now();
        let code = run.wait().unwrap().code();
        // One second is the specification; a busy machine needs longer.
        assert!(heard.elapsed() < Duration::from_secs(30), "{:?}", heard.elapsed());
        let mut said = String::new();
        run.stderr.take().unwrap().read_to_string(&mut said).unwrap();
        assert_eq!(code, Some(1), "{said}");
        messages.add(signal, said.lines().rfind(|line| line.starts_with("error: ")).unwrap());
        assert!(drawn() < 44, "it was stopped before its end");
        assert_whole(&out);
    }
}

#[test]
fn a_journal_or_result_is_a_file() {
    let folder = Folder::new();
    let study = folder.with("s.toml", "model = \"ishigami\"\n[design]\nbase_samples = 64\n");
    let out = folder.path("out");
    std::fs::create_dir(&out).unwrap();
    let run = |more: &[&str]| {
        let arguments = [&["run", text(&study), "--out", text(&out)], more].concat();
        program().args(arguments).timeout(Duration::from_secs(120)).output().unwrap()
    };
    let makers: [fn(&Path); 3] = [
        |path| assert!(Command::new("mkfifo").arg(path).status().unwrap().success()),
        |path| std::fs::create_dir(path).unwrap(),
        |path| std::os::unix::fs::symlink("/dev/null", path).unwrap(),
    ];
    let mut messages = messages!();
    for make in makers {
        let journal = out.join("s.journal");
        make(&journal);
        for more in [&[][..], &["--resume"], &["--restart"], &["--shard", "1/1"]] {
            if more.first() == Some(&"--shard") {
                make(&out.join("s-shard-1-of-1.journal"));
            }
            messages.ended(&more.join(" "), 2, &run(more));
        }
        messages.refused(&["merge", text(&study), "--out", text(&out)]);
        for path in [journal, out.join("s-shard-1-of-1.journal")] {
            if path.is_dir() { std::fs::remove_dir(path).unwrap() } else { std::fs::remove_file(path).unwrap() }
        }
        std::fs::remove_dir_all(&out).unwrap();
        std::fs::create_dir(&out).unwrap();
    }
}

#[test]
#[cfg(unix)]
fn too_many_open_files_end_a_run_with_advice() {
    let folder = Folder::new();
    folder.with("in.txt", "{{a}} {{b}}");
    let factors = "[factors.a]\nmin = 0\nmax = 1\n[factors.b]\nmin = 0\nmax = 1\n";
    for (output, key) in [("outputs = [\"y\"]", ""), ("outputs.y = { regex = '[0-9]' }", "template = \"in.txt\"\n")] {
        let command = "program = [\"sh\", \"-c\", \"sleep 1; echo 1\"]\nworkers = 100";
        let study = format!("model = \"command\"\n{output}\n[command]\n{command}\n{key}{factors}");
        let (study, out) = (folder.with("s.toml", study), folder.path("out"));
        let line = format!("ulimit -n 40; exec \"$0\" run '{}' --out '{}'", text(&study), text(&out));
        let program = assert_cmd::cargo::cargo_bin!("apportion");
        let output = Command::new("sh").args(["-c", &line]).arg(program).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
        assert!(stderr(&output).contains("ulimit -n 4096"), "{}", stderr(&output));
    }
}

/// By default the system stops a program that writes beyond the limit without a message.
#[test]
fn a_file_beyond_the_limit_of_sizes_is_an_error_with_its_reason() {
    let folder = Folder::new();
    let study = folder.with("s.toml", "model = \"ishigami\"\n[design]\nbase_samples = 4096\n");
    let out = folder.path("out");
    for more in ["", "--no-journal"] {
        let line = format!("ulimit -f 16; exec \"$0\" run '{}' --out '{}' {more}", text(&study), text(&out));
        let program = assert_cmd::cargo::cargo_bin!("apportion");
        let output = Command::new("sh").args(["-c", &line]).arg(program).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{more}: {}", stderr(&output));
    }
    assert_whole(&out);
    // With enough space it resumes.
    let output = apportion(&["run", text(&study), "--out", text(&out)]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}
