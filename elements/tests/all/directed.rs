//! Cables that are bent when free of stress, with sections that know which way they look.

use ropewalk_core::rotation::cross;
use ropewalk_core::{Batch, Element, Local, Share, V3, Weights, dot};
use ropewalk_elements::cable::quadrature::Gauss2;
use ropewalk_elements::cable::{
    Cable, CableParams, Directed, DirectedLanes, DirectedParams, L4, LockingFree, Models, T3,
};

const L: f64 = 0.7;
const EI: f64 = 6.78;
type Numbers = [f64; 18];

fn unit(x: V3<f64>) -> V3<f64> {
    let size = dot(&x, &x).sqrt();
    x.map(|x| x / size)
}

/// An element bent in space, and directors that are neither unit vectors nor normal to it.
fn bent() -> Numbers {
    let slopes = [[0.9, 0.3, -0.2], [0.5, -0.6, 0.7]];
    let directors = [[0.1, 0.9, 0.4], [0.3, 0.8, 0.9]];
    let mut q = [0.0; 18];
    (q[0], q[1], q[2]) = (3.0, -1.0, 2.0);
    (q[6], q[7], q[8]) = (3.0 + 0.55, -1.0 - 0.08, 2.0 + 0.2);
    for i in 0..3 {
        (q[3 + i], q[9 + i]) = (slopes[0][i], slopes[1][i]);
        (q[12 + i], q[15 + i]) = (directors[0][i], directors[1][i]);
    }
    q
}

/// Another shape, with proper directors.
fn rest() -> Numbers {
    let mut q = bent();
    (q[6], q[7], q[8]) = (3.0 + 0.5, -1.0 + 0.3, 2.0 + 0.3);
    for at in [12, 15] {
        let t = unit([q[at / 15 * 6 + 3], q[at / 15 * 6 + 4], q[at / 15 * 6 + 5]]);
        let d = unit(cross(&t, &[0.2, -0.3, 1.0]));
        q[at..at + 3].copy_from_slice(&d);
    }
    q
}

fn local(q: Numbers) -> Local<f64, 18, 18> {
    Local { q, v: [0.0; 18], a: [0.0; 18], last: [0.0; 18], relaxed: None }
}

fn element() -> Directed {
    let q = rest();
    let params = DirectedParams { l: L, ei: EI, gj: 0.8 * EI, rho_j: 1e-3 };
    let shape = std::array::from_fn(|i| q[i]);
    Directed::at_shape(params, &shape, [[q[12], q[13], q[14]], [q[15], q[16], q[17]]], Gauss2)
}

fn energy(p: &DirectedLanes<f64>, q: Numbers) -> f64 {
    Directed::energy(p, &local(q)).potential
}

fn forces(p: &DirectedLanes<f64>, q: Numbers) -> Share<f64, 18> {
    let mut out = Share::zero();
    let w = Weights { q: 1.0, v: 0.0, a: 0.0 };
    Directed::add::<f64, true>(p, &local(q), &w, &mut out);
    out
}

/// Every vector turned about one axis, positions moved as well.
fn turned(q: &Numbers, angle: f64) -> Numbers {
    let axis = unit([0.3, -0.5, 0.8]);
    let (sin, cos) = angle.sin_cos();
    let mut out = *q;
    for block in 0..6 {
        let x: V3<f64> = std::array::from_fn(|i| q[3 * block + i]);
        let (side, along) = (cross(&axis, &x), dot(&axis, &x) * (1.0 - cos));
        let shift = if block % 2 == 0 && block < 4 { 5.0 } else { 0.0 };
        for i in 0..3 {
            out[3 * block + i] = cos * x[i] + sin * side[i] + along * axis[i] + shift;
        }
    }
    out
}

#[test]
fn forces_are_derivatives_of_the_energy_and_tangents_of_the_forces() {
    let p = element().to_lanes();
    let (q, h) = (bent(), 1e-4);
    let out = forces(&p, q);
    let (scale, stiff) = (
        out.r.iter().fold(0.0_f64, |m, x| m.max(x.abs())),
        out.k.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs())),
    );
    for j in 0..18 {
        let moved = |s: f64| {
            let mut q = q;
            q[j] += s * h;
            q
        };
        let four = |f: &dyn Fn(f64) -> f64| (8.0 * (f(1.0) - f(-1.0)) - (f(2.0) - f(-2.0))) / (12.0 * h);
        let slope = four(&|s| energy(&p, moved(s)));
        assert!((slope - out.r[j]).abs() < 1e-8 * scale, "{j}: {slope} {}", out.r[j]);
        for i in 0..18 {
            let k = four(&|s| forces(&p, moved(s)).r[i]);
            assert!((k - out.k[i][j]).abs() < 1e-8 * stiff, "{i} {j}: {k} {}", out.k[i][j]);
            assert_eq!(out.k[i][j], out.k[j][i]);
        }
    }
}

#[test]
fn a_rigid_rotation_changes_nothing_and_the_shape_as_laid_is_free_of_stress() {
    let (p, rest) = (element().to_lanes(), rest());
    let params = CableParams { l: L, ea: 0.0, ei: EI, rho_a: 1.0 };
    let elastic = Cable::new(params, Models::new(L4, T3, LockingFree));
    let elastic = Cable::lanes(&Batch::of(std::slice::from_ref(&elastic)));
    for angle in [0.0, 0.4, 2.0, 3.1, 3.5] {
        let now = turned(&bent(), angle);
        assert!((energy(&p, now) / energy(&p, bent()) - 1.0).abs() < 1e-12);
        // bending and what belongs to it cancel at rest, in whatever attitude
        let q = turned(&rest, angle);
        let own: [f64; 12] = std::array::from_fn(|i| q[i]);
        let x = Local { q: own, v: [0.0; 12], a: [0.0; 12], last: [0.0; 12], relaxed: None };
        let mut cable = Share::zero();
        Cable::<L4, T3, LockingFree>::add::<f64, false>(&elastic, &x, &Weights::default(), &mut cable);
        let out = forces(&p, q);
        let size = cable.r.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        for i in 0..18 {
            let sum = out.r[i] + if i < 12 { cable.r[i] } else { 0.0 };
            assert!(sum.abs() < 1e-12 * size, "{i}: {sum} of {size}");
        }
        let sum = energy(&p, q) + Cable::<L4, T3, LockingFree>::energy::<f64>(&elastic, &x).potential;
        assert!(sum.abs() < 1e-13 * energy(&p, bent()).abs(), "{sum}");
    }
}

/// Directors that are carried along a helix without spin about its tangent have no twist; between tangent and normal of
/// the curve there is its torsion.
#[test]
fn twist_is_measured_against_directions_carried_without_spin() {
    let (radius, climb) = (1.0_f64, 0.6_f64);
    let speed = radius.hypot(climb);
    let (curvature, torsion) = (radius / (speed * speed), climb / (speed * speed));
    let frame = |s: f64| -> [V3<f64>; 4] {
        let (sin, cos) = (s / speed).sin_cos();
        let t = [-radius * sin / speed, radius * cos / speed, climb / speed];
        let n = [-cos, -sin, 0.0];
        let b = cross(&t, &n);
        [[radius * cos, radius * sin, climb * s / speed], t, n, b]
    };
    let mut errors = Vec::new();
    for l in [0.8, 0.4, 0.2] {
        // normal and binormal turn about the tangent at the rate of the torsion
        let director = |s: f64| -> V3<f64> {
            let [_, _, n, b] = frame(s);
            let (sin, cos) = (torsion * s).sin_cos();
            std::array::from_fn(|i| cos * n[i] - sin * b[i])
        };
        let mut q = [0.0; 18];
        for (k, s) in [0.0, l].into_iter().enumerate() {
            let [x, t, ..] = frame(s);
            q[6 * k..6 * k + 3].copy_from_slice(&x);
            q[6 * k + 3..6 * k + 6].copy_from_slice(&t);
            q[12 + 3 * k..15 + 3 * k].copy_from_slice(&director(s));
        }
        // an element that is straight and free of twist at rest, so that its energy is that of twist alone
        let straight = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, l, 0.0, 0.0, 1.0, 0.0, 0.0];
        let params = DirectedParams { l, ei: 1.0, gj: 1.0, rho_j: 1.0 };
        let up = [0.0, 0.0, 1.0];
        let p = Directed::at_shape(params, &straight, [up, up], Gauss2).to_lanes();
        let twist = (2.0 * l * energy(&p, q)).sqrt();
        errors.push(twist / l);
    }
    println!("{errors:?}");
    assert!(errors[2] < 2e-5 * curvature * torsion);
    assert!((errors[0] / errors[1]).log2() > 3.5 && (errors[1] / errors[2]).log2() > 3.5);
}
