use super::*;

fn value(text: &str) -> f64 {
    let e = Expression::parse(text, &|name| !name.contains('-'))
        .unwrap_or_else(|e| panic!("{text}: {}", e.message));
    e.value(&vec![2.0; e.names().len()])
}

fn unit(text: &str) -> Result<String, String> {
    let e = Expression::parse(text, &|_| true).map_err(|e| e.message)?;
    e.dimension(&vec![Dimension::of("m").unwrap(); e.names().len()]).map(|d| d.unit()).map_err(|e| e.message)
}

#[test]
fn formulas_are_read_as_on_paper() {
    for (text, expected) in [
        ("1 + 2 * 3", 7.0),
        ("(1 + 2) * 3", 9.0),
        ("-2^2", -4.0),
        ("2^3^2", 512.0),
        ("2^-1", 0.5),
        ("8 / 2 / 2", 2.0),
        ("1 - 2 - 3", -4.0),
        ("--3", 3.0),
        ("-$load", -2.0),
        ("2 * $length / 3", 4.0 / 3.0),
        ("$a-1", 1.0),
        ("3 kN - 2 N", 2998.0),
        ("3 kN -2 N", 2998.0),
        ("1.5e2 cm", 1.5),
        ("36 km/h * 2 s", 20.0),
        ("10 m / 4 s", 2.5),
        ("2 N m^2", 2.0),
        ("50 %", 0.5),
        ("0.4 N/(m s) * 2 + 1", 1.8),
        ("(1 + 2 m) * 3", 9.0),
        ("2 * (3 s)", 6.0),
        ("{rope@50 %.tension} + rope.end.x", 4.0),
        ("max(1, min(5, 3)) + clamp(7, 0, 2)", 5.0),
        ("sin(90 deg) + cos(0) + sqrt(16 m^2) / 1 m", 6.0),
        ("atan2(1 m, 1 m) * 4 - pi", 0.0),
    ] {
        assert!((value(text) - expected).abs() <= 1e-12 * expected.abs(), "{text}: {}", value(text));
    }
    assert!(value("sqrt(-1)").is_nan() && value("max(1, 0/0)").is_nan() && value("min(0/0, 1)").is_nan());
}

#[test]
fn names_behind_a_dollar_are_the_longest_that_are_known() {
    let known = |name: &str| ["wet-mass", "a"].contains(&name);
    let names = |text: &str| Expression::parse(text, &known).unwrap().names().to_vec();
    assert_eq!(names("$wet-mass - $a-1"), ["$wet-mass", "$a"]);
    assert_eq!(names("$b-c"), ["$b", "c"]);
}

#[test]
fn units_are_checked() {
    for (text, expected) in [
        ("$a * 3 N", "N m"),
        ("$a^2", "m^2"),
        ("sqrt($a^2 + 1 cm^2)", "m"),
        ("$a / 2 s", "m/s"),
        ("$a^3 / (1 s)^3", "m^3 s^-3"),
        ("1 / (2 s)", "Hz"),
        ("2 N/(m s) * $a", "kg m s^-3"),
        ("$a / 1 m", ""),
    ] {
        assert_eq!(unit(text).as_deref(), Ok(expected), "{text}");
    }
    for text in ["$a + 1", "$a + 1 s", "sin($a)", "2^$a", "$a^0.5", "sqrt($a)", "max($a, 1)", "exp(1 m)"] {
        assert!(unit(text).is_err(), "{text}");
    }
}

#[test]
fn what_is_no_formula_is_refused_and_nothing_panics() {
    let deep = "(".repeat(1000) + "1";
    let minus = "-".repeat(1000) + "1";
    let long = "1+".repeat(2000) + "1";
    for text in [
        "",
        " ",
        "1 +",
        "* 2",
        "(1",
        "1)",
        "2 3",
        "foo(1)",
        "max(1)",
        "sin(1, 2)",
        "$",
        "$ a",
        "{a",
        "1 parsec",
        "3 N m.x",
        "1 é",
        "a b",
        "1..2",
        "1e999",
        ".",
        "a(",
        "max(1,",
        "${a}",
        "2 m/s/s x",
        &deep,
        &minus,
        &long,
    ] {
        assert!(Expression::parse(text, &|_| true).is_err(), "{text:.40}");
    }
}
