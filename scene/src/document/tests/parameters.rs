use super::*;
use crate::document::{Kind, Value};

fn parse(text: &str, overrides: &[&str]) -> Result<Document, Fault> {
    let overrides: Vec<String> = overrides.iter().map(|s| (*s).to_string()).collect();
    Document::parse(text, "s.toml", Format::Toml, &overrides)
}

fn value(text: &str, overrides: &[&str]) -> Kind {
    parse(text, overrides).unwrap().get("x").unwrap().kind.clone()
}

#[test]
fn a_parameter_may_be_anything_and_stand_anywhere() {
    let text = |s: &str| Kind::String(s.to_string());
    assert_eq!(value("parameters.a = 3\nx = '$a'", &[]), Kind::Integer(3));
    assert_eq!(value("parameters.a = { default = 3.5, description = 'd' }\nx = '$a'", &[]), Kind::Float(3.5));
    assert_eq!(
        value("parameters.a = '$b'\nparameters.b = '$c-d'\nparameters.c-d = true\nx = '$a'", &[]),
        Kind::Bool(true)
    );
    assert_eq!(value("x = '$$a'", &[]), text("$a"));
    assert_eq!(value("x = '$$'", &[]), text("$"));
    assert_eq!(value("x = 'a $b $$c'", &[]), text("a $b $$c"));
    let document =
        parse("parameters.a.default = { y = [1, '$b'] }\nparameters.b = '$$b'\nx = ['$a']", &[]).unwrap();
    assert_eq!(document.to_toml(), "[[x]]\ny = [1, \"$$b\"]\n");
}

#[test]
fn set_values_are_toml_or_else_text() {
    for (written, kind) in [
        ("3", Kind::Integer(3)),
        (" 3.5 ", Kind::Float(3.5)),
        ("true", Kind::Bool(true)),
        ("30 kn", Kind::String("30 kn".into())),
        ("\"30 kn\"", Kind::String("30 kn".into())),
        ("$b", Kind::Integer(1)),
        ("$$b", Kind::String("$b".into())),
        ("a=b", Kind::String("a=b".into())),
        ("1979-05-27", Kind::String("1979-05-27".into())),
        ("\"\"", Kind::String(String::new())),
        ("[1", Kind::String("[1".into())),
    ] {
        let set = format!("a={written}");
        assert_eq!(value("parameters = { a = 0, b = 1 }\nx = '$a'", &[&set]), kind, "{written}");
    }
    assert!(
        matches!(value("parameters.a = 0\nx = '$a'", &["a = [1, \"2 m\"]"]), Kind::Array(l) if l.len() == 2)
    );
    assert_eq!(value("parameters.a = 0\nx = '$a'", &["a=1", "a=2"]), Kind::Integer(2));
    assert_eq!(value("parameters.a.description = 'no default'\nx = '$a'", &["a=1"]), Kind::Integer(1));
}

#[test]
fn faults_of_set_values_point_at_the_command_line() {
    let mut document =
        Document::parse(GOOD, "scene.toml", Format::Toml, &["depth = [1, true]".into()]).unwrap();
    assert_eq!(
        scene(&mut document).unwrap_err().to_string(),
        "\
expected a length like \"30 m\" or a number in m, found a list
 --> --set:1:9 (elements[1].from[1])
  |
1 | depth = [1, true]
  |         ^^^^^^^^^
  = note: used as \"$depth\" at scene.toml:5:16"
    );
}

#[test]
fn parameters_are_listed_with_values_and_use() {
    let document = parse(
        "x = '$a'\n[parameters]\na = '$b'\nb = 1\nc = '$d'\nd.default = 2\nd.description = 'D'\n",
        &["b=5"],
    )
    .unwrap();
    let listed: Vec<_> =
        document.parameters().iter().map(|p| (p.name.as_str(), &p.value.kind, p.set, p.used)).collect();
    let (five, two) = (&Kind::Integer(5), &Kind::Integer(2));
    assert_eq!(
        listed,
        [
            ("a", five, false, true),
            ("b", five, true, true),
            ("c", two, false, false),
            ("d", two, false, false)
        ]
    );
    assert_eq!(document.parameters()[3].description.as_deref(), Some("D"));
    assert_eq!(document.unused_parameters(), ["c", "d"]);
}

#[test]
fn parameters_of_what_was_not_chosen_are_used_unless_they_were_set() {
    let scene =
        "x = { choose = '$a', 1 = '$b', 2 = ['$c'] }\n[parameters]\na = 1\nb = 0\nc = '$d'\nd = 3\ne = 4\n";
    assert_eq!(parse(scene, &[]).unwrap().unused_parameters(), ["e"]);
    assert_eq!(parse(scene, &["d=5"]).unwrap().unused_parameters(), ["d", "e"]);
    assert_eq!(parse(scene, &["d=5", "a=2"]).unwrap().unused_parameters(), ["e"]);
}

#[test]
fn formulas_calculate_with_parameters() {
    let parameters =
        "parameters = { load = '20 kN', length = '30 m', n = 12, wet-mass = '2 kg', half = '$length / 2' }\n";
    let float = Kind::Float;
    let text = |t: &str| Kind::String(t.into());
    for (formula, expected) in [
        ("-$load", text("-20000.0 N")),
        ("2 * $length / 3", text("20.0 m")),
        ("$length-1 m", text("29.0 m")),
        ("$wet-mass * 9.81 m/s^2", text("19.62 N")),
        ("$half + 1 cm", text("15.01 m")),
        ("$length / $half", Kind::Integer(2)),
        ("$n / 5", float(2.4)),
        ("$n * 2", Kind::Integer(24)),
        ("sqrt($length^2)", text("30.0 m")),
        // other names stay, for whoever knows them
        ("$load - 2 * {rope@50 %.tension}", text("(20000.0 N) - 2 * {rope@50 %.tension}")),
        ("max(rope.x, $length)", text("max(rope.x, (30.0 m))")),
        // no formulas
        ("of $length", text("of $length")),
        ("5 $ and more", text("5 $ and more")),
        ("$$length / 2", text("$length / 2")),
    ] {
        let document =
            parse(&format!("x = \"{formula}\"\n{parameters}"), &[]).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(document.get("x").unwrap().kind, expected, "{formula}");
    }
    // a scene that is written with its parameters replaced reads again to the same
    let document =
        parse(&format!("x = ['-$load', '2 * $length / 3']\n{parameters}"), &["length=90 m"]).unwrap();
    let again = parse(&document.to_toml(), &[]).unwrap();
    let kinds = |d: &Document| match &d.get("x").unwrap().kind {
        Kind::Array(list) => list.iter().map(|v| v.kind.clone()).collect::<Vec<_>>(),
        _ => Vec::new(),
    };
    assert_eq!(kinds(&again), [text("-20000.0 N"), text("60.0 m")]);
    assert_eq!(kinds(&document), kinds(&again));
    assert_eq!(document.unused_parameters(), ["n", "wet-mass", "half"]);
}

#[test]
fn wrong_parameters_are_refused() {
    for (text, set, message, help) in [
        ("x = '$a'", "", "unknown parameter `a`, the scene has none", "declare it in `[parameters]`"),
        (
            "x = '$sped'\nparameters.speed = 1",
            "",
            "unknown parameter `sped`, expected `speed`",
            "did you mean `speed`?",
        ),
        ("x = '$'", "", "`$` is no name of a parameter", "`$$`"),
        (
            "x = '$speed/2'",
            "",
            "unknown parameter `speed`, the scene has none",
            "declare it in `[parameters]`",
        ),
        ("x = '$speed knots'", "", "`$speed knots` is no name of a parameter", "`2 * $name`"),
        (
            "x = '2 * $lenght'\nparameters.length = 1",
            "",
            "unknown parameter `lenght`, expected `length`",
            "did you mean `length`?",
        ),
        (
            "x = '-$a'\nparameters.a = [1, 2]",
            "",
            "the parameter `a` is a list, and no number to calculate with",
            "",
        ),
        ("x = '1 + $a'\nparameters.a = '3 m'", "", "in `1 + $a`: a plain number and `m` can't be added", ""),
        ("x = '1 / $a'\nparameters.a = 0", "", "`1 / $a` is inf, which is no finite number", ""),
        (
            "parameters = { a = '$b', b = '$c', c = '$b' }",
            "",
            "parameter `b` refers to itself: b -> c -> b",
            "",
        ),
        ("parameters.a = ['$a']\nx = '$a'", "", "parameter `a` refers to itself: a -> a", ""),
        ("parameters.a.description = 'A'", "", "parameter `a` has no value", "`--set a=...`"),
        (
            "parameters.a = { defualt = 1 }",
            "",
            "unknown field `defualt`, expected `default` or `description`",
            "`default`?",
        ),
        ("parameters.a = { ea = 1 }", "", "unknown field `ea`", "stands in `default = { ... }`"),
        ("parameters.a = { default = 1, description = 2 }", "", "a description is a text in quotes", ""),
        ("parameters.'a b' = 1", "", "`a b` is no name for a parameter", "letters"),
        ("parameters.1a = 1", "", "`1a` is no name for a parameter", "letters"),
        ("parameters = 3", "", "`parameters` has to be a table", ""),
        (
            "parameters.speed = 1",
            "sped=1",
            "unknown parameter `sped`, expected `speed`",
            "did you mean `speed`?",
        ),
        ("x = 1", "speed=1", "unknown parameter `speed`, the scene has none", ""),
        ("parameters.a = 1", "a", "expected `name=value`", ""),
        ("parameters.a = 1", "a= ", "expected `name=value`", ""),
        ("parameters.a = 1", "", "", ""),
        ("parameters.a = 1", "a=nan", "nan is not a finite number", ""),
        ("parameters.a = 1", "a=$b", "unknown parameter `b`, expected `a`", ""),
    ] {
        let overrides: Vec<&str> = Some(set).filter(|s| !s.is_empty()).into_iter().collect();
        match parse(text, &overrides) {
            Ok(_) => assert!(message.is_empty(), "{text} {set}"),
            Err(fault) => {
                assert!(!message.is_empty() && fault.message.starts_with(message), "{fault}");
                assert!(fault.help.clone().unwrap_or_default().contains(help), "{fault}");
                assert!(fault.place.is_some(), "{fault}");
            }
        }
    }
    assert_eq!(parse("[a]\nl = [{ x = '$q' }]", &[]).unwrap_err().path, "a.l[0].x");
}

#[test]
fn parameters_that_multiply_or_nest_without_end_are_stopped() {
    let doubling: String = (0..60).map(|i| format!("p{i} = [\"$p{}\", \"$p{}\"]\n", i + 1, i + 1)).collect();
    let fault = parse(&format!("x = '$p0'\n[parameters]\n{doubling}p60 = 1\n"), &[]).unwrap_err();
    assert!(fault.message.contains("grow beyond all measure"), "{fault}");
    let chain: String = (0..50_000).map(|i| format!("p{i} = \"$p{}\"\n", i + 1)).collect();
    let fault = parse(&format!("x = '$p0'\n[parameters]\n{chain}p50000 = 1\n"), &[]).unwrap_err();
    assert!(fault.message.contains("too deeply"), "{fault}");
    let large = Value {
        kind: Kind::String("x".repeat(1 << 20)),
        ..parse("x = 1", &[]).unwrap().get("x").unwrap().clone()
    };
    let uses = "'$a',".repeat(1000);
    let fault =
        parse(&format!("parameters.a = '{}'\nx = [{uses}]", large.as_str().unwrap()), &[]).unwrap_err();
    assert!(fault.message.contains("grow beyond all measure"), "{fault}");
}

#[test]
fn a_value_is_chosen_by_another() {
    let text = |s: &str| Kind::String(s.to_string());
    let scene = "parameters.v = '25 kn'\nx = { choose = '$v', '25 kn' = '$a', '15kn' = 'b', otherwise = 'c' }\n\
                 parameters.a = 'fast'";
    assert_eq!(value(scene, &[]), text("fast"));
    assert_eq!(value(scene, &["v=25kn"]), text("fast"));
    assert_eq!(value(scene, &["v=15 kn"]), text("b"));
    assert_eq!(value(scene, &["v=46.3 km/h"]), text("fast"));
    // a number without unit is in SI, and 25 m are no speed
    assert_eq!(value(&scene.replace("25 kn", "7 m/s"), &["v=7"]), text("fast"));
    assert_eq!(value(&scene.replace("25 kn", "7 m/s"), &["v=7.0 m"]), text("c"));
    assert_eq!(value(scene, &["v=3"]), text("c"));
    // parameters choose too, by numbers as well
    let scene = "parameters.n = 3\nparameters.m.default = { choose = '$n', 3 = 1, 4 = 2 }\nx = '$m'";
    assert_eq!(value(scene, &[]), Kind::Integer(1));
    assert_eq!(value(scene, &["n=4"]), Kind::Integer(2));
    let fault = parse(scene, &["n=5"]).unwrap_err();
    assert!(fault.message.contains("nothing to choose for `5`, expected"), "{fault}");
    assert_eq!(fault.help.as_deref(), Some("add it, or `otherwise` for all that isn't named"));
    let fault = parse("x = { choose = [1], a = 2 }", &[]).unwrap_err();
    assert!(fault.message.contains("takes a text or a number"), "{fault}");
}
