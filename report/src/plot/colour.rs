//! Colours that differ in lightness as well as in hue.

use std::fmt;

/// Red, green and blue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Colour(u8, u8, u8);

impl fmt::Display for Colour {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{:02X}{:02X}{:02X}", self.0, self.1, self.2)
    }
}

pub(super) const TEXT: Colour = Colour(0x22, 0x22, 0x22);
pub(super) const AXIS: Colour = Colour(0x55, 0x55, 0x55);
pub(super) const GRID: Colour = Colour(0xE3, 0xE3, 0xE3);
pub(super) const FINE_GRID: Colour = Colour(0xF1, 0xF1, 0xF1);
pub(super) const PAPER: Colour = Colour(0xFF, 0xFF, 0xFF);

/// Okabe & Ito's palette without its yellow, which is too light for a thin line on white.
const PALETTE: [Colour; 7] = [
    Colour(0x00, 0x72, 0xB2),
    Colour(0xD5, 0x5E, 0x00),
    Colour(0x00, 0x9E, 0x73),
    Colour(0xCC, 0x79, 0xA7),
    Colour(0x22, 0x22, 0x22),
    Colour(0x56, 0xB4, 0xE9),
    Colour(0xE6, 0x9F, 0x00),
];

/// Viridis at equal distances, without its last tenth, which is too light for a line on white.
const RAMP: [Colour; 10] = [
    Colour(0x44, 0x01, 0x54),
    Colour(0x48, 0x26, 0x77),
    Colour(0x3F, 0x47, 0x88),
    Colour(0x31, 0x66, 0x8E),
    Colour(0x26, 0x82, 0x8E),
    Colour(0x1F, 0x9D, 0x8A),
    Colour(0x35, 0xB7, 0x79),
    Colour(0x6C, 0xCE, 0x5A),
    Colour(0x93, 0xD7, 0x41),
    Colour(0xB4, 0xDE, 0x2C),
];

/// Colour of series `index` out of `count`; many series are taken as ordered (along a cable).
pub(super) fn of_series(index: usize, count: usize) -> Colour {
    if count <= PALETTE.len() {
        PALETTE[index % PALETTE.len()]
    } else {
        ramp(index as f64 / (count - 1) as f64)
    }
}

/// Colour at `share`, 0 … 1, of a ramp from dark violet by green to yellow-green.
pub(super) fn ramp(share: f64) -> Colour {
    let last = RAMP.len() - 1;
    let place = share.clamp(0.0, 1.0) * last as f64;
    let below = (place as usize).min(last - 1);
    let (a, b) = (RAMP[below], RAMP[below + 1]);
    let part = place - below as f64;
    let mix = |a: u8, b: u8| (f64::from(a) + part * (f64::from(b) - f64::from(a))).round() as u8;
    Colour(mix(a.0, b.0), mix(a.1, b.1), mix(a.2, b.2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ramp_grows_lighter_from_end_to_end() {
        let light = |c: Colour| 0.2126 * f64::from(c.0) + 0.7152 * f64::from(c.1) + 0.0722 * f64::from(c.2);
        let shades: Vec<f64> = (0..=40).map(|i| light(ramp(f64::from(i) / 40.0))).collect();
        assert!(shades.windows(2).all(|w| w[0] < w[1]));
        assert_eq!(ramp(f64::NAN.max(0.0)), RAMP[0]);
        assert_eq!(ramp(2.0), RAMP[9]);
    }

    #[test]
    fn many_series_are_told_apart_by_the_ramp() {
        let colours: Vec<_> = (0..12).map(|i| of_series(i, 12)).collect();
        assert!(colours.windows(2).all(|w| w[0] != w[1]));
    }
}
