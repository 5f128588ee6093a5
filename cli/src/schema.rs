use clap::Args;
use impinge::scene::SCHEMA;

use super::CliError;

/// Print the JSON schema of scenes (draft 2020-12), by which editors complete and check them
#[derive(Args)]
pub struct Schema {}

impl Schema {
    pub fn execute(&self) -> Result<String, CliError> {
        Ok(SCHEMA.to_owned())
    }
}
