//! Numbers of some rows, as a snapshot holds them.

use std::io::Write as _;

use files::output::h5::Element;

/// Order of bytes on this machine, which is that of all binary files here.
pub const IS_LITTLE: bool = cfg!(target_endian = "little");

/// Values of one type, row after row.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    F64(Vec<f64>),
    F32(Vec<f32>),
    I64(Vec<i64>),
    U64(Vec<u64>),
    U32(Vec<u32>),
    U8(Vec<u8>),
}

/// The same of every type.
macro_rules! each {
    ($values:expr, $inner:ident => $result:expr) => {
        match $values {
            Values::F64($inner) => $result,
            Values::F32($inner) => $result,
            Values::I64($inner) => $result,
            Values::U64($inner) => $result,
            Values::U32($inner) => $result,
            Values::U8($inner) => $result,
        }
    };
}

impl Values {
    /// So many zeros.
    pub fn zeros(element: Element, count: usize) -> Self {
        match element {
            Element::F64 => Self::F64(vec![0.0; count]),
            Element::F32 => Self::F32(vec![0.0; count]),
            Element::I64 => Self::I64(vec![0; count]),
            Element::U64 => Self::U64(vec![0; count]),
            Element::U32 => Self::U32(vec![0; count]),
            Element::U8 | Element::Text(_) => Self::U8(vec![0; count]),
        }
    }

    /// Their bytes.
    pub fn bytes(&self) -> &[u8] {
        each!(self, values => bytemuck::cast_slice(values))
    }

    /// Their bytes, to be filled.
    pub fn bytes_mut(&mut self) -> &mut [u8] {
        each!(self, values => bytemuck::cast_slice_mut(values))
    }

    /// Adds one to a line of text, with the fewest digits that give it back; `nan` is written for
    /// NaN.
    pub fn print(&self, index: usize, nan: &str, text: &mut Vec<u8>) {
        let _ = match self {
            Self::F64(values) if values[index].is_nan() => text.write_all(nan.as_bytes()),
            Self::F32(values) if values[index].is_nan() => text.write_all(nan.as_bytes()),
            _ => each!(self, values => write!(text, "{:?}", values[index])),
        };
    }

    /// One of them as a place in a list, if it can be one.
    pub fn index(&self, at: usize) -> Option<usize> {
        match self {
            Self::F64(_) | Self::F32(_) => None,
            Self::I64(values) => usize::try_from(values[at]).ok(),
            Self::U64(values) => usize::try_from(values[at]).ok(),
            Self::U32(values) => usize::try_from(values[at]).ok(),
            Self::U8(values) => Some(values[at].into()),
        }
    }

    /// Adds a number to whole ones that have a sign.
    pub fn shift(&mut self, by: i64) {
        if let Self::I64(values) = self {
            for value in values {
                *value = value.wrapping_add(by);
            }
        }
    }

    /// Changes reals, of rows of so many components, one by one: given the component.
    pub fn change(&mut self, components: usize, change: impl Fn(usize, f64) -> f64) {
        match self {
            Self::F64(values) => {
                for (k, value) in values.iter_mut().enumerate() {
                    *value = change(k % components, *value);
                }
            }
            Self::F32(values) => {
                for (k, value) in values.iter_mut().enumerate() {
                    #[expect(clippy::cast_possible_truncation, reason = "the file's own precision")]
                    let changed = change(k % components, f64::from(*value)) as f32;
                    *value = changed;
                }
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_give_the_bits_back() {
        let reals = [0.1, 1.0 / 3.0, -0.0, 5e-324, 1.797e308, 2.5e-5, 1e22];
        let values = Values::F64(reals.to_vec());
        for (k, real) in reals.iter().enumerate() {
            let mut text = Vec::new();
            values.print(k, "nan", &mut text);
            let read: f64 = std::str::from_utf8(&text).unwrap().parse().unwrap();
            assert_eq!(read.to_bits(), real.to_bits());
        }
        let mut text = Vec::new();
        Values::F32(vec![0.1]).print(0, "nan", &mut text);
        Values::F64(vec![f64::NAN]).print(0, "nan", &mut text);
        Values::I64(vec![-7]).print(0, "nan", &mut text);
        assert_eq!(text, b"0.1nan-7");
    }

    #[test]
    fn components_are_changed_in_their_own_precision() {
        let mut values = Values::F32(vec![0.1, 0.2, 0.3, 0.4]);
        values.change(
            2,
            |component, value| if component == 0 { -value } else { value },
        );
        assert_eq!(values, Values::F32(vec![-0.1, 0.2, -0.3, 0.4]));
        let mut ids = Values::I64(vec![1, 2]);
        ids.change(1, |_, value| -value);
        assert_eq!(ids, Values::I64(vec![1, 2]));
    }
}
