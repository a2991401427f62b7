//! An output transformerless push-pull circuit.

use super::function::{positive, uniform};
use super::{Exact, KnownAnswer, KnownInput, Made};

pub(super) const ENTRY: KnownAnswer = KnownAnswer {
    name: "otl-circuit",
    description: "midpoint voltage of a push-pull circuit without output transformer (V)",
    formula: "(Vb1 + 0.74) c / (c + Rf) + 11.35 Rf / (c + Rf) + 0.74 Rf c / ((c + Rf) Rc1), Vb1 = 12 Rb2 / (Rb1 + Rb2), \
              c = beta (Rc2 + 9)",
    source: "Ben-Ari and Steinberg 2007, Qual. Eng. 19, 327-338",
    parameters: &[],
    build: |_| Ok(Made::new(inputs(), exact(), value)),
};

fn inputs() -> Vec<KnownInput> {
    vec![
        positive("Rb1", "resistance b1, kilohm", uniform(50.0, 150.0)),
        positive("Rb2", "resistance b2, kilohm", uniform(25.0, 70.0)),
        positive("Rf", "resistance f, kilohm", uniform(0.5, 3.0)),
        positive("Rc1", "resistance c1, kilohm", uniform(1.2, 2.5)),
        positive("Rc2", "resistance c2, kilohm", uniform(0.25, 1.2)),
        positive("beta", "current gain", uniform(50.0, 300.0)),
    ]
}

fn value(x: &[f64]) -> f64 {
    let &[rb1, rb2, rf, rc1, rc2, beta] = x else { return f64::NAN };
    let (vb1, c) = (12.0 * rb2 / (rb1 + rb2), beta * (rc2 + 9.0));
    (vb1 + 0.74) * c / (c + rf) + 11.35 * rf / (c + rf) + 0.74 * rf * c / ((c + rf) * rc1)
}

/// The midpoint voltage in volts. By tensor quadrature: mean 5.43405, variance 1.30691.
fn exact() -> Exact {
    // S_i and ST_i.
    let indices = [
        [0.4956631683466011, 0.5001451493677772],
        [0.40719669280363024, 0.41167859765379644],
        [0.07084080332915968, 0.07400605478878403],
        [0.018639362217232548, 0.02180256813708708],
        [3.3892715014267995e-08, 5.173752114840751e-08],
        [1.2665665569323318e-05, 1.4940126057443647e-05],
    ];
    Exact::by_quadrature(5.4340540961552035, 1.3069093620472445, &indices, 1e-10)
}
