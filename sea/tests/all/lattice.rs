//! The table against the sums that it stands for.

use ropewalk_sea::{Flow, Lattice, Sampling, Spectrum, SplitMix64, Stretching, Waves, sample};

fn sea(depth: f64, stretching: Stretching) -> Waves {
    let spectrum = Spectrum::Jonswap { hs: 4.0, tp: 10.0, gamma: 3.3 };
    let waves = sample(&spectrum, 200, 11, Sampling::EqualEnergy, 0.6, None).expect("sea");
    Waves::new(&waves, depth, 9.81, stretching).expect("waves")
}

/// The largest and the mean square of differences, in parts of the velocity's deviation: of velocity, acceleration,
/// gradient, elevation.
fn off(waves: &Waves, lattice: &mut Lattice) -> [[f64; 2]; 4] {
    let (mut random, mut worst, mut squares) = (SplitMix64::new(5), [0.0_f64; 4], [0.0; 4]);
    let points = 300;
    let (mut speed, mut rate, mut steep) = (0.0, 0.0, 0.0);
    for _ in 0..points {
        let mut between = |a: f64, b: f64| a + (b - a) * random.unit();
        let (x, t) =
            ([between(-300.0, 300.0), between(-50.0, 50.0), between(-40.0, 0.0)], between(0.0, 500.0));
        let Flow { elevation, velocity, acceleration, gradient, .. } = waves.at(x, t);
        let found = lattice.at(x, t);
        let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
        let all = [
            apart(&velocity, &found.velocity),
            apart(&acceleration, &found.acceleration),
            apart(&gradient.concat(), &found.gradient.concat()),
            (elevation - found.elevation).powi(2),
        ];
        for k in 0..4 {
            assert!(all[k].is_finite());
            worst[k] = worst[k].max(all[k].sqrt());
            squares[k] += all[k] / f64::from(points);
        }
        let zero = [0.0; 9];
        speed += apart(&velocity, &zero) / f64::from(points);
        rate += apart(&acceleration, &zero) / f64::from(points);
        steep += apart(&gradient.concat(), &zero) / f64::from(points);
    }
    let sizes = [speed.sqrt(), rate.sqrt(), steep.sqrt(), waves.deviation()];
    std::array::from_fn(|k| [squares[k].sqrt() / sizes[k], worst[k] / sizes[k]])
}

#[test]
fn the_table_stands_for_the_sums() {
    for (depth, stretching) in [
        (80.0, Stretching::Wheeler),
        (f64::INFINITY, Stretching::Wheeler),
        (60.0, Stretching::Constant),
        (45.0, Stretching::None),
    ] {
        let waves = sea(depth, stretching);
        let mut lattice = Lattice::new(waves.clone(), 1.0).expect("one direction");
        let [u, du, gradient, eta] = off(&waves, &mut lattice);
        println!("{depth} m {stretching:?}: u {u:?}, du {du:?}, gradient {gradient:?}, eta {eta:?}");
        assert!(u[0] < 1e-3 && u[1] < 1e-2, "{u:?}");
        assert!(du[0] < 2e-3 && du[1] < 2e-2, "{du:?}");
        assert!(gradient[0] < 2e-2 && eta[1] < 1e-2, "{gradient:?} {eta:?}");
    }
}

#[test]
fn half_the_distances_leave_a_sixteenth_of_the_error() {
    let waves = sea(80.0, Stretching::Wheeler);
    let [coarse, fine] =
        [1.0, 2.0].map(|finer| off(&waves, &mut Lattice::new(waves.clone(), finer).expect("one")));
    let ratio = coarse[0][0] / fine[0][0];
    assert!((10.0..24.0).contains(&ratio), "{ratio}");
}

#[test]
fn its_gradients_are_those_of_its_own_values() {
    let mut lattice = Lattice::new(sea(80.0, Stretching::Wheeler), 1.0).expect("one direction");
    let (x, t, e) = ([31.7, 4.0, -3.1], 41.3, 1e-5);
    let flow = lattice.at(x, t);
    for j in 0..3 {
        let [a, b] = [-e, e].map(|e| {
            let mut x = x;
            x[j] += e;
            lattice.at(x, t)
        });
        for i in 0..3 {
            let by = |a: f64, b: f64| (b - a) / (2.0 * e);
            assert!((by(a.velocity[i], b.velocity[i]) - flow.gradient[i][j]).abs() < 1e-8);
            let rate = by(a.acceleration[i], b.acceleration[i]);
            assert!((rate - flow.acceleration_gradient[i][j]).abs() < 1e-8, "{i} {j} {rate}");
        }
    }
    let [a, b] = [-e, e].map(|e| lattice.at(x, t + e).elevation);
    assert!(((b - a) / (2.0 * e) - flow.rising).abs() < 1e-8);
}

#[test]
fn it_is_filled_only_where_it_is_looked_at() {
    let waves = sea(80.0, Stretching::Wheeler);
    let mut lattice = Lattice::new(waves, 1.0).expect("one direction");
    for k in 0..100 {
        lattice.at([0.5, 0.2, -3.0], 0.001 * f64::from(k));
    }
    assert_eq!(lattice.columns(), 2);
}

#[test]
fn on_a_current_rates_are_those_of_who_drifts() {
    let waves = sea(80.0, Stretching::None).on_current([1.0, 0.5]).expect("current");
    let mut lattice = Lattice::new(waves.clone(), 1.0).expect("one direction");
    let [u, du, ..] = off(&waves, &mut lattice);
    assert!(u[0] < 1e-3 && du[0] < 2e-3, "{u:?} {du:?}");
}

#[test]
fn seas_of_several_directions_have_no_table() {
    let spectrum = Spectrum::Jonswap { hs: 4.0, tp: 10.0, gamma: 3.3 };
    let spreading = Some(ropewalk_sea::Spreading { s: 4.0, directions: 5 });
    let waves = sample(&spectrum, 50, 1, Sampling::EqualEnergy, 0.0, spreading).expect("sea");
    let waves = Waves::new(&waves, 80.0, 9.81, Stretching::Wheeler).expect("waves");
    assert!(Lattice::new(waves, 1.0).is_none());
}

#[test]
fn far_down_larger_cells_do() {
    let waves = sea(150.0, Stretching::Wheeler);
    let mut lattice = Lattice::new(waves.clone(), 1.0).expect("one direction");
    let mut random = SplitMix64::new(7);
    let size = |u: [f64; 3]| u.iter().map(|u| u * u).sum::<f64>();
    for [high, low] in [[0.0, -10.0], [-10.0, -30.0], [-30.0, -70.0], [-70.0, -110.0], [-110.0, -150.0]] {
        let (mut apart, mut all) = ([0.0_f64; 2], [0.0; 2]);
        for _ in 0..300 {
            let mut between = |a: f64, b: f64| a + (b - a) * random.unit();
            let (t, place) = (between(0.0, 500.0), [between(-300.0, 300.0), between(-50.0, 50.0)]);
            let z =
                between(low, high) + waves.elevation(place[0], place[1], t).0.min(0.0) * (1.0 + high / 150.0);
            let x = [place[0], place[1], z.max(-150.0)];
            let (a, b) = (waves.at(x, t), lattice.at(x, t));
            let top = waves.at([place[0], place[1], 0.0], t);
            for (k, [a, b, top]) in
                [[a.velocity, b.velocity, top.velocity], [a.acceleration, b.acceleration, top.acceleration]]
                    .into_iter()
                    .enumerate()
            {
                apart[k] += size(std::array::from_fn(|i| a[i] - b[i])) / 300.0;
                all[k] += size(top) / 300.0;
            }
        }
        let off = [0, 1].map(|k| (apart[k] / all[k]).sqrt());
        println!("{high} to {low} m: {off:?}");
        assert!(off[0] < 5e-4 && off[1] < 1e-3, "{high} to {low} m: {off:?}");
    }
}

#[test]
fn stations_that_move_find_what_those_find_that_come_anew() {
    use ropewalk_sea::Stations;
    let mut lattice = Lattice::new(sea(80.0, Stretching::Wheeler), 1.0).expect("one direction");
    let mut known = Stations::default();
    for k in 0..2000 {
        let t = 0.013 * f64::from(k) - 0.4 * f64::from(k % 7);
        let x = [10.0 + 3.0 * (0.3 * t).sin(), 0.2 * t, -20.0 + 19.0 * (0.7 * t).sin()];
        let anew = lattice.at(x, t);
        let now = lattice.instant(t);
        let top = lattice.surface(now, [x[0], x[1]], &mut known);
        let motion = lattice.within(now, x, &top, &mut known).spread(&lattice.axes());
        assert_eq!((top, motion), (anew.top(), anew.motion()), "{k}");
    }
}

#[test]
fn a_plane_in_space_has_its_vectors_and_matrices() {
    use ropewalk_sea::{Axes, plus_product, transposed_times};
    let (sin, cos) = 0.7_f64.sin_cos();
    let (plane, space) = (Axes::plane([cos, sin]), Axes::space());
    let (m, x): (_, [f64; 3]) = ([[1.0, 2.0], [3.0, 4.0]], [0.3, -0.5, 0.8]);
    // what is along waves has both horizontal components, and what is across them none in the plane
    let near = |a: [f64; 3], b: [f64; 3]| (0..3).all(|i| (a[i] - b[i]).abs() < 1e-15);
    assert!(near(plane.vector(&[2.0, 5.0]), [2.0 * cos, 2.0 * sin, 5.0]));
    assert!(plane.along(&[-sin, cos, 0.0]).iter().all(|x| x.abs() < 1e-15));
    // in the plane or in space, a matrix makes the same of a vector
    let whole = plane.matrix(&m);
    let in_plane = plane.along(&x);
    let times = |m: &[[f64; 3]; 3], x: [f64; 3]| -> [f64; 3] {
        std::array::from_fn(|i| (0..3).map(|j| m[i][j] * x[j]).sum())
    };
    let made = [0, 1].map(|i| m[i][0] * in_plane[0] + m[i][1] * in_plane[1]);
    assert!(near(plane.vector(&made), times(&whole, x)));
    assert!(near(plane.vector(&transposed_times(&m, &in_plane)), transposed_times(&whole, &x)));
    let rows = plane.rows(&m);
    assert!((0..3).all(|i| near(plane.vector(&rows[i]), whole[i])));
    // and a product is that of its factors
    let square = plane.matrix(&plus_product([[0.0; 2]; 2], &m, &m));
    let twice = plus_product([[0.0; 3]; 3], &whole, &whole);
    assert!((0..3).all(|i| near(square[i], twice[i])));
    // those of space change nothing
    assert_eq!((space.along(&x), space.vector(&x), space.matrix(&whole)), (x, x, whole));
}
