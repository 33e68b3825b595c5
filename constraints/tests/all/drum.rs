//! What lies on drums: the geometry of layers, and the stretch with which cable was wound.

use num_dual::Dual2_64;
use ropewalk_constraints::testing::{Layers, Locked};
use std::f64::consts::{PI, TAU};

const DRUM: Layers = Layers { radius: 0.3, pitch: 0.02, rise: 0.017, turns: Some(5.5) };

#[test]
fn length_is_the_integral_of_the_radius_and_smooth_over_layers() {
    let (n, end) = (200_000, 90.0);
    let h = end / f64::from(n);
    let (mut length, mut inertia) = (0.0, 0.0);
    for i in 0..n {
        let r = DRUM.at((f64::from(i) + 0.5) * h).radius;
        length += r * h;
        inertia += r.powi(3) * h;
    }
    let got = DRUM.at(end).length;
    assert!((got - length).abs() <= 1e-8, "{got} m, not {length} m");
    assert!((DRUM.inertia(end) - inertia).abs() <= 1e-8, "{} not {inertia}", DRUM.inertia(end));
    for layer in [1.0, 2.0] {
        let joint = TAU * 5.5 * layer;
        for at in [joint, joint - PI] {
            let [a, b] = [-1e-9, 1e-9].map(|d| DRUM.at(Dual2_64::new(at + d, 1.0, 0.0)));
            for (a, b) in [(a.x, b.x), (a.radius, b.radius), (a.length, b.length)] {
                let off = (a.re - b.re).abs() + (a.v1 - b.v1).abs() + (a.v2 - b.v2).abs();
                assert!(off <= 1e-8, "{off} at {at} rad");
            }
        }
    }
}

#[test]
fn a_layer_goes_from_flange_to_flange_and_length_gives_the_angle_back() {
    // the next layer begins where this one ended
    let (first, second) = (DRUM.at(0.0_f64), DRUM.at(TAU * 5.5 + 1e-12));
    assert!((first.x + 0.05).abs() <= 1e-12 && (second.x - 0.05).abs() <= 1e-12);
    for angle in [-3.0, 0.0, 1.0, 32.0, 34.0, 50.0, 70.0, 100.0] {
        let back = DRUM.angle(DRUM.at(angle).length);
        assert!((back - angle).abs() <= 1e-10, "{back} not {angle}");
    }
}

fn locked() -> (Locked, Vec<f64>) {
    (Locked::new(3, 1.01, 0.5), vec![0.0; 3 + Locked::memory()])
}

#[test]
fn what_is_wound_comes_back_as_it_was() {
    let (locked, mut memory) = locked();
    // 10 m in, at a stretch that rises from 1.02 to 1.03
    let (mut length, mut known) = (0.0, vec![[0.0, 0.0]]);
    locked.wind(&mut memory, 0.0, 1.02);
    for k in 1..=1000 {
        let fed = -0.01 * f64::from(k);
        length -= 0.01 * (1.02 + 1e-5 * f64::from(k - 1));
        locked.wind(&mut memory, fed, 1.02 + 1e-5 * f64::from(k));
        known.push([fed, length]);
    }
    for [fed, length] in known.iter().rev() {
        let got = locked.at(&memory, *fed).sum(*fed);
        // up to half a step's rise over the distance of places, but where it goes over from what was there before
        let most = if *fed < -0.6 { 0.5 * 1e-5 * 0.52 } else { 0.01 * 0.5 };
        assert!((got - length).abs() <= most, "{got} not {length} at {fed}");
        locked.wind(&mut memory, *fed, 1.5);
    }
    // the whole of it is what it was, and below lies what was there at the start
    assert!(locked.at(&memory, 0.0).sum(0.0_f64).abs() <= 1e-12);
    assert!((locked.at(&memory, 2.0).sum(2.0_f64) - 2.02).abs() <= 1e-12);
    assert_eq!(locked.at(&memory, 2.0).per_length(2.0_f64), 1.01);
}

#[test]
fn nothing_jumps_where_cable_of_another_stretch_comes_off() {
    let (locked, mut memory) = locked();
    for (k, stretch) in
        [(1.0, 1.02), (2.0, 1.02), (3.0, 1.05), (4.0, 1.05), (4.2, 1.0), (4.3, 1.0), (3.5, 1.04), (6.0, 1.0)]
    {
        locked.wind(&mut memory, -k, stretch);
    }
    let n = 100_000;
    let mut before: Option<[f64; 2]> = None;
    for k in 0..=n {
        let fed = -6.0 + 7.0 * f64::from(k) / f64::from(n);
        let passes = locked.at(&memory, fed);
        let now = [passes.sum(fed), passes.per_length(fed)];
        if let Some(before) = before.filter(|_| k > 1) {
            let mean = (now[0] - before[0]) / (7.0 / f64::from(n));
            assert!((now[1] - before[1]).abs() <= 1e-4, "{now:?} after {before:?} at {fed}");
            assert!((mean - now[1]).abs() <= 1e-4, "{mean} not {} at {fed}", now[1]);
        }
        before = Some(now);
    }
}

#[test]
fn more_places_than_are_kept_leave_the_whole_length() {
    let (locked, mut memory) = locked();
    let mut length = 0.0;
    locked.wind(&mut memory, 0.0, 1.02);
    for k in 1..1000 {
        let fed = -f64::from(k);
        length -= locked.at(&memory, fed).per_length(fed);
        locked.wind(&mut memory, fed, 1.02 + 0.01 * f64::from(k).sin());
    }
    let got = locked.at(&memory, -999.0).sum(-999.0_f64);
    assert!((got - length).abs() <= 1e-9, "{got} not {length}");
    assert!(locked.at(&memory, 0.0).sum(0.0_f64).abs() <= 1e-9);
}
