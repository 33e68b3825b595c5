//! Where elements that touch a level plane in part lie on it.

use crate::random::Random;
use ropewalk_forces::testing::below;

#[test]
fn a_cubic_is_below_zero_where_it_is() {
    let mut random = Random(1);
    let mut twice = 0;
    for k in 0..5000 {
        // straight and bent once too
        let mut b: [f64; 4] = std::array::from_fn(|_| random.number(0.5));
        if k % 5 == 0 {
            (b[1], b[2]) = ((2.0 * b[0] + b[3]) / 3.0, (b[0] + 2.0 * b[3]) / 3.0);
        } else if k % 5 == 1 {
            b[2] = b[1] + (b[3] - b[0]) / 3.0;
        }
        let (pieces, count) = below(&b);
        twice += usize::from(count == 2);
        for i in 0..=200 {
            let xi = f64::from(i) / 200.0;
            let rest = 1.0 - xi;
            let height =
                rest * rest * (rest * b[0] + 3.0 * xi * b[1]) + xi * xi * (3.0 * rest * b[2] + xi * b[3]);
            let within = pieces[..count].iter().any(|[from, to]| xi >= *from && xi <= *to);
            assert!(within == (height < 0.0) || height.abs() < 1e-12, "{b:?} at {xi}: {height}");
        }
    }
    assert!(twice > 10, "{twice}");
}
