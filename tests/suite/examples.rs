//! The examples run, and what they assert holds.

#[path = "../../examples/function_model.rs"]
mod function_model;
#[path = "../../examples/units_and_failures.rs"]
mod units_and_failures;

#[test]
fn examples_run() {
    function_model::main().unwrap();
    units_and_failures::main().unwrap();
}
