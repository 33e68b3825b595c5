//! A cable that falls freely, stepped: for the same count of instructions in programs that have more to offer and less.

use ropewalk_core::Model;
use ropewalk_core::integrator::{Alpha, Integrator, Options, Stepping, Workspace, prepare};
use std::error::Error;

pub const ELEMENTS: usize = 64;
/// Steps that are counted, after as many to warm up.
pub const STEPS: usize = 10;
const H: f64 = 1e-3;
pub const G: [f64; 3] = [0.0, 0.0, -9.81];

/// Calls the work where instructions are counted: valgrind finds this function by its name.
#[inline(never)]
pub fn counted_by_valgrind(work: &mut dyn FnMut()) {
    work();
}

/// Counts the steps of a model.
pub fn count_steps(model: &Model) -> Result<(), Box<dyn Error>> {
    let options = Options { stepping: Stepping::Fixed { h: H }, ..Options::default() };
    let mut integrator = Alpha::new(&options, model, 1.0)?;
    let mut work = Workspace::new(model)?;
    let mut state = model.state();
    prepare(model, &mut state, &mut work, &integrator)?;
    let mut done = Ok(());
    let mut steps = || {
        for _ in 0..STEPS {
            if let Err(e) = integrator.step(model, &mut state, &mut work, H) {
                done = Err(e);
            }
        }
    };
    steps();
    counted_by_valgrind(&mut steps);
    Ok(done?)
}
