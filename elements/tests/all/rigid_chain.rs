//! Chains of rigid links: inertia, joints, bending.

use ropewalk_core::rotation::{exp, then};
use ropewalk_core::testing::{check_tangent, dense, difference};
use ropewalk_core::{At, Node, NodeKind, Per, Term, Weights, Width, retract};
use ropewalk_elements::rigid_chain::{Bend, Bends, LinkSection, SpoolSpec};
use ropewalk_elements::{PointMassSpec, RigidChainSpec};
use ropewalk_scene::{MarkerRef, Scene};

const NODES: [Node; 2] = [
    Node { kind: NodeKind::Frame, q: 0, v: 0, shared: false },
    Node { kind: NodeKind::Frame, q: 7, v: 6, shared: false },
];

fn state() -> (Vec<f64>, Vec<f64>) {
    let (a, b) = (exp([0.3, -0.8, 1.1]), then(exp([0.2, 0.1, -0.3]), exp([0.9, 0.4, -0.7])));
    let mut q = vec![0.1, 0.2, 0.3];
    q.extend(a);
    q.extend([1.0, 0.5, -0.2]);
    q.extend(b);
    (q, vec![0.3, 0.1, -0.2, 1.5, -0.7, 0.4, 0.2, 0.6, 0.9, -0.8, 0.3, 2.1])
}

fn bends(rest: [f64; 3]) -> Bends {
    let joints = vec![Bend { q: [0, 7], v: [0, 6], rest }];
    Bends { label: "joints".into(), stiffness: 20.0, damping: 0.7, joints }
}

#[test]
fn tangent_and_energy_of_bending_are_exact() {
    let (q, v) = state();
    let at = At { t: 0.0, q: &q, v: &v, a: &[0.0; 12], internal: &[], relaxed: None };
    for rest in [[1.0, 0.0, 0.0], [0.6, 0.0, 0.8]] {
        let bends = bends(rest);
        let error = check_tangent(&bends, &NODES, &at, Width::One);
        assert!(error < 1e-8, "{error}");
        let (r, _) = dense(&bends, &NODES, &at, Weights::default(), Width::One);
        let taken: f64 = r.iter().zip(&v).map(|(r, v)| r * v).sum();
        let stored = difference(|dt| {
            let (mut moved, step) = (q.clone(), v.iter().map(|v| v * dt).collect::<Vec<_>>());
            retract(&NODES, &q, &step, &mut moved);
            vec![bends.energy(&At { q: &moved, ..at }).potential]
        })[0];
        approx::assert_relative_eq!(taken, stored + bends.power(&at).dissipated, max_relative = 1e-8);
    }
}

fn spooled() -> RigidChainSpec {
    let section = LinkSection { flooded: 0.361, ..LinkSection::new(0.5, 0.023) };
    let mut chain = RigidChainSpec::new("hose", vec![[0.0; 3], [-0.5, 0.0, 0.3]], 60, section);
    chain.length = Some(6.0);
    chain.spool = Some(SpoolSpec { centre: [0.0; 3], axis: [-1.0, 0.0, 0.0], pitch: 0.025, turns: None });
    chain
}

#[test]
fn a_chain_on_a_spool_meets_its_joints_and_weighs_what_it_should() {
    let mut scene = Scene::new();
    scene.element(spooled());
    let model = scene.build().unwrap();
    let state = model.state();
    assert_eq!((model.nodes().len(), model.constraints().len()), (60, 59));
    for c in model.constraints() {
        let (mut g, mut jac) = (vec![0.0; 3], vec![0.0; 36]);
        c.jacobian(model.nodes(), &state.at(), &mut g, &mut jac);
        assert!(g.iter().all(|g| g.abs() < 1e-14), "{}: {g:?}", c.name());
    }
    let part = model.part("hose").unwrap();
    let weight = part.dead_load(Per::Mass, [0.0, 0.0, -10.0]).unwrap();
    let line = part.centre_line(&state.at());
    assert_eq!(line.len(), 61);
    // the potential of the weight is that of the links at their centres
    let height: f64 = line.windows(2).map(|w| 0.5 * (w[0][2] + w[1][2])).sum();
    approx::assert_relative_eq!(
        weight.energy(&state.at()).potential,
        0.05 * 10.0 * height,
        max_relative = 1e-12
    );
    // a point between joints is on its link
    let (x, _) = part.point(0.25, &state.at()).unwrap();
    for i in 0..3 {
        approx::assert_relative_eq!(x[i], 0.5 * (line[2][i] + line[3][i]), epsilon = 1e-14);
    }
}

#[test]
fn bad_chains_are_refused_with_the_remedy() {
    let told = |change: &dyn Fn(&mut RigidChainSpec)| {
        let mut chain = spooled();
        change(&mut chain);
        let mut scene = Scene::new();
        scene.element(chain);
        match scene.build() {
            Err(e) => e.error.message,
            Ok(_) => panic!("accepted"),
        }
    };
    for (change, words) in [
        (&(|c: &mut RigidChainSpec| c.links = 0) as &dyn Fn(&mut RigidChainSpec), "`links` must be between"),
        (&|c| c.section.mass = 0.0, "`mass` must be positive"),
        (&|c| c.section.diameter = 0.0, "needs `gyration`"),
        (&|c| c.links = 6, "too long for a spool"),
        (&|c| c.length = None, "give its `turns` or the chain's `length`"),
        (&|c| c.spool = None, "ends after 5 of 60 links"),
        (&|c| c.points.clear(), "needs `points` or `curve`"),
        (&|c| c.points[1] = [-0.5, 0.0, 0.0], "a spool of radius 0.000 m"),
    ] {
        let message = told(change);
        assert!(message.contains(words), "{message}");
    }
    let mut scene = Scene::new();
    scene.element(spooled()).element(PointMassSpec::new("m", MarkerRef::from("hose.link61"), 1.0));
    let message = scene.build().err().unwrap().error.message;
    assert!(message.contains("`hose.link60`"), "{message}");
}
