use super::*;

#[test]
fn journals_of_different_names_have_different_sibling_journals() {
    let of = |name: &str| sibling_path(Path::new(name), "split").display().to_string();
    assert_eq!(of("results/s.journal"), "results/s-split.journal");
    assert_eq!((of("jr/j_0.1"), of("jr/j_0.2")), ("jr/j_0.1-split".to_owned(), "jr/j_0.2-split".to_owned()));
    assert_eq!((of("a.b.journal"), of("a.b")), ("a.b-split.journal".to_owned(), "a.b-split".to_owned()));
}
