use super::{ALL, kind};
use crate as quantity;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

#[derive(Debug, Deserialize, Serialize)]
struct Sample {
    #[serde(default, deserialize_with = "quantity::speed")]
    speed: f64,
    #[serde(default, deserialize_with = "quantity::optional::length")]
    depth: Option<f64>,
    #[serde(default, deserialize_with = "quantity::vec3::length")]
    from: [f64; 3],
    #[serde(default, deserialize_with = "quantity::list::angle")]
    turns: Vec<f64>,
}

fn sample(json: &str) -> Result<Sample, String> {
    serde_json::from_str(json).map_err(|e| e.to_string())
}

#[test]
fn units_convert_without_rounding_twice() {
    for (kind, text, si) in [
        (&kind::SPEED, "25 kn", 25.0 * 1852.0 / 3600.0),
        (&kind::SPEED, "36 km/h", 10.0),
        (&kind::SPEED, "36km/h", 10.0),
        (&kind::SPEED, "36 kmh", 10.0),
        (&kind::SPEED, "36 kph", 10.0),
        (&kind::SPEED, "25 knots", 25.0 * 1852.0 / 3600.0),
        (&kind::SPEED, "25 kts", 25.0 * 1852.0 / 3600.0),
        (&kind::SPEED, "10 ft/s", 10.0 * 0.3048),
        (&kind::LENGTH, "10 ft", 10.0 * 0.3048),
        (&kind::LENGTH, "10 feet", 10.0 * 0.3048),
        (&kind::LENGTH, "2 in", 2.0 * 0.0254),
        (&kind::MASS_PER_LENGTH, "1 lb/ft", 0.453_592_37 / 0.3048),
        (&kind::FORCE, "1000 lbf", 1000.0 * 4.448_221_615_260_5),
        (&kind::TIME, "90 seconds", 90.0),
        (&kind::AXIAL_STIFFNESS, "1.2 MN", 1.2e6),
        (&kind::LENGTH, "30 m", 30.0),
        (&kind::LENGTH, "9 mm", 0.009),
        (&kind::LENGTH, " -1.5e2 cm ", -1.5),
        (&kind::LENGTH, "2 nmi", 3704.0),
        (&kind::LENGTH, "3 µm", 3e-6),
        (&kind::LENGTH, "3 μm", 3e-6),
        (&kind::LENGTH, ".5 m", 0.5),
        (&kind::BENDING_STIFFNESS, "2 N m^2", 2.0),
        (&kind::BENDING_STIFFNESS, "2 N*m^2", 2.0),
        (&kind::BENDING_STIFFNESS, "2 kN·m²", 2000.0),
        (&kind::BENDING_STIFFNESS, "2 N m2", 2.0),
        (&kind::BENDING_STIFFNESS, "2 N m**2", 2.0),
        (&kind::MASS_PER_LENGTH, "0.5 kg/m", 0.5),
        (&kind::MASS_PER_LENGTH, "500 g/m", 0.5),
        (&kind::VISCOSITY, "5e-3 Pa s", 5e-3),
        (&kind::VISCOSITY, "1 kg/(m s)", 1.0),
        (&kind::VISCOSITY, "1 kg m^-1 s-1", 1.0),
        (&kind::VISCOSITY, "1 kg m⁻¹ s⁻¹", 1.0),
        (&kind::MASS, "1.5 t", 1500.0),
        (&kind::TIME, "2 min", 120.0),
        (&kind::TIME, "1.5 h", 5400.0),
        (&kind::TIME, "20 ms", 0.02),
        (&kind::ANGLE, "180 deg", PI),
        (&kind::ANGLE, "180°", PI),
        (&kind::ANGULAR_VELOCITY, "180 deg/s", PI),
        (&kind::ANGULAR_VELOCITY, "2 rad/s", 2.0),
        (&kind::FREQUENCY, "2 kHz", 2000.0),
        (&kind::FREQUENCY, "2 1/s", 2.0),
        (&kind::FREQUENCY, "2 /s", 2.0),
        (&kind::ACCELERATION, "9.81 m/s/s", 9.81),
        (&kind::ACCELERATION, "9.81 m/s²", 9.81),
        (&kind::PRESSURE, "210 GPa", 210e9),
        (&kind::PRESSURE, "1 hPa", 100.0),
        (&kind::AREA, "5 cm^2", 5e-4),
        (&kind::DENSITY, "1025 kg/m^3", 1025.0),
        (&kind::DAMPING, "200 N s/m", 200.0),
        (&kind::ROTATIONAL_STIFFNESS, "40 N m/rad", 40.0),
        (&kind::ROTATIONAL_STIFFNESS, "40 N m", 40.0),
        (&kind::NUMBER, "0.5", 0.5),
        (&kind::NUMBER, "5 %", 0.05),
    ] {
        assert_eq!(kind.parse(text), Ok(si), "{text}");
    }
    let turning = kind::ANGULAR_VELOCITY.parse("60 rpm").unwrap();
    assert!((turning - TAU).abs() < 1e-14);
}

#[test]
fn every_example_and_every_si_unit_reads_as_its_kind() {
    for kind in ALL {
        assert!(kind.parse(kind.example).is_ok(), "{:?}", kind.parse(kind.example));
        assert_eq!(kind.parse(&format!("3 {}", kind.unit)), Ok(3.0), "{kind}");
    }
}

#[test]
fn wrong_quantities_say_what_they_are_and_what_was_expected() {
    for (kind, text, message) in [
        (&kind::SPEED, "25 kg", r#""25 kg" is a mass, expected a speed like "25 kn" or a number in m/s"#),
        (
            &kind::FORCE,
            "25 kn",
            r#""25 kn" is a speed (`kn` is the knot, `kN` the kilonewton), expected a force"#,
        ),
        (&kind::SPEED, "25", r#""25" has no unit, expected a speed"#),
        (&kind::SPEED, "", r#""" does not begin with a number"#),
        (&kind::SPEED, "fast", "does not begin with a number"),
        (&kind::SPEED, "nan m/s", "does not begin with a number"),
        (&kind::SPEED, "-inf m/s", "does not begin with a number"),
        (&kind::SPEED, "1e999 m/s", "inf is not a finite number"),
        (&kind::LENGTH, "1e300 km km/m Tm/Tm km^9/m^9", "ambiguous"),
        (&kind::LENGTH, "1e300 Tm", "inf is not a finite number"),
        (&kind::LENGTH, "2,5 m", "has a comma: write a decimal point"),
        (&kind::LENGTH, "1 000 m", "has a second number, `000`"),
        (&kind::LENGTH, "3 nm", "write `nmi` for nautical miles"),
        (&kind::MOMENT, "3 Nm", "has the unknown unit `Nm` (did you mean `N m`?), expected a moment"),
        (&kind::MOMENT, "3 kNm", "did you mean `kN m`?"),
        (&kind::SPEED, "3 Kts", "did you mean `kn`?"),
        (&kind::MASS, "3 ton", "did you mean `t`?"),
        (&kind::MASS, "3 Kg", "did you mean `kg`?"),
        (&kind::FORCE, "3 KN", "did you mean `kn` or `kN`?"),
        (&kind::FORCE, "3 foo", "has the unknown unit `foo`, expected a force"),
        (&kind::VISCOSITY, "1 kg/m s", "ambiguous"),
        (&kind::VISCOSITY, "1 kg/(m s", "not closed"),
        (&kind::VISCOSITY, "1 kg/", "unfinished"),
        (&kind::AREA, "1 m^2.5", "whole number"),
        (&kind::AREA, "1 m^", "whole number"),
        (&kind::AREA, "1 m^0", "whole number"),
        (&kind::AREA, "1 m^99999999999999", "whole number"),
        (&kind::ANGULAR_VELOCITY, "3 Hz", "is a frequency, expected an angular velocity"),
        (&kind::FREQUENCY, "3 rpm", "is an angular velocity, expected a frequency"),
        (&kind::NUMBER, "3 deg", "is an angle, expected a plain number like 0.5"),
        (&kind::SPEED, "3 %", "has no dimension"),
        (&kind::SPEED, "3 kg m^4", r#""3 kg m^4" is in kg m^4, expected a speed"#),
    ] {
        let error = kind.parse(text).expect_err(text);
        assert!(error.contains(message), "{text}: {error}");
    }
}

#[test]
fn fields_take_numbers_strings_lists_and_nothing() {
    let s = sample(r#"{"speed": 3, "depth": "20 cm", "from": [0, "1 km", -2.5], "turns": ["180 deg", 0]}"#)
        .unwrap();
    assert_eq!((s.speed, s.depth, s.from), (3.0, Some(0.2), [0.0, 1000.0, -2.5]));
    assert_eq!(s.turns, [PI, 0.0]);
    assert_eq!(sample(r#"{"depth": null}"#).unwrap().depth, None);
    assert_eq!(serde_json::to_string(&s.speed).unwrap(), "3.0");
}

#[test]
fn wrong_types_and_lengths_are_refused() {
    for (json, message) in [
        (r#"{"speed": true}"#, r#"boolean `true`, expected a speed like "25 kn" or a number in m/s"#),
        (r#"{"speed": null}"#, "expected a speed"),
        (r#"{"depth": "2 kg"}"#, "is a mass, expected a length"),
        (r#"{"from": [1, 2]}"#, "invalid length 2, expected three entries, each a length"),
        (r#"{"from": [1, 2, 3, 4]}"#, "invalid length 4, expected three entries"),
        (r#"{"from": [1, "2 s", 3]}"#, "is a time, expected a length"),
        (r#"{"from": 1.0}"#, "expected three entries"),
        (r#"{"turns": "1 rad"}"#, "expected a list"),
    ] {
        let error = sample(json).expect_err(json);
        assert!(error.contains(message), "{json}: {error}");
    }
    let not_finite = serde::de::value::F64Deserializer::<serde::de::value::Error>::new(f64::NAN);
    assert!(quantity::speed(not_finite).unwrap_err().to_string().starts_with("NaN is not a finite number"));
}

#[test]
fn no_text_makes_the_reader_panic() {
    use proptest::prelude::*;
    use proptest::test_runner::{Config, TestRunner};
    let pieces = prop::sample::select(vec![
        "1", "-", "+", ".", "e", "5e-3", " ", "m", "kN", "kn", "/", "*", "^", "2", "²", "⁻", "(", ")", "·",
        "µ", "°", "%", "é", "🚢", "nan", "min", "^9", "km^9",
    ]);
    let text = prop::collection::vec(pieces, 0..40).prop_map(|p| p.concat());
    TestRunner::new(Config { cases: 5_000, failure_persistence: None, ..Config::default() })
        .run(&text, |text| {
            for kind in ALL {
                if let Ok(x) = kind.parse(&text) {
                    prop_assert!(x.is_finite());
                }
            }
            Ok(())
        })
        .unwrap();
    // any finite number survives being written with its SI unit
    TestRunner::new(Config { cases: 2_000, failure_persistence: None, ..Config::default() })
        .run(&any::<f64>(), |x| {
            prop_assert_eq!(
                kind::DAMPING.parse(&format!("{x:?} N s/m")).ok(),
                Some(x).filter(|x| x.is_finite())
            );
            Ok(())
        })
        .unwrap();
}
