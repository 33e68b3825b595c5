//! Numbers as few bytes: what is left of them after a guess, byte by byte, deflated, as text.

use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::io::Write;

/// Of nine: more takes longer than it saves bytes.
const LEVEL: u32 = 5;

const SYMBOLS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Rows of single-precision numbers, each row like the one before: `code` 0, 1 or 2 says by how many rows before it
/// a row was guessed. What is left is stored as four planes, all lowest bytes first.
pub(super) fn rows(values: &[f32], columns: usize, out: &mut Vec<u8>) -> u8 {
    let bits: Vec<i32> = values.iter().map(|x| x.to_bits() as i32).collect();
    let rest = |code: u8| -> Vec<u32> {
        let before = |k: usize, rows: usize| if k >= rows * columns { bits[k - rows * columns] } else { 0 };
        let guess = |k: usize| match code {
            0 => 0,
            1 => before(k, 1),
            // without two rows before it, as the row before
            _ if k < 2 * columns => before(k, 1),
            _ => before(k, 1).wrapping_mul(2).wrapping_sub(before(k, 2)),
        };
        // zigzag: small numbers of either sign have empty upper bytes
        let left = bits.iter().enumerate().map(|(k, x)| x.wrapping_sub(guess(k)));
        left.map(|d| ((d << 1) ^ (d >> 31)) as u32).collect()
    };
    let cost = |rest: &[u32]| rest.iter().map(|d| u64::from(32 - d.leading_zeros())).sum::<u64>();
    let (code, rest) =
        (0..3).map(|code| (code, rest(code))).min_by_key(|(_, rest)| cost(rest)).unwrap_or_default();
    for plane in 0..4 {
        out.extend(rest.iter().map(|d| (d >> (8 * plane)) as u8));
    }
    code
}

/// A zlib stream, as browsers inflate it.
pub(super) fn deflated(bytes: &[u8]) -> Vec<u8> {
    let mut packed = ZlibEncoder::new(Vec::new(), Compression::new(LEVEL));
    // a vector takes all that is written to it
    let done = packed.write_all(bytes).and_then(|()| packed.finish());
    done.unwrap_or_default()
}

/// Bytes as text.
pub(super) fn base64(bytes: &[u8]) -> String {
    let mut text = Vec::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let byte = |k: usize| u32::from(chunk.get(k).copied().unwrap_or(0));
        let word = byte(0) << 16 | byte(1) << 8 | byte(2);
        for k in 0..4 {
            let symbol = SYMBOLS[(word >> (18 - 6 * k) & 63) as usize];
            text.push(if k <= chunk.len() { symbol } else { b'=' });
        }
    }
    text.into_iter().map(char::from).collect()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use proptest::prelude::*;

    /// What the page does to get the numbers back.
    pub fn numbers(bytes: &[u8], count: usize, columns: usize, code: u8) -> Vec<f32> {
        let mut bits: Vec<i32> = Vec::new();
        for k in 0..count {
            let left = (0..4).map(|plane| u32::from(bytes[plane * count + k]) << (8 * plane)).sum::<u32>();
            let left = (left >> 1) as i32 ^ -((left & 1) as i32);
            let row = k / columns;
            let guess = match (code, row) {
                (0, _) | (_, 0) => 0,
                (1, _) | (_, 1) => bits[k - columns],
                _ => bits[k - columns].wrapping_mul(2).wrapping_sub(bits[k - 2 * columns]),
            };
            bits.push(left.wrapping_add(guess));
        }
        bits.into_iter().map(|b| f32::from_bits(b as u32)).collect()
    }

    pub fn bytes(text: &str) -> Vec<u8> {
        let mut out = Vec::new();
        for chunk in text.as_bytes().chunks(4) {
            let value = |c: &u8| SYMBOLS.iter().position(|s| s == c).unwrap_or(0) as u32;
            let word = chunk.iter().fold(0, |word, c| word << 6 | value(c));
            let filled = chunk.iter().filter(|c| **c != b'=').count();
            out.extend((0..filled - 1).map(|k| (word >> (16 - 8 * k)) as u8));
        }
        out
    }

    #[test]
    fn text_is_that_of_rfc_4648() {
        for (plain, text) in
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")]
        {
            assert_eq!(base64(plain.as_bytes()), text);
            assert_eq!(bytes(text), plain.as_bytes());
        }
    }

    #[test]
    fn smooth_rows_become_small() {
        let values: Vec<f32> = (0..300)
            .flat_map(|k| (0..50).map(move |i| (0.0137 * k as f32 + 0.1 * (i * i) as f32).sin() + 3.0))
            .collect();
        let mut packed = Vec::new();
        assert_eq!(rows(&values, 50, &mut packed), 2);
        let plain: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
        let (small, large) = (deflated(&packed).len(), deflated(&plain).len());
        assert!(2 * small < large, "{small} of {large}");
    }

    proptest! {
        #[test]
        fn any_numbers_come_back_bit_by_bit(raw in prop::collection::vec(any::<u32>(), 0..60), columns in 1_usize..5) {
            let values: Vec<f32> = raw.iter().map(|b| f32::from_bits(*b)).collect();
            let values = &values[..values.len() / columns * columns];
            let mut packed = Vec::new();
            let code = rows(values, columns, &mut packed);
            let back = numbers(&packed, values.len(), columns, code);
            prop_assert!(values.iter().zip(&back).all(|(a, b)| a.to_bits() == b.to_bits()));
        }
    }
}
