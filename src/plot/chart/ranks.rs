//! The work of the ranks, step after step.

use super::curves::Line;
use super::table::Table;
use crate::canvas::Rgb;
use crate::colour;

/// As many ranks, or groups of ranks, have a curve each.
const FEW: usize = 8;

/// The quantiles that are drawn of many: the rank of each hundred in the order of their work, and
/// its colour.
const OF_MANY: [(&str, usize, Rgb); 5] = [
    ("busiest", 100, [213, 94, 0]),
    ("upper quarter", 75, [230, 159, 0]),
    ("median", 50, [40, 40, 40]),
    ("lower quarter", 25, [86, 180, 233]),
    ("least busy", 0, [0, 114, 178]),
];

/// Ranks at some steps.
struct Row {
    step: f64,
    ranks: [f64; 2],
    work: f64,
}

/// Lines of `work_over_mean` over the steps: one for each rank of few, for quantiles of many.
///
/// # Errors
/// A message on a table that lacks a column or has a bad number.
pub(super) fn by_rank(table: &Table, steps: &[f64]) -> Result<Vec<Line>, String> {
    let columns = ["first_rank", "last_rank", "work_over_mean"];
    let [first, last, work] = columns.map(|name| table.column(name));
    let (first, last, work) = (first?, last?, work?);
    let row = |n: usize| Row {
        step: steps[n],
        ranks: [first[n], last[n]],
        work: work[n],
    };
    let rows: Vec<Row> = (0..steps.len()).map(row).collect();
    // A restart on other ranks has other groups.
    let at_once = |rows: &[Row]| {
        rows.chunk_by(|a, b| a.step == b.step)
            .map(<[Row]>::len)
            .max()
    };
    if at_once(&rows).is_some_and(|most| most > FEW) {
        Ok(quantiles(&rows))
    } else {
        Ok(each(&rows))
    }
}

/// A line for each rank or group of them, in their order.
fn each(rows: &[Row]) -> Vec<Line> {
    let mut groups: Vec<[f64; 2]> = rows.iter().map(|row| row.ranks).collect();
    groups.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    groups.dedup();
    let line = |(k, &group): (usize, &[f64; 2])| {
        let own = rows.iter().filter(|row| row.ranks == group);
        let name = match group {
            [first, last] if first == last => format!("rank {first}"),
            [first, last] => format!("ranks {first} to {last}"),
        };
        (
            name,
            colour::body(k),
            own.map(|row| [row.step, row.work]).collect(),
        )
    };
    groups.iter().enumerate().map(line).collect()
}

/// A line for each of some quantiles of all ranks.
fn quantiles(rows: &[Row]) -> Vec<Line> {
    let mut lines = OF_MANY.map(|(name, _, colour)| (name.to_owned(), colour, Vec::new()));
    for rows in rows.chunk_by(|a, b| a.step == b.step) {
        let mut work: Vec<f64> = rows.iter().map(|row| row.work).collect();
        work.sort_by(f64::total_cmp);
        for (line, (_, hundredth, _)) in lines.iter_mut().zip(OF_MANY) {
            let nearest = ((work.len() - 1) * hundredth + 50) / 100;
            line.2.push([rows[0].step, work[nearest]]);
        }
    }
    lines.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(rows: &str) -> Vec<Line> {
        let units = "# units: -,-,-,-,-\nstep,first_rank,last_rank,particles,work_over_mean\n";
        let table = Table::parse(&format!("{units}{rows}")).unwrap();
        by_rank(&table, &table.column("step").unwrap()).unwrap()
    }

    #[test]
    fn few_ranks_have_a_line_each() {
        // Three groups of five ranks, then a restart on two.
        let drawn = lines("0,0,1,9,1.5\n0,2,3,9,0.5\n0,4,4,9,1\n7,0,0,9,1.25\n7,1,1,9,0.75\n");
        let drawn: Vec<_> = drawn
            .iter()
            .map(|line| (&line.0[..], &line.2[..]))
            .collect();
        let expected: [(&str, &[[f64; 2]]); 5] = [
            ("rank 0", &[[7.0, 1.25]]),
            ("ranks 0 to 1", &[[0.0, 1.5]]),
            ("rank 1", &[[7.0, 0.75]]),
            ("ranks 2 to 3", &[[0.0, 0.5]]),
            ("rank 4", &[[0.0, 1.0]]),
        ];
        assert_eq!(drawn, expected);
    }

    #[test]
    fn many_ranks_have_lines_of_quantiles() {
        let row = |rank| format!("3,{rank},{rank},9,{}\n", 8 - rank);
        let rows = (0..9).map(row).collect::<Vec<_>>().concat();
        let drawn = lines(&rows);
        let drawn: Vec<_> = drawn
            .iter()
            .map(|line| (&line.0[..], &line.2[..]))
            .collect();
        let expected: [(&str, &[[f64; 2]]); 5] = [
            ("busiest", &[[3.0, 8.0]]),
            ("upper quarter", &[[3.0, 6.0]]),
            ("median", &[[3.0, 4.0]]),
            ("lower quarter", &[[3.0, 2.0]]),
            ("least busy", &[[3.0, 0.0]]),
        ];
        assert_eq!(drawn, expected);
    }
}
