//! Settings that stand in the wrong section, and where they belong.

use crate::document::Fault;
use crate::run::Run;
use crate::water::{Air, Water};
use ropewalk_core::integrator::Options;
use ropewalk_core::statics::StaticsOptions;
use serde::de::value::Error;
use serde::de::{DeserializeOwned, Visitor};
use serde::{Deserializer, forward_to_deserialize_any};

/// Settings that are part of another one.
const INSIDE: [(&str, &str); 2] = [
    ("tolerance", "steps have theirs in `[solver]`: stepping = { type = \"controlled\", tolerance = 1e-4 }"),
    ("h", "steps have theirs in `[solver]`: stepping = { type = \"fixed\", h = \"1 ms\" }"),
];

/// Says where a field belongs that was written in another section, or in none.
pub(crate) fn pointed(fault: Fault) -> Fault {
    let name = fault.message.strip_prefix("unknown field `").and_then(|rest| rest.split('`').next());
    match name.filter(|_| !fault.path.contains(['.', '['])).and_then(home) {
        Some(help) => fault.with_help(help),
        None => fault,
    }
}

/// Where a setting has its place, in words.
fn home(name: &str) -> Option<String> {
    if let Some((_, help)) = INSIDE.iter().find(|(inside, _)| *inside == name) {
        return Some((*help).to_string());
    }
    let sections = [
        ("run", fields::<Run>()),
        ("solver", fields::<Options>()),
        ("statics", fields::<StaticsOptions>()),
        ("water", fields::<Water>()),
        ("air", fields::<Air>()),
    ];
    let those = sections.iter().filter(|(_, fields)| fields.contains(&name));
    let those: Vec<String> = those.map(|(section, _)| format!("`[{section}]`")).collect();
    (!those.is_empty()).then(|| format!("`{name}` is a setting of {}", those.join(" and ")))
}

/// The names of a type's fields as files have them.
fn fields<T: DeserializeOwned>() -> &'static [&'static str] {
    let mut names: &[&str] = &[];
    // it always ends before a value is made
    let _ = T::deserialize(Names(&mut names));
    names
}

/// Hears what fields a type asks for, and has none.
struct Names<'a>(&'a mut &'static [&'static str]);

impl<'de> Deserializer<'de> for Names<'_> {
    type Error = Error;

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        *self.0 = fields;
        self.deserialize_any(visitor)
    }

    fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, Error> {
        Err(serde::de::Error::custom("names alone"))
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit unit_struct
        newtype_struct seq tuple tuple_struct map enum identifier ignored_any
    }
}

#[cfg(test)]
mod tests {
    use crate::document::Format;
    use crate::scene_file::SceneFile;

    #[test]
    fn what_stands_in_the_wrong_section_is_told_where_it_belongs() {
        for (text, help) in [
            ("[solver]\nfrom_equilibrium = true\n", Some("`from_equilibrium` is a setting of `[run]`")),
            ("duration = 1\n", Some("`duration` is a setting of `[run]`")),
            ("[run]\nsteps = 3\n", Some("`steps` is a setting of `[statics]`")),
            ("[solver]\ntolerance = 1e-6\n", Some("steps have theirs in `[solver]`: stepping = ")),
            // a field of a part isn't one of a section
            ("[solver]\nmass = 1\n", None),
            ("[run]\nduratoin = 1\n", Some("did you mean `duration`?")),
        ] {
            let fault = SceneFile::parse(text, "x", Format::Toml, &[]).unwrap_err();
            assert!(fault.message.starts_with("unknown field"), "{fault}");
            match help {
                Some(help) => assert!(fault.help.as_ref().is_some_and(|h| h.starts_with(help)), "{fault}"),
                None => assert_eq!(fault.help, None, "{fault}"),
            }
        }
    }
}
