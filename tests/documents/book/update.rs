//! Writes current outputs into the page: `BOOK=update`.

use std::collections::BTreeSet;

use super::page::{Block, Page};
use super::play::is_alike;

/// Smallest similarity of two lines of which one can replace the other: the share of their words that they have in common.
const ALIKE: f64 = 0.35;

/// `shown` with the current lines of `printed`, and the same elisions.
pub fn corrected(shown: &str, printed: &str) -> String {
    let lines: Vec<&str> = printed.lines().map(str::trim_end).collect();
    let (mut next, mut corrected) = (0, Vec::<String>::new());
    let dots = |corrected: &mut Vec<String>| {
        if corrected.last().is_none_or(|line| line != "...") {
            corrected.push("...".to_owned());
        }
    };
    for line in shown.lines().map(str::trim_end) {
        if line == "..." {
            dots(&mut corrected);
            continue;
        }
        let exact = lines[next..].iter().position(|printed| is_alike(line, printed));
        let Some(place) = exact.or_else(|| most_alike(line, &lines[next..])) else {
            dots(&mut corrected);
            continue;
        };
        if place > 0 {
            dots(&mut corrected);
        }
        let printed = lines[next + place];
        corrected.push(if exact.is_some() { line.to_owned() } else { cut_like(line, printed) });
        next += place + 1;
    }
    if next < lines.len() {
        dots(&mut corrected);
    }
    corrected.iter().map(|line| format!("{line}\n")).collect()
}

fn words(line: &str) -> BTreeSet<String> {
    let letters = line.split(|letter: char| !letter.is_alphabetic()).filter(|word| !word.is_empty());
    letters.map(str::to_lowercase).collect()
}

fn most_alike(line: &str, printed: &[&str]) -> Option<usize> {
    let wanted = words(line);
    let likeness = |other: &str| {
        let found = words(other);
        let shared = wanted.intersection(&found).count();
        // A line that is cut off has all its words in the other.
        shared as f64 / if line.contains("[..]") { wanted.len() } else { wanted.union(&found).count() }.max(1) as f64
    };
    let all = printed.iter().map(|other| likeness(other)).enumerate();
    let best = all.fold((0, 0.0), |best, other| if other.1 > best.1 { other } else { best });
    (best.1 >= ALIKE).then_some(best.0)
}

/// As many words of `printed` as there are before the first `[..]` of `line`; all of them if it has none.
fn cut_like(line: &str, printed: &str) -> String {
    let Some((kept, _)) = line.split_once("[..]") else { return printed.to_owned() };
    let count = kept.split_whitespace().count();
    let mut ends = printed.match_indices(' ').map(|(place, _)| place);
    let end = ends.nth(count.saturating_sub(1)).unwrap_or(printed.len());
    format!("{} [..]", printed[..end].trim_end())
}

/// Writes the corrected outputs into the page.
pub fn write(page: &Page, corrections: &[(&Block, String)]) {
    let path = crate::common::root().join(&page.name);
    let text = std::fs::read_to_string(&path).unwrap();
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    for (block, corrected) in corrections.iter().rev() {
        let indent = " ".repeat(lines[block.line - 1].len() - lines[block.line - 1].trim_start().len());
        let new = corrected.lines().map(|line| format!("{indent}{line}").trim_end().to_owned());
        lines.splice(block.line..block.line + block.text.lines().count(), new);
    }
    std::fs::write(path, lines.join("\n") + "\n").unwrap();
}

#[test]
fn shown_output_is_updated_from_printed_output() {
    let printed =
        "run: 12 runs in 3 s\nFor y, x1 matters most: its index is 0.6, 60 %.\n\ntable\n  x1  0.60\n  x2  0.40\nend\n";
    let shown = "...\nX1 matters most for y: its index is 0.5, [..]\n...\n  x1  0.50\n...\n";
    let expected = "...\nFor y, x1 matters most: its index is 0.6, [..]\n...\n  x1  0.60\n...\n";
    assert_eq!(corrected(shown, printed), expected);
    assert_eq!(corrected(expected, printed), expected);
    assert_eq!(corrected("run: 12 runs in [..]\n", printed), "run: 12 runs in [..]\n...\n");
}
