//! Arrays of VTK's XML files: as text, in base 64, or raw at the end, plain or compressed by zlib.

use std::io::Read;

use base64::Engine;
use base64::engine::DecodePaddingMode;
use base64::engine::general_purpose::{GeneralPurpose, GeneralPurposeConfig};
use flate2::read::ZlibDecoder;
use roxmltree::Node;

use crate::input::cloud::text::{number, shortened};

/// Most components of an array that is read.
const MOST_COMPONENTS: usize = 64;
/// A byte that is compressed cannot become more.
const MOST_GROWTH: usize = 1100;

/// Encoding of the bytes in the file.
#[derive(Debug)]
pub struct Layout<'a> {
    /// Bytes of the number that tells a length: 4 or 8.
    pub header: usize,
    pub is_little: bool,
    pub is_compressed: bool,
    /// Data at the end of the file, and whether it is in base 64.
    pub appended: Option<(&'a [u8], bool)>,
}

/// Name and components of an array.
pub fn title(node: Node) -> Result<(String, usize), String> {
    let name = node.attribute("Name").unwrap_or_default().to_owned();
    let components = match node.attribute("NumberOfComponents") {
        None => 1,
        Some(text) => text.trim().parse().unwrap_or(0),
    };
    if !(1..=MOST_COMPONENTS).contains(&components) {
        return Err(format!(
            "the array `{}` has no components",
            shortened(&name)
        ));
    }
    Ok((name, components))
}

/// Reads `values` numbers of an array.
///
/// # Errors
/// If there are others, or it is of a kind that is not read.
pub fn read(node: Node, values: usize, layout: &Layout) -> Result<Vec<f64>, String> {
    let format = node.attribute("format").unwrap_or("ascii");
    if format == "ascii" {
        let words = node.text().unwrap_or_default().split_ascii_whitespace();
        let numbers: Result<Vec<f64>, String> = words.take(values + 1).map(number).collect();
        return exactly(numbers?, values);
    }
    let kind = Kind::of(node.attribute("type").unwrap_or_default())?;
    let length = values.checked_mul(kind.bytes).ok_or("it is too large")?;
    let bytes = match format {
        "binary" => {
            let text: Vec<u8> = node.text().unwrap_or_default().bytes().collect();
            layout.unpack(&text, true, length)?
        }
        "appended" => {
            let (appended, is_base64) = layout.appended.ok_or("it has no appended data")?;
            let offset = node.attribute("offset").unwrap_or_default();
            let offset: usize = offset
                .trim()
                .parse()
                .map_err(|_| "an offset is no number")?;
            let from = appended
                .get(offset..)
                .ok_or("an offset is beyond the file's end")?;
            layout.unpack(from, is_base64, length)?
        }
        other => return Err(format!("the format `{}` is not read", shortened(other))),
    };
    let numbers = bytes.chunks_exact(kind.bytes);
    exactly(
        numbers
            .map(|bytes| kind.number(bytes, layout.is_little))
            .collect(),
        values,
    )
}

fn exactly(numbers: Vec<f64>, values: usize) -> Result<Vec<f64>, String> {
    if numbers.len() == values {
        return Ok(numbers);
    }
    let found = numbers.len();
    let word = if found > values { "more" } else { "fewer" };
    Err(format!("it has {word} than {values} numbers"))
}

/// A type of numbers.
struct Kind {
    bytes: usize,
    is_float: bool,
    is_signed: bool,
}

impl Kind {
    fn of(name: &str) -> Result<Self, String> {
        let (bytes, is_float, is_signed) = match name {
            "Float64" => (8, true, true),
            "Float32" => (4, true, true),
            "Int64" => (8, false, true),
            "Int32" => (4, false, true),
            "Int16" => (2, false, true),
            "Int8" => (1, false, true),
            "UInt64" => (8, false, false),
            "UInt32" => (4, false, false),
            "UInt16" => (2, false, false),
            "UInt8" => (1, false, false),
            _ => return Err(format!("the type `{}` is not read", shortened(name))),
        };
        Ok(Self {
            bytes,
            is_float,
            is_signed,
        })
    }

    #[allow(clippy::cast_precision_loss, clippy::cast_possible_wrap)] // bits are meant
    fn number(&self, bytes: &[u8], is_little: bool) -> f64 {
        let bits = unsigned(bytes, is_little);
        match (self.is_float, self.bytes) {
            (true, 8) => f64::from_bits(bits),
            (true, _) => f32::from_bits(u32::try_from(bits).unwrap_or(0)).into(),
            (false, bytes) if self.is_signed => {
                let unused = 64 - 8 * bytes;
                ((bits << unused) as i64 >> unused) as f64
            }
            _ => bits as f64,
        }
    }
}

fn unsigned(bytes: &[u8], is_little: bool) -> u64 {
    let add = |sum: u64, byte: &u8| sum << 8 | u64::from(*byte);
    if is_little {
        bytes.iter().rev().fold(0, add)
    } else {
        bytes.iter().fold(0, add)
    }
}

impl Layout<'_> {
    /// The `length` bytes of an array, which begin with a header.
    fn unpack(&self, from: &[u8], is_base64: bool, length: usize) -> Result<Vec<u8>, String> {
        if !self.is_compressed {
            let all = Self::stream(from, is_base64, self.header + length)?;
            let (head, bytes) = all.split_at(self.header);
            if unsigned(head, self.is_little) != length as u64 {
                return Err("its length is not that of its numbers".to_owned());
            }
            return Ok(bytes.to_vec());
        }
        let word = |head: &[u8], k: usize| {
            let bytes = &head[k * self.header..(k + 1) * self.header];
            usize::try_from(unsigned(bytes, self.is_little)).unwrap_or(usize::MAX)
        };
        let head = Self::stream(from, is_base64, 3 * self.header)?;
        let (blocks, size, last) = (word(&head, 0), word(&head, 1), word(&head, 2));
        if blocks > from.len() || length > from.len().saturating_mul(MOST_GROWTH) {
            return Err("it has more than the file holds".to_owned());
        }
        let head = Self::stream(from, is_base64, (3 + blocks) * self.header)?;
        let lengths = || (0..blocks).map(|k| word(&head, 3 + k));
        let total = lengths().try_fold(0_usize, usize::checked_add);
        let total = total.filter(|total| *total <= from.len());
        let total = total.ok_or("it has more than the file holds")?;
        // Header and blocks are two streams in base 64.
        let begin = if is_base64 {
            head.len().div_ceil(3) * 4
        } else {
            head.len()
        };
        let from = trimmed(from, is_base64);
        let packed = Self::stream(from.get(begin..).unwrap_or_default(), is_base64, total)?;
        let mut bytes = Vec::new();
        let mut first = 0;
        for (k, packed_length) in lengths().enumerate() {
            let wanted = if k + 1 == blocks && last > 0 {
                last
            } else {
                size
            };
            if wanted > length - bytes.len() {
                return Err("its blocks are more than its numbers".to_owned());
            }
            let packed = &packed[first..first + packed_length];
            let before = bytes.len();
            let mut block = ZlibDecoder::new(packed).take(wanted as u64 + 1);
            let read = block.read_to_end(&mut bytes);
            if read.is_err() || bytes.len() - before != wanted {
                return Err("a compressed block is damaged".to_owned());
            }
            first += packed_length;
        }
        if bytes.len() != length {
            return Err("its length is not that of its numbers".to_owned());
        }
        Ok(bytes)
    }

    /// The first bytes of a stream.
    fn stream(from: &[u8], is_base64: bool, length: usize) -> Result<Vec<u8>, String> {
        let short = "the file holds fewer bytes than it says";
        if !is_base64 {
            return Ok(from.get(..length).ok_or(short)?.to_vec());
        }
        let from = trimmed(from, true);
        let digits = length.div_ceil(3).checked_mul(4).ok_or(short)?;
        let digits = from.get(..digits).ok_or(short)?;
        let config = GeneralPurposeConfig::new()
            .with_decode_allow_trailing_bits(true)
            .with_decode_padding_mode(DecodePaddingMode::Indifferent);
        let engine = GeneralPurpose::new(&base64::alphabet::STANDARD, config);
        let mut bytes = engine
            .decode(digits)
            .map_err(|cause| format!("its base 64 is damaged: {cause}"))?;
        if bytes.len() < length {
            return Err(short.to_owned());
        }
        bytes.truncate(length);
        Ok(bytes)
    }
}

/// Without the blanks before it.
fn trimmed(from: &[u8], is_base64: bool) -> &[u8] {
    if is_base64 {
        from.trim_ascii_start()
    } else {
        from
    }
}
