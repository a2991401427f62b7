//! A study file run from Rust, with progress.
//!
//!     cargo run --release --example study_file

use std::error::Error;

pub fn main() -> Result<(), Box<dyn Error>> {
    let study = apportion_files::load_study("studies/ishigami.toml".as_ref(), &[])?;
    let result = study.runner().on_progress(|progress| eprintln!("{} runs", progress.done)).run()?;
    for factor in study.space().factors() {
        let total = result.output("y")?.factor(&factor.name)?.total;
        println!("{}: {:.4}", factor.name, total.estimate);
    }
    Ok(())
}
