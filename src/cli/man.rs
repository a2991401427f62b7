//! `apportion man`: the manual as pages of roff.

use std::path::PathBuf;

use anyhow::anyhow;
use apportion::report::{prepare_folder, write_atomically};
use apportion::study::nearest;
use clap_mangen::Man;

use super::{Failure, print_raw, say};

#[derive(clap::Args)]
#[command(after_help = "To read a page: apportion man run | man -l -
To install all: apportion man --out ~/.local/share/man/man1")]
pub struct Arguments {
    /// The command whose page is printed [default: that of the whole program]
    #[arg(conflicts_with = "out")]
    command: Option<String>,
    /// Write all pages to this folder: apportion.1, apportion-run.1, ...
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub fn man(arguments: &Arguments) -> Result<(), Failure> {
    let pages = pages()?;
    let Some(folder) = &arguments.out else {
        let wanted = arguments.command.as_ref().map_or_else(|| "apportion".to_owned(), |c| format!("apportion-{c}"));
        return match pages.iter().find(|(name, _)| *name == wanted) {
            Some((_, page)) => print_raw(page),
            None => Err(unknown(arguments.command.as_deref().unwrap_or_default(), &pages)),
        };
    };
    prepare_folder(folder)?;
    for (name, page) in &pages {
        write_atomically(&folder.join(format!("{name}.1")), page)?;
    }
    say(&format!("wrote {} pages to {}", pages.len(), folder.display()));
    Ok(())
}

/// Every page with its name, that of the whole program first.
fn pages() -> Result<Vec<(String, Vec<u8>)>, Failure> {
    let mut program = super::command().disable_help_subcommand(true);
    program.build();
    let mut pages = Vec::new();
    let subcommands: Vec<clap::Command> = program.get_subcommands().cloned().collect();
    for command in std::iter::once(program).chain(subcommands) {
        let name = command.get_display_name().unwrap_or(command.get_name()).to_owned();
        let mut page = Vec::new();
        Man::new(command).source(format!("apportion {}", env!("CARGO_PKG_VERSION"))).render(&mut page)?;
        pages.push((name, page));
    }
    Ok(pages)
}

fn unknown(name: &str, pages: &[(String, Vec<u8>)]) -> Failure {
    let commands = || pages.iter().filter_map(|(page, _)| page.strip_prefix("apportion-"));
    let hint = nearest(name, commands()).map_or_else(String::new, |near| format!(", did you mean `{near}`?"));
    let known = commands().collect::<Vec<_>>().join(", ");
    Failure::Input(anyhow!("there is no command `{name}`{hint} (commands: {known})"))
}
