//! The examples run, and their assertions hold.

#[path = "../../../examples/function_model.rs"]
mod function_model;
#[path = "../../../examples/interrupted.rs"]
mod interrupted;
#[path = "../../../examples/own_program.rs"]
mod own_program;
#[path = "../../../examples/pendulum.rs"]
mod pendulum;
#[path = "../../../examples/study_file.rs"]
mod study_file;
#[path = "../../../examples/three_steps.rs"]
mod three_steps;
#[path = "../../../examples/units_and_failures.rs"]
mod units_and_failures;

#[test]
fn examples_run() {
    // Users start them in the folder of the sources; no other test depends on the working directory.
    std::env::set_current_dir(crate::common::root()).unwrap();
    function_model::main().unwrap();
    pendulum::main().unwrap();
    study_file::main().unwrap();
    units_and_failures::main().unwrap();
}

#[test]
fn an_interrupted_run_is_resumed() {
    interrupted::main().unwrap();
}

#[test]
fn a_program_is_asked_from_rust() {
    own_program::main().unwrap();
}

#[test]
fn three_steps_are_joined_by_files() {
    three_steps::main().unwrap();
}
