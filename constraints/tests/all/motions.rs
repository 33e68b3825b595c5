//! Motions: derivatives against differences, continuity, exact circles.

use ropewalk_constraints::motion::{
    Circle, Ends, Harmonic, Manoeuvre, Rest, Side, SpeedTable, Straight, Sum, Table, Turn,
};
use ropewalk_core::testing::difference;
use ropewalk_core::{Join, Motion, V3};
use std::sync::Arc;

const MANOEUVRE: Manoeuvre = Manoeuvre {
    heading: [3.0, 4.0, 0.0],
    side: Side::Left,
    speed: 7.716_67,
    start: 2.0,
    ramp: 5.0,
    radius: 25.0,
    turn_start: 10.0,
    turn_ramp: 4.0,
};

fn turns() -> Vec<Turn> {
    let early = Manoeuvre { side: Side::Right, turn_start: 4.0, turn_ramp: 1.5, ..MANOEUVRE };
    let together = Manoeuvre { turn_start: 2.0, turn_ramp: 40.0, ..MANOEUVRE };
    [MANOEUVRE, early, together].map(|m| Turn::new(m).unwrap()).to_vec()
}

fn motions() -> Vec<(Box<dyn Motion>, Vec<f64>)> {
    let rows: Vec<[f64; 4]> =
        (0..12).map(|k| f64::from(k) * 0.5).map(|t| [t, t.sin(), 1.0 - t.cos(), 0.1 * t * t]).collect();
    let mut all: Vec<(Box<dyn Motion>, Vec<f64>)> = vec![
        (Box::new(Rest), vec![0.0]),
        (Box::new(Straight::new([1.0, 2.0, -2.0], 12.9, 1.0, 2.0).unwrap()), vec![1.0, 3.0]),
        (Box::new(Circle::new([0.0, 1.0, 0.0], Side::Right, 25.0, 7.7, 1.0, 5.0).unwrap()), vec![1.0, 6.0]),
        (Box::new(Harmonic::new([0.5, 0.0, 1.0], 0.4, 0.3, 1.0, 2.0).unwrap()), vec![1.0, 3.0]),
    ];
    for ends in [Ends::Natural, Ends::AtRest, Ends::FromRest] {
        all.push((Box::new(Table::new(&rows, Join::Cubic, ends).unwrap()), vec![0.5, 2.0, 5.0]));
    }
    let parts: Vec<Arc<dyn Motion>> = vec![
        Arc::new(Straight::new([1.0, 2.0, -2.0], 12.9, 1.0, 2.0).unwrap()),
        Arc::new(Harmonic::new([0.5, 0.0, 1.0], 0.4, 0.3, 1.5, 2.0).unwrap()),
    ];
    all.push((Box::new(Sum::new(parts)), vec![1.0, 1.5, 3.0, 3.5]));
    for turn in turns() {
        all.push((Box::new(turn), vec![2.0, 4.0, 5.5, 7.0, 10.0, 14.0, 42.0]));
    }
    all
}

fn norm(x: V3<f64>) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[test]
fn derivatives_are_those_of_the_displacement() {
    let mut worst = 0.0_f64;
    for (motion, edges) in motions() {
        let (from, to) = motion.range();
        let times = (0..400)
            .map(|k| 0.01 + 0.1117 * f64::from(k))
            .chain(edges.iter().flat_map(|&t| [t - 3e-4, t + 3e-4]));
        for t in times.filter(|&t| t - 1e-3 > from && t + 1e-3 < to) {
            let m = motion.at(t);
            // differences reach across the edges of the table's pieces, where only the third derivative jumps
            let v = difference(|h| motion.at(t + h).x.to_vec());
            let a = difference(|h| motion.at(t + h).v.to_vec());
            for i in 0..3 {
                worst = worst.max((m.v[i] - v[i]).abs() / (1.0 + norm(m.v)));
                worst = worst.max((m.a[i] - a[i]).abs() / (1.0 + norm(m.a)));
            }
        }
    }
    println!("derivatives of motions: {worst:.1e}");
    assert!(worst < 1e-6, "{worst}");
}

#[test]
fn nothing_jumps_at_the_edges() {
    for (motion, edges) in motions() {
        for t in edges {
            let (a, b) = (motion.at(t - 1e-10), motion.at(t + 1e-10));
            for (a, b) in [(a.x, b.x), (a.v, b.v), (a.a, b.a)] {
                for i in 0..3 {
                    assert!((a[i] - b[i]).abs() < 1e-8, "{motion:?} at {t}");
                }
            }
        }
    }
}

#[test]
fn starts_from_rest() {
    let start: Vec<Box<dyn Motion>> = vec![
        Box::new(Straight::new([1.0, 0.0, 0.0], 5.0, 1.0, 2.0).unwrap()),
        Box::new(Circle::new([1.0, 0.0, 0.0], Side::Left, 25.0, 5.0, 1.0, 2.0).unwrap()),
        Box::new(Harmonic::new([1.0; 3], 1.0, 0.5, 1.0, 2.0).unwrap()),
        Box::new(turns().remove(0)),
    ];
    for m in start {
        for t in [-1e9, 0.0, 1.0] {
            let m = m.at(t);
            assert_eq!([m.x, m.v, m.a].map(|x| x.map(f64::abs)), [[0.0; 3]; 3]);
        }
        assert!(m.steady(0.0).is_none());
    }
}

#[test]
fn straight_run_has_its_speed_and_way() {
    let m = Straight::new([0.0, 0.0, 2.0], 12.0, 1.0, 4.0).unwrap();
    assert_eq!(m.at(3.0).v, [0.0, 0.0, 6.0]);
    approx::assert_relative_eq!(m.at(5.0).x[2], 24.0, max_relative = 1e-14);
    approx::assert_relative_eq!(m.at(7.0).x[2], 48.0, max_relative = 1e-14);
    assert_eq!(m.steady(5.0).unwrap().velocity, [0.0, 0.0, 12.0]);
    assert!(m.steady(4.9).is_none());
}

/// From `t` on: constant radius about the centre, velocity ω × (x - c), acceleration ω × v.
fn check_circle(motion: &dyn Motion, from: f64, radius: f64, speed: f64) -> f64 {
    let frame = motion.steady(from).unwrap();
    assert_eq!(frame.velocity, [0.0; 3]);
    let w = frame.omega;
    let cross = |a: V3<f64>, b: V3<f64>| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let mut worst = (norm(w) * radius / speed - 1.0).abs();
    for k in 0..200 {
        let m = motion.at(from + 0.37 * f64::from(k));
        let r = std::array::from_fn(|i| m.x[i] - frame.centre[i]);
        let (v, a) = (cross(w, r), cross(w, m.v));
        worst = worst.max((norm(r) / radius - 1.0).abs()).max((norm(m.v) / speed - 1.0).abs());
        for i in 0..3 {
            worst = worst
                .max((v[i] - m.v[i]).abs() / speed)
                .max((a[i] - m.a[i]).abs() / (speed * speed / radius));
        }
    }
    worst
}

#[test]
fn circles_are_exact() {
    let circle = Circle::new([1.0, 1.0, 0.0], Side::Left, 25.0, 7.7, 1.0, 5.0).unwrap();
    let mut worst = check_circle(&circle, 6.0, 25.0, 7.7);
    for turn in turns() {
        worst = worst.max(check_circle(&turn, turn.circle_from(), 25.0, MANOEUVRE.speed));
        assert!(turn.steady(turn.circle_from() - 0.1).is_none());
    }
    println!("circles: {worst:.1e}");
    assert!(worst < 1e-12, "{worst}");
    // to port of a northward course lies the west
    assert_eq!(circle.steady(6.0).unwrap().omega[2], 7.7 / 25.0);
    let x = Circle::new([0.0, 1.0, 0.0], Side::Left, 25.0, 7.7, 0.0, 1.0).unwrap().at(2.0).x;
    assert!(x[0] < 0.0 && x[1] > 0.0);
}

#[test]
fn turn_is_the_integral_of_its_velocity() {
    // Simpson's rule with steps so small that only rounding is left
    for turn in turns() {
        let (from, to) = (2.0, 50.0);
        let n = 96_000;
        let h = (to - from) / f64::from(n);
        let mut sum = [0.0; 3];
        for k in 0..n {
            let v = |s: f64| turn.at(from + h * (f64::from(k) + s)).v;
            let (a, b, c) = (v(0.0), v(0.5), v(1.0));
            for i in 0..3 {
                sum[i] += h / 6.0 * (a[i] + 4.0 * b[i] + c[i]);
            }
        }
        let x = turn.at(to).x;
        let error = norm(std::array::from_fn(|i| x[i] - sum[i])) / norm(x);
        println!("turn: {error:.1e}");
        assert!(error < 1e-10, "{error}");
    }
}

#[test]
fn table_goes_through_its_rows_and_reproduces_what_it_can() {
    let rows: Vec<[f64; 4]> =
        [0.0, 0.3, 1.0, 1.2, 2.0].map(|t: f64| [t, 1.0 + 2.0 * t, t * t * (3.0 - t), 0.0]).to_vec();
    let natural = Table::new(&rows, Join::Cubic, Ends::Natural).unwrap();
    let rest = Table::new(&rows, Join::Cubic, Ends::AtRest).unwrap();
    for r in &rows {
        approx::assert_relative_eq!(natural.at(r[0]).x[..], r[1..], epsilon = 1e-13);
    }
    for t in [0.1, 0.7, 1.9] {
        // a straight line is natural; t²(3 - t) ends at 2 without velocity
        approx::assert_relative_eq!(natural.at(t).x[0], 1.0 + 2.0 * t, epsilon = 1e-13);
        approx::assert_relative_eq!(rest.at(t).x[1], t * t * (3.0 - t), epsilon = 1e-13);
    }
    approx::assert_abs_diff_eq!(rest.at(0.0).v[0], 0.0, epsilon = 1e-13);
    approx::assert_abs_diff_eq!(rest.at(2.0).v[0], 0.0, epsilon = 1e-13);
    let from = Table::new(&rows, Join::Cubic, Ends::FromRest).unwrap();
    approx::assert_abs_diff_eq!(from.at(0.0).v[0], 0.0, epsilon = 1e-13);
    approx::assert_abs_diff_eq!(from.at(2.0).a[0], 0.0, epsilon = 1e-13);
    assert_eq!(natural.range(), (0.0, 2.0));
    for ends in [Ends::Natural, Ends::AtRest, Ends::FromRest] {
        assert_eq!(Table::new(&rows[..2], Join::Cubic, ends).unwrap().at(0.3).x, [1.6, rows[1][2], 0.0]);
    }
}

#[test]
fn bad_motions_are_refused() {
    assert!(Straight::new([0.0; 3], 1.0, 0.0, 1.0).is_err());
    assert!(Straight::new([1.0; 3], 1.0, 0.0, 0.0).unwrap_err().to_string().contains("jump"));
    assert!(Straight::new([1.0; 3], f64::NAN, 0.0, 1.0).is_err());
    assert!(Circle::new([0.0, 0.0, 1.0], Side::Left, 1.0, 1.0, 0.0, 1.0).is_err());
    assert!(Circle::new([1.0, 0.0, 0.0], Side::Left, 0.0, 1.0, 0.0, 1.0).is_err());
    assert!(Turn::new(Manoeuvre { turn_start: 1.0, ..MANOEUVRE }).is_err());
    assert!(Turn::new(Manoeuvre { turn_ramp: -1.0, ..MANOEUVRE }).is_err());
    assert!(Harmonic::new([1.0; 3], 0.0, 0.0, 0.0, 1.0).is_err());
    assert!(Table::new(&[[0.0; 4]], Join::Cubic, Ends::Natural).is_err());
    assert!(Table::new(&[[0.0; 4], [0.0; 4]], Join::Cubic, Ends::Natural).is_err());
    assert!(Table::new(&[[0.0; 4], [1.0, f64::NAN, 0.0, 0.0]], Join::Cubic, Ends::Natural).is_err());
}

/// Position, velocity and acceleration of tables belong together between the rows, and position and velocity go on over
/// them.
#[test]
fn tables_are_consistent_however_their_rows_are_joined() {
    let t: Vec<f64> = (0..12).map(|k| 0.5 * f64::from(k) + 0.1 * f64::from(k % 3)).collect();
    let speeds: Vec<[f64; 2]> = t.iter().map(|t| [*t, t.sin()]).collect();
    let rows: Vec<[f64; 4]> = t.iter().map(|t| [*t, t.sin(), (2.0 * t).cos() - 1.0, 0.1 * t * t]).collect();
    let line: Vec<[f64; 4]> = t.iter().map(|t| [*t, 0.3 * t, 0.0, -0.7 * t]).collect();
    let mut all: Vec<Box<dyn Motion>> =
        vec![Box::new(Table::new(&line, Join::Linear, Ends::Natural).unwrap())];
    for join in [Join::Linear, Join::Monotone, Join::Cubic] {
        all.push(Box::new(SpeedTable::new([1.0, -2.0, 2.0], &speeds, join).unwrap()));
    }
    for ends in [Ends::Natural, Ends::AtRest, Ends::FromRest] {
        all.push(Box::new(Table::new(&rows, Join::Monotone, ends).unwrap()));
    }
    for motion in &all {
        for w in t.windows(2) {
            for x in [0.1, 0.5, 0.9] {
                let t = w[0] + x * (w[1] - w[0]);
                let m = motion.at(t);
                let (v, a) = (
                    difference(|h| motion.at(t + h).x.to_vec()),
                    difference(|h| motion.at(t + h).v.to_vec()),
                );
                approx::assert_relative_eq!(m.v[..], v[..], epsilon = 1e-7);
                approx::assert_relative_eq!(m.a[..], a[..], epsilon = 1e-7);
            }
        }
        for t in &t[1..11] {
            let (a, b) = (motion.at(t - 1e-11), motion.at(*t));
            approx::assert_relative_eq!(a.x[..], b.x[..], epsilon = 1e-9);
            approx::assert_relative_eq!(a.v[..], b.v[..], epsilon = 1e-9);
        }
    }
}

/// From rest to 1 m/s in 2 s is 1 m, and 48 m more until 50 s.
#[test]
fn a_table_of_speeds_feeds_the_area_under_it() {
    let rows = [[0.0, 0.0], [2.0, 1.0], [50.0, 1.0]];
    let way = |join, t| SpeedTable::new([1.0, 0.0, 0.0], &rows, join).unwrap().at(t).x[0];
    approx::assert_relative_eq!(way(Join::Linear, 2.0), 1.0, epsilon = 1e-14);
    approx::assert_relative_eq!(way(Join::Linear, 50.0), 49.0, epsilon = 1e-13);
    // rounded off, it is faster before it has risen
    assert!(way(Join::Monotone, 2.0) > 1.15);
}

#[test]
fn a_table_does_not_overshoot_unless_it_is_a_spline() {
    let rows = [[0.0, 0.0], [1.0, 0.0], [2.0, 1.5], [3.0, 1.5]].map(|[t, x]| [t, x, 0.0, 0.0]);
    let largest = |join| {
        let table = Table::new(&rows, join, Ends::Natural).unwrap();
        (0..=300).map(|k| table.at(0.01 * f64::from(k)).x[0]).fold(0.0, f64::max)
    };
    assert_eq!(largest(Join::Monotone), 1.5);
    assert!(largest(Join::Cubic) > 1.55);
    let e = Table::new(&rows, Join::Linear, Ends::Natural).unwrap_err().to_string();
    assert!(e.contains("row 2") && e.contains("velocity would jump at 1 s") && e.contains("monotone"), "{e}");
}

#[test]
fn steps_end_where_tables_bend() {
    let speeds = [[0.0, 0.0], [2.0, 1.0], [50.0, 1.0]];
    let speed = SpeedTable::new([1.0, 0.0, 0.0], &speeds, Join::Linear).unwrap();
    assert_eq!((speed.reach(0.0, 10.0), speed.reach(2.0, 10.0)), (Some(2.0), Some(10.0)));
    // at rest at every row, but not between them
    let rows = [[0.0, 0.0], [1.0, 0.0], [2.0, 1.5], [3.0, 1.5]].map(|[t, x]| [t, x, 0.0, 0.0]);
    let table = Table::new(&rows, Join::Monotone, Ends::Natural).unwrap();
    assert_eq!((table.reach(0.0, 10.0), table.reach(1.0, 10.0)), (Some(1.0), Some(0.5)));
    // a sum says what its parts say
    let swing = Harmonic::new([1.0; 3], 0.1, 0.0, 0.0, 0.0).unwrap();
    let sum = Sum::new(vec![Arc::new(swing), Arc::new(speed)]);
    assert_eq!(sum.reach(1.9, 10.0), Some(2.0 - 1.9));
    assert_eq!(sum.range(), (0.0, 50.0));
}

#[test]
fn steady_runs_add_up_and_what_turns_is_steady_beside_what_rests() {
    let run = || -> Arc<dyn Motion> { Arc::new(Straight::new([1.0, 0.0, 0.0], 2.0, 0.0, 1.0).unwrap()) };
    let round = || -> Arc<dyn Motion> {
        Arc::new(Circle::new([1.0, 0.0, 0.0], Side::Left, 3.0, 1.0, 0.0, 1.0).unwrap())
    };
    let both = Sum::new(vec![run(), run()]);
    assert!(both.steady(0.5).is_none());
    assert_eq!(both.steady(2.0).unwrap().velocity, [4.0, 0.0, 0.0]);
    assert_eq!(Sum::new(vec![Arc::new(Rest), round()]).steady(2.0), round().steady(2.0));
    assert!(Sum::new(vec![run(), round()]).steady(2.0).is_none());
}
