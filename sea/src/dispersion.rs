//! How long waves are: `ω² = g k tanh(k h)`.

/// Wavenumber `k` [1/m] of waves of angular frequency `omega` [rad/s] in water of this depth [m], which may be infinite.
///
/// Newton's method on `x tanh x = a`, `x = k h`, `a = ω² h/g`, from a start that is right to 1 % at any depth, converges in
/// three to five steps to the last digit.
pub fn wavenumber(omega: f64, depth: f64, g: f64) -> f64 {
    let deep = omega * omega / g;
    if omega == 0.0 || depth.is_infinite() {
        return deep;
    }
    let a = deep * depth;
    let mut x = if a < 40.0 { a / (-(-a.powf(1.25)).exp_m1()).powf(0.4) } else { a };
    for _ in 0..20 {
        let t = x.tanh();
        let dx = (x * t - a) / (t + x * (1.0 - t * t));
        x -= dx;
        if dx.abs() <= 2e-16 * x {
            break;
        }
    }
    x / depth
}

/// Velocity of the energy of waves, `dω/dk` [m/s].
pub fn group_velocity(k: f64, depth: f64, g: f64) -> f64 {
    let kh = k * depth;
    // 2kh/sinh 2kh vanishes where it would overflow
    let shallow = if kh < 300.0 { 2.0 * kh / (2.0 * kh).sinh() } else { 0.0 };
    let celerity = if depth.is_infinite() { (g / k).sqrt() } else { (g * kh.tanh() / k).sqrt() };
    0.5 * celerity * (1.0 + if depth.is_infinite() { 0.0 } else { shallow })
}

/// Wavenumber of waves that an observer at rest sees with the frequency `omega` on a current of speed `along` [m/s] in
/// their direction: `(ω - k U)² = g k tanh(k h)`. `None` if an opposing current is too fast for them to advance.
pub fn wavenumber_on_current(omega: f64, depth: f64, g: f64, along: f64) -> Option<f64> {
    let mut k = wavenumber(omega, depth, g);
    if along == 0.0 || omega == 0.0 {
        return Some(k);
    }
    let tanh = |k: f64| if depth.is_infinite() { 1.0 } else { (k * depth).tanh() };
    for _ in 0..60 {
        let (sigma, t) = (omega - k * along, tanh(k));
        let f = g * k * t - sigma * sigma;
        let sech = 1.0 - t * t;
        let slope = g * (t + if depth.is_infinite() { 0.0 } else { k * depth * sech }) + 2.0 * sigma * along;
        // beyond the fold the group stands still against the current
        if !(slope > 0.0) || !(sigma > 0.0) {
            return None;
        }
        let next = (k - f / slope).max(0.1 * k);
        let moved = (next - k).abs();
        k = next;
        if moved <= 4e-16 * k {
            break;
        }
    }
    let (sigma, t) = (omega - k * along, tanh(k));
    let left = (g * k * t - sigma * sigma).abs();
    (left <= 1e-10 * sigma * sigma).then_some(k)
}
