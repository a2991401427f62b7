//! The page that a run writes.

use std::path::Path;

use crate::common::{Folder, all_files, apportion, stderr, study_path, succeed, text};
use crate::messages::messages;

/// The page that `apportion run` writes for a study file, and its folder.
fn page_of(study: &Path, settings: &[&str]) -> (String, tempfile::TempDir) {
    let folder = tempfile::tempdir().unwrap();
    let mut arguments = vec!["run", study.to_str().unwrap(), "--out", folder.path().to_str().unwrap()];
    arguments.extend_from_slice(settings);
    let output = apportion(&arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let name = study.file_stem().unwrap().to_str().unwrap();
    (std::fs::read_to_string(folder.path().join(format!("{name}.html"))).unwrap(), folder)
}

/// Where the links of a page lead.
fn links(page: &str) -> Vec<&str> {
    page.split("<a href=\"").skip(1).map(|rest| rest.split_once('"').unwrap().0).collect()
}

#[test]
fn a_run_writes_a_page_that_needs_nothing_else() {
    let (page, folder) = page_of(&study_path("coulomb-general"), &["--base-samples", "8192"]);
    let lead = page.split("<p class=\"lead\">").nth(1).and_then(|rest| rest.split("</p>").next()).unwrap();
    assert!(lead.contains("thickness"), "the answer comes first: {lead}");
    let own = page.replace("http://www.w3.org/2000/svg", "");
    for outside in ["http:", "https:", " src=", "@import", "url(", "//cdn", "fetch("] {
        assert!(!own.contains(outside), "{outside}");
    }
    let links = links(&page);
    for link in &links {
        match link.strip_prefix('#') {
            Some(anchor) => assert!(page.contains(&format!("id=\"{anchor}\"")), "{link}"),
            None => assert!(folder.path().join(link).is_file(), "{link}"),
        }
    }
    for file in [
        "coulomb-general.json",
        "coulomb-general.csv",
        "charts/coulomb-general-indices.svg",
        "coulomb-general-convergence.csv",
    ] {
        assert!(links.contains(&file), "{file}");
    }
}

#[test]
fn every_output_has_its_section_and_pairs_their_table() {
    let (page, _) = page_of(&study_path("soft-cantilever"), &["--base-samples", "256"]);
    assert!(page.contains("critical force (nN)</h2>") && page.contains("critical time (s)</h2>"));
    let (page, _) = page_of(&study_path("ishigami-second-order"), &["--base-samples", "256"]);
    assert!(page.contains("x1 × x3"), "the pair that interacts");
}

#[test]
fn a_malicious_title_is_escaped() {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("evil.toml");
    let title = "</title></script><script>alert('1')</script><img src=x onerror=alert(2)> & \\\"quoted\\\"";
    std::fs::write(&study, format!("title = \"{title}\"\nmodel = \"ishigami\"\n[design]\nbase_samples = 64\n"))
        .unwrap();
    let (page, _) = page_of(&study, &[]);
    assert!(page.contains("&lt;/title&gt;"), "the title is there as text");
    assert_eq!(page.matches("</script>").count(), 1);
    assert_eq!(page.matches("</title>").count(), page.matches("<title").count());
    assert!(!page.contains("<img") && !page.contains("alert('1')"));
}

#[test]
fn the_same_study_gives_the_same_page_but_for_its_time() {
    let page = || page_of(&study_path("ishigami"), &["--base-samples", "256", "--threads", "1"]).0;
    let timeless = |page: String| {
        let timed = |line: &&str| line.contains(">time<") || line.contains(">runs per second<");
        page.lines().filter(|line| !timed(line)).map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(timeless(page()), timeless(page()));
}

#[test]
fn results_without_indices_have_pages() {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("flat.toml");
    std::fs::write(&study, "model = \"linear\"\n[function]\nc = [0, 0]\n").unwrap();
    let (page, _) = page_of(&study, &[]);
    assert!(!page.contains("id=\"indices\""), "{page}");
}

/// Checks that the page of a folder needs no other files and links only to existing ones; returns it.
#[track_caller]
fn whole(folder: &Path, name: &str) -> String {
    let page = std::fs::read_to_string(folder.join(format!("{name}.html"))).unwrap();
    for link in links(&page).into_iter().filter(|link| !link.starts_with('#')) {
        assert!(folder.join(link).is_file(), "{name}: {link}");
    }
    assert!(page.contains("<p class=\"lead\">") && page.contains("<svg"), "{name}");
    page
}

#[test]
fn every_command_that_draws_writes_a_page() {
    let folder = Folder::new();
    let (study, out) = (study_path("soft-cantilever"), folder.path("out"));
    let to = ["--out", text(&out)];
    let run = ["run", text(&study), "--base-samples", "64", "--no-journal"];
    succeed(&[&run[..], &to].concat());
    whole(&out, "soft-cantilever");
    succeed(&[&["screen", text(&study), "--trajectories", "8"], &to[..]].concat());
    assert!(whole(&out, "soft-cantilever-screen").contains("critical time (s)</h2>"));
    succeed(&[&["sweep", text(&study), "--points", "5"], &to[..]].concat());
    let sweep = whole(&out, "soft-cantilever-sweep");
    assert!(!sweep.contains("critical_force ="), "{sweep}");
    // Captions are sentences, and say which axes are logarithmic.
    let mut messages = messages!();
    for caption in sweep.split("<figcaption>").skip(1) {
        let (chart, sentences) = caption.split("</p>").next().unwrap().split_once("</strong>").unwrap();
        messages.add_printed(chart.rsplit('>').next().unwrap(), sentences);
    }
    succeed(&[&["simulate", text(&study)], &to[..]].concat());
    assert!(whole(&out, "soft-cantilever-scene").contains("<iframe"));
    succeed(&[&["simulate", text(&study), "--mode-diagram"], &to[..]].concat());
    whole(&out, "soft-cantilever-modes");
    let json = out.join("soft-cantilever.json");
    let both = ["compare", text(&json), text(&json), "--label-a", "one", "--label-b", "two"];
    succeed(&[&both[..], &to].concat());
    whole(&out, "A-vs-B");
    let rows: String = (0..60).map(|k| format!("{},{}\n", k * 37 % 60, (k * 37 % 60) * (k * 23 % 60))).collect();
    let table = folder.with("table.csv", format!("x,y\n{rows}"));
    succeed(&[&["given-data", text(&table), "--outputs", "y"], &to[..]].concat());
    whole(&out, "table");
}

#[test]
fn charts_have_the_formats_that_are_asked_for() {
    let folder = Folder::new();
    let study = study_path("ishigami");
    let run = |charts: &str| {
        let out = folder.path(charts);
        let output = apportion(&[
            "run",
            text(&study),
            "--base-samples",
            "64",
            "--no-journal",
            "--charts",
            charts,
            "--out",
            text(&out),
        ]);
        (output, out)
    };
    let (output, out) = run("png");
    let told: Vec<String> = stderr(&output).lines().rev().take(3).map(str::to_owned).collect();
    assert!(told.iter().all(|line| line.starts_with("wrote ")), "{told:?}");
    let charts = |out: &Path, ending: &str| all_files(out).iter().filter(|name| name.ends_with(ending)).count();
    assert_eq!((charts(&out, ".png"), charts(&out, ".svg")), (4, 0));
    assert!(!whole(&out, "ishigami").contains(".svg\""));
    let (_, out) = run("none");
    assert!(!out.join("charts").exists());
    assert!(!whole(&out, "ishigami").contains("charts/"));
    let (output, out) = run("gif");
    messages!().ended("--charts gif", 2, &output);
    assert!(!out.exists());
}

#[test]
fn charts_for_a_paper_have_its_width_and_no_title() {
    let folder = Folder::new();
    let out = folder.path("out");
    let study = study_path("ishigami");
    let run = ["run", text(&study), "--base-samples", "64", "--no-journal", "--out", text(&out)];
    succeed(&[&run[..], &["--charts", "svg,png,pdf", "--chart-width", "88mm"]].concat());
    let svg = std::fs::read_to_string(out.join("charts/ishigami-indices.svg")).unwrap();
    let root = svg.split('>').next().unwrap();
    assert!(root.contains("width=\"88mm\"") && root.contains("viewBox=\"0 0 338 "), "{root}");
    assert!(!svg.contains("class=\"title\"") && !svg.contains("class=\"caption\"") && svg.contains("<text "), "{svg}");
    // 88 mm at 600 dpi; pHYs says so behind IHDR.
    let png = std::fs::read(out.join("charts/ishigami-indices.png")).unwrap();
    let number = |at: usize| u32::from_be_bytes([png[at], png[at + 1], png[at + 2], png[at + 3]]);
    assert!((2078..=2080).contains(&number(16)) && &png[37..41] == b"pHYs" && number(41) == 23_622);
    // 88 mm are 249.45 points; the faces are inside.
    let pdf = std::fs::read(out.join("charts/ishigami-indices.pdf")).unwrap();
    let pdf = String::from_utf8_lossy(&pdf);
    assert!(pdf.contains("/MediaBox [0 0 249.4") && pdf.contains("/FontFile2 "), "{pdf}");
    assert!(std::fs::read_to_string(out.join("ishigami.html")).unwrap().contains("charts/ishigami-indices.pdf"));
    messages!().refused(&[&run[..], &["--chart-width", "20mm"]].concat());
}
