//! Commands of the program wherever a page writes them: `apportion COMMAND --option`.

use std::collections::HashMap;

use super::page::{Page, Role};
use crate::common::succeed;

/// The commands according to the help of the program.
pub struct Known {
    commands: Vec<String>,
    help: HashMap<String, String>,
}

impl Known {
    pub fn new() -> Self {
        let help = succeed(&["--help"]);
        let list = help.split("Commands:").nth(1).unwrap().split("Options:").next().unwrap();
        let is_start = |line: &&str| line.starts_with("  ") && !line.starts_with("   ");
        let first = |line: &str| line.split_whitespace().next().unwrap_or_default().to_owned();
        Self { commands: list.lines().filter(is_start).map(first).collect(), help: HashMap::new() }
    }

    /// The names on a page that do not exist.
    pub fn faults(&mut self, page: &Page) -> Vec<String> {
        let spans = page.prose.split('`').skip(1).step_by(2).map(|span| span.replace('\n', " "));
        let scripts = page.blocks.iter().filter(|block| block.language == "sh" || block.role == Role::NotRun);
        let lines =
            scripts.flat_map(|block| block.text.replace("\\\n", " ").lines().map(str::to_owned).collect::<Vec<_>>());
        let told: Vec<String> = spans.chain(lines).collect();
        told.iter().filter_map(|line| Some(format!("{}: {}", page.name, self.fault(line)?))).collect()
    }

    fn fault(&mut self, line: &str) -> Option<String> {
        let code = line.split(" #").next().unwrap_or_default();
        let is_name = |word: &str| {
            word.chars().all(|letter| letter.is_ascii_lowercase() || letter == '-')
                && word.starts_with(char::is_alphabetic)
        };
        let mut words = code.split_whitespace().map(|word| word.trim_matches(['\'', '"', ')', ';', ',']));
        // Neither the name of the Python package nor the first bytes of a journal.
        if code.contains("import ") || code == "apportion journal" {
            return None;
        }
        words.find(|word| *word == "apportion")?;
        let command = words.next()?;
        if !is_name(command) {
            return None;
        }
        if !self.commands.iter().any(|known| known == command) {
            return Some(format!("there is no command `{command}` ({line})"));
        }
        let help = self.help.entry(command.to_owned()).or_insert_with(|| succeed(&[command, "--help"]));
        let options = words.take_while(|word| !["|", "&&", ">"].contains(word)).filter(|word| word.starts_with("--"));
        let mut names =
            options.map(|option| option.split('=').next().unwrap_or_default()).filter(|name| name.len() > 2);
        names
            .find(|name| !help.split(|letter: char| letter.is_whitespace() || letter == ',').any(|word| word == *name))
            .map(|name| format!("`apportion {command}` has no option `{name}` ({line})"))
    }
}
