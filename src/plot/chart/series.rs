//! The series of a table: the rows of each pair of bodies, load or body, by the columns that name
//! them.

use super::sheet::CURVE;
use super::table::Table;

/// Columns that name what a row belongs to.
const KEYS: [&str; 8] = [
    "body_a",
    "body_b",
    CURVE,
    "load",
    "gauge",
    "witness",
    "body",
    "direction",
];

/// The same by number.
const NUMBER: &str = "first_rank";

/// The two columns of a pair.
const PAIR: [&str; 2] = [KEYS[0], KEYS[1]];

/// Some rows of a table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Series {
    /// Their name; empty if the table has one series alone.
    pub name: String,
    /// Their places among the rows.
    pub rows: Vec<usize>,
}

/// The series of a table of which `drawn` are the columns that are drawn, in the order in which
/// they begin; of a pair its own alone.
///
/// # Errors
/// A message if the table has no pairs, or not this one.
pub fn series(
    table: &Table,
    drawn: &[&str],
    pair: Option<&[String; 2]>,
) -> Result<Vec<Series>, String> {
    let mut keys = Vec::new();
    for name in KEYS.into_iter().chain([NUMBER]) {
        // A table of other origin may have a load in newtons.
        let present = table.has(name) && !drawn.contains(&name);
        let names = present && (name == NUMBER || table.column(name).is_err());
        if names || (PAIR.contains(&name) && table.has(name)) {
            keys.push(table.texts(name)?);
        }
    }
    if pair.is_some() && !has_pairs(table) {
        return Err("it has no pairs of bodies; contacts.csv of a run has".to_owned());
    }
    let count = table.len();
    let mut known: Vec<Series> = Vec::new();
    for row in 0..count {
        let name = keys
            .iter()
            .map(|key| key[row])
            .collect::<Vec<_>>()
            .join(" – ");
        match known.iter_mut().find(|series| series.name == name) {
            Some(series) => series.rows.push(row),
            None => known.push(Series {
                name,
                rows: vec![row],
            }),
        }
    }
    if let Some([a, b]) = pair {
        let of = |series: &Series| {
            series.name == format!("{a} – {b}") || series.name == format!("{b} – {a}")
        };
        if !known.iter().any(of) {
            let names: Vec<&str> = known.iter().map(|series| series.name.as_str()).collect();
            return Err(format!(
                "it has no pair {a} – {b}; it has {}",
                names.join(", ")
            ));
        }
        known.retain(of);
    } else if let [only] = &mut known[..] {
        only.name.clear();
    }
    Ok(known)
}

/// True if the rows of a table are of pairs of bodies.
#[must_use]
pub fn has_pairs(table: &Table) -> bool {
    PAIR.iter().all(|name| table.has(name))
}

/// Reads `A,B`.
#[must_use]
pub fn parse_pair(text: &str) -> Option<[String; 2]> {
    let (a, b) = text.split_once(',')?;
    let [a, b] = [a, b].map(|name| name.trim().to_owned());
    (!a.is_empty() && !b.is_empty()).then_some([a, b])
}

/// A column of numbers; if there is none of this name but three that end in `_x`, `_y` and `_z`,
/// the magnitude of that vector.
///
/// # Errors
/// A message with the line.
pub fn numbers(table: &Table, name: &str) -> Result<Vec<f64>, String> {
    let Some(parts) = components(table, name) else {
        return table.column(name);
    };
    let [x, y, z] = parts.map(|part| table.column(&part));
    let (x, y, z) = (x?, y?, z?);
    let all = x.into_iter().zip(y).zip(z);
    Ok(all
        .map(|((x, y), z)| (x * x + y * y + z * z).sqrt())
        .collect())
}

/// The SI unit of such a column; empty for none.
///
/// # Errors
/// A message if there is no such column.
pub fn unit(table: &Table, name: &str) -> Result<String, String> {
    let first = components(table, name).map_or(name.to_owned(), |[x, _, _]| x);
    table.unit(&first).map(str::to_owned)
}

/// The columns of a vector, if `name` is one and not itself a column.
fn components(table: &Table, name: &str) -> Option<[String; 3]> {
    let parts = ["x", "y", "z"].map(|axis| format!("{name}_{axis}"));
    (!table.has(name) && parts.iter().all(|part| table.has(part))).then_some(parts)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CONTACTS: &str = "# units: s,-,-,N,N,N\ntime,body_a,body_b,force_x,force_y,force_z\n\
        0,a,b,3,0,4\n0,a,c,0,0,1\n1,a,b,0,0,-2\n1,a,c,0,0,0\n";

    #[test]
    fn pairs_are_series_of_their_own() {
        let table = Table::parse(CONTACTS).unwrap();
        let all = series(&table, &["time", "force"], None).unwrap();
        assert_eq!(all.len(), 2);
        assert_eq!(
            (all[0].name.as_str(), &all[0].rows[..]),
            ("a – b", &[0, 2][..])
        );
        let pair = parse_pair("c, a").unwrap();
        let one = series(&table, &["time", "force"], Some(&pair)).unwrap();
        assert_eq!(one, [all[1].clone()]);
        assert_eq!(numbers(&table, "force").unwrap(), [5.0, 1.0, 2.0, 0.0]);
        assert_eq!(unit(&table, "force").unwrap(), "N");
        let wrong = series(&table, &[], parse_pair("a,d").as_ref()).unwrap_err();
        assert!(
            wrong.contains("no pair a – d; it has a – b, a – c"),
            "{wrong}"
        );
    }

    #[test]
    fn gauges_are_series_and_read_nothing_where_cells_are_empty() {
        let table = Table::parse("time,gauge,pressure\n0,front,1\n0,rear,\n1,front,2\n").unwrap();
        let all = series(&table, &["time", "pressure"], None).unwrap();
        let names: Vec<&str> = all.iter().map(|series| series.name.as_str()).collect();
        assert_eq!(names, ["front", "rear"]);
        let read = numbers(&table, "pressure").unwrap();
        assert!(read[1].is_nan() && read[2] == 2.0);
    }

    #[test]
    fn tables_without_names_are_one_series() {
        let table = Table::parse("time,load\n0,5\n1,7\n").unwrap();
        let all = series(&table, &["time", "load"], None).unwrap();
        assert_eq!((all.len(), all[0].name.as_str()), (1, ""));
        assert_eq!(series(&table, &["time"], None).unwrap().len(), 1);
        assert!(
            series(&table, &[], parse_pair("a,b").as_ref())
                .unwrap_err()
                .contains("no pairs")
        );
        assert!(
            numbers(&table, "force")
                .unwrap_err()
                .contains("no column force")
        );
    }
}
