//! Tables and sentences within the width of a terminal, broken between words.

use unicode_width::UnicodeWidthStr;

/// After these a name may be broken where it does not fit as a whole.
const JOINTS: [char; 7] = ['_', '-', '/', '.', ':', ',', '+'];

/// Columns of a name that is broken anywhere, because nothing else is left to do.
const LEAST: usize = 8;

/// How `text` may be broken.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Breaks {
    /// Between words.
    Words,
    /// Inside a word after one of [`JOINTS`].
    Joints,
    /// Anywhere.
    Anywhere,
}

/// `text` with every line of more than `width` columns broken between words; what follows a break is indented. Lines that
/// are drawn, as tables and places in files are, stay as they are, and so does a word that is too long by itself.
///
/// ```
/// use apportion::report::wrapped;
///
/// assert_eq!(wrapped("note: the factors stand in no formula", 20), "note: the factors\n  stand in no\n  formula");
/// ```
pub fn wrapped(text: &str, width: usize) -> String {
    let line = |line: &str| {
        let margin = line.len() - line.trim_start().len();
        if line.width() <= width || is_drawn(line) || margin + 2 >= width {
            return line.to_owned();
        }
        let indent = " ".repeat(margin + 2);
        let mut lines = fill(&words(line.trim_start()), width - margin, width - margin - 2).into_iter();
        let first = format!("{}{}", &line[..margin], lines.next().unwrap_or_default());
        lines.fold(first, |text, line| format!("{text}\n{indent}{line}"))
    };
    text.split('\n').map(line).collect::<Vec<_>>().join("\n")
}

/// Rules of tables, and the margin beside a line of a file.
fn is_drawn(line: &str) -> bool {
    line.contains('─') || line.trim_start_matches(|c: char| c.is_ascii_digit() || c == ' ').starts_with('|')
}

/// The cells of a table, row by row, each with the line breaks it needs so that the columns take no more than `width`
/// together.
pub(super) fn fitted(rows: &[Vec<String>], width: usize) -> Vec<Vec<String>> {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let widths = widths(rows, columns, width);
    let cell = |(text, limit): (&String, &usize)| broken(text, *limit).join("\n");
    rows.iter().map(|row| row.iter().zip(&widths).map(cell).collect()).collect()
}

/// Whether the columns can take no more than `width` together without a break inside a number.
pub(super) fn keeps_numbers(rows: &[Vec<String>], width: usize) -> bool {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    least(rows, columns, Breaks::Joints).iter().sum::<usize>() <= width
}

fn longest(rows: &[Vec<String>], column: usize, of: &dyn Fn(&str) -> usize) -> usize {
    rows.iter().filter_map(|row| row.get(column)).map(|text| of(text)).max().unwrap_or(0)
}

/// The width of the longest piece of each column.
fn least(rows: &[Vec<String>], columns: usize, breaks: Breaks) -> Vec<usize> {
    let longest_piece = |text: &str| pieces(text, breaks).iter().map(|piece| piece.width()).max().unwrap_or(0);
    (0..columns).map(|column| longest(rows, column, &longest_piece)).collect()
}

fn widths(rows: &[Vec<String>], columns: usize, width: usize) -> Vec<usize> {
    let longest = |column: usize, of: &dyn Fn(&str) -> usize| longest(rows, column, of);
    let natural: Vec<usize> = (0..columns).map(|column| longest(column, &|text| text.width())).collect();
    let least = |breaks: Breaks| least(rows, columns, breaks);
    let mut widths: Vec<usize> = natural.iter().map(|natural| (*natural).min(width)).collect();
    let anywhere = natural.iter().map(|natural| (*natural).min(LEAST)).collect();
    // Nothing is broken inside a word as long as something can be broken between words; the widest column gives first.
    for least in [least(Breaks::Words), least(Breaks::Joints), anywhere] {
        while widths.iter().sum::<usize>() > width {
            let narrower = (0..columns).filter(|column| widths[*column] > least[*column]);
            let Some(widest) = narrower.max_by_key(|column| widths[*column]) else { break };
            widths[widest] -= 1;
        }
    }
    // What a broken column leaves free goes to those that need little to be whole.
    for (column, limit) in widths.iter_mut().enumerate() {
        *limit = longest(column, &|text| broken(text, *limit).iter().map(|line| line.width()).max().unwrap_or(0));
    }
    let mut order: Vec<usize> = (0..columns).collect();
    order.sort_by_key(|column| natural[*column].saturating_sub(widths[*column]));
    for column in order {
        let left = width.saturating_sub(widths.iter().sum());
        if natural[column].saturating_sub(widths[column]) <= left {
            widths[column] = natural[column];
        }
    }
    widths
}

/// The words of `text`; `±` stays with the number after it.
fn words(text: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match words.last_mut() {
            Some(last) if last == "±" => *last = format!("± {word}"),
            _ => words.push(word.to_owned()),
        }
    }
    words
}

/// What stays together.
fn pieces(text: &str, breaks: Breaks) -> Vec<String> {
    let words = words(text);
    match breaks {
        Breaks::Words => words,
        Breaks::Joints => words.iter().flat_map(|word| joined(word)).collect(),
        Breaks::Anywhere => words.iter().flat_map(|word| word.chars()).map(String::from).collect(),
    }
}

/// The parts of a name with the joints after them. A number, which has the same signs in it, is one part.
fn joined(word: &str) -> Vec<String> {
    if !word.starts_with(char::is_alphabetic) {
        return vec![word.to_owned()];
    }
    word.split_inclusive(JOINTS).map(str::to_owned).collect()
}

/// The words joined by spaces, in lines of up to `first` columns and then `limit`. A word that is longer has a line of its own.
fn fill(words: &[String], first: usize, limit: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in words {
        let most = if lines.len() > 1 { limit } else { first };
        match lines.last_mut() {
            Some(line) if line.width() + 1 + word.width() <= most => *line = format!("{line} {word}"),
            _ => lines.push(word.clone()),
        }
    }
    lines
}

/// `text` in lines of up to `limit` columns: broken between words, inside one that is longer after a joint, and anywhere
/// only where there is none.
fn broken(text: &str, limit: usize) -> Vec<String> {
    let mut fitting = Vec::new();
    for word in words(text) {
        if word.width() <= limit {
            fitting.push(word);
            continue;
        }
        let mut line = String::new();
        for piece in pieces(&word, Breaks::Joints) {
            let parts = if piece.width() > limit { pieces(&piece, Breaks::Anywhere) } else { vec![piece] };
            for part in parts {
                if !line.is_empty() && line.width() + part.width() > limit {
                    fitting.push(std::mem::take(&mut line));
                }
                line.push_str(&part);
            }
        }
        fitting.push(line);
    }
    fill(&fitting, limit, limit)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(rows: &[&[&str]]) -> Vec<Vec<String>> {
        rows.iter().map(|row| row.iter().map(|cell| (*cell).to_owned()).collect()).collect()
    }

    fn width_of(rows: &[Vec<String>]) -> usize {
        let column = |column: usize| {
            let lines = rows.iter().flat_map(|row| row[column].split('\n'));
            lines.map(|line| line.width()).max().unwrap_or(0)
        };
        (0..rows[0].len()).map(column).sum()
    }

    #[test]
    fn a_table_is_broken_between_words() {
        let table = rows(&[
            &["factor", "first order S1", "total ST"],
            &["static_friction", "0.3374 ± 0.0024", "0.5000 [0.4000, 0.5200]"],
        ]);
        assert_eq!(fitted(&table, 80), table);
        let narrow = fitted(&table, 45);
        assert_eq!(narrow[1], ["static_friction", "0.3374 ± 0.0024", "0.5000 [0.4000,\n0.5200]"]);
        assert!(width_of(&narrow) <= 45);
        // Names are broken where they are joined, and elsewhere only where they are not.
        let narrower = fitted(&table, 28);
        assert_eq!(narrower[1][0], "static_\nfriction");
        assert!(width_of(&narrower) <= 28, "{narrower:?}");
        // A longer name costs the others nothing that they do not need.
        let beside = rows(&[
            &["factor", "S1", "ST"],
            &["static_friction", "0.3374 ± 0.0024", "0.3374 ± 0.0024"],
            &["modulus_of_the_tip_of_the_probe", "0.3374 ± 0.0024", "0.3374 ± 0.0024"],
        ]);
        let beside = fitted(&beside, 36);
        assert_eq!(
            (beside[1][0].as_str(), beside[2][0].as_str()),
            ("static_friction", "modulus_of_the_tip_\nof_the_probe")
        );
        let long = rows(&[&["factor", "S1"], &["donaudampfschifffahrtsgesellschaft", "0.1 ± 0.2"]]);
        assert!(width_of(&fitted(&long, 24)) <= 24);
        assert!(fitted(&long, 24)[1][0].starts_with("donaudampfschif"));
    }

    #[test]
    fn any_width_and_any_text_are_taken() {
        let table = rows(&[&["a b", "", "±"], &["  ", "界界界界 界", "x_y_z-"], &["± ±", "\u{301}", "_"]]);
        for width in 0..40 {
            assert_eq!(fitted(&table, width).len(), 3);
            wrapped("  a b c\n\n ± 1 界界 界", width);
        }
    }

    #[test]
    fn sentences_are_broken_between_words_and_drawings_are_not() {
        let note = "note: factor `static_friction` stands in no formula";
        assert_eq!(wrapped(note, 32), "note: factor `static_friction`\n  stands in no formula");
        assert_eq!(wrapped(note, 80), note);
        let place = "12 | outputs.y = \"x1 + x2 + x3 + x4 + x5\"\n   | ^^^^^^^";
        assert_eq!(wrapped(place, 20), place);
        let path = "wrote /a/long/path/that/has/no/space/in/it.html";
        assert_eq!(wrapped(path, 20), "wrote\n  /a/long/path/that/has/no/space/in/it.html");
    }
}
