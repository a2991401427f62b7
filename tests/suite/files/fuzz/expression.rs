//! Formulas.

use apportion::model::{Batch, Expression, ExpressionModel, Model, Output, RunContext, Symbol};
use apportion_base::quantity::Unit;

const POINTS: [[f64; 3]; 5] =
    [[0.5, -2.0, 3.0], [0.0, -0.0, 1.0], [1e308, -1e308, 1e-308], [-1.0, 0.5, 4096.0], [f64::MAX, f64::MIN, 5e-324]];

fn symbol(name: &str) -> Option<Symbol> {
    Some(match name {
        "x" => Symbol::Input(0),
        "y" => Symbol::Input(1),
        "z" => Symbol::Input(2),
        "a" => Symbol::Number(7.0),
        _ => return None,
    })
}

/// A formula is read or refused with a place inside it; what is read has the same values alone and in columns.
pub fn run(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let formula = match Expression::parse(text, &symbol) {
        Ok(formula) => formula,
        Err(error) => {
            assert!(text.get(error.place.clone()).is_some(), "{error}: {:?} is no place", error.place);
            return;
        }
    };
    let model = ExpressionModel::new(vec![(Output::new("y", Unit::dimensionless(), ""), formula.clone())]);
    let mut batch = Batch::new(&model);
    batch.reset(POINTS.len());
    let columns: Vec<Vec<f64>> = (0..3).map(|input| POINTS.iter().map(|point| point[input]).collect()).collect();
    let inputs: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
    model.worker(&RunContext::default()).run(&inputs, &mut batch);
    for (row, point) in POINTS.iter().enumerate() {
        let (alone, among) = (formula.value(point), batch.column(0)[row]);
        // In a batch a value that is not finite is a failure.
        assert!(alone.to_bits() == among.to_bits() || !(alone.is_finite() || among.is_finite()), "{alone} {among}");
    }
    assert_eq!(Expression::parse(formula.text(), &symbol).as_ref(), Ok(&formula));
}
