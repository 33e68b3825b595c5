//! Numbers as people read them.

/// A number in six significant digits, without trailing zeros.
pub fn number(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 || !x.is_finite() {
        return format!("{}", x + 0.0);
    }
    if !(1e-4..1e7).contains(&size) {
        let text = format!("{x:.4e}");
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        return format!("{}e{exponent}", mantissa.trim_end_matches('0').trim_end_matches('.'));
    }
    let decimals = (5.0 - size.log10().floor()).clamp(0.0, 9.0) as usize;
    let text = format!("{x:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_string() } else { text }
}

/// A number in three digits, for what is known no better.
pub fn rough(x: f64) -> String {
    if (0.01..1e5).contains(&x.abs()) {
        let decimals = (2.0 - x.abs().log10().floor()).clamp(0.0, 4.0) as usize;
        format!("{x:.decimals$}")
    } else if x == 0.0 {
        "0".into()
    } else {
        format!("{x:.1e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_readable() {
        for (x, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0, "1"),
            (-29.98765432, "-29.9877"),
            (1234567.0, "1234567"),
            (0.00012345678, "0.000123457"),
            (1.5e-9, "1.5e-9"),
            (-2e12, "-2e12"),
            (f64::NAN, "NaN"),
        ] {
            assert_eq!(number(x), text);
        }
        assert_eq!([rough(0.0), rough(1.234), rough(123.4), rough(1e-9)], ["0", "1.23", "123", "1.0e-9"]);
    }
}
