//! Boxes of which a replay writes snapshots of their own.

/// Snapshots of a part where nothing tells how often they come.
const SNAPSHOTS: f64 = 50.0;

/// What a box needs to know of the case.
pub(super) struct Asked<'a> {
    /// Names of schedules that the case has.
    pub taken: &'a [String],
    /// Time between snapshots as typed.
    pub every: Option<&'a str>,
    /// The part of the run that is computed again (s).
    pub part: [f64; 2],
}

/// The overrides that give each box `LOWER:UPPER` a schedule of snapshots.
///
/// # Errors
/// A message on a text of another form.
pub(super) fn schedules(boxes: &[String], asked: &Asked<'_>) -> Result<Vec<String>, String> {
    let mut taken = asked.taken.to_vec();
    let mut set = Vec::new();
    for text in boxes {
        let name = free_name(&taken);
        let region = region(text)?;
        set.push(format!(
            "output.snapshot+={{ name = {name:?}, {}region = {region} }}",
            every(asked)
        ));
        taken.push(name);
    }
    Ok(set)
}

/// `watch`, or with the first number behind it that no schedule has.
fn free_name(taken: &[String]) -> String {
    let mut name = "watch".to_owned();
    let mut number = 1;
    while taken.contains(&name) {
        number += 1;
        name = format!("watch-{number}");
    }
    name
}

/// The time between snapshots as an entry of a table; nothing where the part has no length.
fn every(asked: &Asked<'_>) -> String {
    let [from, to] = asked.part;
    match asked.every {
        Some(every) => format!("every = {every:?}, "),
        None if to > from => format!("every = \"{:e} s\", ", (to - from) / SNAPSHOTS),
        None => String::new(),
    }
}

/// A region of the input between two corners; a side that is left empty is open.
fn region(text: &str) -> Result<String, String> {
    let wrong = || {
        format!(
            "error: --watch {text}: write a box as LOWER:UPPER, as in -1mm,-1mm,-2mm:1mm,1mm,0mm"
        )
    };
    let corners = text.split_once(':').ok_or_else(wrong)?;
    let corners =
        [corners.0, corners.1].map(|corner| corner.split(',').map(str::trim).collect::<Vec<_>>());
    if corners[0].len() != corners[1].len() || corners[0].len() > 3 {
        return Err(wrong());
    }
    let mut sides = Vec::new();
    for (key, corner) in ["above", "below"].into_iter().zip(corners) {
        let closed = ["x", "y", "z"]
            .into_iter()
            .zip(corner)
            .filter(|(_, at)| !at.is_empty());
        let closed: Vec<String> = closed
            .map(|(axis, at)| format!("{axis} = {at:?}"))
            .collect();
        if !closed.is_empty() {
            sides.push(format!("{key} = {{ {} }}", closed.join(", ")));
        }
    }
    if sides.is_empty() {
        return Err(wrong());
    }
    Ok(format!("{{ {} }}", sides.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn asked<'a>(taken: &'a [String], every: Option<&'a str>) -> Asked<'a> {
        Asked {
            taken,
            every,
            part: [1e-6, 2e-6],
        }
    }

    #[test]
    fn a_box_becomes_a_schedule() {
        let taken = ["watch".to_owned()];
        let set = schedules(
            &["-1mm,,0:1mm, 2 mm,".to_owned()],
            &asked(&taken, Some("5ns")),
        )
        .unwrap();
        let region =
            "{ above = { x = \"-1mm\", z = \"0\" }, below = { x = \"1mm\", y = \"2 mm\" } }";
        let expected = format!(
            "output.snapshot+={{ name = \"watch-2\", every = \"5ns\", region = {region} }}"
        );
        assert_eq!(set, [expected]);
        let set = schedules(&[",0:,".to_owned(), "1m:2m".to_owned()], &asked(&[], None)).unwrap();
        assert!(
            set[0].contains("name = \"watch\", every = \"2e-8 s\","),
            "{set:?}"
        );
        assert!(
            set[0].ends_with("region = { above = { y = \"0\" } } }"),
            "{set:?}"
        );
        assert!(set[1].contains("\"watch-2\""), "{set:?}");
    }

    #[test]
    fn what_is_no_box_is_refused() {
        for text in ["", "1mm,2mm", "1mm:2mm,3mm", "1,2,3,4:5,6,7,8", ",,:,,"] {
            let error = schedules(&[text.to_owned()], &asked(&[], None)).unwrap_err();
            assert!(error.contains("LOWER:UPPER"), "{text}: {error}");
        }
    }
}
