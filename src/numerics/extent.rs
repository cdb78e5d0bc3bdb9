//! Boxes along the axes.

/// The lower and the upper corner of a box (m).
pub type Extent = ([f64; 3], [f64; 3]);

/// The box around some boxes (m); from +∞ to −∞ around none.
pub fn around(boxes: impl IntoIterator<Item = Extent>) -> Extent {
    let mut all = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for (lower, upper) in boxes {
        for a in 0..3 {
            all.0[a] = all.0[a].min(lower[a]);
            all.1[a] = all.1[a].max(upper[a]);
        }
    }
    all
}
