//! `model = "external"`: the outputs of a model that is run outside this program.

use apportion::model::{Input, Output};
use apportion::study::ExternalSubject;

use super::context::{Context, Fault, wrong};
use super::outputs::own_outputs;
use super::sections::{At, FactorSection, Outputs};
use super::units::own_inputs;

/// Returns the inputs of the model: the factors of the study, each in its own unit.
pub fn inputs(context: &Context<'_>, factors: &[At<FactorSection>]) -> Result<Vec<Input>, Fault> {
    for section in factors {
        let name = &section.get_ref().name;
        if name.get_ref().trim() != name.get_ref() || name.get_ref().is_empty() {
            let expected = "a text without spaces around it (it is the header of a column)";
            return context.refuse(name, "name of a factor", expected, format!("{:?}", name.get_ref()));
        }
    }
    own_inputs(context, factors)
}

/// Returns the outputs that the study states.
pub(super) fn subject(context: &Context<'_>, outputs: Option<&At<Outputs>>) -> Result<ExternalSubject, Fault> {
    let own = own_outputs(context, outputs)?;
    if let Some(place) = own.first_pick {
        let expected = "used only with a program that this program starts";
        return Err(context.fault(
            place,
            wrong("regex, column, pointer, file, match", expected, "with an external model".to_owned()),
        ));
    }
    let output = |output: crate::CommandOutput| Output::new(output.name, output.unit, "computed outside this program");
    Ok(ExternalSubject { outputs: own.outputs.into_iter().map(output).collect(), series: own.series })
}
