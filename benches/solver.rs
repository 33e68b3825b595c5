//! Factors of an iteration matrix, and its solution: chains, trees, nets and hubs, each symmetric and, with drag or damping
//! of its material, unsymmetric.
//! `cargo bench --bench solver`; items are elements.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use ropewalk::bench::{FullIteration, Pendulum};
use ropewalk::constraints::SphericalSpec;
use ropewalk::core::Width;
use ropewalk::elements::{CableSpec, RigidBodySpec, Section};
use ropewalk::{Error, Scene};
use std::fmt;

fn main() {
    divan::main();
}

/// What is solved, how large, and whether it is damped.
#[derive(Clone, Copy)]
enum Case {
    Chain(usize, bool),
    Tree(u32, bool),
    Net(usize, bool),
    /// Knotted together; with a body in the middle, which makes it unsymmetric by itself.
    Hub(usize, bool),
    Body(usize),
}
use Case::{Body, Chain, Hub, Net, Tree};

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Chain(n, _) => write!(f, "chain of {n}")?,
            Tree(n, _) => write!(f, "tree of {n} levels")?,
            Net(n, _) => write!(f, "net of {n} x {n} meshes")?,
            Hub(n, _) => write!(f, "{n} lines from a knot")?,
            Body(n) => write!(f, "{n} lines from a body")?,
        }
        f.write_str(if self.symmetric() { ", symmetric" } else { ", unsymmetric" })
    }
}

impl Case {
    fn symmetric(self) -> bool {
        match self {
            Chain(_, damped) | Tree(_, damped) | Net(_, damped) | Hub(_, damped) => !damped,
            Body(_) => false,
        }
    }
    fn elements(self) -> usize {
        match self {
            Chain(n, _) => n,
            Tree(n, _) => ((1 << n) - 1) * ALONG,
            Net(n, _) => 2 * n * (n + 1) * ALONG,
            Hub(n, _) | Body(n) => n * ALONG,
        }
    }
    /// Assembled, factored and solved once.
    fn ready(self) -> Result<FullIteration, Error> {
        let mut ready = match self {
            Chain(n, false) => FullIteration::new(&Pendulum::new(n), Width::best())?,
            Chain(n, true) => FullIteration::new(&Pendulum::new(n).in_water(), Width::best())?,
            Tree(n, damped) => FullIteration::of(tree(n, damped).build()?)?,
            Net(n, damped) => FullIteration::of(net(n, damped).build()?)?,
            Hub(n, damped) => FullIteration::of(hub(n, damped, false).build()?)?,
            Body(n) => FullIteration::of(hub(n, false, true).build()?)?,
        };
        ready.run()?;
        Ok(ready)
    }
}

/// Elements along a side of a mesh, a branch or a line.
const ALONG: usize = 4;

fn section(damped: bool) -> Section {
    Section { axial_retardation_time: if damped { 0.01 } else { 0.0 }, ..Section::new(0.1, 5000.0, 0.01) }
}

/// A square net of ropes, knotted where they cross.
fn net(n: usize, damped: bool) -> Scene {
    let mut scene = Scene::new();
    for k in 0..=n {
        let (at, end) = (k as f64, n as f64);
        let lines = [("weft", [0.0, at, 0.0], [end, at, 0.0]), ("warp", [at, 0.0, 0.0], [at, end, 0.0])];
        for (name, from, to) in lines {
            let line = CableSpec::straight(&format!("{name}{k}"), from, to, n * ALONG, section(damped));
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

/// A binary tree of ropes that hangs from its root.
fn tree(levels: u32, damped: bool) -> Scene {
    let mut scene = Scene::new();
    for k in 1..1_usize << levels {
        // branch k has the branches 2 k and 2 k + 1 at its end
        let end = |k: usize| {
            let level = k.ilog2();
            let across = (k as f64 + 0.5) / f64::from(1 << level) - 1.5;
            [4.0 * across, -1.0 - f64::from(level), 0.0]
        };
        let from = if k == 1 { [0.0; 3] } else { end(k / 2) };
        let name = format!("branch{k}");
        scene.element(CableSpec::straight(&name, from, end(k), ALONG, section(damped)));
        let (joint, start) = (format!("joint{k}"), format!("{name}.start"));
        let parent = format!("branch{}.end", k / 2);
        scene.constraint(if k == 1 {
            SphericalSpec::pin(&joint, start.as_str())
        } else {
            SphericalSpec::new(&joint, start.as_str(), parent.as_str())
        });
    }
    scene
}

/// Lines from a knot or a body to the ground.
fn hub(legs: usize, damped: bool, body: bool) -> Scene {
    let mut scene = Scene::new();
    if body {
        scene.element(RigidBodySpec::new("hub", [0.0; 3], 10.0, [1.0; 3]));
    }
    for k in 0..legs {
        let (sin, cos) = (std::f64::consts::TAU * k as f64 / legs as f64).sin_cos();
        let name = format!("line{k}");
        scene.element(CableSpec::straight(&name, [0.0; 3], [cos, sin, 0.0], ALONG, section(damped)));
        scene.constraint(SphericalSpec::pin(&format!("anchor{k}"), format!("{name}.end").as_str()));
        if body || k > 0 {
            let (joint, start) = (format!("joint{k}"), format!("{name}.start"));
            let to = if body { "hub" } else { "line0.start" };
            scene.constraint(SphericalSpec::new(&joint, start.as_str(), to));
        }
    }
    scene
}

fn cases() -> Vec<Case> {
    let both = [false, true];
    let chains = [32, 128, 512, 2048, 8192].into_iter().flat_map(|n| both.map(|damped| Chain(n, damped)));
    let trees = [6, 9].into_iter().flat_map(|n| both.map(|damped| Tree(n, damped)));
    let nets = [3, 8, 14].into_iter().flat_map(|n| both.map(|damped| Net(n, damped)));
    let hubs = [10, 100, 400].into_iter().flat_map(|n| [Hub(n, false), Hub(n, true), Body(n)]);
    chains.chain(trees).chain(nets).chain(hubs).collect()
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
