use super::*;
use crate::model::function_model;
use crate::space::Distribution;

#[test]
fn a_journal_that_no_run_could_load_is_not_begun() {
    let model = function_model("y", |x| x[0]);
    let study = Study::builder("s", model).factor("x", Distribution::uniform(0.0, 1.0).unwrap()).build().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("s.journal");
    let most = MAX_STORED_BYTES / 8;
    for (total, outputs, is_begun) in
        [(most + 1, 1, false), (most / 2 + 1, 2, false), (u64::MAX, 2, false), (most, 1, true)]
    {
        let journal = RunJournal::none(&study).with_new(&path, Value::Null, true).unwrap();
        let progress = Progress { done: 1, total, elapsed: Duration::from_secs(60), ..Progress::default() };
        journal.watch(progress, outputs, &Messages::default());
        assert_eq!(path.exists(), is_begun, "{total} runs");
    }
}
