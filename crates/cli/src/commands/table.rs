//! Tables from the user.

use std::path::Path;

use apportion_files::exchange::ReadOptions;

use super::say;

/// What the file of a table does not say itself.
#[derive(clap::Args)]
pub struct TableArguments {
    /// The first line of the table is a row, not a header
    #[arg(long)]
    no_header: bool,
    /// Numbers that mean a missing value, such as -9999, separated by commas
    #[arg(long, value_name = "X", value_delimiter = ',', allow_hyphen_values = true)]
    missing_value: Vec<f64>,
}

impl TableArguments {
    /// How to read a table of columns with these names; none if it names them itself.
    pub fn options(&self, names: &[String]) -> ReadOptions {
        let names = names.iter().map(|name| name.trim().to_owned()).collect();
        ReadOptions { names, no_header: self.no_header, missing: self.missing_value.clone() }
    }
}

/// Says which columns of a table were not read, and that it may have been cut short.
pub fn say_of_table(path: &Path, skipped: &[String], unended: bool) {
    let path = path.display();
    if !skipped.is_empty() {
        say(&format!("note: {path}: columns of text are skipped: {}", skipped.join(", ")));
    }
    if unended {
        say(&format!(
            "warning: {path}: the last line has no line end: if the file was cut short, its last number may be wrong"
        ));
    }
}
