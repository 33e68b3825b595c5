//! A tree of values to TOML text, so that a run can keep the scene as it was after all parameters.

use super::value::{Kind, Table, Value};
use std::fmt::Write;

/// The whole document. It reads again to the same values; `null` entries are left out.
pub(super) fn document(root: &Table) -> String {
    let mut out = String::new();
    table(&mut out, "", root);
    out
}

impl Value {
    /// The value as `--set` takes it: as TOML, but a string without quotes.
    ///
    /// ```
    /// use ropewalk_scene::{Document, Format};
    /// let text = "[parameters]\nspeed = '15 kn'\nend = [1, 2.5]\n[run]\nduration = '$speed'\noutput = '$end'";
    /// let document = Document::parse(text, "scene.toml", Format::Toml, &[])?;
    /// let values: Vec<String> = document.parameters().iter().map(|p| p.value.to_text()).collect();
    /// assert_eq!(values, ["15 kn", "[1, 2.5]"]);
    /// # Ok::<(), ropewalk_scene::Fault>(())
    /// ```
    #[must_use]
    pub fn to_text(&self) -> String {
        let mut out = String::new();
        match &self.kind {
            Kind::String(s) => out += s,
            _ => inline(&mut out, self, 0),
        }
        out
    }
}

/// Whether a key needs no quotes.
pub(super) fn is_bare(name: &str) -> bool {
    !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-')
}

/// A TOML string.
pub(super) fn text(s: &str) -> String {
    let mut out = String::with_capacity(s.len() + 2);
    out.push('"');
    for c in s.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            '\n' => out.push_str("\\n"),
            '\t' => out.push_str("\\t"),
            '\r' => out.push_str("\\r"),
            // writing to a string can't fail
            c if c.is_control() => _ = write!(out, "\\u{:04X}", u32::from(c)),
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

fn key(name: &str) -> String {
    if is_bare(name) { name.to_string() } else { text(name) }
}

/// The tables of a list that is written as `[[path]]`.
fn tables(value: &Value) -> Option<Vec<&Table>> {
    let Kind::Array(list) = &value.kind else { return None };
    let tables: Option<Vec<&Table>> = list.iter().map(Value::as_table).collect();
    tables.filter(|t| !t.is_empty())
}

fn table(out: &mut String, path: &str, t: &Table) {
    // after a header everything belongs to it, so single values go first
    for (k, v) in
        t.iter().filter(|(_, v)| v.kind != Kind::Null && v.as_table().is_none() && tables(v).is_none())
    {
        _ = write!(out, "{} = ", key(&k.name));
        inline(out, v, 0);
        out.push('\n');
    }
    for (k, v) in t.iter() {
        let path = if path.is_empty() { key(&k.name) } else { format!("{path}.{}", key(&k.name)) };
        if let Some(inner) = v.as_table() {
            _ = writeln!(out, "{}[{path}]", if out.is_empty() { "" } else { "\n" });
            table(out, &path, inner);
        }
        for inner in tables(v).into_iter().flatten() {
            _ = writeln!(out, "{}[[{path}]]", if out.is_empty() { "" } else { "\n" });
            table(out, &path, inner);
        }
    }
}

fn inline(out: &mut String, value: &Value, indent: usize) {
    match &value.kind {
        Kind::Null => {}
        Kind::Bool(b) => _ = write!(out, "{b}"),
        Kind::Integer(i) => _ = write!(out, "{i}"),
        // the shortest text that reads as the same number
        Kind::Float(x) => _ = write!(out, "{x:?}"),
        // a dollar sign that came through the parameters is a literal one
        Kind::String(s) if s.starts_with('$') => out.push_str(&text(&format!("${s}"))),
        Kind::String(s) => out.push_str(&text(s)),
        Kind::Array(list) => {
            let rows = list.iter().any(|v| matches!(v.kind, Kind::Array(_) | Kind::Table(_)));
            out.push('[');
            for (i, v) in list.iter().enumerate() {
                match (rows, i) {
                    (true, _) => _ = write!(out, "\n{}", "    ".repeat(indent + 1)),
                    (false, 0) => {}
                    (false, _) => out.push(' '),
                }
                inline(out, v, indent + 1);
                if rows || i + 1 < list.len() {
                    out.push(',');
                }
            }
            if rows {
                _ = write!(out, "\n{}", "    ".repeat(indent));
            }
            out.push(']');
        }
        Kind::Table(t) => {
            out.push('{');
            for (i, (k, v)) in t.iter().filter(|(_, v)| v.kind != Kind::Null).enumerate() {
                _ = write!(out, "{} {} = ", if i == 0 { "" } else { "," }, key(&k.name));
                inline(out, v, indent);
            }
            out.push_str(" }");
        }
    }
}
