//! Attitudes of rigid bodies: unit quaternions, scalar part first.

use super::vector::{cross, dot};

/// The attitude at the start.
pub const START: [f64; 4] = [1.0, 0.0, 0.0, 0.0];

/// The attitude after a turn by the vector `turn` (rad), whose direction is the axis in space.
#[must_use]
pub fn turned(attitude: &[f64; 4], turn: &[f64; 3]) -> [f64; 4] {
    let angle = dot(turn, turn).sqrt();
    if angle == 0.0 {
        return *attitude;
    }
    let half = 0.5 * angle;
    let (c, s) = (libm::cos(half), libm::sin(half) / angle);
    let [w, v @ ..] = *attitude;
    let u = turn.map(|component| s * component);
    let across = cross(&u, &v);
    let [x, y, z] = std::array::from_fn(|a| c * v[a] + w * u[a] + across[a]);
    let all = [c * w - dot(&u, &v), x, y, z];
    // Rounding alone changes the length.
    let length = all.iter().fold(0.0, |sum, q| sum + q * q).sqrt();
    all.map(|q| q / length)
}

/// The rotation from the start to an attitude, by rows (Hamilton).
#[must_use]
pub fn rotation(attitude: &[f64; 4]) -> [[f64; 3]; 3] {
    let [w, x, y, z] = *attitude;
    [
        [
            1.0 - 2.0 * (y * y + z * z),
            2.0 * (x * y - w * z),
            2.0 * (x * z + w * y),
        ],
        [
            2.0 * (x * y + w * z),
            1.0 - 2.0 * (x * x + z * z),
            2.0 * (y * z - w * x),
        ],
        [
            2.0 * (x * z - w * y),
            2.0 * (y * z + w * x),
            1.0 - 2.0 * (x * x + y * y),
        ],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Turns about one axis add up, and leave the axis; turns about two do not commute.
    #[test]
    fn turns_are_rotations() {
        let half = std::f64::consts::FRAC_PI_2;
        let third = turned(&turned(&START, &[0.0, 0.0, 0.4]), &[0.0, 0.0, half - 0.4]);
        let r = rotation(&third);
        let x = [1.0, 0.0, 0.0];
        let y = r.map(|row| dot(&row, &x));
        assert!((y[1] - 1.0).abs() < 1e-15 && y[0].abs() < 1e-15);
        // x to y about z, then y to z about x.
        let r = rotation(&turned(&third, &[half, 0.0, 0.0]));
        let z = r.map(|row| dot(&row, &x));
        assert!((z[2] - 1.0).abs() < 1e-15);
        // z first leaves x, about x, then y.
        let r = rotation(&turned(
            &turned(&START, &[half, 0.0, 0.0]),
            &[0.0, 0.0, half],
        ));
        let y = r.map(|row| dot(&row, &x));
        assert!((y[1] - 1.0).abs() < 1e-15);
    }
}
