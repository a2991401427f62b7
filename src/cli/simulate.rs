//! `apportion simulate`: one scene of a study in time.

use std::path::{Path, PathBuf};

use crate::scene::simulation::{SimulationError, mode_diagram, simulate as simulate_scene};
use crate::scene::{PageParts, mode_diagram_chart, scene_charts, scene_csv, scene_json, scene_page};
use apportion::quantity::{Dimension, Quantity};
use apportion::report::chart::{Chart, png};
use apportion::report::{prepare_folder, with_unit, write_in};
use apportion::study::Study;

use super::pictures::say_written;
use super::run::default_folder;
use super::{Failure, StudyArguments, print};

#[derive(clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Folder for the results [default: results/NAME]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// How long to simulate, as in "0.4 s" [default: twice the critical time]
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

impl From<SimulationError> for Failure {
    fn from(error: SimulationError) -> Self {
        match error {
            SimulationError::NoScene(_) => Self::Input(error.into()),
            SimulationError::Failed(_) => Self::Run(error.into()),
        }
    }
}

/// Simulates the scene in which every factor stands at its nominal value.
pub fn simulate(arguments: &Arguments) -> Result<(), Failure> {
    let study = arguments.study.load()?;
    let folder = arguments.out.clone().unwrap_or_else(|| default_folder(&study.name));
    prepare_folder(&folder)?;
    let files = if arguments.mode_diagram { draw_modes(&study, &folder)? } else { tell(arguments, &study, &folder)? };
    say_written(&files);
    Ok(())
}

fn tell(arguments: &Arguments, study: &Study, folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let story = simulate_scene(study, arguments.duration)?;
    let charts = scene_charts(&story);
    let stem = format!("{}-scene", study.name);
    let (csv, json) = (format!("{stem}.csv"), format!("{stem}.json"));
    let parts = PageParts { charts: &charts, csv_file: &csv, json_file: &json };
    let page = scene_page(&story, parts).map_err(|error| Failure::Run(error.into()))?;
    let mut files = vec![
        (format!("{stem}.html"), page.into_bytes()),
        (csv, scene_csv(&story).into_bytes()),
        (json, scene_json(&story).into_bytes()),
    ];
    for chart in &charts {
        files.extend(pictures(&format!("{}-{}", study.name, chart.stem), &chart.chart)?);
    }
    let critical = &story.critical;
    let nanonewtons = |force: f64| with_unit(force * 1e9, "nN");
    let time = critical.time.map_or_else(|| "never".to_owned(), |time| format!("after {}", with_unit(time, "s")));
    let state = story.samples.last().map_or_else(String::new, |end| {
        let moved = with_unit(end.relative_position * 1e9, "nm");
        format!("; after {} it has moved {moved} relative to the substrate", with_unit(end.time, "s"))
    });
    print(&format!(
        "the particle slips {time}, at a tip force of {} (lateral {}, normal {}){state}\n",
        nanonewtons(critical.critical_force),
        nanonewtons(critical.lateral_force),
        nanonewtons(critical.normal_force)
    ))?;
    write(folder, files)
}

fn draw_modes(study: &Study, folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let diagram = mode_diagram(study)?;
    let chart = mode_diagram_chart(&diagram).map_err(|error| Failure::Run(error.into()))?;
    let mut csv = String::from("angle_rad");
    for line in &diagram.forces {
        csv.push_str(&format!(",{}_N", line.mode));
    }
    csv.push('\n');
    for (row, angle) in diagram.angle.iter().enumerate() {
        let forces = diagram.forces.iter().map(|line| line.force[row].map_or_else(String::new, |f| f.to_string()));
        csv.push_str(&format!("{angle},{}\n", forces.collect::<Vec<_>>().join(",")));
    }
    let stem = format!("{}-modes", study.name);
    let mut files = vec![(format!("{stem}.csv"), csv.into_bytes())];
    files.extend(pictures(&stem, &chart)?);
    write(folder, files)
}

/// A chart as its two files.
fn pictures(stem: &str, chart: &Chart) -> Result<[(String, Vec<u8>); 2], Failure> {
    let svg = chart.svg().map_err(|error| Failure::Run(error.into()))?;
    let picture = png(&svg).map_err(|error| Failure::Run(error.into()))?;
    Ok([(format!("{stem}.svg"), svg.into_bytes()), (format!("{stem}.png"), picture.bytes)])
}

fn write(folder: &Path, files: Vec<(String, Vec<u8>)>) -> Result<Vec<PathBuf>, Failure> {
    super::stop::writing()?;
    let mut written = Vec::with_capacity(files.len());
    for (name, bytes) in files {
        written.push(write_in(folder, &name, &bytes)?);
    }
    Ok(written)
}
