//! How an output is distributed.

use super::super::chart::{Axis, Chart, LineChart, LinePanel};
use super::super::distribution::{DensityWords, density_chart};
use super::super::format::{the, words};
use super::super::result::{OutputRecord, ResultFile};
use super::{friction, headline};

/// The distribution of an output; without values, the reason.
pub fn distribution_chart(result: &ResultFile, output: &OutputRecord) -> Chart {
    let title = format!("{}: distribution of {}", headline(result), the(&output.name));
    let role = friction(result);
    let output_words = words(&output.name);
    if let Some(distribution) = &output.distribution {
        return density_chart(&distribution.sample, &DensityWords { title: &title, output: &output_words, role });
    }
    let reason = output.reason.as_deref().unwrap_or("its values are beyond double precision in this unit");
    let y = Axis { label: "probability density".to_owned(), ..Axis::default() };
    Chart::Lines(LineChart {
        names: Vec::new(),
        title,
        caption: format!("No distribution of {}: {reason}.", the(&output.name)),
        x: Axis { label: output_words, ..Axis::default() },
        panels: vec![LinePanel { title: String::new(), y, series: Vec::new(), markers: Vec::new() }],
    })
}
