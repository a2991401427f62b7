//! Words of programs in ours: short, on one line, and equal for equal causes.

/// Characters of a program's words that a reason keeps.
const MAX_LETTERS: usize = 120;

/// One line of a program's own words, shortened, for reasons.
pub(crate) fn shortened(text: &str) -> String {
    cut(text.trim(), MAX_LETTERS)
}

/// The text on one line of at most `most` characters, without those that would change the terminal.
pub(crate) fn cut(text: &str, most: usize) -> String {
    let clean = text.trim_end().chars().map(|c| if c.is_control() { ' ' } else { c });
    let mut short: String = clean.take(most).collect();
    if text.trim_end().chars().nth(most).is_some() {
        short.push_str("...");
    }
    short
}

/// The same with every number as `#`: reasons that differ by the numbers of their rows alone are counted together.
pub(crate) fn masked(text: &str) -> String {
    let mut out = String::new();
    let mut letters = text.trim().chars().peekable();
    let mut before = ' ';
    while let Some(c) = letters.next() {
        let begins = c.is_ascii_digit() && !before.is_alphanumeric() && before != '_';
        if !begins {
            out.push(c);
            before = c;
            continue;
        }
        if out.ends_with(['-', '+']) {
            out.pop();
        }
        let mut last = c;
        while let Some(&next) = letters.peek() {
            let goes_on = next.is_ascii_digit()
                || matches!(next, '.' | 'e' | 'E')
                || (matches!(next, '-' | '+') && matches!(last, 'e' | 'E'));
            if !goes_on {
                break;
            }
            last = next;
            letters.next();
        }
        out.push('#');
        before = '#';
    }
    shortened(&out)
}

/// A duration as people write it.
#[cfg(feature = "study")]
pub(crate) fn seconds(duration: std::time::Duration) -> String {
    format!("{} s", duration.as_secs_f64())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_masked_and_names_are_not() {
        assert_eq!(masked("  no root at t=-1.5e-3, x2 = 7.\n"), "no root at t=#, x2 = #");
        assert_eq!(masked("1.0,2,-3E+5"), "#,#,#");
        assert_eq!(masked("float32 and a1b2"), "float32 and a1b2");
    }

    #[test]
    fn long_words_are_cut_and_stay_on_one_line() {
        let long = shortened(&"wörd\t".repeat(100));
        assert_eq!(long.chars().count(), MAX_LETTERS + 3);
        assert!(!long.contains('\t') && long.ends_with("..."));
    }

    proptest::proptest! {
        #[test]
        fn no_text_panics(text in proptest::prelude::any::<String>()) {
            let masked = masked(&text);
            proptest::prop_assert!(masked.chars().count() <= MAX_LETTERS + 3 && !masked.chars().any(char::is_control));
        }
    }
}
