use super::*;

fn part(what: &str, nominal: bool, value: f64) -> ClaimPart {
    let interval = Some(Interval { low: value - 0.001, high: value + 0.001 });
    ClaimPart { what: what.into(), nominal, share: Share { value, interval } }
}

#[test]
fn verdicts_use_the_scene_of_the_paper_and_ranges_the_box() {
    let parts = [part("Coulomb", true, 1.0), part("LuGre", true, 0.5)];
    assert_eq!(Answer::judged(&parts, []).verdict, Verdict::Reproduced);
    assert_eq!(over_ranges(&parts), "Coulomb: all of the box; LuGre: 50 % [49.9, 50.1] of the box");
    // Everywhere in the box but not at the nominal scene does not reproduce a chart drawn there.
    let elsewhere = Answer::judged(&[part("Coulomb", false, 1.0)], []);
    assert_eq!(elsewhere.verdict, Verdict::NotReproduced);
}

#[test]
fn findings_have_few_digits() {
    assert_eq!(nano(631.3456e-9, "N"), "631 nN");
    assert_eq!(nano(-19.044e-9, "m"), "−19 nm");
    assert_eq!(number(0.209_47, "s"), "0.209 s");
    assert_eq!((number(2.99, ""), number(3.0411e-5, "nN")), ("2.99".into(), "3.0e-5 nN".into()));
    assert_eq!(
        (percent_of(0.8324), percent_of(0.99951), percent_of(1.0)),
        ("83.2".into(), "99.95".into(), "100".into())
    );
    assert_eq!((change(0.019_04), change(0.0), change(3.2e-9)), ("1.9 %".into(), "0 %".into(), "3e-7 %".into()));
}
