//! `apportion given-data` through the program.

use std::path::PathBuf;

use apportion::given::Measure;
use apportion_base::digest::sha256;
use apportion_report::given::GivenFile;
use apportion_report::screening::ScreeningFile;

use crate::common::{Folder, apportion, stderr, stdout, text};
use crate::engine::points::{Columns, random, saltelli, shuffled, sobol, trajectories};
use crate::messages::{Messages, messages};

/// A table of the columns and of their linear combination 3, 2, 1, ... as `y`.
fn table(columns: &Columns) -> String {
    let mut text: String = (1..=columns.len()).map(|j| format!("x{j},")).collect::<String>() + "y\n";
    for row in 0..columns[0].len() {
        let x = columns.iter().map(|column| column[row]);
        let y: f64 = x.clone().enumerate().map(|(j, x)| (columns.len() - j) as f64 * x).sum();
        x.for_each(|x| text.push_str(&format!("{x},")));
        text.push_str(&format!("{y}\n"));
    }
    text
}

struct Run {
    folder: tempfile::TempDir,
    output: std::process::Output,
}

impl Run {
    fn of(content: &str, more: &[&str]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.csv");
        std::fs::write(&path, content).unwrap();
        let out = folder.path().join("out");
        let output = apportion(&[&["given-data", text(&path), "--out", text(&out)], more].concat());
        Self { folder, output }
    }

    fn out(&self) -> PathBuf {
        self.folder.path().join("out")
    }

    #[track_caller]
    fn refused(&self, messages: &mut Messages, case: &str) {
        messages.ended(case, 2, &self.output);
        assert!(!self.out().exists(), "a refused table leaves nothing behind");
    }

    #[track_caller]
    fn result(&self) -> GivenFile {
        assert_eq!(self.output.status.code(), Some(0), "{}", stderr(&self.output));
        serde_json::from_slice(&std::fs::read(self.out().join("table.json")).unwrap()).unwrap()
    }
}

#[test]
fn a_table_becomes_a_result() {
    let content = table(&random(3, 500, 2));
    let run = Run::of(&content, &["--outputs", "y"]);
    let result = run.result();
    assert_eq!((result.format.as_str(), result.version, result.table.rows), ("apportion-given-data", 1, 500));
    assert!(result.warnings.is_empty() && result.notes.len() == 3, "{:?}", result.warnings);
    let output = &result.outputs[0];
    assert_eq!(output.distribution.as_ref().unwrap().count, 500);
    for (index, exact) in output.indices.as_ref().unwrap().iter().zip([9.0, 4.0, 1.0]) {
        let rank = index.rank.unwrap();
        // Four standard errors.
        let width = rank.interval.unwrap().high - rank.interval.unwrap().low;
        assert!((rank.estimate - exact / 14.0).abs() < width && width < 0.2, "{index:?}");
    }
    messages!().add_printed("given-data", &stdout(&run.output));
    let csv = std::fs::read_to_string(run.out().join("table-indices.csv")).unwrap();
    assert_eq!(csv.lines().count(), 4);
    for chart in ["table.svg", "table.png"] {
        assert!(run.out().join("charts").join(chart).is_file());
    }
    // A repetition gives the same bytes, for any threads and time.
    let again = Run::of(&content, &["--outputs", "y"]);
    let bytes = |run: &Run, name: &str| std::fs::read(run.out().join(name)).unwrap();
    assert_eq!(bytes(&run, "charts/table.svg"), bytes(&again, "charts/table.svg"));
    assert_eq!(result.outputs, again.result().outputs);
}

#[test]
fn columns_are_chosen() {
    let content = table(&random(3, 100, 2));
    let result = Run::of(&content, &["--outputs", "y,x3", "--inputs", "x2,x1"]).result();
    assert_eq!(result.inputs.iter().map(|input| input.name.as_str()).collect::<Vec<_>>(), ["x2", "x1"]);
    let output = &result.outputs[1];
    assert_eq!(output.name, "x3");
    let index = &output.indices.as_ref().unwrap()[0];
    assert!(index.rank.is_some() && index.binned.bins == 6);
    let mut messages = messages!();
    for more in [&["--outputs", "z"][..], &["--outputs", "y,,"], &[]] {
        Run::of(&content, more).refused(&mut messages, &more.join(" "));
    }
}

#[test]
fn faults_are_refused_with_their_place() {
    let content = table(&random(2, 40, 2));
    let spoilt = |line: usize, cells: &str| {
        let lines = content.lines().enumerate();
        lines.map(|(k, text)| format!("{}\n", if k + 1 == line { cells } else { text })).collect::<String>()
    };
    let mut messages = messages!();
    for (table, place) in [
        (spoilt(7, "0.5,,1"), "table.csv: line 7: column 2 (`x2`): "),
        (spoilt(9, "0.5,red,1"), "line 9: column 2 (`x2`): "),
        (spoilt(9, "0.5,1"), "line 9: "),
        ("x,y\n1.5,2\n".to_owned(), ""),
    ] {
        let run = Run::of(&table, &["--outputs", "y"]);
        run.refused(&mut messages, place);
        assert!(stderr(&run.output).contains(place), "not at {place}");
    }
    let result = Run::of(&spoilt(7, "0.5,NaN,1"), &["--outputs", "y", "--drop-missing"]).result();
    assert_eq!((result.table.rows, result.table.rows_dropped, result.table.first_dropped_line), (39, 1, Some(7)));
    messages.add("--drop-missing", &result.warnings[0]);
}

#[test]
fn rows_that_are_no_independent_draws_are_refused_or_warned_of() {
    let content = table(&sobol(3, 256, 1));
    let result = Run::of(&content, &["--outputs", "y"]).result();
    assert_eq!(result.table.points, "too-even");
    let mut messages = messages!();
    messages.add("a net", &result.warnings[0]);
    let index = &result.outputs[0].indices.as_ref().unwrap()[0];
    let binned = index.binned.estimate;
    assert!(index.rank.is_none() && binned.interval.is_none());
    // 16 bins lose 1/256 of a linear effect; means over a net are exact to 1e-3.
    assert!((binned.estimate - 9.0 / 14.0).abs() < 0.006, "{binned:?}");
    let design = table(&saltelli(3, 64, apportion::design::Sampler::Sobol, 1));
    Run::of(&design, &["--outputs", "y"]).refused(&mut messages, "a design of Saltelli");
}

#[test]
fn morris_trajectories_are_a_screening() {
    let columns = trajectories(10, 16, 4, 1);
    let run = Run::of(&table(&columns), &["--outputs", "y"]);
    assert_eq!(run.output.status.code(), Some(0), "{}", stderr(&run.output));
    let file: ScreeningFile =
        serde_json::from_slice(&std::fs::read(run.out().join("table-screen.json")).unwrap()).unwrap();
    assert_eq!((file.provenance.trajectories, file.provenance.seed), (16, None));
    for (factor, slope) in file.outputs[0].factors.iter().zip((1..=10).rev()) {
        let [mu, mu_star, sigma] = [factor.mu, factor.mu_star, factor.sigma].map(|of| of.unwrap());
        // The range has three steps.
        assert!((mu.estimate - 3.0 * f64::from(slope)).abs() < 1e-9 && (mu_star.estimate - mu.estimate).abs() < 1e-9);
        assert!(sigma.estimate < 1e-9 && mu_star.interval.is_some() && factor.effects == 16);
    }
    let mut messages = messages!();
    let repeated: Columns = random(3, 40, 1).iter().map(|of| of.iter().flat_map(|x| [*x; 4]).collect()).collect();
    Run::of(&table(&repeated), &["--outputs", "y"]).refused(&mut messages, "four times each row");
    Run::of(&table(&shuffled(columns.clone(), 1)), &["--outputs", "y"]).refused(&mut messages, "shuffled");
    Run::of(&table(&columns), &["--outputs", "y", "--measures"]).refused(&mut messages, "with measures");
}

#[test]
fn two_classes_are_zero_and_one() {
    let columns = random(2, 60, 2);
    let classes = |[no, yes]: [&str; 2]| {
        let class = |k: usize| if columns[0][k] > 0.4 { yes } else { no };
        let line = |k: usize| format!("{},{},{}\n", columns[0][k], columns[1][k], class(k));
        let table = format!("a,b,y\n{}", (0..60).map(line).collect::<String>());
        Run::of(&table, &["--outputs", "y"]).result().outputs
    };
    for words in [["invalid", "valid"], ["No", "Yes"], ["FALSE", "true"]] {
        assert_eq!(classes(words), classes(["0", "1"]));
    }
}

#[test]
fn replicates_are_averaged_and_series_are_not_inputs() {
    let columns = random(3, 500, 4);
    let row = |k: usize, number: usize| {
        let [a, b, noise] = [columns[0][k], columns[1][k], columns[2][(5 * k + number) % 500]];
        format!("{a},{b},{number},{}\n", 3.0 * a + b + noise)
    };
    let rows: String = (0..100).flat_map(|k| (0..5).map(move |number| (k, number))).map(|(k, n)| row(k, n)).collect();
    let run = Run::of(&format!("a,b,seed,y\n{rows}"), &["--outputs", "y"]);
    let result = run.result();
    assert_eq!((result.table.rows, result.inputs.len()), (100, 2));
    let mut messages = messages!();
    messages.add("replicates", &result.warnings[0]);
    Run::of(&format!("a,b,t,y\n{rows}"), &["--outputs", "y"]).refused(&mut messages, "a series");
}

#[test]
fn a_number_of_the_run_is_no_input() {
    let content = table(&random(2, 100, 2));
    let plain = Run::of(&content, &["--outputs", "y"]).result();
    let mut lines: Vec<String> = content.lines().skip(1).enumerate().map(|(k, line)| format!("{k},{line}\n")).collect();
    lines.sort_by_key(|line| line.len() + line.bytes().map(usize::from).sum::<usize>() % 7);
    let mut messages = messages!();
    for name in ["", "run_id", "%eval_id"] {
        let numbered = format!("{name},x1,x2,y\n{}", lines.concat());
        let result = Run::of(&numbered, &["--outputs", "y"]).result();
        assert_eq!(result.outputs, plain.outputs);
        messages.add(name, &result.warnings[0]);
    }
    let only: String = (0..50).map(|k| format!("{},{}\n", k * 7 % 50, k % 13)).collect();
    Run::of(&format!("run,y\n{only}"), &["--outputs", "y"]).refused(&mut messages, "nothing else");
}

#[test]
fn outputs_may_be_in_a_file_of_their_own() {
    let content = table(&random(2, 100, 2));
    let together = Run::of(&content, &["--outputs", "y"]).result();
    let folder = Folder::new();
    let lines = content.lines().map(|line| line.rsplit_once(',').unwrap()).enumerate();
    let (inputs, outputs): (Vec<String>, Vec<String>) = lines
        .map(|(k, (x, y))| match k {
            0 => (format!(",{x}\n"), format!(",{y},other\n")),
            k => (format!("{k},{x}\n"), format!("{k},{y},text\n")),
        })
        .unzip();
    let file = folder.with("y.csv", outputs.concat());
    let apart = Run::of(&inputs.concat(), &["--outputs", "y", "--outputs-from", text(&file)]);
    let result = apart.result();
    assert_eq!((result.inputs, result.outputs), (together.inputs.clone(), together.outputs.clone()));
    let both = sha256((inputs.concat() + &outputs.concat()).as_bytes());
    assert!(result.table.sha256 == both && result.table.file.ends_with("y.csv"), "{}", result.table.file);
    // Without headers, as NumPy writes them.
    let bare = |cells: &[String], from: usize, to: usize| -> String {
        let cell = |line: &String| line.trim().split(',').skip(from).take(to - from).collect::<Vec<_>>().join(" ");
        cells[1..].iter().map(|line| cell(line) + "\n").collect()
    };
    let file = folder.with("y.txt", bare(&outputs, 1, 2));
    let names = ["--names", "x1,x2", "--outputs", "y", "--outputs-from", text(&file)];
    assert_eq!(Run::of(&bare(&inputs, 1, 3), &names).result().outputs, together.outputs);
    let mut messages = messages!();
    for (case, outputs, output) in [
        ("fewer rows", outputs[..90].concat(), "y"),
        ("more rows", outputs.concat() + "101,1,text\n", "y"),
        ("an input again", outputs.concat().replace("other", "x1"), "x1"),
        ("no such output", outputs.concat(), "z"),
    ] {
        let file = folder.with("y.csv", outputs);
        let run = Run::of(&inputs.concat(), &["--outputs", output, "--outputs-from", text(&file)]);
        run.refused(&mut messages, case);
    }
}

#[test]
fn values_that_may_mark_failed_runs_are_one_warning() {
    let columns = random(3, 1000, 6);
    let line = |k: usize, code: f64| {
        let [a, b, c] = [columns[0][k], columns[1][k], columns[2][k]];
        let (y, z) = if c < 0.03 { (code, code) } else { (3.0 * a + b, a * b) };
        format!("{a},{b},{y},{z}\n")
    };
    let mut messages = messages!();
    for code in [-99.0, -1.0, 1.7] {
        let rows: String = (0..1000).map(|k| line(k, code)).collect();
        let result = Run::of(&format!("a,b,y,z\n{rows}"), &["--outputs", "y,z"]).result();
        messages.add(&code.to_string(), &result.warnings.join("\n"));
    }
    // A limit at which an output is cut is none.
    let cut: String = (0..1000)
        .map(|k| format!("{},{},{}\n", columns[0][k], columns[1][k], (columns[0][k] - 0.2).max(0.0)))
        .collect();
    assert!(Run::of(&format!("a,b,y\n{cut}"), &["--outputs", "y"]).result().warnings.is_empty());
    // Few rows with all of the variance.
    let heavy: String =
        (0..1000).map(|k| format!("{},{},{}\n", columns[0][k], columns[1][k], columns[0][k].powi(-2))).collect();
    messages
        .add("a heavy tail", &Run::of(&format!("a,b,y\n{heavy}"), &["--outputs", "y"]).result().outputs[0].warnings[0]);
    // Every word for no number is a missing value.
    let words = ["inf", "-Infinity", "1.#INF", "-1.#IND", "nan(ind)", "NaNQ"];
    let with_words = words.iter().map(|word| format!("0.1,0.2,{word}\n")).collect::<String>();
    let result = Run::of(&format!("a,b,y\n{cut}{with_words}"), &["--outputs", "y", "--drop-missing"]).result();
    assert_eq!(result.table.rows_dropped, 6);
    Run::of(&format!("a,b,y\n{cut}{with_words}"), &["--outputs", "y"]).refused(&mut messages, "an infinity");
}

#[test]
fn an_output_that_does_not_vary_has_no_indices_but_a_reason() {
    let plain = table(&random(2, 60, 3));
    let extended = |line: &str| line.to_owned() + if line.ends_with('y') { ",c\n" } else { ",7\n" };
    let run = Run::of(&plain.lines().map(extended).collect::<String>(), &["--outputs", "y,c"]);
    let result = run.result();
    assert!(result.outputs[0].indices.is_some());
    assert!(result.outputs[1].indices.is_none());
    messages!().add("a constant", result.outputs[1].reason.as_ref().unwrap());
}

#[cfg(unix)]
#[test]
fn the_table_is_never_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a-indices.csv");
    std::fs::write(&path, table(&random(2, 60, 3))).unwrap();
    let twin = folder.path().join("a.csv");
    std::os::unix::fs::symlink(&path, &twin).unwrap();
    let output = apportion(&["given-data", text(&twin), "--outputs", "y", "--out", text(folder.path())]);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    assert!(std::fs::read_to_string(&path).unwrap().starts_with("x1,x2,y"));
}

#[test]
fn a_surrogate_adds_total_indices() {
    let content = table(&random(3, 300, 4));
    let run = Run::of(&content, &["--outputs", "y"]);
    let result = run.result();
    let surrogate = &result.surrogate;
    assert_eq!((surrogate.rows, surrogate.distributions.as_deref()), (Some(300), Some("columns")));
    let of = result.outputs[0].surrogate.as_ref().unwrap();
    assert!(of.serves && of.unknown < 1e-12, "{}", of.unknown);
    for (index, exact) in of.indices.iter().zip([9.0, 4.0, 1.0]) {
        let (low, high) = (index.total.interval.unwrap().low, index.total.interval.unwrap().high);
        assert!(low <= exact / 14.0 && exact / 14.0 <= high && high - low < 0.15, "{index:?}");
    }
    // What is left is nothing, of which nothing is said.
    messages!().add_printed("a surrogate", &stdout(&run.output));
    let csv = std::fs::read_to_string(run.out().join("table-indices.csv")).unwrap();
    assert!(
        csv.starts_with("output,input,first_order,") && csv.lines().next().unwrap().ends_with("surrogate_unknown"),
        "{csv}"
    );
}

#[test]
fn distributions_come_from_the_study() {
    let study = |max: f64| {
        let factors: String = (1..=3).map(|j| format!("[[factor]]\nname = \"x{j}\"\nmin = 0\nmax = {max}\n")).collect();
        format!("model = \"expression\"\n[outputs]\ny = \"3*x1 + 2*x2 + x3\"\n{factors}")
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("study.toml");
    std::fs::write(&path, study(1.0)).unwrap();
    let content = table(&random(3, 200, 4));
    let with_study = ["--outputs", "y", "--study", text(&path)];
    let result = Run::of(&content, &with_study).result();
    for (index, exact) in result.outputs[0].surrogate.as_ref().unwrap().indices.iter().zip([9.0, 4.0, 1.0]) {
        assert!((index.first_order.estimate - exact / 14.0).abs() < 1e-9, "{index:?}");
    }
    assert_eq!(result.surrogate.distributions.as_deref(), Some("given"));
    std::fs::write(&path, study(2.0)).unwrap();
    let result = Run::of(&content, &with_study).result();
    let mut messages = messages!();
    messages.add("another distribution", &result.warnings[0]);
    assert!(result.outputs[0].surrogate.is_none() && result.outputs[0].indices.is_some());
    std::fs::write(&path, study(1.0).replace("x3", "x4")).unwrap();
    Run::of(&content, &with_study).refused(&mut messages, "an input that is no factor");
}

#[test]
fn a_useless_surrogate_gives_a_warning() {
    let columns = random(4, 200, 4);
    let mut content = "x1,x2,y\n".to_owned();
    (0..200).for_each(|k| content.push_str(&format!("{},{},{}\n", columns[0][k], columns[1][k], columns[3][k])));
    let run = Run::of(&content, &["--outputs", "y"]);
    let result = run.result();
    assert!(!result.outputs[0].surrogate.as_ref().unwrap().serves);
    let mut messages = messages!();
    messages.add("warning", &result.outputs[0].warnings[0]);
    messages.add("note", &result.notes[0]);
    messages.add_printed("printed", &stdout(&run.output));
}

#[test]
fn other_measures_are_listed_with_the_indices() {
    // x3 has the smallest effect, and x4 none.
    let columns = random(4, 600, 12);
    let content = table(&columns);
    let weightless = content.lines().enumerate().map(|(row, line)| match row {
        0 => format!("{line}\n"),
        _ => {
            let y = columns[0][row - 1] * 3.0 + columns[1][row - 1] * 2.0 + columns[2][row - 1];
            format!("{},{y}\n", line.rsplit_once(',').unwrap().0)
        }
    });
    let content: String = weightless.collect();
    let run = Run::of(&content, &["--outputs", "y", "--measures"]);
    messages!().add_printed("--measures", &stdout(&run.output));
    let result: GivenFile =
        serde_json::from_str(&std::fs::read_to_string(run.out().join("table.json")).unwrap()).unwrap();
    let measures = result.outputs[0].measures.as_ref().unwrap();
    for measure in Measure::ALL {
        let name = measure.name();
        let of = |input: usize| measures[input].get(measure).unwrap().estimate.estimate;
        assert!(of(0) > of(1) && of(1) > of(2).max(of(3)), "{name}: {:?}", [of(0), of(1), of(2), of(3)]);
        let p_value = |input: usize| measures[input].get(measure).unwrap().p_value.unwrap();
        assert!(p_value(0) <= 0.005 && p_value(1) <= 0.005 && p_value(3) > 0.001, "{name}");
    }
    let csv = std::fs::read_to_string(run.out().join("table-measures.csv")).unwrap();
    assert!(csv.starts_with("output,input,fourier,fourier_low,fourier_high,fourier_p,delta,"), "{csv}");
    // The rows of a net are not independent draws.
    let even = Run::of(&table(&sobol(3, 512, 0)), &["--outputs", "y", "--measures"]);
    let result: GivenFile =
        serde_json::from_str(&std::fs::read_to_string(even.out().join("table.json")).unwrap()).unwrap();
    let measures = &result.outputs[0].measures.as_ref().unwrap()[0].measures;
    assert!(measures.values().all(|of| of.p_value.is_none() && of.estimate.interval.is_none()));
    let without = Run::of(&table(&sobol(3, 512, 0)), &["--outputs", "y"]);
    assert!(!without.out().join("table-measures.csv").exists());
}

/// A table whose column `a` explains nearly all of `y`, with its cells written by `cell`.
fn without_numbers(cell: impl Fn(f64) -> String) -> String {
    let columns = random(2, 200, 3);
    let rows = (0..200).map(|row| {
        let (a, b) = (columns[0][row], columns[1][row]);
        format!("{};{b};{}\n", cell(a), 5.0 * a + 0.1 * b)
    });
    "a;b;y\n".to_owned() + &rows.collect::<String>()
}

#[test]
fn columns_of_text_are_warned_of_with_their_remedy() {
    let cells: [fn(f64) -> String; 3] = [
        |a| a.to_string().replace('.', ","),
        |a| format!("{a} mm"),
        |a| if a < 0.5 { "alu" } else { "steel" }.to_owned(),
    ];
    let mut messages = messages!();
    for (case, cell) in ["commas", "units", "names"].into_iter().zip(cells) {
        let run = Run::of(&without_numbers(cell), &["--outputs", "y"]);
        let result = run.result();
        let left_out = &result.table.columns_left_out;
        assert_eq!((left_out.len(), left_out[0].name.as_str()), (1, "a"));
        messages.add(case, &result.warnings[0]);
        // The end of the warning is on the terminal and the page too.
        let end = result.warnings[0].rsplit_once(": ").unwrap().1;
        let page = std::fs::read_to_string(run.out().join("table.html")).unwrap();
        assert!(stdout(&run.output).contains(end) && page.contains(end), "{end}: {}", stdout(&run.output));
    }
    Run::of("a;y\n1,5;2\n2,5;3\n", &["--outputs", "y"]).refused(&mut messages, "nothing is left");
}
