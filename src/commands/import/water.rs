//! The run, the water, its bed and what it does to lines.

use super::deck::{Deck, Row};
use super::parts::Line;
use super::rod::rod_end;
use ropewalk_scene::Fault;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::fmt::Write as _;
use std::path::Path;

/// The run, gravity and the water.
pub(super) fn head(
    deck: &Deck<'_>,
    name: &str,
    density: f64,
    folder: &Path,
    out: &mut String,
) -> Result<(), Fault> {
    let g = deck.option_number(&["g", "gravity"], 9.80665)?;
    let output = deck.option_number(&["dtout"], 0.0)?;
    let output = if output > 0.0 { output } else { 0.1 };
    let depth = deck.option_number(&["wtrdpth"], 0.0)?;
    let start = match drifts(deck) {
        true => {
            "from_equilibrium = false         # something drifts freely: all starts where the deck puts it"
        }
        false => "from_equilibrium = true",
    };
    let title = deck.title.replace(['"', '\\'], "'");
    let _ = write!(
        out,
        "# {name}, a MoorDyn deck, as a scene.\ntitle = \"{title}\"\ngravity = [0, 0, {:?}]\n\n[run]\n\
         # the deck doesn't say how long\nduration = \"60 s\"\noutput = {output:?}\n{start}\n\n[water]\n\
         density = {density:?}\nlevel = 0\n",
        0.0 - g
    );
    match deck.option_number(&["currents"], 0.0)? {
        0.0 => {}
        1.0 => {
            let profile = table(folder, "current_profile.txt", 4, 3)?;
            out.push_str("profile = [\n");
            for z in profile {
                let _ = writeln!(
                    out,
                    "    {{ z = {:?}, velocity = [{:?}, {:?}, {:?}] }},",
                    z[0], z[1], z[2], z[3]
                );
            }
            out.push_str("]\n");
        }
        _ => {
            return Err(unknown(
                deck,
                "currents",
                "currents of this kind aren't taken over: only 0 and 1, a profile over depth, are",
            ));
        }
    }
    match deck.option_number(&["wavekin"], 0.0)? {
        0.0 => {}
        3.0 => {
            let file = folder.join("wave_elevation.txt");
            if !file.is_file() {
                let message = format!("`{}`, which the deck needs, is no file", file.display());
                return Err(unknown(deck, "wavekin", &message));
            }
            let file = file.display().to_string().replace('\\', "/").replace('"', "");
            let _ = write!(
                out,
                "\n[water.waves]\ndepth = {depth:?}\nramp = 20.0                      # from the equilibrium in still water\n\
                 # the deck's record of the elevation; summed up, without the deck's grid\nmeasured = {{ file = \"{file}\" }}\n"
            );
        }
        kind @ (2.0 | 7.0) => {
            let _ = write!(
                out,
                "\n[water.waves]\ndepth = {depth:?}\nramp = 20.0                      # from the equilibrium in still water\n{}components = [\n",
                if kind == 2.0 { "# summed up, without the deck's grid\n" } else { "" }
            );
            let rows = table(folder, "wave_frequencies.txt", 3, 0)?;
            if kind == 2.0 && !even(&rows) {
                let message = "waves on a grid (WaveKin 2) are taken over only if their frequencies are at equal intervals: the deck \
                               puts others between them";
                return Err(unknown(deck, "wavekin", message));
            }
            for w in rows {
                let [omega, re, im] = [w[0], w[1], w[2]];
                // kind 7 sums up |A| sin(ωt - kx + arg A), kind 2 |A| cos(ωt - kx + arg A), the scene cos(kx - ωt + φ)
                let turn = if kind == 2.0 { 0.0 } else { FRAC_PI_2 };
                let (amplitude, phase) = (re.hypot(im), turn - im.atan2(re));
                if omega > 0.0 && amplitude > 0.0 {
                    let way = w.get(3).filter(|b| **b != 0.0);
                    let way = way.map_or(String::new(), |b| format!(", direction = {b:?}"));
                    let _ = writeln!(
                        out,
                        "    {{ amplitude = {amplitude:?}, period = {:?}, phase = {phase:?}{way} }},",
                        TAU / omega
                    );
                }
            }
            out.push_str("]\n");
        }
        _ => {
            return Err(unknown(
                deck,
                "wavekin",
                "waves of this kind aren't taken over: only 0, and 2, 3 and 7, which are sums of components, are",
            ));
        }
    }
    Ok(())
}

/// Whether a rod or body has no line, so that it has no equilibrium that could be found.
fn drifts(deck: &Deck<'_>) -> bool {
    let word = |row: &Row, k: usize| row.words.get(k).map_or(String::new(), |w| w.text.to_lowercase());
    let ends = || deck.lines.iter().flat_map(|row| [word(row, 2), word(row, 3)]);
    let lone_rod = |row: &Row| {
        let free = matches!(word(row, 2).as_str(), "free" | "pinned" | "pin");
        free && !ends().any(|id| rod_end(deck, &id).is_some_and(|(rod, _)| std::ptr::eq(rod, row)))
    };
    let lone_body = |row: &Row| {
        let own = format!("body{}", word(row, 0));
        let points: Vec<String> =
            deck.points.iter().filter(|p| word(p, 1) == own).map(|p| word(p, 0)).collect();
        word(row, 1) == "free" && !ends().any(|id| points.contains(&id))
    };
    deck.rods.iter().any(lone_rod) || deck.bodies.iter().any(lone_body)
}

/// Whether the first numbers of rows are at equal intervals.
fn even(rows: &[Vec<f64>]) -> bool {
    let steps: Vec<f64> = rows.windows(2).map(|w| w[1][0] - w[0][0]).collect();
    steps.iter().all(|step| (step - steps[0]).abs() <= 1e-6 * steps[0].abs())
}

/// An option with a value that has no counterpart.
fn unknown(deck: &Deck<'_>, option: &str, message: &str) -> Fault {
    let word = deck.option(&[option]).and_then(|row| row.words.first());
    word.map_or_else(|| Fault::new(message), |word| deck.word_fault(message, word))
}

/// Rows of numbers of a file beside the deck.
fn table(folder: &Path, file: &str, columns: usize, heads: usize) -> Result<Vec<Vec<f64>>, Fault> {
    let path = folder.join(file);
    let shown = path.display().to_string();
    let text = std::fs::read_to_string(&path)
        .map_err(|e| Fault::new(format!("`{shown}`, which the deck needs, can't be read: {e}")))?;
    let mut start = 0;
    let mut rows = Vec::new();
    for (k, line) in text.split_inclusive('\n').enumerate() {
        let bytes = start..start + line.trim_end().len();
        start += line.len();
        if k < heads || line.trim().is_empty() {
            continue;
        }
        let row: Option<Vec<f64>> =
            line.split_whitespace().map(|x| x.parse().ok().filter(|x: &f64| x.is_finite())).collect();
        let Some(row) = row.filter(|row| row.len() >= columns) else {
            return Err(Fault::in_text(format!("{columns} numbers are expected here"), &shown, &text, bytes));
        };
        rows.push(row);
    }
    Ok(rows)
}

/// Gravity, water and the bed.
pub(super) fn forces(
    deck: &Deck<'_>,
    lines: &[Line<'_>],
    folder: &Path,
    out: &mut String,
) -> Result<(), Fault> {
    out.push_str("\n[[forces]]\ntype = \"gravity\"\n\n[[forces]]\ntype = \"buoyancy\"\n");
    let kinds = |same: &dyn Fn(&Line<'_>) -> Vec<u64>| {
        let mut groups: Vec<(Vec<u64>, Vec<&Line<'_>>)> = Vec::new();
        for l in lines {
            let key = same(l);
            match groups.iter_mut().find(|(k, _)| *k == key) {
                Some((_, all)) => all.push(l),
                None => groups.push((key, vec![l])),
            }
        }
        groups.into_iter().map(|(_, all)| all).collect::<Vec<_>>()
    };
    let names =
        |all: &[&Line<'_>]| all.iter().map(|l| format!("\"{}\"", l.name)).collect::<Vec<_>>().join(", ");
    for all in kinds(&|l| vec![l.kind.fluid[0].to_bits(), l.kind.fluid[2].to_bits()]) {
        let [cd, _, along, _] = all[0].kind.fluid;
        if cd != 0.0 || along != 0.0 {
            let _ = write!(
                out,
                "\n[[forces]]\ntype = \"drag\"\ncn = {cd:?}\nct = {along:?}\non = [{}]\n",
                names(&all)
            );
        }
    }
    for all in kinds(&|l| vec![l.kind.fluid[1].to_bits(), l.kind.fluid[3].to_bits()]) {
        let [_, ca, _, along] = all[0].kind.fluid;
        if ca != 0.0 {
            let along = match along.clamp(0.0, ca) {
                0.0 => String::new(),
                along => format!("ca_axial = {along:?}\n"),
            };
            let on = names(&all);
            let _ = write!(out, "\n[[forces]]\ntype = \"added_mass\"\nca = {ca:?}\n{along}on = [{on}]\n");
        }
    }
    let depth = deck.option_number(&["wtrdpth"], 0.0)?;
    let floor = deck.option(&["seafloorfile"]).map(|row| deck.word(row, 0, "file")).transpose()?;
    let (stiffness, damping) =
        (deck.option_number(&["kbot", "kb"], 3e6)?, deck.option_number(&["cbot", "cb"], 3e5)?);
    if stiffness == 0.0 || depth == 0.0 && floor.is_none() {
        return Ok(());
    }
    let friction = deck.option_number(&["frictioncoefficient"], 0.0)?;
    let grid = floor.map(|file| grid(&file.text, folder)).transpose()?;
    for (k, all) in kinds(&|l| vec![l.kind.diameter.to_bits()]).into_iter().enumerate() {
        let name = if k == 0 { "bed".to_string() } else { format!("bed-{}", k + 1) };
        let radius = 0.5 * all[0].kind.diameter;
        let below = if grid.is_some() { 0.0 } else { 0.0 - depth };
        let _ = write!(
            out,
            "\n# the axis of a line lies on the deck's bed, here half a diameter above\n[[forces]]\ntype = \"bed\"\n\
             name = \"{name}\"\npoint = [0, 0, {:?}]\nstiffness = {stiffness:?}\ndamping = {damping:?}\non = [{}]\n",
            below - radius,
            names(&all)
        );
        if friction > 0.0 {
            let _ = writeln!(out, "friction = {friction:?}");
        }
        out.push_str(grid.as_deref().unwrap_or(""));
    }
    Ok(())
}

/// The heights of a sea floor: numbers of lines, the lines along x and y, and rows `x y z`.
fn grid(file: &str, folder: &Path) -> Result<String, Fault> {
    let name = Path::new(file).file_name().map_or(file, |f| f.to_str().unwrap_or(file));
    let file = if folder.join(file).exists() { file } else { name };
    let rows = table(folder, file, 2, 0)?;
    let bad = |why: &str| Fault::new(format!("`{file}` is no sea floor: {why}"));
    let [_, x, y, heights @ ..] = &rows[..] else {
        return Err(bad("it needs the lines along x and y, and heights"));
    };
    let mut z = vec![vec![f64::NAN; y.len()]; x.len()];
    for row in heights {
        let near = |all: &[f64], at: f64| all.iter().position(|x| (x - at).abs() <= 1e-6 * (1.0 + at.abs()));
        let ([i, j], height) = match row[..] {
            [a, b, c] => ([near(x, a), near(y, b)], c),
            _ => return Err(bad("each height is a row `x y z`")),
        };
        match (i, j) {
            (Some(i), Some(j)) => z[i][j] = height,
            _ => return Err(bad("a height isn't on its lines")),
        }
    }
    if z.iter().flatten().any(|z| z.is_nan()) {
        return Err(bad("a crossing of its lines has no height"));
    }
    Ok(format!("grid = {{ x = {x:?}, y = {y:?}, z = {z:?} }}\n"))
}
