use super::*;
use crate::model::OutputSeries;

#[test]
fn positions_are_finite_and_rise() {
    let axis = SeriesAxis::even("time", "ms", 3, 1.0, 0.5).unwrap();
    assert_eq!(axis.positions(), [1.0, 1.5, 2.0]);
    let refused = |positions: &[f64]| SeriesAxis::new("t", "", positions.to_vec()).unwrap_err().to_string();
    assert_eq!(refused(&[1.0]), "a series has 2 to 10000 values, not 1");
    assert!(refused(&[0.0, 1.0, 1.0]).ends_with("position 2 is 1"));
    assert!(refused(&[f64::NEG_INFINITY, 1.0]).ends_with("position 0 is -inf"));
    assert!(refused(&[0.0, f64::NAN]).ends_with("position 1 is NaN"));
    assert!(SeriesAxis::even("t", "", usize::MAX, 0.0, 1.0).is_err());
    assert!(SeriesAxis::even("t", "", 3, 0.0, -1.0).is_err());
}

#[test]
fn a_series_is_chosen_whole_or_not_at_all() {
    let axis = SeriesAxis::even("t", "", 3, 0.0, 1.0).unwrap();
    let series = OutputSeries { name: "y".to_owned(), first: 1, axis };
    let first = |chosen: &[usize]| OutputSeries::chosen(std::slice::from_ref(&series), chosen).first().map(|s| s.first);
    assert_eq!(first(&[0, 1, 2, 3]), Some(1));
    assert_eq!(first(&[4, 5, 1, 2, 3]), Some(2));
    assert_eq!(first(&[1, 2]), None);
    assert_eq!(first(&[1, 3, 2]), None);
    assert_eq!(first(&[0]), None);
}

#[test]
fn names_of_items_are_read() {
    assert_eq!(OutputSeries::item_of_list("infected[12]"), Some(("infected", 12)));
    assert_eq!(OutputSeries::item_of_list("a[1][2]"), Some(("a[1]", 2)));
    for name in ["y", "y[]", "[1]", "y[-1]", "y[1", "y[1]x", "y[99999999999999999999999]"] {
        assert_eq!(OutputSeries::item_of_list(name), None, "{name}");
    }
    let items = |header: &str| OutputSeries::items_of_header(header).map(Iterator::collect::<Vec<String>>);
    assert_eq!(items("y[2..4]"), Some(vec!["y[2]".to_owned(), "y[3]".to_owned()]));
    for header in ["y[2]", "y[4..2]", "y[2..2]", "[0..2]", "y[0..-2]", "y[0...2]", "y[0..99999999]", "y[..2]"] {
        assert_eq!(items(header), None, "{header}");
    }
}
