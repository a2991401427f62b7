//! What several test files share.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::LazyLock;

use apportion::EffectEstimates;
use apportion::result::{Named, OutputResult, StudyResult};

/// Ishigami's function where |x3| < 3, and a failure in the other 4.5 % of the rows.
pub const HOLES: &str = "model = \"expression\"\n\
    outputs.y = \"sin(x1) + 7*sin(x2)^2 + 0.1*x3^4*sin(x1) + 0*sqrt(3 - abs(x3))\"\n[factors]\n\
    x1 = { min = -3.14159, max = 3.14159 }\nx2 = { min = -3.14159, max = 3.14159 }\nx3 = { min = -3.14159, max = 3.14159 }\n";

/// A study with a factor of every requested family, some of them truncated; its model is their sum.
pub const FAMILIES: &str = r#"model = "expression"
[outputs]
y = "g + e + p + t + l + a + h + q + n"
[design]
base_samples = 4096
[factors.g]
distribution = "gamma"
mean = 2
sd = 1
[factors.e]
distribution = "exponential"
mean = 1
truncate = [0.5, inf]
[factors.p]
distribution = "poisson"
mean = 4
[factors.t]
distribution = "student-t"
df = 5
location = 0
scale = 1
[factors.l]
distribution = "logistic"
mean = 2
sd = 1
[factors.a]
distribution = "pareto"
shape = 1
min = 1
truncate = [-inf, 4]
[factors.h]
distribution = "histogram"
quantiles = { "0" = 1, "0.5" = 2, "1" = 5 }
[factors.q]
distribution = "histogram"
edges = [0, 1, 3]
weights = [1, 3]
[factors.n]
distribution = "normal"
mean = 0
sd = 1
truncate = [-inf, 0]
"#;

/// A separate folder for a test, with files in it.
pub struct Folder(tempfile::TempDir);

impl Folder {
    /// An empty one.
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    /// A path in it.
    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Writes a file in it.
    pub fn with(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        std::fs::write(&path, content).unwrap();
        path
    }
}

/// Runs the program and returns its output and exit status.
pub fn apportion(arguments: &[&str]) -> Output {
    program().args(arguments).output().unwrap()
}

/// The program, which finds the programs of studies by [`search_path`].
pub fn program() -> assert_cmd::Command {
    let mut command = assert_cmd::Command::cargo_bin("apportion").unwrap();
    command.env("PATH", search_path());
    command
}

/// The search path of programs. It begins with a Python without packages: those of a machine can take four times as long to
/// start as the interpreter, some hundred times a test.
pub fn search_path() -> &'static OsStr {
    static PATH: LazyLock<OsString> = LazyLock::new(|| {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("python");
        if !folder.join("bin/python3").is_file() {
            let made = Command::new("python3").args(["-m", "venv", "--without-pip"]).arg(&folder).status();
            assert!(made.is_ok_and(|status| status.success()), "python3 makes no environment in {}", folder.display());
        }
        let path = std::env::var_os("PATH").unwrap_or_default();
        std::env::join_paths([folder.join("bin")].into_iter().chain(std::env::split_paths(&path))).unwrap()
    });
    &PATH
}

/// Standard error of a program run as text.
pub fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// Standard output of a program run as text.
pub fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// A path as text.
pub fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// The standard output of a successful run of the program.
#[track_caller]
pub fn succeed(arguments: &[&str]) -> String {
    let output = apportion(arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
    stdout(&output)
}

/// Names of the files in a folder, without the hidden lists of results, whose lines have no order.
pub fn files(folder: &Path) -> BTreeSet<String> {
    let names = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    names.filter(|name| !name.ends_with(".written")).collect()
}

/// Every file in `folder` and in its folder of charts, as paths below it.
pub fn all_files(folder: &Path) -> BTreeSet<String> {
    let charts = folder.join("charts");
    let charts = if charts.is_dir() { files(&charts) } else { BTreeSet::new() };
    let others = files(folder).into_iter().filter(|name| name != "charts");
    others.chain(charts.into_iter().map(|name| format!("charts/{name}"))).collect()
}

/// Every such file with its content.
pub fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    all_files(folder).into_iter().map(|name| (name.clone(), std::fs::read(folder.join(name)).unwrap())).collect()
}

/// Runs the study `file` in three parts, each in a folder next to `merged`, and joins them there.
#[track_caller]
pub fn run_in_parts(file: &Path, merged: &Path) {
    let part = |shard: u32| {
        let out = merged.with_extension(format!("shard{shard}"));
        succeed(&["run", text(file), "--shard", &format!("{shard}/3"), "--out", text(&out)]);
        let part = files(&out).into_iter().find(|name| name.contains("shard"));
        out.join(part.expect("the file of a shard"))
    };
    let parts: Vec<PathBuf> = (1..=3).map(part).collect();
    let mut merge = vec!["merge", text(file)];
    merge.extend(parts.iter().map(|part| text(part)));
    merge.extend(["--out", text(merged)]);
    succeed(&merge);
}

/// The folder of the sources.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().find(|folder| folder.join("studies").is_dir()).unwrap()
}

/// A study of this repository.
pub fn study_path(name: &str) -> PathBuf {
    root().join("studies").join(format!("{name}.toml"))
}

/// The result of a study of this repository under overrides.
pub fn analysed(name: &str, overrides: &[&str]) -> StudyResult {
    let overrides: Vec<String> = overrides.iter().map(|text| (*text).to_owned()).collect();
    let study = apportion_files::load_study(&study_path(name), &overrides).unwrap();
    study.run().unwrap()
}

/// The indices of the first output.
pub fn indices(result: &StudyResult) -> &[Named<EffectEstimates>] {
    result.outputs[0].indices.as_deref().unwrap()
}

/// First-order and total indices of the first output as plain numbers.
pub fn numbers(output: &OutputResult) -> (Vec<f64>, Vec<f64>) {
    let indices = output.indices.as_deref().unwrap();
    let first = indices.iter().map(|index| index.effect.first_order.estimate).collect();
    let total = indices.iter().map(|index| index.effect.total.estimate).collect();
    (first, total)
}

/// Largest absolute difference between two lists.
pub fn gap(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// The indices of every factor of an output.
pub fn effects(output: &OutputResult) -> Vec<EffectEstimates> {
    output.indices.iter().flatten().map(|index| index.effect).collect()
}
