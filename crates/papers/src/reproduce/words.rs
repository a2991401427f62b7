//! Computed values in sentences.

use apportion_report::fixed;

/// Computed values in words, by their names in braces.
pub(super) type Words = Vec<(&'static str, String)>;

/// Replaces the names in braces in `text` by `words`.
pub(super) fn filled(text: &str, words: &Words) -> String {
    words.iter().fold(text.to_owned(), |text, (name, word)| text.replace(&format!("{{{name}}}"), word))
}

/// Groups the names by equal texts, in the order of the first of each.
pub(super) fn named_together<'a, T: PartialEq>(
    texts: impl IntoIterator<Item = (T, &'a str)>,
) -> Vec<(T, Vec<&'a str>)> {
    let mut groups: Vec<(T, Vec<&str>)> = Vec::new();
    for (text, name) in texts {
        match groups.iter_mut().find(|(other, _)| *other == text) {
            Some((_, names)) => names.push(name),
            None => groups.push((text, vec![name])),
        }
    }
    groups
}

/// Formats an index in percent of the variance, to a whole percent; one decimal below 10 % and near 100 %.
pub(super) fn percent(index: f64) -> String {
    let is_near_an_end = !(0.0995..=0.985).contains(&index);
    format!("{} %", fixed(100.0 * index, usize::from(is_near_an_end)))
}
