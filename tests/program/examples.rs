//! The examples run.

#[path = "../../examples/custom_assembly.rs"]
mod custom_assembly;

#[test]
fn custom_assembly_runs() {
    custom_assembly::main().unwrap();
}
