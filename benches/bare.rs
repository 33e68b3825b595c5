//! A program that has cables and weight and nothing else: no water, no drag, no scenes, no command line. What its
//! steps cost is compared by `cargo bench --bench instructions`.

mod free_fall;

use free_fall::{ELEMENTS, G, count_steps};
use ropewalk_core::Per;
use ropewalk_elements::{CableSpec, Section};
use ropewalk_scene::{Builder, ElementSpec};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let mut b = Builder::new();
    let section = Section::new(0.5, 5000.0, 0.1);
    CableSpec::straight("cable", [0.0; 3], [1.0, 0.0, 0.0], ELEMENTS, section).build(&mut b)?;
    for (_, part) in b.parts(&[])? {
        b.term(part.dead_load(Per::Mass, G).ok_or("a cable has weight")?);
    }
    count_steps(&b.finish()?)
}
