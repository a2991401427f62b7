//! `apportion completions`: shell completions of commands and options.

use clap::CommandFactory;
use clap_complete::{Shell, generate};

use super::{Cli, print_raw};

#[derive(clap::Args)]
#[command(after_help = "Where to put it:
  bash        apportion completions bash > ~/.local/share/bash-completion/completions/apportion
  zsh         apportion completions zsh > DIR/_apportion, with DIR in $fpath
  fish        apportion completions fish > ~/.config/fish/completions/apportion.fish
  powershell  apportion completions powershell >> $PROFILE
  elvish      apportion completions elvish >> ~/.config/elvish/rc.elv")]
pub struct Arguments {
    /// The shell
    shell: Shell,
}

pub fn completions(arguments: &Arguments) -> anyhow::Result<()> {
    let mut script = Vec::new();
    generate(arguments.shell, &mut Cli::command(), "apportion", &mut script);
    print_raw(&script)
}
