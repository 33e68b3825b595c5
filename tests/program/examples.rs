//! The examples run.

use ropewalk::scene::{Format, SceneFile};
use ropewalk::simulate;

#[path = "../../examples/custom_assembly.rs"]
mod custom_assembly;

#[test]
fn custom_assembly_runs() {
    custom_assembly::main().unwrap();
}

/// The whole scenes that a document shows.
fn scenes_of(text: &'static str) -> impl Iterator<Item = &'static str> {
    let blocks = text.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next());
    blocks.filter(|block| block.contains("elements") && block.contains("records"))
}

#[test]
fn scenes_of_the_documents_run() {
    for (document, text) in
        [("README", include_str!("../../README.md")), ("guide", include_str!("../../docs/guide.md"))]
    {
        let mut found = 0;
        for scene in scenes_of(text) {
            let file = SceneFile::parse(scene, document, Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
            simulate(file.scene()).unwrap_or_else(|e| panic!("{document}: {e}"));
            found += 1;
        }
        assert_eq!(found, 1, "{document}");
    }
}
