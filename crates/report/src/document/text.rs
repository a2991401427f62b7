//! A document as text for a terminal.

use super::{Document, Part, Table};
use crate::text_table::table;

impl Document {
    /// Formats the document as text: the main results, then its sections without figures and parts for the page only.
    pub fn text(&self) -> String {
        let mut terminal = Terminal { text: String::new(), headings: [None, None] };
        self.lead.iter().for_each(|paragraph| terminal.line(paragraph));
        for section in &self.sections {
            terminal.headings = [Some(&section.title), None];
            terminal.parts(&section.parts);
        }
        terminal.text
    }
}

/// The text so far.
struct Terminal<'a> {
    text: String,
    /// The headings of section and part, printed only when something follows them.
    headings: [Option<&'a str>; 2],
}

impl<'a> Terminal<'a> {
    fn parts(&mut self, parts: &'a [Part]) {
        for part in parts {
            match part {
                Part::Heading(text) => self.headings[1] = Some(text),
                Part::Text(text) => self.line(text),
                Part::List(items) => items.iter().for_each(|item| self.line(&format!("- {item}"))),
                Part::Notice { kind, texts, .. } => {
                    texts.iter().for_each(|text| self.line(&format!("{}: {text}", kind.to_lowercase())));
                }
                Part::Code(text) => text.lines().for_each(|line| self.line(format!("    {line}").trim_end())),
                Part::Table(table) => self.table(table),
                Part::Details { parts, .. } => self.parts(parts),
                Part::Figure(_) | Part::Gallery(_) | Part::Links(_) | Part::Frame { .. } | Part::OnPage(_) => (),
            }
        }
    }

    fn line(&mut self, line: &str) {
        for heading in std::mem::take(&mut self.headings).into_iter().flatten() {
            let gap = if self.text.is_empty() { "" } else { "\n" };
            self.text.push_str(&format!("{gap}{heading}\n"));
        }
        self.text.push_str(&format!("{line}\n"));
    }

    fn table(&mut self, drawn: &Table) {
        let columns = drawn.printed_columns();
        let headings: Vec<&str> = columns.iter().map(|(_, heading, _)| *heading).collect();
        let of_text = (0..columns.len()).filter(|&place| !columns[place].2).collect::<Vec<_>>();
        let mut rows = table(&headings, &of_text);
        for row in drawn.printed_rows() {
            rows.add_row(row.iter().map(|cell| &cell.text));
        }
        self.line(&drawn.caption);
        self.line(&rows.to_string());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Section;

    #[test]
    fn a_terminal_shows_tables_and_sentences_and_no_empty_section() {
        let numbers = Table {
            printed: Some(vec![1]),
            sums: vec!["sum".into(), "3".into()],
            ..Table::from_rows("Two numbers.", [("a", "1"), ("b", "2")])
                .text("factor", |row| row.0)
                .number("S_1", |row| row.1)
                .into()
        };
        let document = Document {
            lead: vec!["b decides.".to_owned()],
            sections: vec![
                Section::new("page", "For the page", vec![Part::OnPage(vec![Part::Text("long".to_owned())])]),
                Section::new(
                    "both",
                    "For both",
                    vec![
                        Part::Heading("nothing below".to_owned()),
                        Part::Heading("something below".to_owned()),
                        Part::warnings(&["few runs".to_owned()]).unwrap(),
                        Part::Details { summary: "folded".to_owned(), parts: vec![Part::Table(numbers)] },
                    ],
                ),
            ],
            ..Document::default()
        };
        let text = document.text();
        let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
        assert_eq!(lines[..6], ["b decides.", "", "For both", "", "something below", "warning: Few runs."]);
        assert_eq!(lines[6], "Two numbers.");
        assert_eq!((lines[8], lines[10], lines[11]), ("  factor   S_1", "  b          2", "  sum        3"), "{text}");
        assert!(!text.contains("long"));
    }
}
