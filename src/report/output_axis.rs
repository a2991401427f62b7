//! Outputs in a row: by the numbers in their names, where these are those of a series, else by name.

/// Fewest outputs that are a series.
const FEWEST: usize = 3;

/// Most axes; the outputs of studies with more stand on one.
const MOST: usize = 4;

/// Outputs that stand on one axis of a map.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct OutputAxis {
    /// What it is called; empty where the outputs have nothing in common.
    pub label: String,
    /// The places of the outputs in the study.
    pub outputs: Vec<usize>,
    /// Where each of them stands, in rising order; `None` if only their names tell them apart.
    pub numbers: Option<Vec<f64>>,
}

impl OutputAxis {
    /// The axes of outputs with these names: one for each series, such as `infected[0]`, `infected[1]`, ..., or `y_10`,
    /// `y_20`, ..., and one for all that belong to none.
    pub fn all(names: &[&str]) -> Vec<Self> {
        let mut axes: Vec<Self> = Vec::new();
        for (place, (stem, number)) in
            names.iter().enumerate().filter_map(|(place, name)| Some((place, numbered(name)?)))
        {
            match axes.iter_mut().find(|axis| axis.label == stem) {
                Some(axis) => {
                    axis.outputs.push(place);
                    axis.numbers.get_or_insert_default().push(number);
                }
                None => axes.push(Self { label: stem.to_owned(), outputs: vec![place], numbers: Some(vec![number]) }),
            }
        }
        let rises = |numbers: &Vec<f64>| numbers.len() >= FEWEST && numbers.windows(2).all(|pair| pair[0] < pair[1]);
        axes.retain(|axis| axis.numbers.as_ref().is_some_and(rises));
        let in_series = |place: &usize| axes.iter().any(|axis| axis.outputs.binary_search(place).is_ok());
        let others: Vec<usize> = (0..names.len()).filter(|place| !in_series(place)).collect();
        let named = |outputs: Vec<usize>| Self { label: String::new(), outputs, numbers: None };
        if !others.is_empty() {
            axes.push(named(others));
        }
        if axes.len() > MOST { vec![named((0..names.len()).collect())] } else { axes }
    }
}

/// What a name begins with, and the number that it ends in: `infected[12]` is number 12 of `infected`.
fn numbered(name: &str) -> Option<(&str, f64)> {
    let open = name.strip_suffix([']', ')']).unwrap_or(name);
    let digits = open.trim_end_matches(|c: char| c.is_ascii_digit() || c == '.').len();
    let number: f64 = open[digits..].parse().ok()?;
    Some((open[..digits].trim_end_matches(['[', '(', '_', '-', ' ', '=']), number))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_end_in_numbers_are_series() {
        let found = ["infected[12]", "y_10", "y7", "f(0.5)", "1990", "F_cr", "y.", "t=2.5"].map(numbered);
        let expected = [
            Some(("infected", 12.0)),
            Some(("y", 10.0)),
            Some(("y", 7.0)),
            Some(("f", 0.5)),
            Some(("", 1990.0)),
            None,
            None,
            Some(("t", 2.5)),
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn every_output_stands_on_one_axis() {
        let axes = OutputAxis::all(&["s[0]", "peak", "s[2]", "i[0]", "s[5]", "i[1]", "x2"]);
        let series = OutputAxis { label: "s".to_owned(), outputs: vec![0, 2, 4], numbers: Some(vec![0.0, 2.0, 5.0]) };
        let others = OutputAxis { label: String::new(), outputs: vec![1, 3, 5, 6], numbers: None };
        assert_eq!(axes, [series, others]);
        // What falls is no axis.
        assert_eq!(OutputAxis::all(&["y3", "y2", "y1"])[0].numbers, None);
        let many: Vec<String> = (0..30).map(|k| format!("{}{}", ["a", "b", "c", "d", "e"][k % 5], k)).collect();
        let axes = OutputAxis::all(&many.iter().map(String::as_str).collect::<Vec<_>>());
        assert_eq!((axes.len(), axes[0].outputs.len(), &axes[0].numbers), (1, 30, &None));
    }
}
