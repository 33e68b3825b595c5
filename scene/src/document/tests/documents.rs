use super::*;
use crate::document::{Kind, Value};
use std::path::{Path, PathBuf};

#[test]
fn a_good_scene_is_read() {
    let scene = toml(GOOD).unwrap();
    let shown = format!("{:?}", scene.elements.iter().map(|(part, _)| part).collect::<Vec<_>>());
    for part in [
        r#"name: "line", from: [0.0, 0.2, 0.0], section: Section { ea: 1200000.0, ei: 0.01, shape: Solid }"#,
        r#"name: "second", from: [0.0, 30.0, 2.0], section: Section { ea: 10000.0, ei: 2.0, shape: Tube { bore: 0.01 } }"#,
        "elements: Some(20), motion: Some(Sine { amplitude: 30.0 })",
        r#""b c": 2.5"#,
        "Weight { mass: 2000.0 }",
    ] {
        assert!(shown.contains(part), "{shown}");
    }
    assert_eq!(scene.solver.unwrap().step, 0.02);
    assert_eq!(&GOOD[scene.elements[2].1.range()], "[[elements]]");
}

#[test]
fn json_reads_as_toml_does() {
    let scene = json(
        r#"{ "$schema": "https://example.org/scene.json", "title": null, "solver": { "step": 1 }, "parameters": { "n": 20.0 },
             "elements": [{ "type": "cable", "name": "é\n", "from": [1, "2 m", 3e0], "elements": "$n", "motion": null,
                            "section": { "ea": 1, "ei": 2, "shape": "solid" } }] }"#,
    )
    .unwrap();
    let shown = format!("{:?}", scene.elements[0].0);
    assert!(shown.contains(r#"name: "é\n", from: [1.0, 2.0, 3.0]"#), "{shown}");
    assert!(shown.contains("elements: Some(20), motion: None"), "{shown}");
}

#[test]
fn parts_without_fields_need_only_a_type() {
    assert!(toml("elements = [{ type = 'gravity' }]").is_ok());
    let fault = toml("elements = [{ type = 'gravity', g = 9.81 }]").unwrap_err();
    assert_eq!(
        (fault.message.as_str(), fault.path.as_str()),
        ("unknown field `g`, expected nothing here", "elements[0]")
    );
}

#[test]
fn null_is_as_good_as_nothing() {
    assert!(json(r#"{"solver": {"step": 1, "quiet": null}, "elements": null}"#).is_ok());
    assert_eq!(json(r#"{"solver": {"step": null}}"#).unwrap_err().message, "missing `step`");
    assert!(
        json(r#"{"solver": {"step": 1, "quite": null}}"#)
            .unwrap_err()
            .message
            .starts_with("unknown field `quite`")
    );
}

#[test]
fn enums_take_a_name_a_type_or_serdes_own_form() {
    for (text, shape) in [
        ("x = 'solid'", Shape::Solid),
        ("x = { type = 'solid' }", Shape::Solid),
        ("x = { type = 'tube', bore = 2 }", Shape::Tube { bore: 2.0 }),
        ("x = { tube = { bore = 2 } }", Shape::Tube { bore: 2.0 }),
        ("x.power = 3", Shape::Power(3.0)),
    ] {
        let mut document = Document::parse(text, "x.toml", Format::Toml, &[]).unwrap();
        assert_eq!(document.require::<Shape>("x").unwrap(), shape, "{text}");
    }
    for (text, message, path) in [
        ("x = 'sold'", "unknown value `sold`, expected one of `solid`, `tube`, `power`", "x"),
        ("x = 'tube'", "`tube` needs values of its own", "x"),
        ("x = 3", "expected one of `solid`, `tube`, `power`, found a number", "x"),
        ("x = { type = 'tub', bore = 2 }", "unknown type `tub`, expected one of", "x.type"),
        ("x = { type = 3 }", "expected the name of a type, found a number", "x.type"),
        ("x = { bore = 2 }", "missing `type`, expected one of", "x"),
        ("x = { type = 'solid', bore = 2 }", "unknown field `bore`, expected nothing here", "x"),
        ("x = { type = 'tube', bore = 'wide' }", "expected a number, found \"wide\"", "x.bore"),
        ("x = { tube = { bore = 'wide' } }", "expected a number, found \"wide\"", "x.tube.bore"),
        ("x = { tube = { bore = 2, core = 1 } }", "unknown field `core`, expected `bore`", "x.tube"),
        ("x = { power = 'much' }", "expected a number, found \"much\"", "x.power"),
    ] {
        let mut document = Document::parse(text, "x.toml", Format::Toml, &[]).unwrap();
        let fault = document.require::<Shape>("x").expect_err(text);
        assert!(fault.message.starts_with(message), "{text}: {fault}");
        assert_eq!(fault.path, path, "{text}: {fault}");
    }
}

#[test]
fn whole_numbers_may_be_written_with_a_point_but_not_with_a_fraction() {
    let number = |text: &str| Document::parse(text, "x", Format::Toml, &[]).unwrap().require::<u8>("x");
    assert_eq!(number("x = 20.0").unwrap(), 20);
    assert_eq!(number("x = 2e1").unwrap(), 20);
    for (text, message) in [
        ("x = 20.5", "expected a whole number, 0 or larger, found 20.5"),
        ("x = -1", "expected a whole number, 0 or larger, found -1"),
        ("x = 300", "expected a whole number, 0 or larger, found 300"),
        ("x = 1e300", "expected a whole number, 0 or larger, found 1e300"),
    ] {
        assert_eq!(number(text).unwrap_err().message, message);
    }
}

/// Equal but for places.
fn same(a: &Value, b: &Value) -> bool {
    match (&a.kind, &b.kind) {
        (Kind::Array(a), Kind::Array(b)) => a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(a, b)),
        (Kind::Table(a), Kind::Table(b)) => {
            let (a, b): (Vec<_>, Vec<_>) = (present(a), present(b));
            a.len() == b.len() && a.iter().all(|(k, v)| b.iter().any(|(l, w)| k == l && same(v, w)))
        }
        (a, b) => a == b,
    }
}

fn present(t: &crate::document::Table) -> Vec<(&str, &Value)> {
    t.iter().filter(|(_, v)| v.kind != Kind::Null).map(|(k, v)| (k.name.as_str(), v)).collect()
}

fn written_reads_the_same(text: &str, format: Format) -> String {
    let first = Document::parse(text, "first", format, &[]).unwrap();
    let written = first.to_toml();
    let again =
        Document::parse(&written, "again", Format::Toml, &[]).unwrap_or_else(|e| panic!("{written}\n{e}"));
    assert!(same(first.root(), again.root()), "{written}\n{:?}\n{:?}", first.root(), again.root());
    assert_eq!(written, again.to_toml());
    written
}

#[test]
fn what_is_written_reads_again_to_the_same() {
    let written = written_reads_the_same(GOOD, Format::Toml);
    assert!(!written.contains("parameters") && !written.contains("\"$"), "{written}");
    assert!(toml(&written).is_ok(), "{written}");
    let odd = r#"{ "a b": {"": [[], {}, [[1, {"x": null, "y": [{"z": {}}]}]]], "t": [{"u": [{"v": 1}], "w": 2}, {}], "n": null},
                   "s": "$$a\u0000\u007f\u0085\"\\\n\t\r é🚢", "f": [1e300, -0.0, 5e-324, 1e22, 0.1, 123456789.125, 1E5],
                   "i": [-9223372036854775808, 9223372036854775807], "big": 18446744073709551615, "e": [], "b": [true, false] }"#;
    let written = written_reads_the_same(odd, Format::Json);
    assert!(written.contains("s = \"$$a"), "{written}");
    written_reads_the_same(
        "[a.b.c]\n[a]\nx = 0x1F\ny = [[1, 2], [3]]\n[[a.l]]\n[[a.l.m]]\nz = '''\n$$q'''\n",
        Format::Toml,
    );
}

fn file(name: &str, bytes: &[u8]) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("ropewalk-scene-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

#[test]
fn files_are_read_by_extension() {
    assert!(Document::read(&file("good.toml", GOOD.as_bytes()), &[]).is_ok());
    assert!(Document::read(&file("good.JSON", b"{\"a\": 1}"), &[]).is_ok());
    assert!(Document::read(&file("json", b"\xEF\xBB\xBF \n{\"a\": 1}"), &[]).is_ok());
    assert!(Document::read(&file("toml", b"\xEF\xBB\xBFa = 1\r\n"), &[]).is_ok());
}

#[test]
fn files_that_are_no_scenes_are_refused() {
    let fault = |path: &Path| Document::read(path, &[]).expect_err("no scene").to_string();
    assert!(fault(Path::new("/nowhere/scene.toml")).contains("there is no file `/nowhere/scene.toml`"));
    assert!(fault(&std::env::temp_dir()).contains("is a directory, not a scene file"));
    for (name, bytes, message) in [
        ("binary.toml", &b"\xff\xfe\x00x"[..], "is not a text file (UTF-8)"),
        ("zero.toml", b"a = 1\0", "is not a text file (UTF-8)"),
        ("empty.toml", b"", "is empty"),
        ("blank.json", b"\xEF\xBB\xBF \n", "is empty"),
        ("comment.toml", b"# nothing\n", "is empty"),
        ("nothing.json", b"{}", "is empty"),
        ("scene.yaml", b"a: 1", "`.yaml` is neither `.toml` nor `.json`"),
        ("large.toml", &vec![b'#'; (8 << 20) + 1], "is larger than 8 MB"),
    ] {
        let fault = fault(&file(name, bytes));
        assert!(fault.contains(message) && fault.lines().count() == 1, "{fault}");
    }
    if Path::new("/dev/zero").exists() {
        assert!(fault(Path::new("/dev/zero")).contains("is a pipe or a device, not a scene file"));
    }
}
