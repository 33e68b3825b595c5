//! What comes on top of the elastic force: damping, stress-free shapes, stations, readings.

use crate::common::*;
use ropewalk_core::{Element, Gives, Load, Local, Share, Station, StationElement, Weights};
use ropewalk_elements::cable::longitudinal::Longitudinal;
use ropewalk_elements::cable::quadrature::{Gauss2, Gauss5, Lobatto3, Quadrature, Rule};
use ropewalk_elements::cable::transverse::Transverse;
use ropewalk_elements::cable::*;

const L: f64 = 0.7;
const EA: f64 = 1234.5;
const EI: f64 = 6.78;

/// Configurations whose curvature and stretch are far from the kinks.
fn bent() -> Vec<[f64; 12]> {
    let o = oracle();
    let names = ["quarter_circle_rigid", "random_3d", "compressed_slack", "hairpin", "nonuniform_stretch"];
    names.iter().map(|n| numbers(&o["configs"][n]["e"])).collect()
}

/// The worst error of the tangent against differences, relative to its largest entry.
fn tangent_error<E: Element<12, 12>>(p: &E, e: &[f64; 12]) -> f64 {
    let x = at(*e, noise(4, 1.0), [0.0; 12]);
    let mut worst = 0.0_f64;
    for (w, h) in [(STIFFNESS, 2e-5), (Weights { v: 1.0, ..Weights::default() }, 1e-1)] {
        let (exact, numeric) = (eval(p, &x, w).k, differences(p, &x, w, h));
        let scale = largest(exact.iter().flatten());
        if scale > 0.0 {
            for i in 0..12 {
                worst = worst.max(apart(&exact[i], &numeric[i]) / scale);
            }
        }
    }
    worst
}

/// The rates of the dofs in a rigid spin: every vector turns about the same axis, every position around the same point.
fn spinning(e: &[f64; 12], omega: [f64; 3]) -> [f64; 12] {
    std::array::from_fn(|i| {
        let (k, c) = (3 * (i / 3), i % 3);
        omega[(c + 1) % 3] * e[k + (c + 2) % 3] - omega[(c + 2) % 3] * e[k + (c + 1) % 3]
    })
}

/// Tangent, power and objectivity of one kind of damping; whether a rigid spin loses nothing, whatever its axis.
fn damps<E: Element<12, 12>>(p: &E, spins: bool) {
    let mut worst = [0.0_f64; 4];
    for e in bent() {
        worst[0] = worst[0].max(tangent_error(p, &e));
        let v = noise(4, 1.0);
        let force = |q: [f64; 12], v: [f64; 12]| eval(p, &at(q, v, [0.0; 12]), Weights::default()).r;
        let power = |q, v| E::power::<f64>(&lanes(p), &at(q, v, [0.0; 12])).dissipated;
        let done: f64 = force(e, v).iter().zip(&v).map(|(f, v)| f * v).sum();
        worst[1] = worst[1].max((power(e, v) - done).abs() / done);
        assert!(done > 0.0);
        if spins {
            worst[2] = worst[2].max(power(e, spinning(&e, [0.3, -0.7, 0.5])) / done);
        }
        let turned = force(rotated(&e), rotated(&v));
        worst[3] = worst[3].max(apart(&turned, &rotated(&force(e, v))) / largest(&turned));
    }
    println!(
        "{}: tangent {:.1e}, power {:.1e}, spin {:.1e}, turned {:.1e}",
        p.label(),
        worst[0],
        worst[1],
        worst[2],
        worst[3]
    );
    assert!(worst[0] < 1e-8 && worst[1] < 1e-12 && worst[2] < 1e-26 && worst[3] < 1e-12, "{worst:?}");
}

#[test]
fn damping_is_dissipative_objective_and_consistent() {
    damps(&AxialDamping::new(L, 0.1 * EA, L1, Gauss2), true);
    damps(&AxialDamping::new(L, 0.1 * EA, L2, Gauss2), true);
    damps(&AxialDamping::new(L, 0.1 * EA, L3, Gauss5), true);
    damps(&AxialDamping::new(L, 0.1 * EA, L4, Gauss5), true);
    damps(&AxialDamping::new(L, 0.1 * EA, L4, Lobatto3), true);
    damps(&BendingDamping::new(L, 0.1 * EI, Gauss2), false);
    damps(&BendingDamping::new(L, 0.1 * EI, Gauss5), false);
}

/// A circular arc, as Hermite's cubic has it nearly, with a point in the plane of `e1` and `e2`.
fn arc(angle: f64) -> [f64; 12] {
    let radius = L / angle;
    let at = |a: f64| [radius * a.sin(), radius * (1.0 - a.cos()), 0.0, a.cos(), a.sin(), 0.0];
    let (start, end) = (at(0.0), at(angle));
    std::array::from_fn(|i| if i < 6 { start[i] } else { end[i - 6] })
}

/// What a centre line can tell from whirling loses nothing: a turn about an axis across the tangents.
#[test]
fn a_bent_cable_that_turns_in_its_plane_is_not_damped() {
    let damping = lanes(&BendingDamping::new(L, 0.1 * EI, Gauss5));
    let power = |v| BendingDamping::power::<f64>(&damping, &at(arc(1.0), v, [0.0; 12])).dissipated;
    let (in_plane, whirling) = ([0.0, 0.0, 2.0], [2.0, 0.0, 0.0]);
    let lost = power(spinning(&arc(1.0), whirling));
    // a whirl at rate w loses as the curvature vector turns: eta EI (w cos of the tangent's angle)² κ² per length
    let mean = 0.5 + 0.25 * f64::sin(2.0);
    let expected = 0.1 * EI * 4.0 / (L * L) * mean * L;
    assert!((lost / expected - 1.0).abs() < 1e-2, "{lost} instead of {expected}");
    assert!(power(spinning(&arc(1.0), in_plane)) < 1e-28 * lost);
}

/// The damping matrix of a straight cable is its bending stiffness times the time.
#[test]
fn a_straight_cable_is_damped_as_it_is_stiff() {
    let straight: [f64; 12] = numbers(&oracle()["configs"]["straight"]["e"]);
    let x = at(straight, [0.0; 12], [0.0; 12]);
    let damping =
        eval(&BendingDamping::new(L, 0.1 * EI, Gauss2), &x, Weights { v: 1.0, ..Weights::default() }).k;
    let cable = CableParams { l: L, ea: 0.0, ei: EI, rho_a: 0.0 };
    let stiffness = eval(&Cable::new(cable, Models::new(L4, T3, LockingFree)), &x, STIFFNESS).k;
    let scale = largest(stiffness.iter().flatten());
    for (c, k) in damping.iter().flatten().zip(stiffness.iter().flatten()) {
        assert!((c - 0.1 * k).abs() < 1e-13 * scale, "{c} {k}");
    }
}

/// Force and energy of cable and rest together at the stress-free shape, turned by 90 degrees.
fn rests<A: Longitudinal, T: Transverse, Q: Rule>(models: Models<A, T, Q>) {
    let Models { longitudinal, transverse, rule } = models;
    let (mut force, mut energy, mut tangent) = (0.0_f64, 0.0_f64, 0.0_f64);
    let own = Cable::new(CableParams { l: L, ea: EA, ei: EI, rho_a: 0.0 }, models);
    for e in bent() {
        let a = AxialRest::at_shape(L, EA, &e, longitudinal, rule.axial());
        let b = BendingRest::at_shape(L, EI, &e, transverse, rule.bending());
        // (x, y, z) -> (-y, x, z)
        let turned = std::array::from_fn(|i| match i % 3 {
            0 => -e[i + 1],
            1 => e[i - 1],
            _ => e[i],
        });
        let x = at(turned, [0.0; 12], [0.0; 12]);
        let cable = eval(&own, &x, STIFFNESS);
        let ra = eval(&a, &x, STIFFNESS);
        let rb = eval(&b, &x, STIFFNESS);
        let total: Vec<f64> = (0..12).map(|i| cable.r[i] + ra.r[i] + rb.r[i]).collect();
        force = force.max(largest(&total) / EA);
        let u = Cable::<A, T, Q>::energy::<f64>(&lanes(&own), &x).potential
            + AxialRest::<A, Q::Axial>::energy::<f64>(&lanes(&a), &x).potential
            + BendingRest::<T, Q::Bending>::energy::<f64>(&lanes(&b), &x).potential;
        energy = energy.max(u.abs() / (EA * L));
        tangent = tangent.max(tangent_error(&a, &e));
        tangent = tangent.max(tangent_error(&b, &e));
        assert!(largest(&ra.r) + largest(&rb.r) > 1.0);
    }
    println!("{}: force {force:.1e} EA, energy {energy:.1e} EA L, tangent {tangent:.1e}", own.label());
    assert!(force < 1e-12 && energy < 1e-12 && tangent < 1e-8);
}

#[test]
fn a_cable_laid_in_a_curve_is_free_of_stress_there() {
    rests(Models::new(L1, T1, LockingFree));
    rests(Models::new(L1n, T1, LockingFree));
    rests(Models::new(L2, T1, LockingFree));
    rests(Models::new(L3, T2, Full));
    rests(Models::new(L4, T3, LockingFree));
    let chosen = CableModel { longitudinal: LongitudinalModel::L3, ..CableModel::default() };
    rests(chosen.models().expect("legal"));
}

#[test]
fn rest_forces_are_derivatives_of_their_energies() {
    let a = AxialRest::new(L, EA, [0.01, -0.02, 0.03, 0.0, 0.0], L4, Lobatto3);
    let b = BendingRest::new(L, EI, [0.5, 1.5, 0.0, 0.0, 0.0], T3, Gauss2);
    fn error<E: Element<12, 12>>(p: &E, e: &[f64; 12]) -> f64 {
        let f = eval(p, &at(*e, [0.0; 12], [0.0; 12]), Weights::default()).r;
        let h = 1e-4;
        let numeric: [f64; 12] = std::array::from_fn(|j| {
            let u = |s: f64| {
                let mut q = *e;
                q[j] += s * h;
                E::energy::<f64>(&lanes(p), &at(q, [0.0; 12], [0.0; 12])).potential
            };
            (8.0 * (u(1.0) - u(-1.0)) - (u(2.0) - u(-2.0))) / (12.0 * h)
        });
        apart(&f, &numeric) / largest(&f)
    }
    for e in bent() {
        assert!(error(&a, &e) < 1e-8);
        assert!(error(&b, &e) < 1e-8);
    }
}

/// A load that depends on everything, with its derivatives.
fn load(s: &Station<f64>) -> Load<f64> {
    let mut out = Load::zero();
    for i in 0..3 {
        let j = (i + 1) % 3;
        out.f[i] = s.x[i] * s.slope[j] + s.v[i] * s.v[j] - 0.3 * s.a[i] * s.x[j];
        out.d_x[i][i] += s.slope[j];
        out.d_x[i][j] -= 0.3 * s.a[i];
        out.d_slope[i][j] += s.x[i];
        out.d_v[i][i] += s.v[j];
        out.d_v[i][j] += s.v[i];
        out.d_a[i][i] -= 0.3 * s.x[j];
    }
    out
}

fn stations(p: &CableStations, x: &Local<f64, 12, 12>) -> [Station<f64>; 4] {
    std::array::from_fn(|k| CableStations::station(p, x, k))
}

fn loaded(x: &Local<f64, 12, 12>, w: Weights) -> Share<f64, 12> {
    let p = CableStations { l: L, s0: 5.0, diameter: 0.1, area: 0.01 };
    let loads = stations(&p, x).map(|s| load(&s));
    let mut out = Share::zero();
    CableStations::spread::<f64, true>(&p, x, &loads, Gives::ALL, &w, &mut out);
    out
}

#[test]
fn stations_spread_loads_and_their_derivatives() {
    let x = at(bent()[1], noise(5, 1.0), noise(6, 1.0));
    let pick = |q, v, a| Weights { q, v, a };
    for w in [pick(1.0, 0.0, 0.0), pick(0.0, 1.0, 0.0), pick(0.0, 0.0, 1.0), pick(1.0, 2.0, 3.0)] {
        let exact = loaded(&x, w).k;
        let h = 1e-3;
        for j in 0..12 {
            let moved = |s: f64| {
                let mut y = x;
                y.q[j] += s * h * w.q;
                y.v[j] += s * h * w.v;
                y.a[j] += s * h * w.a;
                loaded(&y, w).r
            };
            let (p1, m1, p2, m2) = (moved(1.0), moved(-1.0), moved(2.0), moved(-2.0));
            for i in 0..12 {
                let numeric = (8.0 * (p1[i] - m1[i]) - (p2[i] - m2[i])) / (12.0 * h);
                approx::assert_abs_diff_eq!(exact[i][j], numeric, epsilon = 1e-11);
            }
        }
    }
}

#[test]
fn stations_weigh_the_element() {
    let p = CableStations { l: L, s0: 5.0, diameter: 0.1, area: 0.01 };
    let x = at(bent()[1], noise(5, 1.0), noise(6, 1.0));
    let stations = stations(&p, &x);
    approx::assert_relative_eq!(stations.iter().map(|s| s.weight).sum::<f64>(), L, max_relative = 1e-15);
    approx::assert_relative_eq!(stations.iter().map(|s| s.s * s.weight).sum::<f64>() / L, 5.0 + 0.5 * L);
    // a uniform load gives w L [1/2, L/12, 1/2, -L/12]
    let mut one = Load::zero();
    one.f[2] = 1.0;
    let mut out = Share::zero();
    CableStations::spread::<f64, false>(&p, &x, &[one; 4], Gives::NOTHING, &Weights::default(), &mut out);
    for (k, s) in [0.5, L / 12.0, 0.5, -L / 12.0].into_iter().enumerate() {
        approx::assert_relative_eq!(out.r[3 * k + 2], -L * s, max_relative = 1e-14);
    }
}

#[test]
fn readings_of_a_stretched_cable() {
    use {LongitudinalModel as M, TransverseModel as T};
    let p = CableParams { l: L, ea: EA, ei: EI, rho_a: 1.0 };
    let e: [f64; 12] = numbers(&oracle()["configs"]["stretched_oblique"]["e"]);
    let stretch = 1.07_f64;
    let green = 0.5 * (stretch * stretch - 1.0);
    for (longitudinal, strain, tension) in [
        (M::L1, 0.07, 0.07 * EA),
        (M::L1n, 0.07, 0.07 * stretch * EA),
        (M::L2, green, green * stretch * EA),
        (M::L3, green, green * stretch * EA),
        (M::L4, 0.07, 0.07 * EA),
    ] {
        let model = CableModel { longitudinal, transverse: T::T1, ..CableModel::default() };
        let r = read(model, &p, &e, &e, 0.3, None).expect("legal");
        approx::assert_relative_eq!(r.strain, strain, max_relative = 1e-12);
        approx::assert_relative_eq!(r.tension, tension, max_relative = 1e-12);
        approx::assert_abs_diff_eq!(r.curvature, 0.0, epsilon = 1e-13);
        approx::assert_relative_eq!(r.position[0], e[0] + 0.3 * L * e[3], max_relative = 1e-13);
        let free = read(model, &p, &e, &e, 0.3, Some(&e)).expect("legal");
        assert_eq!((free.tension, free.moment), (0.0, 0.0));
        // the force on the end is the tension
        struct Pull<'a>(&'a CableParams, &'a [f64; 12]);
        impl WithModels for Pull<'_> {
            type Output = f64;
            fn go<A: Longitudinal, T: Transverse, Q: Rule>(self, models: Models<A, T, Q>) -> f64 {
                let cable = Cable::new(*self.0, models);
                let r = eval(&cable, &at(*self.1, [0.0; 12], [0.0; 12]), Weights::default()).r;
                (r[6] * r[6] + r[7] * r[7] + r[8] * r[8]).sqrt()
            }
        }
        approx::assert_relative_eq!(
            with_models(model, Pull(&p, &e)).expect("legal"),
            tension,
            max_relative = 1e-12
        );
    }
}

#[test]
fn illegal_pairs_and_impossible_elements_are_refused() {
    struct Count(usize);
    impl Sink for Count {
        fn push<E: Element<12, 12>>(&mut self, _: E, _: &[ropewalk_core::NodeId]) {
            self.0 += 1;
        }
    }
    let p = CableParams { l: L, ea: EA, ei: EI, rho_a: 1.0 };
    let bad = CableModel {
        longitudinal: LongitudinalModel::L2,
        transverse: TransverseModel::T3,
        integration: Integration::Full,
    };
    let mut sink = Count(0);
    assert!(push_cable(&mut sink, bad, p, &[]).is_err());
    assert!(push_cable(&mut sink, CableModel::default(), CableParams { l: f64::NAN, ..p }, &[]).is_err());
    assert_eq!(sink.0, 0);
    push_cable(&mut sink, CableModel::default(), p, &[]).expect("legal");
    push_rest(&mut sink, CableModel::default(), p, Rest::Stretched(bent()[0]), &[]).expect("legal");
    assert_eq!(sink.0, 2);
    push_rest(&mut sink, CableModel::default(), p, Rest::Uniform { eps0: 0.0, kappa0: 0.0 }, &[])
        .expect("legal");
    assert_eq!(sink.0, 2, "a straight cable carries nothing");
    assert_eq!(Gauss2.points().len(), 2);
}
