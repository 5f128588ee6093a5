//! The command line: `impinge check SCENE`, `impinge run SCENE`.

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::main()
}
