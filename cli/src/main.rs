//! The command line: `impinge check SCENE`, `impinge run SCENE`, `impinge schema`. Reports go to standard output; errors, warnings and progress to standard
//! error. Exit status: 0 done, 1 refused or failed, 2 wrong usage.

mod check;
mod error;
mod idle;
mod inputs;
mod patience;
mod run;
mod schema;
mod set;
mod summary;
mod table;
mod units;

use std::fmt::Display;
use std::io::{self, Write};
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use impinge::warning::Warning;

use error::CliError;

/// What a hot droplet does to the surface it hits: heat and stress
#[derive(Parser)]
#[command(name = "impinge", version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Check(check::Check),
    Run(run::Run),
    Schema(schema::Schema),
}

fn main() -> ExitCode {
    impinge::runtime::file_size::report_limits();
    let report = match Arguments::parse().command {
        Command::Check(command) => command.execute(),
        Command::Run(command) => command.execute(),
        Command::Schema(command) => command.execute(),
    };
    match report.and_then(|report| print(&report)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            print_message("error", &error);
            ExitCode::FAILURE
        }
    }
}

/// Says on standard error what is implausible in a scene.
fn warn(warnings: &[Warning]) {
    for warning in warnings {
        print_message("warning", warning);
    }
}

/// Says something on standard error; where that cannot be written there is nobody to tell.
fn print_message(kind: &str, what: &dyn Display) {
    let _ = writeln!(io::stderr(), "{kind}: {what}");
}

/// Prints a report; a reader that has seen enough and closed the pipe is no error.
fn print(report: &str) -> Result<(), CliError> {
    let mut out = io::stdout().lock();
    match out.write_all(report.as_bytes()).and_then(|()| out.flush()) {
        Err(reason) if reason.kind() != io::ErrorKind::BrokenPipe => Err(CliError::Print(reason)),
        _ => Ok(()),
    }
}
