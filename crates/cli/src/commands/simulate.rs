//! `apportion simulate`: one scene of a study in time.

use apportion_base::quantity::{Dimension, Quantity};

use super::StudyArguments;
use super::output::{OutputArguments, deliver};
use apportion_papers::scene::simulation::{mode_diagram, simulate as simulate_scene};
use apportion_papers::scene::{mode_document, scene_document};

#[derive(clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    #[command(flatten)]
    output: OutputArguments,
    /// Simulated time, as in "0.4 s" [default: twice the critical time]
    #[arg(long, value_name = "TIME", value_parser = parse_time, allow_hyphen_values = true)]
    duration: Option<f64>,
    /// Draw the mode diagram instead: the force at which the particle slides, slips at the tip, rolls or spins
    #[arg(long, conflicts_with = "duration")]
    mode_diagram: bool,
}

fn parse_time(text: &str) -> Result<f64, String> {
    let quantity = Quantity::parse(text).map_err(|error| error.to_string())?;
    if quantity.unit.dimension() != Dimension::TIME || quantity.value <= 0.0 {
        return Err("expected a time greater than 0 with its unit, as in \"0.4 s\"".to_owned());
    }
    Ok(quantity.to_si())
}

/// Simulates the scene with every factor at its nominal value.
pub fn simulate(arguments: &Arguments) -> anyhow::Result<()> {
    let study = arguments.study.load_with(&[])?;
    let artefacts =
        arguments.output.prepared(&study, if arguments.mode_diagram { "-modes" } else { "-scene" }, None)?;
    let document = if arguments.mode_diagram {
        mode_document(&mode_diagram(&study)?, study.name(), study.title().unwrap_or(study.name()))
    } else {
        scene_document(&simulate_scene(&study, arguments.duration)?, study.name())
    };
    deliver(&artefacts, &document)
}
