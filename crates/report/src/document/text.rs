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
