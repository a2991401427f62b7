//! The identity of a study: everything on which the outputs of its runs depend.

use serde_json::{Map, Value, json};

use super::Study;
use crate::design::{DesignSettings, Sampler};
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
            self.model().outputs().iter().map(|output| json!({ "name": output.name, "unit": output.unit })).collect();
        let mut factors = Vec::with_capacity(self.space.factors().len());
        for factor in self.space.factors() {
            let (unit, distribution) = (factor.unit(), factor.distribution());
            factors.push(json!({ "name": factor.name, "unit": unit, "distribution": distribution }));
        }
        let design = &self.design;
        let DesignSettings { sampler, base_samples, replicates, seed } = *design.settings();
        let mut swaps = Vec::with_capacity(design.swaps().len());
        for swap in design.swaps() {
            swaps.push(swap.iter().map(|k| &*self.space.factors()[*k].name).collect::<Vec<_>>().join("+"));
        }
        let mut points = json!({
            "sampler": sampler,
            "seed": seed,
            "replicates": replicates,
            "rows_per_point": design.rows_per_point(),
            "swaps": swaps,
            "ba": design.has_ba(),
        });
        if let Some(copula) = self.space.copula() {
            points["copula"] = json!(sha256(json!(copula.rows()).to_string().as_bytes()));
            points["redrawn"] = json!(design.requested().redrawn);
        }
        if sampler == Sampler::LatinHypercube {
            points["base_samples"] = json!(base_samples);
        }
        json!({
            "apportion": env!("CARGO_PKG_VERSION"),
            "model": self.subject.name(),
            "settings": settings,
            "constants": constants,
            "outputs": outputs,
            "factors": factors,
            "design": points,
        })
    }
}
