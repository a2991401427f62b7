//! Findings are written for terminals and tables too, in plain letters; on the page they have proper ones.

/// Plain spellings with the letters that stand for them; each counts between other characters than letters and digits.
const WORDS: [(&str, &str); 12] = [
    ("um", "µm"),
    ("nm2", "nm²"),
    ("J/m2", "J/m²"),
    ("deg", "°"),
    ("psi", "ψ"),
    ("phi", "φ"),
    ("nu", "ν"),
    ("xi", "ξ"),
    ("tau", "τ"),
    ("omega", "ω"),
    ("mu_s", "μ_s"),
    ("F*_ss", "F_ss*"),
];

/// `text` with Greek letters, superscripts in units and true minus signs.
pub(super) fn typeset(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while !rest.is_empty() {
        let before = out.chars().last();
        let inside = before.is_some_and(|c| c.is_alphanumeric() || c == '_');
        let found = WORDS.iter().find(|(plain, _)| {
            !inside
                && rest
                    .strip_prefix(plain)
                    .is_some_and(|after| !after.starts_with(|c: char| c.is_alphanumeric() || c == '_'))
        });
        if let Some((plain, proper)) = found {
            out.push_str(proper);
            rest = &rest[plain.len()..];
            continue;
        }
        let mut letters = rest.chars();
        let Some(c) = letters.next() else { break };
        let minus = c == '-' && !inside && letters.as_str().starts_with(|c: char| c.is_ascii_digit());
        out.push(if minus { '−' } else { c });
        rest = letters.as_str();
    }
    out.replace(" °", "°").replace("R^2", "R²")
}

#[cfg(test)]
mod tests {
    use super::typeset;

    #[test]
    fn letters_are_proper_and_words_stay() {
        assert_eq!(typeset("from 200 to 700 um, -21 nm, 64 nm2"), "from 200 to 700 µm, −21 nm, 64 nm²");
        assert_eq!(typeset("psi of 41.5 deg, mu_s = 1, F*_ss"), "ψ of 41.5°, μ_s = 1, F_ss*");
        assert_eq!(
            typeset("number, degrees, maximum, 1e-4, LG-probe, R^2"),
            "number, degrees, maximum, 1e-4, LG-probe, R²"
        );
    }
}
