//! Twist of single elements against an independent program, and the derivatives of what is made of it.

use ropewalk_core::model::twist::{across, between, carried, relabel};
use ropewalk_core::rotation::cross;
use ropewalk_core::testing::{check_tangent, dense};
use ropewalk_core::{At, Element, Node, NodeId, NodeKind, Pool, Term, V3, Weights, Width, dot, retract};
use ropewalk_elements::cable::quadrature::{Gauss2, Gauss5, Lobatto3, Quadrature};
use ropewalk_elements::cable::{
    Directed, DirectedParams, SectionDamping, SpinInertia, TorqueTension, Torsion, TorsionDamping,
    TorsionParams,
};
use serde_json::Value;

pub const L: f64 = 0.7;

/// Two nodes with torsion and the bubble between them.
pub fn nodes() -> Vec<Node> {
    let mut all: Vec<Node> = Vec::new();
    for kind in [NodeKind::Twist, NodeKind::Twist, NodeKind::Scalars(1)] {
        let (q, v) = all.last().map_or((0, 0), |n| (n.coords().end, n.dofs().end));
        all.push(Node { kind, q, v, shared: false });
    }
    all
}

fn cases() -> Vec<Value> {
    let all: Value = serde_json::from_str(include_str!("../data/torsion.json")).expect("torsion.json");
    all["cases"].as_array().expect("cases").clone()
}

fn list(v: &Value) -> Vec<f64> {
    v.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect()
}

/// The coordinates of a case, with a bubble.
pub fn coordinates(case: &Value, bubble: f64) -> Vec<f64> {
    let mut q = Vec::new();
    for node in case["parameters"]["nodes"].as_array().expect("nodes") {
        q.extend([&node["r"], &node["slope"], &node["u"]].into_iter().flat_map(list));
        q.push(node["theta"].as_f64().expect("an angle"));
    }
    q.push(bubble);
    q
}

pub fn states() -> Vec<Vec<f64>> {
    cases().iter().map(|c| coordinates(c, 0.17)).collect()
}

fn pool<E: Element<Q, N>, const Q: usize, const N: usize>(element: E, on: &[NodeId]) -> Pool<E, Q, N> {
    let mut pool = Pool::new();
    for _ in 0..3 {
        assert!(pool.push(&nodes(), element.clone(), on));
    }
    pool
}

const BOTH: [NodeId; 2] = [NodeId(0), NodeId(1)];
const ALL: [NodeId; 3] = [NodeId(0), NodeId(1), NodeId(2)];

fn at<'a>(q: &'a [f64], v: &'a [f64], a: &'a [f64]) -> At<'a> {
    At { t: 0.0, q, v, a, internal: &[], relaxed: None }
}

fn worst(a: &[f64], b: &[f64]) -> f64 {
    let size = b.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).fold(0.0_f64, |m, (a, b)| {
        let off = (a - b).abs() / size;
        if off <= m { m } else { off }
    })
}

const STIFFNESS: Weights = Weights { q: 1.0, v: 0.0, a: 0.0 };

#[test]
fn the_twist_of_an_element_is_that_of_the_oracle() {
    for case in cases() {
        let (q, exact) = (coordinates(&case, 0.0), &case["results"]);
        let number = |name: &str| exact[name].as_f64().expect(name);
        let pair: [f64; 20] = std::array::from_fn(|i| q[i]);
        assert!((Torsion::twist(&pair, L) / number("Phi") - 1.0).abs() < 1e-13);
        // free of stress but for a unit moment, the residual is the gradient; and the tangent, less its square, the Hessian
        let gj = 1e-3;
        let twist0 = number("Phi") - L / gj;
        let torsion = Torsion::new(TorsionParams { l: L, gj, rho_j: 0.3, twist0 });
        let mut one = Pool::<Torsion, 20, 14>::new();
        assert!(one.push(&nodes(), torsion, &BOTH));
        let still = [0.0; 15];
        let (f, k) = dense(&one, &nodes(), &at(&q, &still, &still), STIFFNESS, Width::One);
        let g = list(&exact["dPhi"]);
        assert!(worst(&f[..14], &g) < 1e-11, "{}", worst(&f[..14], &g));
        for (i, row) in exact["d2Phi_symmetric"].as_array().expect("rows").iter().enumerate() {
            let own: Vec<f64> = (0..14).map(|j| k[i][j] - gj / L * g[i] * g[j]).collect();
            let size = 1e-11 * 100.0;
            assert!(own.iter().zip(list(row)).all(|(a, b)| (a - b).abs() < size), "{i}: {own:?} {row}");
        }
        // curvature about both directors: energies that are linear in either
        let first = Gauss2.points()[0];
        let kappa = Directed::curvature(&std::array::from_fn(|i| q[i]), L, Gauss2)[0];
        for (k, own, by) in [(0, "K_d_first_gauss2_point", "dK_d"), (1, "K_e_first_gauss2_point", "dK_e")] {
            assert!((kappa[k] / number(own) - 1.0).abs() < 1e-12, "{own}");
            let mut kappa0 = [[0.0; 2]; 5];
            kappa0[0][k] = -1.0 / (L * first.w);
            let params = DirectedParams { l: L, ei_d: 1.0, ei_e: 1.0, gj: 1.0, eta_gj: 0.0, rho_j: 0.0 };
            let mut one = Pool::<Directed, 21, 15>::new();
            assert!(one.push(&nodes(), Directed::new(params, kappa0, Gauss2), &ALL));
            let (f, _) = dense(&one, &nodes(), &at(&q, &still, &still), STIFFNESS, Width::One);
            assert!(worst(&f[..14], &list(&exact[by])) < 1e-11, "{by}: {f:?}");
        }
    }
}

fn noise(seed: u64, n: usize) -> Vec<f64> {
    let mut s = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    (0..n)
        .map(|_| {
            s ^= s << 13;
            s ^= s >> 7;
            s ^= s << 17;
            (s >> 11) as f64 / (1u64 << 53) as f64 * 2.0 - 1.0
        })
        .collect()
}

/// Every kind of element with torsion.
fn terms() -> Vec<(&'static str, Box<dyn Term>)> {
    let torsion = Torsion::new(TorsionParams { l: L, gj: 0.8, rho_j: 0.3, twist0: 0.4 });
    let coupled =
        TorqueTension { params: torsion.params, lay: 1.7, strain0: 0.02, points: Lobatto3.points() };
    let damping = TorsionDamping { l: L, eta_gj: 0.6 };
    let params = DirectedParams { l: L, ei_d: 2.3, ei_e: 0.9, gj: 0.8, eta_gj: 0.05, rho_j: 0.3 };
    let kappa0 = [[0.7, -0.4], [0.2, 0.5], [0.0; 2], [0.0; 2], [0.0; 2]];
    vec![
        ("torsion", Box::new(pool(torsion, &BOTH))),
        ("torque and tension", Box::new(pool(coupled, &BOTH))),
        ("damping", Box::new(pool(damping, &BOTH))),
        ("spin", Box::new(pool(SpinInertia { l: L, rho_j: 0.3 }, &BOTH))),
        ("directed", Box::new(pool(Directed::new(params, kappa0, Gauss2), &ALL))),
        ("bending damping", Box::new(pool::<_, 20, 14>(SectionDamping::new(L, [0.4, 0.4], Gauss2), &BOTH))),
        ("with a bubble", Box::new(pool::<_, 21, 15>(SectionDamping::new(L, [0.7, 0.3], Gauss5), &ALL))),
    ]
}

#[test]
fn tangents_are_derivatives_at_every_width() {
    for q in states() {
        let (v, a) = (noise(3, 15), noise(5, 15));
        for (name, term) in terms() {
            for width in [Width::One, Width::Four, Width::Eight] {
                let error = check_tangent(term.as_ref(), &nodes(), &at(&q, &v, &a), width);
                println!("{name}: {error:.1e}");
                assert!(error < 1e-8, "{name}: {error}");
            }
        }
    }
}

/// Damping of bending lets a cable turn as it likes, about its own axis too, unless it is bent and its sections turn in it.
#[test]
fn what_turns_as_a_rigid_body_is_not_damped() {
    let damping = pool::<_, 21, 15>(SectionDamping::new(L, [0.7, 0.3], Gauss5), &ALL);
    for q in states() {
        let (still, spin) = ([0.0; 15], [0.4, -1.1, 0.7]);
        let turning = |own: f64| -> Vec<f64> {
            let mut v = Vec::new();
            for x in [&q[..10], &q[10..20]] {
                let slope: V3<f64> = [x[3], x[4], x[5]];
                v.extend(cross(&spin, &[x[0], x[1], x[2]]));
                v.extend(cross(&spin, &slope));
                v.push(own + dot(&spin, &slope) / dot(&slope, &slope).sqrt());
            }
            v.push(0.0);
            v
        };
        let power = |own: f64| damping.power(&at(&q, &turning(own), &still)).dissipated;
        assert!(power(0.0) < 1e-24 && power(1.0) > 1e-3, "{:e} {:e}", power(0.0), power(1.0));
    }
}

#[test]
fn forces_are_derivatives_of_the_energy_and_of_power() {
    for q in states() {
        let (v, still) = (noise(3, 15), [0.0; 15]);
        for (name, term) in terms() {
            let (f, _) = dense(term.as_ref(), &nodes(), &at(&q, &still, &still), STIFFNESS, Width::One);
            for i in 0..15 {
                let slope = ropewalk_core::testing::difference(|h| {
                    let d: Vec<f64> = (0..15).map(|j| if j == i { h } else { 0.0 }).collect();
                    let mut moved = q.clone();
                    retract(&nodes(), &q, &d, &mut moved);
                    vec![term.energy(&at(&moved, &still, &still)).potential]
                })[0];
                assert!((f[i] - slope).abs() < 1e-8 * (1.0 + slope.abs()), "{name} {i}: {} {slope}", f[i]);
            }
            let (moving, _) = dense(term.as_ref(), &nodes(), &at(&q, &v, &still), STIFFNESS, Width::One);
            let lost: f64 = moving.iter().zip(&f).zip(&v).map(|((m, f), v)| (m - f) * v).sum();
            let power = term.power(&at(&q, &v, &still));
            assert!((power.dissipated - lost).abs() < 1e-12 * (1.0 + lost), "{name}: {lost}");
            // momentum of the kinetic energy
            let (inertia, _) = dense(term.as_ref(), &nodes(), &at(&q, &still, &v), STIFFNESS, Width::One);
            let twice: f64 = inertia.iter().zip(&f).zip(&v).map(|((m, f), v)| (m - f) * v).sum();
            let kinetic = term.energy(&at(&q, &v, &still)).kinetic;
            assert!((2.0 * kinetic - twice).abs() < 1e-12 * (1.0 + twice), "{name}: {kinetic} {twice}");
        }
    }
}

/// Every vector turned about one axis, positions moved as well.
fn turned(q: &[f64], angle: f64) -> Vec<f64> {
    let axis: V3<f64> = [0.3 / 0.98_f64.sqrt(), -0.5 / 0.98_f64.sqrt(), 0.8 / 0.98_f64.sqrt()];
    let (sin, cos) = angle.sin_cos();
    let mut out = q.to_vec();
    for first in [0, 3, 6, 10, 13, 16] {
        let x: V3<f64> = std::array::from_fn(|i| q[first + i]);
        let (side, along) = (cross(&axis, &x), dot(&axis, &x) * (1.0 - cos));
        let shift = if first % 10 == 0 { 5.0 } else { 0.0 };
        for i in 0..3 {
            out[first + i] = cos * x[i] + sin * side[i] + along * axis[i] + shift;
        }
    }
    out
}

#[test]
fn neither_a_rigid_rotation_nor_the_gauge_nor_the_numbering_changes_the_energy() {
    let still = [0.0; 15];
    for q in states() {
        for (name, term) in terms() {
            let energy = |q: &[f64]| term.energy(&at(q, &still, &still)).potential;
            for angle in [0.4, 2.0, 3.1, 3.5] {
                assert!((energy(&turned(&q, angle)) - energy(&q)).abs() < 1e-12 * (1.0 + energy(&q).abs()));
            }
            // relabelled: another reference director at the second node
            let mut other = q.clone();
            if relabel(&mut other, &[0, 10]) {
                assert!((energy(&other) - energy(&q)).abs() < 1e-12 * (1.0 + energy(&q).abs()), "{name}");
                assert!(other[19] != q[19]);
            }
        }
        // from the other end: tangents and the second director turn round
        let mut back = vec![0.0; 20];
        for (to, from) in [(0, 10), (10, 0)] {
            for i in 0..3 {
                back[to + i] = q[from + i];
                back[to + 3 + i] = -q[from + 3 + i];
                back[to + 6 + i] = q[from + 6 + i];
            }
            back[to + 9] = -q[from + 9];
        }
        let twist = |q: &[f64]| Torsion::twist(&std::array::from_fn(|i| q[i]), L);
        assert!((twist(&back) - twist(&q)).abs() < 1e-14);
    }
}

/// Directors that are carried along a helix without spin about its tangent have no twist; between tangent and normal of
/// the curve there is its torsion.
#[test]
fn twist_is_measured_against_directions_carried_without_spin() {
    let (radius, climb) = (1.0_f64, 0.6_f64);
    let speed = radius.hypot(climb);
    let torsion = climb / (speed * speed);
    let frame = |s: f64| -> [V3<f64>; 3] {
        let (sin, cos) = (s / speed).sin_cos();
        let t = [-radius * sin / speed, radius * cos / speed, climb / speed];
        [[radius * cos, radius * sin, climb * s / speed], t, [-cos, -sin, 0.0]]
    };
    let mut errors = Vec::new();
    for l in [0.8, 0.4, 0.2] {
        let mut q = [0.0; 20];
        for (k, s) in [0.0, l].into_iter().enumerate() {
            let [x, t, n] = frame(s);
            q[10 * k..10 * k + 3].copy_from_slice(&x);
            q[10 * k + 3..10 * k + 6].copy_from_slice(&t);
            q[10 * k + 6..10 * k + 9].copy_from_slice(&n);
            // normal and binormal turn about the tangent at the rate of the torsion
            q[10 * k + 9] = -torsion * s;
        }
        errors.push((Torsion::twist(&q, l) / l).abs());
    }
    println!("{errors:?}");
    assert!(errors[2] < 1e-5);
    assert!((errors[0] / errors[1]).log2() > 3.7 && (errors[1] / errors[2]).log2() > 3.8, "{errors:?}");
}

/// A section that is carried round a cone without spin comes back turned by the solid angle of its polygon.
#[test]
fn a_section_carried_round_a_cone_comes_back_turned_by_its_solid_angle() {
    let all: Value = serde_json::from_str(include_str!("../data/torsion.json")).expect("torsion.json");
    let reference = &all["holonomy"];
    for (steps, exact) in list(&reference["steps"]).into_iter().zip(list(&reference["clamp_holonomy"])) {
        let tangent = |k: i32| {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / steps).sin_cos();
            [0.6_f64.cos(), 0.6_f64.sin() * cos, 0.6_f64.sin() * sin]
        };
        let start = across(&[0.0, 0.0, 1.0], &tangent(0));
        let end = (0..steps as i32).fold(start, |d, k| carried(&d, &tangent(k), &tangent(k + 1)));
        // seen from the section that comes back
        let turned = between([&tangent(0), &end], [&tangent(0), &start]);
        assert!((turned - exact).abs() < 1e-6, "{steps}: {turned} {exact}");
    }
}

#[test]
fn carrying_a_director_keeps_its_length_and_right_angle() {
    let (a, b) = ([1.0, 0.0, 0.0], [0.6, 0.48, 0.64]);
    let v = carried(&[0.0, 0.6, -0.8], &a, &b);
    assert!((dot(&v, &v) - 1.0).abs() < 1e-15 && dot(&v, &b).abs() < 1e-15);
}
