//! No process outlives a run, however it ends.

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use super::Case;
use crate::common::{search_path, text};

/// Writes the numbers of its processes to files, answers a few rows, and then does `what`, with a child.
fn worker(what: &str) -> Case {
    Case::each_row(
        "",
        &format!(
            "    if 'child' not in globals():\n        import subprocess\n        child = subprocess.Popen(['sleep', '1000'])\n        \
             open(f'pid-{{os.getpid()}}', 'w')\n        open(f'pid-{{child.pid}}', 'w')\n        n = 0\n    n += 1\n{what}    answer(y)\n"
        ),
    )
}

fn started(case: &Case) -> Child {
    spawn(&["run", text(&case.path("study.toml")), "--out", text(&case.path("out"))])
}

/// The running program.
pub fn spawn(arguments: &[&str]) -> Child {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin("apportion"));
    command.env("PATH", search_path()).args(arguments).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
}

/// The numbers of processes that wrote them to files.
pub fn processes(case: &Case) -> Vec<String> {
    let names =
        std::fs::read_dir(case.path("")).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    names.filter_map(|name| name.strip_prefix("pid-").map(str::to_owned)).collect()
}

/// Alive, and no zombie.
pub fn is_alive(pid: &String) -> bool {
    let stat = std::fs::read_to_string(Path::new("/proc").join(pid).join("stat"));
    stat.is_ok_and(|stat| !stat.rsplit(')').next().is_some_and(|rest| rest.trim_start().starts_with('Z')))
}

#[track_caller]
pub fn within(seconds: u64, what: &str, condition: impl Fn() -> bool) {
    let start = Instant::now();
    while !condition() {
        assert!(start.elapsed() < Duration::from_secs(seconds), "{what}: not within {seconds} s");
        std::thread::sleep(Duration::from_millis(20));
    }
}

pub fn signal(name: &str, child: &Child) {
    let status = Command::new("kill").args([name, &child.id().to_string()]).status().unwrap();
    assert!(status.success());
}

const HANGS: &str = "    if n > 3: time.sleep(1000)\n";

#[test]
fn a_finished_run_leaves_no_process() {
    let case = worker("");
    case.result();
    let all = processes(&case);
    assert!(all.len() >= 2, "{all:?}");
    within(60, "all have ended", || !all.iter().any(is_alive));
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_ends_hanging_programs() {
    let case = worker(HANGS);
    let mut run = started(&case);
    within(60, "two workers hang", || processes(&case).len() >= 4);
    std::thread::sleep(Duration::from_millis(300));
    signal("-INT", &run);
    let start = Instant::now();
    let status = run.wait().unwrap();
    assert!(start.elapsed() < Duration::from_secs(30), "{:?}", start.elapsed());
    assert_eq!(status.code(), Some(1));
    within(60, "all have ended", || !processes(&case).iter().any(is_alive));
}

/// The engine is killed: the system stops its child processes, which do not read their input here.
#[cfg(target_os = "linux")]
#[test]
fn a_killed_engine_takes_its_programs_along() {
    let hangs = "    if n > 3: time.sleep(1000)\n";
    let case = Case::each_row(
        "",
        &format!("    n = globals().get('n', 0) + 1\n    open(f'pid-{{os.getpid()}}', 'w')\n{hangs}    answer(y)\n"),
    );
    let mut run = started(&case);
    within(60, "two workers hang", || processes(&case).len() >= 2);
    std::thread::sleep(Duration::from_millis(300));
    assert!(processes(&case).iter().all(is_alive));
    signal("-KILL", &run);
    run.wait().unwrap();
    within(60, "all have ended", || !processes(&case).iter().any(is_alive));
}

/// A process in a session of its own keeps the program's output open after its end.
#[cfg(target_os = "linux")]
#[test]
fn a_program_that_ends_and_leaves_a_daemon_does_not_hang_the_run() {
    let daemon = "subprocess.Popen(['sleep', '100'], start_new_session=True)";
    let case = Case::each_row(
        "",
        &format!(
            "    if x[0] > 0.9:\n        import subprocess\n        child = {daemon}\n        \
             open(f'pid-{{child.pid}}', 'w')\n        os._exit(1)\n    answer(y)\n"
        ),
    );
    let begun = Instant::now();
    let output = case.run();
    let took = begun.elapsed();
    for pid in processes(&case) {
        Command::new("kill").arg(pid).status().unwrap();
    }
    assert_eq!(output.status.code(), Some(0), "{}", crate::common::stderr(&output));
    assert!(took < Duration::from_secs(90), "{took:?}");
    assert_eq!(case.result_file().outputs[0].runs_failed, super::rows_where(|x| x > 0.9));
}

/// The second signal ends the program at once, and what its programs have started.
#[cfg(target_os = "linux")]
#[test]
fn a_second_signal_leaves_no_process() {
    let case = worker(HANGS).replace("workers = 2", "workers = 1");
    let ignoring = "    import signal; signal.signal(signal.SIGTERM, signal.SIG_IGN)\n";
    let program = std::fs::read_to_string(case.path("model.py")).unwrap();
    case.write("model.py", &program.replace("    n += 1\n", &format!("    n += 1\n{ignoring}")));
    let mut run = started(&case);
    within(60, "a worker hangs", || processes(&case).len() >= 2);
    std::thread::sleep(Duration::from_millis(500));
    signal("-INT", &run);
    // Before the worker has noticed the first one.
    std::thread::sleep(Duration::from_millis(10));
    signal("-INT", &run);
    run.wait().unwrap();
    within(60, "all have ended", || !processes(&case).iter().any(is_alive));
}
