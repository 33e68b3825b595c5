//! The full Newton iteration and the step of a pendulum, dry and in water.
//! `cargo bench --bench newton`; items are elements, in `step` times the steps of a sample.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use ropewalk::bench::{FullIteration, Pendulum, Steps};
use ropewalk::core::Width;

const SIZES: [usize; 6] = [8, 32, 128, 512, 2048, 8192];
/// Steps from the release on in one sample.
const STEPS: usize = 20;

fn main() {
    divan::main();
}

fn iterate(bencher: Bencher<'_, '_>, problem: &Pendulum) {
    let mut iteration = FullIteration::new(problem, Width::best()).expect("model");
    let items = ItemsCount::new(problem.elements);
    bencher.counter(items).bench_local(|| black_box(&mut iteration).run().expect("solution"));
}

fn advance(bencher: Bencher<'_, '_>, problem: &Pendulum) {
    let mut steps = Steps::new(problem, Width::best()).expect("start");
    bencher.counter(ItemsCount::new(STEPS * problem.elements)).bench_local(|| {
        steps.rewind();
        black_box(&mut steps).run(STEPS).expect("steps");
    });
}

#[divan::bench(args = SIZES)]
fn iteration_dry(bencher: Bencher<'_, '_>, elements: usize) {
    iterate(bencher, &Pendulum::new(elements));
}

#[divan::bench(args = SIZES)]
fn iteration_in_water(bencher: Bencher<'_, '_>, elements: usize) {
    iterate(bencher, &Pendulum::new(elements).in_water());
}

#[divan::bench(args = SIZES)]
fn step_dry(bencher: Bencher<'_, '_>, elements: usize) {
    advance(bencher, &Pendulum::new(elements));
}

#[divan::bench(args = SIZES)]
fn step_in_water(bencher: Bencher<'_, '_>, elements: usize) {
    advance(bencher, &Pendulum::new(elements).in_water());
}
