//! Scenes of rigid bodies and joints, and how the tests look at them.
#![allow(dead_code)]

use ropewalk_constraints::{
    PerpendicularSpec, PointOnLineSpec, PrismaticSpec, RevoluteSpec, RotationSpec, SphericalSpec,
    UniversalSpec,
};
use ropewalk_core::integrator::{NewtonPolicy, Options, Scheme, Stepping, consistent};
use ropewalk_core::rotation::{around, bryant, cross, from_matrix, matrix, then, times, transposed_times};
use ropewalk_core::{BuildError, End, Model, Motion, Moving, Simulation, State, V3};
use ropewalk_elements::RigidBodySpec;
use ropewalk_forces::{GravitySpec, PointMomentSpec, SpringSpec, TimeFunction};
use ropewalk_scene::{MarkerRef, MotionSpec, Scene, split_marker};
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

pub const G: f64 = 9.81;

pub fn fixed(h: f64) -> Options {
    Options { stepping: Stepping::Fixed { h }, ..Options::default() }
}

/// Fixed steps whose equations are solved to rounding, to see the order of the scheme.
pub fn tight(h: f64) -> Options {
    Options { newton_tolerance: 1e-4, newton: NewtonPolicy::Full, ..fixed(h) }
}

pub fn controlled(tolerance: f64) -> Options {
    Options { stepping: Stepping::Controlled { tolerance }, ..Options::default() }
}

/// Error control for motion that small errors of the velocities throw off its way.
pub fn careful(tolerance: f64) -> Options {
    Options { newton_tolerance: 1e-2, ..controlled(tolerance) }
}

pub fn radau(tolerance: f64) -> Options {
    Options { scheme: Scheme::RadauIia5, ..controlled(tolerance) }
}

#[track_caller]
pub fn start(scene: &Scene, options: &Options, duration: f64) -> Simulation {
    let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
    let mut s = Simulation::new(model, options, duration).unwrap_or_else(|e| panic!("{e}"));
    s.keep_audit(false);
    s
}

#[track_caller]
pub fn go(s: &mut Simulation, t: f64) {
    assert_eq!(s.advance(t, f64::INFINITY, &mut ()).unwrap_or_else(|e| panic!("{e}")), End::Done);
}

/// The state with the velocities, accelerations and multipliers that go into results.
pub fn for_output(s: &mut Simulation) -> State {
    let mut state = s.state.clone();
    consistent(&s.model, &mut state, &mut s.work).expect("accelerations");
    state
}

/// The time that a quantity is asked for at, `… at t=0.5 s …`.
pub fn time_of(quantity: &str) -> Option<f64> {
    let (_, rest) = quantity.split_once("t=")?;
    rest.split([' ', ',']).next()?.parse().ok()
}

/// Keeps account of the largest error in parts of its tolerance, and says which it is.
#[derive(Default)]
pub struct Worst {
    pub ratio: f64,
    what: String,
}

impl Worst {
    pub fn see(&mut self, what: &str, got: f64, want: f64, tolerance: f64) {
        let ratio = (got - want).abs() / tolerance;
        if !(ratio <= self.ratio) {
            self.ratio = if ratio.is_nan() { f64::INFINITY } else { ratio };
            self.what = format!("{what}: {got} instead of {want}");
        }
    }
    pub fn see_angle(&mut self, what: &str, got: f64, want: f64, tolerance: f64) {
        let off = (got - want + PI).rem_euclid(TAU) - PI;
        self.see(what, want + off, want, tolerance);
    }
    #[track_caller]
    pub fn within_tolerance(&self, name: &str, s: &Simulation) {
        println!("{name}: {:.3} of the tolerance, {}; {:?}", self.ratio, self.what, s.work.counts);
        assert!(self.ratio <= 1.0, "{name}: {:.3} of the tolerance, {}", self.ratio, self.what);
    }
}

/// Where a marker is, and how it moves.
#[track_caller]
pub fn whereabouts(model: &Model, state: &State, marker: &str) -> [V3<f64>; 2] {
    let (part, spot) = split_marker(marker).expect("marker");
    let part = model.part(part).unwrap_or_else(|| panic!("no part {part}"));
    let marker = part.marker(&spot).unwrap_or_else(|e| panic!("{e}"));
    [marker.now(model.nodes(), &state.at()).x, marker.velocity(model.nodes(), &state.at())]
}

/// Orientation of a body, and its angular velocity in its own axes.
#[track_caller]
pub fn attitude(model: &Model, state: &State, body: &str) -> ([f64; 4], V3<f64>) {
    let (q, v) = model.part(body).unwrap_or_else(|| panic!("no body {body}")).seats()[0];
    let (q, v) = (&state.q[q..], &state.v[v..]);
    ([q[3], q[4], q[5], q[6]], [v[3], v[4], v[5]])
}

/// Direction of the body's x axis in the x-y plane [rad].
pub fn heading(model: &Model, state: &State, body: &str) -> f64 {
    let r = matrix(&attitude(model, state, body).0);
    r[1][0].atan2(r[0][0])
}

/// Force of a constraint on the last of its bodies [N], and its moment about the centre of mass in the body's
/// axes [N m].
#[track_caller]
pub fn reaction(model: &Model, state: &State, constraint: &str) -> [V3<f64>; 2] {
    let c = model.constraints().iter().position(|c| c.name() == constraint).expect(constraint);
    let node = *model.constraints()[c].nodes().last().expect("node");
    let r = model.reaction(c, node, &state.at(), &state.lambda);
    [[r[0], r[1], r[2]], [r[3], r[4], r[5]]]
}

pub fn energy(model: &Model, state: &State) -> f64 {
    let e = model.energy(&state.at());
    e.kinetic + e.potential
}

/// Linear momentum, and angular momentum about the origin, of rigid bodies, each with mass and moments of inertia.
pub fn momentum(model: &Model, state: &State, bodies: &[(&str, f64, V3<f64>)]) -> [V3<f64>; 2] {
    let mut sum = [[0.0; 3]; 2];
    for (name, mass, inertia) in bodies {
        let [x, v] = whereabouts(model, state, &format!("{name}.com"));
        let (q, omega) = attitude(model, state, name);
        let p = v.map(|v| mass * v);
        let spin = times(&matrix(&q), &std::array::from_fn(|i| inertia[i] * omega[i]));
        let swing = cross(&x, &p);
        for i in 0..3 {
            sum[0][i] += p[i];
            sum[1][i] += swing[i] + spin[i];
        }
    }
    sum
}

pub fn minus(a: V3<f64>, b: V3<f64>) -> V3<f64> {
    std::array::from_fn(|i| a[i] - b[i])
}

/// The largest magnitude; not a number counts as infinite.
pub fn largest(x: impl IntoIterator<Item = f64>) -> f64 {
    x.into_iter().fold(0.0, |m, x| if x.is_nan() { f64::INFINITY } else { m.max(x.abs()) })
}

/// Numbers with two digits, for messages.
pub fn listed(x: &[f64]) -> String {
    x.iter().map(|x| format!("{x:.1e}")).collect::<Vec<_>>().join(", ")
}

/// How a whole scene stands in space: turned, then moved.
#[derive(Clone, Copy, Debug)]
pub struct Stand {
    pub turn: [f64; 4],
    pub shift: V3<f64>,
}

impl Stand {
    pub const UPRIGHT: Stand = Stand { turn: [1.0, 0.0, 0.0, 0.0], shift: [0.0; 3] };

    pub fn vector(&self, v: V3<f64>) -> V3<f64> {
        times(&matrix(&self.turn), &v)
    }
    pub fn point(&self, x: V3<f64>) -> V3<f64> {
        let x = self.vector(x);
        std::array::from_fn(|i| x[i] + self.shift[i])
    }
    /// Bryant angles of a body with this orientation.
    pub fn angles(&self, q: [f64; 4]) -> V3<f64> {
        bryant(&then(self.turn, q))
    }
    /// Undoes [`Stand::vector`].
    pub fn vector_back(&self, v: V3<f64>) -> V3<f64> {
        transposed_times(&matrix(&self.turn), &v)
    }
    /// Undoes [`Stand::point`].
    pub fn point_back(&self, x: V3<f64>) -> V3<f64> {
        self.vector_back(minus(x, self.shift))
    }
}

/// The orientation whose x axis is along `d`.
pub fn pointing(d: V3<f64>) -> [f64; 4] {
    let [n, m, d] = around(d);
    from_matrix(&std::array::from_fn(|i| [d[i], n[i], m[i]]))
}

/// A homogeneous slender rod from one point to another: its x axis goes along, its origin is where it starts. What it
/// resists turning about itself is as good as nothing.
pub fn rod(name: &str, from: V3<f64>, to: V3<f64>, mass: f64) -> RigidBodySpec {
    let d = minus(to, from);
    let length = d.iter().map(|x| x * x).sum::<f64>().sqrt();
    let j = mass * length * length / 12.0;
    let angles = if d[2] == 0.0 { [0.0, 0.0, d[1].atan2(d[0])] } else { bryant(&pointing(d)) };
    let spec = RigidBodySpec {
        angles,
        centre: [0.5 * length, 0.0, 0.0],
        ..RigidBodySpec::new(name, from, mass, [1e-6 * j, j, j])
    };
    spec.with_point("end", [length, 0.0, 0.0])
}

/// A hinge about z.
pub fn hinge(name: &str, marker: &str, to: impl Into<MarkerRef>) -> RevoluteSpec {
    RevoluteSpec { name: name.into(), marker: marker.into(), to: Some(to.into()), axis: [0.0, 0.0, 1.0] }
}

/// A hinge about z of which only the two equations in the plane are left: closes a loop that is plane already.
pub fn closing(name: &str, marker: &str, to: impl Into<MarkerRef>) -> PointOnLineSpec {
    PointOnLineSpec { name: name.into(), marker: marker.into(), to: Some(to.into()), axis: [0.0, 0.0, 1.0] }
}

/// Closes a plane loop by two equations, or by a hinge with all five.
pub fn close(scene: &mut Scene, redundant: bool, name: &str, marker: &str, to: &str) {
    if redundant {
        scene.constraint(hinge(name, marker, to));
    } else {
        scene.constraint(closing(name, marker, to));
    }
}

/// Angles over time that some cases prescribe.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub enum Angle {
    /// `ω t`
    Steady(f64),
    /// `0.8 t² exp(-t) + 0.3 sin 5t - 1.5 t`
    Rod,
    /// From rest to the speed `ω` within the time `T`, as Kane, Ryan & Banerjee (1987).
    SpinUp(f64, f64),
}

impl Motion for Angle {
    fn at(&self, t: f64) -> Moving {
        let [x, v, a] = match *self {
            Angle::Steady(omega) => [omega * t, omega, 0.0],
            Angle::Rod => {
                let (e, (sin, cos)) = ((-t).exp(), (5.0 * t).sin_cos());
                [
                    0.8 * t * t * e + 0.3 * sin - 1.5 * t,
                    0.8 * (2.0 * t - t * t) * e + 1.5 * cos - 1.5,
                    0.8 * (2.0 - 4.0 * t + t * t) * e - 7.5 * sin,
                ]
            }
            Angle::SpinUp(omega, time) if t < time => {
                let (sin, cos) = (TAU * t / time).sin_cos();
                let whole = omega / time;
                [
                    whole * (0.5 * t * t + (time / TAU).powi(2) * (cos - 1.0)),
                    whole * (t - time / TAU * sin),
                    whole * (1.0 - cos),
                ]
            }
            Angle::SpinUp(omega, time) => [omega * (t - 0.5 * time), omega, 0.0],
        };
        Moving { x: [x, 0.0, 0.0], v: [v, 0.0, 0.0], a: [a, 0.0, 0.0] }
    }
}

/// An [`Angle`] as a motion of a scene.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct AngleSpec {
    pub name: String,
    pub angle: Angle,
}

#[typetag::serde(name = "angle of a test")]
impl MotionSpec for AngleSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn build(&self, _: &[Arc<dyn Motion>]) -> Result<Arc<dyn Motion>, BuildError> {
        Ok(Arc::new(self.angle))
    }
}

/// Drives a marker about an axis by an angle.
pub fn drive(scene: &mut Scene, marker: &str, axis: V3<f64>, angle: Angle) {
    scene.motion(AngleSpec { name: "angle".into(), angle }).constraint(RotationSpec {
        name: "drive".into(),
        marker: marker.into(),
        to: None,
        axis,
        motion: "angle".into(),
    });
}

/// Free rigid body that spins about its middle axis of inertia, and flips.
pub fn dzhanibekov(stand: &Stand) -> Scene {
    let mut scene = Scene::new();
    scene.element(RigidBodySpec {
        angles: stand.angles([1.0, 0.0, 0.0, 0.0]),
        angular_velocity: stand.vector([0.01, 2.0, 0.0]),
        ..RigidBodySpec::new("wing nut", stand.point([0.0; 3]), 1.0, [1.0, 2.0, 3.0])
    });
    scene
}

/// `n` rods of length `l`, hung one on the other from the origin, laid horizontally along x.
pub fn chain(n: usize, l: f64, mass: f64) -> Scene {
    let mut scene = Scene::new();
    for k in 0..n {
        let x = k as f64 * l;
        scene.element(rod(&format!("rod{k}"), [x, 0.0, 0.0], [x + l, 0.0, 0.0], mass));
    }
    scene.constraint(hinge("hinge0", "rod0", [0.0; 3]));
    for k in 1..n {
        let before = format!("rod{}.end", k - 1);
        scene.constraint(hinge(&format!("hinge{k}"), &format!("rod{k}"), before.as_str()));
    }
    scene.set_gravity([0.0, -G, 0.0]).force(GravitySpec::default());
    scene
}

/// A rod at an angle from the vertical down, hinged at the origin.
pub fn rod_pendulum(mass: f64, length: f64, angle: f64) -> Scene {
    let mut scene = Scene::new();
    scene
        .element(rod("rod", [0.0; 3], [length * angle.sin(), -length * angle.cos(), 0.0], mass))
        .constraint(hinge("pivot", "rod", [0.0; 3]))
        .set_gravity([0.0, -G, 0.0])
        .force(GravitySpec::default());
    scene
}

/// `n + 1` cranks in a row, joined by `n` couplers.
pub fn four_bars(n: usize, redundant: bool) -> Scene {
    let mut scene = Scene::new();
    for k in 0..=n {
        let x = k as f64;
        let crank = rod(&format!("crank{k}"), [x, 0.0, 0.0], [x, 1.0, 0.0], 1.0);
        scene.element(RigidBodySpec { angular_velocity: [0.0, 0.0, -1.0], ..crank });
    }
    for k in 0..n {
        let x = k as f64;
        let coupler = rod(&format!("coupler{k}"), [x, 1.0, 0.0], [x + 1.0, 1.0, 0.0], 1.0);
        scene.element(RigidBodySpec { velocity: [1.0, 0.0, 0.0], ..coupler });
    }
    for k in 0..=n {
        scene.constraint(hinge(&format!("ground{k}"), &format!("crank{k}"), [k as f64, 0.0, 0.0]));
    }
    for k in 0..n {
        let crank = format!("crank{k}.end");
        scene.constraint(hinge(&format!("left{k}"), &format!("coupler{k}"), crank.as_str()));
        let (coupler, next) = (format!("coupler{k}.end"), format!("crank{}.end", k + 1));
        close(&mut scene, redundant, &format!("right{k}"), &coupler, &next);
    }
    scene.set_gravity([0.0, -G, 0.0]).force(GravitySpec::default());
    scene
}

/// Crank, rod and slider in space. `axial` is what the rod resists turning about itself [kg m²]; `swapped` names the
/// markers of the joints the other way round, and lists everything from the end.
pub fn slider_crank(axial: f64, stand: &Stand, swapped: bool) -> Scene {
    let (b, c) = ([0.0, 0.1, 0.2], [0.2, 0.0, 0.0]);
    let u = minus(c, b).map(|x| x / 0.3);
    let arm = cross(&[0.0, 1.0, 0.0], &u);
    let size = arm.iter().map(|x| x * x).sum::<f64>().sqrt();
    let arm = arm.map(|x| x / size);
    // the ends of the rod move along y and x; the cross of the universal joint doesn't let it spin
    let (vb, vc) = ([0.0, -0.48, 0.0], [0.24, 0.0, 0.0]);
    let across = cross(&u, &minus(vc, vb)).map(|x| x / 0.3);
    let normal = cross(&arm, &[0.0, 1.0, 0.0]);
    let dot = |a: &V3<f64>, b: &V3<f64>| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
    let spin = -dot(&across, &normal) / dot(&u, &normal);
    let omega: V3<f64> = std::array::from_fn(|i| across[i] + spin * u[i]);

    let mut scene = Scene::new();
    let crank = RigidBodySpec {
        angles: stand.angles([1.0, 0.0, 0.0, 0.0]),
        velocity: [0.0; 3],
        angular_velocity: stand.vector([6.0, 0.0, 0.0]),
        centre: [0.0, 0.0, 0.04],
        ..RigidBodySpec::new("crank", stand.point([0.0, 0.1, 0.12]), 0.12, [1e-4, 1e-4, 1e-5])
    };
    let rod = RigidBodySpec {
        angles: stand.angles(pointing(u)),
        velocity: stand.vector(vb),
        angular_velocity: stand.vector(omega),
        centre: [0.15, 0.0, 0.0],
        ..RigidBodySpec::new("rod", stand.point(b), 0.5, [axial, 4e-3, 4e-3])
    };
    let slider = RigidBodySpec {
        angles: stand.angles([1.0, 0.0, 0.0, 0.0]),
        velocity: stand.vector(vc),
        ..RigidBodySpec::new("slider", stand.point(c), 2.0, [1e-3; 3])
    };
    let bodies = [crank.with_point("pin", [0.0, 0.0, 0.08]), rod.with_point("end", [0.3, 0.0, 0.0]), slider];
    let x = stand.vector([1.0, 0.0, 0.0]);
    let y = stand.vector([0.0, 1.0, 0.0]);
    let arm = stand.vector(arm);
    let pin = stand.point([0.0, 0.1, 0.12]);
    let revolute =
        RevoluteSpec { name: "revolute".into(), marker: "crank".into(), to: Some(pin.into()), axis: x };
    let prismatic = PrismaticSpec { name: "prismatic".into(), marker: "slider".into(), to: None, axis: x };
    let mut ball = SphericalSpec::new("spherical", "rod", "crank.pin");
    let mut universal = UniversalSpec {
        name: "universal".into(),
        marker: "rod.end".into(),
        to: Some("slider".into()),
        axis_to: Some(y),
        axis: Some(arm),
    };
    if swapped {
        ball = SphericalSpec::new("spherical", "crank.pin", "rod");
        universal = UniversalSpec {
            marker: "slider".into(),
            to: Some("rod.end".into()),
            axis_to: Some(arm),
            axis: Some(y),
            ..universal
        };
        for b in bodies.into_iter().rev() {
            scene.element(b);
        }
        scene.constraint(prismatic).constraint(universal).constraint(ball).constraint(revolute);
    } else {
        for b in bodies {
            scene.element(b);
        }
        scene.constraint(revolute).constraint(ball).constraint(universal).constraint(prismatic);
    }
    scene.set_gravity(stand.vector([0.0, 0.0, -G])).force(GravitySpec::default());
    scene
}

/// Two shafts at an angle of 30° with a Hooke joint between them, the first driven at 10 rad/s: at constant speed its own
/// inertia asks for no torque.
pub fn hooke() -> Scene {
    let (sin, cos) = (PI / 6.0).sin_cos();
    let (one, two) = ([1.0, 0.0, 0.0], [cos, sin, 0.0]);
    let omega = 10.0 * cos;
    let driven = RigidBodySpec {
        angular_velocity: [10.0, 0.0, 0.0],
        ..RigidBodySpec::new("driven", [0.0; 3], 1.0, [1e-3; 3])
    };
    let output = RigidBodySpec {
        angles: [0.0, 0.0, PI / 6.0],
        angular_velocity: two.map(|x| omega * x),
        ..RigidBodySpec::new("output", [0.0; 3], 1.0, [0.02; 3])
    };
    let bearing = |name: &str, marker: &str, axis| RevoluteSpec {
        name: name.into(),
        marker: marker.into(),
        to: Some([0.0; 3].into()),
        axis,
    };
    let mut scene = Scene::new();
    scene
        .element(driven)
        .element(output)
        .constraint(bearing("bearing of the first", "driven", one))
        .constraint(bearing("bearing of the second", "output", two))
        .constraint(PerpendicularSpec {
            name: "cross".into(),
            marker: "output".into(),
            to: Some("driven".into()),
            axis_to: Some([0.0, 0.0, 1.0]),
            axis: Some([sin, -cos, 0.0]),
        });
    drive(&mut scene, "driven", one, Angle::Steady(10.0));
    scene
}

/// Andrews' squeezing mechanism: seven bodies in a plane, with a spring and a torque.
pub fn squeezer(order: &[usize; 7], redundant: bool) -> Scene {
    // angles where it starts: β, Θ, γ, Φ, δ, Ω, ε
    let [b, th, g, ph, de, om, ep] = [
        -0.061_713_890_014_276_45,
        0.0,
        0.455_279_819_163_070_37,
        0.222_668_390_165_885_88,
        0.487_364_979_543_842_56,
        -0.222_668_390_165_885_88,
        1.230_547_444_549_821_2,
    ];
    let (xa, ya, xb, yb) = (-0.06934, -0.00227, -0.03635, 0.03273);
    let (d, da, e, ea, rr, ra) = (0.028, 0.0115, 0.02, 0.01421, 0.007, 0.00092);
    let (ss, sa, sb, sc, sd) = (0.035, 0.01874, 0.01043, 0.018, 0.02);
    let (ta, tb, u, ua, ub, zf, zt, fa) = (0.02308, 0.00916, 0.04, 0.01228, 0.00449, 0.02, 0.04, 0.01421);
    // the origin, angle, centre of mass, mass, moment of inertia and points of each body, in axes turned by its angle
    let rotated = |angle: f64, x: f64, y: f64| -> V3<f64> {
        let (sin, cos) = angle.sin_cos();
        [cos * x - sin * y, sin * x + cos * y, 0.0]
    };
    let body =
        |name: &str, at: V3<f64>, angle: f64, centre: [f64; 2], mass: f64, inertia: f64| RigidBodySpec {
            angles: [0.0, 0.0, angle],
            centre: [centre[0], centre[1], 0.0],
            ..RigidBodySpec::new(name, at, mass, [inertia; 3])
        };
    let o = [0.0; 3];
    let (a, bb) = ([xa, ya, 0.0], [xb, yb, 0.0]);
    let plus = |a: V3<f64>, b: V3<f64>| -> V3<f64> { std::array::from_fn(|i| a[i] + b[i]) };
    let crank_pin = rotated(b, rr, 0.0);
    let (a4, a6) = (plus(a, rotated(de, zt, 0.0)), plus(a, rotated(ep, 0.0, -u)));
    let bodies = [
        body("k1", o, b, [ra, 0.0], 0.04325, 2.194e-6).with_point("pin", [rr, 0.0, 0.0]),
        body("k2", crank_pin, b + th, [-da, 0.0], 0.00365, 4.41e-7).with_point("tip", [-d, 0.0, 0.0]),
        body("k3", bb, g, [sb, -sa], 0.02373, 5.255e-6)
            .with_point("tip", [0.0, -ss, 0.0])
            .with_point("spring", [sd, -sc, 0.0]),
        body("k4", a4, ph + de, [0.0, ea - e], 0.00706, 5.667e-7).with_point("tip", [0.0, -e, 0.0]),
        body("k5", a, de, [ta, tb], 0.0705, 1.169e-5).with_point("pin", [zt, 0.0, 0.0]),
        body("k6", a6, om + ep, [zf - fa, 0.0], 0.00706, 5.667e-7).with_point("tip", [zf, 0.0, 0.0]),
        body("k7", a, ep, [-ub, -ua], 0.05498, 1.912e-5).with_point("pin", [0.0, -u, 0.0]),
    ];
    let mut scene = Scene::new();
    for &k in order {
        scene.element(bodies[k].clone());
    }
    scene
        .constraint(hinge("O", "k1", o))
        .constraint(hinge("B", "k3", bb))
        .constraint(hinge("A5", "k5", a))
        .constraint(hinge("A7", "k7", a))
        .constraint(hinge("12", "k2", "k1.pin"))
        .constraint(hinge("45", "k4", "k5.pin"))
        .constraint(hinge("67", "k6", "k7.pin"));
    for k in ["k3", "k4", "k6"] {
        close(&mut scene, redundant, &format!("E{k}"), &format!("{k}.tip"), "k2.tip");
    }
    scene
        .force(SpringSpec {
            name: "spring".into(),
            marker: "k3.spring".into(),
            to: [0.014, 0.072, 0.0].into(),
            stiffness: 4530.0.into(),
            damping: 0.0.into(),
            length: Some(0.07785.into()),
            tension_only: false,
        })
        .force(PointMomentSpec {
            marker: "k1".into(),
            local: false,
            moment: [0.0, 0.0, 0.033].map(Into::into),
            torque: None,
            time: TimeFunction::Constant,
        });
    scene
}

/// The seven angles of [`squeezer`] and the rate of the first.
pub fn squeezer_angles(model: &Model, state: &State) -> ([f64; 7], f64) {
    let [b, k2, g, k4, d, k6, e] =
        ["k1", "k2", "k3", "k4", "k5", "k6", "k7"].map(|k| heading(model, state, k));
    ([b, k2 - b, g, k4 - d, d, k6 - e, e], attitude(model, state, "k1").1[2])
}

/// A door on an axis that leans by 30°, on one hinge or on two, released at 90° from where it comes to rest.
pub fn door(angle: f64, hinges: usize) -> (Scene, [V3<f64>; 3]) {
    let (sin, cos) = (PI / 6.0).sin_cos();
    let axes = [[1.0, 0.0, 0.0], [0.0, cos, sin], [0.0, -sin, cos]];
    let on_axis = |z: f64| axes[2].map(|x| z * x);
    // x towards the free edge, z along the axis
    let (s, c) = angle.sin_cos();
    let x: V3<f64> = std::array::from_fn(|i| s * axes[0][i] - c * axes[1][i]);
    let y = cross(&axes[2], &x);
    let q = from_matrix(&std::array::from_fn(|i| [x[i], y[i], axes[2][i]]));
    let (m, b, h) = (20.0, 0.8_f64, 2.0_f64);
    let (about_x, about_z) = (m * h * h / 12.0, m * b * b / 12.0);
    let leaf = RigidBodySpec {
        angles: bryant(&q),
        centre: [0.5 * b, 0.0, 0.5 * h],
        ..RigidBodySpec::new("door", [0.0; 3], m, [about_x, about_x + about_z, about_z])
    };
    let mut scene = Scene::new();
    scene.element(leaf.with_point("low", [0.0, 0.0, 0.25]).with_point("high", [0.0, 0.0, 1.75]));
    for (name, z) in [("low", 0.25), ("high", 1.75)].into_iter().take(hinges) {
        scene.constraint(RevoluteSpec {
            name: name.into(),
            marker: format!("door.{name}").as_str().into(),
            to: Some(on_axis(z).into()),
            axis: axes[2],
        });
    }
    scene.set_gravity([0.0, 0.0, -G]).force(GravitySpec::default());
    (scene, axes)
}
