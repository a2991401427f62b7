//! What somebody may have meant who typed a name that is not there.

/// The name in `known` nearest to `name`, if one is near enough to be meant. Names of more than 100 characters, whose
/// comparison would take long, are near to none.
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<String> {
    const LONGEST: usize = 100;
    let is_long = |name: &str| name.chars().nth(LONGEST).is_some();
    if is_long(name) {
        return None;
    }
    let name = name.to_lowercase();
    known
        .into_iter()
        .filter(|candidate| !is_long(candidate))
        .map(|candidate| (strsim::damerau_levenshtein(&name, &candidate.to_lowercase()), candidate))
        .min_by_key(|(distance, _)| *distance)
        .filter(|(distance, candidate)| *distance <= candidate.chars().count().div_ceil(3).max(1))
        .map(|(_, candidate)| candidate.to_owned())
}

/// The end of a message about a name that is not there; two names that are meant are joined by "and".
pub(super) fn suggestion(nearest: &Option<String>) -> String {
    nearest.as_ref().map_or_else(String::new, |name| format!(": did you mean `{}`?", name.replace(" and ", "` and `")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_names_are_suggested_and_far_ones_are_not() {
        let known = ["length", "width", "thickness", "height"];
        assert_eq!(nearest("lenght", known).as_deref(), Some("length"));
        assert_eq!(nearest("Width", known).as_deref(), Some("width"));
        assert_eq!(nearest("temperature", known), None);
        // Names of 50,000 letters once took half a minute.
        let long = "x".repeat(50_000);
        assert_eq!(nearest(&long[1..], [long.as_str(), "width"]), None);
        assert_eq!(nearest("widht", [long.as_str(), "width"]).as_deref(), Some("width"));
    }
}
