//! Ishigami's function with parts where it has no value.

use super::ishigami::Ishigami;
use super::parameters::{Given, Range};
use super::{Entry, Exact, Function, KnownInput, ParameterError, ParameterInfo, ParameterValue};

pub(super) const ENTRY: Entry = Entry {
    name: "ishigami-holes",
    summary: "fails where x3 > edge, returns NaN where x3 < -edge: 4.5 % of the rows in all",
    formula: "ishigami where |x3| <= edge; a failure with a reason above, NaN without a reason below",
    source: "this program, for the handling of failed rows",
    parameters: &[
        ParameterInfo { name: "a", description: "weight of the second term [7]" },
        ParameterInfo { name: "b", description: "weight of the interaction [0.1]" },
        ParameterInfo { name: "edge", description: "largest |x3| with a value, greater than 0 and at most pi [3]" },
    ],
    build: |given| Ok(Box::new(IshigamiHoles::new(given)?)),
};

const EDGE: Range = (|x| x > 0.0 && x <= std::f64::consts::PI, "greater than 0 and at most pi");

/// [`Ishigami`] on |x3| <= edge, of which a share of edge / pi of all rows is left.
///
/// The exact answer is that of the rows that have a value: there x3 is uniform on (-edge, edge) and the inputs are still
/// independent, so that Ishigami's formulas hold with edge for pi. It is also what an analysis converges to that
/// leaves out every base point with a failed row. (Not so for a hole that is no slab: inputs would then depend.)
struct IshigamiHoles {
    whole: Ishigami,
    edge: f64,
}

impl IshigamiHoles {
    fn new(given: &Given<'_>) -> Result<Self, ParameterError> {
        Ok(Self { whole: Ishigami::new(given)?, edge: given.number("edge", 3.0, EDGE)? })
    }
}

impl Function for IshigamiHoles {
    fn inputs(&self) -> Vec<KnownInput> {
        self.whole.inputs()
    }

    fn parameters(&self) -> Vec<(&'static str, ParameterValue)> {
        let mut parameters = self.whole.parameters();
        parameters.push(("edge", ParameterValue::Number(self.edge)));
        parameters
    }

    fn value(&self, x: &[f64]) -> f64 {
        if x[2].abs() <= self.edge { self.whole.value(x) } else { f64::NAN }
    }

    fn reason(&self, x: &[f64]) -> Option<&'static str> {
        (x[2] > self.edge).then_some("the function has a hole where x3 exceeds its edge")
    }

    fn expression(&self) -> String {
        self.whole.expression()
    }

    fn exact(&self) -> Exact {
        self.whole.exact_within(self.edge)
    }
}
