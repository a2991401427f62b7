//! Rules for the names that users choose, file names derived from them, and enums selected by name.
//!
//! Names appear in tables, charts, pages, terminals and file names. A name is checked when it is read; file names are
//! always safe and unique.

/// Declares an enum without fields together with `ALL` and `name`, so that the three stay consistent.
#[macro_export]
macro_rules! named {
    ($(#[$meta:meta])* pub enum $type:ident { $($(#[$variant_meta:meta])* $variant:ident = $name:literal,)+ }) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum $type { $($(#[$variant_meta])* $variant,)+ }

        impl $type {
            /// All variants, in the order of declaration.
            pub const ALL: [Self; [$($name),+].len()] = [$(Self::$variant),+];

            /// Returns the name used in study files and results.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $name),+ }
            }
        }

        impl $crate::names::Named for $type {
            const CHOICES: &'static [(&'static str, Self)] = &[$(($name, Self::$variant)),+];
        }
    };
}

pub use named;

/// An enum that is selected by name.
pub trait Named: Copy + 'static {
    /// All variants with their names, in the order of declaration.
    const CHOICES: &'static [(&'static str, Self)];
}

/// Maximum number of characters in the name of a factor, output, group or label, more than any table or chart shows.
pub const LONGEST_NAME: usize = 200;

/// Maximum number of characters in a title.
const LONGEST_TITLE: usize = 500;

/// Maximum number of bytes in the name of a study: most systems allow 255 bytes in a file name, and endings are added.
pub const LONGEST_STUDY_NAME: usize = 120;

/// Maximum number of bytes that an output's name contributes to a file name.
const LONGEST_PART: usize = 80;

/// Returns whether `c` is invisible but changes the text around it: a control character, a mark of writing direction, a
/// line separator or a character of zero width.
pub fn is_hidden(c: char) -> bool {
    c.is_control()
        || matches!(
            c,
            '\u{ad}'
                | '\u{61c}'
                | '\u{180e}'
                | '\u{200b}'..='\u{200f}'
                | '\u{2028}'..='\u{202e}'
                | '\u{2060}'..='\u{206f}'
                | '\u{feff}'
                | '\u{fff9}'..='\u{fffb}'
                | '\u{fffe}'
                | '\u{ffff}'
                | '\u{e0000}'..='\u{e007f}'
        )
}

/// Returns why `name` cannot name a factor, group or label, in words that follow "expected"; `None` if it can.
pub fn refused_name(name: &str) -> Option<String> {
    if name.trim().is_empty() {
        return Some("a name that is not empty".to_owned());
    }
    if name.chars().count() > LONGEST_NAME {
        return Some(format!("at most {LONGEST_NAME} characters"));
    }
    let visible = "a name without control characters and invisible characters (line separators, direction marks)";
    name.contains(is_hidden).then(|| visible.to_owned())
}

/// Returns the same for the name of an output, which is also used in file names.
pub fn refused_output_name(name: &str) -> Option<String> {
    let leads_away = name.contains(['/', '\\', ':']);
    refused_name(name).or(leads_away.then(|| "a name without / \\ : (files are named after it)".to_owned()))
}

/// Returns the same for a title; an empty title counts as none.
pub fn refused_title(title: &str) -> Option<String> {
    if title.chars().count() > LONGEST_TITLE {
        return Some(format!("at most {LONGEST_TITLE} characters"));
    }
    let hidden = title.contains(|c| is_hidden(c) && !matches!(c, '\n' | '\t'));
    hidden.then(|| "a text without control characters and invisible characters".to_owned())
}

/// The rule for a unit or the name of an axis, in words that follow "must be".
pub const SHORT_TEXT: &str = "a text of up to 60 characters, without control characters";

/// Returns whether `text` satisfies [`SHORT_TEXT`].
pub fn is_short_text(text: &str) -> bool {
    text.chars().count() <= 60 && !text.contains(is_hidden)
}

/// Returns a name or value as messages show it: shortened if it is long, without hidden characters.
pub fn shown(text: &str) -> String {
    let mut chars = text.chars();
    let begin: String = chars.by_ref().take(60).collect();
    match chars.next() {
        Some(_) => format!("{begin:?}... ({} characters)", text.chars().count()),
        None => format!("{begin:?}"),
    }
}

/// Returns `name` as part of a file name: without characters that are special in a file system, and not too long.
///
/// ```
/// assert_eq!(apportion_base::names::file_part("../x: y"), ".._x_ y");
/// ```
pub fn file_part(name: &str) -> String {
    let mut part = name.replace(|c| is_hidden(c) || "/\\:*?\"<>|".contains(c), "_");
    part.truncate(part.floor_char_boundary(LONGEST_PART));
    part
}

/// The rule for the name of a study.
pub const NAME_RULE: &str =
    "letters, digits, '-', '_', '.' and spaces, not starting with a dot, at most 120 bytes (files are named after it)";

/// Returns whether `name` satisfies [`NAME_RULE`].
pub fn names_files(name: &str) -> bool {
    let mut chars = name.chars();
    let are_allowed = chars.all(|c| c.is_alphanumeric() || "-_. ".contains(c));
    are_allowed && !name.trim().is_empty() && name.len() <= LONGEST_STUDY_NAME && !name.starts_with('.')
}

/// Maximum number of characters of a name that is compared with others: longer ones would take long.
const LONGEST_COMPARED: usize = 100;

fn is_long(name: &str) -> bool {
    name.chars().nth(LONGEST_COMPARED).is_some()
}

/// Returns the one of `names` nearest to `name`, if it is close enough to be meant. Names of more than 100 characters
/// match none.
pub fn nearest<'a>(name: &str, names: impl IntoIterator<Item = &'a str>) -> Option<String> {
    if is_long(name) {
        return None;
    }
    let name = name.to_lowercase();
    names
        .into_iter()
        .filter(|candidate| !is_long(candidate))
        .map(|candidate| (strsim::damerau_levenshtein(&name, &candidate.to_lowercase()), candidate))
        .min_by_key(|(distance, _)| *distance)
        .filter(|(distance, candidate)| *distance <= candidate.chars().count().div_ceil(3).max(1))
        .map(|(_, candidate)| candidate.to_owned())
}

/// Returns the end of a message about an unknown name, if a similar one exists.
pub fn did_you_mean(nearest: &Option<String>) -> String {
    nearest.as_ref().map_or_else(String::new, |name| format!(": did you mean `{name}`?"))
}

#[cfg(test)]
#[path = "tests/names.rs"]
mod tests;
