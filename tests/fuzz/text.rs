//! Texts of scenes with something changed.

use super::random::Rng;

/// Numbers and words that scenes may stumble over.
const ODD: [&str; 24] = [
    "0",
    "-1",
    "1",
    "1e-300",
    "1e300",
    "-1e300",
    "nan",
    "inf",
    "-inf",
    "1e308",
    "9223372036854775807",
    "2.5",
    "true",
    "[]",
    "[0, 0, 0]",
    "[1, 2]",
    "{}",
    "\"\"",
    "\"5 m\"",
    "\"-3 kg\"",
    "\"$elements\"",
    "\"$nothing\"",
    "\"1 furlong\"",
    "\"\\u0000\"",
];
/// The same where a number stands inside of something.
const NUMBERS: [&str; 12] =
    ["0", "-1", "1e-300", "1e300", "nan", "inf", "-0.0", "1e7", "0.5", "3", "\"2 m\"", "1e-9"];

/// The bundled scenes, and one that has everything.
pub fn sources() -> Vec<String> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data");
    let mut all: Vec<String> = ropewalk::bundled().iter().map(|b| b.text.to_string()).collect();
    for name in ["full.toml", "bodies.toml"] {
        all.push(std::fs::read_to_string(format!("{folder}/{name}")).expect(name));
    }
    // small meshes: what is looked for doesn't depend on their size
    all.iter()
        .map(|text| text.replace("default = 300,", "default = 12,").replace("default = 64,", "default = 6,"))
        .collect()
}

/// One of the texts with one to four changes.
pub fn changed(rng: &mut Rng, sources: &[String]) -> String {
    let mut text = sources[rng.below(sources.len())].clone();
    for _ in 0..=rng.below(4) {
        text = change(rng, &text, sources);
    }
    text
}

fn change(rng: &mut Rng, text: &str, sources: &[String]) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_string).collect();
    if lines.is_empty() {
        return text.to_string();
    }
    let at = rng.below(lines.len());
    match rng.below(12) {
        // another value
        0..=3 => {
            let fields: Vec<usize> = (0..lines.len()).filter(|k| lines[*k].contains(" = ")).collect();
            if let Some((key, _)) =
                fields.get(at % fields.len().max(1)).and_then(|k| lines[*k].split_once(" = "))
            {
                let line = format!("{key} = {}", rng.pick(&ODD));
                lines[fields[at % fields.len()]] = line;
            }
        }
        // another number inside of a value
        4..=5 => {
            let line = &lines[at];
            let digits: Vec<usize> =
                line.char_indices().filter(|(_, c)| c.is_ascii_digit()).map(|(k, _)| k).collect();
            if !digits.is_empty() {
                let from = digits[rng.below(digits.len())];
                let length = line[from..]
                    .find(|c: char| !(c.is_ascii_digit() || c == '.'))
                    .unwrap_or(line.len() - from);
                lines[at] = format!("{}{}{}", &line[..from], rng.pick(&NUMBERS), &line[from + length..]);
            }
        }
        // a line less, twice, or elsewhere
        6 => drop(lines.remove(at)),
        7 => lines.insert(at, lines[at].clone()),
        8 => {
            let line = lines.remove(at);
            lines.insert(rng.below(lines.len() + 1), line);
        }
        // a line of another scene
        9 => {
            let other: Vec<&str> = sources[rng.below(sources.len())].lines().collect();
            lines.insert(at, other[rng.below(other.len())].to_string());
        }
        // a character that doesn't belong there
        10 => {
            let line = &mut lines[at];
            let places: Vec<usize> = line.char_indices().map(|(k, _)| k).chain([line.len()]).collect();
            line.insert_str(
                places[rng.below(places.len())],
                rng.pick(&["\"", "[", "]", "{", "=", "#", "é", "\u{0}", "\\", "$", ","]),
            );
        }
        // the end is missing
        _ => {
            lines.truncate(at + 1);
            let keep = lines[at].char_indices().map(|(k, _)| k).nth(rng.below(12)).unwrap_or(0);
            lines[at].truncate(keep);
        }
    }
    lines.join("\n") + "\n"
}
