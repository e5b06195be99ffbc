//! `driftworld completions`: what shells need to complete the command's arguments. Which there are, they learn from clap.

use clap::Args;
use clap_complete::{Shell, generate};

use super::{Failure, output};

/// Print completions for bash, zsh, fish, elvish or PowerShell.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld completions bash > ~/.local/share/bash-completion/completions/driftworld
  driftworld completions zsh > ~/.zfunc/_driftworld       # with fpath+=~/.zfunc before compinit in ~/.zshrc
  driftworld completions fish > ~/.config/fish/completions/driftworld.fish
  driftworld completions powershell >> $PROFILE")]
pub(crate) struct Completions {
    /// The shell.
    shell: Shell,
}

impl Completions {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let mut script = Vec::new();
        generate(self.shell, &mut super::command(), "driftworld", &mut script);
        output::print_data(&String::from_utf8_lossy(&script))
    }
}
