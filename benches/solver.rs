//! Factors of an iteration matrix, and its solution: chains (dry is symmetric, drag makes it unsymmetric) and a net.
//! `cargo bench --bench solver`; items are elements.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use ropewalk::bench::{FullIteration, Pendulum};
use ropewalk::constraints::SphericalSpec;
use ropewalk::core::Width;
use ropewalk::elements::{CableSpec, Section};
use ropewalk::{Error, Scene};
use std::fmt;

fn main() {
    divan::main();
}

/// What is solved, and how large.
#[derive(Clone, Copy)]
enum Case {
    Chain(usize),
    Unsymmetric(usize),
    Net(usize),
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Case::Chain(n) => write!(f, "chain, symmetric, {n}"),
            Case::Unsymmetric(n) => write!(f, "chain, unsymmetric, {n}"),
            Case::Net(n) => write!(f, "net of {n} x {n} meshes"),
        }
    }
}

impl Case {
    fn elements(self) -> usize {
        match self {
            Case::Chain(n) | Case::Unsymmetric(n) => n,
            Case::Net(n) => 2 * n * (n + 1) * ALONG,
        }
    }
    /// Assembled, factored and solved once.
    fn ready(self) -> Result<FullIteration, Error> {
        let mut ready = match self {
            Case::Chain(n) => FullIteration::new(&Pendulum::new(n), Width::best())?,
            Case::Unsymmetric(n) => FullIteration::new(&Pendulum::new(n).in_water(), Width::best())?,
            Case::Net(n) => FullIteration::of(net(n).build()?)?,
        };
        ready.run()?;
        Ok(ready)
    }
}

/// Elements along a side of a mesh.
const ALONG: usize = 4;

/// A square net of ropes, knotted where they cross.
fn net(n: usize) -> Scene {
    let section = Section::new(0.1, 5000.0, 0.01);
    let mut scene = Scene::new();
    for k in 0..=n {
        let (at, end) = (k as f64, n as f64);
        let lines = [("weft", [0.0, at, 0.0], [end, at, 0.0]), ("warp", [at, 0.0, 0.0], [at, end, 0.0])];
        for (name, from, to) in lines {
            let line = CableSpec::straight(&format!("{name}{k}"), from, to, n * ALONG, section.clone());
            scene.element(line);
        }
    }
    for i in 0..=n {
        for j in 0..=n {
            let ends = (format!("weft{j}@{i}m"), format!("warp{i}@{j}m"));
            scene.constraint(SphericalSpec::new(&format!("knot{i}-{j}"), ends.0.as_str(), ends.1.as_str()));
        }
    }
    scene
}

fn cases() -> Vec<Case> {
    let sizes = [32, 128, 512, 2048, 8192];
    let chains = sizes.into_iter().flat_map(|n| [Case::Chain(n), Case::Unsymmetric(n)]);
    chains.chain([4, 8].map(Case::Net)).collect()
}

#[divan::bench(args = cases())]
fn factor(bencher: Bencher<'_, '_>, case: Case) {
    let mut ready = case.ready().expect("ready");
    let items = ItemsCount::new(case.elements());
    bencher.counter(items).bench_local(|| black_box(&mut ready).factor().expect("factors"));
}

/// With factors that were checked before.
#[divan::bench(args = cases())]
fn solve(bencher: Bencher<'_, '_>, case: Case) {
    let mut ready = case.ready().expect("ready");
    let items = ItemsCount::new(case.elements());
    bencher.counter(items).bench_local(|| black_box(&mut ready).solve().expect("solution"));
}
