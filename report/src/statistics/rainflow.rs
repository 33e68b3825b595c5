//! Cycles of a record for fatigue: rainflow counting as ASTM E1049-85, section 5.4.4, has it.

/// Some cycles of one range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cycle {
    /// From its lowest to its highest value.
    pub range: f64,
    /// Half way between both.
    pub mean: f64,
    /// 1 of a whole cycle, 0.5 of a half one.
    pub count: f64,
}

/// The cycles of a record, in the order in which they close; half cycles of what is left come last.
pub fn rainflow(record: &[f64]) -> Vec<Cycle> {
    let mut cycles = Vec::new();
    let mut stack: Vec<f64> = Vec::new();
    let cycle = |a: f64, b: f64, count| Cycle { range: (a - b).abs(), mean: 0.5 * (a + b), count };
    for turn in turning_points(record) {
        stack.push(turn);
        while let [.., a, b, c] = stack[..] {
            if (c - b).abs() < (b - a).abs() {
                break;
            }
            if stack.len() == 3 {
                // the range holds the first point: half a cycle
                cycles.push(cycle(a, b, 0.5));
                stack.remove(0);
            } else {
                cycles.push(cycle(a, b, 1.0));
                stack.truncate(stack.len() - 3);
                stack.push(c);
            }
        }
    }
    cycles.extend(stack.windows(2).map(|w| cycle(w[0], w[1], 0.5)));
    cycles
}

/// Where a record turns, with its first and its last value.
fn turning_points(record: &[f64]) -> Vec<f64> {
    let mut turns: Vec<f64> = Vec::new();
    for &x in record {
        match turns[..] {
            [.., y] if y == x => {}
            [.., a, b] if (b - a) * (x - b) > 0.0 => {
                if let Some(last) = turns.last_mut() {
                    *last = x;
                }
            }
            _ => turns.push(x),
        }
    }
    turns
}

/// Sum of the counts.
pub fn total(cycles: &[Cycle]) -> f64 {
    cycles.iter().map(|c| c.count).sum()
}

/// Damage by Miner's rule, where `life` tells how many cycles of a range and mean a rope endures: 1 is its end.
pub fn damage(cycles: &[Cycle], life: impl Fn(&Cycle) -> f64) -> f64 {
    cycles.iter().map(|c| c.count / life(c)).sum()
}

/// The range whose cycles, one every second over the whole duration [s], do the same damage where life goes with the range to
/// the power `-m`.
pub fn equivalent_range(cycles: &[Cycle], m: f64, duration: f64) -> f64 {
    (cycles.iter().map(|c| c.count * c.range.powf(m)).sum::<f64>() / duration).powf(1.0 / m)
}
