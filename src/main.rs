//! The command line: `impinge check SCENE`, `impinge run SCENE`, `impinge schema`.

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    impinge::runtime::file_size::report_limits();
    cli::main()
}
