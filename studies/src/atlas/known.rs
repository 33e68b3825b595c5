//! Tables that follow from the program itself: schemes, stiffness models, the machine.

use super::spec::Known;
use super::table::{Item, Printed};
use ropewalk_core::Width;
use ropewalk_core::integrator::{Coefficients, Scheme};
use ropewalk_elements::cable::{LongitudinalModel, TransverseModel, legal};

/// Makes a table.
pub(super) fn table(known: Known) -> Printed {
    match known {
        Known::NewmarkFamily => newmark(),
        Known::Machine => machine(),
        Known::LongitudinalModels => longitudinal(),
        Known::StiffnessPairs => pairs(),
    }
}

fn text(s: impl Into<String>) -> Item {
    Item::Text(s.into())
}

fn printed<const N: usize>(headings: [&str; N], rows: Vec<Vec<Item>>) -> Printed {
    Printed { headings: headings.map(String::from).to_vec(), rows }
}

/// Newmark's family: limit of stability and order follow from the amplification of an undamped oscillator.
fn newmark() -> Printed {
    let members = [
        ("purely explicit", Scheme::PurelyExplicit),
        ("central difference", Scheme::CentralDifference),
        ("Fox and Goodwin", Scheme::FoxGoodwin),
        ("linear acceleration", Scheme::LinearAcceleration),
        ("average acceleration", Scheme::AverageAcceleration),
        ("damped average acceleration, a = 0.1", Scheme::DampedAverageAcceleration { a: 0.1 }),
    ];
    let row = |(name, scheme): &(&str, Scheme)| {
        let c = scheme.coefficients().ok()?;
        let limit = match stability(&c) {
            Some(0.0) => text("unstable"),
            Some(limit) => Item::Number(limit, false),
            None => text("none"),
        };
        let (period, growth) = errors(&c);
        let numbers = [order(&c), period, growth].map(|x| Item::Number(x, false));
        let name = [text(*name), Item::Number(c.beta, false), Item::Number(c.gamma, false), limit];
        Some(name.into_iter().chain(numbers).collect())
    };
    let headings = [
        "method",
        "β",
        "γ",
        "stable up to ω h",
        "order",
        "error of the period / (ω h)²",
        "growth in a step / (ω h)²",
    ];
    printed(headings, members.iter().filter_map(row).collect())
}

/// Relative error of the period, and growth of the amplitude in a step, both by `(ω h)²` where that is small.
fn errors(c: &Coefficients) -> (f64, f64) {
    const SMALL: f64 = 0.01;
    let a = amplification(c, SMALL);
    let (half, det) = (0.5 * (a[0][0] + a[1][1]), a[0][0] * a[1][1] - a[0][1] * a[1][0]);
    let angle = (det - half * half).sqrt().atan2(half);
    let shown = |x: f64| (1e4 * x / (SMALL * SMALL)).round() / 1e4 + 0.0;
    (shown(SMALL / angle - 1.0), shown(det.sqrt() - 1.0))
}

/// What a step of `q̈ + q = 0` does to `(q, h v)` where `Ω = ω h`.
fn amplification(c: &Coefficients, omega: f64) -> [[f64; 2]; 2] {
    let w = omega * omega;
    let lead = 1.0 + c.beta * w;
    let (q, v) = ((1.0 - (0.5 - c.beta) * w) / lead, 1.0 / lead);
    [[q, v], [-(1.0 - c.gamma) * w - c.gamma * w * q, 1.0 - c.gamma * w * v]]
}

/// Largest size of its eigenvalues.
fn radius(c: &Coefficients, omega: f64) -> f64 {
    let a = amplification(c, omega);
    let (half, det) = (0.5 * (a[0][0] + a[1][1]), a[0][0] * a[1][1] - a[0][1] * a[1][0]);
    let disc = half * half - det;
    if disc >= 0.0 { half.abs() + disc.sqrt() } else { det.sqrt() }
}

/// The largest `ω h` up to which nothing grows: zero if there is none, nothing if there is no end.
fn stability(c: &Coefficients) -> Option<f64> {
    const GROWTH: f64 = 1e-9;
    const LARGEST: f64 = 1e4;
    let stable = |omega: f64| radius(c, omega) <= 1.0 + GROWTH;
    if !stable(1e-3) {
        return Some(0.0);
    }
    if stable(LARGEST) {
        return None;
    }
    let (mut low, mut high) = (1e-3, LARGEST);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if stable(middle) { low = middle } else { high = middle }
    }
    Some(low)
}

/// Order of convergence, from the error of an oscillator after a given time with two steps.
fn order(c: &Coefficients) -> f64 {
    let error = |steps: u32| {
        let h = 1.0 / f64::from(steps);
        let a = amplification(c, h);
        let x = (0..steps).fold([1.0, 0.0], |x, _| [0, 1].map(|i| a[i][0] * x[0] + a[i][1] * x[1]));
        (x[0] - 1.0_f64.cos()).hypot(x[1] / h + 1.0_f64.sin())
    };
    (error(100) / error(200)).log2().round()
}

fn longitudinal() -> Printed {
    use LongitudinalModel::{L1, L1n, L2, L3, L4};
    let rows = [
        (L1, "of the chord", "the same all along the element", "exact"),
        (L1n, "of the chord, taken as known", "the same all along the element", "not conservative"),
        (L2, "Green's, mean over the element", "the same all along the element", "exact"),
        (L3, "Green's", "at every point", "exact"),
        (L4, "engineering", "at every point", "exact"),
    ];
    let row = |(model, strain, along, energy): (LongitudinalModel, &str, &str, &str)| {
        vec![text(format!("{model:?}")), text(strain), text(along), text(energy)]
    };
    printed(["model", "strain", "along the element", "balance of energy"], rows.map(row).to_vec())
}

fn pairs() -> Printed {
    use LongitudinalModel::{L1, L1n, L2, L3, L4};
    use TransverseModel::{T1, T2, T3};
    let row = |l: LongitudinalModel| {
        let cell = |t| text(if legal(l, t).is_ok() { "yes" } else { "no: modes without stiffness" });
        std::iter::once(text(format!("{l:?}"))).chain([T1, T2, T3].map(cell)).collect()
    };
    let headings = ["", "T1: second derivative", "T2: curvature", "T3: turning of the tangent"];
    printed(headings, [L1, L1n, L2, L3, L4].map(row).to_vec())
}

/// What this machine is, as far as the system tells.
fn machine() -> Printed {
    let read = |path: &str| std::fs::read_to_string(path).unwrap_or_default();
    let field = |path: &str, name: &str| {
        let line = read(path).lines().find(|l| l.starts_with(name)).map(str::to_string)?;
        Some(line.split_once(':')?.1.trim().to_string())
    };
    let unknown = || "not told by the system".to_string();
    let memory =
        field("/proc/meminfo", "MemTotal").and_then(|t| t.trim_end_matches(" kB").parse::<f64>().ok());
    let cores = std::thread::available_parallelism().map_or_else(|_| unknown(), |n| n.to_string());
    let rows = [
        ("processor", field("/proc/cpuinfo", "model name").unwrap_or_else(unknown)),
        ("cores", cores),
        ("elements at once", Width::best().lanes().to_string()),
        ("memory", memory.map_or_else(unknown, |kb| format!("{:.1} GB", kb * 1024.0 / 1e9))),
        ("system", format!("{} {}", std::env::consts::OS, std::env::consts::ARCH)),
        ("program", format!("Ropewalk {}", env!("CARGO_PKG_VERSION"))),
    ];
    printed(["", "this machine"], rows.map(|(name, value)| vec![text(name), text(value)]).to_vec())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_of_stability_are_those_in_closed_form() {
        // ω h ≤ (γ/2 - β)^-½ for γ = ½
        for (beta, limit) in [(0.0, 2.0), (1.0 / 12.0, 6_f64.sqrt()), (1.0 / 6.0, 12_f64.sqrt())] {
            let c = Scheme::Newmark { beta, gamma: 0.5 }.coefficients().unwrap();
            let found = stability(&c).unwrap();
            assert!((found - limit).abs() < 1e-4, "{beta}: {found} {limit}");
        }
        let of = |s: Scheme| stability(&s.coefficients().unwrap());
        assert_eq!((of(Scheme::AverageAcceleration), of(Scheme::PurelyExplicit)), (None, Some(0.0)));
    }

    #[test]
    fn orders_are_the_known_ones() {
        let of = |s: Scheme| order(&s.coefficients().unwrap());
        // the fourth order of Fox and Goodwin is that of its period; its velocities are of the second
        for scheme in [Scheme::CentralDifference, Scheme::FoxGoodwin, Scheme::AverageAcceleration] {
            assert_eq!(of(scheme), 2.0);
        }
        assert_eq!(of(Scheme::DampedAverageAcceleration { a: 0.1 }), 1.0);
        assert_eq!(of(Scheme::PurelyExplicit), 1.0);
    }

    #[test]
    fn errors_are_those_of_the_expansion_in_small_steps() {
        // the period is longer by (β - 1/12) (ω h)² / 2 for γ = ½; γ beyond ½ damps by (γ - ½) (ω h)² / 2
        for (beta, gamma) in [(0.0, 0.5), (1.0 / 12.0, 0.5), (1.0 / 6.0, 0.5), (0.25, 0.5), (0.3025, 0.6)] {
            let c = Scheme::Newmark { beta, gamma }.coefficients().unwrap();
            let (period, growth) = errors(&c);
            if gamma == 0.5 {
                assert!((period - 0.5 * (beta - 1.0 / 12.0)).abs() < 1e-4, "{beta}: {period}");
            }
            assert!((growth + 0.5 * (gamma - 0.5)).abs() < 1e-3, "{beta}: {growth}");
        }
    }

    #[test]
    fn pairs_are_those_that_cables_take() {
        let table = pairs();
        assert_eq!(table.rows[0][1], text("yes"));
        assert!(matches!(&table.rows[2][3], Item::Text(t) if t.starts_with("no")));
        assert!(table.rows[4].iter().skip(1).all(|c| *c == text("yes")));
    }
}
