//! Cables through which material flows: inertia against time derivatives at fixed material points, energies, tangents.

use ropewalk_core::testing::{check_tangent, dense, difference};
use ropewalk_core::{
    At, Dual, Element, FieldTerm, Laws, Load, Node, NodeId, NodeKind, Pool, Real, Station, StationPool, Term,
    Weights, Width,
};
use ropewalk_elements::cable::flow::{Embedding, FlowCable, FlowDamping, FlowEnd, FlowStations, FlowWeight};
use ropewalk_elements::cable::quadrature::{Gauss2, Lobatto3, Rule};
use ropewalk_elements::cable::{
    AxialDamping, BendingDamping, CableModel, CableParams, ChosenModels, Full, L1, L2, L3, L4, LockingFree,
    LongitudinalModel, Models, T1, T3,
};
use std::sync::Arc;

const PARAMS: CableParams = CableParams { l: 1.0, ea: 50.0, ei: 0.7, rho_a: 1.3 };

/// Models that are looked up at run time.
fn chosen() -> ChosenModels {
    let model = CableModel { longitudinal: LongitudinalModel::L3, ..CableModel::default() };
    model.models().expect("legal")
}

/// Two nodes of a cable, and the boundaries of its line.
fn nodes(boundaries: usize) -> Vec<Node> {
    let mut nodes: Vec<Node> =
        (0..2).map(|k| Node { kind: NodeKind::Slope, q: 6 * k, v: 6 * k, shared: false }).collect();
    for k in 0..boundaries {
        nodes.push(Node { kind: NodeKind::Scalars(1), q: 12 + k, v: 12 + k, shared: true });
    }
    nodes
}

fn on(boundaries: usize) -> Vec<NodeId> {
    (0..2 + boundaries as u32).map(NodeId).collect()
}

/// One of two elements of a line whose start flows, or whose both ends do.
const ONE: Embedding<1> = Embedding { fixed: [0.4, 1.3], by: [[0.8, 0.35]] };
const TWO: Embedding<2> = Embedding { fixed: [0.02, 0.1], by: [[0.8, 0.35], [0.2, 0.65]] };

/// A bent element in motion: coordinates, velocities and accelerations, the boundaries behind the dofs.
fn motion() -> [Vec<f64>; 3] {
    let q = vec![0.1, -0.2, 0.3, 0.9, 0.35, -0.3, 0.75, 0.25, 0.2, 0.8, 0.5, 0.45, -0.3, 0.9];
    let v = vec![0.4, -0.3, 0.5, 0.2, -0.6, 0.1, 0.3, 0.7, -0.2, 0.5, 0.15, -0.45, 0.8, -0.37];
    let a = vec![0.7, 0.2, -0.4, 0.3, 0.5, -0.9, 0.6, -0.1, 0.8, -0.2, 0.35, 0.25, -1.2, 0.66];
    [q, v, a]
}

fn at<'a>(x: &'a [Vec<f64>; 3]) -> At<'a> {
    At { t: 0.3, q: &x[0], v: &x[1], a: &x[2], internal: &[], relaxed: None }
}

fn pool<E: Element<N, N>, const N: usize>(element: E) -> Pool<E, N, N> {
    let mut pool = Pool::new();
    for _ in 0..5 {
        assert!(pool.push(&nodes(N - 12), element.clone(), &on(N - 12)));
    }
    pool
}

/// Shape functions of an element of length `l`.
fn hermite<R: Real>(xi: R, l: R) -> [R; 4] {
    let one = R::of(1.0);
    let (s2, s3, s4) = (xi * (one - xi) * (one - xi), xi * xi * (R::of(3.0) - xi - xi), xi * xi * (xi - one));
    [one - s3, l * s2, s3, l * s4]
}

const GAUSS: [(f64, f64); 5] = [
    (0.046_910_077_030_668_004, 0.118_463_442_528_094_54),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_23),
    (0.5, 64.0 / 225.0),
    (0.769_234_655_052_841_5, 0.239_314_335_249_683_23),
    (0.953_089_922_969_332, 0.118_463_442_528_094_54),
];

type Twice = Dual<Dual<f64>>;

/// The position of the material point `p` as time goes on, by value and two derivatives: twelve dofs and boundaries move
/// on parabolas.
fn material_point(by: &Embedding<2>, x: &[Vec<f64>; 3], p: f64) -> [Twice; 3] {
    let t: Twice = Dual::new(Dual::new(0.0, 1.0), Dual::constant(1.0));
    let y = |i: usize| Twice::of(x[0][i]) + t * (Twice::of(x[1][i]) + t * Twice::of(0.5 * x[2][i]));
    let node =
        |i: usize| Twice::of(by.fixed[i]) + Twice::of(by.by[0][i]) * y(12) + Twice::of(by.by[1][i]) * y(13);
    let (a, b) = (node(0), node(1));
    let s = hermite((Twice::of(p) - a) / (b - a), b - a);
    std::array::from_fn(|c| (0..4).fold(Twice::zero(), |sum, n| sum + s[n] * y(3 * n + c)))
}

#[test]
fn inertia_is_that_of_material_points() {
    let x = motion();
    let elastic = CableParams { ea: 0.0, ei: 0.0, ..PARAMS };
    let (r, _) = dense(
        &pool(FlowCable::new(elastic, Models::new(L4, T3, LockingFree), TWO)),
        &nodes(2),
        &at(&x),
        Weights::default(),
        Width::One,
    );
    let node = |i: usize| TWO.fixed[i] + TWO.by[0][i] * x[0][12] + TWO.by[1][i] * x[0][13];
    let (a, l) = (node(0), node(1) - node(0));
    let mut expected = [0.0; 14];
    for (xi, w) in GAUSS {
        let acceleration = material_point(&TWO, &x, a + xi * l).map(|r| r.eps.eps);
        let s = hermite(xi, l);
        // how the material point moves when a boundary does: by differences of where the curve has it
        let virtual_by_front = |k: usize| {
            difference(|h| {
                let mut moved = x.clone();
                moved[0][12 + k] += h;
                material_point(&TWO, &moved, a + xi * l).map(|r| r.re.re).to_vec()
            })
        };
        for c in 0..3 {
            let f = w * l * PARAMS.rho_a * acceleration[c];
            for n in 0..4 {
                expected[3 * n + c] += s[n] * f;
            }
            for k in 0..2 {
                expected[12 + k] += virtual_by_front(k)[c] * f;
            }
        }
    }
    let size = expected.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    for i in 0..14 {
        // five elements lie on top of each other
        let error = (r[i] / 5.0 - expected[i]).abs() / size;
        let bound = if i < 12 { 1e-14 } else { 1e-10 };
        assert!(error < bound, "equation {i}: {} instead of {}, {error:e}", r[i] / 5.0, expected[i]);
    }
}

#[test]
fn elastic_force_is_the_derivative_of_the_energy() {
    fn check<E: Element<14, 14>>(element: E) {
        let (mut x, pool) = (motion(), pool(element));
        // at rest nothing but elasticity is left
        (x[1], x[2]) = (vec![0.0; 14], vec![0.0; 14]);
        let (r, _) = dense(&pool, &nodes(2), &at(&x), Weights::default(), Width::One);
        let size = r.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        for (i, r) in r.iter().enumerate() {
            let numeric = difference(|h| {
                let mut moved = x.clone();
                moved[0][i] += h;
                vec![pool.energy(&at(&moved)).potential]
            });
            assert!((r - numeric[0]).abs() < 1e-9 * size, "{}, {i}: {r} and {}", pool.label(), numeric[0]);
        }
    }
    check(FlowCable::new(PARAMS, chosen(), TWO));
    check(FlowCable::new(PARAMS, Models::new(L1, T1, LockingFree), TWO));
    check(FlowCable::new(PARAMS, Models::new(L2, T1, LockingFree), TWO));
    check(FlowCable::new(PARAMS, Models::new(L3, T3, Full), TWO));
    check(FlowCable::new(PARAMS, Models::new(L4, T3, LockingFree), TWO));
}

#[test]
fn energy_at_an_end_completes_the_rule_of_the_material() {
    // with exact quadrature dU/dp_b = W_b - (r'·F + r''·F'), and dU/dp_a the same with the other sign
    let mut x = motion();
    (x[1], x[2]) = (vec![0.0; 14], vec![0.0; 14]);
    let by = Embedding::<2> { fixed: [0.0; 2], by: [[1.0, 0.0], [0.0, 1.0]] };
    let params = CableParams { ei: 0.0, ..PARAMS };
    let residual = |term: &dyn Term| dense(term, &nodes(2), &at(&x), Weights::default(), Width::One).0;
    let u = residual(&pool(FlowCable::new(params, Models::new(L3, T1, Full), by)));
    let l = x[0][13] - x[0][12];
    for (end, sign) in [(0, 1.0), (1, -1.0)] {
        let w =
            residual(&pool(FlowEnd::new(params, Models::new(L3, T1, Full), by, end, end)))[12 + end] * sign;
        let e: Vec<[f64; 3]> = x[0].chunks(3).take(4).map(|c| [c[0], c[1], c[2]]).collect();
        let bend: [f64; 3] = std::array::from_fn(|c| {
            let chord = 6.0 * (e[2][c] - e[0][c]) / (l * l);
            let twist = if end == 0 { 4.0 * e[1][c] + 2.0 * e[3][c] } else { 2.0 * e[1][c] + 4.0 * e[3][c] };
            if end == 0 { chord - twist / l } else { twist / l - chord }
        });
        let i = 6 * end;
        let slide: f64 = (0..3).map(|c| e[2 * end + 1][c] * u[i + c] + bend[c] * u[i + 3 + c]).sum();
        // d'Alembert's force on the boundary: that of the energy, and what passes the end
        let expected = -sign * w - slide;
        approx::assert_relative_eq!(u[12 + end], expected, max_relative = 1e-12);
    }
}

/// A law that depends on everything that a station says.
#[derive(Clone)]
struct Everything;
impl ropewalk_core::Law for Everything {
    fn label(&self) -> String {
        "everything".into()
    }
    fn load<R: Real, const TANGENT: bool>(&self, _: f64, at: &Station<R>, out: &mut Load<R>) {
        let m = [[0.3, -0.5, 0.7], [0.9, 0.2, -0.4], [-0.6, 0.8, 0.1]].map(|row| row.map(R::of));
        for i in 0..3 {
            for j in 0..3 {
                let k = (i + j) % 3;
                out.f[i] += m[i][j] * at.x[j] * at.slope[k] + m[j][i] * at.v[j] * at.v[k] - m[i][j] * at.a[j];
                out.d_x[i][j] += m[i][j] * at.slope[k];
                out.d_slope[i][k] += m[i][j] * at.x[j];
                out.d_v[i][j] += m[j][i] * at.v[k];
                out.d_v[i][k] += m[j][i] * at.v[j];
                out.d_a[i][j] -= m[i][j];
                out.f[i] += m[i][k] * at.slope_rate[j];
                out.d_rate[i][j] += m[i][k];
                out.g[i] += m[j][k] * at.x[j] * at.slope[k] - m[k][i] * at.v[j] * at.slope[j];
                out.g_x[i][j] += m[j][k] * at.slope[k];
                out.g_slope[i][k] += m[j][k] * at.x[j];
                out.g_v[i][j] -= m[k][i] * at.slope[j];
                out.g_slope[i][j] -= m[k][i] * at.v[j];
            }
        }
    }
}

fn loaded<const F: usize, const N: usize>(element: FlowStations<F>) -> FieldTerm
where
    FlowStations<F>: ropewalk_core::StationElement<N, N, 4>,
{
    let mut stations = StationPool::<FlowStations<F>, N, N, 4>::new();
    for _ in 0..5 {
        assert!(stations.push(&nodes(F), element, &on(F)));
    }
    let mut laws = Laws::default();
    laws.push(Everything);
    FieldTerm { part: "cable".into(), stations: Arc::new(stations), laws }
}

#[test]
fn tangents_agree_with_differences() {
    let x = motion();
    let axial = AxialDamping::new(1.0, 3.0, L4, Lobatto3);
    let slow = AxialDamping::new(1.0, 3.0, chosen().longitudinal, chosen().rule.axial());
    let bending = BendingDamping::new(1.0, 0.6, Gauss2);
    let one = FlowStations::<1> { by: ONE, slip: [1.0], diameter: 0.1, area: 0.01 };
    let two = FlowStations::<2> { by: TWO, slip: [0.7, 0.3], diameter: 0.1, area: 0.01 };
    let terms: Vec<(usize, Box<dyn Term>)> = vec![
        (1, Box::new(pool::<_, 13>(FlowCable::new(PARAMS, Models::new(L4, T3, LockingFree), ONE)))),
        (2, Box::new(pool::<_, 14>(FlowCable::new(PARAMS, Models::new(L4, T3, LockingFree), TWO)))),
        (2, Box::new(pool::<_, 14>(FlowCable::new(PARAMS, Models::new(L2, T1, LockingFree), TWO)))),
        (1, Box::new(pool::<_, 13>(FlowCable::new(PARAMS, Models::new(L3, T3, Full), ONE)))),
        (1, Box::new(pool::<_, 13>(FlowCable::new(PARAMS, chosen(), ONE)))),
        (2, Box::new(pool::<_, 14>(FlowEnd::new(PARAMS, chosen(), TWO, 0, 0)))),
        (2, Box::new(pool::<_, 14>(FlowDamping { damping: slow, by: TWO }))),
        (1, Box::new(pool::<_, 13>(FlowEnd::new(PARAMS, Models::new(L4, T3, LockingFree), ONE, 0, 0)))),
        (2, Box::new(pool::<_, 14>(FlowEnd::new(PARAMS, Models::new(L4, T3, LockingFree), TWO, 1, 1)))),
        (1, Box::new(pool::<_, 13>(FlowWeight::<1> { load: [0.3, -0.4, -9.0], by: ONE }))),
        (2, Box::new(pool::<_, 14>(FlowWeight::<2> { load: [0.3, -0.4, -9.0], by: TWO }))),
        (1, Box::new(pool::<_, 13>(FlowDamping { damping: axial, by: ONE }))),
        (2, Box::new(pool::<_, 14>(FlowDamping { damping: axial, by: TWO }))),
        (2, Box::new(pool::<_, 14>(FlowDamping { damping: bending, by: TWO }))),
        (1, Box::new(loaded(one))),
        (2, Box::new(loaded(two))),
        (2, Box::new(loaded(FlowStations { slip: [0.0; 2], ..two }))),
    ];
    for (boundaries, term) in terms {
        let x = x.clone().map(|mut x| {
            x.truncate(12 + boundaries);
            x
        });
        for width in [Width::One, Width::Four] {
            let error = check_tangent(term.as_ref(), &nodes(boundaries), &at(&x), width);
            assert!(error < 1e-7, "{} with {boundaries} boundaries, {width:?}: {error:e}", term.label());
        }
    }
}

#[test]
fn energies_balance_what_flows_over_the_ends() {
    // an element alone with both ends flowing: d/dt (T + U) = carried + residual · velocity
    let x = motion();
    let by = Embedding::<2> { fixed: [0.0; 2], by: [[1.0, 0.0], [0.0, 1.0]] };
    let cable = pool::<_, 14>(FlowCable::new(PARAMS, Models::new(L4, T3, LockingFree), by));
    let weight = pool::<_, 14>(FlowWeight::<2> { load: [0.3, -0.4, -9.0], by });
    let ends =
        [0, 1].map(|e| pool::<_, 14>(FlowEnd::new(PARAMS, Models::new(L4, T3, LockingFree), by, e, e)));
    let terms: [&dyn Term; 4] = [&cable, &weight, &ends[0], &ends[1]];
    let energy = |t: f64| {
        let moved = |x: &[f64], v: &[f64], a: &[f64]| -> Vec<f64> {
            (0..14).map(|i| x[i] + t * v[i] + 0.5 * t * t * a[i]).collect()
        };
        let none = vec![0.0; 14];
        let now = [moved(&x[0], &x[1], &x[2]), moved(&x[1], &x[2], &none), x[2].clone()];
        terms.iter().map(|term| term.energy(&at(&now))).map(|e| e.kinetic + e.potential).sum::<f64>()
    };
    let rate = difference(|h| vec![energy(h)])[0];
    let mut work = 0.0;
    let mut carried = 0.0;
    for term in terms {
        let (r, _) = dense(term, &nodes(2), &at(&x), Weights::default(), Width::One);
        work += r.iter().zip(&x[1]).map(|(r, v)| r * v).sum::<f64>();
        carried += term.power(&at(&x)).carried;
    }
    approx::assert_relative_eq!(rate, work + carried, max_relative = 1e-9);
}
