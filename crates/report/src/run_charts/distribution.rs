//! The distribution of an output.

use apportion::result::{OutputResult, StudyResult};

use super::super::chart::{Axis, Chart, Panel};
use super::super::format::{grouped, name, words};
use super::super::histogram_chart;

/// Draws the distribution of an output; without values, the reason.
pub fn distribution_chart(result: &StudyResult, output: &OutputResult) -> Chart {
    let title = format!("{}: distribution of {}", result.study.headline(), name(&output.name));
    let output_words = words(&output.name);
    if let Some(distribution) = &output.distribution {
        // With the mean of the values, not that of the page, which surrogates may have corrected.
        let sample = &distribution.sample;
        let mut chart = histogram_chart(sample, &title, &output_words);
        if sample.count < distribution.values {
            chart.caption.push_str(&format!(" They were kept of all {}.", grouped(distribution.values)));
        }
        return chart;
    }
    let reason = output.reason.as_deref().unwrap_or("its values are beyond double precision in this unit");
    let panel = Panel::new(Axis::new(output_words, ""), Axis::new("probability density", ""));
    Chart::new(title, format!("No distribution of {}: {reason}.", name(&output.name))).panels([panel])
}
