//! Cells, cylinders and balls across the surface of water, against quadrature and differences.

use crate::random::Random;
use ropewalk_core::testing::check_law;
use ropewalk_core::{Law, Load, Station, V3, dot};
use ropewalk_forces::{AddedMass, Buoyancy, Drag, NormalLaw, Surface, TangentialLaw, Theory, Wetted};
use ropewalk_scene::Current;
use std::f64::consts::PI;

const SURFACE: Surface = Surface::still(LEVEL);
const LEVEL: f64 = 0.3;

/// A station of a cylinder of 0.2 m whose cell of 0.25 m lies near the surface.
fn station(r: &mut Random, depth: f64, slope: V3<f64>) -> Station<f64> {
    let radius = 0.1;
    Station {
        x: [0.4, -0.7, LEVEL - depth],
        v: r.vector(2.0),
        a: r.vector(3.0),
        slope,
        slope_rate: r.vector(4.0),
        s: 0.5,
        weight: 0.25,
        before: 0.09,
        element: 0.8,
        diameter: 2.0 * radius,
        area: PI * radius * radius,
        who: 0,
    }
}

fn slopes() -> Vec<V3<f64>> {
    vec![
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 1e-4],
        [0.9, 0.1, 0.05],
        [0.6, 0.3, 0.8],
        [-0.5, 0.9, -0.4],
        [0.1, 0.0, 1.05],
        [0.02, 0.01, -1.0],
    ]
}

/// The wet volume of a cell and the integral of its depth, by slices of it and of its discs.
fn by_slices(at: &Station<f64>) -> (f64, f64) {
    const N: usize = 400;
    let radius = (at.area / PI).sqrt();
    let length = dot(&at.slope, &at.slope).sqrt();
    let steep = (1.0 - (at.slope[2] / length).powi(2)).sqrt();
    let (mut volume, mut depth) = (0.0, 0.0);
    for i in 0..N {
        let along = ((i as f64 + 0.5) / N as f64) * at.weight - at.before;
        let middle = LEVEL - at.x[2] - along * at.slope[2];
        for j in 0..N {
            // chords of the disc along its steepest line
            let angle = PI * (j as f64 + 0.5) / N as f64;
            let (up, chord) = (radius * angle.cos(), 2.0 * radius * angle.sin());
            let d = middle - up * steep;
            let area = chord * radius * angle.sin() * PI / N as f64;
            if d > 0.0 {
                volume += area * at.weight / N as f64;
                depth += area * d * at.weight / N as f64;
            }
        }
    }
    (volume, depth)
}

#[test]
fn the_wet_share_is_that_of_a_cylinder() {
    let mut r = Random(7);
    for slope in slopes() {
        for depth in [-0.35, -0.09, -0.03, 0.0, 0.02, 0.07, 0.2] {
            let at = Station { element: 0.0, ..station(&mut r, depth, slope) };
            let wet = SURFACE.wet(&at, None);
            let (volume, moment) = by_slices(&at);
            let whole = at.area * at.weight;
            assert!(
                (wet.share - volume / whole).abs() < 2e-3,
                "{slope:?} {depth}: {} {}",
                wet.share,
                volume / whole
            );
            // where the disc that is a little high when it is upright counts as upright
            assert!(
                (wet.depth - moment / whole).abs() < 2e-4 * 0.1 + 1e-5,
                "{slope:?} {depth}: {} {}",
                wet.depth,
                moment / whole
            );
        }
    }
}

#[test]
fn the_share_and_the_couple_are_derivatives_of_the_depth() {
    let mut r = Random(11);
    let h = 1e-6;
    for slope in slopes() {
        for depth in [-0.12, -0.03, 0.0, 0.02, 0.07] {
            let at = station(&mut r, depth, slope);
            let wet = SURFACE.wet(&at, None);
            let moved = |i: usize, h: f64| {
                let mut at = at;
                if i < 3 {
                    at.slope[i] += h
                } else {
                    at.x[2] += h
                }
                SURFACE.wet(&at, None)
            };
            let by = |i: usize, f: &dyn Fn(&ropewalk_forces::Wet<f64>) -> f64| {
                (f(&moved(i, h)) - f(&moved(i, -h))) / (2.0 * h)
            };
            assert!((-wet.lift - by(3, &|w| w.depth)).abs() < 1e-8);
            assert!((wet.lift_by_z - by(3, &|w| w.lift)).abs() < 1e-4, "{slope:?} {depth}");
            assert!((wet.share_by_z - by(3, &|w| w.share)).abs() < 1e-4, "{slope:?} {depth}");
            for i in 0..3 {
                assert!((wet.depth_by_slope[i] - by(i, &|w| w.depth)).abs() < 1e-8, "{slope:?} {depth}");
                assert!((wet.lift_by_slope[i] - by(i, &|w| w.lift)).abs() < 1e-5, "{slope:?} {depth}");
                assert!((wet.share_by_slope[i] - by(i, &|w| w.share)).abs() < 1e-5, "{slope:?} {depth}");
                for j in 0..3 {
                    let exact = wet.depth_by_slopes[i][j];
                    assert!(
                        (exact - by(j, &|w| w.depth_by_slope[i])).abs() < 1e-5,
                        "{slope:?} {depth} {i}{j}"
                    );
                }
            }
        }
    }
}

/// All under water a cell of a cable has the depth of its station, and no couple; one of a hull that of its own middle.
#[test]
fn deep_cells_lift_at_their_stations() {
    let mut r = Random(5);
    for slope in slopes() {
        let at = station(&mut r, 4.0, slope);
        let (cable, hull) = (SURFACE.wet(&at, None), SURFACE.wet(&Station { element: 0.0, ..at }, None));
        assert_eq!((cable.lift, cable.share, cable.lift_by_z), (1.0, 1.0, 0.0));
        assert!((cable.depth - 4.0).abs() < 1e-15 && cable.depth_by_slope.iter().all(|x| x.abs() < 1e-15));
        let lever = 0.5 * (at.before - (at.weight - at.before));
        assert!((hull.depth - 4.0 - lever * slope[2]).abs() < 1e-15);
    }
}

#[test]
fn laws_across_the_surface_have_their_tangents() {
    let mut r = Random(3);
    let drag = Drag::new(1025.0, 1e-3, NormalLaw::Constant(1.2), TangentialLaw::Quadratic(0.01)).unwrap();
    let current = Current::Linear { z0: 1.0, velocity: [0.4, 0.1, 0.0], gradient: [0.1, -0.3, 0.05] };
    let mass = AddedMass::new(1025.0, 1.0).unwrap().in_current(current).unwrap();
    for slope in slopes() {
        for depth in [-0.12, -0.03, 0.01, 0.07] {
            let at = station(&mut r, depth, slope);
            for couple in [true, false] {
                let law = Buoyancy { specific_weight: 1e4, surface: SURFACE, couple };
                let error = check_law(&law, 0.0, &at);
                assert!(error < 2e-6, "buoyancy {slope:?} {depth} {couple}: {error:e}");
            }
            for above in [true, false] {
                let error = check_law(&Wetted { law: drag.clone(), surface: SURFACE, above }, 0.0, &at);
                assert!(error < 2e-6, "drag {slope:?} {depth}: {error:e}");
            }
            for theory in [Theory::Energy, Theory::Morison] {
                let error = check_law(&Wetted::below(SURFACE, mass.clone().by(theory)), 0.0, &at);
                assert!(error < 2e-6, "{theory:?} {slope:?} {depth}: {error:e}");
            }
        }
    }
}

#[test]
fn a_deep_body_has_all_of_its_loads_and_a_dry_one_none() {
    let mut r = Random(5);
    let drag = Drag::new(1025.0, 1e-3, NormalLaw::Constant(1.2), TangentialLaw::Quadratic(0.01)).unwrap();
    for slope in slopes() {
        let mut whole = Load::zero();
        let deep = station(&mut r, 3.0, slope);
        drag.load::<f64, true>(0.0, &deep, &mut whole);
        let mut load = Load::zero();
        Wetted::below(SURFACE, drag.clone()).load::<f64, true>(0.0, &deep, &mut load);
        assert_eq!((load.f, load.d_v, load.d_slope), (whole.f, whole.d_v, whole.d_slope));
        let mut load = Load::zero();
        let dry = station(&mut r, -3.0, slope);
        Wetted::below(SURFACE, drag.clone()).load::<f64, true>(0.0, &dry, &mut load);
        assert_eq!((load.f, load.d_v), ([0.0; 3], [[0.0; 3]; 3]));
    }
}

/// Discs and whole cylinders across still water, by quadrature of their own (`tests/data/partly_wet_cylinder.json`).
#[test]
fn partly_wet_cylinders_have_the_volumes_of_the_reference() {
    let path = format!("{}/tests/data/partly_wet_cylinder.json", env!("CARGO_MANIFEST_DIR"));
    let all: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(path).expect("file")).expect("JSON");
    let number = |v: &serde_json::Value| v.as_f64().expect("a number");
    let mut r = Random(3);
    let mut worst: f64 = 0.0;
    for disc in all["disc"].as_array().expect("discs") {
        let [u, share, integral] = ["depth_over_radius", "disc_share", "integral"].map(|k| number(&disc[k]));
        let at = Station { element: 0.0, ..station(&mut r, 0.1 * u, [1.0, 0.0, 0.0]) };
        let wet = SURFACE.wet(&at, None);
        for off in [wet.share - share, wet.depth / 0.1 - integral] {
            worst = if off.abs() <= worst { worst } else { off.abs() };
        }
    }
    println!("discs: off by {worst:.1e}");
    // a disc that lies level is a hundredth of its radius high
    assert!(worst < 1e-4, "{worst}");
    for case in all["cylinders"].as_array().expect("cylinders") {
        let [radius, length, depth, angle, volume] =
            ["R", "L", "axis_depth_at_lower_end", "angle_above_horizontal_deg", "wet_volume"]
                .map(|k| number(&case[k]));
        let (sin, cos) = angle.to_radians().sin_cos();
        let area = PI * radius * radius;
        for cells in [1_i32, 4, 16] {
            let weight = length / f64::from(cells);
            let found: f64 = (0..cells)
                .map(|k| {
                    let s = (f64::from(k) + 0.3) * weight;
                    let at = Station {
                        x: [0.0, 0.0, LEVEL - depth + s * sin],
                        slope: [cos, 0.0, sin],
                        weight,
                        before: 0.3 * weight,
                        element: 0.0,
                        diameter: 2.0 * radius,
                        area,
                        who: 0,
                        ..station(&mut r, 0.0, [1.0, 0.0, 0.0])
                    };
                    SURFACE.wet(&at, None).share * area * weight
                })
                .sum();
            println!("{angle}° in {cells} cells: {:.1e}", found / volume - 1.0);
            assert!((found / volume - 1.0).abs() < 1e-3, "{angle}° in {cells} cells: {found} for {volume}");
        }
    }
}
