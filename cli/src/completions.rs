use clap::{Args, CommandFactory};
use clap_complete::Shell;

use super::{Arguments, CliError};

/// Print completions of commands and options for a shell; docs/install.md shows where each shell looks for them
#[derive(Args)]
pub struct Completions {
    #[arg(value_enum)]
    shell: Shell,
}

impl Completions {
    pub fn execute(&self) -> Result<String, CliError> {
        let mut script = Vec::new();
        let mut program = Arguments::command();
        clap_complete::generate(self.shell, &mut program, "impinge", &mut script);
        Ok(String::from_utf8_lossy(&script).into_owned())
    }
}
