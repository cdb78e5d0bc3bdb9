//! Numbers of a snapshot, with as many digits as it asks for.

use crate::model::Precision;
use crate::output::h5::{Element, RowType, Writer};
use crate::output::{Block, OutputError};

/// Writes rows of numbers as they are, or those that are no whole numbers with 32 bits each.
pub(super) fn write_values(
    file: &Writer,
    path: &str,
    (row, precision): (RowType, Precision),
    block: Block,
    bytes: &[u8],
) -> Result<(), OutputError> {
    if precision == Precision::Double || row.element != Element::F64 {
        return file.rows(path, row, block, bytes);
    }
    let short = RowType {
        element: Element::F32,
        components: row.components,
    };
    file.rows(path, short, block, bytemuck::cast_slice(&shortened(bytes)))
}

/// Values of 64 bits with 32: the nearest, infinite beyond the range of these. What is no number
/// has the same bits on any machine.
fn shortened(bytes: &[u8]) -> Vec<f32> {
    #[allow(clippy::cast_possible_truncation, reason = "digits are to go")]
    let short = |value: f64| {
        if value.is_nan() {
            f32::NAN
        } else {
            value as f32
        }
    };
    let values = bytes.chunks_exact(size_of::<f64>());
    values
        .map(|value| short(bytemuck::pod_read_unaligned(value)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_rounded_to_the_nearest() {
        let values = [0.1, -1e300, f64::from_bits(0x7ff0_0000_dead_beef), -0.0];
        let short = shortened(bytemuck::cast_slice(&values));
        let bits: Vec<u32> = short.iter().map(|value| value.to_bits()).collect();
        let expected = [0.1_f32, f32::NEG_INFINITY, f32::NAN, -0.0].map(f32::to_bits);
        assert_eq!(bits, expected);
    }
}
