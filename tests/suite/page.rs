//! The page that a run writes.

use std::path::Path;

use crate::common::{apportion, stderr, study_path};

/// The page that `apportion run` writes for a study file, and the folder it stands in.
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
    assert!(page.contains("<p class=\"lead\">Thickness matters most for the critical force"), "the answer comes first");
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
    for file in
        ["coulomb-general.json", "coulomb-general.csv", "charts/coulomb-general.svg", "coulomb-general-convergence.csv"]
    {
        assert!(links.contains(&file), "{file}");
    }
}

#[test]
fn every_output_has_its_section_and_pairs_their_table() {
    let (page, _) = page_of(&study_path("soft-cantilever"), &["--base-samples", "256"]);
    assert!(page.contains("Critical force (nN)</h2>") && page.contains("Critical time (s)</h2>"));
    let (page, _) = page_of(&study_path("ishigami-second-order"), &["--base-samples", "256"]);
    assert!(page.contains("x1 × x3"), "the pair that interacts");
}

#[test]
fn an_evil_title_stays_a_title() {
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
    std::fs::write(&study, "model = \"constant\"\n").unwrap();
    let (page, _) = page_of(&study, &[]);
    assert!(page.contains("There are no indices of y") && page.contains("zero variance"));
}
