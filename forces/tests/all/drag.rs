//! Drag, added mass and line loads against references, differences, rotations and limits.

use crate::random::{Random, rotate};
use ropewalk_core::held::Held;
use ropewalk_core::testing::{check_law, check_tangent, dense};
use ropewalk_core::{At, Law, Load, Marker, Node, NodeId, NodeKind, Station, Tip, Weights, Width, dot};
use ropewalk_forces::{
    AddedMass, BluntEnd, Drag, EndDrag, LineLoad, NormalLaw, PerLength, Surface, TangentialLaw, Theory,
    TimeFunction, at_tip, choo_casarella_cn, choo_casarella_ct_over_mu,
};
use ropewalk_scene::Current;

const NORMAL: [NormalLaw; 2] = [NormalLaw::Constant(1.2), NormalLaw::ChooCasarella];
const TANGENTIAL: [TangentialLaw; 2] = [TangentialLaw::Quadratic(0.01), TangentialLaw::ChooCasarella];

fn station(r: &mut Random, speed: f64) -> Station<f64> {
    Station {
        x: r.vector(5.0),
        v: r.vector(speed),
        a: r.vector(3.0),
        slope: r.vector(1.0),
        slope_rate: r.vector(4.0),
        s: 0.5,
        weight: 0.1,
        before: 0.04,
        element: 0.2,
        diameter: 0.023,
        area: 4e-4,
        who: 0,
    }
}

fn currents() -> [Current; 4] {
    [
        Current::Still,
        Current::Uniform([0.4, -0.2, 0.1]),
        Current::Linear { z0: 1.0, velocity: [0.4, 0.1, 0.0], gradient: [0.1, -0.3, 0.05] },
        Current::profile(vec![-2.0, 0.0, 2.0], vec![[0.0; 3], [0.5, 0.1, 0.0], [0.9, -0.5, 0.2]]).unwrap(),
    ]
}

fn laws() -> Vec<Drag> {
    let currents = currents();
    let mut all = Vec::new();
    for normal in NORMAL {
        for tangential in TANGENTIAL {
            for current in &currents {
                for per in [PerLength::Unstretched, PerLength::Stretched] {
                    let drag = Drag::new(1025.0, 1.07e-3, normal, tangential).unwrap();
                    all.push(Drag { current: current.clone(), per, blend: Some(0.2), ..drag });
                }
            }
        }
    }
    all
}

fn force(law: &impl Law, at: &Station<f64>) -> [f64; 3] {
    let mut load = Load::zero();
    law.load::<f64, false>(0.7, at, &mut load);
    load.f
}

#[test]
fn coefficients_are_those_of_the_reference() {
    let data: serde_json::Value =
        serde_json::from_str(include_str!("../data/drag_choo_casarella.json")).unwrap();
    let number = |x: &serde_json::Value| x.as_f64().unwrap_or_else(|| x.as_str().unwrap().parse().unwrap());
    let mut worst = 0.0_f64;
    let mut check = |value: f64, exact: f64| worst = worst.max((value / exact - 1.0).abs());
    let rows = data["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 40);
    let fluid = |name: &str| number(&data["fluid"][name]);
    for row in rows {
        let re = number(&row["Re"]);
        check(choo_casarella_cn(re), number(&row["Cn_str"]));
        check(choo_casarella_ct_over_mu(re), number(&row["Ct_over_mu_str"]));
        // the force of the whole law, in cross-flow
        let law =
            Drag::new(fluid("rho"), fluid("mu"), NormalLaw::ChooCasarella, TangentialLaw::Quadratic(0.0));
        let mut at = station(&mut Random(1), 0.0);
        at.diameter = fluid("d");
        at.slope = [0.0, 0.0, 1.3];
        at.v = [number(&row["vn"]), 0.0, 0.0];
        // Re is only approximately on its edge when it comes from a speed
        if re != 1.0 && re != 30.0 {
            check(-force(&law.unwrap(), &at)[0], number(&row["fn"]));
        }
    }
    let edges = &data["edges"];
    check(choo_casarella_cn(1.0), number(&edges["Re1"]["low_branch"]));
    check(choo_casarella_cn(30.0), number(&edges["Re30"]["mid_branch"]));
    // just above the edges: the next number, where only the change of Cn over one unit in the last place differs
    check(choo_casarella_cn(1.0_f64.next_up()), number(&edges["Re1"]["mid_branch"]));
    check(choo_casarella_cn(30.0_f64.next_up()), number(&edges["Re30"]["high_branch"]));
    println!("worst relative error of the coefficients: {worst:.1e}");
    assert!(worst < 1e-12, "{worst}");
}

#[test]
fn derivatives_are_exact_and_all_widths_agree() {
    let mut r = Random(7);
    let mut worst = 0.0_f64;
    for law in laws() {
        for _ in 0..20 {
            worst = worst.max(check_law(&law, 0.7, &station(&mut r, 2.0)));
        }
    }
    println!("drag: {worst:.1e}");
    assert!(worst < 1e-7, "{worst}");

    let mut worst = 0.0_f64;
    let ramp = TimeFunction::Ramp { from: 0.0, to: 1.0, t0: 0.0, t1: 1.0 };
    for _ in 0..20 {
        let at = station(&mut r, 2.0);
        for current in currents() {
            let law = AddedMass::new(1025.0, 1.0).unwrap().in_current(current).unwrap();
            worst = worst.max(check_law(&law, 0.7, &at));
            worst = worst.max(check_law(&law.by(Theory::Morison), 0.7, &at));
        }
        for per in [PerLength::Unstretched, PerLength::Stretched] {
            worst =
                worst.max(check_law(&LineLoad::new([1.0, 2.0, -3.0], per, ramp.clone()).unwrap(), 0.7, &at));
        }
    }
    println!("added mass, line load: {worst:.1e}");
    assert!(worst < 1e-8, "{worst}");
}

#[test]
fn derivatives_are_exact_at_every_reynolds_number() {
    // a thick fluid brings low Reynolds numbers to speeds that differences can see
    let mut r = Random(11);
    let (mut worst, mut seen) = (0.0_f64, [0; 3]);
    for viscosity in [1e4, 1e3, 1e2, 10.0, 3.0, 1.0, 0.1] {
        for tangential in TANGENTIAL {
            for blend in [None, Some(0.3)] {
                let law = Drag::new(1025.0, viscosity, NormalLaw::ChooCasarella, tangential).unwrap();
                let law = Drag { blend, ..law };
                for _ in 0..10 {
                    let at = station(&mut r, 2.0);
                    let re = reynolds(&law, &at);
                    // below 1e-3 the tangential derivative is faded out on purpose
                    if re > 1e-3 || tangential != TANGENTIAL[1] {
                        worst = worst.max(check_law(&law, 0.0, &at));
                        seen[usize::from(re > 1.0) + usize::from(re > 30.0)] += 1;
                    }
                }
            }
        }
    }
    println!("drag, {seen:?} states in the three ranges of Re: {worst:.1e}");
    assert!(seen.iter().all(|&n| n > 30), "{seen:?}");
    assert!(worst < 1e-7, "{worst}");
}

/// The Reynolds number of the normal flow in still water.
fn reynolds(law: &Drag, at: &Station<f64>) -> f64 {
    let axial = dot(&at.v, &at.slope) / dot(&at.slope, &at.slope).sqrt();
    law.density * at.diameter * (dot(&at.v, &at.v) - axial * axial).sqrt() / law.viscosity
}

#[test]
fn turned_flow_gives_turned_force() {
    let mut r = Random(3);
    for normal in NORMAL {
        for tangential in TANGENTIAL {
            let at = station(&mut r, 2.0);
            let u = r.vector(1.0);
            let turn = r.vector(2.0);
            let drag = Drag::new(1025.0, 1.07e-3, normal, tangential).unwrap();
            let first = Drag { current: Current::Uniform(u), ..drag.clone() };
            let second = Drag { current: Current::Uniform(rotate(turn, u)), ..drag };
            let turned = Station { v: rotate(turn, at.v), slope: rotate(turn, at.slope), ..at };
            let (a, b) = (rotate(turn, force(&first, &at)), force(&second, &turned));
            approx::assert_relative_eq!(a[..], b[..], max_relative = 1e-12, epsilon = 1e-12);
        }
    }
}

#[test]
fn everything_is_finite_at_zero_velocity_and_in_axial_flow() {
    for law in laws() {
        let mut at = station(&mut Random(5), 1.0);
        at.slope = [0.6, 0.0, 0.8];
        at.x[2] = 1.0;
        let (u, _) = law.current.at(1.0);
        for axial in [0.0, 1e-300, 1e-160, 1e-20, 3.0] {
            for normal in [0.0, 1e-300, 1e-160, 1e-20, 1e-9] {
                at.v = [u[0] + 0.6 * axial, u[1] + normal, u[2] + 0.8 * axial];
                let mut load = Load::zero();
                law.load::<f64, true>(0.0, &at, &mut load);
                let all = [&load.d_x, &load.d_slope, &load.d_v];
                assert!(load.f.iter().chain(all.into_iter().flatten().flatten()).all(|x| x.is_finite()));
                if axial == 0.0 && normal == 0.0 {
                    assert_eq!(load.f.map(f64::abs), [0.0; 3]);
                }
            }
        }
    }
}

#[test]
fn choo_casarella_has_no_axial_drag_in_axial_flow() {
    let law = Drag::new(1025.0, 1.07e-3, NORMAL[1], TANGENTIAL[1]).unwrap();
    let mut at = station(&mut Random(5), 1.0);
    (at.slope, at.v) = ([0.0, 0.0, 1.0], [0.0, 0.0, 12.0]);
    assert_eq!(force(&law, &at).map(f64::abs), [0.0; 3]);
}

#[test]
fn friction_only_dissipates_and_the_power_is_complete() {
    let mut r = Random(13);
    for law in laws() {
        for _ in 0..10 {
            let at = station(&mut r, 2.0);
            let f = force(&law, &at);
            let p = Law::power(&law, 0.7, &at, &Load { f, ..Load::zero() });
            assert!(p.dissipated >= 0.0);
            approx::assert_relative_eq!(
                p.supplied - p.dissipated,
                dot(&f, &at.v),
                max_relative = 1e-10,
                epsilon = 1e-9
            );
        }
    }
}

#[test]
fn blending_joins_the_branches_and_leaves_the_rest_alone() {
    let law = Drag::new(1000.0, 1.0, NormalLaw::ChooCasarella, TangentialLaw::Quadratic(0.0)).unwrap();
    let blended = Drag { blend: Some(0.1), ..law.clone() };
    let mut at = station(&mut Random(1), 1.0);
    at.diameter = 1.0;
    at.slope = [0.0, 0.0, 1.0];
    let mut f = |law: &Drag, re: f64| {
        at.v = [re / 1000.0, 0.0, 0.0];
        -force(law, &at)[0]
    };
    for re in [0.5, 0.89, 1.11, 10.0, 26.9, 33.1, 1e5, 1e6] {
        assert_eq!(f(&law, re), f(&blended, re));
    }
    for edge in [0.9, 1.0, 1.1, 27.0, 30.0, 33.0] {
        let (a, b) = (f(&blended, edge * (1.0 - 1e-9)), f(&blended, edge * (1.0 + 1e-9)));
        assert!((a / b - 1.0).abs() < 1e-8, "{edge}");
    }
}

#[test]
fn per_stretched_length_counts_the_stretch() {
    let law = Drag::new(1025.0, 1.07e-3, NORMAL[0], TANGENTIAL[0]).unwrap();
    let stretched = Drag { per: PerLength::Stretched, ..law.clone() };
    let mut at = station(&mut Random(21), 1.0);
    at.slope = [0.0, 1.5, 2.0];
    approx::assert_relative_eq!(
        force(&stretched, &at)[..],
        force(&law, &at).map(|f| 2.5 * f)[..],
        max_relative = 1e-14
    );
}

#[test]
fn added_mass_of_morison_resists_normal_acceleration_only() {
    let law = AddedMass::new(1025.0, 1.0).unwrap().by(Theory::Morison);
    let mut at = station(&mut Random(1), 1.0);
    (at.slope, at.a) = ([0.0, 0.0, 1.1], [2.0, 0.0, 5.0]);
    let f = force(&law, &at);
    // 0.4259 kg/m for the default hose
    approx::assert_relative_eq!(f[0], -2.0 * 0.425_86, max_relative = 1e-4);
    assert_eq!([f[1], f[2]].map(f64::abs), [0.0, 0.0]);
}

/// What a fluid does at ends takes energy from the motion relative to it and no more, and its tangent is exact; also where an
/// end lies across the surface.
#[test]
fn ends_take_energy_from_the_flow() {
    let cable = [Node { kind: NodeKind::Slope, q: 0, v: 0, shared: false }];
    let body = [Node { kind: NodeKind::Frame, ..cable[0] }];
    let on_cable = Marker::node(NodeId(0));
    let on_body = Marker::beside(NodeId(0), [0.4, -0.1, 0.2]);
    let mut r = Random(3);
    for (k, current) in currents().into_iter().cycle().take(80).enumerate() {
        let v = [r.vector(2.0), r.vector(2.0)].concat();
        let (nodes, marker, q) = if k % 3 == 0 {
            let turn = [[r.number(1.0)].to_vec(), r.vector(1.0).to_vec()].concat();
            let size = turn.iter().map(|x| x * x).sum::<f64>().sqrt();
            let turn: Vec<f64> = turn.iter().map(|x| x / size).collect();
            (&body, on_body, [r.vector(3.0).to_vec(), turn].concat())
        } else {
            (&cable, on_cable, [r.vector(3.0), r.vector(1.0)].concat())
        };
        let at = At { t: 0.0, q: &q, v: &v, a: &[0.0; 6], internal: &[], relaxed: None };
        let z = Held::new(nodes, &marker, "end").unwrap().x(&at)[2];
        let surface = (k % 5 < 2).then_some(Surface::still(z + r.number(0.08)));
        let (diameter, first, axis) = (0.2, k % 2 == 0, [0.6, 0.0, -0.8]);
        let tip = Tip { marker, axis, diameter, first, sheds: true };
        let term = if k % 4 < 2 {
            let added_mass = AddedMass::new(1025.0, 1.0).unwrap().in_current(current).unwrap();
            at_tip(BluntEnd { added_mass, diameter, taper: 0.3, first, surface }, "part", nodes, &tip)
        } else {
            let surface = surface.map(|s| (s, k % 8 < 4));
            at_tip(
                EndDrag { density: 1025.0, current, sea: None, coefficient: 0.4, diameter, surface },
                "part",
                nodes,
                &tip,
            )
        };
        let term = term.expect("a slope");
        let error = check_tangent(term.as_ref(), nodes, &at, Width::One);
        assert!(error < 1e-6, "{error:e}");
        let power = term.power(&at);
        let f = dense(term.as_ref(), nodes, &at, Weights::default(), Width::One).0;
        let done: f64 = f.iter().zip(&v).map(|(f, v)| -f * v).sum();
        assert!(power.dissipated >= 0.0);
        approx::assert_relative_eq!(
            power.supplied - power.dissipated,
            done,
            max_relative = 1e-12,
            epsilon = 1e-12
        );
    }
}

#[test]
fn bad_numbers_are_refused() {
    assert!(Drag::new(-1.0, 1e-3, NORMAL[0], TANGENTIAL[0]).is_err());
    assert!(Drag::new(1025.0, 0.0, NORMAL[0], TANGENTIAL[0]).is_ok());
    assert!(Drag::new(1025.0, 0.0, NORMAL[1], TANGENTIAL[0]).is_err());
    assert!(Drag::new(1025.0, 1e-3, NormalLaw::Constant(f64::NAN), TANGENTIAL[0]).is_err());
    let drag = Drag::new(1025.0, 1e-3, NORMAL[0], TANGENTIAL[0]).unwrap();
    assert!(Drag { blend: Some(2.0), ..drag }.check().is_err());
    assert!(AddedMass::new(1025.0, -1.0).is_err());
}

/// Where a long cable begins to move, its far end does so with velocities whose squares are smaller than any number.
#[test]
fn an_end_that_hardly_moves_sheds_nothing() {
    let nodes = [Node { kind: NodeKind::Slope, q: 0, v: 0, shared: false }];
    let tip = Tip {
        marker: Marker::node(NodeId(0)),
        axis: [1.0, 0.0, 0.0],
        diameter: 0.2,
        first: false,
        sheds: true,
    };
    let added_mass = AddedMass::new(1025.0, 1.0).unwrap();
    let law = BluntEnd { added_mass, diameter: 0.2, taper: 0.0, first: false, surface: None };
    let term = at_tip(law, "part", &nodes, &tip).expect("a slope");
    for speed in [0.0, 5e-324, 1e-300, 1e-165, 1e-155, 1e-20] {
        let v = [-speed, 0.5 * speed, 0.0, 0.0, 0.0, 0.0];
        let q = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0];
        let at = At { t: 0.0, q: &q, v: &v, a: &[0.0; 6], internal: &[], relaxed: None };
        let weights = Weights { q: 1.0, v: 1.0, a: 1.0 };
        let (r, k) = dense(term.as_ref(), &nodes, &at, weights, Width::One);
        assert!(r.iter().chain(k.iter().flatten()).all(|x| x.is_finite()), "{speed:e}: {r:?} {k:?}");
    }
}
