//! Bodies of a deck.

use super::deck::{Deck, Row};
use ropewalk_scene::Fault;
use std::fmt::Write as _;

pub(super) fn body(
    deck: &Deck<'_>,
    row: &Row,
    notes: &mut Vec<String>,
    out: &mut String,
) -> Result<(), Fault> {
    let (id, kind) = (deck.word(row, 0, "number")?, deck.word(row, 1, "attachment")?);
    let free = match kind.text.to_lowercase().as_str() {
        "free" => true,
        "coupled" | "vessel" | "fixed" | "anchor" => false,
        _ => return Err(deck.word_fault(&format!("a body of type `{}` isn't taken over", kind.text), kind)),
    };
    // numbers that may be three, parted by bars
    let several = |k: usize, what: &str| -> Result<Vec<f64>, Fault> {
        let word = deck.word(row, k, what)?;
        let all: Option<Vec<f64>> = word.text.split('|').map(|x| x.parse().ok()).collect();
        all.ok_or_else(|| {
            deck.word_fault(&format!("`{}` is no number: the {what} is expected here", word.text), word)
        })
    };
    let three = |x: Vec<f64>, one: fn(f64) -> [f64; 3]| match x[..] {
        [x] => one(x),
        [a, b, c] => [a, b, c],
        _ => [f64::NAN; 3],
    };
    let mut at = [0.0; 6];
    for (k, x) in at.iter_mut().enumerate() {
        *x = deck.number(row, 2 + k, "position or angle")?;
    }
    if at[3..].iter().any(|x| *x != 0.0) {
        let fault = deck.fault("a body that starts turned isn't taken over", row);
        return Err(fault.with_help("turn its points instead, or add `angles` to the scene"));
    }
    let mass = deck.number(row, 8, "mass")?;
    let centre = three(several(9, "centre of mass")?, |z| [0.0, 0.0, z]);
    let inertia = three(several(10, "inertia")?, |x| [x; 3]);
    let volume = deck.number(row, 11, "volume")?;
    // what is held needs no mass in the deck, and its mass says nothing here
    let weightless = mass == 0.0 && inertia == [0.0; 3];
    if weightless && free {
        let word = deck.word(row, 8, "mass")?;
        return Err(deck.word_fault("a free body without mass of its own isn't taken over", word));
    }
    let (mass, inertia) = if weightless { (1.0, [1.0; 3]) } else { (mass, inertia) };
    let held = if weightless { "# it is held, and its mass means nothing\n" } else { "" };
    if [12, 13].iter().any(|k| several(*k, "coefficient").is_ok_and(|all| all.iter().any(|x| *x != 0.0))) {
        notes.push(format!("drag and added mass of body {} are left out: a `hull` would have them", id.text));
    }
    let _ = write!(
        out,
        "\n# {}\n[[elements]]\ntype = \"rigid_body\"\nname = \"body{}\"\nposition = {:?}\n{held}mass = {mass:?}\ninertia = {inertia:?}\n\
         centre = {centre:?}\nvolume = {volume:?}\n",
        row.line,
        id.text,
        &at[..3]
    );
    let own: Vec<&Row> = deck
        .points
        .iter()
        .filter(|p| p.words.get(1).is_some_and(|w| w.text.to_lowercase() == format!("body{}", id.text)))
        .collect();
    if !own.is_empty() {
        out.push_str("points = {");
        for (k, p) in own.iter().enumerate() {
            let at = [deck.number(p, 2, "X")?, deck.number(p, 3, "Y")?, deck.number(p, 4, "Z")?];
            let _ = write!(out, "{} point{} = {at:?}", if k > 0 { "," } else { "" }, p.words[0].text);
        }
        out.push_str(" }\n");
    }
    if !free {
        let _ = write!(
            out,
            "\n# moved from outside in the deck: give it a `vessel` or `driving` instead\n[[constraints]]\ntype = \"weld\"\n\
             name = \"body{0}\"\nmarker = \"body{0}\"\n",
            id.text
        );
    }
    Ok(())
}
