use super::*;

#[test]
fn a_message_shows_place_path_and_guess() {
    assert_eq!(
        spoilt("ei = 0.01", "eI = 0.01").to_string(),
        "\
unknown field `eI`, expected one of `ea`, `ei`, `shape`
  --> scene.toml:18:1 (elements[0].section)
   |
18 | eI = 0.01
   | ^^
   = help: did you mean `ei`?"
    );
    assert_eq!(
        spoilt("\"2 t\"", "\"2 m\"").to_string(),
        "\
\"2 m\" is a length, expected a mass like \"1.5 t\" or a number in kg
  --> scene.toml:31:8 (elements[2].mass)
   |
31 | mass = \"2 m\"
   |        ^^^^^"
    );
    assert_eq!(
        spoilt("depth = \"30 m\"", "depth = \"30 s\"").to_string(),
        "\
\"30 s\" is a time, expected a length like \"30 m\" or a number in m
 --> scene.toml:6:9 (elements[1].from[1])
  |
6 | depth = \"30 s\"
  |         ^^^^^^
  = note: used as \"$depth\" at scene.toml:5:16"
    );
}

#[test]
fn every_fault_has_its_own_message_and_path() {
    for (good, bad, message, path, help) in [
        (
            "\"cable\"",
            "\"cabel\"",
            "unknown type `cabel`, expected one of `cable`, `gravity`, `weight`",
            "elements[0].type",
            "`cable`?",
        ),
        (
            "type = \"cable\"\n",
            "",
            "missing `type`, expected one of `cable`, `gravity`, `weight`",
            "elements[0]",
            "`type = \"cable\"`",
        ),
        (
            "type = \"cable\"",
            "type = 3",
            "expected the name of a type, found a number",
            "elements[0].type",
            "",
        ),
        ("type = \"cable\"", "typ = \"cable\"", "missing `type`, expected", "elements[0]", ""),
        ("name = \"line\"\n", "", "missing `name`", "elements[0]", ""),
        ("name = \"line\"", "name = 3", "expected a text in quotes, found 3", "elements[0].name", ""),
        ("ea = \"1.2 MN\"\n", "", "missing `ea`", "elements[0].section", ""),
        ("\"1.2 MN\"", "[1]", "expected an axial stiffness like", "elements[0].section.ea", ""),
        ("\"1.2 MN\"", "\"stiff\"", "\"stiff\" does not begin with a number", "elements[0].section.ea", ""),
        ("\"20 cm\", 0]", "\"20 cm\"]", "expected three entries, each a length", "elements[0].from", ""),
        (
            "\"20 cm\", 0]",
            "\"20 cm\", 0, 0]",
            "expected three entries, each a length",
            "elements[0].from",
            "",
        ),
        ("\"20 cm\", 0]", "true, 0]", "expected a length like", "elements[0].from[1]", ""),
        (
            "elements = 20",
            "elements = -2",
            "expected a whole number, 0 or larger, found -2",
            "elements[1].elements",
            "",
        ),
        (
            "\"sine\"",
            "\"sin\"",
            "unknown type `sin`, expected `ramp` or `sine`",
            "elements[1].motion.type",
            "`sine`?",
        ),
        (
            "type = \"sine\", ",
            "",
            "missing `type`, expected `ramp` or `sine`",
            "elements[1].motion",
            "`type = \"ramp\"`",
        ),
        (
            "amplitude",
            "amplitud",
            "unknown field `amplitud`, expected `amplitude`",
            "elements[1].motion",
            "`amplitude`?",
        ),
        (
            "{ type = \"sine\", amplitude = \"$depth\" }",
            "\"sine\"",
            "expected a table with a `type`",
            "elements[1].motion",
            "",
        ),
        (
            "type = \"sine\", amplitude = \"$depth\"",
            "type = \"ramp\", times = [1, \"2 s\", \"3 m\"]",
            "\"3 m\" is a length, expected a time",
            "elements[1].motion.times[2]",
            "",
        ),
        (
            "\"tube\", bore",
            "\"tube\", bor",
            "unknown field `bor`, expected `bore`",
            "elements[1].section.shape",
            "`bore`?",
        ),
        (
            "\"b c\" = 2.5",
            "\"b c\" = \"x\"",
            "expected a number, found \"x\"",
            "elements[1].tags.\"b c\"",
            "",
        ),
        ("mass = \"2 t\"", "mass = -1", "a mass has to be positive", "elements[2].mass", ""),
        ("mass = \"2 t\"", "mass = nan", "nan is not a finite number", "", ""),
        ("mass = \"2 t\"", "mass = -inf", "-inf is not a finite number", "", ""),
        ("mass = \"2 t\"", "mass = 1e999", "1e999 is not a finite number", "", ""),
        ("mass = \"2 t\"", "mass = 99999999999999999999", "a whole number too large", "", ""),
        ("mass = \"2 t\"", "mass = 1979-05-27", "a date or time of day has no meaning", "", ""),
        ("mass = \"2 t\"", "mass = 2 t", "", "", "stands in quotes: \"2 t\""),
        ("mass = \"2 t\"", "mass = 2e3 kg # heavy", "", "", "stands in quotes: \"2e3 kg\""),
        ("mass = \"2 t\"", "mass = 1\nmass = 2", "duplicate key `", "", ""),
        ("mass = \"2 t\"", "mass = \"2 t", "", "", ""),
        ("[solver]", "[solver]\nstep = 1\n[solver]", "duplicate key `", "", ""),
        (
            "[solver]",
            "[solve]",
            "unknown field `solve`, expected one of `elements`, `solver`, `title`, `parameters`",
            "",
            "`solver`?",
        ),
        ("[solver]", "[[solver]]", "expected a table, found a list", "solver", ""),
        ("[solver]", "solver = 3\n[other]", "unknown field `other`", "", ""),
        ("title = \"tow\"", "title = {}", "expected a text in quotes, found a table", "title", ""),
    ] {
        let fault = spoilt(good, bad);
        assert!(fault.message.starts_with(message) && !fault.message.is_empty(), "{bad}: {fault}");
        assert_eq!(fault.path, path, "{bad}: {fault}");
        assert!(fault.place.as_ref().is_some_and(|p| p.line > 0 && p.file == "scene.toml"), "{bad}: {fault}");
        assert!(fault.help.clone().unwrap_or_default().contains(help), "{bad}: {fault}");
    }
}

#[test]
fn syntax_faults_are_said_in_words() {
    for (text, message, help) in [
        ("a = 1\na = 2", "duplicate key `a`", ""),
        ("a.b = 1\n[a]", "duplicate key `a`", ""),
        ("a = ", "missing value after `=`", ""),
        ("a = wide", "a text has to stand in quotes", ""),
        ("a = 1 2", "a text has to stand in quotes", ""),
        (
            "a = -3.5 kN/m # stiff",
            "a text has to stand in quotes",
            "a quantity with a unit stands in quotes: \"-3.5 kN/m\"",
        ),
        ("a = 1_", "`_` may only go between digits", ""),
        ("a", "key with no value, expected `=`", ""),
        ("[a", "unclosed table, expected `]`", ""),
        ("a = [1,", "unclosed array, expected `]`", ""),
    ] {
        let fault = toml(text).expect_err(text);
        assert_eq!(
            (fault.message.as_str(), fault.help.as_deref().unwrap_or_default()),
            (message, help),
            "{text}"
        );
    }
}

#[test]
fn a_fault_marks_what_it_is_about() {
    for (good, bad, marked) in [
        ("\"cable\"", "\"cabel\"", "\"cabel\""),
        ("name = \"line\"\n", "", "[[elements]]"),
        ("ea = \"1.2 MN\"\n", "", "[elements.section]"),
        ("\"20 cm\", 0]", "true, 0]", "true"),
        ("\"20 cm\", 0]", "\"20 cm\"]", "[0.0, \"20 cm\"]"),
        ("amplitude", "amplitud", "amplitud"),
        ("mass = \"2 t\"", "mass = 1\nmass = 2", "mass"),
        ("[solver]", "[solve]", "solve"),
    ] {
        let fault = spoilt(good, bad);
        let place = fault.place.as_ref().expect("a place");
        assert_eq!(&GOOD.replacen(good, bad, 1)[place.span.range()], marked, "{fault}");
    }
}

#[test]
fn lists_have_to_be_lists() {
    let fault = toml("[elements]\ntype = \"cable\"\n").unwrap_err();
    assert_eq!(fault.message, "`elements` is a list, found a table");
    assert_eq!(fault.help.as_deref(), Some("write `[[elements]]`"));
    let fault = toml("elements = [3]").unwrap_err();
    assert_eq!(fault.message, "expected a table with a `type`, found 3");
    assert_eq!(fault.path, "elements[0]");
}

#[test]
fn json_faults_have_places_too() {
    for (text, message, line, column) in [
        ("{\n \"solver\": {\"step\": \"1 m\"}}", "\"1 m\" is a length, expected a time", 2, 21),
        ("{\n \"a\": 1,\n \"a\": 2}", "duplicate key `a`", 3, 2),
        ("{\n \"a\": 1 \"b\": 2}", "expected `,` or `}`", 2, 9),
        ("{\n \"a\": [1 2]}", "expected `,` or `]`", 2, 10),
        ("{\n \"a\": [1,]}", "expected value", 2, 10),
        ("{\n \"a\": 01}", "invalid number", 2, 8),
        ("{\n \"a\": NaN}", "expected value", 2, 7),
        ("{\n \"a\": 1e999}", "`1e999` is not a finite number", 2, 7),
        ("{\n \"a\": \"\\ud800\"}", "", 2, 8),
        ("{\n \"a\": [null]}", "`null` has no meaning in a list", 2, 8),
        ("{\n \"a\": 1", "EOF while parsing an object", 2, 7),
        ("{\n // no\n \"a\": 1}", "key must be a string", 2, 2),
        ("[1]", "a scene is a JSON object", 1, 1),
        ("{\"a\": 1} x", "trailing characters", 1, 10),
        (
            "{\n \"elements\": [{\"type\": \"weight\", \"mas\": 1}]}",
            "unknown field `mas`, expected `mass`",
            2,
            34,
        ),
    ] {
        let fault = json(text).expect_err(text);
        let place = fault.place.as_ref().expect("a place");
        assert!(fault.message.starts_with(message), "{fault}");
        assert_eq!((place.line, place.column), (line, column), "{fault}");
    }
}

#[test]
fn missing_tables_are_said_or_found_misspelt() {
    let mut document = Document::parse("[solvr]\nstep = 1\n[water]\n", "s.toml", Format::Toml, &[]).unwrap();
    let fault = document.require::<Solver>("solver").unwrap_err();
    assert_eq!(fault.message, "missing `solver` in `s.toml`");
    assert_eq!((fault.place.map(|p| p.line), fault.help.as_deref()), (Some(1), Some("is `solver` meant?")));
    let fault = document.require::<Solver>("gravity").unwrap_err();
    assert_eq!(fault.to_string(), "missing `gravity` in `s.toml`\n  = help: the scene has solvr, water");
}

#[test]
fn later_faults_find_their_places() {
    let document = Document::parse(GOOD, "scene.toml", Format::Toml, &[]).unwrap();
    for (path, line) in
        [("elements[0].section.ei", 18), ("elements[0].sektion.ei", 11), ("elements[1].from[2]", 5), ("x", 1)]
    {
        let fault = document.fault_at(path, "no");
        assert_eq!(fault.place.map(|p| p.line), Some(line), "{path}");
    }
}

/// Buffering by serde loses places; what is left has to be right all the same.
#[test]
fn buffered_structs_still_give_a_place() {
    #[derive(Debug, Deserialize)]
    #[expect(dead_code, reason = "only its reading is tested")]
    struct Outer {
        #[serde(flatten)]
        section: Section,
        x: Either,
    }
    #[derive(Debug, Deserialize)]
    #[serde(untagged)]
    #[expect(dead_code, reason = "only its reading is tested")]
    enum Either {
        Number(f64),
        Table { y: f64 },
    }
    let read = |text: &str| Document::parse(text, "s", Format::Toml, &[]).unwrap().require::<Outer>("o");
    assert!(read("o = { ea = '1 N', ei = 2, x = { y = 1 } }").is_ok());
    for (text, message, path) in [
        ("o = { ea = '1 m', ei = 2, x = 1 }", "\"1 m\" is a length", "o"),
        ("o = { ea = 1, ei = 2, x = true }", "data did not match any variant", "o.x"),
        ("o = { ea = 1, x = 1 }", "missing `ei`", "o"),
    ] {
        let fault = read(text).expect_err(text);
        assert!(fault.message.starts_with(message), "{fault}");
        assert_eq!(fault.path, path, "{fault}");
    }
}

#[test]
fn a_name_of_version_0_1_has_its_place_and_the_command() {
    let text = "[[constraints]]\ntype = \"winch\"\nname = \"w\"\npace = \"run\"\n";
    let mut document = Document::parse(text, "old.toml", Format::Toml, &[]).unwrap();
    let fault = document.take_list::<Box<dyn Part>>("constraints").unwrap_err();
    assert_eq!(
        fault.to_string(),
        "\
`pace` is called `reference_speed` since version 0.2
 --> old.toml:4:1 (constraints[0])
  |
4 | pace = \"run\"
  | ^^^^
  = help: `ropewalk migrate old.toml` rewrites the scene"
    );
}
