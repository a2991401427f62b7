//! `apportion schema`: JSON Schemas of the files that users and programs read and write.

use apportion::result::result_schema;
use apportion_files::study_schema;

use super::print_raw;

#[derive(clap::Args)]
#[command(
    after_help = "An editor with a TOML language server (taplo, as in Even Better TOML) completes and checks study files
whose first line names the schema:
  apportion schema study > study.schema.json
  #:schema ./study.schema.json"
)]
pub struct Arguments {
    /// The kind of file
    kind: Kind,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Kind {
    /// Studies (TOML)
    Study,
    /// Results of runs (JSON)
    Result,
}

pub fn schema(arguments: &Arguments) -> anyhow::Result<()> {
    let schema = match arguments.kind {
        Kind::Study => study_schema(),
        Kind::Result => result_schema(),
    };
    print_raw(format!("{schema:#}\n").as_bytes())
}
