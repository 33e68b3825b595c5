//! The elastic force of every model against the reference, and what must hold for all of them.

use crate::common::*;
use ropewalk_core::{Element, LaneTask, Local, Real, Relaxation, Share, Weights, Width, run};
use ropewalk_elements::cable::longitudinal::Longitudinal;
use ropewalk_elements::cable::quadrature::{Gauss2, Gauss3, Gauss5, Lobatto3, Points, Quadrature, Rule};
use ropewalk_elements::cable::transverse::Transverse;
use ropewalk_elements::cable::*;
use serde_json::Value;

/// One quadrature for both parts.
#[derive(Clone, Copy)]
struct Both<Q>(Q);
impl<Q: Quadrature> Rule for Both<Q> {
    type Axial = Q;
    type Bending = Q;
    fn label(self) -> &'static str {
        self.0.label()
    }
    fn axial(self) -> Q {
        self.0
    }
    fn bending(self) -> Q {
        self.0
    }
}

fn params(o: &Value, ea: f64, ei: f64, rho_a: f64) -> CableParams {
    let get = |name: &str, by: f64| o[name].as_f64().expect("a number") * by;
    CableParams { l: get("L", 1.0), ea: get("EA", ea), ei: get("EI", ei), rho_a: get("rhoA", rho_a) }
}

/// The largest error over all configurations: energy, force, tangent, in units of the largest tangent entry.
fn errors<L: Longitudinal, T: Transverse, Q: Rule>(
    model: &str,
    rule: &str,
    element: Cable<L, T, Q>,
    o: &Value,
) -> [f64; 3] {
    let (p, mut worst) = (&element.params, [0.0_f64; 3]);
    for (name, e) in configurations(o) {
        let reference = &o["configs"][&name]["models"][model][rule];
        let k: Vec<[f64; 12]> = (0..12).map(|i| numbers(&reference["K"][i])).collect();
        let scale = largest(k.iter().flatten());
        let x = at(e, [0.0; 12], [0.0; 12]);
        let out = eval(&element, &x, STIFFNESS);
        let energy = Cable::<L, T, Q>::energy::<f64>(&lanes(&element), &x).potential
            - reference["U"].as_f64().expect("U");
        let force = apart(&out.r, &numbers::<12>(&reference["f"]));
        let tangent = largest((0..12).map(|i| apart(&out.k[i], &k[i])).collect::<Vec<_>>().iter());
        for (w, x) in worst.iter_mut().zip([energy.abs() / (p.l * p.l), force / p.l, tangent]) {
            *w = w.max(if x.is_nan() { f64::INFINITY } else { x / scale });
        }
    }
    println!("{model} {rule}: energy {:.1e}, force {:.1e}, tangent {:.1e}", worst[0], worst[1], worst[2]);
    worst
}

fn holds(worst: [f64; 3]) {
    assert!(worst.iter().all(|&e| e < 1e-12), "{worst:?}");
}

/// The models as types, and the same as values.
fn axial<L: Longitudinal, Q: Quadrature>(known: L, chosen: LongitudinalModel, q: Q, rule: &str, o: &Value) {
    let p = params(o, 1.0, 0.0, 0.0);
    holds(errors(known.label(), rule, Cable::new(p, Models::new(known, T1, Both(q))), o));
    let models = Models::new(chosen, TransverseModel::T1, Both(Points::of(q)));
    holds(errors(known.label(), rule, Cable::new(p, models), o));
}
fn bending<T: Transverse, Q: Quadrature>(known: T, chosen: TransverseModel, q: Q, rule: &str, o: &Value) {
    let p = params(o, 0.0, 1.0, 0.0);
    holds(errors(known.label(), rule, Cable::new(p, Models::new(L2, known, Both(q))), o));
    let models = Models::new(LongitudinalModel::L2, chosen, Both(Points::of(q)));
    holds(errors(known.label(), rule, Cable::new(p, models), o));
}

#[test]
fn longitudinal_models_agree_with_the_oracle() {
    use LongitudinalModel as M;
    let o = oracle();
    axial(L1, M::L1, Gauss2, "exact", &o);
    axial(L1n, M::L1n, Gauss2, "exact", &o);
    axial(L2, M::L2, Gauss2, "exact", &o);
    axial(L3, M::L3, Gauss2, "g2", &o);
    axial(L3, M::L3, Gauss3, "g3", &o);
    axial(L3, M::L3, Gauss5, "g5", &o);
    axial(L3, M::L3, Gauss5, "exact", &o);
    axial(L3, M::L3, Lobatto3, "lob3", &o);
    axial(L4, M::L4, Gauss2, "g2", &o);
    axial(L4, M::L4, Gauss3, "g3", &o);
    axial(L4, M::L4, Gauss5, "g5", &o);
    axial(L4, M::L4, Lobatto3, "lob3", &o);
}

#[test]
fn transverse_models_agree_with_the_oracle() {
    use TransverseModel as M;
    let o = oracle();
    bending(T1, M::T1, Gauss2, "exact", &o);
    bending(T1, M::T1, Gauss5, "g5", &o);
    bending(T2, M::T2, Gauss2, "g2", &o);
    bending(T2, M::T2, Gauss3, "g3", &o);
    bending(T2, M::T2, Gauss5, "g5", &o);
    bending(T2, M::T2, Lobatto3, "lob3", &o);
    bending(T3, M::T3, Gauss2, "g2", &o);
    bending(T3, M::T3, Gauss3, "g3", &o);
    bending(T3, M::T3, Gauss5, "g5", &o);
    bending(T3, M::T3, Lobatto3, "lob3", &o);
}

#[test]
fn mass_agrees_with_the_oracle() {
    let o = oracle();
    let cable = Cable::new(params(&o, 0.0, 0.0, 1.0), Models::new(L4, T3, LockingFree));
    let straight = configurations(&o)[0].1;
    let a = noise(3, 1.0);
    let out = eval(&cable, &at(straight, a, a), Weights { a: 1.0, ..Weights::default() });
    let mut kinetic = 0.0;
    let mut inertia = [0.0; 12];
    for i in 0..12 {
        for j in 0..12 {
            let m = if i % 3 == j % 3 { o["mass4"][i / 3][j / 3].as_f64().expect("a number") } else { 0.0 };
            approx::assert_abs_diff_eq!(out.k[i][j], m, epsilon = 1e-15);
            inertia[i] += m * a[j];
        }
        kinetic += 0.5 * a[i] * inertia[i];
    }
    assert!(apart(&out.r, &inertia) < 1e-15);
    let energy = Cable::<L4, T3, LockingFree>::energy::<f64>(&lanes(&cable), &at(straight, a, a));
    approx::assert_relative_eq!(energy.kinetic, kinetic, max_relative = 1e-14);
}

/// Runs one check on every legal pair of models.
fn all_models(f: &mut dyn FnMut(CableModel)) {
    use {LongitudinalModel as L, TransverseModel as T};
    for longitudinal in [L::L1, L::L1n, L::L2, L::L3, L::L4] {
        for transverse in [T::T1, T::T2, T::T3] {
            for integration in [Integration::Full, Integration::LockingFree] {
                if legal(longitudinal, transverse).is_ok() {
                    f(CableModel { longitudinal, transverse, integration });
                }
            }
        }
    }
}

/// Evaluates a whole row of states over lanes.
struct Row<'a, E> {
    element: &'a E,
    states: &'a [Local<f64, 12, 12>],
    out: &'a mut Vec<Share<f64, 12>>,
}
impl<E: Element<12, 12>> LaneTask for Row<'_, E> {
    #[inline(always)]
    fn go<R: Real>(self) {
        for s in self.states.chunks(R::LANES) {
            let pick = |f: &dyn Fn(&Local<f64, 12, 12>, usize) -> f64| -> [R; 12] {
                std::array::from_fn(|i| R::each(|l| f(&s[l.min(s.len() - 1)], i)))
            };
            let x = Local {
                q: pick(&|s, i| s.q[i]),
                v: pick(&|s, i| s.v[i]),
                a: pick(&|s, i| s.a[i]),
                last: pick(&|s, i| s.last[i]),
                relaxed: s[0].relaxed,
            };
            let mut out = Share::zero();
            let w = Weights { q: 1.0, v: 0.5, a: 3.0 };
            E::add::<R, true>(&lanes(self.element), &x, &w, &mut out);
            for l in 0..s.len() {
                let k = std::array::from_fn(|i| std::array::from_fn(|j| out.k[i][j].lane(l)));
                self.out.push(Share { r: std::array::from_fn(|i| out.r[i].lane(l)), k });
            }
        }
    }
}

/// The largest difference between the widths.
fn widths<L: Longitudinal, T: Transverse, Q: Rule>(element: Cable<L, T, Q>, states: &[Local<f64, 12, 12>]) {
    let [one, four, eight] = [Width::One, Width::Four, Width::Eight].map(|width| {
        let mut out = Vec::new();
        run(width, Row { element: &element, states, out: &mut out });
        out
    });
    let mut worst = 0.0_f64;
    for wide in [four, eight] {
        for (a, b) in one.iter().zip(&wide) {
            let scale = largest(a.k.iter().flatten());
            for i in 0..12 {
                worst = worst.max(apart(&a.k[i], &b.k[i]) / scale);
            }
            worst = worst.max(apart(&a.r, &b.r) / (scale * element.params.l));
        }
    }
    println!("{}: widths differ by {worst:.1e}", element.label());
    assert!(worst < 1e-13);
}

#[test]
fn widths_agree() {
    let o = oracle();
    let p = params(&o, 1.0, 1.0, 1.0);
    let states: Vec<_> =
        configurations(&o).into_iter().map(|(_, e)| at(e, noise(1, 1.0), noise(2, 1.0))).collect();
    // every strain and every curvature once: kernels over lanes take long to compile
    widths(Cable::new(p, Models::new(L4, T3, LockingFree)), &states);
    widths(Cable::new(p, Models::new(L3, T2, Full)), &states);
    widths(Cable::new(p, Models::new(L2, T1, LockingFree)), &states);
    widths(Cable::new(p, Models::new(L1, T1, LockingFree)), &states);
    widths(Cable::new(p, Models::new(L1n, T1, LockingFree)), &states);
}

struct Symmetry<'a>(&'a CableParams, &'a [f64; 12]);
impl WithModels for Symmetry<'_> {
    type Output = (bool, f64);
    fn go<L: Longitudinal, T: Transverse, Q: Rule>(self, models: Models<L, T, Q>) -> (bool, f64) {
        let cable = Cable::new(*self.0, models);
        let k = eval(&cable, &at(*self.1, [0.0; 12], [0.0; 12]), STIFFNESS).k;
        let mut skew = 0.0_f64;
        for i in 0..12 {
            for j in 0..i {
                skew = skew.max((k[i][j] - k[j][i]).abs());
            }
        }
        (cable.symmetric(), skew)
    }
}

#[test]
fn tangents_are_symmetric_where_they_say_so() {
    let o = oracle();
    let p = params(&o, 1.0, 1.0, 1.0);
    let e: [f64; 12] = numbers(&o["configs"]["random_3d"]["e"]);
    all_models(&mut |m| {
        let (symmetric, skew) = with_models(m, Symmetry(&p, &e)).expect("legal");
        assert_eq!(symmetric, m.longitudinal != LongitudinalModel::L1n);
        assert_eq!(symmetric, skew == 0.0, "{m:?}: {skew}");
    });
}

struct Objectivity<'a>(&'a CableParams, &'a [f64; 12]);
impl WithModels for Objectivity<'_> {
    type Output = [f64; 2];
    fn go<L: Longitudinal, T: Transverse, Q: Rule>(self, models: Models<L, T, Q>) -> [f64; 2] {
        let cable = Cable::new(*self.0, models);
        let f = |e: &[f64; 12]| eval(&cable, &at(*e, [0.0; 12], [0.0; 12]), STIFFNESS);
        let here = f(self.1);
        let scale = largest(here.k.iter().flatten()) * self.0.l;
        let turn = apart(&f(&rotated(self.1)).r, &rotated(&here.r)) / scale;
        // the shifted positions are rounded, so compare with what those rounded numbers mean at the origin
        let far = shifted(self.1, [1e4, -2e4, 3e4]);
        let back = shifted(&far, [-1e4, 2e4, -3e4]);
        let shift = apart(&f(&far).r, &f(&back).r) / scale;
        [turn, shift]
    }
}

#[test]
fn rigid_motion_changes_nothing() {
    let o = oracle();
    let p = params(&o, 1.0, 1.0, 1.0);
    let mut worst = [0.0_f64; 2];
    for (_, e) in configurations(&o) {
        all_models(&mut |m| {
            let x = with_models(m, Objectivity(&p, &e)).expect("legal");
            worst = [worst[0].max(x[0]), worst[1].max(x[1])];
        });
    }
    println!("rotation {:.1e}, translation {:.1e}", worst[0], worst[1]);
    assert!(worst[0] < 5e-15);
    assert_eq!(worst[1], 0.0, "only r2 - r1 counts, and that is exact once positions are rounded");
}

/// The number of zero modes of a straight element, by elimination with complete pivoting.
fn nullity(mut k: [[f64; 12]; 12]) -> usize {
    let scale = largest(k.iter().flatten());
    for n in 0..12 {
        let mut pivot = (n, n);
        for i in n..12 {
            for j in n..12 {
                if k[i][j].abs() > k[pivot.0][pivot.1].abs() {
                    pivot = (i, j);
                }
            }
        }
        if k[pivot.0][pivot.1].abs() < 1e-12 * scale {
            return 12 - n;
        }
        k.swap(n, pivot.0);
        for row in &mut k {
            row.swap(n, pivot.1);
        }
        for i in n + 1..12 {
            let f = k[i][n] / k[n][n];
            for j in n..12 {
                k[i][j] -= f * k[n][j];
            }
        }
    }
    0
}

struct Nullity<'a>(&'a CableParams, &'a [f64; 12]);
impl WithModels for Nullity<'_> {
    type Output = usize;
    fn go<L: Longitudinal, T: Transverse, Q: Rule>(self, models: Models<L, T, Q>) -> usize {
        nullity(eval(&Cable::new(*self.0, models), &at(*self.1, [0.0; 12], [0.0; 12]), STIFFNESS).k)
    }
}

#[test]
fn nothing_but_rigid_modes_is_free() {
    let o = oracle();
    let p = params(&o, 1.0, 1.0, 1.0);
    let straight: [f64; 12] = numbers(&o["configs"]["straight"]["e"]);
    // three translations and two rotations: spinning about its own axis, a straight element doesn't move
    all_models(&mut |m| assert_eq!(with_models(m, Nullity(&p, &straight)).expect("legal"), 5, "{m:?}"));
    // and what is refused would have two modes more
    let k = eval(
        &Cable::new(p, Models::new(L2, T3, LockingFree)),
        &at(straight, [0.0; 12], [0.0; 12]),
        STIFFNESS,
    )
    .k;
    assert_eq!(nullity(k), 7);
    assert!(legal(LongitudinalModel::L2, TransverseModel::T3).is_err());
}

struct Mixed<'a>(&'a CableParams, &'a [f64; 12]);
impl WithModels for Mixed<'_> {
    type Output = [f64; 2];
    fn go<L: Longitudinal, T: Transverse, Q: Rule>(self, models: Models<L, T, Q>) -> [f64; 2] {
        let mut x = at(*self.1, [0.0; 12], [0.0; 12]);
        let cable = Cable::new(*self.0, models);
        let exact = eval(&cable, &x, STIFFNESS);
        let scale = largest(exact.k.iter().flatten());
        let distance = |x: &Local<f64, 12, 12>| {
            let mixed = eval(&cable, x, STIFFNESS);
            assert_eq!(mixed.r, exact.r);
            (0..12).map(|i| apart(&mixed.k[i], &exact.k[i])).fold(0.0, f64::max) / scale
        };
        let free = f64::INFINITY;
        x.relaxed = Some(Relaxation {
            smooth: true,
            ramp: free,
            ramp_before: free,
            load: 0.0,
            ..Relaxation::default()
        });
        let none = distance(&x);
        x.last = noise(9, 1e-3);
        [none, distance(&x)]
    }
}

#[test]
fn mixed_stress_is_the_exact_tangent_where_nothing_moved() {
    let o = oracle();
    let p = params(&o, 1.0, 1.0, 1.0);
    let e: [f64; 12] = numbers(&o["configs"]["random_3d"]["e"]);
    all_models(&mut |m| {
        let [none, some] = with_models(m, Mixed(&p, &e)).expect("legal");
        assert!(none < 1e-15, "{m:?}: {none}");
        // the linearised strain is off by the square of the increment
        assert!(some > 1e-9 && some < 1e-4, "{m:?}: {some}");
    });
}

#[test]
fn models_have_their_names_in_scenes() {
    let m: CableModel =
        serde_json::from_str(r#"{"longitudinal": "L1n", "transverse": "T1", "integration": "locking-free"}"#)
            .expect("names");
    assert_eq!(m.longitudinal, LongitudinalModel::L1n);
    assert_eq!(serde_json::to_value(m.integration).expect("name"), "locking-free");
    assert_eq!(CableModel::default().longitudinal, LongitudinalModel::L4);
}
