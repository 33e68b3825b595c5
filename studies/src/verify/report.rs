//! What a case says on the terminal.

use super::case::Outcome;
use super::quantity::Measured;
use ropewalk_report::{number, rough};

/// One line: the case, its worst error, its CPU time.
pub fn heading(o: &Outcome) -> String {
    let limit = o.case.suggested_cpu_s;
    let time = format!("{} s of {} s", rough(o.cpu_s), number(limit));
    let slow = if o.cpu_s > limit { ", slower than suggested" } else { "" };
    let name = o.case.name;
    if o.case.quantities() == 0 {
        return format!("{name:<41} not run");
    }
    let compared = o.measured.len();
    if !o.trouble.is_empty() {
        return format!("{name:<41} FAILED: {compared} of {} quantities, {time}", o.case.quantities());
    }
    let verdict = if o.is_within() { "within" } else { "OUTSIDE" };
    let worst = ratio(o.worst());
    format!("{name:<41} {verdict:<7} {worst:>8} of the tolerance, {compared:>2} quantities, {time}{slow}")
}

/// All that it compared, a line each: measured, reference, tolerance, error in parts of the tolerance.
pub fn lines(o: &Outcome) -> Vec<String> {
    let mut out: Vec<String> = o.measured.iter().map(line).collect();
    out.extend(o.trouble.iter().map(|t| format!("    failed: {t}")));
    let left = o.case.left_out.iter();
    out.extend(left.map(|l| format!("    not run ({}): {}: {}", l.count, l.quantity, l.reason)));
    out
}

fn line(m: &Measured) -> String {
    let mark = if m.ratio() <= 1.0 { ' ' } else { '!' };
    format!(
        "  {mark} {:>9}  {}: {} for {} ± {}{}",
        ratio(m.ratio()),
        m.quantity,
        list(&m.measured),
        list(&m.reference),
        spread(&m.tolerance),
        if m.unit == "1" { String::new() } else { format!(" {}", m.unit) },
    )
}

/// A ratio in two digits.
pub(super) fn ratio(r: f64) -> String {
    match r {
        r if !r.is_finite() => "failed".into(),
        0.0 => "0".into(),
        r if r >= 0.01 => format!("{r:.2}"),
        r => format!("{r:.1e}"),
    }
}

/// Numbers in brackets; one stands alone.
pub(super) fn list(x: &[f64]) -> String {
    let all: Vec<String> = x.iter().map(|x| digits(*x)).collect();
    if let [one] = all.as_slice() { one.clone() } else { format!("[{}]", all.join(", ")) }
}

/// Tolerances: one number if all are the same.
pub(super) fn spread(x: &[f64]) -> String {
    let same = x.windows(2).all(|w| w[0] == w[1]);
    let all: Vec<String> = x.iter().map(|x| format!("{x:.1e}")).collect();
    if same { all.first().cloned().unwrap_or_default() } else { format!("[{}]", all.join(", ")) }
}

/// Eight digits that count; what is zero but for rounding is shown as such.
fn digits(x: f64) -> String {
    let size = x.abs();
    if size < 1e-15 {
        return "0".into();
    }
    if !(1e-4..1e8).contains(&size) {
        return format!("{x:.4e}");
    }
    let decimals = (7.0 - size.log10().floor()).clamp(0.0, 11.0) as usize;
    let text = format!("{x:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_string() } else { text }
}
