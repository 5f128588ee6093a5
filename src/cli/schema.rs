use clap::Args;
use impinge::scene;

use super::CliError;

/// Print the JSON schema of scenes (draft 2020-12), by which editors complete and check them
#[derive(Args)]
pub struct Schema {
    /// Print the tables of keys of docs/scene.md instead
    #[arg(long)]
    markdown: bool,
}

impl Schema {
    pub fn execute(&self) -> Result<String, CliError> {
        let schema = scene::Schema::of_scenes();
        if !self.markdown {
            return Ok(format!("{:#}\n", schema.json()));
        }
        let sections = scene::SECTIONS.iter();
        let sections = sections
            .map(|(heading, place)| format!("## {heading}\n{}", scene::table(&schema, place)));
        Ok(sections.collect::<Vec<_>>().join("\n"))
    }
}
