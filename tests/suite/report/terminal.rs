//! Tables on a terminal.

#![cfg(unix)]

use std::path::Path;
use std::process::Command;

use crate::common::{Folder, search_path, succeed, text};

/// Runs a program on a terminal of so many columns, and prints what it writes there.
const TERMINAL: &str = "import fcntl, os, pty, struct, sys, termios
pid, screen = pty.fork()
if pid == 0:
    fcntl.ioctl(1, termios.TIOCSWINSZ, struct.pack('HHHH', 24, int(sys.argv[1]), 0, 0))
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    os.execv(sys.argv[2], sys.argv[2:])
while True:
    try:
        part = os.read(screen, 65536)
    except OSError:
        break
    if not part:
        break
    sys.stdout.buffer.write(part)
sys.exit(os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]))
";

/// Seven columns: a name of fifteen letters once was broken inside at 80 columns.
#[test]
fn no_word_or_number_of_a_result_is_broken() {
    let folder = Folder::new();
    let study = folder.with(
        "study.toml",
        "model = \"expression\"\noutputs.y = \"4*decontamination + 2*permeability + velocity\"\n[factors]\n\
         decontamination = { min = 0, max = 1 }\npermeability = { min = 0, max = 1 }\nvelocity = { min = 0, max = 1 }\n\
         [design]\nbase_samples = 64\n",
    );
    let out = folder.path("out");
    let run = ["run", text(&study), "--no-journal", "--charts", "none", "--out", text(&out)];
    let program = assert_cmd::cargo::cargo_bin("apportion");
    let on_terminal = |program: &Path, columns: &str| {
        let mut terminal = Command::new("python3");
        terminal.env("PATH", search_path()).args(["-c", TERMINAL, columns, text(program)]).args(run);
        let output = terminal.output().unwrap();
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stdout).unwrap().replace("\r\n", "\n")
    };
    let wide = succeed(&run);
    let cells: Vec<&str> =
        wide.lines().filter(|line| line.starts_with("  ")).flat_map(|line| line.split("  ")).collect();
    assert!(cells.iter().any(|cell| cell.trim() == "decontamination"), "{wide}");
    for columns in ["60", "100"] {
        let drawn = on_terminal(&program, columns);
        assert_ne!(drawn, wide);
        for cell in &cells {
            // An error stays on the line of its number.
            let words = if cell.contains('±') { vec![cell.trim()] } else { cell.split_whitespace().collect() };
            for word in words {
                assert!(drawn.contains(word), "no {word} at {columns}:\n{drawn}");
            }
        }
    }
    assert_eq!(on_terminal(&program, "200"), wide);
}
