//! The wound curve against differences, and against a helix in closed form.

use ropewalk_constraints::package::{Hand, PackageSpec, Side, Traverse};
use ropewalk_core::dot;
use std::f64::consts::PI;

fn spec() -> PackageSpec {
    PackageSpec { layers: 3, ..PackageSpec::new(0.06, 0.01, 0.9e-3) }
}

fn all() -> Vec<PackageSpec> {
    let mut specs = Vec::new();
    for side in [Side::Inner, Side::Outer] {
        for hand in [Hand::Right, Hand::Left] {
            for traverse in [Traverse::Forward, Traverse::Backward] {
                let tilted = ([0.3, -0.2, 1.0], Some([0.1, 1.0, 0.0]), [1.0, 2.0, 3.0]);
                let (axis, reference, origin) = tilted;
                let first = Some(0.004);
                specs.push(PackageSpec { side, hand, traverse, axis, reference, origin, first, ..spec() });
            }
        }
    }
    specs
}

#[test]
fn derivatives_are_those_of_differences() {
    for spec in all() {
        let p = spec.build().unwrap();
        let n = 4001;
        for k in 1..n {
            let (s, h) = (p.wound() * k as f64 / n as f64, 1e-6);
            let (a, b, c) = (p.at(s - h).unwrap(), p.at(s).unwrap(), p.at(s + h).unwrap());
            assert!((dot(&b.tangent, &b.tangent) - 1.0).abs() < 1e-14);
            for i in 0..3 {
                assert!(((c.x[i] - a.x[i]) / (2.0 * h) - b.tangent[i]).abs() < 2e-9, "{s}: {spec:?}");
                let bend = (c.tangent[i] - a.tangent[i]) / (2.0 * h);
                // the third derivative jumps where pieces meet, so that differences are of first order there
                assert!((bend - b.curvature[i]).abs() < 2e-3, "{s}: {bend} {:?}", b.curvature);
            }
        }
    }
}

#[test]
fn a_layer_is_a_helix() {
    let p = PackageSpec::new(0.06, 0.02, 0.9e-3).build().unwrap();
    let c = 0.9e-3 / (2.0 * PI);
    let per_angle = 0.06_f64.hypot(c);
    for k in 0..50 {
        let angle = k as f64 * 2.7;
        let lay = p.at(angle * per_angle).unwrap();
        let exact = [0.06 * angle.cos(), 0.06 * angle.sin(), c * angle];
        assert!((0..3).all(|i| (lay.x[i] - exact[i]).abs() < 1e-14));
        let bend = dot(&lay.curvature, &lay.curvature).sqrt();
        assert!((bend - 0.06 / (per_angle * per_angle)).abs() < 1e-12);
    }
    let turns = 0.02 / 0.9e-3;
    assert!((p.wound() - turns * 2.0 * PI * per_angle).abs() < 1e-12);
}

#[test]
fn layers_grow_inside_and_shrink_outside() {
    for (side, sign) in [(Side::Inner, 1.0), (Side::Outer, -1.0)] {
        let p = PackageSpec { side, ..spec() }.build().unwrap();
        let ends = [p.at(0.0).unwrap(), p.at(p.wound()).unwrap()];
        let radii = ends.map(|l| p.cylindrical(&l.x));
        assert!((radii[0][0] - 0.06).abs() < 1e-15 && radii[0][1] == 0.0);
        // three layers: forth, back and forth
        assert!((radii[1][0] - (0.06 + sign * 1.8e-3)).abs() < 1e-15);
        assert!((radii[1][1] - 0.01).abs() < 1e-15, "{radii:?}");
        let layers = [0.0, 0.34, 0.65, 1.0].map(|s| p.layer(s * p.wound()));
        assert_eq!(layers, [0, 1, 1, 2]);
        // three helices without what the change of layer adds or saves
        let helices: f64 = (0..3).map(|k| (0.06 + sign * 0.9e-3 * k as f64) * 2.0 * PI * 0.01 / 0.9e-3).sum();
        assert!((p.wound() / helices - 1.0).abs() < 1e-5);
        let mut deepest = 0.0_f64;
        for k in 0..1000 {
            let s = p.wound() * k as f64 / 1000.0;
            let at = p.at(s).unwrap().x;
            let [_, z] = p.cylindrical(&at);
            assert!((-1e-15..=0.01 + 1e-15).contains(&z));
            deepest = deepest.max(p.depth(&at, &at));
            // a millimetre off the axis there is nothing to touch inside, and much to dive into outside
            let middle = [1e-3, 0.0, 0.5e-2];
            assert_eq!(p.depth(&middle, &at) > 0.0, side == Side::Outer);
        }
        assert_eq!(deepest, 0.0);
    }
}

#[test]
fn hands_mirror_each_other() {
    let right = spec().build().unwrap();
    let left = PackageSpec { hand: Hand::Left, ..spec() }.build().unwrap();
    for k in 0..100 {
        let s = right.wound() * k as f64 / 99.0;
        let (r, l) = (right.at(s).unwrap().x, left.at(s).unwrap().x);
        assert!((r[0] - l[0]).abs() < 1e-15 && (r[1] + l[1]).abs() < 1e-15 && r[2] == l[2]);
    }
    assert!(right.at(0.01).unwrap().x[1] > 0.0);
}

#[test]
fn an_empty_package_says_so() {
    let p = spec().build().unwrap();
    assert!(p.at(p.wound()).is_some());
    assert!(p.at(p.wound() + 1e-6).is_none());
    assert!(p.at(f64::NAN).is_none());
    // a lift-off point may swing back for a moment
    assert!(p.at(-1e-3).unwrap().x[2] < 0.0);
}

#[test]
fn what_cannot_be_wound_is_refused_by_field() {
    let cases: [(PackageSpec, &str, &str); 13] = [
        (PackageSpec { pitch: Some(0.8e-3), ..spec() }, "pitch", "below the diameter"),
        (PackageSpec { radius: 0.0, ..spec() }, "radius", "positive"),
        (PackageSpec { radius: f64::NAN, ..spec() }, "radius", "positive"),
        (PackageSpec { length: 0.0, ..spec() }, "length", "positive"),
        (PackageSpec { length: 0.5e-3, ..spec() }, "length", "less than one turn"),
        (PackageSpec { layers: 0, ..spec() }, "layers", "no cable"),
        (PackageSpec { layers: usize::MAX, ..spec() }, "layers", "at most 10000"),
        (PackageSpec { side: Side::Outer, layers: 70, ..spec() }, "layers", "fewer"),
        (PackageSpec { min_bend_radius: Some(0.07), ..spec() }, "radius", "may not be bent"),
        (PackageSpec { first: Some(0.011), ..spec() }, "first", "within the package"),
        (PackageSpec { first: Some(0.01), ..spec() }, "first", "turn `traverse` round"),
        (PackageSpec { axis: [0.0; 3], ..spec() }, "axis", "no length"),
        (PackageSpec { reference: Some([0.0, 0.0, 2.0]), ..spec() }, "reference", "across"),
    ];
    for (spec, field, says) in cases {
        let e = spec.build().unwrap_err();
        assert!(e.field.as_deref() == Some(field) && e.message.contains(says), "{field}: {e:?}");
    }
}

#[test]
fn a_spec_is_read_with_units() {
    let text = r#"{ "radius": "6 cm", "length": "20 cm", "diameter": "0.9 mm", "side": "outer", "hand": "left",
        "traverse": "backward", "layers": 4, "first": "15 cm", "min_bend_radius": "10 mm" }"#;
    let spec: PackageSpec = serde_json::from_str(text).unwrap();
    assert_eq!((spec.radius, spec.pitch(), spec.first(), spec.layers), (0.06, 0.9e-3, 0.15, 4));
    assert!(serde_json::from_str::<PackageSpec>(r#"{ "radius": 1, "lenght": 2, "diameter": 1 }"#).is_err());
    assert!(spec.build().is_ok());
}
