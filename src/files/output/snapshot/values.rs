//! Numbers of a snapshot in its precision.

use crate::output::h5::{Element, Fill, PIECE, Piece, RowType, Writer};
use crate::output::{Block, OutputError};
use comm::pieces;
use model::Precision;

/// Writes rows of numbers as they are, or reals with 32 bits each.
pub(super) fn write_values(
    file: &mut Writer,
    path: &str,
    row: RowType,
    precision: Precision,
    block: Block,
    fill: &Fill,
) -> Result<(), OutputError> {
    if precision == Precision::Double || row.element != Element::F64 {
        return file.rows_of(path, row, block, fill);
    }
    let short = RowType {
        element: Element::F32,
        components: row.components,
    };
    file.rows_of(path, short, block, &|rows, bytes| {
        let mut piece = Piece::take();
        for chunk in pieces(rows.len(), PIECE / row.bytes()) {
            let wide = &mut piece.bytes()[..chunk.len() * row.bytes()];
            fill(rows.start + chunk.start..rows.start + chunk.end, wide);
            let target = chunk.start * short.bytes()..chunk.end * short.bytes();
            shorten(wide, &mut bytes[target]);
        }
        piece.keep();
    })
}

/// Rounds values of 64 bits to the nearest of 32, infinite beyond their range. NaN has the same bits on
/// any machine.
fn shorten(bytes: &[u8], short: &mut [u8]) {
    #[allow(clippy::cast_possible_truncation, reason = "rounding is wanted")]
    let shortened = |value: f64| {
        if value.is_nan() {
            f32::NAN
        } else {
            value as f32
        }
    };
    let values = bytes.chunks_exact(size_of::<f64>());
    for (target, value) in short.chunks_exact_mut(size_of::<f32>()).zip(values) {
        let value = shortened(bytemuck::pod_read_unaligned(value));
        target.copy_from_slice(&value.to_ne_bytes());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_rounded_to_the_nearest() {
        let values = [0.1, -1e300, f64::from_bits(0x7ff0_0000_dead_beef), -0.0];
        let mut short = [0_f32; 4];
        shorten(
            bytemuck::cast_slice(&values),
            bytemuck::cast_slice_mut(&mut short),
        );
        let bits = short.map(f32::to_bits);
        let expected = [0.1_f32, f32::NEG_INFINITY, f32::NAN, -0.0].map(f32::to_bits);
        assert_eq!(bits, expected);
    }
}
