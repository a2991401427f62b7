//! The identity of a study: everything on which the outputs of its runs depend.

use serde_json::{Map, Value, json};

use super::Study;
use crate::design::{Sampler, Swap};
use apportion_base::digest::sha256;

impl Study {
    /// Returns all that the outputs of the runs depend on, as JSON: the model with its choices and constants, the
    /// factors, the points of the design and its rows, and the version of the program. It excludes the number of points
    /// (except for Latin hypercubes, whose points depend on it), what is estimated from them, and names and titles.
    ///
    /// Two studies of equal identity have the same outputs at the same rows, bit by bit, if their models are
    /// deterministic. A model outside this program, or in a program that uses the library, is identified only by what
    /// the study states about it.
    pub fn identity(&self) -> Value {
        let settings: Map<String, Value> =
            self.settings().into_iter().map(|(key, value)| (key.to_owned(), value)).collect();
        let constants: Map<String, Value> =
            self.constants().into_iter().map(|(name, value, unit)| (name, json!([value, unit]))).collect();
        let outputs: Vec<Value> =
            self.model().outputs().iter().map(|o| json!({ "name": o.name, "unit": o.unit.to_string() })).collect();
        let factor = |factor: &crate::space::Factor| {
            json!({
                "name": factor.name,
                "unit": factor.unit().to_string(),
                "distribution": factor.distribution(),
                // Long lists of values are shortened in the line above.
                "digest": digest(&format!("{:?}", factor.distribution())),
            })
        };
        let (design, settings_of_design) = (&self.design, self.design.settings());
        let names = |swap: &Swap| swap.iter().map(|k| self.space.factors()[*k].name.as_str()).collect::<Vec<_>>();
        let mut points = json!({
            "sampler": settings_of_design.sampler,
            "seed": settings_of_design.seed,
            "replicates": settings_of_design.replicates,
            "rows_per_point": design.rows_per_point(),
            "swaps": design.swaps().iter().map(|swap| names(swap).join("+")).collect::<Vec<_>>(),
            // Kept for existing journals: rows BC and CB no longer exist.
            "companions": { "ba": design.has_ba(), "bc": false, "cb": false },
        });
        if design.plain_rows() > 0 {
            points["plain_rows"] = json!(design.plain_rows());
        }
        if let Some(copula) = self.space.copula() {
            points["copula"] = json!(digest(&format!("{:?}", copula)));
            points["redrawn"] = json!(design.asked().redrawn);
        }
        if settings_of_design.sampler == Sampler::LatinHypercube {
            points["base_samples"] = json!(settings_of_design.base_samples);
        }
        json!({
            "apportion": env!("CARGO_PKG_VERSION"),
            "model": self.subject.name(),
            "settings": settings,
            "constants": constants,
            "outputs": outputs,
            "factors": self.space.factors().iter().map(factor).collect::<Vec<_>>(),
            "design": points,
        })
    }
}

fn digest(text: &str) -> String {
    sha256(text.as_bytes())[..16].to_owned()
}
