//! Words in sentences, for every module that says something to people.

/// A list as people say it: `a`, `a and b`, `a, b and c`.
///
/// ```
/// assert_eq!(apportion::report::listed(&["length", "width", "height"]), "length, width and height");
/// ```
#[cfg(feature = "charts")]
pub fn listed<S: AsRef<str>>(items: &[S]) -> String {
    match items {
        [] => String::new(),
        [one] => one.as_ref().to_owned(),
        [most @ .., last] => {
            let most: Vec<&str> = most.iter().map(AsRef::as_ref).collect();
            format!("{} and {}", most.join(", "), last.as_ref())
        }
    }
}

/// `word` with its first letter a capital.
pub fn capitalised(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
