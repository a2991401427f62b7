//! The fenced blocks of a Markdown page, with the comments above them.

/// The use of a block.
#[derive(Debug, PartialEq)]
pub enum Role {
    /// As its language determines.
    Plain,
    /// It is the file of this name.
    File(String),
    /// It is what the block before printed.
    Output,
    /// It ends with this exit code.
    Exit(i32),
    /// It is not run.
    NotRun,
}

/// A fenced block.
#[derive(Debug)]
pub struct Block {
    pub language: String,
    pub role: Role,
    pub text: String,
    /// Line of its fence, from 1.
    pub line: usize,
}

/// A page as its blocks.
pub struct Page {
    /// Path in the sources.
    pub name: String,
    pub blocks: Vec<Block>,
    /// Its sentences: all lines outside of blocks and comments.
    pub prose: String,
    /// Errors of its format.
    pub faults: Vec<String>,
}

impl Page {
    pub fn new(name: &str, text: &str) -> Self {
        let mut page = Self { name: name.to_owned(), blocks: Vec::new(), prose: String::new(), faults: Vec::new() };
        let mut role = Role::Plain;
        let mut lines = text.lines().enumerate().peekable();
        let mut above = "";
        while let Some((number, line)) = lines.next() {
            let trimmed = line.trim_start();
            let indent = line.len() - trimmed.len();
            if let Some(language) = trimmed.strip_prefix("```") {
                let mut content = String::new();
                let mut is_closed = false;
                for (_, inner) in lines.by_ref() {
                    if inner.trim() == "```" {
                        is_closed = true;
                        break;
                    }
                    content
                        .push_str(inner.get(indent.min(inner.len() - inner.trim_start().len())..).unwrap_or_default());
                    content.push('\n');
                }
                if !is_closed {
                    page.fault(number, "a block without an end");
                }
                let role = std::mem::replace(&mut role, Role::Plain);
                page.blocks.push(Block { language: language.to_owned(), role, text: content, line: number + 1 });
            } else if let Some(comment) = trimmed.strip_prefix("<!-- ").and_then(|rest| rest.strip_suffix(" -->")) {
                let is_block_next = lines.peek().is_some_and(|(_, next)| next.trim_start().starts_with("```"));
                page.comment(number, comment, is_block_next, &mut role);
            } else {
                let is_code = indent >= 4 && above.is_empty() && !is_of_a_list(&page.prose);
                if is_code && !(name == "README.md" && trimmed.starts_with("cargo ")) {
                    page.fault(number, "code by indentation: put it into a fenced block");
                }
                page.prose.push_str(line);
                page.prose.push('\n');
            }
            above = trimmed;
        }
        page
    }

    fn comment(&mut self, number: usize, comment: &str, is_block_next: bool, role: &mut Role) {
        if let Some(command) = comment.strip_prefix("setup: ") {
            let text = format!("{command}\n");
            self.blocks.push(Block { language: "sh".to_owned(), role: Role::Plain, text, line: number + 1 });
            return;
        }
        *role = match comment.split_once(": ") {
            Some(("file", name)) => Role::File(name.to_owned()),
            Some(("exit", code)) => Role::Exit(code.parse().unwrap_or(-1)),
            Some(("not run", _)) => Role::NotRun,
            None if comment == "output" => Role::Output,
            // A remark for those who edit the page.
            _ => return,
        };
        if !is_block_next {
            self.fault(number, "the line below this comment is no block");
        }
    }

    fn fault(&mut self, number: usize, what: &str) {
        self.faults.push(format!("{}:{}: {what}", self.name, number + 1));
    }
}

/// Whether what follows `prose` can be the continuation of an item.
fn is_of_a_list(prose: &str) -> bool {
    let last = prose.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or_default();
    let start = last.trim_start();
    start.len() < last.len()
        || ["- ", "* "].iter().any(|mark| start.starts_with(mark))
        || start.split_once(". ").is_some_and(|(number, _)| number.parse::<u32>().is_ok())
}
