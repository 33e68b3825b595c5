//! Forces that functions give: as those of the built-in types that do the same, with derivatives by differences.

use ropewalk_core::rotation::{M3, transposed_times};
use ropewalk_core::testing::{check_tangent, dense};
use ropewalk_core::{
    At, BuildError, Law, Load, Marker, Node, NodeId, NodeKind, Real, Station, Term, V3, Weights, Width,
    broken,
};
use ropewalk_elements::{CableSpec, Section};
use ropewalk_forces::{FunctionForce, FunctionSpec, Scales};
use ropewalk_scene::functions::{
    Called, Function, Parameters, Reads, Seen, Trouble, Written, register_function,
};
use ropewalk_scene::{Builder, ElementSpec, ForceSpec};
use std::sync::Arc;

/// A spring and damper to a point, and a moment that turns a body back and slows it.
#[derive(Clone, Debug)]
struct Tug(Reads);

const TO: V3<f64> = [0.3, -4.0, 0.5];

impl Function for Tug {
    fn reads(&self) -> Reads {
        self.0
    }
    fn force(&self, t: f64, at: &Seen) -> Result<[V3<f64>; 2], Trouble> {
        let f = std::array::from_fn(|i| (40.0 + t) * (TO[i] - at.position[i]) - 7.0 * at.velocity[i]);
        let moment = if self.0.attitude { turn(&at.attitude, &at.angular_velocity) } else { [0.0; 3] };
        Ok([f, moment])
    }
    fn load(&self, _: f64, at: &[Station<f64>]) -> Result<Vec<V3<f64>>, Trouble> {
        Ok(at.iter().map(|s| resist(&s.x, &s.v, &s.slope)).collect())
    }
}

fn turn(r: &M3, omega: &V3<f64>) -> V3<f64> {
    let up = transposed_times(r, &[0.0, 0.0, 1.0]);
    std::array::from_fn(|i| 3.0 * up[i] - 2.0 * omega[i])
}

/// Resistance against the velocity that grows with its square, with depth and with stretch.
fn resist<R: Real>(x: &V3<R>, v: &V3<R>, slope: &V3<R>) -> V3<R> {
    let speed = ropewalk_core::dot(v, v).sqrt();
    let stretch = ropewalk_core::dot(slope, slope);
    v.map(|v| -(R::of(2.0) + R::of(0.3) * x[2]) * speed * v * stretch)
}

impl Written for Tug {
    fn bind(&self, parameters: &Parameters) -> Result<Arc<dyn Function>, BuildError> {
        match parameters.keys().next() {
            None => Ok(Arc::new(self.clone())),
            Some(name) => Err(BuildError::at("parameters", format!("it has no parameter `{name}`"))),
        }
    }
}

const SCALES: Scales = Scales { length: 2.0, gravity: 9.81 };
const ALL: Reads = Reads {
    time: true,
    position: true,
    velocity: true,
    slope: false,
    attitude: true,
    angular_velocity: true,
};

fn nodes() -> Vec<Node> {
    let mut all: Vec<Node> = Vec::new();
    for kind in [NodeKind::Point, NodeKind::Slope, NodeKind::Frame] {
        let (q, v) = all.last().map_or((0, 0), |n| (n.coords().end, n.dofs().end));
        all.push(Node { kind, q, v, shared: false });
    }
    all
}

#[test]
fn tangents_at_markers_are_those_of_the_force() {
    let pushes = Reads { attitude: false, angular_velocity: false, ..ALL };
    let (mut random, nodes) = (crate::random::Random(3), nodes());
    let (mut q, v, a) = (random.list(16, 2.0), random.list(15, 2.0), random.list(15, 2.0));
    let norm = q[12..16].iter().map(|x| x * x).sum::<f64>().sqrt();
    q[12..16].iter_mut().for_each(|x| *x /= norm);
    let at = At { t: 0.3, q: &q, v: &v, a: &a, internal: &[], relaxed: None };
    let (point, cable, body) = (NodeId(0), NodeId(1), NodeId(2));
    for (k, (marker, reads)) in [
        (Marker::node(point), pushes),
        (Marker::node(cable), pushes),
        (Marker::node(body), ALL),
        (Marker::beside(body, [0.3, -0.4, 0.6]), pushes),
        (Marker::beside(body, [0.3, -0.4, 0.6]), ALL),
    ]
    .into_iter()
    .enumerate()
    {
        let name = format!("tug {k}");
        register_function(&name, Arc::new(Tug(reads)));
        let called = Called::find(&name, &Parameters::new()).unwrap();
        let term = FunctionForce::new(name, &nodes, &marker, called, SCALES).unwrap();
        let error = check_tangent(&term, &nodes, &at, Width::One);
        assert!(error < 1e-5, "{k}: {error:.1e}");
        // the work that it brings in is that of its residual
        let (r, _) = dense(&term, &nodes, &at, Weights::default(), Width::One);
        let work: f64 = r.iter().zip(&v).map(|(r, v)| r * v).sum();
        assert!((term.power(&at).supplied + work).abs() < 1e-12 * work.abs(), "{k}: {work}");
    }
}

/// The same as a law of its own.
#[derive(Clone)]
struct Resists;

impl Law for Resists {
    fn label(&self) -> String {
        "resists".into()
    }
    fn load<R: Real, const TANGENT: bool>(&self, _: f64, at: &Station<R>, out: &mut Load<R>) {
        let f = resist(&at.x, &at.v, &at.slope);
        (0..3).for_each(|i| out.f[i] += f[i]);
    }
}

#[test]
fn a_load_is_that_of_a_law_that_does_the_same() {
    let reads = Reads { position: true, velocity: true, slope: true, ..Reads::default() };
    register_function("resist", Arc::new(Tug(reads)));
    let cable = || CableSpec::straight("line", [0.0; 3], [3.0, 0.0, -1.0], 3, Section::new(0.3, 1e5, 0.1));
    let model = |load: &dyn Fn(&mut Builder)| {
        let mut b = Builder::new();
        cable().build(&mut b).unwrap();
        load(&mut b);
        b.finish().unwrap()
    };
    let spec = FunctionSpec {
        function: "resist".into(),
        name: None,
        marker: None,
        on: vec!["line".into()],
        parameters: Parameters::new(),
    };
    let ours = model(&|b| spec.build(b).unwrap());
    let laws = model(&|b| b.load(&[], Resists).unwrap());
    let mut state = ours.state();
    let mut random = crate::random::Random(9);
    state.q.iter_mut().for_each(|q| *q += random.number(0.1));
    state.v.iter_mut().for_each(|v| *v = random.number(2.0));
    let at = state.at();
    let last = |m: &ropewalk_core::Model| m.terms().len() - 1;
    let (term, law) = (&ours.terms()[last(&ours)], &laws.terms()[last(&laws)]);
    let residual =
        |t: &dyn Term, m: &ropewalk_core::Model| dense(t, m.nodes(), &at, Weights::default(), Width::One).0;
    let (a, b) = (residual(term.as_ref(), &ours), residual(law.as_ref(), &laws));
    let size = b.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-13 * size), "{a:?} {b:?}");
    let error = check_tangent(term.as_ref(), ours.nodes(), &at, Width::One);
    assert!(error < 1e-5, "{error:.1e}");
    let (p, q) = (term.power(&at).supplied, law.power(&at).supplied);
    assert!((p - q).abs() < 1e-12 * q.abs(), "{p} {q}");
}

#[test]
fn what_is_wrong_with_a_function_is_said() {
    register_function("resists", Arc::new(Tug(Reads::default())));
    let e = Called::find("resist5", &Parameters::new()).unwrap_err();
    assert!(e.message.contains("there is no function `resist5` in this process"), "{e}");
    let given = Parameters::from([("drag".to_string(), 2.0.into())]);
    assert_eq!(Called::find("resists", &given).unwrap_err().message, "it has no parameter `drag`");
    // a motion it isn't: that ends what asks for one
    assert!(Called::find("resists", &Parameters::new()).unwrap().motion(2.0).0[0].is_nan());
    assert_eq!(
        broken::take().unwrap().to_string(),
        "at t = 2.000000 s the function `resists` gives no motion"
    );
    register_function("looks", Arc::new(Tug(ALL)));
    let called = Called::find("looks", &Parameters::new()).unwrap();
    let message = |marker: &Marker| {
        FunctionForce::new("looks".into(), &nodes(), marker, called.clone(), SCALES).err().unwrap().message
    };
    assert!(message(&Marker::node(NodeId(0))).contains("only bodies have"));
    assert!(message(&Marker::ground([0.0; 3])).contains("name a marker that moves"));
}
