//! Linearised equations against modes, closed forms and the nonlinear motion.

use faer::prelude::Solve;
use faer::{Mat, c64};
use ropewalk::{About, LineariseOptions, ModesOptions, linearise, modes};
use ropewalk_core::{Linearised, Simulation};
use ropewalk_scene::{Format, Scene, SceneFile};

#[track_caller]
fn scene(text: &str) -> Scene {
    SceneFile::parse(text, "scene.toml", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}")).into_scene()
}

#[track_caller]
fn about(scene: &Scene, about: About) -> Linearised {
    let options = LineariseOptions { about, ..LineariseOptions::default() };
    linearise(scene, &options).unwrap_or_else(|e| panic!("{e}"))
}

/// `ẇ = A w` of the reduced equations, `w` and its rate.
fn first_order(l: &Linearised) -> (Mat<f64>, Mat<f64>) {
    let [m, c, k, b, _] = l.reduced();
    let n = m.nrows();
    let lu = m.partial_piv_lu();
    let (minus_k, minus_c, force) = (lu.solve(&k), lu.solve(&c), lu.solve(&b));
    let a = Mat::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
        (true, false) if i == j - n => 1.0,
        (true, _) => 0.0,
        (false, true) => -minus_k[(i - n, j)],
        (false, false) => -minus_c[(i - n, j - n)],
    });
    let b = Mat::from_fn(2 * n, b.ncols(), |i, j| if i < n { 0.0 } else { force[(i - n, j)] });
    (a, b)
}

/// A body that hangs on a rope, with a spring and a damper to the side.
const HANGING: &str = r#"
    [run]
    duration = "3 s"
    from_equilibrium = true
    [solver]
    stepping = { type = "controlled", tolerance = 1e-9 }
    [[inputs]]
    name = "push"
    unit = "N"
    [[elements]]
    type = "cable"
    name = "rope"
    points = [[0, 0, 0], [0, 0, "-2 m"]]
    elements = 3
    section = { mass = "0.5 kg/m", ea = "5 kN", ei = "2 N m^2" }
    [[elements]]
    type = "rigid_body"
    name = "load"
    position = [0, 0, "-2.3 m"]
    mass = "4 kg"
    inertia = [0.2, 0.3, 0.4]
    points = { eye = [0, 0, "0.3 m"], side = ["0.2 m", 0, "-0.1 m"] }
    [[constraints]]
    type = "spherical"
    name = "hook"
    marker = "rope.start"
    [[constraints]]
    type = "spherical"
    name = "eye"
    marker = "rope.end"
    to = "load.eye"
    [[forces]]
    type = "gravity"
    [[forces]]
    type = "spring"
    name = "stay"
    marker = "load.side"
    to = ["3 m", "0.5 m", "-1 m"]
    stiffness = "30 N/m"
    damping = "4 N s/m"
    length = "2 m"
    [[forces]]
    type = "point_force"
    marker = "load.side"
    force = [0, { input = "push" }, 0]
    [[records]]
    type = "position"
    of = "load.side"
    [[records]]
    type = "reaction"
    of = "hook"
"#;

#[test]
fn eigenvalues_on_the_null_space_are_the_modes() {
    let scene = scene(HANGING);
    let l = about(&scene, About::Equilibrium);
    let z = l.null_space();
    let left = l.jacobian.to_dense() * &z;
    assert!(left.norm_max() < 1e-12 * l.jacobian.to_dense().norm_max(), "{:e}", left.norm_max());
    let gram = z.transpose() * &z;
    assert!((gram - Mat::<f64>::identity(z.ncols(), z.ncols())).norm_max() < 1e-12);
    assert_eq!((z.nrows(), z.ncols()), (l.unknowns.len(), l.unknowns.len() - 6));
    let values = first_order(&l).0.eigenvalues().expect("they converge");
    let found = modes(&scene, &ModesOptions { count: 12, ..ModesOptions::default() }).expect("modes");
    assert!(found.modes.len() == 12 && found.modes.iter().any(|m| m.growth < -1e-3));
    for m in &found.modes {
        let distance = |v: &c64| (v.re - m.growth).hypot(v.im - m.omega);
        let off = values.iter().map(distance).fold(f64::INFINITY, f64::min) / m.growth.hypot(m.omega);
        println!("{} + {} i: off by {off:e}", m.growth, m.omega);
        assert!(off < 1e-6, "{off:e}");
    }
}

#[test]
fn transfer_function_of_a_mass_on_a_spring() {
    let (mass, stiffness, damping) = (2.0, 50.0, 3.0);
    let l = about(
        &scene(&format!(
            r#"
            [[inputs]]
            name = "f"
            unit = "N"
            [[elements]]
            type = "point_mass"
            name = "ball"
            marker = ["1 m", 0, 0]
            mass = {mass}
            [[constraints]]
            type = "point_on_line"
            name = "rail"
            marker = "ball"
            to = [0, 0, 0]
            axis = [1, 0, 0]
            [[forces]]
            type = "spring"
            name = "spring"
            marker = "ball"
            to = [0, 0, 0]
            stiffness = {stiffness}
            damping = {damping}
            [[forces]]
            type = "point_force"
            marker = "ball"
            force = [{{ input = "f" }}, 0, 0]
            [[records]]
            type = "position"
            of = "ball"
            [[records]]
            type = "force"
            of = "spring"
            [[records]]
            type = "input"
            of = "f"
            "#
        )),
        About::Equilibrium,
    );
    let names: Vec<&str> = l.outputs.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["ball.x", "ball.y", "ball.z", "spring.tension", "f"]);
    assert_eq!((l.inputs[0].name.as_str(), l.inputs[0].unit.as_str()), ("f", "N"));
    let [m, c, k, b, z] = l.reduced();
    let [yq, yv] = [0, 1].map(|i| l.output[i].to_dense() * &z);
    for omega in [0.0, 1.0, 4.9, 5.0, 30.0] {
        let s = c64::new(0.0, omega);
        let n = m.nrows();
        let a = Mat::from_fn(n, n, |i, j| s * s * m[(i, j)] + s * c[(i, j)] + k[(i, j)]);
        let x = a.partial_piv_lu().solve(Mat::from_fn(n, 1, |i, _| c64::new(b[(i, 0)], 0.0)));
        let out = |row: usize| {
            (0..n)
                .map(|j| (yq[(row, j)] + s * yv[(row, j)]) * x[(j, 0)])
                .fold(c64::new(0.0, 0.0), |sum, x| sum + x)
        };
        let exact = c64::new(1.0, 0.0) / (s * s * mass + s * damping + stiffness);
        let tension = (s * damping + stiffness) * exact;
        for (found, exact) in [(out(0), exact), (out(3), tension)] {
            let off = (found - exact).norm() / exact.norm();
            assert!(off < 1e-8, "at {omega}: {found} instead of {exact}");
        }
    }
    assert_eq!(l.feedthrough.to_dense()[(4, 0)], 1.0);
}

#[test]
fn small_inputs_move_the_model_as_the_linear_equations_say() {
    let scene = scene(HANGING);
    let l = about(&scene, About::Equilibrium);
    let (a, b) = first_order(&l);
    let [.., z] = l.reduced();
    let n = z.ncols();
    // Runge-Kutta for a unit force from rest, in steps that resolve the fastest mode
    let fastest = a.eigenvalues().expect("they converge").iter().map(|v| v.norm()).fold(0.0, f64::max);
    let steps = (2.0 * fastest).ceil() as usize;
    let h = 0.5 / steps as f64;
    let mut w = Mat::<f64>::zeros(2 * n, 1);
    for _ in 0..steps {
        let rate = |w: &Mat<f64>| &a * w + b.subcols(0, 1);
        let k1 = rate(&w);
        let k2 = rate(&(&w + faer::Scale(0.5 * h) * &k1));
        let k3 = rate(&(&w + faer::Scale(0.5 * h) * &k2));
        let k4 = rate(&(&w + faer::Scale(h) * &k3));
        w += faer::Scale(h / 6.0) * (k1 + faer::Scale(2.0) * k2 + faer::Scale(2.0) * k3 + k4);
    }
    let side = l.output[0].to_dense() * &z * w.subrows(0, n);
    let moved = |push: f64| {
        let (mut s, _) = ropewalk::start(&scene, ropewalk::Watch::default()).expect("start");
        let place = |s: &Simulation| {
            let marker = s
                .model
                .part("load")
                .expect("it")
                .marker(&ropewalk_core::Spot::Named("side".into()))
                .expect("it");
            marker.place(s.model.nodes(), &s.state.q, |_| 0.0).x
        };
        let before = place(&s);
        s.set_input("push", push).expect("set");
        s.advance(0.5, 0.5, &mut ()).expect("run");
        let after = place(&s);
        (0..3).map(|i| (after[i] - before[i]) / push - side[(i, 0)]).map(|x| x * x).sum::<f64>().sqrt()
    };
    let [far, near] = [2.0, 1.0].map(moved);
    let size = (0..3).map(|i| side[(i, 0)].powi(2)).sum::<f64>().sqrt();
    println!("off by {:e} and {:e} of {size} m/N", far / size, near / size);
    assert!(far < 0.1 * size && near > 1e-9 * size);
    // what is left of the compliance is proportional to the force
    assert!((far / near - 2.0).abs() < 0.1, "{}", far / near);
}

#[test]
fn a_prescribed_speed_shakes_what_hangs_on_it() {
    // a mass on a spring and damper to a hand that is moved at a speed: x = (c s + k) / (m s² + c s + k) X, with s X = u
    let (mass, stiffness, damping) = (2.0, 50.0, 3.0);
    let l = about(
        &scene(&format!(
            r#"
            [[inputs]]
            name = "u"
            unit = "m/s"
            join = "linear"
            [[motions]]
            type = "input"
            name = "shake"
            speed = "u"
            [[elements]]
            type = "point_mass"
            name = "hand"
            marker = [0, 0, 0]
            mass = 7
            [[elements]]
            type = "point_mass"
            name = "ball"
            marker = ["2 m", 0, 0]
            mass = {mass}
            [[constraints]]
            type = "driving"
            name = "arm"
            marker = "hand"
            motion = "shake"
            [[forces]]
            type = "spring"
            name = "spring"
            marker = "ball"
            to = "hand"
            stiffness = {stiffness}
            damping = {damping}
            [[forces]]
            type = "spring"
            name = "aside"
            marker = "ball"
            to = [2, 5, 0]
            stiffness = 1
            [[forces]]
            type = "spring"
            name = "across"
            marker = "ball"
            to = [2, 0, 5]
            stiffness = 1
            [[records]]
            type = "position"
            of = "ball"
            [[records]]
            type = "position"
            of = "hand"
            "#
        )),
        About::Start,
    );
    let [m, c, k, b, z] = l.reduced();
    let [p0, p1, p2, v] = l.carried().expect("numbers");
    assert_eq!(b.norm_max(), 0.0);
    let yq = l.output[0].to_dense();
    for omega in [0.5, 4.9, 5.0, 30.0] {
        let s = c64::new(0.0, omega);
        let n = m.nrows();
        let a = Mat::from_fn(n, n, |i, j| s * s * m[(i, j)] + s * c[(i, j)] + k[(i, j)]);
        let push = Mat::from_fn(n, 1, |i, _| p0[(i, 0)] / s + p1[(i, 0)] + s * p2[(i, 0)]);
        let w = a.partial_piv_lu().solve(push);
        let place = |row: usize| {
            let own = (0..z.nrows()).map(|i| {
                let q = (0..n).map(|j| w[(j, 0)] * z[(i, j)]).fold(v[(i, 0)] / s, |sum, x| sum + x);
                q * yq[(row, i)]
            });
            own.fold(c64::new(0.0, 0.0), |sum, x| sum + x)
        };
        let hand = c64::new(1.0, 0.0) / s;
        let ball = (s * damping + stiffness) / (s * s * mass + s * damping + stiffness) * hand;
        for (found, exact) in [(place(0), ball), (place(3), hand)] {
            assert!((found - exact).norm() < 1e-8 * exact.norm(), "at {omega}: {found} instead of {exact}");
        }
    }
}

#[test]
fn free_top_precesses_as_euler_says() {
    let l = about(
        &scene(
            "[[elements]]\ntype = \"rigid_body\"\nname = \"top\"\nposition = [0, 0, 0]\nmass = 1\ninertia = [2, 2, 3]\n\
             angular_velocity = [0, 0, 4]\n",
        ),
        About::Start,
    );
    // M δω̇ + C δω = 0 about the axes across: (I₃ - I₁) / I₁ ω₃ = 2 rad/s
    let (m, c) = (l.mass.to_dense(), l.damping.to_dense());
    assert_eq!([m[(3, 3)], m[(4, 4)]], [2.0, 2.0]);
    assert!((c[(3, 4)] - 4.0).abs() < 1e-12 && (c[(4, 3)] + 4.0).abs() < 1e-12, "{c:?}");
    let g = l.gyroscopic.to_dense();
    assert!((g[(3, 4)] - 4.0).abs() < 1e-12 && (&g + g.transpose()).norm_max() < 1e-15);
    let n = l.kinematic.to_dense();
    assert_eq!([n[(3, 4)], n[(4, 3)]], [4.0, -4.0]);
}

#[test]
fn speeds_that_are_inputs_drive_the_constraints() {
    let l = about(
        &scene(
            r#"
            [[inputs]]
            name = "u"
            unit = "m/s"
            join = "linear"
            [[motions]]
            type = "input"
            name = "haul"
            speed = "u"
            direction = [0, 3, 4]
            [[elements]]
            type = "point_mass"
            name = "ball"
            marker = [0, 0, 0]
            mass = 1
            [[constraints]]
            type = "driving"
            name = "driver"
            marker = "ball"
            motion = "haul"
            "#,
        ),
        About::Start,
    );
    let direction = Mat::from_fn(3, 1, |i, _| [0.0, 0.6, 0.8][i]);
    let off = l.jacobian.to_dense() * direction - l.drives.to_dense();
    assert!(off.norm_max() < 1e-12, "{off:?}");
    assert_eq!(l.forces.compute_nnz(), 0);
}
