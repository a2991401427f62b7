//! `apportion sweep`: one factor at a time around the nominal point.

use anyhow::anyhow;
use apportion::model::{GiveUp, RunContext};
use apportion::report::sweep::{build_sweep, sweep_document};
use apportion::run::Halt;
use apportion::space::Space;
use apportion::study::Study;
use apportion::sweep::{FactorValues, MAX_POINTS, SweepError, SweepRequest, find, sweep_in};

use super::output::{OutputArguments, deliver};
use super::stop::on_signal;
use super::{Failure, StudyArguments, number_in, say};

#[derive(clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// A factor to sweep over its range, or over values: thickness, or thickness='0.5,1,2 um' [default: every factor]
    #[arg(long = "factor", value_name = "NAME[=VALUES]")]
    factors: Vec<String>,
    /// Points over the range of each factor
    #[arg(long, value_name = "N", default_value_t = 101, value_parser = |text: &str| number_in(text, 2..=MAX_POINTS))]
    points: usize,
    /// Repeat each sweep for values of another factor, one curve for each: length='300,450,600 um'
    #[arg(long, value_name = "NAME=VALUES")]
    against: Option<String>,
    #[command(flatten)]
    output: OutputArguments,
}

impl From<SweepError> for Failure {
    fn from(error: SweepError) -> Self {
        let is_input = match &error {
            SweepError::Halted(halt) => matches!(halt, Halt::GaveUp(GiveUp { is_bad_input: true, .. })),
            _ => true,
        };
        Self::input_if(is_input, error)
    }
}

impl Arguments {
    fn request(&self, study: &Study) -> Result<SweepRequest, Failure> {
        let space = study.space();
        let factors = if self.factors.is_empty() {
            let all = 0..space.factors().len();
            all.map(|factor| FactorValues::over_range(space, factor, self.points)).collect::<Result<_, _>>()?
        } else {
            let read = |text: &String| self.swept(text, space).map_err(of_option("--factor", text));
            self.factors.iter().map(read).collect::<Result<_, _>>()?
        };
        let against = self.against.as_ref();
        let against =
            against.map(|text| FactorValues::parse(text, space).map_err(of_option("--against", text))).transpose()?;
        Ok(SweepRequest { factors, against })
    }

    fn swept(&self, text: &str, space: &Space) -> Result<FactorValues, SweepError> {
        if text.contains('=') {
            FactorValues::parse(text, space).inspect(|asked| tell_of_others(asked, space))
        } else {
            FactorValues::over_range(space, find(space, text)?, self.points)
        }
    }
}

/// Says which of the values asked for the factor does not take.
fn tell_of_others(asked: &FactorValues, space: &Space) {
    let factor = &space.factors()[asked.factor];
    let (low, high) = factor.distribution().support();
    let outside: Vec<String> =
        asked.values.iter().filter(|value| !(low..=high).contains(value)).map(f64::to_string).collect();
    if !outside.is_empty() {
        let range = format!("its range in the study, from {low} to {high}");
        let values = outside.join(", ");
        let unit = factor.unit();
        let lie = if outside.len() == 1 { "lies" } else { "lie" };
        say(&format!("note: {} = {values} (in {unit}) {lie} outside of {range}", factor.name));
    }
}

/// The error of an option with the option in front.
fn of_option(option: &str, text: &str) -> impl FnOnce(SweepError) -> Failure {
    let option = format!("{option} {text}");
    move |error| Failure::Input(anyhow!("{option}: {error}"))
}

pub fn sweep(arguments: &Arguments) -> Result<(), Failure> {
    let study = arguments.study.load()?;
    let request = arguments.request(&study)?;
    request.check(study.space())?;
    let model = study.model();
    let artefacts = arguments.output.artefacts(study.name());
    artefacts.prepare()?;
    let context = RunContext::new(Some(on_signal()), say);
    let sweeps = sweep_in(study.space(), model.as_ref(), &request, &context)?;
    deliver(&artefacts, &sweep_document(&build_sweep(&study, model.as_ref(), sweeps)))
}
