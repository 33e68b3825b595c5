//! What the tests of the elements share: reference data, single evaluations and differences.

use ropewalk_core::{Batch, Element, Local, Real, Share, Weights};
use serde_json::Value;

/// The reference computed with forty digits by an independent program; see its `_doc`.
pub fn oracle() -> Value {
    serde_json::from_str(include_str!("../data/oracle.json")).expect("oracle.json")
}

pub fn numbers<const N: usize>(v: &Value) -> [f64; N] {
    std::array::from_fn(|i| v[i].as_f64().expect("a number"))
}

/// The configurations of the reference, by name.
pub fn configurations(o: &Value) -> Vec<(String, [f64; 12])> {
    let configs = o["configs"].as_object().expect("configs");
    configs.iter().map(|(name, c)| (name.clone(), numbers(&c["e"]))).collect()
}

pub fn at(q: [f64; 12], v: [f64; 12], a: [f64; 12]) -> Local<f64, 12, 12> {
    Local { q, v, a, last: [0.0; 12], relaxed: None }
}

/// The numbers of an element, the same in every lane.
#[inline(always)]
pub fn lanes<E: Element<12, 12>, R: Real>(element: &E) -> E::Lanes<R> {
    E::lanes(&Batch::of(std::slice::from_ref(element)))
}

/// Residual and weighted tangent of one element.
pub fn eval<E: Element<12, 12>>(element: &E, x: &Local<f64, 12, 12>, w: Weights) -> Share<f64, 12> {
    let (p, mut out) = (lanes(element), Share::zero());
    E::add::<f64, true>(&p, x, &w, &mut out);
    let mut force = Share::zero();
    E::add::<f64, false>(&p, x, &w, &mut force);
    assert_eq!(force.r, out.r, "the residual doesn't depend on whether the tangent is wanted");
    out
}

pub const STIFFNESS: Weights = Weights { q: 1.0, v: 0.0, a: 0.0 };

pub fn largest<'a>(x: impl IntoIterator<Item = &'a f64>) -> f64 {
    x.into_iter().fold(0.0, |m, x| if x.abs() > m || x.is_nan() { x.abs() } else { m })
}

/// The largest difference of two lists.
pub fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let d: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    largest(&d)
}

/// The weighted tangent by central differences of fourth order of the residual.
pub fn differences<E: Element<12, 12>>(
    element: &E,
    x: &Local<f64, 12, 12>,
    w: Weights,
    h: f64,
) -> [[f64; 12]; 12] {
    let (p, mut k) = (lanes(element), [[0.0; 12]; 12]);
    let r = |y: &Local<f64, 12, 12>| {
        let mut out = Share::zero();
        E::add::<f64, false>(&p, y, &Weights::default(), &mut out);
        out.r
    };
    for j in 0..12 {
        let moved = |s: f64| {
            let mut y = *x;
            y.q[j] += s * h * w.q;
            y.v[j] += s * h * w.v;
            y.a[j] += s * h * w.a;
            r(&y)
        };
        let (p1, m1, p2, m2) = (moved(1.0), moved(-1.0), moved(2.0), moved(-2.0));
        for i in 0..12 {
            k[i][j] = (8.0 * (p1[i] - m1[i]) - (p2[i] - m2[i])) / (12.0 * h);
        }
    }
    k
}

/// Turns all four vectors of an element's dofs by a fixed rotation.
pub fn rotated(e: &[f64; 12]) -> [f64; 12] {
    let (axis, angle) = ([3.0_f64, -1.0, 2.0], 1.234_567_f64);
    let n = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    let u = axis.map(|x| x / n);
    let (s, c) = angle.sin_cos();
    let mut out = [0.0; 12];
    for k in 0..4 {
        let x = &e[3 * k..3 * k + 3];
        let along = u[0] * x[0] + u[1] * x[1] + u[2] * x[2];
        for i in 0..3 {
            let (j, l) = ((i + 1) % 3, (i + 2) % 3);
            out[3 * k + i] = c * x[i] + s * (u[j] * x[l] - u[l] * x[j]) + (1.0 - c) * along * u[i];
        }
    }
    out
}

/// Moves both ends by the same vector.
pub fn shifted(e: &[f64; 12], by: [f64; 3]) -> [f64; 12] {
    let mut out = *e;
    for c in 0..3 {
        out[c] += by[c];
        out[6 + c] += by[c];
    }
    out
}

/// Numbers that look random and are the same every time.
pub fn noise(seed: u64, scale: f64) -> [f64; 12] {
    let mut s = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    std::array::from_fn(|_| {
        s ^= s << 13;
        s ^= s >> 7;
        s ^= s << 17;
        scale * ((s >> 11) as f64 / (1u64 << 53) as f64 * 2.0 - 1.0)
    })
}
